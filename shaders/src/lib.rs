//! The WGSL compute kernels of diacaustic and the structs they share with Rust.
//!
//! The kernels live beside this crate's manifest, one file per pass, and import the modules in the folders there. The build
//! script links and validates them; [`KERNELS`] holds the results.
//!
//! A part of the crate `diacaustic`, which changes it as it needs; use that.

mod layout;

pub use layout::{
    AimTarget, BakeParams, BakeTexel, BvhNode, CameraParams, DataLayers, DisplayParams, ErrorParams, LOST, Landing,
    Light, MAX_AIM_TARGETS, MapLayer, MapSquare, MapTexel, MapTile, MapTileRecord, MapWeld, MapWeldPart, Material,
    MaterialTextures, NONE, PathParams, PhotonParams, ProbeParams, QueryHit, QueryRay, RECORDS_WIDTH_BITS,
    ResolveParams, SHARED_CONSTANTS, SHARED_STRUCTS, STACK_SIZE, SharedField, SharedStruct, Sighting, SmoothParams,
    SurfaceTexture, TextureCoordinates, TileError, Triangle, TriangleCorners, VertexColors, WAVELENGTH_STEPS, ledger,
    light_kind, light_layer, map_tile, material_kind, paper_refraction, tangent, texture_flag, triangle_flag,
};

/// A linked kernel.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// Its file's name without ending.
    pub name: &'static str,
    /// WGSL source.
    pub source: &'static str,
    /// Its compute entry point; none for a render pass.
    pub entry_point: Option<&'static str>,
}

macro_rules! kernel {
    ($name:literal, $entry_point:expr) => {
        Kernel {
            name: $name,
            source: include_str!(concat!(env!("OUT_DIR"), "/", $name, ".wgsl")),
            entry_point: $entry_point,
        }
    };
}

/// Phase 1: photons from the lights into the energy maps.
pub const PHOTONS: Kernel = kernel!("photons", Some("emit_photons"));
/// Phase 2: one sample of every pixel.
pub const CAMERA: Kernel = kernel!("camera", Some("sample_pixels"));
/// One sample of every texel of a lightmap.
pub const BAKE: Kernel = kernel!("bake", Some("sample_texels"));
/// Between the phases: fixed-point flux to irradiance.
pub const RESOLVE: Kernel = kernel!("resolve", Some("resolve_irradiance"));
/// After it: noise is smoothed.
pub const SMOOTH: Kernel = kernel!("smooth", Some("smooth_maps"));
/// Looks up what the energy maps hold where camera paths met them.
pub const PROBE: Kernel = kernel!("probe", Some("look_up_sightings"));
/// Estimates the error of each tile of the picture.
pub const ERRORS: Kernel = kernel!("errors", Some("estimate_errors"));
/// Shows the film on a texture: `cover_target` and `show_pixel`.
pub const DISPLAY: Kernel = kernel!("display", None);
/// Answers ray queries.
pub const INTERSECT: Kernel = kernel!("intersect", Some("intersect_rays"));
/// Counts loop iterations, to find adapters that cut loops short.
pub const LOOP_CHECK: Kernel = kernel!("loop_check", Some("count_iterations"));

/// Every kernel.
pub const KERNELS: [Kernel; 10] =
    [PHOTONS, CAMERA, BAKE, RESOLVE, SMOOTH, PROBE, ERRORS, DISPLAY, INTERSECT, LOOP_CHECK];

/// Invocations in a workgroup of every compute kernel but [`LOOP_CHECK`].
pub const WORKGROUP_SIZE: u32 = 64;
/// Width and height of a camera workgroup's tile, pixels.
pub const TILE_SIZE: u32 = 8;
