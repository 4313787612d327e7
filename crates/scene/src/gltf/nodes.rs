//! The tree of nodes: where each of them stands in the world.

use std::collections::HashMap;

use glam::{Affine3A, DAffine3, DMat4, DQuat, DVec3};
use gltf_json::{Node, Root};

use super::{
    animations::Motion,
    fault::{Fault, Result, entry, place},
};

/// The nodes of the scene that is shown.
pub(super) struct Nodes {
    /// World from node, of every node of the file.
    pub(super) world: Vec<DAffine3>,
    /// The nodes of the scene, each before its children, in the file's order.
    pub(super) shown: Vec<usize>,
    /// What an animation sets of nodes.
    pub(super) motions: HashMap<usize, Motion>,
}

impl Nodes {
    /// Those of the file's default scene, or else its first; of a file without scenes, all nodes.
    pub(super) fn read(root: &Root, motions: HashMap<usize, Motion>) -> Result<Self> {
        let parents = parents(root)?;
        let world = world_transforms(root, &parents, &motions)?;
        let index = root.scene.map_or(0, |scene| scene.value());
        let roots: Vec<usize> = match root.scenes.get(index) {
            Some(scene) => scene.nodes.iter().map(|node| node.value()).collect(),
            None if root.scene.is_some() => entry(&root.scenes, "scenes", index, "scene").map(|_| Vec::new())?,
            None => (0..root.nodes.len()).filter(|node| parents[*node].is_none()).collect(),
        };
        Ok(Self { world, shown: shown(root, &roots, index)?, motions })
    }
}

/// The place of a node in messages.
pub(super) fn node_place(root: &Root, node: usize) -> String {
    place("nodes", node, root.nodes.get(node).and_then(|node| node.name.as_deref()))
}

/// An affine map in single precision.
pub(super) fn single(map: &DAffine3) -> Affine3A {
    Affine3A::from_mat3_translation(map.matrix3.as_mat3(), map.translation.as_vec3())
}

fn children(node: &Node) -> impl DoubleEndedIterator<Item = usize> + '_ {
    node.children.iter().flatten().map(|child| child.value())
}

/// The parent of each node.
fn parents(root: &Root) -> Result<Vec<Option<usize>>> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in children(node) {
            entry(&root.nodes, "nodes", child, &node_place(root, index))?;
            if let Some(other) = parents[child].replace(index) {
                return Err(Fault::new(
                    node_place(root, child),
                    format!("is a child of nodes[{other}] and of nodes[{index}]; a node has one parent at most"),
                ));
            }
        }
    }
    Ok(parents)
}

/// World from node. Nodes that none without a parent leads to are in a cycle.
fn world_transforms(root: &Root, parents: &[Option<usize>], motions: &HashMap<usize, Motion>) -> Result<Vec<DAffine3>> {
    let mut world = vec![None; root.nodes.len()];
    let mut next: Vec<usize> = (0..world.len()).filter(|node| parents[*node].is_none()).collect();
    while let Some(node) = next.pop() {
        let parent = parents[node].and_then(|parent| world[parent]).unwrap_or(DAffine3::IDENTITY);
        world[node] = Some(parent * local_transform(root, node, motions.get(&node))?);
        next.extend(children(&root.nodes[node]));
    }
    let in_cycle = |node| Fault::new(node_place(root, node), "is its own ancestor; nodes must form a tree");
    world.into_iter().enumerate().map(|(node, world)| world.ok_or_else(|| in_cycle(node))).collect()
}

/// Parent from node.
fn local_transform(root: &Root, index: usize, motion: Option<&Motion>) -> Result<DAffine3> {
    let node = &root.nodes[index];
    let still = Motion::default();
    let moved = motion.unwrap_or(&still);
    let is_moved = moved.translation.is_some() || moved.rotation.is_some() || moved.scale.is_some();
    let fault = |problem: &str| Fault::new(node_place(root, index), problem);
    let transform = match node.matrix {
        Some(_) if is_moved => {
            return Err(fault("has a matrix and is animated; such a node must have translation, rotation and scale"));
        }
        Some(matrix) => DAffine3::from_mat4(DMat4::from_cols_array(&matrix.map(f64::from))),
        None => {
            let vector = |vector: Option<[f32; 3]>, default| vector.map_or(default, |v| DVec3::from(v.map(f64::from)));
            let stated = DQuat::from_array(node.rotation.unwrap_or_default().0.map(f64::from));
            let rotation = moved.rotation.map_or(stated, |rotation| rotation.as_dquat());
            let length = rotation.length();
            // Rounded numbers give lengths near 1; others would scale.
            if !(0.5..=2.0).contains(&length) {
                return Err(fault("has a rotation whose length is not 1; it must be a unit quaternion [x, y, z, w]"));
            }
            let (scale, translation) = (
                moved.scale.map_or_else(|| vector(node.scale, DVec3::ONE), |scale| scale.as_dvec3()),
                moved.translation.map_or_else(|| vector(node.translation, DVec3::ZERO), |offset| offset.as_dvec3()),
            );
            DAffine3::from_scale_rotation_translation(scale, rotation / length, translation)
        }
    };
    if transform.is_finite() { Ok(transform) } else { Err(fault("has a transform that is not finite")) }
}

/// The nodes under the roots of a scene.
fn shown(root: &Root, roots: &[usize], scene: usize) -> Result<Vec<usize>> {
    let mut is_shown = vec![false; root.nodes.len()];
    let mut shown = Vec::new();
    let mut next: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(node) = next.pop() {
        let scene = || format!("scenes[{scene}]");
        entry(&root.nodes, "nodes", node, &scene())?;
        if std::mem::replace(&mut is_shown[node], true) {
            return Err(Fault::new(scene(), format!("has nodes[{node}] twice; it must have each node once")));
        }
        shown.push(node);
        next.extend(children(&root.nodes[node]).rev());
    }
    Ok(shown)
}
