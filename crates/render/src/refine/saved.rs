//! A course in words, for render states.

use glam::Vec3;

use super::{Course, Stage};

impl Course {
    /// All that a render has learned by now; what the scene asks for is not in it.
    pub(crate) fn words(&self) -> Vec<u32> {
        let mut words = Words::default();
        words.number(match self.stage {
            Stage::Photons => 0,
            Stage::Samples => 1,
            Stage::Done => 2,
        });
        words.number(self.emitted);
        words.number(self.next_look);
        words.number(self.map_error.to_bits());
        words.number(self.camera_error.is_some().into());
        words.number(self.camera_error.unwrap_or_default().to_bits());
        let (photons, error) = self.cache.unwrap_or_default();
        words.number(self.cache.is_some().into());
        words.number(photons);
        words.number(error.to_bits());
        words.number(self.sampled.into());
        words.number(self.tile_count as u64);
        words.number(self.cheap_rays);
        words.number(self.listed.len() as u64);
        words.0.extend(self.listed.iter().flat_map(|&(tile, missing)| [tile, missing]));
        let (photons, picture) = self.last_look.as_ref().map_or((0, &[][..]), |(photons, picture)| (*photons, picture));
        words.number(photons);
        words.picture(picture);
        words.0
    }

    /// Goes on from where another course of the same scene was, which may have been asked for less. None if the words are no course.
    pub(crate) fn resumed(self, words: &[u32]) -> Option<Self> {
        let mut words = Reader(words);
        let stage = match words.number()? {
            0 => Stage::Photons,
            1 | 2 => Stage::Samples,
            _ => return None,
        };
        let (emitted, next_look) = (words.number()?, words.number()?);
        let map_error = f64::from_bits(words.number()?);
        let (is_known, camera_error) = (words.number()? != 0, f64::from_bits(words.number()?));
        let (is_filled, cache) = (words.number()? != 0, (words.number()?, f64::from_bits(words.number()?)));
        let cache = is_filled.then_some(cache);
        let (sampled, tile_count) = (words.number()? as u32, words.number()? as usize);
        let cheap_rays = words.number()?;
        let count = words.number()? as usize;
        let listed = words.take(count.checked_mul(2)?)?.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        let (photons, picture) = (words.number()?, words.picture()?);
        let last_look = (photons > 0).then_some((photons, picture));
        let camera_error = is_known.then_some(camera_error);
        let course = Self {
            stage,
            emitted,
            next_look,
            map_error,
            camera_error,
            cache,
            sampled,
            tile_count,
            cheap_rays,
            listed,
            last_look,
            ..self
        };
        Some(course.at_its_stage())
    }

    /// The same, at the stage that follows from the numbers which the scene states by now.
    fn at_its_stage(self) -> Self {
        let lacks_photons = self.photons.is_some_and(|photons| self.emitted < photons.min(self.supply.most));
        let is_done = self.samples.is_some_and(|samples| self.sampled >= samples);
        let stage = match self.stage {
            Stage::Samples if self.sampled == 0 && lacks_photons && self.supply.turns > 0 => Stage::Photons,
            Stage::Samples if is_done => Stage::Done,
            stage => stage,
        };
        Self { stage, ..self }
    }
}

/// Words that are written.
#[derive(Default)]
struct Words(Vec<u32>);

impl Words {
    fn number(&mut self, number: u64) {
        self.0.extend([number as u32, (number >> 32) as u32]);
    }

    fn picture(&mut self, picture: &[Vec3]) {
        self.number(picture.len() as u64);
        self.0.extend(picture.iter().flat_map(|radiance| radiance.to_array().map(f32::to_bits)));
    }
}

/// Words that are read.
struct Reader<'w>(&'w [u32]);

impl<'w> Reader<'w> {
    fn take(&mut self, count: usize) -> Option<&'w [u32]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn number(&mut self) -> Option<u64> {
        let words = self.take(2)?;
        Some(u64::from(words[0]) | u64::from(words[1]) << 32)
    }

    fn picture(&mut self) -> Option<Vec<Vec3>> {
        let count = self.number()? as usize;
        let words = self.take(count.checked_mul(3)?)?;
        let radiance = |words: &[u32]| Vec3::from_array(std::array::from_fn(|channel| f32::from_bits(words[channel])));
        Some(words.chunks_exact(3).map(radiance).collect())
    }
}

#[cfg(test)]
mod tests {
    use diacaustic_scene::RenderSettings;

    use super::*;
    use crate::refine::{PhotonSupply, Step};

    fn course(samples: Option<u32>) -> Course {
        Course::new(&RenderSettings { samples, ..RenderSettings::default() }, PhotonSupply { turns: 1, most: 1 << 32 })
    }

    #[test]
    fn a_course_goes_on_where_it_was() {
        let mut saved = course(None);
        (saved.emitted, saved.next_look, saved.map_error) = (1 << 33, 3 << 33, 0.25);
        saved.last_look = Some((7, vec![Vec3::Y, Vec3::Z]));
        saved.cheap_rays = 1 << 40;
        (saved.listed, saved.tile_count, saved.camera_error) = (vec![(3, 4), (9, 8)], 12, Some(0.5));
        saved.cache = Some((5, 0.125));
        let resumed = course(None).resumed(&saved.words()).unwrap();
        assert_eq!(format!("{resumed:?}"), format!("{saved:?}"));
        for length in 0..saved.words().len() {
            assert!(course(None).resumed(&saved.words()[..length]).is_none(), "{length} words");
        }
    }

    #[test]
    fn more_may_be_asked_for_than_before() {
        let mut saved = course(Some(4));
        saved.finish_photons();
        saved.note_samples(4);
        assert_eq!(course(Some(4)).resumed(&saved.words()).unwrap().next_step(), Step::Rest);
        assert_eq!(course(Some(5)).resumed(&saved.words()).unwrap().next_step(), Step::Sample(1));
        let photons = |photons| {
            let settings = RenderSettings { photons: Some(photons), ..RenderSettings::default() };
            Course::new(&settings, PhotonSupply { turns: 1, most: 1 << 32 })
        };
        let mut saved = photons(100);
        saved.note_photons(100);
        assert_eq!(photons(150).resumed(&saved.words()).unwrap().next_step(), Step::Emit(100..150));
        assert_eq!(photons(100).resumed(&saved.words()).unwrap().next_step(), Step::Sample(1));
        // Samples that are lit by fewer photons would not fit those that follow.
        saved.note_samples(1);
        assert_eq!(photons(150).resumed(&saved.words()).unwrap().next_step(), Step::Sample(1));
    }
}
