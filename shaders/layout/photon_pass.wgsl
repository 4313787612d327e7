// Bind groups 1 and 2 of the photon pass.

/// The most targets that a light aims at.
const MAX_AIM_TARGETS: u32 = 16u;

/// What a light aims at: for a sphere, a disc that every ray from it to some casters crosses; for other lights, a bounding sphere of casters.
struct AimTarget {
    /// Centre, metres, world frame.
    center: vec3<f32>,
    /// Radius, metres; of a sphere's target 0 if it is every direction.
    radius: f32,
    /// Unit normal of a disc, pointing away from the light.
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
    /// Targets in use.
    target_count: u32,
    /// 1 if `order` applies.
    ordered: u32,
    /// Units of the fixed-point sums in a watt.
    units_per_watt: f32,
    /// Factor on every photon's flux: 1 / (the light's share of all photons).
    flux_factor: f32,
    /// Spheres among the lights, which come first.
    sphere_count: u32,
    /// Index of the light's accounts in the ledger.
    account: u32,
    /// Columns of the guide of the first two emission numbers.
    guide_columns: u32,
    /// Its rows.
    guide_rows: u32,
    /// Columns, and rows, of the guide of the next two emission numbers.
    guide_side: u32,
    /// 1 in a pilot, which notes where photons land and leaves maps and ledger alone.
    pilot: u32,
    /// The media that the light stands in, as keys.
    media: vec4<u32>,
    /// Centre of a sphere around everything, metres.
    scene_center: vec3<f32>,
    /// Its radius, metres.
    scene_radius: f32,
    /// In the profile `paper`, the energy of each ray.
    ray_energy: vec3<f32>,
    /// In the profile `paper`, the steps of each angle; 0 for random angles.
    grid_side: u32,
    /// Columns of the bit matrix that takes a place in the block to a photon, so that neighbours in the dispatch are aimed
    /// at neighbouring points.
    order: array<vec4<u32>, 8>,
    /// What the light aims at.
    targets: array<AimTarget, 16>,
}

/// Marks a photon that met a caster and landed on no receiver.
const LOST: u32 = 0xfffffffeu;

/// Where a pilot's photon went.
struct Landing {
    /// The layer that it landed on, two for each object; LOST if it met a caster and landed on none, NONE if it met no caster.
    layer: u32,
    /// Where on the map's plane it landed.
    x: f32,
    /// The same along y.
    y: f32,
    /// Flux that it brought there, W, mean of the channels.
    flux: f32,
    /// Density of its emission under the guide, over that without one.
    density: f32,
    /// The cell of the guide of its first two emission numbers.
    aim_cell: u32,
    /// The cell of the guide of the next two.
    place_cell: u32,
}

const LEDGER_EMITTED: u32 = 0u;
const LEDGER_DEPOSITED: u32 = 1u;
const LEDGER_DIRECT: u32 = 2u;
const LEDGER_ABSORBED: u32 = 3u;
const LEDGER_ESCAPED: u32 = 4u;
const LEDGER_CUT_OFF: u32 = 5u;
const LEDGER_SHADING_NORMALS: u32 = 6u;
const LEDGER_DISPERSION: u32 = 7u;
/// Accounts in a light's ledger.
const LEDGER_ACCOUNTS: u32 = 8u;

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
/// The light's guide, an entry a texel: lower and upper end, as bits, of the part of [0, 1) that moves into interval k of n, and the
/// interval that k/n moves into. First the columns of the guide of the first two emission numbers and the rows of each column, then the
/// same of the next two.
@group(1) @binding(1) var guide: texture_2d<u32>;
/// Signed 64-bit sums of flux, for each texel and channel, and where they are kept of the squares of what photons brought: the low words, and apart from them, so that twice as much can be bound, the high ones.
@group(2) @binding(0) var<storage, read_write> energy_low: array<atomic<u32>>;
@group(2) @binding(1) var<storage, read_write> energy_high: array<atomic<u32>>;
@group(2) @binding(2) var<storage, read_write> ledger: PhotonLedger;
/// In a pilot, an entry for each photon.
@group(2) @binding(3) var<storage, read_write> landings: array<Landing>;
