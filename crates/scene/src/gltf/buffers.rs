//! The bytes of a file: in the GLB container, in the text itself as data URIs, or in files beside it.

use std::{borrow::Cow, collections::HashMap};

use base64::{
    Engine as _, alphabet,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use gltf_json::Root;
use percent_encoding::percent_decode_str;

use super::{
    fault::{Fault, Result, entry, place},
    meshopt::{self, Decoded},
};
use crate::folder::Folder;

/// Base64 as data URIs have it, with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The buffers of a file.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    buffers: Vec<Cow<'a, [u8]>>,
    /// The views that are stored compressed.
    decoded: HashMap<usize, Decoded>,
}

/// A part of a buffer.
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    /// Bytes from an element to the next, where the file states them.
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// Reads every buffer; `binary` is that of the GLB container.
    pub(super) fn read(root: &'a Root, binary: Option<&'a [u8]>, folder: &Folder) -> Result<Self> {
        let mut buffers = Vec::new();
        for (index, buffer) in root.buffers.iter().enumerate() {
            let place = place("buffers", index, buffer.name.as_deref());
            let stated = buffer.byte_length.0;
            let bytes = match (&buffer.uri, binary) {
                (Some(uri), _) => Cow::Owned(read_uri(uri, folder, stated).map_err(|p| Fault::new(&place, p))?),
                (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
                // Extensions that are not read have buffers without bytes; a view of one is out of range.
                (None, _) => Cow::Borrowed([].as_slice()),
            };
            let has_source = buffer.uri.is_some() || !bytes.is_empty();
            if has_source && (bytes.len() as u64) < stated {
                return Err(Fault::new(
                    place,
                    format!("states {stated} bytes, and there are {}; the file is cut off or damaged", bytes.len()),
                ));
            }
            buffers.push(bytes);
        }
        let mut decoded = HashMap::new();
        for (index, view) in root.buffer_views.iter().enumerate() {
            let place = place("bufferViews", index, view.name.as_deref());
            let extensions = view.extensions.as_ref().map(|extensions| &extensions.others);
            decoded.extend(meshopt::decode(extensions, &buffers, &place)?.map(|decoded| (index, decoded)));
        }
        Ok(Self { root, buffers, decoded })
    }

    /// The part of a buffer that `bufferViews[index]` stands for; `user` names what asks for it.
    pub(super) fn view(&self, index: usize, user: &str) -> Result<View<'_>> {
        let view = entry(&self.root.buffer_views, "bufferViews", index, user)?;
        if let Some(Decoded { bytes, stride }) = self.decoded.get(&index) {
            return Ok(View { bytes, stride: Some(view.byte_stride.map_or(*stride, |stride| stride.0)) });
        }
        let place = place("bufferViews", index, view.name.as_deref());
        let buffer = entry(&self.buffers, "buffers", view.buffer.value(), &place)?;
        let (start, length) = (view.byte_offset.map_or(0, |offset| offset.0), view.byte_length.0);
        let range =
            usize::try_from(start).ok().zip(start.checked_add(length).and_then(|end| usize::try_from(end).ok()));
        let bytes = range.and_then(|(start, end)| buffer.get(start..end)).ok_or_else(|| {
            Fault::new(
                place,
                format!("takes {length} bytes from {start} on, but its buffer has {} bytes", buffer.len()),
            )
        })?;
        Ok(View { bytes, stride: view.byte_stride.map(|stride| stride.0) })
    }
}

/// The bytes that a URI stands for, `most` at most where they are in a file.
pub(super) fn read_uri(uri: &str, folder: &Folder, most: u64) -> std::result::Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, encoded) = data
            .split_once(";base64,")
            .ok_or("has a data URI of another kind than \"data:...;base64,...\", the only one that is read")?;
        return BASE64.decode(encoded).map_err(|error| format!("has a data URI that is no valid base64: {error}"));
    }
    folder.read(&file_name(uri)?, most)
}

/// The name of the file that a URI stands for.
fn file_name(uri: &str) -> std::result::Result<String, String> {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme).filter(|scheme| {
        let is_part = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
        scheme.len() > 1 && scheme.chars().all(is_part)
    });
    if scheme.is_some() {
        let shown = super::fault::shortened(uri);
        return Err(format!(
            "names {shown:?}; only files beside the glTF file are read, nothing is fetched from elsewhere"
        ));
    }
    let name = percent_decode_str(uri).decode_utf8().map_err(|_| format!("names {uri:?}, which is not UTF-8"))?;
    if name.contains('\0') {
        return Err(format!("names {uri:?}, which has a zero byte"));
    }
    Ok(name.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_become_file_names() {
        assert_eq!(file_name("a%20b/c.png").unwrap(), "a b/c.png");
        for elsewhere in ["http://a/b.png", "https://a", "file:///etc/passwd", "ftp:x", "javascript:1"] {
            assert!(file_name(elsewhere).unwrap_err().contains("nothing is fetched"), "{elsewhere}");
        }
        assert!(file_name("a%00").unwrap_err().contains("zero byte"));
        assert!(file_name("%ff").unwrap_err().contains("UTF-8"));
    }
}
