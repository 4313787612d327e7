// Bind group 0: the scene. Written once, read by every pass.

/// A node of the eight-wide compressed BVH (Ylitie, Karras and Laine 2017), as obvhs lays it out.
struct BvhNode {
    /// Origin of the node's grid, metres (bits of three f32); then three grid exponents and the mask of inner children, 8 bits each.
    grid: vec4<u32>,
    /// First child node, first triangle, and eight 8-bit child descriptions.
    children: vec4<u32>,
    /// Lower, then upper grid planes of the eight children along x, 8 bits each.
    planes_x: vec4<u32>,
    /// The same along y.
    planes_y: vec4<u32>,
    /// The same along z.
    planes_z: vec4<u32>,
}

/// A triangle, world frame, in the order of the BVH's leaves.
struct Triangle {
    /// First corner, metres.
    corner: vec3<f32>,
    /// Index of its object.
    object: u32,
    /// Second corner minus the first, metres.
    edge_1: vec3<f32>,
    /// Index of its material.
    material: u32,
    /// Third corner minus the first, metres.
    edge_2: vec3<f32>,
    /// 1 if the corners' normals are interpolated, 0 for a flat facet.
    interpolate_normals: u32,
}

/// What a triangle's corners carry, in the order of the triangles.
struct TriangleCorners {
    /// Unit normal at the first corner, world frame.
    normal_0: vec3<f32>,
    /// Texel column of the third corner.
    texel_x_2: f32,
    /// Unit normal at the second corner, world frame.
    normal_1: vec3<f32>,
    /// Texel row of the third corner.
    texel_y_2: f32,
    /// Unit normal at the third corner, world frame.
    normal_2: vec3<f32>,
    /// Unused.
    padding: u32,
    /// Texel column and row of the first corner, then of the second.
    texel_01: vec4<f32>,
}

/// An object's place in the energy maps.
struct Object {
    /// Index of its map's first texel.
    map_first_texel: u32,
    /// Texels along x; 0 for an object without a map.
    map_width: u32,
    /// Texels along y.
    map_height: u32,
    /// 1, or 2 where front and back are kept apart.
    map_layers: u32,
}

/// What a surface does to light. Which fields count depends on `kind`.
struct Material {
    /// Diffuse albedo, Phong's diffuse share or a mirror's reflectance.
    reflectance: vec3<f32>,
    /// One of the MATERIAL_ constants.
    kind: u32,
    /// Factor on light that crosses a dielectric's boundary.
    tint: vec3<f32>,
    /// Index of refraction.
    ior: f32,
    /// Absorption coefficient of a dielectric's interior, 1/m.
    absorption: vec3<f32>,
    /// Exponent of Phong's specular lobe.
    shininess: f32,
    /// Phong's specular share.
    specular: vec3<f32>,
    /// Unused.
    padding_0: u32,
    /// Phong's factor on ambient light.
    ambient: vec3<f32>,
    /// Unused.
    padding_1: u32,
}

/// A spherical emitter.
struct SphereLight {
    /// Centre, metres, world frame.
    center: vec3<f32>,
    /// Radius, metres.
    radius: f32,
    /// Radiance, W/(m² sr).
    radiance: vec3<f32>,
    /// Probability with which the camera pass chooses a light up to and including this one.
    cumulative_probability: f32,
}

const MATERIAL_DIFFUSE: u32 = 0u;
const MATERIAL_PHONG: u32 = 1u;
const MATERIAL_MIRROR: u32 = 2u;
const MATERIAL_DIELECTRIC: u32 = 3u;

/// Marks the absence of an index.
const NONE: u32 = 0xffffffffu;

/// Width of the textures that hold records, texels, as a power of two. Record after record of 16-byte texels, row by row:
/// software adapters read texels far faster than storage buffers, and a texture may be larger than a storage binding.
const RECORDS_WIDTH_BITS: u32 = 13u;

/// BvhNode records of 5 texels.
@group(0) @binding(0) var nodes: texture_2d<u32>;
/// Triangle records of 3 texels, floating-point numbers as their bits.
@group(0) @binding(1) var triangles: texture_2d<u32>;
/// TriangleCorners records of 4 texels, floating-point numbers as their bits.
@group(0) @binding(2) var corners: texture_2d<u32>;
/// Object records of 1 texel.
@group(0) @binding(3) var objects: texture_2d<u32>;
/// Material records of 5 texels, floating-point numbers as their bits.
@group(0) @binding(4) var materials: texture_2d<u32>;
/// SphereLight records of 2 texels, floating-point numbers as their bits.
@group(0) @binding(5) var lights: texture_2d<u32>;
