//! What the bits of a render depend on, part by part, so that a saved state can tell whether it is of the same.

use std::hash::Hasher as _;

use bytemuck::Pod;
use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher13;

/// What a render depends on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Fingerprint(Vec<Part>);

/// One thing that it depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Part {
    name: String,
    /// What can be said of it in words; else a digest.
    text: Option<String>,
    digest: Option<String>,
}

/// A difference between two fingerprints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Difference {
    /// What differs.
    pub name: String,
    /// What the first says, if that can be said in words.
    pub first: Option<String>,
    /// What the second says.
    pub second: Option<String>,
}

impl Fingerprint {
    /// Adds something that can be said in words.
    pub fn say(&mut self, name: &str, text: impl ToString) {
        self.0.push(Part { name: name.to_owned(), text: Some(text.to_string()), digest: None });
    }

    /// Adds records.
    pub fn digest<T: Pod>(&mut self, name: &str, records: &[T]) {
        let digest = digest_of([bytemuck::cast_slice(records)]);
        self.0.push(Part { name: name.to_owned(), text: None, digest: Some(format!("{digest:016x}")) });
    }

    /// Adds all that another has.
    pub fn extend(&mut self, other: &Self) {
        self.0.extend_from_slice(&other.0);
    }

    /// The first part in which another differs.
    pub fn difference(&self, other: &Self) -> Option<Difference> {
        let count = self.0.len().max(other.0.len());
        let (first, second) =
            (0..count).map(|number| (self.0.get(number), other.0.get(number))).find(|(a, b)| a != b)?;
        let text = |part: Option<&Part>| part.and_then(|part| part.text.clone());
        let name = first.or(second).map(|part| part.name.clone()).unwrap_or_default();
        Some(Difference { name, first: text(first), second: text(second) })
    }
}

/// A digest of 64 bits of some pieces one after the other: the same on every machine and in every version.
pub(crate) fn digest_of<'p>(pieces: impl IntoIterator<Item = &'p [u8]>) -> u64 {
    let mut hasher = SipHasher13::new();
    pieces.into_iter().for_each(|piece| hasher.write(piece));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fingerprint(seed: u32, records: &[u32]) -> Fingerprint {
        let mut fingerprint = Fingerprint::default();
        fingerprint.say("seed", seed);
        fingerprint.digest("materials", records);
        fingerprint
    }

    #[test]
    fn the_first_difference_is_named() {
        let one = fingerprint(1, &[1, 2]);
        assert_eq!(one.difference(&fingerprint(1, &[1, 2])), None);
        let seeds = one.difference(&fingerprint(2, &[1])).unwrap();
        assert_eq!(
            (seeds.name.as_str(), seeds.first.as_deref(), seeds.second.as_deref()),
            ("seed", Some("1"), Some("2"))
        );
        let records = one.difference(&fingerprint(1, &[1, 3])).unwrap();
        assert_eq!((records.name.as_str(), records.first, records.second), ("materials", None, None));
        assert_eq!(one.difference(&Fingerprint::default()).unwrap().name, "seed");
    }

    #[test]
    fn digests_do_not_depend_on_pieces_and_stay_the_same() {
        assert_eq!(digest_of([&b"ab"[..], b"c"]), digest_of([&b"abc"[..]]));
        assert_ne!(digest_of([&b"abc"[..]]), digest_of([&b"abd"[..]]));
        // SipHash-1-3 with a key of zeros: files of other machines are read by it.
        assert_eq!(digest_of([&b""[..]]), 0xd1fb_a762_150c_532c);
    }
}
