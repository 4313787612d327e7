//! Triangles of a primitive: lists, strips and fans, indexed or not.

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
    /// Vertices of each triangle, all of which are in range.
    pub(super) triangles: Vec<[u32; 3]>,
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
    /// Reads a primitive with the texture coordinates of set `uv_set`; none for points and lines.
    pub(super) fn read(
        root: &Root,
        buffers: &'a Buffers<'_>,
        primitive: &Primitive,
        uv_set: u32,
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
        let vertex_indices = match primitive.indices {
            Some(index) => read_indices(root, buffers, index.value(), vertices, place)?,
            None => (0..vertices as u32).collect(),
        };
        Ok(Some(Self {
            normals: find(Semantic::Normals, Type::Vec3, vertices)?,
            uvs: find(Semantic::TexCoords(uv_set), Type::Vec2, vertices)?,
            positions,
            triangles: triangles(mode, &vertex_indices, place)?,
        }))
    }
}

fn no_positions(primitive: &Primitive, place: &str) -> Fault {
    let extensions = primitive.extensions.iter().flat_map(|extensions| extensions.others.keys());
    let names: Vec<_> = extensions.map(String::as_str).collect();
    let which = if names.is_empty() { String::new() } else { format!(" (its extensions: {})", names.join(", ")) };
    Fault::new(place, format!("has no POSITION{which}; a primitive must have positions"))
}

fn read_indices(root: &Root, buffers: &Buffers<'_>, index: usize, vertices: usize, place: &str) -> Result<Vec<u32>> {
    let accessor = Accessor::new(root, buffers, index, Type::Scalar, &format!("{place}.indices"))?;
    if !accessor.is_unsigned() {
        return Err(Fault::new(&accessor.place, "is used as indices; its componentType must be 5121, 5123 or 5125"));
    }
    let indices: Vec<_> = (0..accessor.count).map(|at| accessor.whole(at)).collect();
    match indices.iter().position(|index| *index as usize >= vertices) {
        Some(at) => Err(Fault::new(
            &accessor.place,
            format!("has the index {} at {at}, but {place} has {vertices} vertices, from 0", indices[at]),
        )),
        None => Ok(indices),
    }
}

/// The triangles that the indices of a list, strip or fan stand for.
fn triangles(mode: Mode, indices: &[u32], place: &str) -> Result<Vec<[u32; 3]>> {
    let is_proper = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let count = indices.len();
    match mode {
        Mode::TriangleStrip => {
            let triangle =
                |(number, w): (usize, &[u32])| if number % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] };
            // Triangles without area join the parts of a strip.
            Ok(indices.windows(3).enumerate().map(triangle).filter(is_proper).collect())
        }
        Mode::TriangleFan => {
            let rim = indices.get(1..).unwrap_or_default();
            Ok(rim.windows(2).map(|w| [w[0], w[1], indices[0]]).filter(is_proper).collect())
        }
        _ if !count.is_multiple_of(3) => {
            Err(Fault::new(place, format!("has {count} corners of triangles; they must be a multiple of 3")))
        }
        _ => Ok(indices.as_chunks().0.to_vec()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let indices = [0, 1, 2, 3, 4];
        assert_eq!(triangles(Mode::TriangleStrip, &indices, "").unwrap(), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(triangles(Mode::TriangleFan, &indices, "").unwrap(), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 2, 3, 3, 4, 5], "").unwrap(), [[0, 1, 2], [3, 5, 4]]);
        assert!(triangles(Mode::TriangleFan, &[0], "").unwrap().is_empty());
        assert!(triangles(Mode::Triangles, &indices, "meshes[0]").is_err());
    }
}
