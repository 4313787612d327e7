//! The scale of false colours.

/// Numbers from a least to a greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    /// 0 on a linear scale.
    least: f32,
    greatest: f32,
}

/// The greatest value over the median from which on a scale is logarithmic.
const LOGARITHMIC_FROM: f32 = 20.0;
/// Powers of ten that a logarithmic scale covers at most.
const DECADES: i32 = 4;
/// Ticks of a linear scale.
const TICKS: u32 = 5;

impl Scale {
    /// A scale for some values: up to the greatest, from 0, or, if the greatest is far beyond most others, over some powers of ten.
    pub fn of(values: &[f32]) -> Self {
        let mut lit: Vec<f32> = values.iter().copied().filter(|value| *value > 0.0 && value.is_finite()).collect();
        lit.sort_unstable_by(f32::total_cmp);
        let (Some(&lowest), Some(&highest)) = (lit.first(), lit.last()) else {
            return Self { least: 0.0, greatest: 1.0 };
        };
        let greatest = rounded_up(highest);
        let median = lit[lit.len() / 2];
        if highest < LOGARITHMIC_FROM * median {
            return Self { least: 0.0, greatest };
        }
        let top = 10f32.powi(highest.log10().ceil() as i32);
        let bottom = 10f32.powi(lowest.log10().floor() as i32).max(top * 10f32.powi(-DECADES));
        Self { least: bottom, greatest: top }
    }

    pub fn is_logarithmic(&self) -> bool {
        self.least > 0.0
    }

    /// A value's place on the scale, from 0 to 1.
    pub fn part(&self, value: f32) -> f32 {
        let part = if self.is_logarithmic() {
            (value / self.least).log10() / (self.greatest / self.least).log10()
        } else {
            value / self.greatest
        };
        part.clamp(0.0, 1.0)
    }

    /// Places on the scale and what stands beside them, from the least up.
    pub fn ticks(&self) -> Vec<(f32, String)> {
        if self.is_logarithmic() {
            let (first, last) = (self.least.log10().round() as i32, self.greatest.log10().round() as i32);
            return (first..=last).map(|power| (self.part(10f32.powi(power)), number(10f64.powi(power)))).collect();
        }
        let value = |step: u32| f64::from(self.greatest) * f64::from(step) / f64::from(TICKS);
        (0..=TICKS).map(|step| (step as f32 / TICKS as f32, number(value(step)))).collect()
    }
}

/// The next of 1, 2, 2.5 and 5 times a power of ten.
fn rounded_up(value: f32) -> f32 {
    let power = 10f32.powi(value.log10().floor() as i32);
    [1.0, 2.0, 2.5, 5.0].into_iter().map(|digit| digit * power).find(|round| *round >= value).unwrap_or(10.0 * power)
}

/// A number of few letters.
fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if (1e-3..1e5).contains(&value) {
        let digits = (2 - value.log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.digits$}");
        return if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text };
    }
    format!("{value:.0e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_light_has_a_linear_scale_and_caustics_a_logarithmic_one() {
        let even = Scale::of(&[0.0, 3.0, 2.0, 4.2]);
        assert_eq!(even, Scale { least: 0.0, greatest: 5.0 });
        assert!(!even.is_logarithmic() && even.part(2.5) == 0.5 && even.part(9.0) == 1.0);
        let labels: Vec<String> = even.ticks().into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0", "1", "2", "3", "4", "5"]);

        let mut values = vec![0.5; 100];
        values.extend([70.0, 1e-7]);
        let caustic = Scale::of(&values);
        assert!(caustic.is_logarithmic());
        assert_eq!(
            caustic.ticks().iter().map(|(_, label)| label.as_str()).collect::<Vec<_>>(),
            ["0.01", "0.1", "1", "10", "100"]
        );
        assert!((caustic.part(1.0) - 0.5).abs() < 1e-6 && caustic.part(1e-7) == 0.0);
        assert_eq!(Scale::of(&[0.0, f32::NAN]), Scale { least: 0.0, greatest: 1.0 });
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.0, 0.25, 2000.0, 1e6, 2e-7].map(number), ["0", "0.25", "2000", "1e6", "2e-7"]);
    }
}
