//! Renders that choose their photons and samples: one step after the other of a course.

use super::Renderer;
use crate::{
    Error, Refinement,
    refine::{Course, Step},
};

impl Renderer {
    /// Takes the render one step further toward the scene's `target_error`, and waits until it is done: photons, until the maps are exact
    /// enough, then samples where the picture needs them. Where the scene states photons or samples, there are as many. The film may be
    /// read and shown after every step. Blocks: for a second or two of a usual scene on two cores.
    ///
    /// The steps are the same in every run. An application calls either this or [`Renderer::emit_photons`] and [`Renderer::add_samples`], for this
    /// counts its own work alone; [`Renderer::restart`] begins anew.
    ///
    /// # Errors
    /// If no scene is set, the device fails, or it cut invocations short.
    pub fn refine(&mut self) -> Result<Refinement, Error> {
        let course = &self.scene.as_ref().ok_or(Error::NoScene)?.course;
        match course.next_step() {
            Step::Emit(numbers) => {
                let end = numbers.end;
                self.emit_photons(numbers)?;
                self.gpu.wait()?;
                self.on_course(|course| course.note_photons(end))
            }
            Step::Probe => self.probe_maps(),
            Step::Sample(count) => {
                self.prepare_light()?;
                self.take_samples(count)?;
                self.gpu.wait()?;
                self.on_course(|course| course.note_samples(count))
            }
            Step::Estimate => {
                let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
                let (samples, size) = (&on_device.samples, on_device.samples.size());
                let errors = self.error_pass.run(&self.gpu, &samples.film, &samples.halves, size)?;
                self.on_course(|course| course.note_errors(&errors))
            }
            Step::SampleTiles { tiles, count } => {
                self.sample_tiles(&tiles, count)?;
                self.on_course(|course| course.note_tile_samples(count))
            }
            Step::Rest => self.on_course(|_| ()),
        }
    }

    /// How far [`Renderer::refine`] has come.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn refinement(&self) -> Result<Refinement, Error> {
        let on_device = self.scene.as_ref().ok_or(Error::NoScene)?;
        Ok(on_device.course.refinement(on_device.mean_samples()))
    }

    /// Makes the photons so far enough for [`Renderer::refine`], whose next steps are samples.
    ///
    /// # Errors
    /// If no scene is set.
    pub fn finish_photons(&mut self) -> Result<Refinement, Error> {
        self.on_course(Course::finish_photons)
    }

    fn on_course(&mut self, note: impl FnOnce(&mut Course)) -> Result<Refinement, Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        note(&mut on_device.course);
        self.refinement()
    }

    /// Brings what samples read of the photons up to date: the maps' irradiance and the irradiance cache. Blocks where it fills the cache.
    fn prepare_light(&mut self) -> Result<(), Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        on_device.resolve(&self.gpu, &self.resolve_pass);
        self.fill_cache()
    }

    fn probe_maps(&mut self) -> Result<Refinement, Error> {
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        on_device.resolve(&self.gpu, &self.resolve_pass);
        let (group, sightings) = (&on_device.buffers.bind_group, &on_device.sightings);
        let of_maps = self.probe_pass.run(&self.gpu, group, &on_device.maps, sightings)?;
        on_device.course.note_probe(sightings, of_maps);
        self.refinement()
    }

    fn sample_tiles(&mut self, tiles: &[u32], count: u32) -> Result<(), Error> {
        self.prepare_light()?;
        let on_device = self.scene.as_mut().ok_or(Error::NoScene)?;
        let group = &on_device.buffers.bind_group;
        let pixels = on_device.samples.add_to_tiles(&self.gpu, &self.camera_pass, group, tiles, count)?;
        on_device.sample_sum += pixels * u64::from(count);
        self.gpu.wait()
    }
}
