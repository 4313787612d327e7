//! Rays from the thin-lens camera.

use diacaustic_scene::Scene;
use glam::{DVec2, DVec3};

use crate::generator::Generator;
use crate::geometry::Ray;
use crate::warp;

/// The camera and its picture.
pub(super) struct View {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Pixels.
    size: DVec2,
    /// Half the picture's height at distance 1.
    half_height: f64,
    aperture_radius: f64,
    focus_distance: f64,
}

impl View {
    pub(super) fn new(scene: &Scene) -> Self {
        let camera = &scene.camera;
        let position = camera.position.as_dvec3();
        let forward = (camera.look_at.as_dvec3() - position).normalize();
        let right = forward.cross(camera.up.as_dvec3()).normalize();
        Self {
            position,
            right,
            up: right.cross(forward),
            forward,
            size: DVec2::new(f64::from(scene.settings.width), f64::from(scene.settings.height)),
            half_height: (0.5 * f64::from(camera.vertical_fov).to_radians()).tan(),
            aperture_radius: f64::from(camera.aperture_radius),
            focus_distance: f64::from(camera.focus_distance),
        }
    }

    /// A ray through an even point of the pixel's square and of the lens.
    pub(super) fn ray(&self, x: u32, y: u32, generator: &mut Generator) -> Ray {
        let film = DVec2::new(f64::from(x) + generator.unit(), f64::from(y) + generator.unit());
        let on_lens = self.aperture_radius * warp::disc(generator.unit(), generator.unit());
        self.ray_through(film, on_lens)
    }

    /// The ray through a point of the film, pixels from the top left corner, and of the lens, metres from its centre.
    fn ray_through(&self, film: DVec2, on_lens: DVec2) -> Ray {
        let scale = 2.0 * self.half_height / self.size.y;
        let across = scale * (film.x - 0.5 * self.size.x);
        let upward = scale * (0.5 * self.size.y - film.y);
        let to_focus = self.focus_distance * (self.forward + across * self.right + upward * self.up);
        let offset = on_lens.x * self.right + on_lens.y * self.up;
        Ray { origin: self.position + offset, direction: (to_focus - offset).normalize() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View {
        View {
            position: DVec3::new(1.0, 2.0, 3.0),
            right: DVec3::X,
            up: DVec3::Y,
            forward: -DVec3::Z,
            size: DVec2::new(200.0, 100.0),
            half_height: 1.0,
            aperture_radius: 0.1,
            focus_distance: 5.0,
        }
    }

    #[test]
    fn corners_of_the_picture() {
        let direction = |x, y| view().ray_through(DVec2::new(x, y), DVec2::ZERO).direction;
        assert!(direction(100.0, 50.0).distance(-DVec3::Z) < 1e-15);
        assert!(direction(0.0, 0.0).distance(DVec3::new(-2.0, 1.0, -1.0).normalize()) < 1e-15);
        assert!(direction(200.0, 100.0).distance(DVec3::new(2.0, -1.0, -1.0).normalize()) < 1e-15);
    }

    #[test]
    fn rays_of_one_film_point_meet_in_the_plane_of_focus() {
        let meet = |x, y| {
            let ray = view().ray_through(DVec2::new(30.0, 20.0), DVec2::new(x, y));
            ray.at((3.0 - 5.0 - ray.origin.z) / ray.direction.z)
        };
        assert!(meet(0.1, 0.0).distance(meet(-0.03, 0.07)) < 1e-14);
    }
}
