//! The film: what the camera pass accumulates, and the pixel filter with which it draws.

use std::f64::consts::{PI, TAU};

use diacaustic_scene::PixelFilter;

/// The picture accumulated so far, read from the device.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Samples in each pixel, at least.
    pub samples: u32,
    /// Mean radiance, W/(m² sr), linear Rec. 709, row by row from the top left.
    pub radiance: Vec<[f32; 3]>,
}

/// Steps of [`filter_inverse_cdf`].
const STEPS: usize = 64;

/// The inverse cumulative distribution of a pixel filter along one axis at (1 − cos(πk/63))/2 for k = 0 … 63, pixels from the
/// centre: steps that are fine where the filter's tails are. Drawing offsets from it and averaging equals weighting by the
/// filter (Ernst, Stamminger and Greiner 2006).
pub(crate) fn filter_inverse_cdf(filter: PixelFilter) -> [[f32; 4]; STEPS / 4] {
    let half_width = match filter {
        PixelFilter::Box => 0.5,
        PixelFilter::BlackmanHarris => 2.0,
    };
    std::array::from_fn(|k| {
        std::array::from_fn(|i| {
            let wanted = 0.5 - 0.5 * (PI * (4 * k + i) as f64 / (STEPS - 1) as f64).cos();
            // The distribution rises steadily, so halving finds the offset.
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if filter_cdf(filter, middle) < wanted { low = middle } else { high = middle }
            }
            (half_width * (low + high - 1.0)) as f32
        })
    })
}

/// The share of a filter's weight in the first part `t` of its width.
fn filter_cdf(filter: PixelFilter, t: f64) -> f64 {
    match filter {
        PixelFilter::Box => t,
        PixelFilter::BlackmanHarris => {
            let sine = |k: f64| (TAU * k * t).sin() / (TAU * k);
            t + (-0.488_29 * sine(1.0) + 0.141_28 * sine(2.0) - 0.011_68 * sine(3.0)) / 0.358_75
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_have_the_filters_spread() {
        // Variance of a box one pixel wide: 1/12. Of the window: its second moment over 4 pixels, by quadrature.
        let window = |x: f64| {
            let t = x / 4.0 + 0.5;
            0.358_75 - 0.488_29 * (TAU * t).cos() + 0.141_28 * (2.0 * TAU * t).cos() - 0.011_68 * (3.0 * TAU * t).cos()
        };
        let points = (0..4000).map(|i| -2.0 + (f64::from(i) + 0.5) / 1000.0);
        let second = points.clone().map(|x| x * x * window(x)).sum::<f64>() / points.map(window).sum::<f64>();
        for (filter, expected) in [(PixelFilter::Box, 1.0 / 12.0), (PixelFilter::BlackmanHarris, second)] {
            let table = filter_inverse_cdf(filter).concat();
            // As the kernel looks it up, for evenly spread numbers.
            let offset = |u: f64| {
                let at = (1.0 - 2.0 * u).acos() * 63.0 / PI;
                let k = (at as usize).min(62);
                f64::from(table[k]) + f64::from(table[k + 1] - table[k]) * (at - k as f64)
            };
            let numbers = (0..10_000).map(|i| (f64::from(i) + 0.5) / 10_000.0);
            let variance = numbers.map(|u| offset(u).powi(2)).sum::<f64>() / 10_000.0;
            assert!((variance / expected - 1.0).abs() < 0.003, "{filter:?}: {variance} against {expected}");
        }
    }
}
