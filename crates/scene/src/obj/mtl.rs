//! Materials from MTL.

mod entry;
mod kinds;
mod maps;
mod pictures;

use std::{
    collections::HashMap,
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
};

use self::{entry::Entry, pictures::PictureReader};
use super::lines::Lines;
use crate::{Error, Material, MaterialKind, Mesh, ReadOptions, Warning, folder::Folder};

/// The material of each slot of a mesh, from the libraries beside its OBJ file; the last definition of a name counts.
/// What cannot be used is noted.
pub(super) fn slot_materials(
    mesh: &Mesh,
    libraries: &[String],
    obj_path: &Path,
    options: ReadOptions,
    warnings: &mut Vec<Warning>,
) -> Vec<Option<Material>> {
    if mesh.material_slots.is_empty() {
        return Vec::new();
    }
    let entries = read_libraries(libraries, obj_path, options, warnings);
    let by_name: HashMap<_, _> =
        entries.iter().map(|(library, entry)| (entry.name.as_str(), (library, entry))).collect();
    let mut closed_slots = None;
    let mut pictures = PictureReader::default();
    let mut materials = Vec::new();
    for (number, slot) in mesh.material_slots.iter().enumerate() {
        let Some((library, entry)) = by_name.get(slot.as_str()) else {
            materials.push(None);
            continue;
        };
        let folder = Folder::of(library, options);
        let mut material = entry.material(&mut pictures, &folder, !mesh.uvs.is_empty(), warnings);
        if let MaterialKind::Dielectric { ior, tint, roughness, .. } = material.kind
            && !closed_slots.get_or_insert_with(|| closed_slots_of(mesh))[number]
        {
            material.kind = MaterialKind::ThinWalled { ior, tint, roughness };
            warnings.push(Warning::OpenGlass { path: obj_path.to_owned(), material: material.name.clone() });
        }
        materials.push(Some(material));
    }
    materials
}

/// Whether each slot encloses a volume: by itself, or because the whole mesh does.
fn closed_slots_of(mesh: &Mesh) -> Vec<bool> {
    if mesh.open_edges() == 0 { vec![true; mesh.material_slots.len()] } else { mesh.closed_slots() }
}

/// The entries of all libraries, each with its library's path.
fn read_libraries(
    libraries: &[String],
    obj_path: &Path,
    options: ReadOptions,
    warnings: &mut Vec<Warning>,
) -> Vec<(PathBuf, Entry)> {
    let folder = Folder::of(obj_path, options);
    let mut entries = Vec::new();
    for name in libraries.iter().flat_map(|line| file_names(line, &folder)) {
        let read = folder.inside(&name).and_then(|path| {
            let library = load_mtl(&path).map_err(|error| error.to_string())?;
            Ok(library.into_iter().map(move |entry| (path.clone(), entry)))
        });
        match read {
            Ok(library) => entries.extend(library),
            Err(problem) => warnings.push(Warning::MaterialLibrary { path: obj_path.to_owned(), problem }),
        }
    }
    entries
}

/// The names after `mtllib`: one, perhaps with spaces, if there is such a file, else one for each word.
fn file_names(line: &str, folder: &Folder) -> Vec<String> {
    let line = line.replace('\\', "/");
    let is_one = !line.contains(' ') || folder.inside(&line).is_ok_and(|path| path.is_file());
    let words = || line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let are_several = || words().iter().all(|word| word.to_lowercase().ends_with(".mtl"));
    if is_one || !are_several() { vec![line] } else { words() }
}

fn load_mtl(path: &Path) -> Result<Vec<Entry>, Error> {
    let unreadable = |cause| Error::Read { path: path.to_owned(), cause };
    if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        let problem = "is a folder; mtllib must name a file".to_owned();
        return Err(Error::Obj { path: path.to_owned(), line: None, problem });
    }
    entry::read_entries(Lines::new(BufReader::new(File::open(path).map_err(unreadable)?), path), path)
}
