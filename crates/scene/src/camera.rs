//! The camera.

use glam::Vec3;

/// A thin-lens perspective camera; a pinhole when the aperture is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Centre of the lens, metres, world frame.
    pub position: Vec3,
    /// The point at the centre of the picture, world frame.
    pub look_at: Vec3,
    /// The direction that is up in the picture; not parallel to the view.
    pub up: Vec3,
    /// Vertical field of view, degrees, in (0, 180).
    pub vertical_fov: f32,
    /// Radius of the lens, metres, ≥ 0.
    pub aperture_radius: f32,
    /// Distance along the view at which the picture is sharp, metres, > 0.
    pub focus_distance: f32,
}

impl Camera {
    /// The camera's orthonormal axes (right, up, forward), world frame.
    pub fn axes(&self) -> [Vec3; 3] {
        let forward = (self.look_at - self.position).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }
}
