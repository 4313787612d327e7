//! Reads meshes from Wavefront OBJ, with their materials from MTL.

mod build;
mod lines;
mod mtl;
mod statements;

use std::{
    fs::File,
    io::{BufRead, BufReader},
    path::Path,
};

use self::{build::build, lines::Lines, mtl::slot_materials, statements::Statements};
use crate::{Error, Material, Mesh, MeshOptions, Warning};

/// A mesh from an OBJ file, with what its material libraries say.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjFile {
    /// All groups and objects of the file as one mesh, in metres as the file states them; a slot for each material
    /// name that faces use, in the order of first use. Faces before the first `usemtl` have the slot "", unless no
    /// face names a material: then there are no slots.
    pub mesh: Mesh,
    /// For each slot, its material if a library defines it.
    pub materials: Vec<Option<Material>>,
    /// What is odd about the file.
    pub warnings: Vec<Warning>,
}

/// Reads an OBJ file and the MTL files and pictures that it names. `docs/scene-file.md` says what becomes of polygons, of faces without
/// normals and of MTL's materials.
///
/// # Errors
/// If the OBJ file cannot be read or makes no sense. A fault of a material library or a picture is a warning, also that it lies outside
/// the file's folder where the options do not allow it.
pub fn load_obj(path: &Path, options: &MeshOptions) -> Result<ObjFile, Error> {
    let file = File::open(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    read(BufReader::new(file), path, options)
}

/// Reads a mesh from OBJ text; material libraries are sought beside `path`, which messages name.
///
/// # Errors
/// As [`load_obj`].
pub fn parse_obj(text: &[u8], path: &Path, options: &MeshOptions) -> Result<ObjFile, Error> {
    read(text, path, options)
}

fn read(source: impl BufRead, path: &Path, options: &MeshOptions) -> Result<ObjFile, Error> {
    let mut statements = Statements::default();
    let mut lines = Lines::new(source, path);
    while let Some((number, line)) = lines.next()? {
        let problem = |problem| Error::Obj { path: path.to_owned(), line: Some(number), problem };
        statements.read_line(&line).map_err(problem)?;
    }
    if statements.corners.is_empty() {
        let problem = "the file has no faces (f lines with 3 or more corners)".to_owned();
        return Err(Error::Obj { path: path.to_owned(), line: None, problem });
    }
    let libraries = std::mem::take(&mut statements.libraries);
    let mut warnings = Vec::new();
    let mesh = build(statements, path, options.crease_angle, &mut warnings);
    let materials = slot_materials(&mesh, &libraries, path, options.read, &mut warnings);
    Ok(ObjFile { mesh, materials, warnings })
}
