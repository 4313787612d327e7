//! Comparisons of pictures.

/// How a picture compares with a reference over some pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean over the pixels of min(1, (i − r)²/(r² + 0.01 r̄²)).
    pub relative_mse: f64,
    /// Ratio of the means.
    pub mean_ratio: f64,
}

/// Compares the pixels where `mask` holds.
///
/// # Panics
/// If the lengths differ, a value is not finite, or no pixel is in the mask.
pub fn compare_pictures(picture: &[f64], reference: &[f64], mask: &[bool]) -> Comparison {
    assert!(picture.len() == reference.len() && picture.len() == mask.len(), "pictures of different sizes");
    let pairs: Vec<(f64, f64)> =
        picture.iter().zip(reference).zip(mask).filter(|(_, inside)| **inside).map(|((&p, &r), _)| (p, r)).collect();
    assert!(!pairs.is_empty(), "no pixel to compare");
    assert!(pairs.iter().all(|(p, r)| p.is_finite() && r.is_finite()), "a value is not finite");
    let reference_mean = mean(pairs.iter().map(|(_, r)| *r));
    let floor = 0.01 * reference_mean * reference_mean;
    Comparison {
        relative_mse: mean(pairs.iter().map(|(p, r)| ((p - r).powi(2) / (r * r + floor)).min(1.0))),
        mean_ratio: mean(pairs.iter().map(|(p, _)| *p)) / reference_mean,
    }
}

/// The mean of some numbers; NaN of none.
pub fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_have_no_error_and_others_do() {
        let reference = [1.0, 2.0, 3.0, 100.0];
        let mask = [true, true, true, false];
        let same = compare_pictures(&[1.0, 2.0, 3.0, 0.0], &reference, &mask);
        assert_eq!(same, Comparison { relative_mse: 0.0, mean_ratio: 1.0 });
        let brighter = compare_pictures(&[1.1, 2.2, 3.3, 0.0], &reference, &mask);
        assert!((brighter.mean_ratio - 1.1).abs() < 1e-12 && brighter.relative_mse > 0.005);
    }

    #[test]
    #[should_panic(expected = "not finite")]
    fn a_picture_with_a_hole_fails() {
        compare_pictures(&[f64::NAN], &[1.0], &[true]);
    }
}
