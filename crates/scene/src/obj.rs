//! Reads meshes from Wavefront OBJ, with their materials from MTL.

mod check;
mod mtl;

use std::{collections::HashMap, fs, path::Path};

use glam::{Vec2, Vec3};

use self::check::{Checked, check};
use crate::{Chart, Error, Material, Mesh, ReadOptions, Warning};

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

/// Reads an OBJ file and the MTL files that it names. Polygons are cut into fans of triangles.
///
/// A material is a dielectric if `illum` is 4, 6, 7 or 9 or it is not opaque (`d`, `Tr`), a mirror if `illum` is 3,
/// `phong` if `illum` is 2 with a specular colour, and diffuse otherwise. `Ke` is radiance that it emits, W/(m² sr), unless it
/// is a dielectric.
///
/// # Errors
/// If the OBJ file cannot be read or makes no sense. A fault of a material library is a warning, also that it lies outside the file's
/// folder where the options do not allow it.
pub fn load_obj(path: &Path, options: ReadOptions) -> Result<ObjFile, Error> {
    let bytes = fs::read(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    parse_obj(&String::from_utf8_lossy(&bytes), path, options)
}

/// Reads a mesh from OBJ text; material libraries are sought beside `path`, which messages name.
///
/// # Errors
/// If the text makes no sense. A fault of a material library is a warning.
pub fn parse_obj(text: &str, path: &Path, options: ReadOptions) -> Result<ObjFile, Error> {
    let checked = check(text, path)?;
    let mut mesh = merge_models(read_models(&checked, path)?);
    let mut warnings = Vec::new();
    settle_optional_data(&mut mesh, &checked, path, &mut warnings);
    if checked.skipped_faces > 0 {
        warnings.push(Warning::SkippedFaces { path: path.to_owned(), count: checked.skipped_faces });
    }
    if checked.slots.iter().any(|slot| !slot.is_empty()) {
        mesh.material_slots = checked.slots;
    }
    let materials = mtl::slot_materials(&mesh.material_slots, &checked.libraries, path, options, &mut warnings);
    if mesh.material_slots.len() < 2 {
        mesh.triangle_slots.clear();
    }
    Ok(ObjFile { mesh, materials, warnings })
}

/// One model for each run of faces of one material; its `material_id` is the slot.
fn read_models(checked: &Checked, path: &Path) -> Result<Vec<tobj::Model>, Error> {
    let slot_names: Vec<_> = (0..checked.slots.len()).map(check::slot_keyword).collect();
    let library = |_: &Path| {
        let slots = slot_names.iter().map(|name| tobj::Material { name: name.clone(), ..Default::default() });
        let indices: HashMap<_, _> = slot_names.iter().cloned().zip(0..).collect();
        Ok((slots.collect(), indices))
    };
    let models = tobj::load_obj_buf(&mut checked.text.as_bytes(), &tobj::GPU_LOAD_OPTIONS, library);
    let (models, _) = models.map_err(|error| Error::Obj {
        path: path.to_owned(),
        line: None,
        problem: format!("not a valid OBJ file: {error}"),
    })?;
    if models.iter().all(|model| model.mesh.indices.is_empty()) {
        let problem = "the file has no faces (f lines with 3 or more corners)".to_owned();
        return Err(Error::Obj { path: path.to_owned(), line: None, problem });
    }
    Ok(models)
}

fn merge_models(models: Vec<tobj::Model>) -> Mesh {
    let mut merged = Mesh { chart: Chart::Automatic, ..Mesh::default() };
    for tobj::Model { mesh, .. } in models {
        let first = merged.positions.len() as u32;
        let slot = mesh.material_id.unwrap_or(0) as u32;
        merged.positions.extend(mesh.positions.as_chunks().0.iter().copied().map(Vec3::from_array));
        merged.normals.extend(mesh.normals.as_chunks().0.iter().copied().map(Vec3::from_array));
        merged.uvs.extend(mesh.texcoords.as_chunks().0.iter().copied().map(Vec2::from_array));
        let triangles = mesh.indices.as_chunks::<3>().0;
        merged.triangles.extend(triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
        merged.triangle_slots.resize(merged.triangles.len(), slot);
    }
    merged
}

/// Drops the stand-ins for normals and texture coordinates that the file does not have.
fn settle_optional_data(mesh: &mut Mesh, checked: &Checked, path: &Path, warnings: &mut Vec<Warning>) {
    if checked.without_texcoord > 0 {
        mesh.uvs.clear();
        if checked.without_texcoord < checked.corners {
            let (count, corners) = (checked.without_texcoord, checked.corners);
            warnings.push(Warning::PartialTexcoords { path: path.to_owned(), count, corners });
        }
    }
    if checked.without_normal == checked.corners {
        mesh.normals.clear();
        return;
    }
    let replaced = mesh.replace_unusable_normals();
    if replaced > 0 {
        warnings.push(Warning::ReplacedNormals { path: path.to_owned(), count: replaced });
    }
}
