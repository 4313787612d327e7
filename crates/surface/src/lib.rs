//! What the renderer needs of surfaces before it runs: world-space triangles, a bounding volume hierarchy over them, the
//! layout of energy maps and the areas of their texels, bounds of casters. No GPU.
//!
//! A part of the crate `diacaustic`, which changes it as it needs; use that.

mod bounds;
mod box_tree;
mod bvh;
mod chart;
mod error;
mod light_surfaces;
mod media;
mod texel_area;
mod tile;
mod touching;
mod triangles;
mod weld;

pub use bounds::{BoundingSphere, caster_bounds, merge_spheres, scene_bounds};
pub use bvh::{Bvh, BvhNode, MAX_DEPTH};
pub use chart::{MapLayout, check_map_uvs};
pub use error::Error;
pub use light_surfaces::{DISK_CORNERS, light_surfaces};
pub use media::DielectricBoundaries;
pub use texel_area::{TexelChart, TexelSurface, texel_areas, texel_surfaces};
pub use tile::{FINEST_LEVEL, MapSquare, MapTile, MapTiles};
pub use touching::{RAY_OFFSET, separate_touching};
pub use triangles::{WorldTriangle, world_triangles};
pub use weld::{Weld, WeldPart, Welds};
