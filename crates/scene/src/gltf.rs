//! Reads meshes, materials, lights and cameras from glTF 2.0: `.gltf` and `.glb`.
//!
//! The crate `gltf-json` gives the lists of the file their types; whatever they refer to is checked here.

mod accessors;
mod animations;
mod buffers;
mod container;
mod curves;
mod fault;
mod instances;
mod lights;
mod materials;
mod meshes;
mod meshopt;
mod nodes;
mod options;
mod pointers;
mod pose;
mod primitives;
mod textures;
mod variants;

use std::{
    collections::{BTreeSet, HashMap, HashSet},
    fs,
    path::Path,
    sync::Arc,
};

use glam::{Affine3A, DAffine3};
use gltf_json::Root;

use self::{
    animations::motions,
    buffers::Buffers,
    fault::{Fault, Result, place, shortened},
    instances::read_instances,
    lights::{read_camera, read_light},
    materials::{MaterialReader, is_whole_on},
    meshes::{MOST_TRIANGLES, MeshReader, SlottedMesh},
    nodes::{Nodes, node_place, single},
    pose::Pose,
    textures::TextureReader,
};
pub use self::{lights::GltfCamera, options::GltfOptions};
use crate::{Error, Light, Material, Mesh, Warning, folder::Folder};

/// What a glTF file shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GltfFile {
    /// Its meshes as they stand in the world, metres; a mesh that stands in several places is shared.
    pub objects: Vec<GltfObject>,
    /// The materials that its objects use.
    pub materials: Vec<Material>,
    /// Its lights, with names that differ.
    pub lights: Vec<Light>,
    /// Its cameras.
    pub cameras: Vec<GltfCamera>,
    /// What is not shown as it is meant.
    pub warnings: Vec<Warning>,
}

/// A mesh of a glTF file in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfObject {
    /// The name of its node, or else of its mesh; objects may have the same.
    pub name: String,
    /// Its surface.
    pub mesh: Arc<Mesh>,
    /// Placement; invertible.
    pub world_from_object: Affine3A,
    /// For each slot of the mesh, an index into [`GltfFile::materials`].
    pub materials: Vec<usize>,
}

/// Reads a glTF file: the default scene, at rest or posed by an animation. The files that it names must lie in its folder or below, unless the options
/// allow otherwise; nothing is fetched.
///
/// # Errors
/// If the file or one that it names cannot be read, makes no sense, or requires an extension that is not supported, and if it lacks the
/// animation or variant that the options name. What is used and not supported is a warning.
pub fn load_gltf(path: &Path, options: &GltfOptions) -> std::result::Result<GltfFile, Error> {
    let bytes = fs::read(path).map_err(|cause| Error::Read { path: path.to_owned(), cause })?;
    parse_gltf(&bytes, path, options)
}

/// Reads a glTF file from bytes; messages call it `path`, and the files that it names are sought beside that.
///
/// # Errors
/// As [`load_gltf`].
pub fn parse_gltf(bytes: &[u8], path: &Path, options: &GltfOptions) -> std::result::Result<GltfFile, Error> {
    let folder = Folder::of(path, options.read);
    read(bytes, path, &folder, options).map_err(|fault| fault.error(path))
}

fn read(bytes: &[u8], path: &Path, folder: &Folder, options: &GltfOptions) -> Result<GltfFile> {
    let container = container::split(bytes)?;
    let (root, pointers) = container::parse(container.json)?;
    let unsupported = container::check_extensions(&root)?;
    let buffers = Buffers::read(&root, container.binary, folder)?;
    let (posed, warnings) = pointers.posed(&root, &buffers, options)?.unzip();
    let root = posed.as_ref().unwrap_or(&root);
    let textures = TextureReader::new(root, &buffers, folder);
    let mut reader = Reader {
        root,
        meshes: MeshReader::new(root, &buffers, variants::variant(root, options.variant.as_deref())?),
        materials: MaterialReader::new(root, textures),
        nodes: Nodes::read(root, motions(root, &buffers, &pointers, options)?)?,
        shared: HashMap::new(),
        triangles_left: MOST_TRIANGLES,
        warnings: warnings.unwrap_or_default(),
        file: GltfFile::default(),
    };
    reader.read_nodes()?;
    Ok(reader.finish(&unsupported, path))
}

/// A mesh as its nodes share it: the mesh and its materials; none without triangles.
type SharedMesh = Option<(Arc<Mesh>, Vec<usize>)>;

struct Reader<'a, 'b> {
    root: &'a Root,
    meshes: MeshReader<'a, 'b>,
    materials: MaterialReader<'a, 'b>,
    nodes: Nodes,
    /// Meshes that stand as the file has them.
    shared: HashMap<usize, SharedMesh>,
    /// The most triangles that may still be placed in the world.
    triangles_left: usize,
    warnings: Vec<Fault>,
    file: GltfFile,
}

impl Reader<'_, '_> {
    fn read_nodes(&mut self) -> Result<()> {
        for node in std::mem::take(&mut self.nodes.shown) {
            let world = self.nodes.world[node];
            if let Some(mesh) = self.root.nodes[node].mesh {
                self.read_mesh_node(node, mesh.value(), world)?;
            }
            if let Some((name, kind)) = read_light(self.root, node, &world)? {
                let name = name.or_else(|| self.root.nodes[node].name.clone()).map(|name| shortened(&name));
                let name = name.filter(|name| !name.is_empty()).unwrap_or_else(|| "light".to_owned());
                self.file.lights.push(Light { name, kind, photon_share: 1, group: None });
            }
            self.file.cameras.extend(read_camera(self.root, node, &world, &mut self.warnings)?);
        }
        Ok(())
    }

    /// Places the mesh of a node in the world, once or for each of its instances.
    fn read_mesh_node(&mut self, node: usize, mesh: usize, mut world: DAffine3) -> Result<()> {
        let pose = Pose::of_node(self.root, self.meshes.buffers, &self.nodes, node)?;
        let Some((shape, materials)) = self.mesh(node, mesh, &pose)? else { return Ok(()) };
        if pose.is_in_world() {
            world = DAffine3::IDENTITY;
        }
        let name = self.object_name(node, mesh);
        for instance in read_instances(self.root, self.meshes.buffers, node)? {
            let world = world * instance;
            let world_from_object = single(&world);
            if world.matrix3.determinant() == 0.0 || !world_from_object.inverse().is_finite() {
                self.warnings
                    .push(Fault::new(node_place(self.root, node), "has a scale of 0 along an axis and is left out"));
                continue;
            }
            self.triangles_left = self.triangles_left.checked_sub(shape.triangles.len()).ok_or_else(|| {
                let problem = format!("brings the scene to more than {MOST_TRIANGLES} triangles");
                Fault::new(node_place(self.root, node), problem)
            })?;
            self.file.objects.push(GltfObject {
                name: name.clone(),
                mesh: Arc::clone(&shape),
                world_from_object,
                materials: materials.clone(),
            });
        }
        Ok(())
    }

    /// The name of a node or else of its mesh, as files can be named after it.
    fn object_name(&self, node: usize, mesh: usize) -> String {
        let stated = |name: &Option<String>| name.clone().filter(|name| !name.trim().is_empty());
        let name = stated(&self.root.nodes[node].name);
        let name = name.or_else(|| self.root.meshes.get(mesh).and_then(|mesh| stated(&mesh.name)));
        let allowed = |c: char| if "/\\".contains(c) || c.is_control() { '_' } else { c };
        shortened(&name.unwrap_or_else(|| format!("node {node}"))).chars().map(allowed).collect()
    }

    fn mesh(&mut self, node: usize, mesh: usize, pose: &Pose) -> Result<SharedMesh> {
        if let Some(shared) = self.shared.get(&mesh).filter(|_| pose.is_plain()) {
            return Ok(shared.clone());
        }
        let user = node_place(self.root, node);
        let mesh_place = place("meshes", mesh, None);
        let needs_of = |material| self.materials.needs(material, &mesh_place);
        let read = self.meshes.read(mesh, pose, &user, needs_of)?.map(|slotted| self.with_materials(slotted));
        let read = read.transpose()?;
        if pose.is_plain() {
            self.shared.insert(mesh, read.clone());
        }
        Ok(read)
    }

    /// Names the slots of a mesh and finds their materials.
    fn with_materials(&mut self, slotted: SlottedMesh) -> Result<(Arc<Mesh>, Vec<usize>)> {
        let SlottedMesh { mut mesh, slots } = slotted;
        let mut materials = Vec::new();
        let is_volume = |slot: &Option<usize>| self.materials.is_volume(*slot);
        mesh.material_slots = slots.iter().map(|slot| self.materials.name(*slot)).collect();
        let are_closed = match slots.iter().any(is_volume) {
            true if mesh.open_edges() > 0 => mesh.closed_slots(),
            _ => vec![true; slots.len()],
        };
        for (slot, is_closed) in slots.iter().zip(are_closed) {
            materials.push(self.materials.index(*slot, is_closed)?);
        }
        Ok((Arc::new(mesh), materials))
    }

    /// Leaves out what materials are in part nowhere on the objects that use them.
    fn drop_hidden_rests(&mut self) {
        let materials = &mut self.materials.materials;
        let mut shows_rest = vec![false; materials.len()];
        let mut seen = HashSet::new();
        for object in &self.file.objects {
            for (slot, &index) in object.materials.iter().enumerate() {
                let Some(blend) = materials[index].blend.as_ref().filter(|_| !shows_rest[index]) else { continue };
                let is_new = seen.insert((Arc::as_ptr(&object.mesh), slot, index));
                shows_rest[index] = is_new && !is_whole_on(blend, &object.mesh, slot);
            }
        }
        for (material, shows_rest) in materials.iter_mut().zip(shows_rest) {
            material.blend = material.blend.take().filter(|_| shows_rest);
        }
    }

    fn finish(mut self, unsupported: &[&str], path: &Path) -> GltfFile {
        number_names(&mut self.file.lights);
        self.drop_hidden_rests();
        let mut faults = self.warnings;
        faults.extend(self.meshes.warnings);
        faults.extend(self.materials.warnings);
        for (extension, users) in &self.materials.unsupported {
            faults.push(Fault::of_file(format!(
                "{extension} of {} is not supported; it shows without it",
                listed(users)
            )));
        }
        for extension in unsupported.iter().filter(|name| !self.materials.unsupported.contains_key(**name)) {
            faults.push(Fault::of_file(format!("uses {extension}, which is not supported; the file shows without it")));
        }
        self.file.materials = self.materials.materials;
        self.file.warnings = faults.into_iter().map(|fault| fault.warning(path)).collect();
        self.file
    }
}

/// Makes the names of lights differ.
fn number_names(lights: &mut [Light]) {
    let mut counts = HashMap::<String, usize>::new();
    let mut taken: HashSet<_> = lights.iter().map(|light| light.name.clone()).collect();
    let mut is_first: HashMap<String, bool> = HashMap::new();
    for light in lights {
        let base = light.name.clone();
        if !std::mem::replace(is_first.entry(base.clone()).or_insert(false), true) {
            continue;
        }
        let count = counts.entry(base.clone()).or_insert(1);
        while taken.contains(&light.name) {
            *count += 1;
            light.name = format!("{base} {count}");
        }
        taken.insert(light.name.clone());
    }
}

/// A few names as messages list them.
fn listed(names: &BTreeSet<String>) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<_> = names.iter().take(SHOWN).map(|name| format!("{name:?}")).collect();
    let rest = names.len().saturating_sub(SHOWN);
    let more = if rest > 0 { format!(" and {rest} more") } else { String::new() };
    let what = if names.len() == 1 { "the material" } else { "the materials" };
    format!("{what} {}{more}", shown.join(", "))
}
