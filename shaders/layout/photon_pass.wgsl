// Bind groups 1 and 2 of the photon pass.

/// The most aim discs that a light has.
const MAX_AIM_DISCS: u32 = 16u;

/// A disc that every ray from a light to some casters crosses.
struct AimDisc {
    /// Centre, metres, world frame.
    center: vec3<f32>,
    /// Radius, metres.
    radius: f32,
    /// Unit normal, pointing away from the light.
    axis: vec3<f32>,
    /// Unused.
    padding: u32,
}

/// One dispatch of the photon pass: an aligned block of one light's photons.
struct PhotonParams {
    /// Index of the light.
    light: u32,
    /// Index of the block's first photon; a multiple of the block's length where that is a power of two.
    first_photon: u32,
    /// Photons in the block.
    photon_count: u32,
    /// Invocations of the dispatch that take photons; each takes every `lane_count`-th.
    lane_count: u32,
    /// Seed of the light's random numbers.
    seed: u32,
    /// The most surfaces that a photon meets before it is cut off.
    max_depth: u32,
    /// Aim discs in use; 0 for light emitted in every direction.
    aim_disc_count: u32,
    /// 1 if `order` applies.
    ordered: u32,
    /// Units of the fixed-point sums in a watt.
    units_per_watt: f32,
    /// Factor on every photon's flux: 1 / (the light's share of all photons).
    flux_factor: f32,
    /// Lights in the scene.
    light_count: u32,
    /// Unused.
    padding_0: u32,
    /// Flux Φ of the light, W.
    flux: vec3<f32>,
    /// Unused.
    padding_1: u32,
    /// Columns of the bit matrix that takes a place in the block to a photon, so that neighbours in the dispatch are aimed
    /// at neighbouring points.
    order: array<vec4<u32>, 8>,
    /// The light's aim discs.
    aim_discs: array<AimDisc, 16>,
}

const LEDGER_EMITTED: u32 = 0u;
const LEDGER_DEPOSITED: u32 = 1u;
const LEDGER_DIRECT: u32 = 2u;
const LEDGER_ABSORBED: u32 = 3u;
const LEDGER_ESCAPED: u32 = 4u;
const LEDGER_CUT_OFF: u32 = 5u;
const LEDGER_SHADING_NORMALS: u32 = 6u;
/// Accounts in a light's ledger.
const LEDGER_ACCOUNTS: u32 = 7u;

/// What the photon pass counts.
struct PhotonLedger {
    /// Rays traced, low and high word.
    rays_low: atomic<u32>,
    rays_high: atomic<u32>,
    /// Invocations that an adapter's loop limit cut short: any makes the result worthless.
    unfinished: atomic<u32>,
    /// Photons that reached a receiver through a caster, low and high word.
    deposits_low: atomic<u32>,
    deposits_high: atomic<u32>,
    /// Signed 64-bit sums, low and high word: for each light, account and channel.
    accounts: array<atomic<u32>>,
}

@group(1) @binding(0) var<uniform> photon_params: PhotonParams;
/// Signed 64-bit sums of flux, low and high word: for each texel and channel.
@group(2) @binding(0) var<storage, read_write> energy: array<atomic<u32>>;
@group(2) @binding(1) var<storage, read_write> ledger: PhotonLedger;
