//! The variance of the picture's pixels: that of their samples, scaled by what halves of the samples differ in around them.

/// Pixels to each side of one that its scale is taken over.
const REACH: usize = 4;

/// What the samples of a picture's pixels sum to: radiance, W/(m² sr), and how many they are.
#[derive(Debug)]
pub(crate) struct SampleSums {
    /// Pixels along x.
    pub width: usize,
    /// All samples of each pixel, row by row from the top left.
    pub all: Vec<[f32; 4]>,
    /// The first samples of each pixel, as many as the last power of two before all, and a number that is not theirs; empty if they are not kept.
    pub halves: Vec<[f32; 4]>,
}

impl SampleSums {
    /// Samples of each pixel.
    pub fn counts(&self) -> impl Iterator<Item = u32> + Clone {
        self.all.iter().map(|sum| sum[3] as u32)
    }

    /// The variance of each pixel's mean, (W/(m² sr))²; 0 where it cannot be known, of a single sample. `squares` are the squared deviations of the
    /// samples of each pixel from their mean.
    ///
    /// Samples of a low-discrepancy sequence are no independent ones, whose variance the squares tell. What its halves differ in is, but is a
    /// single number for each pixel; so the one is scaled to the other over a neighbourhood (Rousselle, Knaus and Zwicker 2012).
    pub fn variances(&self, squares: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let of_samples: Vec<_> =
            self.all.iter().zip(squares).map(|(all, squares)| if_independent(all, squares)).collect();
        let of_halves = self.all.iter().zip(&self.halves).map(|(all, first)| by_halves(all, first));
        let sum = |variance: &[f32; 3]| variance.iter().map(|&channel| f64::from(channel)).sum::<f64>();
        let both = of_samples.iter().zip(of_halves).map(|(samples, halves)| [sum(samples), sum(&halves)]);
        let around = sums_around(both, self.width);
        let scaled = |(variance, [samples, halves]): (&[f32; 3], [f64; 2])| {
            let scale = if samples > 0.0 { halves / samples } else { 1.0 };
            variance.map(|channel| (f64::from(channel) * scale) as f32)
        };
        of_samples.iter().zip(around).map(scaled).collect()
    }
}

/// The variance of the mean of independent samples.
fn if_independent(all: &[f32; 4], squares: &[f32; 3]) -> [f32; 3] {
    let count = all[3];
    squares.map(|square| square / (count * (count - 1.0)).max(1.0))
}

/// The variance of the mean of samples, of which the first and the rest are independent: means of n₁ and n₂ samples differ by σ²(1/n₁ + 1/n₂) in the mean
/// square, and that of all has the variance σ²/(n₁ + n₂).
fn by_halves(all: &[f32; 4], first: &[f32; 4]) -> [f32; 3] {
    let count = all[3];
    if count < 2.0 {
        return [0.0; 3];
    }
    let early = (1u32 << (count as u32 - 1).ilog2()) as f32;
    let late = count - early;
    std::array::from_fn(|k| {
        let difference = first[k] / early - (all[k] - first[k]) / late;
        difference * difference * early * late / (count * count)
    })
}

/// The sums of numbers over the square around each pixel, as far as it lies in the picture.
fn sums_around(values: impl Iterator<Item = [f64; 2]>, width: usize) -> Vec<[f64; 2]> {
    let values: Vec<_> = values.collect();
    let add = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
    let height = values.len() / width.max(1);
    let near = |at: usize, count: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(count);
    let sum = |values: &[[f64; 2]], indices: &mut dyn Iterator<Item = usize>| {
        indices.map(|index| values[index]).fold([0.0; 2], add)
    };
    // Along rows, then along columns. Plain sums: differences of running ones would lose the dark beside the bright.
    let along_x = |index: usize| sum(&values, &mut near(index % width, width).map(|x| index / width * width + x));
    let rows: Vec<_> = (0..width * height).map(along_x).collect();
    let along_y = |index: usize| sum(&rows, &mut near(index / width, height).map(|y| y * width + index % width));
    (0..width * height).map(along_y).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of one row whose pixels have four samples each, the first two of which are kept apart.
    fn row(pixels: &[[f32; 4]]) -> (SampleSums, Vec<[f32; 3]>) {
        let sums = |count: usize| {
            let sum = |samples: &[f32; 4]| samples[..count].iter().sum::<f32>();
            pixels.iter().map(|samples| [sum(samples), 0.0, 0.0, count as f32]).collect()
        };
        let squares = |samples: &[f32; 4]| {
            let mean = samples.iter().sum::<f32>() / 4.0;
            [samples.iter().map(|sample| (sample - mean).powi(2)).sum(), 0.0, 0.0]
        };
        (SampleSums { width: pixels.len(), all: sums(4), halves: sums(2) }, pixels.iter().map(squares).collect())
    }

    #[test]
    fn samples_are_scaled_to_what_halves_differ_in() {
        // Samples vary by 4/3 each; the halves by 0, and by 2.
        let (sums, squares) = row(&[[1.0, 3.0, 3.0, 1.0], [1.0, 1.0, 3.0, 3.0]]);
        // Over both pixels: samples tell 1/3 + 1/3, halves 0 + 1.
        let expected = 1.0 / 3.0 * (1.0 / (2.0 / 3.0));
        for variance in sums.variances(&squares) {
            assert!((variance[0] - expected).abs() < 1e-6 && variance[1] == 0.0, "{variance:?}");
        }
    }

    #[test]
    fn only_near_pixels_count() {
        let mut pixels = vec![[1.0, 3.0, 3.0, 1.0]; 12];
        pixels[0] = [1.0, 1.0, 3.0, 3.0];
        let (sums, squares) = row(&pixels);
        let variances = sums.variances(&squares);
        assert!(variances[REACH][0] > 0.0 && variances[REACH + 1][0] == 0.0, "{variances:?}");
    }

    #[test]
    fn without_noise_or_with_a_single_sample_there_is_none() {
        let (sums, squares) = row(&[[2.0; 4]; 3]);
        assert_eq!(sums.variances(&squares), [[0.0; 3]; 3]);
        let single = SampleSums { width: 1, all: vec![[2.0, 2.0, 2.0, 1.0]], halves: vec![[0.0; 4]] };
        assert_eq!(single.variances(&[[0.0; 3]]), [[0.0; 3]]);
    }
}
