//! What is built of a scene before anything is sent to the device.

use std::time::{Duration, Instant};

use diacaustic_scene::Scene;
use diacaustic_surface::{
    BoundingSphere, Bvh, caster_bounds, check_map_uvs, light_surfaces, scene_bounds, separate_touching, world_triangles,
};

use crate::{
    Error,
    features::Features,
    lights::Lights,
    map_plan::{MapPlan, plan_maps},
    paper,
};

/// A scene on the host.
#[derive(Debug)]
pub(crate) struct HostScene {
    /// Triangles of the objects.
    pub triangles: usize,
    /// The hierarchy over them and the surfaces of lights.
    pub bvh: Bvh,
    /// The energy maps, object by object.
    pub maps: Vec<Option<MapPlan>>,
    /// Bounding spheres of what casts light on.
    pub casters: Vec<BoundingSphere>,
    /// A sphere around everything.
    pub around: BoundingSphere,
    pub lights: Lights,
    pub features: Features,
    pub bvh_time: Duration,
    pub maps_time: Duration,
}

impl HostScene {
    /// Builds all of it, if the scene has no more triangles than the device holds.
    pub fn build(scene: &Scene, most_triangles: usize) -> Result<Self, Error> {
        let start = Instant::now();
        let mut triangles = world_triangles(scene);
        let of_objects = triangles.len();
        triangles.extend(light_surfaces(scene));
        if triangles.len() > most_triangles {
            return Err(Error::TooManyTriangles { triangles: triangles.len(), limit: most_triangles });
        }
        separate_touching(scene, &mut triangles[..of_objects]);
        let bvh = Bvh::build(&triangles)?;
        let bvh_time = start.elapsed();

        let start = Instant::now();
        check_map_uvs(scene)?;
        let maps = plan_maps(scene, &triangles[..of_objects]);
        let maps_time = start.elapsed();

        let around = scene_bounds(scene, &triangles);
        let mut lights = Lights::new(scene, &bvh.triangles, &around);
        if let Some(profile) = &scene.settings.paper {
            paper::set_pole(profile, &mut lights);
        }
        Ok(Self {
            triangles: of_objects,
            maps,
            casters: caster_bounds(scene, &triangles[..of_objects]),
            around,
            features: Features::of(scene),
            lights,
            bvh,
            bvh_time,
            maps_time,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use diacaustic_scene::parse_scene;
    use diacaustic_shaders::CAMERA;
    use diacaustic_surface::RAY_OFFSET;

    use super::*;

    #[test]
    fn more_triangles_than_the_device_holds_are_refused() {
        let text = "camera = { position = [0, 2, 3], look_at = [0, 0, 0], vertical_fov = 40 }
             materials.floor = { type = \"diffuse\", albedo = 0.5 }
             [[lights]]
             type = \"rectangle\"
             center = [0, 2, 0]
             edge_u = [1, 0, 0]
             edge_v = [0, 0, 1]
             flux = 1
             [[objects]]
             rectangle = { center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }
             material = \"floor\"";
        let scene = parse_scene(text, Path::new("."), "test").unwrap_or_else(|error| panic!("{error}")).scene;
        assert_eq!(HostScene::build(&scene, 4).unwrap().triangles, 2);
        let error = HostScene::build(&scene, 3).unwrap_err();
        assert!(matches!(error, Error::TooManyTriangles { triangles: 4, limit: 3 }), "{error}");
    }

    #[test]
    fn touching_is_measured_in_the_kernels_ray_offsets() {
        let after = CAMERA.source.split("const OFFSET_PER_METRE: f32 = ").nth(1).expect("the kernel's constant");
        let written = after.split(';').next().expect("its end");
        assert_eq!(written.trim_end_matches('f').parse::<f32>().unwrap(), RAY_OFFSET, "{written}");
    }
}
