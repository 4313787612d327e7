//! From radiance to what a screen shows, as `shaders/film/tone.wgsl` has it.

/// The curve between exposed radiance and the screen's linear light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// None: values over 1 are clipped.
    Plain,
    /// Nearly linear up to 0.6, then a shoulder that reaches 1 for no finite value.
    #[default]
    Filmic,
}

/// Where the shoulder of the filmic curve begins.
const KNEE: f32 = 0.6;

impl Tone {
    /// Applies the curve to one channel.
    pub fn apply(self, value: f32) -> f32 {
        match self {
            Self::Plain => value,
            Self::Filmic => {
                let over = (value - KNEE).max(0.0) / (1.0 - KNEE);
                let shoulder = if over.is_finite() { over / (1.0 + over) } else { 1.0 };
                value.min(KNEE) + (1.0 - KNEE) * shoulder
            }
        }
    }
}

/// The sRGB transfer function (IEC 61966-2-1), clipped to [0, 1].
pub(crate) fn encode_srgb(linear: f32) -> f32 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filmic_is_linear_below_the_knee_and_rises_to_1() {
        let filmic = |value| Tone::Filmic.apply(value);
        assert_eq!(filmic(0.25), 0.25);
        // over = 1: half of what is left above the knee.
        assert!((filmic(1.0) - 0.8).abs() < 1e-6);
        assert!(filmic(100.0) < 1.0 && filmic(100.0) > 0.99);
        assert_eq!(filmic(f32::INFINITY), 1.0);
        assert_eq!(filmic(f32::MAX), 1.0);
        assert_eq!(Tone::Plain.apply(3.0), 3.0);
    }

    #[test]
    fn srgb_has_the_standards_values() {
        assert_eq!((encode_srgb(-1.0), encode_srgb(0.0)), (0.0, 0.0));
        assert_eq!(encode_srgb(1.0), encode_srgb(7.0));
        assert!((encode_srgb(1.0) - 1.0).abs() < 1e-6);
        assert!((encode_srgb(0.214_041_14) - 0.5).abs() < 1e-6);
        assert!((encode_srgb(0.002) - 0.025_84).abs() < 1e-7);
    }
}
