//! Phase 1: photons from the lights into the energy maps.

use std::ops::Range;

use diacaustic_scene::RenderSettings;
use diacaustic_shaders::{AimTarget, MAX_AIM_TARGETS, PHOTONS, PhotonParams, WORKGROUP_SIZE, ledger};
use diacaustic_surface::BoundingSphere;
use glam::DVec3;

use crate::{
    Error, Ledger, LoopLimit,
    energy_map::EnergyMaps,
    features::{Features, Pipelines},
    gpu::{Binding, Gpu, Purpose, wide},
    guide::{Block, Emission, blocks},
    lights::{Emitter, Lights},
    random::combine,
    renderer::MOST_IN_FLIGHT,
};

/// The bindings of `shaders/layout/photon_pass.wgsl`.
const PARAMS: [Binding; 1] = [Binding::Uniform];
const OUTPUTS: [Binding; 2] = [Binding::ReadWrite; 2];
const LEDGER: Purpose = Purpose { what: "the lights' ledgers", remedy: "use fewer lights" };
/// Words of the ledger before its accounts: rays (low, high), unfinished, deposits (low, high).
const COUNTERS: u64 = 5;
/// Words of a light's accounts.
const LIGHT_WORDS: usize = ledger::ACCOUNTS as usize * 3 * 2;
/// The largest flux of a photon, in units, as a power of two: the digits of an f32.
const LARGEST_PHOTON_UNITS: f32 = 16_777_216.0;
/// The stream of the photon pass's seeds; docs/photon-paths.md.
const SEED_STREAM: u32 = 1;

/// The pipeline of the photon pass.
#[derive(Debug)]
pub(crate) struct PhotonPass {
    params_layout: wgpu::BindGroupLayout,
    outputs_layout: wgpu::BindGroupLayout,
    pipelines: Pipelines,
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
    /// Units of the fixed-point sums in a watt: a power of two, so that scaling is exact.
    pub units_per_watt: f32,
    params: wgpu::Buffer,
    pub ledger: wgpu::Buffer,
    params_group: wgpu::BindGroup,
    outputs_group: wgpu::BindGroup,
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
    pub fn new(
        gpu: &Gpu,
        pass: &mut PhotonPass,
        scene: &PhotonScene,
        maps: &EnergyMaps,
        loop_limit: LoopLimit,
    ) -> Result<Self, Error> {
        let pipeline = |emitter: &Emitter| pass.pipelines.get(gpu, scene.features.for_photons_of(emitter.kind()));
        let (photon_lights, turns) = photon_lights(scene.lights, scene.casters, pipeline);
        let largest = photon_lights
            .iter()
            .map(|light| light.emission.largest_photon(&light.emitter) * flux_factor(&light.emitter, turns))
            .fold(f32::MIN_POSITIVE, f32::max);
        let units_per_watt = (LARGEST_PHOTON_UNITS / (largest * scene.greatest_weight)).log2().floor().exp2();
        let params = gpu.uniform::<PhotonParams>("photons");
        let words = COUNTERS + (scene.lights.account_count.max(1) * LIGHT_WORDS) as u64;
        let ledger = gpu.zeroed(LEDGER, words * 4)?;
        Ok(Self {
            lights: photon_lights,
            turns,
            account_count: scene.lights.account_count,
            template: PhotonParams {
                max_depth: scene.settings.max_depth,
                sphere_count: scene.lights.sphere_count as u32,
                units_per_watt,
                scene_center: scene.around.center.into(),
                scene_radius: scene.around.radius,
                ..Default::default()
            },
            seed: scene.settings.seed,
            photons_per_invocation: loop_limit.photons_per_invocation(scene.settings.max_depth),
            units_per_watt,
            params_group: gpu.bind(&pass.params_layout, &[&params]),
            outputs_group: gpu.bind(&pass.outputs_layout, &[&maps.sums, &ledger]),
            params,
            ledger,
        })
    }

    /// Whether any light emits photons: it is not dark, and there is a caster.
    pub fn can_emit(&self) -> bool {
        !self.lights.is_empty()
    }

    /// How a light emits; none if it does not.
    pub fn emission(&self, number: usize) -> Option<&Emission> {
        self.lights.iter().find(|light| light.emitter.number == number).map(|light| &light.emission)
    }

    /// Submits photons `range`, which take turns over the emitting lights.
    pub fn emit(&self, gpu: &Gpu, scene_group: &wgpu::BindGroup, range: Range<u64>) -> Result<(), Error> {
        // A light's own photons are numbered with 32 bits.
        let largest_share = self.lights.iter().map(|light| light.emitter.photon_share).max().unwrap_or(1);
        let limit = u64::from(u32::MAX / largest_share) * self.turns;
        if range.end > limit {
            return Err(Error::TooManyPhotons { index: range.end - 1, limit });
        }
        let mut submitted = 0u32;
        for light in &self.lights {
            for block in blocks(light.of_first(range.start, self.turns), light.of_first(range.end, self.turns)) {
                let lanes = block.count.div_ceil(self.photons_per_invocation);
                gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&self.block_params(light, &block, lanes)));
                let groups = [scene_group, &self.params_group, &self.outputs_group];
                gpu.dispatch(&light.pipeline, &groups, [lanes.div_ceil(WORKGROUP_SIZE), 1]);
                submitted += 1;
                if submitted.is_multiple_of(MOST_IN_FLIGHT) {
                    gpu.wait()?;
                }
            }
        }
        Ok(())
    }

    fn block_params(&self, light: &PhotonLight, block: &Block, lane_count: u32) -> PhotonParams {
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
            lane_count,
            seed: combine(combine(self.seed, SEED_STREAM), emitter.number as u32),
            target_count: aimed.len() as u32,
            ordered: u32::from(block.order.is_some()),
            flux_factor: flux_factor(emitter, self.turns),
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

/// The inverse of a light's share of all photons.
fn flux_factor(emitter: &Emitter, turns: u64) -> f32 {
    turns as f32 / emitter.photon_share as f32
}

/// The lights that emit photons, with their turns, and the number of all turns.
fn photon_lights(
    lights: &Lights,
    casters: &[BoundingSphere],
    mut pipeline: impl FnMut(&Emitter) -> wgpu::ComputePipeline,
) -> (Vec<PhotonLight>, u64) {
    let mut turns = 0;
    let mut list = Vec::new();
    for emitter in &lights.emitters {
        if let Some(emission) = Emission::toward(emitter, casters) {
            list.push(PhotonLight {
                emitter: emitter.clone(),
                emission,
                first_turn: turns,
                pipeline: pipeline(emitter),
            });
            turns += u64::from(emitter.photon_share);
        }
    }
    (list, turns)
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
