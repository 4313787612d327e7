//! Triangles of a primitive: lists, strips and fans, indexed or not.

use glam::{Vec3, Vec4};
use gltf_json::{
    Root,
    accessor::Type,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked,
};

use super::{
    accessors::Accessor,
    buffers::Buffers,
    fault::{Fault, Result},
};

/// What a primitive's triangles are made of.
pub(super) struct Corners<'a> {
    pub(super) positions: Accessor<'a>,
    pub(super) normals: Option<Accessor<'a>>,
    pub(super) uvs: Option<Accessor<'a>>,
    /// The second set of texture coordinates, which may serve as an energy map.
    pub(super) map_uvs: Option<Accessor<'a>>,
    /// Factors on the material's colour, with coverage.
    pub(super) colors: Option<Colors<'a>>,
    /// Tangents, on surfaces with normals and a normal map alone.
    pub(super) tangents: Option<Accessor<'a>>,
    /// What the material asks of it.
    pub(super) needs: Needs,
    /// Vertices of each triangle, all of which are in range.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// What a material asks of the corners of its triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Needs {
    /// The set of texture coordinates on which its pictures lie, if it has any.
    pub(super) uv_set: Option<u32>,
    /// Whether a normal map is among them.
    pub(super) has_normal_map: bool,
    /// Whether coverage makes holes, by its alphaMode.
    pub(super) has_coverage: bool,
}

/// COLOR_0, of three or four channels.
pub(super) enum Colors<'a> {
    Opaque(Accessor<'a>),
    WithAlpha(Accessor<'a>),
}

impl<'a> Colors<'a> {
    fn read(
        root: &Root,
        buffers: &'a Buffers<'_>,
        primitive: &Primitive,
        vertices: usize,
        place: &str,
    ) -> Result<Option<Self>> {
        let index = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0)));
        let accessor = index.and_then(|index| root.accessors.get(index.value()));
        let has_alpha = accessor.is_some_and(|accessor| accessor.type_ == Checked::Valid(Type::Vec4));
        let kind = if has_alpha { Type::Vec4 } else { Type::Vec3 };
        let read = attribute(root, buffers, primitive, (Semantic::Colors(0), kind), vertices, place)?;
        Ok(read.map(if has_alpha { Self::WithAlpha } else { Self::Opaque }))
    }

    /// Colour and coverage of a vertex, held to 0 … 1 as the format asks.
    pub(super) fn at(&self, vertex: usize) -> Vec4 {
        let color = match self {
            Self::Opaque(accessor) => Vec3::from(accessor.numbers(vertex)).extend(1.0),
            Self::WithAlpha(accessor) => Vec4::from(accessor.numbers(vertex)),
        };
        color.clamp(Vec4::ZERO, Vec4::ONE)
    }
}

/// The accessor of an attribute, which must have as many elements as there are vertices.
pub(super) fn attribute<'a>(
    root: &Root,
    buffers: &'a Buffers<'_>,
    primitive: &Primitive,
    (semantic, kind): (Semantic, Type),
    vertices: usize,
    place: &str,
) -> Result<Option<Accessor<'a>>> {
    let name = semantic.to_string();
    let Some(index) = primitive.attributes.get(&Checked::Valid(semantic)) else { return Ok(None) };
    let accessor = Accessor::new(root, buffers, index.value(), kind, &format!("{place}.{name}"))?;
    if accessor.count < vertices {
        let count = accessor.count;
        return Err(Fault::new(place, format!("has {vertices} positions, but {count} elements of {name}")));
    }
    Ok(Some(accessor))
}

impl<'a> Corners<'a> {
    /// Reads a primitive with what its material needs; none for points and lines.
    pub(super) fn read(
        root: &Root,
        buffers: &'a Buffers<'_>,
        primitive: &Primitive,
        needs: Needs,
        place: &str,
    ) -> Result<Option<Self>> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(Fault::new(place, "has an unknown mode; it must be from 0 to 6"));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            return Ok(None);
        }
        let find = |semantic, kind, vertices| attribute(root, buffers, primitive, (semantic, kind), vertices, place);
        let positions = find(Semantic::Positions, Type::Vec3, 0)?.ok_or_else(|| no_positions(primitive, place))?;
        let vertices = positions.count;
        if vertices >= u32::MAX as usize {
            return Err(Fault::new(place, format!("has {vertices} vertices; it must have fewer than 2^32")));
        }
        let indices = primitive.indices.map(|index| index_accessor(root, buffers, index.value(), place)).transpose()?;
        let count = indices.as_ref().map_or(vertices, |indices| indices.count);
        let index = |at: usize| indices.as_ref().map_or(at as u32, |indices| indices.whole(at));
        if let Some(at) = (0..count).find(|at| index(*at) as usize >= vertices) {
            let problem = format!("has the index {} at {at}, but {place} has {vertices} vertices, from 0", index(at));
            return Err(Fault::new(indices.as_ref().map_or(place, |indices| &indices.place), problem));
        }
        let normals = find(Semantic::Normals, Type::Vec3, vertices)?;
        // Without normals the format has none of the tangents either.
        let takes_tangents = needs.has_normal_map && normals.is_some();
        let tangents = takes_tangents.then(|| find(Semantic::Tangents, Type::Vec4, vertices));
        Ok(Some(Self {
            normals,
            tangents: tangents.transpose()?.flatten(),
            uvs: find(Semantic::TexCoords(needs.uv_set.unwrap_or(0)), Type::Vec2, vertices)?,
            map_uvs: find(Semantic::TexCoords(1), Type::Vec2, vertices)?,
            colors: Colors::read(root, buffers, primitive, vertices, place)?,
            needs,
            positions,
            triangles: triangles(mode, count, index, place)?,
        }))
    }
}

fn no_positions(primitive: &Primitive, place: &str) -> Fault {
    let extensions = primitive.extensions.iter().flat_map(|extensions| extensions.others.keys());
    let names: Vec<_> = extensions.map(String::as_str).collect();
    let which = if names.is_empty() { String::new() } else { format!(" (its extensions: {})", names.join(", ")) };
    Fault::new(place, format!("has no POSITION{which}; a primitive must have positions"))
}

fn index_accessor<'a>(root: &Root, buffers: &'a Buffers<'_>, index: usize, place: &str) -> Result<Accessor<'a>> {
    let accessor = Accessor::new(root, buffers, index, Type::Scalar, &format!("{place}.indices"))?;
    if !accessor.is_unsigned() {
        return Err(Fault::new(&accessor.place, "is used as indices; its componentType must be 5121, 5123 or 5125"));
    }
    Ok(accessor)
}

/// The triangles that the `count` indices of a list, strip or fan stand for.
fn triangles(mode: Mode, count: usize, index: impl Fn(usize) -> u32, place: &str) -> Result<Vec<[u32; 3]>> {
    let is_proper = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let in_order = |places: [usize; 3]| places.map(&index);
    let beyond_two = 0..count.saturating_sub(2);
    Ok(match mode {
        // Triangles without area join the parts of a strip.
        Mode::TriangleStrip => {
            let triangle = |at: usize| in_order([at, at + 1 + at % 2, at + 2 - at % 2]);
            beyond_two.map(triangle).filter(is_proper).collect()
        }
        Mode::TriangleFan => beyond_two.map(|at| in_order([at + 1, at + 2, 0])).filter(is_proper).collect(),
        _ if !count.is_multiple_of(3) => {
            return Err(Fault::new(place, format!("has {count} corners of triangles; they must be a multiple of 3")));
        }
        _ => (0..count / 3).map(|triangle| in_order([0, 1, 2].map(|corner| 3 * triangle + corner))).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let read = |mode, indices: &[u32]| triangles(mode, indices.len(), |at| indices[at], "meshes[0]");
        let indices = [0, 1, 2, 3, 4];
        assert_eq!(read(Mode::TriangleStrip, &indices).unwrap(), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(read(Mode::TriangleFan, &indices).unwrap(), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert_eq!(read(Mode::TriangleStrip, &[0, 1, 2, 2, 3, 3, 4, 5]).unwrap(), [[0, 1, 2], [3, 5, 4]]);
        assert_eq!(read(Mode::Triangles, &[0, 1, 2, 2, 1, 3]).unwrap(), [[0, 1, 2], [2, 1, 3]]);
        assert!(read(Mode::TriangleFan, &[0]).unwrap().is_empty());
        assert!(read(Mode::Triangles, &indices).is_err());
    }
}
