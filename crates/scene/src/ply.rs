//! Reads meshes from PLY, binary and as text.

mod elements;

use std::{
    io::{BufRead, Read},
    path::Path,
};

use ply_rs_bw::{
    parser::{Parser, Reader},
    ply::{ElementDef, Encoding, Header, PropertyAccess, PropertyType, ScalarType},
};

use self::elements::{Face, Skipped, Vertex, face_indices, properties_of_vertices};
use crate::{
    Error, Mesh, MeshFile, MeshOptions, Warning,
    mesh_file::{MOST_TRIANGLES, fault, read_bytes},
    polygons::PolygonCutter,
};

/// The most bytes of a line of text.
const MOST_LINE: u64 = 1 << 20;
/// The most corners of a face: cutting takes time with the square of their number.
const MOST_CORNERS: usize = 4096;
/// Vertex colours from which on are white.
const WHITE: f32 = 0.999;

/// Reads a PLY file: `x`, `y`, `z`, `nx`, `ny`, `nz`, texture coordinates and colours of its vertices, and its faces. Faces
/// without normals that meet at less than the crease angle look smooth.
///
/// # Errors
/// If the file cannot be read or makes no sense.
pub fn load_ply(path: &Path, options: &MeshOptions) -> Result<MeshFile, Error> {
    parse_ply(&read_bytes(path)?, path, options)
}

/// Reads a mesh from the bytes of a PLY file, which messages call `path`.
///
/// # Errors
/// As [`load_ply`].
pub fn parse_ply(bytes: &[u8], path: &Path, options: &MeshOptions) -> Result<MeshFile, Error> {
    let mut mesh = read(bytes).map_err(|problem| fault(path, problem))?;
    let mut warnings = Vec::new();
    if mesh.normals.is_empty() {
        mesh.smooth_below(options.crease_angle);
    } else {
        let count = mesh.replace_unusable_normals();
        if count > 0 {
            warnings.push(Warning::ReplacedNormals { path: path.to_owned(), count });
        }
    }
    Ok(MeshFile { mesh, warnings })
}

fn read(bytes: &[u8]) -> Result<Mesh, String> {
    let mut source = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut source);
    let header = header.map_err(|error| format!("is not a PLY file: {}", first_line(&error)))?;
    let mut payload = source.into_inner();
    check_sizes(&header, payload.len() as u64)?;
    let mut builder = Builder::default();
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => builder.read_vertices(&header, element, &mut payload)?,
            "face" => builder.read_faces(&header, element, &mut payload)?,
            _ => each::<Skipped>(&header, element, &mut payload, |_, _| Ok(()))?,
        }
    }
    let Builder { mut mesh, .. } = builder;
    if mesh.triangles.is_empty() {
        return Err("has no faces; a cloud of points or strips of triangles are not read".to_owned());
    }
    if mesh.colors.iter().all(|color| color.min_element() > WHITE) {
        mesh.colors = Vec::new();
    }
    Ok(mesh)
}

/// Refuses more elements than the file has bytes for, before any memory is taken for them.
fn check_sizes(header: &Header, bytes: u64) -> Result<(), String> {
    let mut needed = 0u64;
    for (name, ElementDef { count, properties, .. }) in &header.elements {
        let least = match header.encoding {
            Encoding::Ascii => 1,
            _ => properties.values().map(|property| least_bytes(&property.data_type)).sum(),
        };
        if least == 0 && *count > 0 {
            return Err(format!("has {count} of the element {name:?}, which has no properties"));
        }
        needed = needed.saturating_add((*count as u64).saturating_mul(least));
        if needed > bytes.saturating_add(1) {
            return Err(format!(
                "states {count} of the element {name:?}, more than its {bytes} bytes can hold; it is cut off"
            ));
        }
    }
    Ok(())
}

/// What a parser says first; the rest is of use to its authors.
fn first_line(error: &dyn std::fmt::Display) -> String {
    error.to_string().lines().next().unwrap_or_default().chars().take(200).collect()
}

fn least_bytes(kind: &PropertyType) -> u64 {
    let (PropertyType::Scalar(scalar) | PropertyType::List(scalar, _)) = kind;
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

/// Reads the elements of one kind, one by one.
fn each<E: PropertyAccess>(
    header: &Header,
    element: &ElementDef,
    payload: &mut &[u8],
    mut take: impl FnMut(usize, E) -> Result<(), String>,
) -> Result<(), String> {
    let parser = Parser::<E>::new();
    let mut line = String::new();
    for index in 0..element.count {
        let read = match header.encoding {
            Encoding::BinaryBigEndian => parser.read_big_endian_element(payload, element),
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(payload, element),
            Encoding::Ascii => {
                line.clear();
                let text = payload.by_ref().take(MOST_LINE).read_line(&mut line);
                let bytes = text.map_err(|_| format!("is not text at the {} {index}", element.name))?;
                if bytes == 0 {
                    return Err(format!("is cut off: it has {index} of {} {}", element.count, element.name));
                }
                parser.read_ascii_element(line.trim_end(), element)
            }
        };
        let problem = |error| format!("cannot be read at the {} {index}: {}", element.name, first_line(&error));
        let read = read.map_err(problem)?;
        take(index, read)?;
    }
    Ok(())
}

/// The mesh so far.
#[derive(Default)]
struct Builder {
    mesh: Mesh,
    cutter: PolygonCutter,
}

impl Builder {
    fn read_vertices(&mut self, header: &Header, element: &ElementDef, payload: &mut &[u8]) -> Result<(), String> {
        let [has_normals, has_uvs, has_colors] = properties_of_vertices(element)?;
        each::<Vertex>(header, element, payload, |index, vertex| {
            let Vertex { position, normal, uv, color } = vertex;
            if !position.is_finite() || !uv.is_finite() || !color.is_finite() {
                return Err(format!("has a number that is not finite at vertex {index}"));
            }
            self.mesh.positions.push(position);
            if has_normals {
                self.mesh.normals.push(if normal.is_finite() { normal } else { glam::Vec3::ZERO });
            }
            if has_uvs {
                self.mesh.uvs.push(uv);
            }
            if has_colors {
                self.mesh.colors.push(color);
            }
            Ok(())
        })
    }

    fn read_faces(&mut self, header: &Header, element: &ElementDef, payload: &mut &[u8]) -> Result<(), String> {
        face_indices(element)?;
        let Self { mesh, cutter } = self;
        each::<Face>(header, element, payload, |index, Face(corners)| {
            let vertices = mesh.positions.len();
            if let Some(bad) = corners.iter().find(|corner| **corner as usize >= vertices) {
                return Err(format!("has the vertex {bad} in face {index}, but {vertices} vertices, from 0"));
            }
            if corners.len() > MOST_CORNERS {
                return Err(format!(
                    "has {} corners in face {index}; a face has at most {MOST_CORNERS}",
                    corners.len()
                ));
            }
            if mesh.triangles.len() + corners.len() > MOST_TRIANGLES {
                return Err(format!("has more than {MOST_TRIANGLES} triangles, the most that are read"));
            }
            match corners[..] {
                [] | [_] | [_, _] => {}
                [a, b, c] => mesh.triangles.push([a, b, c]),
                _ => {
                    let places: Vec<_> = corners.iter().map(|corner| mesh.positions[*corner as usize]).collect();
                    let cut = cutter.cut(&places);
                    mesh.triangles.extend(cut.iter().map(|triangle| triangle.map(|corner| corners[corner as usize])));
                }
            }
            Ok(())
        })
    }
}
