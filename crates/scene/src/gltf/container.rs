//! The two forms of a glTF file: JSON, or JSON and bytes in a GLB container; versions and extensions.

use std::borrow::Cow;

use gltf_json::Root;

use super::{
    fault::{Fault, Result},
    pointers::{self, Pointers},
};

/// The most JSON objects of a file: each takes some hundred bytes in memory.
const MOST_JSON_OBJECTS: usize = 4_000_000;

/// Extensions that are read in full, or in which nothing is lost when they are passed over.
pub(super) const SUPPORTED: [&str; 15] = [
    pointers::EXTENSION,
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
];

/// The parts of a file.
#[derive(Debug)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// The bytes that the first buffer holds, in a GLB file that has some.
    pub(super) binary: Option<&'a [u8]>,
}

/// Tells JSON from GLB, and splits the latter.
pub(super) fn split(bytes: &[u8]) -> Result<Container<'_>> {
    const HEADER: usize = 12;
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return Ok(Container { json: bytes, binary: None });
    };
    let cut_off = |what: &str| Fault::of_file(format!("the file is cut off: it ends within {what}"));
    let [version, length] = words(rest).ok_or_else(|| cut_off("its header"))?;
    if version != 2 {
        return Err(Fault::of_file(format!("is GLB of version {version}; version 2 is read")));
    }
    let length = length as usize;
    if length < HEADER || length > bytes.len() {
        return Err(Fault::of_file(format!(
            "the file is cut off or damaged: its header states {length} bytes, and there are {}",
            bytes.len()
        )));
    }
    let mut chunks = bytes[HEADER..length].as_ref();
    let mut container = Container { json: &[], binary: None };
    for number in 0.. {
        let Some([length, kind]) = words(chunks) else { break };
        let end = (length as usize).saturating_add(8);
        let chunk = chunks.get(8..end).ok_or_else(|| cut_off(&format!("its chunk {number} of {length} bytes")))?;
        match (number, &kind.to_le_bytes()) {
            (0, b"JSON") => container.json = chunk,
            (0, _) => return Err(Fault::of_file("the file's first chunk is not JSON, as that of a GLB file is")),
            (1, b"BIN\0") => container.binary = Some(chunk),
            _ => {}
        }
        chunks = &chunks[end..];
    }
    if container.json.is_empty() {
        return Err(cut_off("its JSON"));
    }
    Ok(container)
}

/// The first two little-endian numbers.
fn words(bytes: &[u8]) -> Option<[u32; 2]> {
    let (words, _) = bytes.as_chunks::<4>();
    Some([u32::from_le_bytes(*words.first()?), u32::from_le_bytes(*words.get(1)?)])
}

/// The lists of the file, and what its animations point at elsewhere.
pub(super) fn parse(json: &[u8]) -> Result<(Root, Pointers)> {
    let objects = json.iter().filter(|byte| **byte == b'{').count();
    if objects > MOST_JSON_OBJECTS {
        return Err(Fault::of_file(format!("has {objects} JSON objects; at most {MOST_JSON_OBJECTS} are read")));
    }
    // Some files begin with a byte-order mark.
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let (pointers, json) = match Pointers::take(json) {
        Some((pointers, json)) => (pointers, Cow::Owned(json)),
        None => (Pointers::default(), Cow::Borrowed(json)),
    };
    let root = Root::from_slice(&json).map_err(|error| Fault::of_file(format!("is not valid glTF: {error}")))?;
    let version = &root.asset.version;
    let needed = root.asset.min_version.as_ref().unwrap_or(version);
    if !version.starts_with("2.") || !matches!(needed.as_str(), "2.0" | "2.1") && root.asset.min_version.is_some() {
        return Err(Fault::new("asset", format!("is of glTF version {needed}; version 2.0 is read")));
    }
    Ok((root, pointers))
}

/// Refuses what is required and not read; returns the names of the extensions that are used and not read.
pub(super) fn check_extensions(root: &Root) -> Result<Vec<&str>> {
    let is_unknown = |name: &&String| !SUPPORTED.contains(&name.as_str());
    if let Some(name) = root.extensions_required.iter().find(is_unknown) {
        let advice = match name.as_str() {
            "KHR_draco_mesh_compression" | "KHR_meshopt_compression" => "export it without compressed meshes",
            "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => {
                "export it with PNG or JPEG pictures"
            }
            _ => "export it without",
        };
        return Err(Fault::new("extensionsRequired", format!("names {name}, which is not supported; {advice}")));
    }
    Ok(root.extensions_used.iter().filter(is_unknown).map(String::as_str).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(version: u32, length: u32, chunks: &[(&[u8; 4], u32, &[u8])]) -> Vec<u8> {
        let mut bytes = [b"glTF".as_slice(), &version.to_le_bytes(), &length.to_le_bytes()].concat();
        for (kind, length, content) in chunks {
            bytes.extend([&length.to_le_bytes(), kind.as_slice(), content].concat());
        }
        bytes
    }

    #[test]
    fn chunks_are_found() {
        let bytes = glb(2, 36, &[(b"JSON", 4, b"{}  "), (b"BIN\0", 4, b"abcd")]);
        let container = split(&bytes).unwrap();
        assert_eq!((container.json, container.binary), (b"{}  ".as_slice(), Some(b"abcd".as_slice())));
        assert_eq!(split(b"{}").unwrap().json, b"{}");
    }

    #[test]
    fn damaged_containers_are_refused() {
        for (bytes, text) in [
            (b"glTF".to_vec(), "cut off"),
            (glb(1, 12, &[]), "version 1"),
            (glb(2, 0, &[]), "states 0 bytes"),
            (glb(2, u32::MAX, &[]), "states 4294967295 bytes, and there are 12"),
            (glb(2, 12, &[]), "within its JSON"),
            (glb(2, 24, &[(b"JSON", u32::MAX, b"{}  ")]), "within its chunk 0 of 4294967295 bytes"),
            (glb(2, 24, &[(b"BIN\0", 4, b"abcd")]), "first chunk is not JSON"),
        ] {
            let message = split(&bytes).unwrap_err().error("a.glb".as_ref()).to_string();
            assert!(message.contains(text), "{message}");
        }
    }
}
