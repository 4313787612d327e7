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
}
