//! What the renderer needs of surfaces before it runs: world-space triangles, a bounding volume hierarchy over them, the
//! layout of energy maps and the areas of their texels, bounds of casters. No GPU.

mod bounds;
mod bvh;
mod chart;
mod error;
mod texel_area;
mod triangles;

pub use bounds::{BoundingSphere, caster_bounds, merge_spheres};
pub use bvh::{Bvh, BvhNode, MAX_DEPTH};
pub use chart::{MapLayout, uvs_overlap};
pub use error::Error;
pub use texel_area::texel_areas;
pub use triangles::{WorldTriangle, world_triangles};
