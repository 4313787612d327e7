//! Reads meshes from STL, binary and as text.

use std::{collections::HashMap, io::Cursor, path::Path};

use glam::Vec3;

use crate::{
    Error, Mesh, MeshFile, MeshOptions,
    mesh_file::{MOST_TRIANGLES, fault, read_bytes},
};

/// Bytes before the triangles of a binary file, and of each triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads an STL file. Corners of equal position are one vertex; facets that meet at less than the crease angle look smooth.
///
/// # Errors
/// If the file cannot be read or makes no sense.
pub fn load_stl(path: &Path, options: &MeshOptions) -> Result<MeshFile, Error> {
    parse_stl(read_bytes(path)?, path, options)
}

/// Reads a mesh from the bytes of an STL file, which messages call `path`.
///
/// # Errors
/// As [`load_stl`].
pub fn parse_stl(mut bytes: Vec<u8>, path: &Path, options: &MeshOptions) -> Result<MeshFile, Error> {
    if bytes.len() > HEADER + TRIANGLE * MOST_TRIANGLES {
        return Err(fault(path, format!("has more than {MOST_TRIANGLES} triangles, the most that are read")));
    }
    if is_binary(&bytes) {
        // stl_io takes what begins with "solid" for text, as some binary files do.
        bytes[..5].fill(0);
    }
    let mut builder = Builder::default();
    let mut source = Cursor::new(bytes);
    let problem = |error: std::io::Error| fault(path, format!("is not a whole STL file: {error}"));
    for triangle in stl_io::create_stl_reader(&mut source).map_err(problem)? {
        let corners = triangle.map_err(problem)?.vertices.map(|vertex| Vec3::from(vertex.0));
        if let Some(corner) = corners.iter().find(|corner| !corner.is_finite()) {
            let number = builder.mesh.triangles.len();
            return Err(fault(
                path,
                format!("has the position {corner} in triangle {number}; all numbers must be finite"),
            ));
        }
        builder.add(corners);
    }
    let mut mesh = builder.mesh;
    if mesh.triangles.is_empty() {
        return Err(fault(path, "has no triangles"));
    }
    mesh.smooth_below(options.crease_angle);
    Ok(MeshFile { mesh, warnings: Vec::new() })
}

/// Whether the number of triangles in the header fits the length, as it does by no chance in a text.
fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER - 4..HEADER).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes);
    count.is_some_and(|count| HEADER as u64 + TRIANGLE as u64 * u64::from(count) == bytes.len() as u64)
}

/// Triangles so far.
#[derive(Default)]
struct Builder {
    mesh: Mesh,
    vertices: HashMap<[u32; 3], u32>,
}

impl Builder {
    fn add(&mut self, corners: [Vec3; 3]) {
        let Self { mesh, vertices } = self;
        let triangle = corners.map(|corner| {
            // Adding 0 turns −0 into 0.
            let key = (corner + Vec3::ZERO).to_array().map(f32::to_bits);
            *vertices.entry(key).or_insert_with(|| {
                mesh.positions.push(corner);
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(triangle);
    }
}
