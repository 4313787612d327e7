//! The content of the statistics file.

use diacaustic::{Ledger, LightReport, MapSize, SceneReport, Statistics, scene::Scene, wgpu::AdapterInfo};
use diacaustic_output as output;

use crate::{progress::rate, session::Times};

/// Everything that a statistics file tells.
pub(crate) struct Report<'r> {
    pub scene_file: String,
    pub scene: &'r Scene,
    pub adapter: &'r AdapterInfo,
    pub built: &'r SceneReport,
    pub counted: &'r Statistics,
    pub times: Times,
    pub time_limit_reached: bool,
    pub interrupted: bool,
    pub error: Option<f64>,
}

impl Report<'_> {
    pub fn statistics(&self) -> output::Statistics {
        let lights = self.built.lights.iter().zip(&self.counted.ledgers);
        output::Statistics {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: self.scene_file.clone(),
            seed: self.scene.settings.seed,
            time_limit_reached: self.time_limit_reached,
            interrupted: self.interrupted,
            adapter: adapter(self.adapter),
            size: self.size(),
            seconds: self.seconds(),
            photons: self.photons(),
            camera: self.camera(),
            maps: self.built.maps.iter().map(|map| self.map(map)).collect(),
            lights: lights.map(|(light, ledger)| light_ledger(light, ledger, self.counted.photons)).collect(),
        }
    }

    fn size(&self) -> output::SceneSize {
        output::SceneSize {
            width: self.scene.settings.width,
            height: self.scene.settings.height,
            triangles: self.built.triangles as u64,
            bvh_nodes: self.built.bvh_nodes as u64,
            device_bytes: self.built.device_bytes,
            map_bytes: self.built.map_bytes,
            map_budget: self.built.map_budget,
            map_filter: self.scene.settings.map_filter,
        }
    }

    fn seconds(&self) -> output::Seconds {
        let times = self.times;
        let pilot = self.built.pilot.unwrap_or_default().time;
        let upload = times.scene.saturating_sub(self.built.bvh_time + self.built.maps_time + pilot);
        output::Seconds {
            load: times.load.as_secs_f64(),
            device: times.device.as_secs_f64(),
            kernels: times.kernels.as_secs_f64(),
            bvh: self.built.bvh_time.as_secs_f64(),
            maps: self.built.maps_time.as_secs_f64(),
            upload: upload.as_secs_f64(),
            pilot: pilot.as_secs_f64(),
            photons: times.photons.as_secs_f64(),
            samples: times.samples.as_secs_f64(),
            write: times.write.as_secs_f64(),
            total: times.total.as_secs_f64(),
        }
    }

    fn photons(&self) -> output::Photons {
        let (counted, time) = (self.counted, self.times.photons);
        output::Photons {
            emitted: counted.photons,
            deposits: counted.deposits,
            deposit_share: counted.deposits as f64 / counted.photons.max(1) as f64,
            unguided_deposit_share: self.built.pilot.map(|pilot| pilot.unguided_share),
            pilot: self.built.pilot.unwrap_or_default().photons,
            rays: counted.photon_rays,
            photons_per_second: rate(counted.photons, time),
            rays_per_second: rate(counted.photon_rays, time),
        }
    }

    fn camera(&self) -> output::CameraRays {
        let (counted, time) = (self.counted, self.times.samples);
        let pixels = u64::from(self.scene.settings.width) * u64::from(self.scene.settings.height);
        output::CameraRays {
            samples: counted.samples,
            rays: counted.camera_rays,
            mean_samples: counted.mean_samples,
            estimated_error: self.error,
            samples_per_second: rate((pixels as f64 * counted.mean_samples) as u64, time),
            rays_per_second: rate(counted.camera_rays, time),
        }
    }

    fn map(&self, map: &MapSize) -> output::Map {
        let object = self.scene.objects[map.object].name.clone();
        output::Map {
            object,
            width: map.width,
            height: map.height,
            layers: map.layers,
            tiles: map.tiles,
            texels: map.texels,
            texel_width: map.texel_width,
            wanted_texel_width: map.wanted_texel_width,
            finest_texel_width: map.finest_texel_width,
        }
    }
}

fn adapter(info: &AdapterInfo) -> output::Adapter {
    output::Adapter {
        name: info.name.clone(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        backend: info.backend.to_str().to_owned(),
    }
}

fn light_ledger(light: &LightReport, ledger: &Ledger, photons: u64) -> output::LightLedger {
    let watts = |account| ledger.watts(account, photons).to_array();
    output::LightLedger {
        name: light.name.clone(),
        flux: light.flux.map(f64::from),
        emitted: watts(ledger.emitted),
        deposited: watts(ledger.deposited),
        direct: watts(ledger.direct),
        absorbed: watts(ledger.absorbed),
        escaped: watts(ledger.escaped),
        cut_off: watts(ledger.cut_off),
        shading_normals: watts(ledger.shading_normals),
        dispersion: watts(ledger.dispersion),
        residue: ledger.residue(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ledgers_are_in_watts() {
        let mut lamp = LightReport::default();
        lamp.flux = [8.0, 4.0, 2.0];
        let mut ledger = Ledger::default();
        ledger.emitted = [400, 200, 100];
        ledger.deposited = [300, 200, 100];
        ledger.direct = [100, 0, 1];
        ledger.units_per_watt = 10.0;
        let told = light_ledger(&lamp, &ledger, 10);
        assert_eq!((told.flux, told.emitted), ([8.0, 4.0, 2.0], [4.0, 2.0, 1.0]));
        assert_eq!((told.deposited, told.direct, told.residue), ([3.0, 2.0, 1.0], [1.0, 0.0, 0.01], [0, 0, -1]));
    }
}
