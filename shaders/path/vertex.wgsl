// A surface that a path meets.

import package::bsdf::base::gloss_reflectance;
import package::bsdf::dispersion::split_colors;
import package::bsdf::specular::{outer_interface, Interface};
import package::geometry::surface::SurfacePoint;
import package::geometry::traverse::Hit;
import package::layout::features::has_dispersion;
import package::layout::path_pass::path_params;
import package::layout::scene::{Material, Triangle, MATERIAL_CASTER, MATERIAL_DIELECTRIC, MATERIAL_KIND_BITS, MATERIAL_RECEIVER};
import package::medium::media::{is_dispersive, media_beyond, medium_ior};
import package::path::state::{take_wavelength, Path};
import package::sampling::sobol::padded_1;
import package::spectrum::wavelength::at_wavelength;
import package::texture::surface::surface_at;

/// The least probability with which a path takes the gloss over a base.
const LEAST_GLOSS_CHANCE: f32 = 0.25;

/// A surface that a path has met.
struct Vertex {
    point: SurfacePoint,
    material: Material,
    kind: u32,
    is_caster: bool,
    is_receiver: bool,
    /// The indices on the two sides.
    sides: Interface,
    /// The media beyond, for light that is transmitted.
    beyond: vec4<u32>,
    /// Reflectance of the gloss over a receiver's base, seen along the path; 0 without either.
    gloss: vec3<f32>,
    /// The number of the choice between lobes, and its place among the path's choices.
    u: f32,
    choice: u32,
    /// Probability with which the path takes the specular lobe.
    specular_chance: f32,
}

/// The surface at `hit`. Its media say whether a boundary exists at all: where `beyond` begins with the same medium, it does not.
fn vertex_at(path: ptr<function, Path>, hit: Hit, triangle: Triangle) -> Vertex {
    let met = surface_at(hit, triangle, (*path).origin, (*path).direction);
    let material = met.material;
    let point = met.point;
    let media = (*path).media;
    let kind = material.kind & MATERIAL_KIND_BITS;
    var beyond = media;
    let choice = (*path).choices;
    var u = padded_1((*path).sample, (*path).seed, choice);
    u = select(u, (*path).fifth_number, choice == 0u && !has_dispersion);
    if kind == MATERIAL_DIELECTRIC {
        beyond = media_beyond(media, material.medium, point.front);
        let exists = beyond.x != media.x;
        if exists && (*path).wavelength.number < 0.0 && (is_dispersive(media) || is_dispersive(beyond)) {
            let cos_i = -dot((*path).direction, point.n_s);
            let split = split_colors(media, beyond, cos_i, material.gloss <= 0.0, u, (*path).fifth_number);
            (*path).fifth_number = split.xi;
            if split.takes_wavelength {
                take_wavelength(path);
            }
            u = split.u;
            (*path).beta *= at_wavelength(split.factor, (*path).wavelength);
        }
    }
    let ior = medium_ior(media, (*path).wavelength);
    var vertex = Vertex(
        point, material, kind, (material.kind & MATERIAL_CASTER) != 0u, (material.kind & MATERIAL_RECEIVER) != 0u,
        outer_interface(material, ior), beyond, vec3<f32>(0.0), u, choice, 1.0,
    );
    if kind == MATERIAL_DIELECTRIC {
        vertex.sides = Interface(ior, ior / medium_ior(beyond, (*path).wavelength));
    }
    if vertex.is_receiver {
        vertex.gloss = gloss_reflectance(material, -dot((*path).direction, point.n_s), vertex.sides);
        let mean = (vertex.gloss.x + vertex.gloss.y + vertex.gloss.z) / 3.0;
        // A weak gloss may reflect what is bright, so it is looked at more often than its share. A black base is not worth a choice.
        let chance = select(0.0, max(mean, LEAST_GLOSS_CHANCE), mean > 0.0);
        vertex.specular_chance = select(1.0, chance, any(material.base > vec3<f32>(0.0)));
    }
    return vertex;
}
