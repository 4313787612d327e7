// Phase 1: photons leave the lights and fill the energy maps. docs/photon-paths.md defines each step.

import package::bsdf::specular::{adjoint_factor, scatter_specular};
import package::emitter::emission::emit;
import package::emitter::sphere::nearest_light;
import package::film::fixed_point::carry;
import package::film::texels::footprint;
import package::layout::records::{load_material, load_triangle};
import package::geometry::surface::{leave, surface_point};
import package::geometry::traverse::{trace, Hit};
import package::layout::photon_pass::{
    energy, ledger, photon_params, LEDGER_ABSORBED, LEDGER_ACCOUNTS, LEDGER_CUT_OFF, LEDGER_DEPOSITED, LEDGER_DIRECT,
    LEDGER_EMITTED, LEDGER_ESCAPED, LEDGER_SHADING_NORMALS,
};
import package::layout::scene::{MATERIAL_DIELECTRIC, MATERIAL_MIRROR, NONE};
import package::medium::absorption::transmittance;
import package::sampling::sobol::{padded_1, sobol_5};

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
    /// Material of the medium that it flies in, or NONE.
    medium: u32,
    /// Surfaces met.
    depth: u32,
    /// Choices between reflection and refraction made.
    choices: u32,
    /// The number of its first choice.
    first_choice: f32,
}

/// The largest flux of one photon in units; more can only come from interpolated normals, whose account takes the rest.
const MAX_UNITS: f32 = 67108864.0;

/// Per-invocation sums of the ledger, units of the fixed-point sums.
var<private> accounts: array<vec3<i32>, LEDGER_ACCOUNTS>;

/// Photons that this invocation has deposited.
var<private> deposits: u32;

fn to_units(beta: vec3<f32>) -> vec3<i32> {
    return vec3<i32>(round(min(beta * photon_params.units_per_watt, vec3<f32>(MAX_UNITS))));
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
    let emission = emit(numbers.first);
    let beta = emission.flux * photon_params.flux_factor;
    let units = to_units(beta);
    accounts[LEDGER_EMITTED] += units;
    return Photon(index, emission.origin, emission.direction, beta, units, NONE, 0u, 0u, numbers.fifth);
}

/// Multiplies a photon's flux; the change goes to `account`.
fn change_flux(photon: ptr<function, Photon>, factor: vec3<f32>, account: u32) {
    let beta = (*photon).beta * factor;
    let units = to_units(beta);
    accounts[account] += (*photon).units - units;
    (*photon).beta = beta;
    (*photon).units = units;
}

/// The number of the photon's next choice between reflection and refraction.
fn next_choice(photon: ptr<function, Photon>) -> f32 {
    let choice = (*photon).choices;
    (*photon).choices = choice + 1u;
    if choice == 0u {
        return (*photon).first_choice;
    }
    return padded_1((*photon).index, photon_params.seed, choice);
}

/// Adds flux to the four texels around a hit; their integers sum to `units` exactly.
fn deposit(hit: Hit, object: u32, front: bool, units: vec3<i32>) {
    let place = footprint(hit, object, front);
    for (var channel = 0u; channel < 3u; channel++) {
        let total = units[channel];
        var shares = vec4<i32>(round(f32(total) * place.weights));
        shares.w = total - shares.x - shares.y - shares.z;
        for (var k = 0u; k < 4u; k++) {
            let share = shares[k];
            if share != 0 {
                let word = 6u * place.texels[k] + 2u * channel;
                let gained = carry(atomicAdd(&energy[word], bitcast<u32>(share)), share);
                if gained != 0u {
                    atomicAdd(&energy[word + 1u], gained);
                }
            }
        }
    }
    deposits += 1u;
}

/// Lets a photon meet the surface at `hit`; returns whether its path goes on.
fn meet_surface(photon: ptr<function, Photon>, hit: Hit) -> bool {
    let d = (*photon).direction;
    let triangle = load_triangle(hit.triangle);
    let point = surface_point(hit, triangle, d);
    let material = load_material(triangle.material);
    let kind = material.kind;
    if kind != MATERIAL_MIRROR && kind != MATERIAL_DIELECTRIC {
        // Light that met no caster belongs to the camera pass.
        if (*photon).depth == 0u {
            accounts[LEDGER_DIRECT] += (*photon).units;
        } else {
            accounts[LEDGER_DEPOSITED] += (*photon).units;
            deposit(hit, triangle.object, point.front, (*photon).units);
        }
        return false;
    }
    var u = 0.0;
    if kind == MATERIAL_DIELECTRIC {
        u = next_choice(photon);
    }
    let ior = material.ior;
    let event = scatter_specular(kind, d, point.n_g, point.n_s, select(ior, 1.0 / ior, point.front), u);
    if event.transmitted {
        change_flux(photon, material.tint, LEDGER_ABSORBED);
        (*photon).medium = select(NONE, triangle.material, point.front);
    } else if kind == MATERIAL_MIRROR {
        change_flux(photon, material.reflectance, LEDGER_ABSORBED);
    }
    change_flux(photon, vec3<f32>(adjoint_factor(d, point.n_g, event)), LEDGER_SHADING_NORMALS);
    (*photon).origin = leave(point, event.direction);
    (*photon).direction = event.direction;
    (*photon).depth += 1u;
    return true;
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
            add_to_ledger(((photon_params.light * LEDGER_ACCOUNTS + account) * 3u + channel) * 2u, accounts[account][channel]);
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
            in_flight = true;
        }
        if photon.depth >= photon_params.max_depth {
            accounts[LEDGER_CUT_OFF] += photon.units;
            in_flight = false;
            continue;
        }
        let light = nearest_light(photon_params.light_count, photon.origin, photon.direction, 3.0e38);
        let hit = trace(photon.origin, photon.direction, light.t, false);
        rays += 1u;
        let met_light = hit.triangle == NONE && light.t < 3.0e38;
        if hit.triangle == NONE && !met_light {
            accounts[LEDGER_ESCAPED] += photon.units;
            in_flight = false;
            continue;
        }
        if photon.medium != NONE {
            change_flux(&photon, transmittance(photon.medium, hit.t), LEDGER_ABSORBED);
        }
        if met_light {
            accounts[LEDGER_ABSORBED] += photon.units;
            in_flight = false;
            continue;
        }
        in_flight = meet_surface(&photon, hit);
    }
    if !finished {
        atomicAdd(&ledger.unfinished, 1u);
    }
    close_accounts(rays);
}
