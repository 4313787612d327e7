//! Reads the objects of a scene file and the meshes that they name.

use std::{
    collections::{HashMap, HashSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::{Affine3A, DMat3, Vec3};

use super::table::{Entry, Table};
use crate::{Error, Material, Mesh, Object, Warning, load_obj, primitives::are_perpendicular};

const OBJECT_KEYS: [&str; 11] = [
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
];
const SHAPE_KEYS: [&str; 4] = ["mesh", "sphere", "rectangle", "box"];

/// Subdivisions of a sphere that names none: 16128 triangles.
const SPHERE_SUBDIVISIONS: u32 = 6;

/// Reads objects; holds what they share.
pub(super) struct ObjectReader<'a> {
    base_dir: &'a Path,
    /// The file's materials, in its order, then those from MTL files that an object uses.
    pub(super) materials: Vec<Material>,
    pub(super) warnings: Vec<Warning>,
    named_materials: HashMap<String, usize>,
    meshes: HashMap<PathBuf, SharedMesh>,
    object_names: HashSet<String>,
}

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
    pub(super) fn new(base_dir: &'a Path, materials: Vec<Material>) -> Self {
        let named_materials = materials.iter().enumerate().map(|(i, material)| (material.name.clone(), i)).collect();
        Self {
            base_dir,
            materials,
            warnings: Vec::new(),
            named_materials,
            meshes: HashMap::new(),
            object_names: HashSet::new(),
        }
    }

    pub(super) fn read_all(&mut self, tables: &[Table<'_>]) -> Result<Vec<Object>, Error> {
        for table in tables {
            if let Some(name) = table.get("name") {
                self.object_names.insert(name.string("a string")?.to_owned());
            }
        }
        tables.iter().map(|table| self.read(table.clone())).collect()
    }

    fn read(&mut self, mut table: Table<'_>) -> Result<Object, Error> {
        let name = table.get("name").map(|entry| entry.string("a string")).transpose()?;
        if let Some(name) = name {
            table.describe(&format!(" {name:?}"));
        }
        table.allow_only(&OBJECT_KEYS)?;
        let shape = self.read_shape(&table)?;
        let materials = self.read_materials(&table, &shape)?;
        Ok(Object {
            name: name.map_or_else(|| self.unused_name(&shape.default_name), str::to_owned),
            mesh: shape.mesh,
            world_from_object: read_placement(&table)?,
            materials,
            map_size: table.get("map_size").map(|entry| entry.whole32()).transpose()?,
        })
    }

    /// The name itself, or with the first number from 2 that makes it differ from every other object's.
    fn unused_name(&mut self, name: &str) -> String {
        let mut candidate = name.to_owned();
        let mut number = 2;
        while !self.object_names.insert(candidate.clone()) {
            candidate = format!("{name} {number}");
            number += 1;
        }
        candidate
    }

    fn read_shape(&mut self, table: &Table<'_>) -> Result<SharedMesh, Error> {
        let shapes: Vec<_> = SHAPE_KEYS.iter().filter_map(|key| table.get(key)).collect();
        let [shape] = shapes.as_slice() else {
            let found: Vec<_> = shapes.iter().map(Entry::key).collect();
            let found = if found.is_empty() { "none".to_owned() } else { found.join(" and ") };
            return Err(
                table.error(format!("an object takes exactly one of {}; it has {found}", SHAPE_KEYS.join(", ")))
            );
        };
        let inner = || shape.table(shape.place(), "a table: { key = value, ... }");
        match shape.key() {
            "sphere" => Ok(SharedMesh::primitive(read_sphere(&inner()?)?, "sphere")),
            "rectangle" => Ok(SharedMesh::primitive(read_rectangle(&inner()?)?, "rectangle")),
            "box" => Ok(SharedMesh::primitive(read_box(&inner()?)?, "box")),
            _ => self.read_mesh_file(shape),
        }
    }

    fn read_mesh_file(&mut self, entry: &Entry<'_>) -> Result<SharedMesh, Error> {
        let path = self.base_dir.join(entry.string("the path of an OBJ file, relative to the scene file")?);
        if let Some(mesh) = self.meshes.get(&path) {
            return Ok(mesh.clone());
        }
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
            return Err(
                entry.error(format!("is {}; meshes are read from OBJ files, whose names end in .obj", path.display()))
            );
        }
        let file = load_obj(&path).map_err(|cause| Error::File {
            at: entry.location(),
            place: entry.place(),
            cause: Box::new(cause),
        })?;
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
        let slots = &shape.mesh.material_slots;
        let mut chosen = vec![None; slots.len().max(1)];
        if let Some(material) = table.get("material") {
            chosen.fill(Some(self.material(&material)?));
        }
        if let Some(entry) = table.get("material_slots") {
            let known: Vec<_> = slots.iter().map(String::as_str).collect();
            for slot in entry.table(entry.place(), "a table: { \"slot\" = \"material\" }")?.entries() {
                let index = known.iter().position(|name| *name == slot.key());
                let unknown = || entry.unknown_name("material slot", slot.key(), &known, "slots of the mesh");
                chosen[index.ok_or_else(unknown)?] = Some(self.material(&slot)?);
            }
        }
        let mut materials = Vec::new();
        for (slot, choice) in chosen.into_iter().enumerate() {
            let found = choice.or_else(|| self.mtl_material(shape, slot));
            materials.push(found.ok_or_else(|| no_material(table, shape, slot))?);
        }
        Ok(materials)
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
