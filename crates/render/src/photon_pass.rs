//! Phase 1: photons from the lights into the energy maps.

use std::ops::Range;

use diacaustic_scene::RenderSettings;
use diacaustic_shaders::{
    AimTarget, LOST, Landing, MAX_AIM_TARGETS, PHOTONS, PhotonParams, Sighting, WORKGROUP_SIZE, ledger,
};
use diacaustic_surface::BoundingSphere;
use glam::{DVec2, DVec3, Vec2};

use crate::{
    Error, Guide, Ledger, LoopLimit, PilotReport,
    aim::{Block, Emission, blocks},
    features::{Features, Pipelines},
    fingerprint::Fingerprint,
    gpu::{Binding, Gpu, Purpose, wide},
    lights::{Emitter, Lights},
    map_plan::MapPlan,
    map_sums::EnergyMaps,
    paper,
    pilot::{Pilot, PilotRound},
    random::combine,
    refine::PhotonSupply,
    renderer::MOST_IN_FLIGHT,
};

/// The bindings of `shaders/layout/photon_pass.wgsl`.
const PARAMS: [Binding; 2] = [Binding::Uniform, Binding::Records];
const OUTPUTS: [Binding; 4] = [Binding::ReadWrite; 4];
const GUIDE: Purpose = Purpose { what: "a light's guide", remedy: "set guiding = false" };
const LANDINGS: Purpose = Purpose { what: "the pilot's photons", remedy: "set guiding = false and map_size" };
const LEDGER: Purpose = Purpose { what: "the lights' ledgers", remedy: "use fewer lights" };
/// Words of the ledger before its accounts: rays (low, high), unfinished, deposits (low, high).
const COUNTERS: u64 = 5;
/// Words of a light's accounts.
const LIGHT_WORDS: usize = ledger::ACCOUNTS as usize * 3 * 2;
/// The largest flux of a photon, in units, as a power of two: the digits of an f32.
const LARGEST_PHOTON_UNITS: f32 = 16_777_216.0;
/// The stream of the photon pass's seeds; docs/photon-paths.md.
const SEED_STREAM: u32 = 1;
/// The stream of the pilots' seeds.
const PILOT_SEED_STREAM: u32 = 3;
/// Rounds of a pilot: each flies by the guide that follows from those before it.
const PILOT_ROUNDS: usize = 2;
/// Photons in a round of a light's pilot, as powers of two: at most; at least, where many lights share the photons of two.
const PILOT_ROUND: std::ops::RangeInclusive<u32> = 10..=14;

/// The pipeline of the photon pass.
#[derive(Debug)]
pub(crate) struct PhotonPass {
    params_layout: wgpu::BindGroupLayout,
    outputs_layout: wgpu::BindGroupLayout,
    pub pipelines: Pipelines,
}

impl PhotonPass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let params_layout = gpu.layout("photon params", wgpu::ShaderStages::COMPUTE, &PARAMS);
        let outputs_layout = gpu.layout("photon outputs", wgpu::ShaderStages::COMPUTE, &OUTPUTS);
        let pipelines = Pipelines::new(PHOTONS, &[scene_layout, &params_layout, &outputs_layout]);
        Self { params_layout, outputs_layout, pipelines }
    }
}

/// A light that emits photons.
#[derive(Clone, Debug)]
struct PhotonLight {
    emitter: Emitter,
    emission: Emission,
    /// The first of its turns.
    first_turn: u64,
    pipeline: wgpu::ComputePipeline,
    guide: Guide,
    /// Params and guide.
    params_group: wgpu::BindGroup,
}

impl PhotonLight {
    /// How many of the first `photons` photons are its own, where all lights together have `turns`.
    fn of_first(&self, photons: u64, turns: u64) -> u32 {
        of_first(photons, turns, self.first_turn, u64::from(self.emitter.photon_share))
    }
}

/// How many of the first `photons` photons fall on `share` of `turns` turns, from `first_turn` on.
fn of_first(photons: u64, turns: u64, first_turn: u64, share: u64) -> u32 {
    (photons / turns * share + (photons % turns).saturating_sub(first_turn).min(share)) as u32
}

/// One scene's photons on the device.
#[derive(Debug)]
pub(crate) struct Photons {
    lights: Vec<PhotonLight>,
    /// Turns of all lights.
    pub turns: u64,
    account_count: usize,
    /// The params of every block, but for its light and photons.
    template: PhotonParams,
    seed: u32,
    photons_per_invocation: u32,
    /// Whether a guide moves the emission numbers.
    guided: bool,
    /// Whether photons have footprints.
    footprints: bool,
    /// Units of the fixed-point sums in a watt: a power of two, so that scaling is exact.
    pub units_per_watt: f32,
    greatest_weight: f32,
    params: wgpu::Buffer,
    pub ledger: wgpu::Buffer,
    /// For each light group, what its photons write; none until there are maps.
    outputs_groups: Vec<wgpu::BindGroup>,
}

/// What the pilots of all lights have found.
#[derive(Debug, Default)]
pub(crate) struct Flights {
    /// For each light its rounds.
    rounds: Vec<Vec<PilotRound>>,
    pub report: PilotReport,
}

impl Flights {
    /// Where photons came down on receivers through casters: the record of the map's layer, and the place on its plane.
    pub fn landings(&self) -> impl Iterator<Item = (u32, DVec2)> {
        let landings = self.rounds.iter().flatten().flat_map(|round| &round.landings);
        let landed = landings.filter(|landing| landing.layer < LOST);
        landed.map(|landing| (landing.layer, Vec2::new(landing.x, landing.y).as_dvec2()))
    }
}

/// What photons need to know of a scene.
pub(crate) struct PhotonScene<'a> {
    pub settings: &'a RenderSettings,
    pub lights: &'a Lights,
    pub features: Features,
    /// The greatest factor by which one wavelength changes a channel of light.
    pub greatest_weight: f32,
    pub casters: &'a [BoundingSphere],
    /// A sphere around everything.
    pub around: BoundingSphere,
}

impl Photons {
    pub fn new(gpu: &Gpu, pass: &mut PhotonPass, scene: &PhotonScene, loop_limit: LoopLimit) -> Result<Self, Error> {
        let guided = scene.settings.guiding;
        let params = gpu.uniform::<PhotonParams>("photons");
        let mut lights = Vec::new();
        let mut turns = 0;
        let pilot = (PILOT_ROUNDS as u32) << pilot_round(scene.lights.emitters.len());
        for emitter in &scene.lights.emitters {
            let emission = match &scene.settings.paper {
                Some(profile) => paper::emission(profile, scene.casters),
                None => Emission::toward(emitter, scene.casters),
            };
            let Some(emission) = emission else { continue };
            let features = scene.features.for_photons_of(emitter.kind(), scene.settings);
            let guide = Guide::even(emitter, &emission, pilot);
            lights.push(PhotonLight {
                emitter: emitter.clone(),
                emission,
                first_turn: turns,
                pipeline: pass.pipelines.get(gpu, features),
                params_group: guide_group(gpu, &pass.params_layout, &params, &guide)?,
                guide,
            });
            turns += u64::from(emitter.photon_share);
        }
        let words = COUNTERS + (scene.lights.account_count.max(1) * LIGHT_WORDS) as u64;
        let ledger = gpu.zeroed(LEDGER, words * 4)?;
        let units_per_watt = units_per_watt(&lights, turns, scene.greatest_weight);
        Ok(Self {
            lights,
            turns,
            account_count: scene.lights.account_count,
            template: PhotonParams {
                max_depth: scene.settings.max_depth,
                sphere_count: scene.lights.sphere_count as u32,
                units_per_watt,
                scene_center: scene.around.center.into(),
                scene_radius: scene.around.radius,
                ray_energy: scene.settings.paper.map_or([0.0; 3], |profile| profile.energy.into()),
                grid_side: scene.settings.paper.map_or(0, |profile| paper::grid_side(&profile, scene.settings)),
                ..Default::default()
            },
            seed: scene.settings.seed,
            greatest_weight: scene.greatest_weight,
            photons_per_invocation: loop_limit.photons_per_invocation(scene.settings),
            guided,
            footprints: scene.settings.footprints,
            units_per_watt,
            outputs_groups: Vec::new(),
            params,
            ledger,
        })
    }

    /// Whether any light emits photons: it is not dark, and there is a caster.
    pub fn can_emit(&self) -> bool {
        !self.lights.is_empty()
    }

    /// The photons that there are.
    pub fn supply(&self) -> PhotonSupply {
        let largest_share = self.lights.iter().map(|light| light.emitter.photon_share).max().unwrap_or(1);
        // A light's own photons are numbered with 32 bits.
        PhotonSupply { turns: self.turns, most: u64::from(u32::MAX / largest_share) * self.turns }
    }

    /// How a light emits; none if it does not.
    pub fn emission(&self, number: usize) -> Option<&Emission> {
        self.lights.iter().find(|light| light.emitter.number == number).map(|light| &light.emission)
    }

    /// How a light's emission numbers are moved; none if it emits nothing, or photons are not guided.
    pub fn guide(&self, number: usize) -> Option<&Guide> {
        let light = self.lights.iter().find(|light| light.emitter.number == number);
        light.filter(|_| self.guided).map(|light| &light.guide)
    }

    /// Lets photons fall into the maps of each of `groups` light groups from now on.
    pub fn fill(&mut self, gpu: &Gpu, pass: &PhotonPass, maps: &EnergyMaps, groups: usize) -> Result<(), Error> {
        let no_landings = gpu.zeroed(LANDINGS, size_of::<Landing>() as u64)?;
        let group = |group| outputs_group(gpu, pass, maps, group, &self.ledger, &no_landings);
        self.outputs_groups = (0..groups).map(group).collect();
        Ok(())
    }

    /// Flies a pilot of every light over the planes of maps that are `empty` yet, and makes the guides that the photons follow from now on, if
    /// they are to be guided. Blocks.
    pub fn fly_pilots(
        &mut self,
        gpu: &Gpu,
        pass: &PhotonPass,
        scene_group: &wgpu::BindGroup,
        empty: &EnergyMaps,
        plans: &[Option<MapPlan>],
        sightings: &[Sighting],
    ) -> Result<Flights, Error> {
        let count = 1u32 << pilot_round(self.lights.len());
        let landings = gpu.zeroed(LANDINGS, u64::from(count) * PILOT_ROUNDS as u64 * size_of::<Landing>() as u64)?;
        let outputs = outputs_group(gpu, pass, empty, 0, &self.ledger, &landings);
        let mut pilot = Pilot::new(plans, sightings);
        let mut flights = vec![Vec::new(); self.lights.len()];
        for round in 0..PILOT_ROUNDS as u32 {
            let photons = round * count..(round + 1) * count;
            for (light, rounds) in self.lights.iter().zip(&mut flights) {
                for block in blocks(photons.start, photons.end) {
                    self.submit(gpu, scene_group, &outputs, light, &self.pilot_params(light, &block));
                }
                let landed = gpu.read(&landings, photons.start.into()..photons.end.into())?;
                rounds.push(PilotRound { guide: light.guide.clone(), landings: landed });
            }
            if !self.guided {
                continue;
            }
            pilot.measure_flux(&flights);
            let error_weights = pilot.error_weights();
            for (light, rounds) in self.lights.iter_mut().zip(&flights) {
                let range = f64::from(light.emission.photon_range(&light.emitter));
                light.guide = pilot.learn(rounds, &error_weights, range);
                light.params_group = guide_group(gpu, &pass.params_layout, &self.params, &light.guide)?;
            }
        }
        self.units_per_watt = units_per_watt(&self.lights, self.turns, self.greatest_weight);
        self.template.units_per_watt = self.units_per_watt;
        let report = PilotReport {
            photons: flights.iter().flatten().map(|round| round.landings.len() as u64).sum(),
            unguided_share: unguided_share(&self.lights, &flights),
            ..PilotReport::default()
        };
        Ok(Flights { rounds: flights, report })
    }

    /// Adds what the photons depend on beside the scene: how they are aimed and guided.
    pub fn add_to(&self, fingerprint: &mut Fingerprint) {
        let none = Block { first: 0, count: 0, order: None };
        let params: Vec<_> = self.lights.iter().map(|light| self.block_params(light, &none)).collect();
        fingerprint.digest("how photons are emitted", &params);
        let guides: Vec<_> = self.lights.iter().flat_map(|light| light.guide.records()).collect();
        fingerprint.digest("how photons are guided", &guides);
        fingerprint.say("footprints", self.footprints);
    }

    /// Submits photons `range`, which take turns over the emitting lights.
    pub fn emit(&self, gpu: &Gpu, scene_group: &wgpu::BindGroup, range: Range<u64>) -> Result<(), Error> {
        let limit = self.supply().most;
        if range.end > limit {
            return Err(Error::TooManyPhotons { index: range.end - 1, limit });
        }
        let mut submitted = 0u32;
        for light in &self.lights {
            for block in blocks(light.of_first(range.start, self.turns), light.of_first(range.end, self.turns)) {
                let outputs = &self.outputs_groups[light.emitter.group];
                self.submit(gpu, scene_group, outputs, light, &self.block_params(light, &block));
                submitted += 1;
                if submitted.is_multiple_of(MOST_IN_FLIGHT) {
                    gpu.wait()?;
                }
            }
        }
        Ok(())
    }

    /// Submits one block.
    fn submit(
        &self,
        gpu: &Gpu,
        scene_group: &wgpu::BindGroup,
        outputs: &wgpu::BindGroup,
        light: &PhotonLight,
        params: &PhotonParams,
    ) {
        gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(params));
        let groups = [scene_group, &light.params_group, outputs];
        gpu.dispatch(&light.pipeline, &groups, [params.lane_count.div_ceil(WORKGROUP_SIZE), 1]);
    }

    /// The params of a block of a light's pilot, whose photons carry their flux as if the light were alone.
    fn pilot_params(&self, light: &PhotonLight, block: &Block) -> PhotonParams {
        let seed = combine(combine(self.seed, PILOT_SEED_STREAM), light.emitter.number as u32);
        PhotonParams { seed, pilot: 1, flux_factor: 1.0, ..self.block_params(light, block) }
    }

    fn block_params(&self, light: &PhotonLight, block: &Block) -> PhotonParams {
        let emitter = &light.emitter;
        let aimed = light.emission.targets();
        let mut targets = [AimTarget::default(); MAX_AIM_TARGETS as usize];
        targets[..aimed.len()].copy_from_slice(aimed);
        let columns = block.order.unwrap_or_default();
        PhotonParams {
            light: emitter.index as u32,
            account: emitter.number as u32,
            first_photon: block.first,
            photon_count: block.count,
            lane_count: block.count.div_ceil(self.photons_per_invocation),
            seed: combine(combine(self.seed, SEED_STREAM), emitter.number as u32),
            target_count: aimed.len() as u32,
            // The order follows emission numbers, which the profile `paper` does not draw.
            ordered: u32::from(block.order.is_some() && !matches!(light.emission, Emission::Paper { .. })),
            flux_factor: flux_factor(emitter, self.turns),
            guide_columns: light.guide.aim.columns as u32,
            guide_rows: light.guide.aim.rows as u32,
            guide_side: light.guide.place.columns as u32,
            media: emitter.media,
            order: std::array::from_fn(|k| std::array::from_fn(|i| columns[4 * k + i])),
            targets,
            ..self.template
        }
    }

    /// Reads what the pass has counted. Blocks.
    pub fn counts(&self, gpu: &Gpu) -> Result<PhotonCounts, Error> {
        let lights = self.account_count;
        let words: Vec<u32> = gpu.read(&self.ledger, 0..COUNTERS + (lights.max(1) * LIGHT_WORDS) as u64)?;
        if words[2] > 0 {
            return Err(Error::CutShort { invocations: words[2] });
        }
        let accounts = &words[COUNTERS as usize..];
        Ok(PhotonCounts {
            rays: wide([words[0], words[1]]),
            deposits: wide([words[3], words[4]]),
            ledgers: accounts.chunks_exact(LIGHT_WORDS).take(lights).map(|light| self.ledger_of(light)).collect(),
        })
    }

    fn ledger_of(&self, words: &[u32]) -> Ledger {
        let account = |number: u32| {
            let at = number as usize * 6;
            std::array::from_fn(|channel| wide([words[at + 2 * channel], words[at + 2 * channel + 1]]) as i64)
        };
        Ledger {
            emitted: account(ledger::EMITTED),
            deposited: account(ledger::DEPOSITED),
            direct: account(ledger::DIRECT),
            absorbed: account(ledger::ABSORBED),
            escaped: account(ledger::ESCAPED),
            cut_off: account(ledger::CUT_OFF),
            shading_normals: account(ledger::SHADING_NORMALS),
            dispersion: account(ledger::DISPERSION),
            units_per_watt: f64::from(self.units_per_watt),
        }
    }
}

/// The energy maps of a light group, the ledger and what a pilot notes.
fn outputs_group(
    gpu: &Gpu,
    pass: &PhotonPass,
    maps: &EnergyMaps,
    group: usize,
    ledger: &wgpu::Buffer,
    landings: &wgpu::Buffer,
) -> wgpu::BindGroup {
    let [low, high] = maps.sums_of(group);
    let resources = vec![low, high, ledger.as_entire_binding(), landings.as_entire_binding()];
    gpu.bind_resources(&pass.outputs_layout, resources)
}

/// The inverse of a light's share of all photons.
fn flux_factor(emitter: &Emitter, turns: u64) -> f32 {
    turns as f32 / emitter.photon_share as f32
}

/// Units in a watt, such that the largest photon of all lights has 2²⁴, also where one wavelength multiplies it by `greatest_weight`.
fn units_per_watt(lights: &[PhotonLight], turns: u64, greatest_weight: f32) -> f32 {
    let largest = |light: &PhotonLight| {
        let unguided = light.emission.largest_photon(&light.emitter) * flux_factor(&light.emitter, turns);
        unguided / light.guide.least_density() as f32
    };
    let largest = lights.iter().map(largest).fold(f32::MIN_POSITIVE, f32::max);
    (LARGEST_PHOTON_UNITS / (largest * greatest_weight)).log2().floor().exp2()
}

/// The bind group of params and guide.
fn guide_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    params: &wgpu::Buffer,
    guide: &Guide,
) -> Result<wgpu::BindGroup, Error> {
    let texture = gpu.records(GUIDE, &guide.records())?;
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let resources = vec![params.as_entire_binding(), wgpu::BindingResource::TextureView(&view)];
    Ok(gpu.bind_resources(layout, resources))
}

/// Photons in a round of each light's pilot, as a power of two.
fn pilot_round(lights: usize) -> u32 {
    let (least, most) = (*PILOT_ROUND.start(), *PILOT_ROUND.end());
    (most + 1).saturating_sub(lights.next_power_of_two().ilog2()).clamp(least, most)
}

/// The share of all lights' photons that would reach a receiver through a caster without a guide: those of the first round.
fn unguided_share(lights: &[PhotonLight], flights: &[Vec<PilotRound>]) -> f64 {
    let shares = lights.iter().zip(flights).map(|(light, rounds)| {
        let landings = &rounds[0].landings;
        let landed = landings.iter().filter(|landing| landing.layer < LOST).count();
        (f64::from(light.emitter.photon_share), landed as f64 / landings.len() as f64)
    });
    let (sum, turns) = shares.fold((0.0, 0.0), |(sum, turns), (turn, share)| (sum + turn * share, turns + turn));
    sum / f64::max(turns, 1.0)
}

/// What the photon pass has counted.
#[derive(Clone, Debug)]
pub(crate) struct PhotonCounts {
    pub rays: u64,
    pub deposits: u64,
    pub ledgers: Vec<Ledger>,
}

impl Ledger {
    /// An account in watts, after `photons` photons over every light.
    pub fn watts(&self, account: [i64; 3], photons: u64) -> DVec3 {
        DVec3::from(account.map(|units| units as f64)) / (self.units_per_watt * photons.max(1) as f64)
    }

    /// Emitted minus everything that became of it, in units: 0 in every channel.
    pub fn residue(&self) -> [i64; 3] {
        std::array::from_fn(|channel| {
            let spent = [self.deposited, self.direct, self.absorbed, self.escaped, self.cut_off];
            let changed = [self.shading_normals, self.dispersion];
            self.emitted[channel] - spent.iter().chain(&changed).map(|account| account[channel]).sum::<i64>()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_give_each_light_its_share() {
        // Shares 3, 1 and 2 of 6 turns.
        let shares = [(0u64, 3u64), (3, 1), (4, 2)];
        for photons in 0..40u64 {
            let own: Vec<u64> =
                shares.iter().map(|&(first, share)| u64::from(of_first(photons, 6, first, share))).collect();
            assert_eq!(own.iter().sum::<u64>(), photons);
            assert!(own.iter().zip(shares).all(|(own, (_, share))| own.abs_diff(photons * share / 6) <= share));
        }
        assert_eq!(shares.map(|(first, share)| of_first(600, 6, first, share)), [300, 100, 200]);
    }
}
