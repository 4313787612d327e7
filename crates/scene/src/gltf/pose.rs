//! Morph targets and skins: where vertices are.

use glam::{DAffine3, DMat4, Mat3, Mat4, Vec3};
use gltf_json::{
    Root,
    accessor::Type,
    mesh::{Primitive, Semantic},
};

use super::{
    accessors::Accessor,
    buffers::Buffers,
    fault::{Fault, Result, entry, place},
    nodes::{Nodes, node_place},
};

/// How a node's mesh is bent.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pose {
    /// The weight of each morph target.
    weights: Vec<f32>,
    /// World from the mesh, for each joint.
    joints: Vec<Mat4>,
}

impl Pose {
    /// That of a node: the weights of its animation, its own or else its mesh's, and its skin.
    pub(super) fn of_node(root: &Root, buffers: &Buffers<'_>, nodes: &Nodes, index: usize) -> Result<Self> {
        let node = &root.nodes[index];
        let mesh = node.mesh.and_then(|mesh| root.meshes.get(mesh.value()));
        let moved = nodes.motions.get(&index).and_then(|motion| motion.weights.as_ref());
        let weights = moved
            .or(node.weights.as_ref())
            .or(mesh.and_then(|mesh| mesh.weights.as_ref()))
            .cloned()
            .unwrap_or_default();
        if weights.iter().any(|weight| !weight.is_finite()) {
            return Err(Fault::new(node_place(root, index), "has a weight of a morph target that is not finite"));
        }
        let weights = if weights.iter().all(|weight| *weight == 0.0) { Vec::new() } else { weights };
        let skin = node.skin.map(|skin| skin.value());
        let joints = skin.map(|skin| joints(root, buffers, nodes, skin, &node_place(root, index)));
        Ok(Self { weights, joints: joints.transpose()?.unwrap_or_default() })
    }

    /// Whether the mesh stays as the file has it.
    pub(super) fn is_plain(&self) -> bool {
        self.weights.is_empty() && self.joints.is_empty()
    }

    /// Whether vertices are brought to the world, whatever their node's transform.
    pub(super) fn is_in_world(&self) -> bool {
        !self.joints.is_empty()
    }

    /// What a primitive brings to the pose.
    pub(super) fn of_primitive<'a>(
        &'a self,
        root: &Root,
        buffers: &'a Buffers<'_>,
        primitive: &Primitive,
        vertices: usize,
        place: &str,
    ) -> Result<PrimitivePose<'a>> {
        let mut targets = Vec::new();
        for (number, target) in primitive.targets.iter().flatten().enumerate() {
            let weight = self.weights.get(number).copied().unwrap_or(0.0);
            if weight == 0.0 {
                continue;
            }
            let place = format!("{place}.targets[{number}]");
            let accessor = |index: Option<gltf_json::Index<gltf_json::Accessor>>| {
                let index = index.map(|index| index.value());
                index
                    .map(|index| {
                        of_vertices(Accessor::new(root, buffers, index, Type::Vec3, &place)?, vertices, &place)
                    })
                    .transpose()
            };
            targets.push(Target {
                weight,
                positions: accessor(target.positions)?,
                normals: accessor(target.normals)?,
                tangents: accessor(target.tangents)?,
            });
        }
        let attribute =
            |semantic| super::primitives::attribute(root, buffers, primitive, (semantic, Type::Vec4), vertices, place);
        let mut influences = None;
        if !self.joints.is_empty() {
            influences = attribute(Semantic::Joints(0))?.zip(attribute(Semantic::Weights(0))?);
        }
        if let Some((joints, _)) = &influences {
            let used = (0..vertices).flat_map(|vertex| joints.wholes::<4>(vertex)).max().unwrap_or(0);
            if !joints.is_unsigned() || used as usize >= self.joints.len() {
                let count = self.joints.len();
                return Err(Fault::new(place, format!("names joint {used}, but its skin has {count}, from 0")));
            }
        }
        Ok(PrimitivePose { joints: &self.joints, targets, influences })
    }
}

fn of_vertices<'a>(accessor: Accessor<'a>, vertices: usize, place: &str) -> Result<Accessor<'a>> {
    if accessor.count < vertices {
        return Err(Fault::new(place, format!("has {} elements for {vertices} vertices", accessor.count)));
    }
    Ok(accessor)
}

/// World from the mesh, for each joint of a skin.
fn joints(root: &Root, buffers: &Buffers<'_>, nodes: &Nodes, skin: usize, user: &str) -> Result<Vec<Mat4>> {
    let skin_entry = entry(&root.skins, "skins", skin, user)?;
    let place = place("skins", skin, skin_entry.name.as_deref());
    if skin_entry.joints.is_empty() {
        return Err(Fault::new(place, "has no joints; it must have one at least"));
    }
    let inverse = skin_entry.inverse_bind_matrices.map(|index| {
        of_vertices(Accessor::new(root, buffers, index.value(), Type::Mat4, &place)?, skin_entry.joints.len(), &place)
    });
    let inverse = inverse.transpose()?;
    let mut joints = Vec::new();
    for (number, joint) in skin_entry.joints.iter().enumerate() {
        let world: DAffine3 = *entry(&nodes.world, "nodes", joint.value(), &place)?;
        let bind = inverse.as_ref().map_or(Mat4::IDENTITY, |inverse| Mat4::from_cols_array(&inverse.numbers(number)));
        joints.push((DMat4::from(world) * bind.as_dmat4()).as_mat4());
    }
    Ok(joints)
}

/// A pose with the numbers of a primitive.
pub(super) struct PrimitivePose<'a> {
    joints: &'a [Mat4],
    /// The morph targets that count.
    targets: Vec<Target<'a>>,
    /// Joints and weights.
    influences: Option<(Accessor<'a>, Accessor<'a>)>,
}

/// What a morph target adds to vertices.
struct Target<'a> {
    weight: f32,
    positions: Option<Accessor<'a>>,
    normals: Option<Accessor<'a>>,
    tangents: Option<Accessor<'a>>,
}

/// What of a vertex moves.
#[derive(Clone, Copy)]
pub(super) struct Posed {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) tangent: Vec3,
}

impl PrimitivePose<'_> {
    /// A vertex where the pose moves it.
    pub(super) fn apply(&self, vertex: usize, mut posed: Posed) -> Posed {
        for target in &self.targets {
            let moved = |accessor: &Option<Accessor<'_>>| {
                accessor.as_ref().map_or(Vec3::ZERO, |accessor| target.weight * Vec3::from(accessor.numbers(vertex)))
            };
            posed.position += moved(&target.positions);
            posed.normal += moved(&target.normals);
            posed.tangent += moved(&target.tangents);
        }
        let Some((joints, weights)) = &self.influences else { return posed };
        let weights = weights.numbers::<4>(vertex);
        let sum: f32 = weights.iter().sum();
        let mut blend = Mat4::ZERO;
        for (joint, weight) in joints.wholes::<4>(vertex).into_iter().zip(weights) {
            blend += self.joints[joint as usize] * (weight / sum);
        }
        Posed {
            position: blend.transform_point3(posed.position),
            normal: Mat3::from_mat4(blend).inverse().transpose() * posed.normal,
            tangent: blend.transform_vector3(posed.tangent),
        }
    }
}
