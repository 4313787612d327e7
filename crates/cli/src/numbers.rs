//! Numbers as arguments.

use std::{ops::RangeInclusive, time::Duration};

pub(crate) fn parse_photons(text: &str) -> Result<u64, String> {
    parse_whole(text, 0).map(u64::from)
}

pub(crate) fn parse_samples(text: &str) -> Result<u32, String> {
    parse_whole(text, 1)
}

pub(crate) fn parse_seed(text: &str) -> Result<u32, String> {
    parse_whole(text, 0)
}

pub(crate) fn parse_target_error(text: &str) -> Result<f32, String> {
    let error = text.parse().ok().filter(|error| *error > 0.0 && *error <= 1.0);
    error.ok_or_else(|| "expected a number greater than 0 and at most 1, such as 0.05".to_owned())
}

/// The size of a map, texels.
pub(crate) fn parse_size(text: &str) -> Result<u32, String> {
    let size = parse_whole(text, 2)?;
    if size <= 8192 { Ok(size) } else { Err("expected a whole number from 2 to 8192".to_owned()) }
}

/// Texels a metre.
pub(crate) fn parse_density(text: &str) -> Result<f32, String> {
    let expected = || "expected a number of texels greater than 0, such as 100 or 2.5".to_owned();
    let density: f32 = text.parse().map_err(|_| expected())?;
    if density > 0.0 && density.is_finite() { Ok(density) } else { Err(expected()) }
}

/// A whole number in decimal digits, between which underscores may stand.
fn parse_whole(text: &str, least: u32) -> Result<u32, String> {
    let expected = || format!("expected a whole number from {least} to {}, such as 1000 or 1_000", u32::MAX);
    let digits_at_ends =
        [text.chars().next(), text.chars().last()].iter().all(|c| c.is_some_and(|c| c.is_ascii_digit()));
    let value: u32 = text.replace('_', "").parse().map_err(|_| expected())?;
    if digits_at_ends && value >= least { Ok(value) } else { Err(expected()) }
}

/// Two frames with dots between.
pub(crate) fn parse_frames(text: &str) -> Result<RangeInclusive<u32>, String> {
    let frame = |text| parse_whole(text, 0).ok();
    let range = text.split_once("..").and_then(|(first, last)| Some(frame(first)?..=frame(last)?));
    range
        .filter(|range| !range.is_empty())
        .ok_or_else(|| "expected the first and the last frame, such as 1..48".to_owned())
}

/// Seconds, without a unit.
pub(crate) fn parse_seconds(text: &str) -> Result<Duration, String> {
    let expected = || "expected a number of seconds greater than 0, such as 60 or 2.5".to_owned();
    let seconds: f64 = text.parse().map_err(|_| expected())?;
    let duration = Duration::try_from_secs_f64(seconds).map_err(|_| expected())?;
    if duration.is_zero() { Err(expected()) } else { Ok(duration) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_checked() {
        for bad in ["1e6", "-1", "+1", "_1", "1_", "", "1.5", "4294967296", "ten", "1 000"] {
            assert!(parse_photons(bad).is_err(), "{bad:?}");
        }
        assert_eq!((parse_photons("0"), parse_photons("4_294_967_295")), (Ok(0), Ok(u64::from(u32::MAX))));
        assert_eq!((parse_frames("1..48"), parse_frames("7..7")), (Ok(1..=48), Ok(7..=7)));
        for bad in ["", "1", "1..", "..2", "2..1", "1..=2", "-1..2", "a..b"] {
            assert!(parse_frames(bad).is_err(), "{bad:?}");
        }
        assert!(parse_samples("0").unwrap_err().contains("from 1 to"));
        for bad in ["0", "-1", "1.5", "nan", "inf", "5%", ""] {
            assert!(parse_target_error(bad).is_err(), "{bad:?}");
        }
        assert_eq!(parse_target_error("0.05"), Ok(0.05));
        assert_eq!((parse_size("512"), parse_density("2.5")), (Ok(512), Ok(2.5)));
        assert!(["1", "8193", "x"].iter().all(|bad| parse_size(bad).is_err()));
        assert!(["0", "-1", "nan", "inf", "x"].iter().all(|bad| parse_density(bad).is_err()));
        for bad in ["0", "-1", "nan", "inf", "1e300", "1s", ""] {
            assert!(parse_seconds(bad).is_err(), "{bad:?}");
        }
    }
}
