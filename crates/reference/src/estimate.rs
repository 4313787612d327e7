//! Means of random samples and how sure they are.

use glam::DVec3;
use rayon::prelude::*;

use crate::generator::Generator;

/// Samples that share one stream of random numbers.
const CHUNK: u32 = 1024;

/// The mean of independent samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean, per channel.
    pub mean: DVec3,
    /// Variance of the mean, estimated from the samples' own variance; the square of the mean's unit.
    pub variance: DVec3,
}

impl Estimate {
    /// How many standard deviations `value` lies from the mean, per channel.
    pub fn deviations(&self, value: DVec3) -> DVec3 {
        (value - self.mean) / self.variance.map(f64::sqrt)
    }
}

#[derive(Clone, Copy)]
struct Sums<const N: usize> {
    values: [DVec3; N],
    squares: [DVec3; N],
}

impl<const N: usize> Sums<N> {
    const ZERO: Self = Self { values: [DVec3::ZERO; N], squares: [DVec3::ZERO; N] };

    fn add(mut self, values: [DVec3; N], squares: [DVec3; N]) -> Self {
        for i in 0..N {
            self.values[i] += values[i];
            self.squares[i] += squares[i];
        }
        self
    }
}

/// Means of N quantities that are sampled together. `words` names the stream of random numbers; the result does not
/// depend on the number of threads.
///
/// # Panics
/// If there are fewer than 2 samples.
pub(crate) fn mean<const N: usize>(
    samples: u32,
    words: &[u64],
    sample: impl Fn(&mut Generator) -> [DVec3; N] + Sync,
) -> [Estimate; N] {
    assert!(samples >= 2, "a variance takes at least 2 samples, not {samples}");
    let sum_chunk = |chunk: u32| {
        let key: Vec<u64> = words.iter().copied().chain([u64::from(chunk)]).collect();
        let mut generator = Generator::new(&key);
        let size = CHUNK.min(samples - chunk * CHUNK);
        (0..size).fold(Sums::ZERO, |sums, _| {
            let values = sample(&mut generator);
            sums.add(values, values.map(|v| v * v))
        })
    };
    let chunks: Vec<Sums<N>> = (0..samples.div_ceil(CHUNK)).into_par_iter().map(sum_chunk).collect();
    let sums = chunks.into_iter().fold(Sums::ZERO, |all, chunk| all.add(chunk.values, chunk.squares));
    let count = f64::from(samples);
    std::array::from_fn(|i| {
        let mean = sums.values[i] / count;
        let variance = (sums.squares[i] / count - mean * mean).max(DVec3::ZERO) / (count - 1.0);
        Estimate { mean, variance }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_of_uniform_numbers() {
        let [estimate] = mean(10_000, &[3], |generator| [DVec3::splat(generator.unit())]);
        assert!((estimate.variance.x * 12.0 * 10_000.0 - 1.0).abs() < 0.05);
        assert!(estimate.deviations(DVec3::splat(0.5)).abs().max_element() < 4.0);
        assert!(estimate.deviations(DVec3::splat(0.52)).abs().max_element() > 4.0);
    }

    #[test]
    fn constants_have_no_variance() {
        let [estimate] = mean(2000, &[3], |_| [DVec3::ONE]);
        assert_eq!(estimate, Estimate { mean: DVec3::ONE, variance: DVec3::ZERO });
    }
}
