//! Reads the objects of a scene file and the meshes that they name.

use std::{
    collections::{HashMap, HashSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::{Affine3A, DMat3, Vec3};

use super::table::{Entry, Table};
use crate::{
    Chart, Error, GltfFile, Material, Mesh, Object, ReadOptions, Warning, load_gltf, load_obj,
    primitives::are_perpendicular,
};

const OBJECT_KEYS: [&str; 12] = [
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
    "map_uvs",
];
const SHAPE_KEYS: [&str; 4] = ["mesh", "sphere", "rectangle", "box"];

/// Subdivisions of a sphere that names none: 16128 triangles.
const SPHERE_SUBDIVISIONS: u32 = 6;

/// Reads objects; holds what they share.
pub(super) struct ObjectReader<'a> {
    base_dir: &'a Path,
    options: ReadOptions,
    /// The file's materials, in its order, then those from MTL and glTF files that an object uses.
    pub(super) materials: Vec<Material>,
    pub(super) warnings: Vec<Warning>,
    named_materials: HashMap<String, usize>,
    meshes: HashMap<PathBuf, SharedMesh>,
    gltf_files: HashMap<PathBuf, Arc<GltfFile>>,
    /// Where the materials of glTF files stand in `materials`, of those that an object uses.
    gltf_materials: HashMap<(PathBuf, usize), usize>,
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
            meshes: HashMap::new(),
            gltf_files: HashMap::new(),
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
        let shape = self.read_shape(&shape)?;
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

    fn read_shape(&mut self, shape: &Entry<'_>) -> Result<SharedMesh, Error> {
        let inner = || shape.table(shape.place(), "a table: { key = value, ... }");
        match shape.key() {
            "sphere" => Ok(SharedMesh::primitive(read_sphere(&inner()?)?, "sphere")),
            "rectangle" => Ok(SharedMesh::primitive(read_rectangle(&inner()?)?, "rectangle")),
            "box" => Ok(SharedMesh::primitive(read_box(&inner()?)?, "box")),
            _ => self.read_mesh_file(shape),
        }
    }

    fn mesh_path(&self, entry: &Entry<'_>) -> Result<PathBuf, Error> {
        Ok(self.base_dir.join(entry.string("the path of an OBJ or glTF file, relative to the scene file")?))
    }

    /// An object for each of a glTF file's.
    fn read_gltf_objects(
        &mut self,
        table: &Table<'_>,
        entry: &Entry<'_>,
        name: Option<&str>,
    ) -> Result<Vec<Object>, Error> {
        let path = self.mesh_path(entry)?;
        let file = self.gltf_file(&path, entry)?;
        let mut slots: Vec<_> =
            file.objects.iter().flat_map(|part| &part.mesh.material_slots).map(String::as_str).collect();
        slots.sort_unstable();
        slots.dedup();
        let choices: HashMap<_, _> = slots.iter().copied().zip(self.read_choices(table, &slots)?).collect();
        let (placement, map_size) = (read_placement(table)?, read_map_size(table)?);
        let mut objects = Vec::new();
        for part in &file.objects {
            let slots = part.mesh.material_slots.iter().zip(&part.materials);
            let materials = slots.map(|(slot, of_file)| {
                choices[slot.as_str()].unwrap_or_else(|| self.gltf_material(&path, &file, *of_file))
            });
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

    fn gltf_file(&mut self, path: &Path, entry: &Entry<'_>) -> Result<Arc<GltfFile>, Error> {
        if let Some(file) = self.gltf_files.get(path) {
            return Ok(Arc::clone(file));
        }
        let file = load_gltf(path, self.options).map_err(|cause| in_file(entry, cause))?;
        if file.objects.is_empty() {
            return Err(entry.error(format!("is {}, whose scene has no triangles", path.display())));
        }
        self.warnings.extend(file.warnings.iter().cloned());
        let file = Arc::new(file);
        self.gltf_files.insert(path.to_owned(), Arc::clone(&file));
        Ok(file)
    }

    /// The index of a glTF file's material, which joins the scene on its first use.
    fn gltf_material(&mut self, path: &Path, file: &GltfFile, index: usize) -> usize {
        *self.gltf_materials.entry((path.to_owned(), index)).or_insert_with(|| {
            self.materials.push(file.materials[index].clone());
            self.materials.len() - 1
        })
    }

    fn read_mesh_file(&mut self, entry: &Entry<'_>) -> Result<SharedMesh, Error> {
        let path = self.mesh_path(entry)?;
        if let Some(mesh) = self.meshes.get(&path) {
            return Ok(mesh.clone());
        }
        if !has_ending(&path, &["obj"]) {
            return Err(entry.error(format!(
                "is {}; meshes are read from OBJ and glTF files, whose names end in .obj, .gltf or .glb",
                path.display()
            )));
        }
        let file = load_obj(&path, self.options).map_err(|cause| in_file(entry, cause))?;
        self.warnings.extend(file.warnings.iter().filter(|warning| !is_about_textures(warning)).cloned());
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let shared = SharedMesh {
            mesh: Arc::new(file.mesh),
            default_name: stem.into_owned(),
            mtl: file.materials,
            warnings: file.warnings,
        };
        self.meshes.insert(path, shared.clone());
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
            |warning| matches!(warning, Warning::IgnoredTextures { material: name, .. } if *name == material.name),
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

fn in_file(entry: &Entry<'_>, cause: Error) -> Error {
    Error::File { at: entry.location(), place: entry.place(), cause: Box::new(cause) }
}

fn read_map_size(table: &Table<'_>) -> Result<Option<u32>, Error> {
    table.get("map_size").map(|entry| entry.whole32()).transpose()
}

/// Whether a warning matters only to objects that take their material from the MTL file.
fn is_about_textures(warning: &Warning) -> bool {
    matches!(warning, Warning::IgnoredTextures { .. })
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

fn read_sphere(table: &Table<'_>) -> Result<Mesh, Error> {
    table.allow_only(&["center", "radius", "subdivisions"])?;
    let center = table.require("center", "3 numbers [x, y, z], metres")?.vector()?;
    let radius_entry = table.require("radius", "a number, metres")?;
    let radius = radius_entry.number()?;
    if radius <= 0.0 {
        return Err(radius_entry.error(format!("is {radius}; it must be greater than 0 (metres)")));
    }
    let mut subdivisions = SPHERE_SUBDIVISIONS;
    if let Some(entry) = table.get("subdivisions") {
        subdivisions = entry.whole32()?;
        let most = Mesh::MAX_SPHERE_SUBDIVISIONS;
        if !(1..=most).contains(&subdivisions) {
            return Err(entry.error(format!("is {subdivisions}; it must be from 1 to {most}")));
        }
    }
    Ok(Mesh::sphere(center, radius, subdivisions))
}

fn read_rectangle(table: &Table<'_>) -> Result<Mesh, Error> {
    table.allow_only(&["center", "edge_u", "edge_v"])?;
    let vector = |key| table.require(key, "3 numbers [x, y, z], metres")?.vector();
    let (center, edge_u, edge_v) = (vector("center")?, vector("edge_u")?, vector("edge_v")?);
    if edge_u.length() == 0.0 || edge_v.length() == 0.0 {
        return Err(table.error("edge_u and edge_v must not have length 0"));
    }
    if !are_perpendicular(edge_u, edge_v) {
        return Err(table.error("edge_u and edge_v must be perpendicular; for another shape, use an OBJ mesh"));
    }
    Ok(Mesh::rectangle(center, edge_u, edge_v))
}

fn read_box(table: &Table<'_>) -> Result<Mesh, Error> {
    table.allow_only(&["min", "max"])?;
    let vector = |key| table.require(key, "3 numbers [x, y, z], metres")?.vector();
    let (min, max) = (vector("min")?, vector("max")?);
    if !min.cmplt(max).all() {
        return Err(table.error(format!("min {min} must be less than max {max} along each axis")));
    }
    Ok(Mesh::cuboid(min, max))
}
