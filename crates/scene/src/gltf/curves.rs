//! Key frames of animations, and what is between them.

use glam::{Quat, Vec3};
use gltf_json::{
    Root,
    accessor::Type,
    animation::{Interpolation, Sampler},
    validation::Checked,
};

use super::{
    accessors::Accessor,
    buffers::Buffers,
    fault::{Fault, Result, entry},
};

/// The most key frames of an animation, over all its channels.
const MOST_KEYS: usize = 1 << 24;
/// The most numbers of a key frame: as many as a mesh may have morph targets.
const MOST_NUMBERS: usize = 1 << 16;

/// Counts the key frames of an animation.
pub(super) struct KeysLeft(usize);

impl KeysLeft {
    pub(super) fn all() -> Self {
        Self(MOST_KEYS)
    }

    /// Takes those of a channel.
    pub(super) fn take(&mut self, root: &Root, sampler: &Sampler, place: &str) -> Result<()> {
        let keys = entry(&root.accessors, "accessors", sampler.input.value(), place)?.count.0;
        let left = usize::try_from(keys).ok().and_then(|keys| self.0.checked_sub(keys));
        self.0 = left.ok_or_else(|| {
            let problem = format!("brings the animation to more than {MOST_KEYS} key frames, the most that are read");
            Fault::new(place, problem)
        })?;
        Ok(())
    }
}

/// Reads the key frames of a channel.
pub(super) struct CurveReader<'a, 'b> {
    pub(super) root: &'a Root,
    pub(super) buffers: &'a Buffers<'b>,
    pub(super) sampler: &'a Sampler,
    pub(super) place: &'a str,
}

impl<'a> CurveReader<'a, '_> {
    /// The key frames, of values of one kind.
    pub(super) fn curve(&self, kind: Type) -> Result<Curve<'a>> {
        let Self { root, buffers, sampler, place } = *self;
        let Checked::Valid(interpolation) = sampler.interpolation else {
            return Err(Fault::new(place, "has an unknown interpolation; it must be LINEAR, STEP or CUBICSPLINE"));
        };
        let input = Accessor::new(root, buffers, sampler.input.value(), Type::Scalar, place)?;
        let values = Accessor::new(root, buffers, sampler.output.value(), kind, place)?;
        let times: Vec<f32> = (0..input.count).map(|index| input.numbers::<1>(index)[0]).collect();
        if times.is_empty() || !times.iter().all(|time| time.is_finite()) || !times.is_sorted_by(|a, b| a < b) {
            return Err(Fault::new(&input.place, "has times of an animation that do not rise, or none"));
        }
        let values_per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let keys = times.len().saturating_mul(values_per_key);
        let elements = values.count / keys;
        let is_right = elements.checked_mul(keys) == Some(values.count) && (1..=MOST_NUMBERS).contains(&elements);
        if !is_right || kind != Type::Scalar && elements != 1 {
            let (count, times) = (values.count, times.len());
            return Err(Fault::new(
                place,
                format!("has {count} values for {times} key frames, which do not go together"),
            ));
        }
        Ok(Curve { place, interpolation, times, values, elements, kind })
    }
}

/// The key frames of a channel.
pub(super) struct Curve<'a> {
    place: &'a str,
    interpolation: Interpolation,
    /// Seconds, rising.
    times: Vec<f32>,
    values: Accessor<'a>,
    /// Elements of `values` that make up a value.
    elements: usize,
    kind: Type,
}

/// A stretch between two key frames: their indices, how far along it is from 0 to 1, and its length in seconds.
struct Stretch {
    from: usize,
    to: usize,
    part: f32,
    seconds: f32,
}

impl Curve<'_> {
    fn stretch(&self, time: f32) -> Stretch {
        let after = self.times.partition_point(|key| *key <= time);
        let last = self.times.len() - 1;
        let (from, to) = (after.saturating_sub(1), after.min(last));
        let seconds = self.times[to] - self.times[from];
        let part = if seconds > 0.0 { ((time - self.times[from]) / seconds).clamp(0.0, 1.0) } else { 0.0 };
        Stretch { from, to, part, seconds }
    }

    /// The numbers of one element.
    fn element(&self, index: usize) -> Vec<f32> {
        match self.kind {
            Type::Scalar => self.values.numbers::<1>(index).to_vec(),
            Type::Vec2 => self.values.numbers::<2>(index).to_vec(),
            Type::Vec3 => self.values.numbers::<3>(index).to_vec(),
            _ => self.values.numbers::<4>(index).to_vec(),
        }
    }

    /// The numbers of key frame `key`; of a spline `which` is 0 for the tangent before, 1 for the value, 2 for the tangent after.
    fn key(&self, key: usize, which: usize) -> Vec<f32> {
        let first = match self.interpolation {
            Interpolation::CubicSpline => (3 * key + which) * self.elements,
            _ => key * self.elements,
        };
        (first..first + self.elements).flat_map(|index| self.element(index)).collect()
    }

    /// The numbers at a time, before and after the key frames those of the first and last.
    pub(super) fn numbers(&self, time: f32) -> Result<Vec<f32>> {
        let Stretch { from, to, part: s, seconds } = self.stretch(time);
        let (before, after) = (self.key(from, 1), self.key(to, 1));
        let pairs = before.iter().zip(&after);
        let numbers: Vec<f32> = match self.interpolation {
            Interpolation::Step => {
                if s == 1.0 {
                    after
                } else {
                    before
                }
            }
            Interpolation::Linear => pairs.map(|(a, b)| (1.0 - s) * a + s * b).collect(),
            // glTF 2.0, appendix C: Hermite's polynomials, of tangents per second.
            Interpolation::CubicSpline => {
                let tangents = self.key(from, 2).into_iter().zip(self.key(to, 0));
                let (s2, s3) = (s * s, s * s * s);
                let at = |((a, b), (leaving, arriving)): ((&f32, &f32), (f32, f32))| {
                    (2.0 * s3 - 3.0 * s2 + 1.0) * a
                        + seconds * (s3 - 2.0 * s2 + s) * leaving
                        + (3.0 * s2 - 2.0 * s3) * b
                        + seconds * (s3 - s2) * arriving
                };
                pairs.zip(tangents).map(at).collect()
            }
        };
        if numbers.iter().all(|number| number.is_finite()) {
            return Ok(numbers);
        }
        Err(Fault::new(self.place, format!("has a value that is not finite at {time} s")))
    }

    pub(super) fn vector(&self, time: f32) -> Result<Vec3> {
        Ok(Vec3::from_slice(&self.numbers(time)?))
    }

    pub(super) fn rotation(&self, time: f32) -> Result<Quat> {
        let rotation = match self.interpolation {
            Interpolation::Linear => {
                let Stretch { from, to, part, .. } = self.stretch(time);
                let [a, b] = [from, to].map(|key| Quat::from_slice(&self.key(key, 1)).normalize());
                a.slerp(b, part)
            }
            _ => Quat::from_slice(&self.numbers(time)?).normalize(),
        };
        if rotation.is_finite() {
            return Ok(rotation);
        }
        Err(Fault::new(self.place, format!("has a rotation without a length at {time} s")))
    }
}
