// Phase 2: one sample of every pixel. A path follows casters to the first receiver, which it shades with the light it can see
// and the irradiance in its energy map.

import package::bsdf::phong::receiver_bsdf;
import package::bsdf::specular::scatter_specular;
import package::emitter::sphere::{nearest_light, sample_sphere_cone};
import package::film::texels::footprint;
import package::layout::records::{load_light, load_material, load_triangle, record_texel};
import package::geometry::surface::{leave, surface_point, SurfacePoint};
import package::geometry::traverse::{trace, Hit};
import package::layout::camera_pass::{camera_params, film, irradiance};
import package::layout::scene::{Material, Triangle, MATERIAL_DIELECTRIC, MATERIAL_MIRROR, MATERIAL_PHONG, NONE};
import package::medium::absorption::transmittance;
import package::sampling::hash::combine;
import package::sampling::sobol::{padded_1, padded_2, sobol_5};
import package::sampling::warp::{disc, PI};

/// Slots of the padded numbers; choices between reflection and refraction have those below.
const SLOT_LIGHT: u32 = 2048u;
const SLOT_LIGHT_POINT: u32 = 2049u;
/// The share of the distance to a light that a shadow ray covers.
const SHADOW_RAY_LENGTH: f32 = 0.9999;
const FAR: f32 = 3.0e38;

/// A path from the lens into the scene.
struct Path {
    origin: vec3<f32>,
    direction: vec3<f32>,
    /// Radiance that arrives in the picture for radiance 1 along the ray.
    beta: vec3<f32>,
    /// Radiance gathered, W/(m² sr).
    radiance: vec3<f32>,
    /// Material of the medium that the ray is in, or NONE.
    medium: u32,
    /// Surfaces met.
    depth: u32,
    /// Choices between reflection and refraction made.
    choices: u32,
    first_choice: f32,
    /// Whether the ray asks for a light's visibility, and then its length and what it brings if nothing blocks it.
    is_shadow_ray: bool,
    length: f32,
    unblocked: vec3<f32>,
    /// Seed of the pixel's random numbers.
    seed: u32,
}

/// Offset from the pixel's centre, drawn with the filter's density. Steps of the table are even in the angle whose cosine is
/// 1 − 2u, which puts most where the filter's tails are.
fn filter_offset(u: f32) -> f32 {
    let at = acos(1.0 - 2.0 * u) * (63.0 / PI);
    let k = min(u32(at), 62u);
    let low = camera_params.filter_inverse_cdf[k >> 2u][k & 3u];
    let high = camera_params.filter_inverse_cdf[(k + 1u) >> 2u][(k + 1u) & 3u];
    return mix(low, high, at - f32(k));
}

/// The camera ray of this sample of a pixel.
fn start_path(pixel: vec2<u32>) -> Path {
    let seed = combine(camera_params.seed, pixel.y * camera_params.width + pixel.x);
    let numbers = sobol_5(camera_params.sample_index, seed);
    let u = numbers.first;
    let size = vec2<f32>(f32(camera_params.width), f32(camera_params.height));
    let at = vec2<f32>(pixel) + 0.5 + vec2<f32>(filter_offset(u.x), filter_offset(u.y));
    let screen = 2.0 * at / size - 1.0;
    let view = camera_params.forward + screen.x * camera_params.half_right - screen.y * camera_params.half_up;
    let lens = camera_params.aperture_radius * disc(u.zw);
    let on_lens = lens.x * camera_params.lens_right + lens.y * camera_params.lens_up;
    let direction = normalize(camera_params.focus_distance * view - on_lens);
    return Path(
        camera_params.position + on_lens, direction, vec3<f32>(1.0), vec3<f32>(0.0), NONE, 0u, 0u, numbers.fifth,
        false, FAR, vec3<f32>(0.0), seed,
    );
}

/// The number of the path's next choice between reflection and refraction.
fn next_choice(path: ptr<function, Path>) -> f32 {
    let choice = (*path).choices;
    (*path).choices = choice + 1u;
    if choice == 0u {
        return (*path).first_choice;
    }
    return padded_1(camera_params.sample_index, (*path).seed, choice);
}

/// Sends the path on from a mirror or a dielectric.
fn meet_caster(path: ptr<function, Path>, point: SurfacePoint, material_index: u32, material: Material) {
    let kind = material.kind;
    var u = 0.0;
    if kind == MATERIAL_DIELECTRIC {
        u = next_choice(path);
    }
    let ior = material.ior;
    let eta = select(ior, 1.0 / ior, point.front);
    let event = scatter_specular(kind, (*path).direction, point.n_g, point.n_s, eta, u);
    if event.transmitted {
        // Radiance is squeezed into a narrower cone in a denser medium: L/n² is what stays.
        (*path).beta *= material.tint * (eta * eta);
        (*path).medium = select(NONE, material_index, point.front);
    } else if kind == MATERIAL_MIRROR {
        (*path).beta *= material.reflectance;
    }
    (*path).origin = leave(point, event.direction);
    (*path).direction = event.direction;
}

/// The light that the first draw of this sample chooses.
fn choose_light(u: f32) -> u32 {
    var light = 0u;
    while light + 1u < camera_params.light_count && u >= load_light(light).cumulative_probability {
        light += 1u;
    }
    return light;
}

/// Turns the path into a shadow ray toward a point of one light.
fn aim_at_light(path: ptr<function, Path>, point: SurfacePoint, material: Material) {
    let index = choose_light(padded_1(camera_params.sample_index, (*path).seed, SLOT_LIGHT));
    let light = load_light(index);
    let before = select(0.0, load_light(max(index, 1u) - 1u).cumulative_probability, index > 0u);
    let probability = light.cumulative_probability - before;
    let u = padded_2(camera_params.sample_index, (*path).seed, SLOT_LIGHT_POINT);
    let to_light = sample_sphere_cone(light.center, light.radius, point.position, u);
    let cos_light = dot(to_light.direction, point.n_s);
    if to_light.solid_angle <= 0.0 || probability <= 0.0 || cos_light <= 0.0 || dot(to_light.direction, point.n_g) <= 0.0 {
        return;
    }
    let reflected = receiver_bsdf(material, to_light.direction, -(*path).direction, point.n_s);
    (*path).unblocked = (*path).beta * reflected * light.radiance * (cos_light * to_light.solid_angle / probability);
    (*path).is_shadow_ray = true;
    (*path).origin = leave(point, to_light.direction);
    (*path).direction = to_light.direction;
    (*path).length = SHADOW_RAY_LENGTH * to_light.distance;
}

/// Irradiance in a texel of the energy maps, W/m².
fn map_irradiance(texel: u32) -> vec3<f32> {
    return textureLoad(irradiance, record_texel(texel), 0).xyz;
}

/// Shades a receiver: ambient light, the caustics in its map, and one light's point, which the next ray tests.
fn meet_receiver(path: ptr<function, Path>, hit: Hit, triangle: Triangle, point: SurfacePoint, material: Material) {
    let place = footprint(hit, triangle.object, point.front);
    let caustic = place.weights.x * map_irradiance(place.texels.x) + place.weights.y * map_irradiance(place.texels.y)
        + place.weights.z * map_irradiance(place.texels.z) + place.weights.w * map_irradiance(place.texels.w);
    (*path).radiance += (*path).beta * material.reflectance / PI * caustic;
    if material.kind == MATERIAL_PHONG {
        (*path).radiance += (*path).beta * material.ambient * camera_params.ambient;
    }
    if camera_params.light_count > 0u {
        aim_at_light(path, point, material);
    }
}

/// Lets a path meet the triangle at `hit`; returns whether another ray follows.
fn meet_surface(path: ptr<function, Path>, hit: Hit) -> bool {
    let triangle = load_triangle(hit.triangle);
    let point = surface_point(hit, triangle, (*path).direction);
    let material = load_material(triangle.material);
    let kind = material.kind;
    if kind == MATERIAL_MIRROR || kind == MATERIAL_DIELECTRIC {
        meet_caster(path, point, triangle.material, material);
        (*path).depth += 1u;
        return (*path).depth < camera_params.max_depth;
    }
    meet_receiver(path, hit, triangle, point, material);
    return (*path).is_shadow_ray;
}

/// Lets a path see what lies along its ray; returns whether another ray follows.
fn advance(path: ptr<function, Path>) -> bool {
    let is_shadow_ray = (*path).is_shadow_ray;
    let light = nearest_light(camera_params.light_count, (*path).origin, (*path).direction, (*path).length);
    let hit = trace((*path).origin, (*path).direction, light.t, is_shadow_ray);
    let met_light = light.t < (*path).length;
    if is_shadow_ray {
        if hit.triangle == NONE && !met_light {
            (*path).radiance += (*path).unblocked;
        }
        return false;
    }
    if hit.triangle != NONE {
        (*path).beta *= transmittance((*path).medium, hit.t);
        return meet_surface(path, hit);
    }
    if met_light {
        (*path).radiance += (*path).beta * transmittance((*path).medium, light.t) * load_light(light.light).radiance;
    } else {
        (*path).radiance += (*path).beta * camera_params.background;
    }
    return false;
}

/// The pixel of an invocation: along a Z-order curve within its 8 × 8 tile, so that neighbouring lanes see alike.
fn pixel_of(group: vec2<u32>, local: u32) -> vec2<u32> {
    let x = (local & 1u) | ((local >> 1u) & 2u) | ((local >> 2u) & 4u);
    let y = ((local >> 1u) & 1u) | ((local >> 2u) & 2u) | ((local >> 3u) & 4u);
    return 8u * group + vec2<u32>(x, y);
}

@compute @workgroup_size(64)
fn sample_pixels(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let pixel = pixel_of(group.xy, local);
    if pixel.x >= camera_params.width || pixel.y >= camera_params.height {
        return;
    }
    // One path a lane: starting the next sample as soon as one ends fills the lanes better, but every step then costs a start
    // too, which on software adapters is more.
    var path = start_path(pixel);
    var rays = 0u;
    var finished = false;
    loop {
        rays += 1u;
        if !advance(&path) {
            finished = true;
            break;
        }
    }
    if !finished {
        atomicAdd(&film.unfinished, 1u);
    }
    if atomicAdd(&film.rays_low, rays) > 0xffffffffu - rays {
        atomicAdd(&film.rays_high, 1u);
    }
    film.pixels[pixel.y * camera_params.width + pixel.x] += vec4<f32>(path.radiance, 1.0);
}
