//! EXT_mesh_gpu_instancing: one mesh in many places of one node.

use glam::{DAffine3, DQuat, DVec3};
use gltf_json::{Root, accessor::Type};

use super::{
    accessors::Accessor,
    buffers::Buffers,
    fault::{Fault, Result},
    nodes::node_place,
};

const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// The most instances of a node.
const MOST_INSTANCES: usize = 1 << 20;

/// Node from mesh, for each instance; the identity for a node without the extension.
pub(super) fn read_instances(root: &Root, buffers: &Buffers<'_>, node: usize) -> Result<Vec<DAffine3>> {
    let extensions = root.nodes[node].extensions.as_ref();
    let Some(extension) = extensions.and_then(|extensions| extensions.others.get(EXTENSION)) else {
        return Ok(vec![DAffine3::IDENTITY]);
    };
    let place = format!("{}.{EXTENSION}", node_place(root, node));
    let accessor = |name: &str, kind| {
        let index = extension.get("attributes").and_then(|attributes| attributes.get(name));
        let index =
            index.map(|index| index.as_u64().and_then(|index| usize::try_from(index).ok()).unwrap_or(usize::MAX));
        index.map(|index| Accessor::new(root, buffers, index, kind, &format!("{place}.{name}"))).transpose()
    };
    let translations = accessor("TRANSLATION", Type::Vec3)?;
    let rotations = accessor("ROTATION", Type::Vec4)?;
    let scales = accessor("SCALE", Type::Vec3)?;
    let counts: Vec<_> = [&translations, &rotations, &scales].into_iter().flatten().map(|a| a.count).collect();
    let count = counts.first().copied().unwrap_or(0);
    if counts.iter().any(|other| *other != count) || count > MOST_INSTANCES {
        return Err(Fault::new(
            place,
            format!("has attributes of {counts:?} elements; they must have equally many, {MOST_INSTANCES} at most"),
        ));
    }
    let vector = |accessor: &Option<Accessor<'_>>, index, default| {
        accessor.as_ref().map_or(default, |accessor| DVec3::from(accessor.numbers::<3>(index).map(f64::from)))
    };
    let mut instances = Vec::with_capacity(count);
    for index in 0..count {
        let rotation = rotations.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |rotations| rotations.numbers::<4>(index));
        let rotation = DQuat::from_array(rotation.map(f64::from));
        let (scale, translation) = (vector(&scales, index, DVec3::ONE), vector(&translations, index, DVec3::ZERO));
        let length = rotation.length();
        let instance = DAffine3::from_scale_rotation_translation(scale, rotation / length, translation);
        if !instance.is_finite() {
            return Err(Fault::new(place, format!("has no finite transform at instance {index}")));
        }
        instances.push(instance);
    }
    Ok(instances)
}
