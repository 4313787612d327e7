//! EXT_meshopt_compression: views of buffers that are stored compressed, decoded as the extension's text defines.
//!
//! The crate `meshopt` wraps the library's C++ code; this is the part of it that reads, in safe Rust.

mod attributes;
mod filters;
mod indices;

use std::borrow::Cow;

use serde_json::{Map, Value};

use super::fault::{Fault, Result, entry};

const EXTENSION: &str = "EXT_meshopt_compression";

/// Decoded bytes to a byte of a stream, at most: 16 elements of a byte each have 2 bits at least.
const MOST_EXPANSION: usize = 64;

/// A decoded view.
pub(super) struct Decoded {
    pub(super) bytes: Vec<u8>,
    pub(super) stride: usize,
}

/// Decodes a view whose extensions say that it is compressed; none of other views.
pub(super) fn decode(
    extensions: Option<&Map<String, Value>>,
    buffers: &[Cow<'_, [u8]>],
    place: &str,
) -> Result<Option<Decoded>> {
    let Some(extension) = extensions.and_then(|extensions| extensions.get(EXTENSION)) else { return Ok(None) };
    let fault = |problem: String| Fault::new(place, format!("has an {EXTENSION} {problem}"));
    let whole = |key: &str, default: Option<usize>| {
        let number = extension.get(key).map_or(Some(default), |value| value.as_u64().map(|n| usize::try_from(n).ok()));
        number.flatten().ok_or_else(|| fault(format!("whose {key} is missing or no whole number")))
    };
    let (offset, length) = (whole("byteOffset", Some(0))?, whole("byteLength", None)?);
    let (stride, count) = (whole("byteStride", None)?, whole("count", None)?);
    let buffer = entry(buffers, "buffers", whole("buffer", None)?, place)?;
    let stream = offset.checked_add(length).and_then(|end| buffer.get(offset..end));
    let stream = stream.ok_or_else(|| fault(format!("of {length} bytes from {offset} on, beyond its buffer")))?;
    let size = count.checked_mul(stride).filter(|size| size / MOST_EXPANSION <= length);
    size.ok_or_else(|| {
        fault(format!("of {count} elements of {stride} bytes, more than {length} bytes can stand for"))
    })?;
    let word = |key: &str, default: &'static str| {
        extension
            .get(key)
            .map_or(Ok(default), |value| value.as_str().ok_or_else(|| fault(format!("whose {key} is no text"))))
    };
    let (mode, filter) = (word("mode", "")?, word("filter", "NONE")?);
    let damaged = || fault("whose stream is damaged or cut off".to_owned());
    let mut bytes = match mode {
        "ATTRIBUTES" if stride.is_multiple_of(4) && (4..=256).contains(&stride) => {
            attributes::decode(stream, count, stride).ok_or_else(damaged)?
        }
        "TRIANGLES" if [2, 4].contains(&stride) && count.is_multiple_of(3) => {
            packed(&indices::decode_triangles(stream, count).ok_or_else(damaged)?, stride)
        }
        "INDICES" if [2, 4].contains(&stride) => {
            packed(&indices::decode_sequence(stream, count).ok_or_else(damaged)?, stride)
        }
        _ => {
            return Err(fault(format!(
                "of the mode {mode:?} with {count} elements of {stride} bytes, which is not allowed"
            )));
        }
    };
    match (mode, filter, stride) {
        (_, "NONE", _) => {}
        ("ATTRIBUTES", "OCTAHEDRAL", 4) => filters::octahedral_8(&mut bytes),
        ("ATTRIBUTES", "OCTAHEDRAL", 8) => filters::octahedral_16(&mut bytes),
        ("ATTRIBUTES", "QUATERNION", 8) => filters::quaternion(&mut bytes),
        ("ATTRIBUTES", "EXPONENTIAL", _) => filters::exponential(&mut bytes),
        _ => {
            return Err(fault(format!(
                "with the filter {filter:?} on elements of {stride} bytes, which is not allowed"
            )));
        }
    }
    Ok(Some(Decoded { bytes, stride }))
}

/// Indices as numbers of 2 or 4 bytes.
fn packed(indices: &[u32], stride: usize) -> Vec<u8> {
    indices.iter().flat_map(|index| index.to_le_bytes().into_iter().take(stride)).collect()
}
