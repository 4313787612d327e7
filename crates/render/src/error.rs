//! What can go wrong.

use diacaustic_scene::Error as SceneError;
use diacaustic_surface::Error as SurfaceError;

/// A scene that cannot be rendered here, or a device that failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene breaks a rule of [`diacaustic_scene::Scene::validate`].
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene's surfaces cannot be prepared.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The scene has more triangles than a texture of the device holds.
    #[error("the scene has {triangles} triangles and the device's textures hold {limit}: use fewer triangles")]
    TooManyTriangles {
        /// Triangles of the scene, surfaces of lights among them.
        triangles: usize,
        /// How many the device holds.
        limit: usize,
    },
    /// A buffer is larger than the device allows.
    #[error("{what} need {asked} bytes in one buffer and the device allows {available}: {remedy}")]
    BufferTooLarge {
        /// What the buffer holds.
        what: &'static str,
        /// Bytes asked for.
        asked: u64,
        /// Bytes that the device allows.
        available: u64,
        /// What would make it fit.
        remedy: &'static str,
    },
    /// A scene needs more than [`RendererOptions::memory`](crate::RendererOptions::memory) allows.
    #[error("{what} need {asked} bytes, and of the {limit} that may be taken on the device {left} are left: {remedy}")]
    OverMemoryLimit {
        /// What does not fit.
        what: &'static str,
        /// Bytes that it needs.
        asked: u64,
        /// Bytes that are left for it.
        left: u64,
        /// Bytes that are allowed in all.
        limit: u64,
        /// What would make it fit.
        remedy: &'static str,
    },
    /// The energy maps are larger than the device allows.
    #[error(
        "the energy maps of each light group take {asked} bytes and the device allows {available}: lower map_size, \
         keep fewer light groups apart, or set map_filter = false"
    )]
    MapsTooLarge {
        /// Bytes of the sums asked for.
        asked: u64,
        /// Bytes that the device allows.
        available: u64,
    },
    /// The device's limits are lower than [`crate::Renderer::required_limits`].
    #[error("the device allows {found} for the limit {limit} and diacaustic needs {needed}")]
    DeviceTooSmall {
        /// The limit's name in wgpu.
        limit: &'static str,
        /// What the device allows.
        found: u64,
        /// What is needed.
        needed: u64,
    },
    /// The device ran out of memory.
    #[error(
        "the device is out of memory for this scene: lower map_size, the picture's size or the triangle count ({0})"
    )]
    OutOfMemory(String),
    /// The device refused an operation.
    #[error("the device refused an operation: {0}")]
    Device(String),
    /// The adapter ends shader loops before they are done.
    #[error(
        "the adapter ends shader loops after about {limit} iterations and diacaustic needs {needed}: use another \
         adapter or a newer driver"
    )]
    LoopsTooShort {
        /// Iterations that ran.
        limit: u32,
        /// Iterations that are needed.
        needed: u32,
    },
    /// Some invocations were cut short during the render.
    #[error(
        "{invocations} shader invocations were cut short by the adapter's loop limit, so the result would be wrong: \
         lower max_depth or use another adapter"
    )]
    CutShort {
        /// How many.
        invocations: u32,
    },
    /// An operation needs a scene first.
    #[error("no scene is set: call set_scene first")]
    NoScene,
    /// More photons than the sequences hold.
    #[error("photon {index} was asked for and the sequences hold {limit}: ask for fewer photons")]
    TooManyPhotons {
        /// The photon's number.
        index: u64,
        /// How many there are.
        limit: u64,
    },
    /// What should be a saved state is none.
    #[error("the saved state cannot be used: {0}")]
    BadState(String),
    /// A saved state is of something else than what is set.
    #[error("the saved state is of another render: {}", difference(what, saved, found))]
    OtherState {
        /// What differs.
        what: String,
        /// What it is in the saved state, where that can be said in words.
        saved: Option<String>,
        /// What it is here.
        found: Option<String>,
    },
    /// An object was named that the scene does not hold.
    #[error("object {index} was asked for and the scene holds {count}")]
    NoSuchObject {
        /// The index asked for.
        index: usize,
        /// Objects in the scene.
        count: usize,
    },
}

fn difference(what: &str, saved: &Option<String>, found: &Option<String>) -> String {
    match (saved, found) {
        (Some(saved), Some(found)) => format!("its {what} is {saved}, and here it is {found}"),
        _ => format!("{what} are not the same"),
    }
}
