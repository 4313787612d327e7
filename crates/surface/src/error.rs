//! What can go wrong.

/// A surface that the renderer cannot take.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene has no triangle with an area.
    #[error("the scene has no triangle with an area: give an object a mesh that is more than points and lines")]
    NoTriangles,
    /// The hierarchy is deeper than the kernels' stack.
    #[error(
        "the scene's bounding volume hierarchy is {depth} levels deep and the kernels follow {limit}: many triangles \
         share one place; remove duplicates"
    )]
    TooDeep {
        /// Levels found.
        depth: usize,
        /// Levels that the kernels follow.
        limit: usize,
    },
    /// Texture coordinates that are to be an object's map cover a place twice.
    #[error(
        "object {object:?}: its texture coordinates cannot be its map: triangles {} and {} (from 0) both cover the place \
         ({:.5}, {:.5}); give each triangle a place of its own, or leave out map_uvs",
        triangles[0], triangles[1], place[0], place[1]
    )]
    OverlappingMapUvs {
        /// The object's name.
        object: String,
        /// Two triangles that overlap.
        triangles: [u32; 2],
        /// A place in both.
        place: [f64; 2],
    },
    /// A triangle with an area has none in the texture coordinates that are to be its object's map.
    #[error(
        "object {object:?}: its texture coordinates cannot be its map: triangle {triangle} (from 0) is folded to a line or a point at \
         ({:.5}, {:.5}); give it an area there, or leave out map_uvs",
        place[0], place[1]
    )]
    FoldedMapUvs {
        /// The object's name.
        object: String,
        /// The triangle.
        triangle: u32,
        /// Its middle.
        place: [f64; 2],
    },
}
