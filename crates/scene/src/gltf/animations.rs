//! An animation at a point of time: what it makes of nodes' transforms and weights.

use std::collections::HashMap;

use glam::{Quat, Vec3};
use gltf_json::{
    Root,
    accessor::Type,
    animation::{Animation, Channel, Property},
    validation::Checked,
};

use super::{
    buffers::Buffers,
    curves::{CurveReader, KeysLeft},
    fault::{Fault, Result, entry, place},
    options::GltfOptions,
    pointers::Pointers,
};

/// What an animation sets of a node, in place of what the node states.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Motion {
    pub(super) translation: Option<Vec3>,
    /// Of unit length.
    pub(super) rotation: Option<Quat>,
    pub(super) scale: Option<Vec3>,
    /// The weight of each morph target.
    pub(super) weights: Option<Vec<f32>>,
}

/// The motions of nodes at the time that the options name; none at rest.
pub(super) fn motions(
    root: &Root,
    buffers: &Buffers<'_>,
    pointers: &Pointers,
    options: &GltfOptions,
) -> Result<HashMap<usize, Motion>> {
    let Some((index, animation, time)) = chosen(root, options)? else { return Ok(HashMap::new()) };
    let place = place("animations", index, animation.name.as_deref());
    let mut motions = HashMap::<usize, Motion>::new();
    let mut keys_left = KeysLeft::all();
    for (number, channel) in animation.channels.iter().enumerate() {
        if pointers.has(index, number) {
            continue;
        }
        let place = format!("{place}.channels[{number}]");
        let node = channel.target.node.value();
        entry(&root.nodes, "nodes", node, &place)?;
        let sampler = entry(&animation.samplers, "samplers", channel.sampler.value(), &place)?;
        keys_left.take(root, sampler, &place)?;
        let curves = CurveReader { root, buffers, sampler, place: &place };
        read_channel(&curves, channel, time, motions.entry(node).or_default())?;
    }
    Ok(motions)
}

/// The animation that the options ask for, its index, and the time; none at rest.
pub(super) fn chosen<'a>(root: &'a Root, options: &GltfOptions) -> Result<Option<(usize, &'a Animation, f32)>> {
    if options.time.is_none() && options.animation.is_none() {
        return Ok(None);
    }
    let time = options.time.unwrap_or(0.0);
    if !time.is_finite() {
        return Err(Fault::of_file(format!("the time {time} was asked for; it must be a finite number of seconds")));
    }
    let (index, animation) = named(root, options.animation.as_deref())?;
    Ok(Some((index, animation, time)))
}

/// The animation of a name, or else of a number; the first without a choice.
fn named<'a>(root: &'a Root, choice: Option<&str>) -> Result<(usize, &'a Animation)> {
    let of_name = |choice: &str| root.animations.iter().position(|animation| animation.name.as_deref() == Some(choice));
    let index = match choice {
        Some(choice) => of_name(choice).or_else(|| choice.parse().ok()),
        None => Some(0),
    };
    let found = index.and_then(|index| Some((index, root.animations.get(index)?)));
    found.ok_or_else(|| {
        let name = |(index, animation): (usize, &Animation)| {
            animation
                .name
                .as_ref()
                .map_or_else(|| index.to_string(), |name| format!("{:?}", super::fault::shortened(name)))
        };
        let names: Vec<_> = root.animations.iter().enumerate().take(20).map(name).collect();
        let known = if names.is_empty() { "has none".to_owned() } else { format!("has {}", names.join(", ")) };
        let asked = choice.map_or("an animation".to_owned(), |choice| format!("the animation {choice:?}"));
        Fault::of_file(format!("{asked} was asked for, and the file {known}"))
    })
}

fn read_channel(curves: &CurveReader<'_, '_>, channel: &Channel, time: f32, motion: &mut Motion) -> Result<()> {
    let Checked::Valid(property) = channel.target.path else {
        let problem = "has an unknown path; it must be translation, rotation, scale or weights";
        return Err(Fault::new(curves.place, problem));
    };
    match property {
        Property::Translation => motion.translation = Some(curves.curve(Type::Vec3)?.vector(time)?),
        Property::Scale => motion.scale = Some(curves.curve(Type::Vec3)?.vector(time)?),
        Property::Rotation => motion.rotation = Some(curves.curve(Type::Vec4)?.rotation(time)?),
        Property::MorphTargetWeights => motion.weights = Some(curves.curve(Type::Scalar)?.numbers(time)?),
    }
    Ok(())
}
