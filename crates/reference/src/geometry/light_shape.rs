//! The surfaces of lights, which rays meet.

use std::f64::consts::PI;

use diacaustic_scene::LightKind;
use glam::DVec3;

use crate::warp;

use super::{Disk, Ray, Rectangle, Sphere};

/// The surface of a light, exact. It is black, and blocks light on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// A sphere, which shines outward.
    Sphere(Sphere),
    /// A rectangle, which shines from its front.
    Rectangle(Rectangle),
    /// A disk, which shines from its front.
    Disk(Disk),
}

impl LightShape {
    /// The surface of a light; none if no ray meets it.
    pub fn of(kind: &LightKind) -> Option<Self> {
        Some(match *kind {
            LightKind::Sphere { center, radius, .. } => {
                Self::Sphere(Sphere { center: center.as_dvec3(), radius: f64::from(radius) })
            }
            LightKind::Rectangle { center, edge_u, edge_v, .. } => Self::Rectangle(Rectangle {
                center: center.as_dvec3(),
                edge_u: edge_u.as_dvec3(),
                edge_v: edge_v.as_dvec3(),
            }),
            LightKind::Disk { center, normal, radius, .. } => Self::Disk(Disk {
                center: center.as_dvec3(),
                normal: normal.as_dvec3().normalize(),
                radius: f64::from(radius),
            }),
            LightKind::Point { .. }
            | LightKind::Spot { .. }
            | LightKind::Distant { .. }
            | LightKind::Environment { .. } => return None,
        })
    }

    /// The nearest crossing farther than `epsilon` metres: its distance, and whether the ray comes from the side that
    /// shines.
    pub fn meet(&self, ray: &Ray, epsilon: f64) -> Option<(f64, bool)> {
        match self {
            Self::Sphere(sphere) => sphere.meet(ray, epsilon),
            Self::Rectangle(rectangle) => rectangle.meet(ray, epsilon),
            Self::Disk(disk) => disk.meet(ray, epsilon),
        }
    }

    /// A sphere about it.
    pub fn bounding_sphere(&self) -> Sphere {
        match *self {
            Self::Sphere(sphere) => sphere,
            Self::Rectangle(Rectangle { center, edge_u, edge_v }) => {
                Sphere { center, radius: 0.5 * (edge_u + edge_v).length() }
            }
            Self::Disk(Disk { center, radius, .. }) => Sphere { center, radius },
        }
    }

    /// The sphere of a spherical light.
    pub fn as_sphere(&self) -> Option<Sphere> {
        match *self {
            Self::Sphere(sphere) => Some(sphere),
            Self::Rectangle(_) | Self::Disk(_) => None,
        }
    }

    /// m².
    pub fn area(&self) -> f64 {
        match self {
            Self::Sphere(Sphere { radius, .. }) => 4.0 * PI * radius * radius,
            Self::Rectangle(rectangle) => rectangle.area(),
            Self::Disk(Disk { radius, .. }) => PI * radius * radius,
        }
    }

    /// A point of the surface, even in area, and the unit normal of the side that shines.
    pub fn sample(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        match *self {
            Self::Sphere(Sphere { center, radius }) => {
                let normal = warp::cone(DVec3::Z, 2.0, u, v);
                (center + radius * normal, normal)
            }
            Self::Rectangle(rectangle) => (rectangle.at(u, v), rectangle.normal()),
            Self::Disk(Disk { center, normal, radius }) => {
                let ([t1, t2], p) = (warp::frame(normal), warp::disc(u, v));
                (center + radius * (p.x * t1 + p.y * t2), normal)
            }
        }
    }
}
