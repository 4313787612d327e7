//! Render states: how far a render is, kept and gone on with.

use diacaustic_shaders::{CAMERA, PHOTONS, RESOLVE, SMOOTH};

use super::{OnDevice, Renderer};
use crate::{
    Error, RenderState,
    fingerprint::{Difference, Fingerprint},
    refine::Course,
    render_state::SavedBuffer,
};

impl Renderer {
    /// Reads everything that photons and samples have left, to go on from it later, in another process too. Blocks until all submitted work
    /// is done. The state takes as much memory on the host as the sums of maps, film and layers on the device.
    ///
    /// # Errors
    /// If no scene is set or the device fails.
    pub fn save_state(&self) -> Result<RenderState, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        let read = |(name, buffer): (&str, &wgpu::Buffer)| {
            Ok(SavedBuffer { name: name.to_owned(), words: self.gpu.read(buffer, 0..buffer.size() / 4)? })
        };
        Ok(RenderState {
            note: String::new(),
            photons: on_device.photon_count,
            samples: on_device.sample_count,
            sample_sum: on_device.sample_sum,
            course: on_device.course.words(),
            fingerprint: on_device.fingerprint(&self.gpu.device.adapter_info()),
            buffers: on_device.accumulated().into_iter().map(read).collect::<Result<_, Error>>()?,
        })
    }

    /// Puts a saved state in the place of all photons and samples so far. What follows is, to the bit, what would have followed where it was saved:
    /// [`RenderState::photons`] and [`RenderState::samples`] tell with which to go on. Blocks until all submitted work is done.
    ///
    /// # Errors
    /// If no scene is set; if the state is of another scene, seed, version of this crate or adapter; or if the device fails. What was there
    /// before then stays.
    pub fn restore_state(&mut self, state: &RenderState) -> Result<(), Error> {
        let adapter = self.gpu.device.adapter_info();
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        if let Some(Difference { name, first, second }) = state.fingerprint.difference(&on_device.fingerprint(&adapter))
        {
            return Err(Error::OtherState { what: name, saved: first, found: second });
        }
        let buffers = on_device.accumulated();
        let shape = |name: &str, words: u64| (name.to_owned(), words);
        let saved: Vec<_> = state.buffers.iter().map(|saved| shape(&saved.name, saved.words.len() as u64)).collect();
        let wanted: Vec<_> = buffers.iter().map(|(name, buffer)| shape(name, buffer.size() / 4)).collect();
        if saved != wanted {
            return Err(Error::BadState("its buffers are not those of this scene".to_owned()));
        }
        let course = Course::new(&on_device.scene.settings, on_device.photons.supply()).resumed(&state.course);
        let course = course.ok_or_else(|| Error::BadState("how far it was is damaged".to_owned()))?;
        self.gpu.wait()?;
        for ((_, buffer), saved) in buffers.into_iter().zip(&state.buffers) {
            self.gpu.queue.write_buffer(buffer, 0, bytemuck::cast_slice(&saved.words));
        }
        self.gpu.queue.submit([]);
        on_device.course = course;
        on_device.photon_count = state.photons;
        on_device.sample_count = state.samples;
        on_device.sample_sum = state.sample_sum;
        on_device.unresolved = true;
        self.gpu.wait()
    }
}

impl OnDevice {
    /// What photons and samples accumulate in, by name.
    pub(super) fn accumulated(&self) -> Vec<(&'static str, &wgpu::Buffer)> {
        let ledgers = [("ledgers", &self.photons.ledger)];
        let cache = [("irradiance cache", &self.cache.buffer)];
        self.maps.accumulated().into_iter().chain(cache).chain(ledgers).chain(self.samples.accumulated()).collect()
    }

    /// What the bits of photons and samples depend on.
    fn fingerprint(&self, adapter: &wgpu::AdapterInfo) -> Fingerprint {
        let wgpu::AdapterInfo { name, driver, driver_info, .. } = adapter;
        let mut fingerprint = Fingerprint::default();
        fingerprint.say("version", env!("CARGO_PKG_VERSION"));
        fingerprint.say("adapter", format!("{name} ({driver} {driver_info})"));
        fingerprint.say("seed", self.scene.settings.seed);
        for kernel in [PHOTONS, RESOLVE, SMOOTH, CAMERA] {
            fingerprint.digest(&format!("the kernel {}", kernel.name), kernel.source.as_bytes());
        }
        fingerprint.say("list of layers", format!("{:?}", self.scene.output.layers));
        fingerprint.extend(&self.buffers.fingerprint);
        fingerprint.say("map_filter", self.scene.settings.map_filter);
        fingerprint.say("hue_filter", self.scene.settings.hue_filter);
        fingerprint.say("list of features", format!("{:?}", self.features));
        self.photons.add_to(&mut fingerprint);
        self.samples.add_to(&mut fingerprint);
        fingerprint
    }
}
