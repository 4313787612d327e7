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
    /// The TRIANGLE_ bits that apply.
    flags: u32,
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
    /// Charts of the object's map; 0 without one.
    charts: u32,
    /// Texel column and row of the first corner, then of the second.
    texel_01: vec4<f32>,
}

/// Texture coordinates of a triangle's corners, in the order of the triangles.
struct TextureCoordinates {
    /// Those of the first corner, then of the second.
    uv_01: vec4<f32>,
    /// Those of the third corner.
    uv_2: vec2<f32>,
    /// Unit tangents of the corners, world frame, along s of the normal map's picture; 0 without. Six octahedral coordinates of TANGENT_BITS bits, three in the first word,
    /// with TANGENT_PRESENT, and with TANGENT_LEFT where t grows against normal × tangent, and three in the second.
    tangents: vec2<u32>,
}

/// Factors on the colour and the opacity of a triangle at its corners, in the order of the triangles: red and green, then blue and opacity, in half precision.
struct VertexColors {
    /// That of the first corner.
    color_0: vec2<u32>,
    /// That of the second corner.
    color_1: vec2<u32>,
    /// That of the third corner.
    color_2: vec2<u32>,
    /// Unused.
    padding: vec2<u32>,
}

/// The pictures of a material: indices of SurfaceTexture records, or NONE.
struct MaterialTextures {
    /// Factor on the material's colour.
    color: u32,
    /// Factor on its roughness.
    roughness: u32,
    /// Factor on its share of metal.
    metallic: u32,
    /// Factor on its emission.
    emission: u32,
    /// Its normal map.
    normal: u32,
    /// Factor on a normal map's components along the surface.
    normal_strength: f32,
    /// Factor on its opacity.
    opacity: u32,
    /// Opacity before the picture.
    opacity_factor: f32,
    /// Opacity from which on a surface is whole, and below which it is a hole; negative where it is neither.
    opacity_cutoff: f32,
    /// Index of the material that the surface is for the rest of the light, or NONE.
    rest: u32,
    /// Share of the light that meets this material and not the rest, before its picture.
    share: f32,
    /// Factor on that share.
    share_picture: u32,
}

/// A picture as it lies on a surface.
struct SurfaceTexture {
    /// Index of the picture's first texel, which is even.
    first_texel: u32,
    /// Texels along its upper side.
    width: u32,
    /// Texels along its left side.
    height: u32,
    /// How it wraps, a WRAP_ constant for each axis of two bits each; TEXTURE_NEAREST; from TEXTURE_CHANNEL_SHIFT on the channel that a number is read from.
    flags: u32,
    /// s on the picture: factors of u, v and 1.
    s_from_uv: vec3<f32>,
    /// Unused.
    padding_s: u32,
    /// t on the picture: factors of u, v and 1.
    t_from_uv: vec3<f32>,
    /// Unused.
    padding_t: u32,
}

/// A layer of an object's energy map, whose plane is divided into squares.
struct MapLayer {
    /// Index of the first MapSquare record, row by row.
    first_square: u32,
    /// Squares along x, and from bit 16 on along y.
    squares: u32,
    /// Squares along x for each unit of the plane.
    scale_x: f32,
    /// The same along y.
    scale_y: f32,
}

/// A square of a map's plane, which is divided into parts.
struct MapSquare {
    /// Index of the first part's MapTile record, row by row.
    first_part: u32,
    /// Parts along each side: a power of two.
    side: u32,
    /// Unused.
    padding: vec2<u32>,
}

/// The tile that a part of a square lies on.
struct MapTile {
    /// Index of its first texel, row by row.
    first_texel: u32,
    /// Cells along x and, from bit MAP_TILE_ROWS_SHIFT on, along y: one less than texels. From MAP_TILE_LEVEL_SHIFT on its level against the squares, plus MAP_TILE_LEVEL_BIAS.
    cells: u32,
    /// Where its first texel stands, in squares.
    origin_x: f32,
    /// The same along y.
    origin_y: f32,
}

/// Where the rows of a tile's cells stand.
const MAP_TILE_ROWS_SHIFT: u32 = 13u;
/// Where its level stands.
const MAP_TILE_LEVEL_SHIFT: u32 = 26u;
/// What is added to its level.
const MAP_TILE_LEVEL_BIAS: u32 = 16u;

/// What a surface does to light; docs/materials.md. Which fields count depends on `kind`.
struct Material {
    /// Effective albedo ρ* of the base: what a diffuse surface reflects, or what lies under a coat or gloss. Of a textured surface the colour before its picture. Of a dielectric its indices for red, green and blue.
    base: vec3<f32>,
    /// One of the MATERIAL_ constants, with the bits MATERIAL_CASTER and MATERIAL_RECEIVER; from MATERIAL_GROUP_SHIFT on the index of its light group.
    kind: u32,
    /// A mirror's reflectance, a conductor's real index, Schlick's reflectance along the normal (of a textured surface that of what is no metal), Phong's specular share. Of a dielectric, x is the row of its indices among the spectra, or negative without dispersion.
    specular: vec3<f32>,
    /// Index of refraction; exponent of Phong's specular lobe.
    ior: f32,
    /// Absorption coefficient of a dielectric's interior, 1/m; a conductor's imaginary index. Of coats x is their reflectance from within, of textured surfaces of glTF's model the share of metal.
    extinction: vec3<f32>,
    /// Width α of the microfacets' distribution, 0 for a smooth surface. Of a textured surface the roughness before its picture.
    gloss: f32,
    /// Factor on light that is transmitted; Phong's factor on ambient light.
    tint: vec3<f32>,
    /// A dielectric's key in lists of media: its rank plus 1 in the upper half, its material's index in the lower.
    medium: u32,
    /// Radiance of the front, W/(m² sr).
    emission: vec3<f32>,
    /// Density with which next-event estimation chooses a point of the surface, 1/m²; 0 without emission.
    emission_pdf_area: f32,
}

/// An emitter. Which fields count depends on `kind`.
struct Light {
    /// Centre or position, metres; of a distant light the unit direction toward it. World frame.
    position: vec3<f32>,
    /// Radius of a sphere, metres; area of a surface, m²; of a distant disc 1 − cos of its angular radius, 0 for parallel light.
    extent: f32,
    /// Radiance, W/(m² sr), or of points and spots intensity, W/sr, or of parallel light irradiance, W/m²; factor on an environment's radiance.
    strength: vec3<f32>,
    /// Probability with which the camera pass chooses a light up to and including this one.
    cumulative_probability: f32,
    /// Unit axis of a spot, or of the sphere of the profile `paper`; cosine and sine of an environment's turn about +y.
    axis: vec3<f32>,
    /// One of the LIGHT_ constants; from LIGHT_GROUP_SHIFT on the index of its group.
    kind: u32,
    /// Cosine of the angle up to which a spot shines fully.
    cos_inner: f32,
    /// Cosine of the angle beyond which a spot is dark.
    cos_outer: f32,
    /// A surface's first entry among the emitting triangles; an environment's width, texels.
    first: u32,
    /// A surface's number of emitting triangles; an environment's height, texels.
    count: u32,
}

const MATERIAL_DIFFUSE: u32 = 0u;
const MATERIAL_PHONG: u32 = 1u;
const MATERIAL_MIRROR: u32 = 2u;
const MATERIAL_DIELECTRIC: u32 = 3u;
const MATERIAL_CONDUCTOR: u32 = 4u;
const MATERIAL_THIN_WALLED: u32 = 5u;
const MATERIAL_COATED: u32 = 6u;
const MATERIAL_METALLIC_ROUGHNESS: u32 = 7u;
/// The bits of `Material::kind` that tell the kind.
const MATERIAL_KIND_BITS: u32 = 0xffu;
/// Set where light that meets the surface is sent on by photons.
const MATERIAL_CASTER: u32 = 0x100u;
/// Set where the surface has a diffuse lobe and an energy map.
const MATERIAL_RECEIVER: u32 = 0x200u;
/// Set where pictures or vertex colours make the surface differ from point to point.
const MATERIAL_TEXTURED: u32 = 0x400u;
/// Where the index of the light group stands in `Material::kind`.
const MATERIAL_GROUP_SHIFT: u32 = 16u;

/// Set where the corners' normals are interpolated.
const TRIANGLE_SMOOTH: u32 = 1u;
/// Set where rays may pass through.
const TRIANGLE_HAS_HOLES: u32 = 2u;
/// Set where the material has a rest.
const TRIANGLE_BLENDED: u32 = 4u;

/// Bits of a tangent's coordinate.
const TANGENT_BITS: u32 = 10u;
/// What a coordinate of 1 is, and what is added to it.
const TANGENT_SCALE: u32 = 511u;
/// Set in the first word of tangents that there are.
const TANGENT_PRESENT: u32 = 0x80000000u;
/// Set there where t grows against normal × tangent.
const TANGENT_LEFT: u32 = 0x40000000u;

const WRAP_REPEAT: u32 = 0u;
const WRAP_MIRROR: u32 = 1u;
const WRAP_CLAMP: u32 = 2u;
/// Set where a place has the texel that it lies in.
const TEXTURE_NEAREST: u32 = 16u;
/// Where the channel stands in a texture's flags.
const TEXTURE_CHANNEL_SHIFT: u32 = 8u;

const LIGHT_SPHERE: u32 = 0u;
const LIGHT_POINT: u32 = 1u;
const LIGHT_SPOT: u32 = 2u;
const LIGHT_SURFACE: u32 = 3u;
const LIGHT_DISTANT: u32 = 4u;
const LIGHT_ENVIRONMENT: u32 = 5u;
/// The bits of `Light::kind` that tell the kind.
const LIGHT_KIND_BITS: u32 = 0xffu;
/// Where the index of the group stands in it.
const LIGHT_GROUP_SHIFT: u32 = 16u;

/// Marks the absence of an index.
const NONE: u32 = 0xffffffffu;

/// Width of the textures that hold records, texels, as a power of two. Record after record of 16-byte texels, row by row:
/// software adapters read texels far faster than storage buffers, and a texture may be larger than a storage binding.
const RECORDS_WIDTH_BITS: u32 = 13u;

/// Steps of what the spectra's tables hold, evenly in ξ.
const WAVELENGTH_STEPS: u32 = 512u;

/// BvhNode records of 5 texels.
@group(0) @binding(0) var nodes: texture_2d<u32>;
/// Triangle records of 3 texels, floating-point numbers as their bits.
@group(0) @binding(1) var triangles: texture_2d<u32>;
/// TriangleCorners records of 4 texels, floating-point numbers as their bits.
@group(0) @binding(2) var corners: texture_2d<u32>;
/// MapLayer records, two for each object, of its front and its back, then MapSquare and MapTile records, of 1 texel each. The indices in them
/// count from the first texel.
@group(0) @binding(3) var maps: texture_2d<u32>;
/// Material records of 5 texels, floating-point numbers as their bits.
@group(0) @binding(4) var materials: texture_2d<u32>;
/// Light records of 4 texels, floating-point numbers as their bits: first spheres, last distant lights and the environment.
@group(0) @binding(5) var lights: texture_2d<u32>;
/// Emitting triangles, a texel each, light by light: index of the triangle, and as bits the share of the light's area up to and including it.
@group(0) @binding(6) var emitting_triangles: texture_2d<u32>;
/// The environment, floating-point numbers as their bits. First a texel for each row of its picture: the probability of a row up to and
/// including it. Then the picture, row by row from the top: radiance, W/(m² sr), and the probability, within the row, of a column up to
/// and including this one.
@group(0) @binding(7) var environment: texture_2d<u32>;
/// TextureCoordinates records of 2 texels, floating-point numbers as their bits; without textures, a single one.
@group(0) @binding(8) var texture_coordinates: texture_2d<u32>;
/// MaterialTextures records of 3 texels, floating-point numbers as their bits.
@group(0) @binding(9) var material_textures: texture_2d<u32>;
/// SurfaceTexture records of 3 texels, floating-point numbers as their bits.
@group(0) @binding(10) var surface_textures: texture_2d<u32>;
/// The pictures' texels of four half-precision numbers, two in each, row by row from the top.
@group(0) @binding(11) var texture_texels: texture_2d<u32>;
/// Floating-point numbers as their bits. First a texel whose x is the number ξ of all light's wavelength, or negative. Then, for each step of ξ, two texels: the
/// weight of its wavelength, and the primaries' spectra there. Then a row for each dielectric with dispersion, of a texel for each step: its
/// index of refraction there and at the next.
@group(0) @binding(12) var spectra: texture_2d<u32>;
/// VertexColors records of 2 texels; without factors at vertices, a single one.
@group(0) @binding(13) var vertex_colors: texture_2d<u32>;
