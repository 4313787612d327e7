//! Values that change from frame to frame.

use glam::{DQuat, DVec3};
use toml::de::DeValue;

use super::{
    Override,
    table::{Entry, Table},
};
use crate::Error;

/// The values that `[animation]` sets at a frame, and what it adds to the seed.
pub(super) struct Frame {
    pub overrides: Vec<Override>,
    pub seed_offset: u32,
}

/// How values change between two keyframes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Interpolation {
    /// The value of the keyframe before.
    Step,
    Linear,
    /// A cubic without kinks that never leaves the range of the values at its ends (Fritsch and Butland 1984).
    Smooth,
}

/// Reads all tracks, for a fault in them is one whether or not a frame is asked for, and evaluates them at a frame.
pub(super) fn at_frame(table: &Table<'_>, frame: u32) -> Result<Frame, Error> {
    table.allow_only(&["seed", "tracks"])?;
    let seeds = [("fixed", 0), ("per_frame", frame)];
    let seed_offset = table.get("seed").map_or(Ok(0), |entry| entry.choice("seed", &seeds))?;
    let tracks = table.require("tracks", "an array of tables: [[animation.tracks]]")?;
    let tracks = tracks.elements("an array of tables: [[animation.tracks]]")?.into_iter().enumerate();
    let overrides = tracks.map(|(index, track)| {
        let name = format!("[[animation.tracks]] #{}", index + 1);
        track_at(&track.table(name, "a table: [[animation.tracks]]")?, f64::from(frame))
    });
    Ok(Frame { overrides: overrides.collect::<Result<_, _>>()?, seed_offset })
}

/// The value of one track at a frame.
fn track_at(table: &Table<'_>, frame: f64) -> Result<Override, Error> {
    table.allow_only(&["key", "frames", "values", "degrees", "orbit", "interpolation"])?;
    let key = table.require("key", "the path of a key, such as \"camera.position\"")?;
    let frames = read_frames(table)?;
    let names = [("step", Interpolation::Step), ("linear", Interpolation::Linear), ("smooth", Interpolation::Smooth)];
    let interpolation =
        table.get("interpolation").map_or(Ok(Interpolation::Linear), |entry| entry.choice("interpolation", &names))?;
    let value = match table.either("values", "degrees", "an array with a value for each of the frames")? {
        entry if entry.key() == "degrees" => {
            let orbit = table.require("orbit", "a table: { start, center, axis }")?;
            let orbit = Orbit::read(&orbit.table(format!("{}: orbit", table.name()), "a table")?)?;
            let degrees = numbers(&entry, &frames)?;
            Value::vector(orbit.at(at(&frames, &degrees, interpolation, frame).to_radians()))
        }
        entry => {
            if let Some(orbit) = table.get("orbit") {
                return Err(orbit.error("goes with degrees in place of values"));
            }
            value_at(&entry, &frames, interpolation, frame)?
        }
    };
    let text = format!("{}={}", key.string("the path of a key, such as \"camera.position\"")?, value.to_toml());
    Override::parse(&text).map_err(|_| key.error("is no path of a key, such as \"camera.position\""))
}

/// The frames of the values, which must rise.
fn read_frames(table: &Table<'_>) -> Result<Vec<f64>, Error> {
    let entry = table.require("frames", "an array of frame numbers that rise")?;
    let frames: Vec<_> = entry
        .elements("an array of frame numbers")?
        .iter()
        .map(|element| element.whole32().map(f64::from))
        .collect::<Result<_, _>>()?;
    if frames.is_empty() || frames.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(entry.error("must hold frame numbers that rise, at least one"));
    }
    Ok(frames)
}

/// The elements of an array of one for each frame.
fn one_each<'d>(entry: &Entry<'d>, frames: &[f64]) -> Result<Vec<Entry<'d>>, Error> {
    let elements = entry.elements("an array with a value for each of the frames")?;
    if elements.len() != frames.len() {
        return Err(entry.error(format!("has {} values, and there are {} frames", elements.len(), frames.len())));
    }
    Ok(elements)
}

fn numbers(entry: &Entry<'_>, frames: &[f64]) -> Result<Vec<f64>, Error> {
    one_each(entry, frames)?.iter().map(|element| element.number().map(f64::from)).collect()
}

fn value_at(entry: &Entry<'_>, frames: &[f64], how: Interpolation, frame: f64) -> Result<Value, Error> {
    let values: Vec<_> = one_each(entry, frames)?
        .iter()
        .map(|element| {
            let expected = "must be a number, a string, true, false, or an array of them";
            Value::read(element.value()).ok_or_else(|| element.error(expected))
        })
        .collect::<Result<_, _>>()?;
    let between = |values: &[f64]| at(frames, values, how, frame);
    let before = frames.iter().rposition(|&at| at <= frame).unwrap_or(0);
    let found = match how {
        Interpolation::Step => Some(values[before].clone()),
        Interpolation::Linear | Interpolation::Smooth => {
            Value::interpolated(&values.iter().collect::<Vec<_>>(), &between)
        }
    };
    found.ok_or_else(|| {
        entry
            .error("can only be interpolated where they are numbers or arrays of as many; set interpolation = \"step\"")
    })
}

/// The value at a frame of a curve through `values` at `frames`; before and after them, it stays.
fn at(frames: &[f64], values: &[f64], how: Interpolation, frame: f64) -> f64 {
    let last = frames.len() - 1;
    let Some(k) = frames.iter().rposition(|&at| at <= frame) else { return values[0] };
    if k == last || how == Interpolation::Step {
        return values[k];
    }
    let width = frames[k + 1] - frames[k];
    let t = (frame - frames[k]) / width;
    if how == Interpolation::Linear {
        return values[k] + t * (values[k + 1] - values[k]);
    }
    let slope = |k: usize| (values[k + 1] - values[k]) / (frames[k + 1] - frames[k]);
    // The harmonic mean of the slopes on both sides, and level where they turn.
    let tangent = |k: usize| match k {
        0 => slope(0),
        _ if k == last => slope(last - 1),
        _ if slope(k - 1) * slope(k) <= 0.0 => 0.0,
        _ => {
            let (before, after) = (frames[k] - frames[k - 1], frames[k + 1] - frames[k]);
            let share = (before + 2.0 * after) / (3.0 * (before + after));
            1.0 / (share / slope(k - 1) + (1.0 - share) / slope(k))
        }
    };
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * values[k]
        + (t3 - 2.0 * t2 + t) * width * tangent(k)
        + (3.0 * t2 - 2.0 * t3) * values[k + 1]
        + (t3 - t2) * width * tangent(k + 1)
}

/// A TOML value that may change.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    /// A number, and whether it was written as a whole one.
    Number(f64, bool),
    Array(Vec<Value>),
    /// A string or a switch, in TOML.
    Other(String),
}

impl Value {
    fn read(value: &DeValue<'_>) -> Option<Self> {
        match value {
            DeValue::Integer(integer) => {
                let whole = i64::from_str_radix(integer.as_str(), integer.radix()).ok()?;
                Some(Self::Number(whole as f64, true))
            }
            DeValue::Float(float) => Some(Self::Number(float.as_str().parse().ok()?, false)),
            DeValue::Boolean(switch) => Some(Self::Other(switch.to_string())),
            // JSON's strings are TOML's.
            DeValue::String(string) => Some(Self::Other(serde_json::to_string(string.as_ref()).ok()?)),
            DeValue::Array(array) => {
                array.iter().map(|element| Self::read(element.get_ref())).collect::<Option<_>>().map(Self::Array)
            }
            DeValue::Datetime(_) | DeValue::Table(_) => None,
        }
    }

    fn vector(vector: DVec3) -> Self {
        Self::Array(vector.to_array().map(|number| Self::Number(number, false)).into())
    }

    /// What `between` makes of each number of some values of the same shape.
    fn interpolated(values: &[&Self], between: &impl Fn(&[f64]) -> f64) -> Option<Self> {
        match values.first()? {
            Self::Number(..) => {
                let numbers = values.iter().map(|value| match value {
                    Self::Number(number, is_whole) => Some((*number, *is_whole)),
                    _ => None,
                });
                let (numbers, are_whole): (Vec<_>, Vec<_>) = numbers.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                Some(Self::Number(between(&numbers), are_whole.into_iter().all(|whole| whole)))
            }
            Self::Array(first) => {
                let arrays = values.iter().map(|value| match value {
                    Self::Array(elements) if elements.len() == first.len() => Some(elements),
                    _ => None,
                });
                let arrays = arrays.collect::<Option<Vec<_>>>()?;
                let element = |index: usize| {
                    Self::interpolated(&arrays.iter().map(|array| &array[index]).collect::<Vec<_>>(), between)
                };
                (0..first.len()).map(element).collect::<Option<_>>().map(Self::Array)
            }
            Self::Other(_) => None,
        }
    }

    fn to_toml(&self) -> String {
        match self {
            Self::Number(number, true) if number.fract() == 0.0 => format!("{number:.0}"),
            Self::Number(number, _) => format!("{number:?}"),
            Self::Array(elements) => {
                let elements: Vec<_> = elements.iter().map(Self::to_toml).collect();
                format!("[{}]", elements.join(", "))
            }
            Self::Other(text) => text.clone(),
        }
    }
}

/// A point that turns about an axis.
struct Orbit {
    start: DVec3,
    center: DVec3,
    axis: DVec3,
}

impl Orbit {
    fn read(table: &Table<'_>) -> Result<Self, Error> {
        table.allow_only(&["start", "center", "axis"])?;
        let vector = |key| table.require(key, "3 numbers [x, y, z]")?.vector().map(|vector| vector.as_dvec3());
        let axis = match table.get("axis") {
            Some(entry) if entry.vector()?.length() == 0.0 => return Err(entry.error("must not have length 0")),
            Some(entry) => entry.vector()?.as_dvec3().normalize(),
            None => DVec3::Y,
        };
        Ok(Self { start: vector("start")?, center: vector("center")?, axis })
    }

    /// Where it is after a turn of some radians, counter-clockwise seen against the axis.
    fn at(&self, angle: f64) -> DVec3 {
        self.center + DQuat::from_axis_angle(self.axis, angle) * (self.start - self.center)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAMES: [f64; 4] = [1.0, 3.0, 4.0, 8.0];

    #[test]
    fn every_curve_passes_through_its_keyframes_and_stays_beyond() {
        let values = [2.0, 5.0, 5.5, -1.0];
        for how in [Interpolation::Step, Interpolation::Linear, Interpolation::Smooth] {
            for (frame, value) in FRAMES.iter().zip(values) {
                assert_eq!(at(&FRAMES, &values, how, *frame), value, "{how:?}");
            }
            assert_eq!((at(&FRAMES, &values, how, 0.0), at(&FRAMES, &values, how, 99.0)), (2.0, -1.0), "{how:?}");
        }
        assert_eq!(at(&FRAMES, &values, Interpolation::Linear, 2.0), 3.5);
        assert_eq!(at(&FRAMES, &values, Interpolation::Step, 2.9), 2.0);
    }

    #[test]
    fn smooth_curves_have_no_kinks_and_leave_no_range() {
        let values = [0.0, 10.0, 10.0, 0.0];
        let smooth = |frame: f64| at(&FRAMES, &values, Interpolation::Smooth, frame);
        for step in 0..=700 {
            let value = smooth(1.0 + 0.01 * f64::from(step));
            assert!((-1e-12..=10.0 + 1e-12).contains(&value), "{value}");
        }
        for knot in [3.0, 4.0] {
            let (before, after) = (smooth(knot) - smooth(knot - 1e-5), smooth(knot + 1e-5) - smooth(knot));
            assert!((before - after).abs() < 1e-8, "{before} and {after}");
        }
        // A straight line stays one.
        let line = [2.0, 6.0, 8.0, 16.0];
        assert!((at(&FRAMES, &line, Interpolation::Smooth, 5.0) - 10.0).abs() < 1e-12);
    }
}
