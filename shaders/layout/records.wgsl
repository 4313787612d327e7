// Records of the scene's textures.

import package::layout::scene::{
    corners, emitting_triangles, environment, lights, maps, material_textures, materials, nodes, spectra, surface_textures, texture_coordinates,
    texture_texels, triangles, vertex_colors, BvhNode, Light, MapLayer, MapSquare, MapTile, Material, MaterialTextures, SurfaceTexture, TextureCoordinates, Triangle, TriangleCorners, VertexColors,
    LIGHT_GROUP_SHIFT, LIGHT_KIND_BITS, RECORDS_WIDTH_BITS, WAVELENGTH_STEPS,
};

/// The place of a texel, counted row by row.
fn record_texel(index: u32) -> vec2<u32> {
    return vec2<u32>(index & ((1u << RECORDS_WIDTH_BITS) - 1u), index >> RECORDS_WIDTH_BITS);
}

fn load_node(index: u32) -> BvhNode {
    let first = 5u * index;
    return BvhNode(
        textureLoad(nodes, record_texel(first), 0),
        textureLoad(nodes, record_texel(first + 1u), 0),
        textureLoad(nodes, record_texel(first + 2u), 0),
        textureLoad(nodes, record_texel(first + 3u), 0),
        textureLoad(nodes, record_texel(first + 4u), 0),
    );
}

fn load_triangle(index: u32) -> Triangle {
    let first = 3u * index;
    let texel_0 = textureLoad(triangles, record_texel(first), 0);
    let texel_1 = textureLoad(triangles, record_texel(first + 1u), 0);
    let texel_2 = textureLoad(triangles, record_texel(first + 2u), 0);
    return Triangle(
        bitcast<vec3<f32>>(texel_0.xyz), texel_0.w,
        bitcast<vec3<f32>>(texel_1.xyz), texel_1.w,
        bitcast<vec3<f32>>(texel_2.xyz), texel_2.w,
    );
}

fn load_corners(index: u32) -> TriangleCorners {
    let first = 4u * index;
    let texel_0 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first), 0));
    let texel_1 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first + 1u), 0));
    let texel_2 = textureLoad(corners, record_texel(first + 2u), 0);
    let texel_3 = bitcast<vec4<f32>>(textureLoad(corners, record_texel(first + 3u), 0));
    return TriangleCorners(
        texel_0.xyz, texel_0.w, texel_1.xyz, texel_1.w, bitcast<vec3<f32>>(texel_2.xyz), texel_2.w, texel_3,
    );
}

/// A layer of a map, two for each object.
fn load_map_layer(index: u32) -> MapLayer {
    let texel = textureLoad(maps, record_texel(index), 0);
    return MapLayer(texel.x, texel.y, bitcast<f32>(texel.z), bitcast<f32>(texel.w));
}

fn load_map_square(index: u32) -> MapSquare {
    let texel = textureLoad(maps, record_texel(index), 0);
    return MapSquare(texel.x, texel.y, texel.zw);
}

fn load_map_tile(index: u32) -> MapTile {
    let texel = textureLoad(maps, record_texel(index), 0);
    return MapTile(texel.x, texel.y, bitcast<f32>(texel.z), bitcast<f32>(texel.w));
}

fn load_material(index: u32) -> Material {
    let first = 5u * index;
    let texel_0 = textureLoad(materials, record_texel(first), 0);
    let texel_1 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 1u), 0));
    let texel_2 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 2u), 0));
    let texel_3 = textureLoad(materials, record_texel(first + 3u), 0);
    let texel_4 = bitcast<vec4<f32>>(textureLoad(materials, record_texel(first + 4u), 0));
    return Material(
        bitcast<vec3<f32>>(texel_0.xyz), texel_0.w,
        texel_1.xyz, texel_1.w,
        texel_2.xyz, texel_2.w,
        bitcast<vec3<f32>>(texel_3.xyz), texel_3.w,
        texel_4.xyz, texel_4.w,
    );
}

/// A dielectric's index of refraction.
struct StatedIndex {
    /// The index, or of one with dispersion that at the stated wavelength.
    ior: f32,
    /// Its row among the spectra; negative without dispersion.
    row: f32,
}

fn load_index(material: u32) -> StatedIndex {
    let texel = bitcast<vec4<f32>>(textureLoad(materials, record_texel(5u * material + 1u), 0));
    return StatedIndex(texel.w, texel.x);
}

/// A dielectric's indices of refraction for red, green and blue light as a whole.
fn load_colored_index(material: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(materials, record_texel(5u * material), 0).xyz);
}

/// The absorption coefficient alone of a dielectric, 1/m.
fn load_absorption(index: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(textureLoad(materials, record_texel(5u * index + 2u), 0).xyz);
}

fn load_light(index: u32) -> Light {
    let first = 4u * index;
    let texel_0 = bitcast<vec4<f32>>(textureLoad(lights, record_texel(first), 0));
    let texel_1 = bitcast<vec4<f32>>(textureLoad(lights, record_texel(first + 1u), 0));
    let texel_2 = textureLoad(lights, record_texel(first + 2u), 0);
    let texel_3 = textureLoad(lights, record_texel(first + 3u), 0);
    return Light(
        texel_0.xyz, texel_0.w,
        texel_1.xyz, texel_1.w,
        bitcast<vec3<f32>>(texel_2.xyz), texel_2.w & LIGHT_KIND_BITS,
        bitcast<f32>(texel_3.x), bitcast<f32>(texel_3.y), texel_3.z, texel_3.w,
    );
}

/// The index of a light's group.
fn load_light_group(light: u32) -> u32 {
    return textureLoad(lights, record_texel(4u * light + 2u), 0).w >> LIGHT_GROUP_SHIFT;
}

/// Centre and radius alone of a sphere, metres.
fn load_sphere(light: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(lights, record_texel(4u * light), 0));
}

/// Probability with which the camera pass chooses a light up to and including this one.
fn load_cumulative_probability(light: u32) -> f32 {
    return bitcast<f32>(textureLoad(lights, record_texel(4u * light + 1u), 0).w);
}

/// An emitting triangle: the index of the triangle, then as bits the share of its light's area up to and including it.
fn load_emitting_triangle(entry: u32) -> vec2<u32> {
    return textureLoad(emitting_triangles, record_texel(entry), 0).xy;
}

/// A texel of the environment's record.
fn load_environment(index: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(environment, record_texel(index), 0));
}

fn load_texture_coordinates(triangle: u32) -> TextureCoordinates {
    let texel_0 = bitcast<vec4<f32>>(textureLoad(texture_coordinates, record_texel(2u * triangle), 0));
    let texel_1 = textureLoad(texture_coordinates, record_texel(2u * triangle + 1u), 0);
    return TextureCoordinates(texel_0, bitcast<vec2<f32>>(texel_1.xy), texel_1.zw);
}

fn load_vertex_colors(triangle: u32) -> VertexColors {
    let texel_0 = textureLoad(vertex_colors, record_texel(2u * triangle), 0);
    let texel_1 = textureLoad(vertex_colors, record_texel(2u * triangle + 1u), 0);
    return VertexColors(texel_0.xy, texel_0.zw, texel_1.xy, texel_1.zw);
}

/// The pictures of a material.
fn load_material_textures(material: u32) -> MaterialTextures {
    let first = 3u * material;
    let texel_0 = textureLoad(material_textures, record_texel(first), 0);
    let texel_1 = textureLoad(material_textures, record_texel(first + 1u), 0);
    let texel_2 = textureLoad(material_textures, record_texel(first + 2u), 0);
    return MaterialTextures(
        texel_0.x, texel_0.y, texel_0.z, texel_0.w,
        texel_1.x, bitcast<f32>(texel_1.y), texel_1.z, bitcast<f32>(texel_1.w),
        bitcast<f32>(texel_2.x), texel_2.y, bitcast<f32>(texel_2.z), texel_2.w,
    );
}

fn load_surface_texture(index: u32) -> SurfaceTexture {
    let first = 3u * index;
    let texel_0 = textureLoad(surface_textures, record_texel(first), 0);
    let texel_1 = bitcast<vec4<f32>>(textureLoad(surface_textures, record_texel(first + 1u), 0));
    let texel_2 = bitcast<vec4<f32>>(textureLoad(surface_textures, record_texel(first + 2u), 0));
    return SurfaceTexture(texel_0.x, texel_0.y, texel_0.z, texel_0.w, texel_1.xyz, 0u, texel_2.xyz, 0u);
}

/// A picture's texel, by its place among the texels of all pictures.
fn load_texture_texel(index: u32) -> vec4<f32> {
    let pair = textureLoad(texture_texels, record_texel(index >> 1u), 0);
    let halves = select(pair.xy, pair.zw, (index & 1u) != 0u);
    return vec4<f32>(unpack2x16float(halves.x), unpack2x16float(halves.y));
}

/// The number ξ of the wavelength that all light has, or negative.
fn load_fixed_wavelength() -> f32 {
    return bitcast<f32>(textureLoad(spectra, record_texel(0u), 0).x);
}

/// A place between two steps of ξ.
struct WavelengthStep {
    index: u32,
    part: f32,
}

fn wavelength_step(number: f32) -> WavelengthStep {
    let at = number * f32(WAVELENGTH_STEPS);
    let index = min(u32(at), WAVELENGTH_STEPS - 1u);
    return WavelengthStep(index, at - f32(index));
}

/// The color of a wavelength.
struct WavelengthColor {
    /// That of white light of this wavelength alone, over the density with which it is drawn.
    weight: vec3<f32>,
    /// The values there of the primaries' spectra.
    primaries: vec3<f32>,
}

fn load_color_of_wavelength(number: f32) -> WavelengthColor {
    let step = wavelength_step(number);
    let first = 1u + 2u * step.index;
    let weight_0 = bitcast<vec3<f32>>(textureLoad(spectra, record_texel(first), 0).xyz);
    let primaries_0 = bitcast<vec3<f32>>(textureLoad(spectra, record_texel(first + 1u), 0).xyz);
    let weight_1 = bitcast<vec3<f32>>(textureLoad(spectra, record_texel(first + 2u), 0).xyz);
    let primaries_1 = bitcast<vec3<f32>>(textureLoad(spectra, record_texel(first + 3u), 0).xyz);
    return WavelengthColor(mix(weight_0, weight_1, step.part), mix(primaries_0, primaries_1, step.part));
}

/// The index of refraction in a row of the spectra at a wavelength.
fn load_index_at(row: u32, number: f32) -> f32 {
    let step = wavelength_step(number);
    let rows = 1u + 2u * (WAVELENGTH_STEPS + 1u);
    let pair = bitcast<vec2<f32>>(textureLoad(spectra, record_texel(rows + WAVELENGTH_STEPS * row + step.index), 0).xy);
    return mix(pair.x, pair.y, step.part);
}
