//! What is read of PLY's elements.

use glam::{Vec2, Vec3};
use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType};

use crate::texture_image::linear_from_srgb;

const TEXTURE_COORDINATES: [[&str; 2]; 4] =
    [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];
const FACE_INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// An element that is passed over.
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

/// A vertex.
pub(super) struct Vertex {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) uv: Vec2,
    /// Linear.
    pub(super) color: Vec3,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self { position: Vec3::ZERO, normal: Vec3::ZERO, uv: Vec2::ZERO, color: Vec3::ONE }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(number) = property.to_f32_lossy() else { return PropertyAccessResult::Ignored };
        let place = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            "nx" => &mut self.normal.x,
            "ny" => &mut self.normal.y,
            "nz" => &mut self.normal.z,
            "red" => return set_channel(&mut self.color.x, &property, number),
            "green" => return set_channel(&mut self.color.y, &property, number),
            "blue" => return set_channel(&mut self.color.z, &property, number),
            _ if TEXTURE_COORDINATES.iter().any(|[u, _]| *u == name) => &mut self.uv.x,
            _ if TEXTURE_COORDINATES.iter().any(|[_, v]| *v == name) => &mut self.uv.y,
            _ => return PropertyAccessResult::Ignored,
        };
        *place = number;
        PropertyAccessResult::Set
    }
}

/// A channel of a colour: bytes are sRGB, other numbers linear.
fn set_channel(channel: &mut f32, property: &Property, number: f32) -> PropertyAccessResult {
    *channel = match property {
        Property::UChar(byte) => linear_from_srgb(f64::from(*byte) / 255.0) as f32,
        _ => number.clamp(0.0, 1.0),
    };
    PropertyAccessResult::Set
}

/// The vertices of a face, in order; `u32::MAX` stands for what is no index.
pub(super) struct Face(pub(super) Vec<u32>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !FACE_INDICES.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        let index = |number: i64| u32::try_from(number).unwrap_or(u32::MAX);
        self.0 = match property {
            Property::ListChar(list) => list.into_iter().map(|number| index(number.into())).collect(),
            Property::ListUChar(list) => list.into_iter().map(u32::from).collect(),
            Property::ListShort(list) => list.into_iter().map(|number| index(number.into())).collect(),
            Property::ListUShort(list) => list.into_iter().map(u32::from).collect(),
            Property::ListInt(list) => list.into_iter().map(|number| index(number.into())).collect(),
            Property::ListUInt(list) => list,
            _ => return PropertyAccessResult::Ignored,
        };
        PropertyAccessResult::Set
    }
}

/// Whether vertices have normals, texture coordinates and colours.
pub(super) fn properties_of_vertices(element: &ElementDef) -> Result<[bool; 3], String> {
    let is_number = |name: &&str| {
        element.properties.get(*name).is_some_and(|property| matches!(property.data_type, PropertyType::Scalar(_)))
    };
    let has_all = |names: &[&str]| names.iter().all(&is_number);
    if let Some(name) = ["x", "y", "z"].iter().find(|name| !is_number(name)) {
        return Err(format!("has vertices without the property {name:?}"));
    }
    let has_uvs = TEXTURE_COORDINATES.iter().any(|names| has_all(names));
    Ok([has_all(&["nx", "ny", "nz"]), has_uvs, has_all(&["red", "green", "blue"])])
}

/// Refuses faces that do not list their vertices.
pub(super) fn face_indices(element: &ElementDef) -> Result<(), String> {
    let is_list = |name: &&str| {
        element.properties.get(*name).is_some_and(|property| matches!(property.data_type, PropertyType::List(..)))
    };
    if FACE_INDICES.iter().any(is_list) {
        return Ok(());
    }
    Err("has faces without the list \"vertex_indices\"".to_owned())
}
