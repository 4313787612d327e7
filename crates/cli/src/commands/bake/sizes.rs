//! How many texels lightmaps have.

use diacaustic::{
    MapLayout,
    scene::{Object, Scene},
};

use super::BakeArguments;

/// Texels along the longer side of a map where nobody states them.
const DEFAULT_SIZE: u32 = 512;
/// The sizes that scenes may state.
const SIZES: std::ops::RangeInclusive<u32> = 2..=8192;

/// States the size of every receiver's map: that of the arguments, else the scene's, else the default.
pub(super) fn state_sizes(scene: &mut Scene, arguments: &BakeArguments) {
    let of_scene = scene.settings.map_size.unwrap_or(DEFAULT_SIZE);
    let materials = &scene.materials;
    let receives = |object: &&mut Object| object.materials.iter().any(|material| materials[*material].is_receiver());
    for object in scene.objects.iter_mut().filter(receives) {
        let size = match (arguments.size, arguments.texels_per_metre) {
            (Some(size), _) => size,
            (None, Some(density)) => size_of_density(object, density),
            (None, None) => object.map_size.unwrap_or(of_scene),
        };
        object.map_size = Some(size);
    }
}

/// The size of a map that has so many texels a metre, on average over the object's surface.
fn size_of_density(object: &Object, texels_per_metre: f32) -> u32 {
    let layout = MapLayout::with_texel_width(object, 1.0 / texels_per_metre);
    layout.width.max(layout.height).clamp(*SIZES.start(), *SIZES.end())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use diacaustic::{
        glam::{Affine3A, Vec3},
        scene::Mesh,
    };

    use super::*;

    #[test]
    fn a_metre_has_as_many_texels_as_asked_for() {
        let rectangle = Mesh::rectangle(Vec3::ZERO, 2.0 * Vec3::X, 1.0 * Vec3::NEG_Z);
        let object = |scale: f32| Object {
            name: "card".into(),
            mesh: Arc::new(rectangle.clone()),
            world_from_object: Affine3A::from_scale(Vec3::splat(scale)),
            materials: vec![0],
            map_size: None,
        };
        assert_eq!(size_of_density(&object(1.0), 100.0), 201);
        assert_eq!(size_of_density(&object(3.0), 100.0), 601);
        assert_eq!(size_of_density(&object(1.0), 1e9), 8192);
    }
}
