//! Checks of single values, whose errors name the part of the scene.

use std::{
    collections::HashMap,
    fmt::Display,
    ops::{Bound, RangeBounds},
};

use glam::Vec3;

use crate::{Error, Subject};

/// The greatest coordinate, metres: areas of triangles within it, and their squares, are finite in single precision.
const GREATEST_COORDINATE: f32 = 1e9;

/// What is right of a position.
pub(super) const REACH: &str = "each number must be finite and at most 1e9 in size";

pub(super) fn is_in_reach(position: Vec3) -> bool {
    position.abs().cmple(Vec3::splat(GREATEST_COORDINATE)).all()
}

/// The numbers greater than a bound.
pub(super) fn above(bound: f32) -> (Bound<f32>, Bound<f32>) {
    (Bound::Excluded(bound), Bound::Unbounded)
}

/// The part of the scene under check.
pub(super) struct At(pub(super) Subject);

impl At {
    pub(super) fn error(&self, key: &'static str, problem: String) -> Error {
        Error::Invalid { at: None, subject: self.0.clone(), key, problem }
    }

    pub(super) fn require(&self, ok: bool, key: &'static str, problem: impl FnOnce() -> String) -> Result<(), Error> {
        if ok { Ok(()) } else { Err(self.error(key, problem())) }
    }

    /// Refuses numbers out of range, and infinity and NaN in any range.
    pub(super) fn number<T>(
        &self,
        key: &'static str,
        number: T,
        allowed: impl RangeBounds<T>,
        right: &str,
    ) -> Result<(), Error>
    where
        T: PartialOrd + Copy + Display + Into<f64>,
    {
        let is_right = number.into().is_finite() && allowed.contains(&number);
        self.require(is_right, key, || format!("is {number}; it must be {right}"))
    }

    /// Refuses colours with a channel out of range, infinite or NaN.
    pub(super) fn channels(
        &self,
        key: &'static str,
        color: Vec3,
        allowed: impl RangeBounds<f32>,
        right: &str,
    ) -> Result<(), Error> {
        let is_right = color.is_finite() && color.to_array().iter().all(|channel| allowed.contains(channel));
        self.require(is_right, key, || format!("is {color}; each channel must be {right}"))
    }

    pub(super) fn position(&self, key: &'static str, position: Vec3) -> Result<(), Error> {
        self.require(is_in_reach(position), key, || format!("is {:?}; {REACH}", position.to_array()))
    }

    /// Refuses what has no direction: vectors of zero, extreme or no length.
    pub(super) fn direction(&self, key: &'static str, direction: Vec3) -> Result<(), Error> {
        self.require(direction.try_normalize().is_some(), key, || {
            format!("is {direction}, which has no direction; it must be a vector such as [0, 1, 0]")
        })
    }

    /// Refuses an empty name and one that an earlier entry of the list has.
    pub(super) fn unique_name<'n>(
        &self,
        names: &mut HashMap<&'n str, usize>,
        index: usize,
        name: &'n str,
    ) -> Result<(), Error> {
        self.require(!name.is_empty(), "name", || "is empty; it must have a letter at least".to_owned())?;
        match names.insert(name, index) {
            Some(earlier) => {
                let (first, second) = (earlier + 1, index + 1);
                Err(self.error("name", format!("is given to numbers {first} and {second}; names must differ")))
            }
            None => Ok(()),
        }
    }
}
