// Phase 1: photons leave the lights and fill the energy maps. docs/photon-paths.md defines each step.

import package::bsdf::base::gloss_reflectance;
import package::bsdf::dispersion::split_colors;
import package::bsdf::specular::{adjoint_factor, landing_factor, outer_interface, scatter_specular, Interface};
import package::deposit::ellipse::{add_ellipse, PlaneAxes};
import package::deposit::sums::add_around;
import package::emitter::emission::{emit, Emission};
import package::emitter::guide::{guide_numbers, GuidedNumbers};
import package::emitter::sphere::nearest_sphere;
import package::film::fixed_point::carry;
import package::film::texels::{map_layer, map_place, tile_at};
import package::geometry::differential::{normal_change, plane_change, transfer, turn_change, Differential};
import package::layout::features::{has_dispersion, has_footprints, has_guide, paper_refraction, photon_light_kind, PAPER_NONE};
import package::layout::records::{load_corners, load_triangle};
import package::geometry::surface::{leave, SurfacePoint};
import package::geometry::traverse::{trace, Hit};
import package::layout::photon_pass::{
    landings, ledger, photon_params, Landing, LEDGER_ABSORBED, LEDGER_ACCOUNTS, LEDGER_CUT_OFF, LEDGER_DEPOSITED, LEDGER_DIRECT,
    LEDGER_DISPERSION, LEDGER_EMITTED, LEDGER_ESCAPED, LEDGER_SHADING_NORMALS, LOST,
};
import package::layout::scene::{
    Material, MATERIAL_CASTER, MATERIAL_DIELECTRIC, MATERIAL_KIND_BITS, MATERIAL_MIRROR, MATERIAL_RECEIVER, NONE,
    LIGHT_DISTANT, LIGHT_ENVIRONMENT, MATERIAL_THIN_WALLED, Triangle,
};
import package::medium::media::{is_dispersive, media_beyond, medium_ior, transmittance};
import package::paper::emission::emit_by_equation_1;
import package::sampling::sobol::{padded_1, padded_2, sobol_5};
import package::sampling::warp::frame;
import package::spectrum::wavelength::{at_wavelength, draw_wavelength, first_wavelength, Wavelength};
import package::texture::surface::surface_at;

/// First slot of the padded numbers for microfacet normals; choices have those below.
const SLOT_MICROFACET: u32 = 4096u;

/// A photon in flight.
struct Photon {
    /// Its number within its light.
    index: u32,
    origin: vec3<f32>,
    direction: vec3<f32>,
    /// Flux, W.
    beta: vec3<f32>,
    /// The same in units of the fixed-point sums: what the ledger says the photon still has.
    units: vec3<i32>,
    /// The media that it flies in.
    media: vec4<u32>,
    /// Casters met.
    depth: u32,
    /// Choices made.
    choices: u32,
    /// The number of its first choice, in scenes with dispersion that of its wavelength.
    fifth_number: f32,
    wavelength: Wavelength,
    /// How its ray changes over its part of the emission.
    differential: Differential,
    /// Whether that is known: no rough surface has spread it.
    has_footprint: bool,
}

/// The largest flux of one photon in units; more can only come from interpolated normals, whose account takes the rest.
const MAX_UNITS: f32 = 67108864.0;

/// Per-invocation sums of the ledger, units of the fixed-point sums.
var<private> accounts: array<vec3<i32>, LEDGER_ACCOUNTS>;

/// Photons that this invocation has deposited.
var<private> deposits: u32;

fn to_units(beta: vec3<f32>) -> vec3<i32> {
    return vec3<i32>(round(clamp(beta * photon_params.units_per_watt, vec3<f32>(-MAX_UNITS), vec3<f32>(MAX_UNITS))));
}

/// Whether photons are thrown away but for where they land.
fn is_pilot() -> bool {
    return photon_params.pilot != 0u;
}

/// The least number of photons that a footprint is made for.
const LEAST_COUNT: u32 = 16384u;
/// The area of emission that a footprint covers, in shares of one photon.
const FOOTPRINT_SHARES: f32 = 4.0;

/// Two directions of the emission, as long as the deviation of the photon's share of it.
fn emitted_differential(emission: Emission, index: u32, density: f32) -> Differential {
    let count = max(f32(1u << min(32u - countLeadingZeros(index), 31u)), f32(LEAST_COUNT));
    let width = sqrt(FOOTPRINT_SHARES / 12.0 * emission.spread / (count * density));
    let basis = frame(emission.direction);
    let a = width * basis.tangent;
    let b = width * basis.bitangent;
    let none = vec3<f32>(0.0);
    if photon_light_kind == LIGHT_DISTANT || photon_light_kind == LIGHT_ENVIRONMENT {
        return Differential(a, b, none, none);
    }
    return Differential(none, none, a, b);
}

/// Moves the differential to the hit.
fn transfer_differential(photon: ptr<function, Photon>, t: f32, n_g: vec3<f32>) {
    let r = (*photon).differential;
    let d = (*photon).direction;
    (*photon).differential.origin_1 = transfer(r.origin_1, r.direction_1, d, t, n_g);
    (*photon).differential.origin_2 = transfer(r.origin_2, r.direction_2, d, t, n_g);
}

/// Turns the differential at a surface, from direction d.
fn turn_differential(
    photon: ptr<function, Photon>, hit: Hit, triangle: Triangle, point: SurfacePoint, n: vec3<f32>, after: vec3<f32>, eta: f32, transmitted: bool,
) {
    let r = (*photon).differential;
    let d = (*photon).direction;
    let dn_1 = normal_change(hit, triangle, point, n, r.origin_1);
    let dn_2 = normal_change(hit, triangle, point, n, r.origin_2);
    (*photon).differential.direction_1 = turn_change(d, r.direction_1, n, dn_1, after, eta, transmitted);
    (*photon).differential.direction_2 = turn_change(d, r.direction_2, n, dn_2, after, eta, transmitted);
}

/// The photon at a place in this block.
fn start_photon(place: u32) -> Photon {
    var index = photon_params.first_photon + place;
    if photon_params.ordered != 0u {
        index = photon_params.first_photon;
        var bit = 0u;
        for (var bits = place; bits != 0u; bits >>= 1u) {
            index ^= photon_params.order[bit >> 2u][bit & 3u] & (0u - (bits & 1u));
            bit += 1u;
        }
    }
    let numbers = sobol_5(index, photon_params.seed);
    var guided = GuidedNumbers(numbers.first, 1.0, 1.0, vec2<u32>(0u));
    if has_guide {
        guided = guide_numbers(numbers.first);
    }
    var emission: Emission;
    if paper_refraction != PAPER_NONE {
        emission = emit_by_equation_1(index);
    } else {
        emission = emit(guided);
    }
    let density = emission.density * guided.place_density;
    if is_pilot() {
        landings[index] = Landing(NONE, 0.0, 0.0, 0.0, density, guided.cells.x, guided.cells.y);
    }
    let wavelength = first_wavelength();
    let beta = at_wavelength(emission.flux * (photon_params.flux_factor / density), wavelength);
    let units = to_units(beta);
    accounts[LEDGER_EMITTED] += units;
    return Photon(
        index, emission.origin, emission.direction, beta, units, photon_params.media, 0u, 0u, numbers.fifth, wavelength,
        emitted_differential(emission, index, density), has_footprints,
    );
}

/// Gives a photon another flux; the change goes to `account`.
fn set_flux(photon: ptr<function, Photon>, beta: vec3<f32>, account: u32) {
    let units = to_units(beta);
    accounts[account] += (*photon).units - units;
    (*photon).beta = beta;
    (*photon).units = units;
}

/// Multiplies a photon's flux by a color; the change goes to `account`.
fn change_flux(photon: ptr<function, Photon>, factor: vec3<f32>, account: u32) {
    set_flux(photon, (*photon).beta * at_wavelength(factor, (*photon).wavelength), account);
}

/// Gives a photon one wavelength.
fn take_wavelength(photon: ptr<function, Photon>) {
    let drawn = draw_wavelength((*photon).fifth_number);
    (*photon).wavelength = drawn.wavelength;
    set_flux(photon, at_wavelength((*photon).beta, drawn.wavelength) * drawn.weight, LEDGER_DISPERSION);
}

/// Lays a photon's flux down on a map's layer: over the ellipse of its footprint, or if that is too small, or the map is of several charts, onto
/// others of which it might reach, on four texels.
fn deposit(photon: ptr<function, Photon>, hit: Hit, triangle: Triangle, layer: u32) {
    let place = tile_at(layer, map_place(hit));
    let units = (*photon).units;
    accounts[LEDGER_DEPOSITED] += units;
    deposits += 1u;
    if has_footprints && (*photon).has_footprint {
        let c = load_corners(hit.triangle);
        let r = (*photon).differential;
        let axes = PlaneAxes(plane_change(triangle, c, r.origin_1), plane_change(triangle, c, r.origin_2));
        if c.charts <= 1u && add_ellipse(place, axes, units) {
            return;
        }
    }
    add_around(place, units);
}

/// Notes where a pilot's photon lands.
fn note_landing(photon: ptr<function, Photon>, hit: Hit, layer: u32) {
    let place = map_place(hit);
    let index = (*photon).index;
    landings[index].layer = layer;
    landings[index].x = place.x;
    landings[index].y = place.y;
    landings[index].flux = dot(abs((*photon).beta), vec3<f32>(1.0 / 3.0));
}

/// The number of choice `choice` of a photon.
fn choice_number(photon: ptr<function, Photon>, choice: u32) -> f32 {
    let later = padded_1((*photon).index, photon_params.seed, choice);
    return select(later, (*photon).fifth_number, choice == 0u && !has_dispersion);
}

/// Lets a photon end on a receiver's base.
fn land(photon: ptr<function, Photon>, hit: Hit, triangle: Triangle, point: SurfacePoint) {
    // Light that met no caster belongs to the camera pass.
    if (*photon).depth == 0u {
        accounts[LEDGER_DIRECT] += (*photon).units;
    } else {
        if paper_refraction == PAPER_NONE {
            let factor = landing_factor((*photon).direction, point.n_g, point.n_smooth);
            change_flux(photon, vec3<f32>(factor), LEDGER_SHADING_NORMALS);
        }
        let layer = map_layer(triangle.object, point.front);
        if is_pilot() {
            note_landing(photon, hit, layer);
            return;
        }
        deposit(photon, hit, triangle, layer);
    }
}

/// Lets a photon meet the surface at `hit`; returns whether its path goes on.
fn meet_surface(photon: ptr<function, Photon>, hit: Hit) -> bool {
    let d = (*photon).direction;
    let triangle = load_triangle(hit.triangle);
    let met = surface_at(hit, triangle, (*photon).origin, d);
    let material = met.material;
    let point = met.point;
    if has_footprints {
        transfer_differential(photon, hit.t, point.n_g);
    }
    let kind = material.kind & MATERIAL_KIND_BITS;
    let is_caster = (material.kind & MATERIAL_CASTER) != 0u;
    let is_receiver = (material.kind & MATERIAL_RECEIVER) != 0u;

    let media = (*photon).media;
    var beyond = media;
    let choice = (*photon).choices;
    var u = choice_number(photon, choice);
    if kind == MATERIAL_DIELECTRIC {
        beyond = media_beyond(media, material.medium, point.front);
        if beyond.x == media.x {
            // A boundary within something of higher rank does not exist.
            (*photon).media = beyond;
            (*photon).origin = leave(point, d);
            (*photon).depth += 1u;
            return true;
        }
        if (*photon).wavelength.number < 0.0 && (is_dispersive(media) || is_dispersive(beyond)) {
            let split = split_colors(media, beyond, -dot(d, point.n_s), material.gloss <= 0.0, u, (*photon).fifth_number);
            (*photon).fifth_number = split.xi;
            if split.takes_wavelength {
                take_wavelength(photon);
            }
            u = split.u;
            change_flux(photon, split.factor, LEDGER_DISPERSION);
        }
    }
    let ior = medium_ior(media, (*photon).wavelength);
    var sides = outer_interface(material, ior);
    if kind == MATERIAL_DIELECTRIC {
        sides = Interface(ior, ior / medium_ior(beyond, (*photon).wavelength));
    }

    (*photon).choices += select(0u, 1u, is_caster && kind != MATERIAL_MIRROR);
    var gloss_chance = 1.0;
    let incident = (*photon).beta;
    if is_receiver && is_caster && (*photon).depth == 0u {
        // What the base takes of light that met no caster is the camera pass's: no photon is spent on it.
        change_flux(photon, gloss_reflectance(material, -dot(d, point.n_s), sides), LEDGER_DIRECT);
    } else if is_receiver {
        let gloss = gloss_reflectance(material, -dot(d, point.n_s), sides);
        // The gloss of a receiver that is no caster is the camera pass's; what it takes is lost to the photon.
        gloss_chance = select(0.0, (gloss.x + gloss.y + gloss.z) / 3.0, is_caster);
        if u >= gloss_chance {
            change_flux(photon, (1.0 - gloss) / (1.0 - gloss_chance), LEDGER_ABSORBED);
            land(photon, hit, triangle, point);
            return false;
        }
    }
    if !is_caster {
        accounts[LEDGER_ABSORBED] += (*photon).units;
        return false;
    }
    let v = padded_2((*photon).index, photon_params.seed, SLOT_MICROFACET + 2u * choice);
    let event = scatter_specular(material, d, point.n_g, point.n_s, sides, u, v);
    set_flux(photon, incident * at_wavelength(event.weight / gloss_chance, (*photon).wavelength), LEDGER_ABSORBED);
    if paper_refraction == PAPER_NONE {
        change_flux(photon, vec3<f32>(adjoint_factor(d, point.n_g, event)), LEDGER_SHADING_NORMALS);
    }
    if has_footprints {
        (*photon).has_footprint = (*photon).has_footprint && material.gloss <= 0.0;
        if !(event.transmitted && kind == MATERIAL_THIN_WALLED) {
            turn_differential(photon, hit, triangle, point, event.normal, event.direction, sides.eta, event.transmitted);
        }
    }
    if event.transmitted {
        (*photon).media = beyond;
    }
    (*photon).origin = leave(point, event.direction);
    (*photon).direction = event.direction;
    (*photon).depth += 1u;
    return any((*photon).units != vec3<i32>(0));
}

fn add_to_ledger(word: u32, value: i32) {
    let gained = carry(atomicAdd(&ledger.accounts[word], bitcast<u32>(value)), value);
    if gained != 0u {
        atomicAdd(&ledger.accounts[word + 1u], gained);
    }
}

/// Adds this invocation's sums to the light's accounts.
fn close_accounts(rays: u32) {
    for (var account = 0u; account < LEDGER_ACCOUNTS; account++) {
        for (var channel = 0u; channel < 3u; channel++) {
            add_to_ledger(((photon_params.account * LEDGER_ACCOUNTS + account) * 3u + channel) * 2u, accounts[account][channel]);
        }
    }
    if atomicAdd(&ledger.rays_low, rays) > 0xffffffffu - rays {
        atomicAdd(&ledger.rays_high, 1u);
    }
    if atomicAdd(&ledger.deposits_low, deposits) > 0xffffffffu - deposits {
        atomicAdd(&ledger.deposits_high, 1u);
    }
}

@compute @workgroup_size(64)
fn emit_photons(@builtin(global_invocation_id) invocation: vec3<u32>) {
    // A lane takes several photons and starts its next one as soon as the last has ended.
    var place = invocation.x;
    if place >= photon_params.lane_count {
        return;
    }
    var photon: Photon;
    var in_flight = false;
    var finished = false;
    var rays = 0u;
    loop {
        if !in_flight {
            if place >= photon_params.photon_count {
                finished = true;
                break;
            }
            photon = start_photon(place);
            place += photon_params.lane_count;
            in_flight = any(photon.units != vec3<i32>(0));
            continue;
        }
        if photon.depth >= photon_params.max_depth {
            accounts[LEDGER_CUT_OFF] += photon.units;
            in_flight = false;
            continue;
        }
        let light = nearest_sphere(photon_params.sphere_count, photon.origin, photon.direction, 3.0e38);
        let hit = trace(photon.origin, photon.direction, light.t, false);
        rays += 1u;
        let met_light = hit.triangle == NONE && light.t < 3.0e38;
        if hit.triangle == NONE && !met_light {
            accounts[LEDGER_ESCAPED] += photon.units;
            in_flight = false;
            continue;
        }
        if photon.media.x != 0u {
            change_flux(&photon, transmittance(photon.media, hit.t, photon.wavelength), LEDGER_ABSORBED);
        }
        if met_light {
            accounts[LEDGER_ABSORBED] += photon.units;
            in_flight = false;
            continue;
        }
        in_flight = meet_surface(&photon, hit);
        if is_pilot() && in_flight && photon.depth > 0u {
            landings[photon.index].layer = LOST;
        }
    }
    if !finished {
        atomicAdd(&ledger.unfinished, 1u);
    }
    if !is_pilot() {
        close_accounts(rays);
    }
}
