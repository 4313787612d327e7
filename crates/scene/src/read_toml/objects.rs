//! Reads the objects of a scene file and the meshes that they name.

use std::{
    collections::{HashMap, HashSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::{Affine3A, DMat3, Vec3};

use super::{
    shapes::{read_box, read_rectangle, read_sphere},
    table::{Entry, Table},
};
use crate::{
    Chart, Error, GltfFile, GltfOptions, Material, Mesh, MeshFile, MeshOptions, ObjFile, Object, ReadOptions, Warning,
    load_gltf, load_obj, load_ply, load_stl,
};

const OBJECT_KEYS: [&str; 16] = [
    "name",
    "mesh",
    "sphere",
    "rectangle",
    "box",
    "material",
    "material_slots",
    "translate",
    "rotate",
    "scale",
    "map_size",
    "time",
    "animation",
    "variant",
    "crease_angle",
    "map_uvs",
];
/// Keys that go with glTF files alone.
const GLTF_KEYS: [&str; 3] = ["time", "animation", "variant"];
const SHAPE_KEYS: [&str; 4] = ["mesh", "sphere", "rectangle", "box"];

/// Reads objects; holds what they share.
pub(super) struct ObjectReader<'a> {
    base_dir: &'a Path,
    options: ReadOptions,
    /// The file's materials, in its order, then those from MTL and glTF files that an object uses.
    pub(super) materials: Vec<Material>,
    pub(super) warnings: Vec<Warning>,
    named_materials: HashMap<String, usize>,
    /// Those read so far, with their crease angles.
    meshes: Vec<(PathBuf, f32, SharedMesh)>,
    /// Those read so far, with what of them.
    gltf_files: Vec<(PathBuf, GltfOptions, Arc<GltfFile>)>,
    /// Where the materials of glTF files, by their index in `gltf_files`, stand in `materials`, of those that an object uses.
    gltf_materials: HashMap<(usize, usize), usize>,
    object_names: HashSet<String>,
    /// The last number given to each name that several objects have.
    name_numbers: HashMap<String, usize>,
}

/// The objects of a scene file, each with the number of the table that it comes from.
pub(super) type NumberedObjects = Vec<(usize, Object)>;

/// A mesh as its objects share it.
#[derive(Clone)]
struct SharedMesh {
    mesh: Arc<Mesh>,
    /// The name of objects that state none.
    default_name: String,
    /// For each slot, its material from an MTL file.
    mtl: Vec<Option<Material>>,
    /// What the reader of the file noted.
    warnings: Vec<Warning>,
}

impl SharedMesh {
    fn primitive(mesh: Mesh, name: &str) -> Self {
        Self { mesh: Arc::new(mesh), default_name: name.to_owned(), mtl: Vec::new(), warnings: Vec::new() }
    }
}

impl<'a> ObjectReader<'a> {
    pub(super) fn new(base_dir: &'a Path, options: ReadOptions, materials: Vec<Material>) -> Self {
        let named_materials = materials.iter().enumerate().map(|(i, material)| (material.name.clone(), i)).collect();
        Self {
            base_dir,
            options,
            materials,
            warnings: Vec::new(),
            named_materials,
            meshes: Vec::new(),
            gltf_files: Vec::new(),
            gltf_materials: HashMap::new(),
            object_names: HashSet::new(),
            name_numbers: HashMap::new(),
        }
    }

    pub(super) fn read_all(&mut self, tables: &[Table<'_>]) -> Result<NumberedObjects, Error> {
        for table in tables {
            if let Some(name) = table.get("name") {
                self.object_names.insert(name.string("a string")?.to_owned());
            }
        }
        let mut objects = Vec::new();
        for (number, table) in tables.iter().enumerate() {
            objects.extend(self.read(table.clone())?.into_iter().map(|object| (number, object)));
        }
        Ok(objects)
    }

    /// The object of a table; several if its mesh is a glTF file of several.
    fn read(&mut self, mut table: Table<'_>) -> Result<Vec<Object>, Error> {
        let name = table.get("name").map(|entry| entry.string("a string")).transpose()?;
        if let Some(name) = name {
            table.describe(&format!(" {name:?}"));
        }
        table.allow_only(&OBJECT_KEYS)?;
        let shape = one_shape(&table)?;
        if shape.key() == "mesh" && has_ending(&self.mesh_path(&shape)?, &["gltf", "glb"]) {
            return self.read_gltf_objects(&table, &shape, name);
        }
        if let Some(entry) = GLTF_KEYS.iter().find_map(|key| table.get(key)) {
            return Err(entry.error("goes with a glTF file alone; leave it out"));
        }
        let shape = self.read_shape(&table, &shape)?;
        let materials = self.read_materials(&table, &shape)?;
        let mut objects = vec![Object {
            name: name.map_or_else(|| self.unused_name(&shape.default_name), str::to_owned),
            mesh: shape.mesh,
            world_from_object: read_placement(&table)?,
            materials,
            map_size: read_map_size(&table)?,
        }];
        self.set_map_uvs(&table, &mut objects)?;
        Ok(objects)
    }

    /// The name itself, or with the first number from 2 that makes it differ from every other object's.
    fn unused_name(&mut self, name: &str) -> String {
        let mut candidate = name.to_owned();
        let number = self.name_numbers.entry(name.to_owned()).or_insert(1);
        while !self.object_names.insert(candidate.clone()) {
            *number += 1;
            candidate = format!("{name} {number}");
        }
        candidate
    }

    fn read_shape(&mut self, table: &Table<'_>, shape: &Entry<'_>) -> Result<SharedMesh, Error> {
        if shape.key() == "mesh" {
            return self.read_mesh_file(table, shape);
        }
        if let Some(entry) = table.get("crease_angle") {
            return Err(entry.error("goes with a mesh from an OBJ, PLY or STL file alone; leave it out"));
        }
        let inner = shape.table(shape.place(), "a table: { key = value, ... }")?;
        Ok(match shape.key() {
            "sphere" => SharedMesh::primitive(read_sphere(&inner)?, "sphere"),
            "rectangle" => SharedMesh::primitive(read_rectangle(&inner)?, "rectangle"),
            _ => SharedMesh::primitive(read_box(&inner)?, "box"),
        })
    }

    fn mesh_path(&self, entry: &Entry<'_>) -> Result<PathBuf, Error> {
        Ok(self.base_dir.join(entry.string("the path of a mesh's file, relative to the scene file")?))
    }

    /// An object for each of a glTF file's.
    fn read_gltf_objects(
        &mut self,
        table: &Table<'_>,
        entry: &Entry<'_>,
        name: Option<&str>,
    ) -> Result<Vec<Object>, Error> {
        let path = self.mesh_path(entry)?;
        let number = self.gltf_file(path, read_gltf_options(table, self.options)?, entry)?;
        let file = Arc::clone(&self.gltf_files[number].2);
        let mut slots: Vec<_> =
            file.objects.iter().flat_map(|part| &part.mesh.material_slots).map(String::as_str).collect();
        slots.sort_unstable();
        slots.dedup();
        let choices: HashMap<_, _> = slots.iter().copied().zip(self.read_choices(table, &slots)?).collect();
        let (placement, map_size) = (read_placement(table)?, read_map_size(table)?);
        let mut objects = Vec::new();
        for part in &file.objects {
            let slots = part.mesh.material_slots.iter().zip(&part.materials);
            let materials = slots
                .map(|(slot, of_file)| choices[slot.as_str()].unwrap_or_else(|| self.gltf_material(number, *of_file)));
            objects.push(Object {
                materials: materials.collect(),
                name: match name {
                    Some(name) if file.objects.len() == 1 => name.to_owned(),
                    Some(name) => self.unused_name(&format!("{name} {}", part.name)),
                    None => self.unused_name(&part.name),
                },
                mesh: Arc::clone(&part.mesh),
                world_from_object: placement * part.world_from_object,
                map_size: None,
            });
        }
        self.set_map_size(&mut objects, map_size);
        self.set_map_uvs(table, &mut objects)?;
        Ok(objects)
    }

    /// Gives the objects that have an energy map its size; all of them, if none has.
    fn set_map_size(&self, objects: &mut [Object], map_size: Option<u32>) {
        let is_receiver = |object: &Object| object.materials.iter().any(|index| self.materials[*index].is_receiver());
        let has_receiver = objects.iter().any(is_receiver);
        for object in objects.iter_mut().filter(|object| !has_receiver || is_receiver(object)) {
            object.map_size = map_size;
        }
    }

    /// Lets the objects that have an energy map take their texture coordinates for it, if the table says so.
    fn set_map_uvs(&self, table: &Table<'_>, objects: &mut [Object]) -> Result<(), Error> {
        let Some(entry) = table.get("map_uvs") else { return Ok(()) };
        if !entry.boolean()? {
            return Ok(());
        }
        let is_receiver = |object: &Object| object.materials.iter().any(|index| self.materials[*index].is_receiver());
        let mut found = false;
        for object in objects.iter_mut().filter(|object| is_receiver(object)) {
            found = true;
            if object.mesh.map_places().is_empty() {
                let problem = format!("is true, but the mesh of object {:?} has no texture coordinates", object.name);
                return Err(entry.error(problem));
            }
            Arc::make_mut(&mut object.mesh).chart = Chart::Uvs;
        }
        if !found {
            return Err(entry.error("is true, but only objects with a diffuse share have an energy map; leave it out"));
        }
        Ok(())
    }

    /// The number of a glTF file among those read, which it joins on its first use.
    fn gltf_file(&mut self, path: PathBuf, options: GltfOptions, entry: &Entry<'_>) -> Result<usize, Error> {
        let is_same = |(read, how, _): &(PathBuf, GltfOptions, _)| *read == path && *how == options;
        if let Some(number) = self.gltf_files.iter().position(is_same) {
            return Ok(number);
        }
        let file = load_gltf(&path, &options).map_err(|cause| in_file(entry, cause))?;
        if file.objects.is_empty() {
            return Err(entry.error(format!("is {}, whose scene has no triangles", path.display())));
        }
        self.warnings.extend(file.warnings.iter().cloned());
        self.gltf_files.push((path, options, Arc::new(file)));
        Ok(self.gltf_files.len() - 1)
    }

    /// The index of a glTF file's material, which joins the scene on its first use.
    fn gltf_material(&mut self, file: usize, index: usize) -> usize {
        *self.gltf_materials.entry((file, index)).or_insert_with(|| {
            self.materials.push(self.gltf_files[file].2.materials[index].clone());
            self.materials.len() - 1
        })
    }

    fn read_mesh_file(&mut self, table: &Table<'_>, entry: &Entry<'_>) -> Result<SharedMesh, Error> {
        let path = self.mesh_path(entry)?;
        let mut options = MeshOptions::from(self.options);
        if let Some(angle) = table.get("crease_angle") {
            options.crease_angle = angle.number()?;
            if !(0.0..=180.0).contains(&options.crease_angle) {
                let angle_stated = options.crease_angle;
                return Err(angle.error(format!("is {angle_stated}; it must be from 0 to 180 (degrees)")));
            }
        }
        let is_same = |(read, angle, _): &&(PathBuf, f32, SharedMesh)| *read == path && *angle == options.crease_angle;
        if let Some((.., mesh)) = self.meshes.iter().find(is_same) {
            return Ok(mesh.clone());
        }
        let file = load_mesh(&path, &options, entry)?;
        self.warnings.extend(file.warnings.iter().filter(|warning| !is_about_textures(warning)).cloned());
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let shared = SharedMesh {
            mesh: Arc::new(file.mesh),
            default_name: stem.into_owned(),
            mtl: file.materials,
            warnings: file.warnings,
        };
        self.meshes.push((path, options.crease_angle, shared.clone()));
        Ok(shared)
    }

    /// For each slot of the mesh, the index of its material: from `material_slots`, else `material`, else the MTL file.
    fn read_materials(&mut self, table: &Table<'_>, shape: &SharedMesh) -> Result<Vec<usize>, Error> {
        let slots: Vec<_> = shape.mesh.material_slots.iter().map(String::as_str).collect();
        let chosen = self.read_choices(table, &slots)?;
        let mut materials = Vec::new();
        for (slot, choice) in chosen.into_iter().enumerate() {
            let found = choice.or_else(|| self.mtl_material(shape, slot));
            materials.push(found.ok_or_else(|| no_material(table, shape, slot))?);
        }
        Ok(materials)
    }

    /// For each slot, or for all triangles where there are none, the material that the table chooses, if it does.
    fn read_choices(&self, table: &Table<'_>, slots: &[&str]) -> Result<Vec<Option<usize>>, Error> {
        let mut chosen = vec![None; slots.len().max(1)];
        if let Some(material) = table.get("material") {
            chosen.fill(Some(self.material(&material)?));
        }
        if let Some(entry) = table.get("material_slots") {
            for slot in entry.table(entry.place(), "a table: { \"slot\" = \"material\" }")?.entries() {
                let index = slots.iter().position(|name| *name == slot.key());
                let unknown = || entry.unknown_name("material slot", slot.key(), slots, "slots of the mesh");
                chosen[index.ok_or_else(unknown)?] = Some(self.material(&slot)?);
            }
        }
        Ok(chosen)
    }

    /// The index of the material that the entry names.
    fn material(&self, entry: &Entry<'_>) -> Result<usize, Error> {
        let name = entry.string("the name of a material")?;
        self.named_materials.get(name).copied().ok_or_else(|| {
            let mut known: Vec<_> = self.named_materials.keys().map(String::as_str).collect();
            known.sort_unstable();
            entry.unknown_name("material", name, &known, "materials")
        })
    }

    /// The index of a slot's material from its MTL file, which joins the scene on its first use.
    fn mtl_material(&mut self, shape: &SharedMesh, slot: usize) -> Option<usize> {
        let material = shape.mtl.get(slot)?.as_ref()?;
        if let Some(index) = self.materials.iter().position(|known| known == material) {
            return Some(index);
        }
        let textures = shape.warnings.iter().filter(
            |warning| matches!(warning, Warning::IgnoredTextures { material: name, .. } | Warning::UnreadPicture { material: name, .. } | Warning::OpenGlass { material: name, .. } if *name == material.name),
        );
        self.warnings.extend(textures.cloned());
        self.materials.push(material.clone());
        Some(self.materials.len() - 1)
    }
}

/// The one entry of an object that says what its surface is.
fn one_shape<'d>(table: &Table<'d>) -> Result<Entry<'d>, Error> {
    let mut shapes: Vec<_> = SHAPE_KEYS.iter().filter_map(|key| table.get(key)).collect();
    if shapes.len() == 1 {
        return Ok(shapes.remove(0));
    }
    let found: Vec<_> = shapes.iter().map(Entry::key).collect();
    let found = if found.is_empty() { "none".to_owned() } else { found.join(" and ") };
    Err(table.error(format!("an object takes exactly one of {}; it has {found}", SHAPE_KEYS.join(", "))))
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|found| endings.iter().any(|ending| found.eq_ignore_ascii_case(ending)))
}

/// A mesh from a file of any kind but glTF.
fn load_mesh(path: &Path, options: &MeshOptions, entry: &Entry<'_>) -> Result<ObjFile, Error> {
    let without_materials = |MeshFile { mesh, warnings }| ObjFile { mesh, materials: Vec::new(), warnings };
    let read = if has_ending(path, &["obj"]) {
        load_obj(path, options)
    } else if has_ending(path, &["ply"]) {
        load_ply(path, options).map(without_materials)
    } else if has_ending(path, &["stl"]) {
        load_stl(path, options).map(without_materials)
    } else {
        return Err(entry.error(format!(
            "is {}; meshes are read from OBJ, PLY, STL and glTF files, whose names end in .obj, .ply, .stl, .gltf or .glb",
            path.display()
        )));
    };
    read.map_err(|cause| in_file(entry, cause))
}

fn in_file(entry: &Entry<'_>, cause: Error) -> Error {
    Error::File { at: entry.location(), place: entry.place(), cause: Box::new(cause) }
}

fn read_map_size(table: &Table<'_>) -> Result<Option<u32>, Error> {
    table.get("map_size").map(|entry| entry.whole32()).transpose()
}

/// When, by which animation and in which variant a glTF file is read.
fn read_gltf_options(table: &Table<'_>, read: ReadOptions) -> Result<GltfOptions, Error> {
    let text = |key, expected| table.get(key).map(|entry| entry.string(expected).map(str::to_owned)).transpose();
    Ok(GltfOptions {
        read,
        time: table.get("time").map(|entry| entry.number()).transpose()?,
        animation: text("animation", "the name of an animation, or its number from 0 in quotes")?,
        variant: text("variant", "the name of a material variant")?,
    })
}

/// Whether a warning matters only to objects that take their material from the MTL file.
fn is_about_textures(warning: &Warning) -> bool {
    matches!(warning, Warning::IgnoredTextures { .. } | Warning::UnreadPicture { .. } | Warning::OpenGlass { .. })
}

fn no_material(table: &Table<'_>, shape: &SharedMesh, slot: usize) -> Error {
    let known = "name one of [materials] with the key \"material\"";
    let slots = &shape.mesh.material_slots;
    let Some(slot_name) = slots.get(slot) else {
        return table.error(format!("the object has no material; {known}"));
    };
    let library = shape.warnings.iter().find_map(|warning| match warning {
        Warning::MaterialLibrary { problem, .. } => Some(format!(" ({problem})")),
        _ => None,
    });
    let which =
        if slot_name.is_empty() { "faces before the first usemtl".to_owned() } else { format!("{slot_name:?}") };
    let library = library.unwrap_or_default();
    table.error(format!("no material for the mesh's slot {which}{library}; {known} or with \"material_slots\""))
}

/// World from object: scale first, then rotations about x, y and z, then the translation.
fn read_placement(table: &Table<'_>) -> Result<Affine3A, Error> {
    let vector = |key| table.get(key).map_or(Ok(Vec3::ZERO), |entry| entry.vector());
    let degrees = vector("rotate")?.as_dvec3();
    let [x, y, z] = degrees.to_array().map(f64::to_radians);
    let mut scale = Vec3::ONE;
    if let Some(entry) = table.get("scale") {
        scale = entry.scale()?;
        if scale.cmpeq(Vec3::ZERO).any() {
            return Err(entry.error("is zero along an axis; a scale must not be 0"));
        }
    }
    let rotation = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    let linear = rotation * DMat3::from_diagonal(scale.as_dvec3());
    Ok(Affine3A::from_mat3_translation(linear.as_mat3(), vector("translate")?))
}
