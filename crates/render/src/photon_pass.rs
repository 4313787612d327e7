//! Phase 1: photons from the lights into the energy maps.

use std::ops::Range;

use diacaustic_scene::{LightKind, Scene};
use diacaustic_shaders::{AimDisc, MAX_AIM_DISCS, PHOTONS, PhotonParams, WORKGROUP_SIZE, ledger};
use diacaustic_surface::BoundingSphere;
use glam::DVec3;

use crate::{
    Error, Ledger,
    energy_map::EnergyMaps,
    gpu::{Binding, Gpu, Purpose, wide},
    guide::{Block, Emission, blocks},
    random::combine,
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
    pipeline: wgpu::ComputePipeline,
}

impl PhotonPass {
    pub fn new(gpu: &Gpu, scene_layout: &wgpu::BindGroupLayout) -> Self {
        let params_layout = gpu.layout("photon params", wgpu::ShaderStages::COMPUTE, &PARAMS);
        let outputs_layout = gpu.layout("photon outputs", wgpu::ShaderStages::COMPUTE, &OUTPUTS);
        let pipeline = gpu.compute_pipeline(PHOTONS, &[scene_layout, &params_layout, &outputs_layout]);
        Self { params_layout, outputs_layout, pipeline }
    }
}

/// A light that emits photons.
#[derive(Clone, Debug)]
struct Emitter {
    light: usize,
    flux: glam::Vec3,
    emission: Emission,
}

/// One scene's photons on the device.
#[derive(Debug)]
pub(crate) struct Photons {
    emitters: Vec<Emitter>,
    seed: u32,
    max_depth: u32,
    light_count: u32,
    photons_per_invocation: u32,
    /// Units of the fixed-point sums in a watt: a power of two, so that scaling is exact.
    pub units_per_watt: f32,
    params: wgpu::Buffer,
    pub ledger: wgpu::Buffer,
    params_group: wgpu::BindGroup,
    outputs_group: wgpu::BindGroup,
}

impl Photons {
    pub fn new(
        gpu: &Gpu,
        pass: &PhotonPass,
        scene: &Scene,
        casters: &[BoundingSphere],
        maps: &EnergyMaps,
        photons_per_invocation: u32,
    ) -> Result<Self, Error> {
        let emitters = emitters(scene, casters);
        let share = emitters.len() as f32;
        let largest = emitters
            .iter()
            .map(|emitter| emitter.emission.largest_photon(&scene.lights[emitter.light].kind) * share)
            .fold(f32::MIN_POSITIVE, f32::max);
        let params = gpu.uniform::<PhotonParams>("photons");
        let words = COUNTERS + (scene.lights.len().max(1) * LIGHT_WORDS) as u64;
        let ledger = gpu.zeroed(LEDGER, words * 4)?;
        Ok(Self {
            emitters,
            seed: scene.settings.seed,
            max_depth: scene.settings.max_depth,
            light_count: scene.lights.len() as u32,
            photons_per_invocation,
            units_per_watt: (LARGEST_PHOTON_UNITS / largest).log2().floor().exp2(),
            params_group: gpu.bind(&pass.params_layout, &[&params]),
            outputs_group: gpu.bind(&pass.outputs_layout, &[&maps.sums, &ledger]),
            params,
            ledger,
        })
    }

    /// Whether any light emits photons: it has flux, and there is a caster.
    pub fn can_emit(&self) -> bool {
        !self.emitters.is_empty()
    }

    /// How a light emits; none if it does not.
    pub fn emission(&self, light: usize) -> Option<&Emission> {
        self.emitters.iter().find(|emitter| emitter.light == light).map(|emitter| &emitter.emission)
    }

    /// Submits photons `range`, which take turns over the emitting lights.
    pub fn emit(
        &self,
        gpu: &Gpu,
        pass: &PhotonPass,
        scene_group: &wgpu::BindGroup,
        range: Range<u64>,
    ) -> Result<(), Error> {
        let turns = self.emitters.len() as u64;
        let limit = u64::from(u32::MAX) * turns;
        if turns > 0 && range.end > limit {
            return Err(Error::TooManyPhotons { index: range.end - 1, limit });
        }
        for (turn, emitter) in self.emitters.iter().enumerate() {
            // Of the first n photons, this light has those whose number leaves rest `turn`.
            let of_first = |n: u64| ((n + turns - 1 - turn as u64) / turns) as u32;
            for block in blocks(of_first(range.start), of_first(range.end)) {
                let lanes = block.count.div_ceil(self.photons_per_invocation);
                gpu.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&self.block_params(emitter, &block, lanes)));
                let groups = [scene_group, &self.params_group, &self.outputs_group];
                gpu.dispatch(&pass.pipeline, &groups, [lanes.div_ceil(WORKGROUP_SIZE), 1]);
            }
        }
        Ok(())
    }

    fn block_params(&self, emitter: &Emitter, block: &Block, lane_count: u32) -> PhotonParams {
        let discs = match &emitter.emission {
            Emission::Aimed(discs) => discs.as_slice(),
            Emission::Unaimed => &[],
        };
        let mut aim_discs = [AimDisc::default(); MAX_AIM_DISCS as usize];
        aim_discs[..discs.len()].copy_from_slice(discs);
        let columns = block.order.unwrap_or_default();
        PhotonParams {
            light: emitter.light as u32,
            first_photon: block.first,
            photon_count: block.count,
            lane_count,
            seed: combine(combine(self.seed, SEED_STREAM), emitter.light as u32),
            max_depth: self.max_depth,
            light_count: self.light_count,
            aim_disc_count: discs.len() as u32,
            ordered: u32::from(block.order.is_some()),
            units_per_watt: self.units_per_watt,
            flux_factor: self.emitters.len() as f32,
            flux: emitter.flux.into(),
            order: std::array::from_fn(|k| std::array::from_fn(|i| columns[4 * k + i])),
            aim_discs,
            ..Default::default()
        }
    }

    /// Reads what the pass has counted. Blocks.
    pub fn counts(&self, gpu: &Gpu, lights: usize) -> Result<PhotonCounts, Error> {
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
            units_per_watt: f64::from(self.units_per_watt),
        }
    }
}

fn emitters(scene: &Scene, casters: &[BoundingSphere]) -> Vec<Emitter> {
    let lights = scene.lights.iter().enumerate();
    lights
        .filter(|(_, light)| light.kind.flux().max_element() > 0.0)
        .filter_map(|(index, light)| {
            let LightKind::Sphere { flux, .. } = light.kind;
            Emission::toward(&light.kind, casters).map(|emission| Emitter { light: index, flux, emission })
        })
        .collect()
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
            let spent = [self.deposited, self.direct, self.absorbed, self.escaped, self.cut_off, self.shading_normals];
            self.emitted[channel] - spent.iter().map(|account| account[channel]).sum::<i64>()
        })
    }
}
