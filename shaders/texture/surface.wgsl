// What pictures and vertex colours make of a surface at a point; docs/materials.md, "Textures".

import package::geometry::surface::{surface_point, SurfacePoint};
import package::geometry::traverse::Hit;
import package::layout::features::{has_gloss, has_textures, has_vertex_colors};
import package::layout::records::{load_material, load_material_textures, load_surface_texture, load_texture_coordinates, load_vertex_colors};
import package::layout::scene::{
    Material, Triangle, MATERIAL_COATED, MATERIAL_KIND_BITS, MATERIAL_METALLIC_ROUGHNESS, MATERIAL_MIRROR, MATERIAL_TEXTURED, NONE,
};
import package::texture::blend::material_taken;
import package::texture::lookup::{channel_of, interpolate_uv, sample_texture};
import package::texture::tangent::mapped_normal;

/// Roughness under which a surface is perfectly smooth.
const SMOOTH: f32 = 0.03;

/// Slots of a material's pictures, in the order in which they are looked up.
const SLOT_COLOR: u32 = 0u;
const SLOT_ROUGHNESS: u32 = 1u;
const SLOT_METALLIC: u32 = 2u;
const SLOT_EMISSION: u32 = 3u;
const SLOT_NORMAL: u32 = 4u;
const SLOTS: u32 = 5u;

/// A textured surface at a point.
struct TexturedSurface {
    material: Material,
    point: SurfacePoint,
}

/// The factor that a triangle's vertex colours make at a hit.
fn vertex_color(hit: Hit) -> vec3<f32> {
    let c = load_vertex_colors(hit.triangle);
    let b = hit.barycentric;
    let red_green = (1.0 - b.x - b.y) * unpack2x16float(c.color_0.x) + b.x * unpack2x16float(c.color_1.x) + b.y * unpack2x16float(c.color_2.x);
    let blue = (1.0 - b.x - b.y) * unpack2x16float(c.color_0.y) + b.x * unpack2x16float(c.color_1.y) + b.y * unpack2x16float(c.color_2.y);
    return vec3<f32>(red_green, blue.x);
}

/// A material before `derive`, its colour times a factor.
fn colored(source: Material, factor: vec3<f32>) -> Material {
    var material = source;
    material.base *= factor;
    material.tint *= factor;
    material.specular *= select(vec3<f32>(1.0), factor, (source.kind & MATERIAL_KIND_BITS) == MATERIAL_MIRROR);
    return material;
}

/// What follows from a material's colour, roughness and share of metal at the point.
fn derive(source: Material) -> Material {
    var material = source;
    material.gloss = select(source.gloss * source.gloss, 0.0, source.gloss < SMOOTH);
    let kind = source.kind & MATERIAL_KIND_BITS;
    if has_gloss && kind == MATERIAL_COATED {
        material.base = source.base / (source.ior * source.ior * (1.0 - source.base * source.extinction.x));
    }
    if has_gloss && kind == MATERIAL_METALLIC_ROUGHNESS {
        let metallic = source.extinction.x;
        let f_0 = mix(source.specular, source.base, metallic);
        let average = f_0 + (1.0 - f_0) / 21.0;
        material.base = (1.0 - metallic) * source.base / max(1.0 - average, vec3<f32>(1e-30));
        material.specular = f_0;
    }
    return material;
}

/// The surface at a hit, seen along `direction`, from its material, of index `index`, and point before pictures.
fn textured_surface(source: Material, index: u32, untextured: SurfacePoint, hit: Hit, direction: vec3<f32>) -> TexturedSurface {
    let textures = load_material_textures(index);
    let coordinates = load_texture_coordinates(hit.triangle);
    let uv = interpolate_uv(coordinates, hit.barycentric);
    var material = source;
    if has_vertex_colors {
        material = colored(source, vertex_color(hit));
    }
    var point = untextured;
    let slots = array<u32, SLOTS>(textures.color, textures.roughness, textures.metallic, textures.emission, textures.normal);
    // A loop rather than five calls, for calls are inlined.
    for (var slot = 0u; slot < SLOTS; slot++) {
        if slots[slot] == NONE {
            continue;
        }
        let texture = load_surface_texture(slots[slot]);
        let value = sample_texture(texture, uv);
        let number = channel_of(texture, value);
        material = colored(material, select(vec3<f32>(1.0), value.xyz, slot == SLOT_COLOR));
        material.gloss *= select(1.0, number, slot == SLOT_ROUGHNESS);
        material.extinction *= select(1.0, number, slot == SLOT_METALLIC);
        material.emission *= select(vec3<f32>(1.0), value.xyz, slot == SLOT_EMISSION);
        if slot == SLOT_NORMAL {
            let n = select(-point.n_smooth, point.n_smooth, point.front);
            let mapped = mapped_normal(coordinates.tangents, hit.barycentric, textures.normal_strength, value.xyz, n);
            point.n_smooth = select(-mapped, mapped, point.front);
            point.n_s = select(point.n_s, point.n_smooth, dot(direction, point.n_smooth) < 0.0);
        }
    }
    return TexturedSurface(derive(material), point);
}

/// The surface that a ray meets at a hit, with its pictures and vertex colours if it has any.
fn surface_at(hit: Hit, triangle: Triangle, origin: vec3<f32>, direction: vec3<f32>) -> TexturedSurface {
    let point = surface_point(hit, triangle, direction);
    let index = material_taken(hit, triangle, origin, direction);
    let material = load_material(index);
    if has_textures && (material.kind & MATERIAL_TEXTURED) != 0u {
        return textured_surface(material, index, point, hit, direction);
    }
    return TexturedSurface(material, point);
}
