//! Makes glTF files for tests.

#![allow(dead_code, reason = "each test program uses a part")]

use base64::{Engine as _, engine::general_purpose::STANDARD};
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde_json::{Value, json};

/// Corners of a closed tetrahedron's triangles, counter-clockwise from outside.
pub const TETRAHEDRON: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A file in the making: its JSON, and the bytes of its one buffer.
#[derive(Clone)]
pub struct Builder {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Default for Builder {
    fn default() -> Self {
        let json = json!({ "asset": { "version": "2.0" }, "accessors": [], "bufferViews": [] });
        Self { json, bytes: Vec::new() }
    }
}

impl Builder {
    /// A file of one closed mesh, at one node.
    pub fn tetrahedron() -> Self {
        let mut builder = Self::default();
        let positions = builder.floats("VEC3", &TETRAHEDRON);
        let indices = builder.view(&[0u8, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], None);
        let indices =
            builder.accessor(json!({ "bufferView": indices, "componentType": 5121, "count": 12, "type": "SCALAR" }));
        builder.json["meshes"] =
            json!([{ "primitives": [{ "attributes": { "POSITION": positions }, "indices": indices }] }]);
        builder.json["nodes"] = json!([{ "mesh": 0 }]);
        builder
    }

    /// Adds bytes and a view of them; returns the view's index.
    pub fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        push(&mut self.json["bufferViews"], view)
    }

    /// Adds an accessor; returns its index.
    pub fn accessor(&mut self, accessor: Value) -> usize {
        push(&mut self.json["accessors"], accessor)
    }

    /// Adds floats and an accessor of them; returns its index.
    pub fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let components = match kind {
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 1,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let view = self.view(&bytes, None);
        let count = numbers.len() / components;
        self.accessor(json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind }))
    }

    /// Adds a picture, and a texture of it.
    pub fn add_picture(&mut self, file: &[u8]) {
        let view = self.view(file, None);
        self.json["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
        self.json["textures"] = json!([{ "source": 0 }]);
    }

    /// The file as GLB.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        glb(json.to_string().as_bytes(), &self.bytes)
    }

    /// The file as text with its buffer in a data URI.
    pub fn gltf(&self) -> Vec<u8> {
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes));
        self.gltf_with_uri(&uri)
    }

    /// The file as text with its buffer elsewhere.
    pub fn gltf_with_uri(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.bytes.len(), "uri": uri }]);
        json.to_string().into_bytes()
    }
}

/// A GLB container of JSON and bytes.
pub fn glb(json: &[u8], bytes: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + bytes.len();
    let word = |number: usize| (number as u32).to_le_bytes();
    [
        b"glTF".as_slice(),
        &word(2),
        &word(length),
        &word(json.len()),
        b"JSON",
        &json,
        &word(bytes.len()),
        b"BIN\0",
        bytes,
    ]
    .concat()
}

/// A PNG file of one colour with coverage.
pub fn png(width: u32, height: u32, texel: [u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let texels = texel.repeat(width as usize * height as usize);
    PngEncoder::new(&mut bytes).write_image(&texels, width, height, ExtendedColorType::Rgba8).unwrap();
    bytes
}

/// A PNG file of a row of texels.
pub fn png_of(width: u32, texels: &[[u8; 4]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let height = texels.len() as u32 / width;
    PngEncoder::new(&mut bytes).write_image(texels.as_flattened(), width, height, ExtendedColorType::Rgba8).unwrap();
    bytes
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}
