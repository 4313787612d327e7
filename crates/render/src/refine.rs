//! How far a render goes by itself: photons until the maps are exact enough, then samples where the picture still needs them.
//!
//! All decisions follow from what the device has computed and counted, never from times, so that a render takes the same course in every run.
//! `docs/refinement.md` says how.

mod saved;

use std::ops::Range;

use diacaustic_scene::RenderSettings;
use diacaustic_shaders::Sighting;
use glam::Vec3;

use crate::error_pass::TileErrors;

/// Photons after which the maps are looked at first, as a power of two.
const FIRST_LOOK: u32 = 14;
/// The most photons of the renderer's own choice, as a power of two.
const MOST_PHOTONS: u32 = 24;
/// Photons until the first chance to stop, or to show a picture, and between any others, as powers of two.
const PHOTONS_AT_FIRST: u32 = 16;
const PHOTONS_AT_ONCE: u32 = 18;
/// The part of the squared target error that the maps may make up, and where the scene states its samples.
const MAP_SHARE: f64 = 0.25;
const MOST_MAP_SHARE: f64 = 0.5;
/// The part that they are brought down to while photons are few beside the samples that every pixel gets: photons for each of those samples.
const CHEAP_MAP_SHARE: f64 = 0.05;
const CHEAP_PHOTONS: f64 = 0.25;
/// Share of the mean radiance, squared, that is added to a pixel's own: that of `shaders/errors.wgsl`.
pub(crate) const DARKNESS: f32 = 0.01;
/// The part of a path's light that the maps must bring for the path to tell how exact they are.
const LEAST_MAP_LIGHT: f32 = 0.05;
/// The part that tiles are brought down to while that costs little, and how much it may cost of all rays of the picture.
const CHEAP_TILE_SHARE: f64 = 0.05;
const CHEAP_RAYS: f64 = 0.25;
/// Samples of every pixel before errors are looked at.
const FIRST_SAMPLES: u32 = 2;
/// Samples at once, over all pixels: so many times the picture.
const PICTURES_AT_ONCE: usize = 2;
/// The most samples that a pixel takes of the renderer's own choice.
const MOST_SAMPLES: u32 = 256;
/// One of so many tiles may miss the target, and one in any picture: single bright paths keep some from it for long.
const TILES_FOR_EACH_MISS: usize = 128;

/// What a render works at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Energy maps.
    Photons,
    /// The picture.
    Samples,
    /// Nothing: it is as exact as asked for.
    Done,
}

/// How far a render has come.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Refinement {
    /// What comes next.
    pub stage: Stage,
    /// Photons emitted, over every light.
    pub photons: u64,
    /// Samples of a pixel, on average.
    pub samples: f64,
    /// Estimated error: the root of the mean over pixels of the squared error of radiance, relative to its brightness. None until it is known.
    pub error: Option<f64>,
}

/// What is to be done next.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    /// Emit photons of these numbers.
    Emit(Range<u64>),
    /// Probe the maps.
    Probe,
    /// Take samples of every pixel.
    Sample(u32),
    /// Estimate errors.
    Estimate,
    /// Take samples of the pixels of some tiles.
    SampleTiles { tiles: Vec<u32>, count: u32 },
    /// Nothing.
    Rest,
}

/// The photons that a scene's lights can send.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PhotonSupply {
    /// Photons after which every light has had its turns once; 0 if none sends any.
    pub turns: u64,
    /// The most that there are.
    pub most: u64,
}

/// The course of one render.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    stage: Stage,
    target: f64,
    supply: PhotonSupply,
    /// Photons to emit, if the scene says.
    photons: Option<u64>,
    /// Samples to take, if the scene says.
    samples: Option<u32>,
    emitted: u64,
    /// Photons after which the maps are looked at next.
    next_look: u64,
    /// The last look at photons: how many there were, and what it saw.
    last_look: Option<(u64, Vec<Vec3>)>,
    /// Squared errors of the picture that the maps and the camera's samples make.
    map_error: f64,
    camera_error: Option<f64>,
    /// Photons by which the irradiance cache was filled last, and its squared error.
    cache: Option<(u64, f64)>,
    /// Samples of every pixel.
    sampled: u32,
    /// Tiles that need more samples, and how many each before the next estimate.
    listed: Vec<(u32, u32)>,
    tile_count: usize,
    /// Rays of samples that tiles within the target got because they cost little.
    cheap_rays: u64,
    /// Photons that cost little beside the picture's first samples.
    cheap: u64,
}

impl Course {
    pub fn new(settings: &RenderSettings, supply: PhotonSupply) -> Self {
        let sends_photons = supply.turns > 0 && settings.photons != Some(0);
        let photons = settings.photons.map(|photons| photons.next_multiple_of(supply.turns.max(1)));
        Self {
            stage: if sends_photons { Stage::Photons } else { Stage::Samples },
            target: f64::from(settings.target_error),
            supply,
            photons,
            samples: settings.samples,
            emitted: 0,
            next_look: at_least(supply.turns, FIRST_LOOK),
            last_look: None,
            map_error: 0.0,
            camera_error: None,
            cache: None,
            sampled: 0,
            listed: Vec::new(),
            tile_count: 0,
            cheap_rays: 0,
            cheap: cheap_photons(settings),
        }
    }

    /// How far it is, after so many samples of a pixel on average.
    pub fn refinement(&self, samples: f64) -> Refinement {
        Refinement {
            stage: self.stage,
            photons: self.emitted,
            samples,
            error: self.camera_error.map(|error| (error + self.light_error()).sqrt()),
        }
    }

    /// Forgets all samples.
    pub fn forget_samples(&mut self) {
        (self.sampled, self.cheap_rays, self.camera_error) = (0, 0, None);
        self.listed.clear();
        if self.stage == Stage::Done {
            self.stage = Stage::Samples;
        }
    }

    /// Goes over to samples.
    pub fn finish_photons(&mut self) {
        if self.stage == Stage::Photons {
            self.stage = Stage::Samples;
        }
    }

    /// Squared error by the maps and the irradiance cache, which all samples share.
    fn light_error(&self) -> f64 {
        self.map_error + self.cache.map_or(0.0, |(_, error)| error)
    }

    /// Photons by which the irradiance cache was filled; none if it was not.
    pub fn cache_photons(&self) -> Option<u64> {
        self.cache.map(|(photons, _)| photons)
    }

    /// Notes that the irradiance cache was filled by so many photons, with a squared error.
    pub fn note_cache(&mut self, photons: u64, error: f64) {
        self.cache = Some((photons, error));
    }

    /// What is to be done next.
    pub fn next_step(&self) -> Step {
        match self.stage {
            Stage::Photons => self.next_photons(),
            Stage::Samples => self.next_samples(),
            Stage::Done => Step::Rest,
        }
    }

    fn next_photons(&self) -> Step {
        let end = self.photons.unwrap_or(self.next_look).min(self.supply.most);
        if self.emitted < end {
            let bits = if self.emitted == 0 { PHOTONS_AT_FIRST } else { PHOTONS_AT_ONCE };
            return Step::Emit(self.emitted..end.min(self.emitted + at_least(self.supply.turns, bits)));
        }
        Step::Probe
    }

    fn next_samples(&self) -> Step {
        if let Some(samples) = self.samples {
            return Step::Sample((samples - self.sampled).min(self.samples_at_once()));
        }
        if self.sampled < FIRST_SAMPLES {
            return Step::Sample(self.samples_at_once());
        }
        let Some(fewest) = self.listed.iter().map(|&(_, missing)| missing).min() else { return Step::Estimate };
        let fitting = (PICTURES_AT_ONCE * self.tile_count / self.listed.len()) as u32;
        Step::SampleTiles {
            tiles: self.listed.iter().map(|&(tile, _)| tile).collect(),
            count: fewest.min(fitting.max(1)),
        }
    }

    /// Samples of every pixel in a step: one at first, for there to be a picture soon.
    fn samples_at_once(&self) -> u32 {
        if self.sampled < PICTURES_AT_ONCE as u32 { 1 } else { PICTURES_AT_ONCE as u32 }
    }

    /// Notes photons emitted.
    pub fn note_photons(&mut self, end: u64) {
        self.emitted = end;
        if self.photons.is_some_and(|photons| end >= photons) || end >= self.supply.most {
            self.stage = Stage::Samples;
        }
    }

    /// Notes samples taken of every pixel.
    pub fn note_samples(&mut self, count: u32) {
        self.sampled += count;
        if self.samples.is_some_and(|samples| self.sampled >= samples) {
            self.stage = Stage::Done;
        }
    }

    /// Notes samples taken of the listed tiles.
    pub fn note_tile_samples(&mut self, count: u32) {
        self.listed.iter_mut().for_each(|(_, missing)| *missing = missing.saturating_sub(count));
        self.listed.retain(|&(_, missing)| missing > 0);
    }

    /// Learns from a probe how exact the maps are: what paths saw without photons, and the radiance that the maps bring to each by now.
    pub fn note_probe(&mut self, sightings: &[Sighting], of_maps: Vec<Vec3>) {
        let now = self.emitted;
        let look = Look { sightings, of_maps: &of_maps };
        let Some((before, last)) = &self.last_look else {
            self.next_look = 2 * now;
            self.last_look = Some((now, of_maps));
            return;
        };
        // The picture of the first photons differs from that of all by what both lack: for twice as many, by as much as that of all does
        // from the truth.
        let scale = *before as f64 / (now - before) as f64;
        self.map_error = scale * look.relative_change(last);
        self.last_look = Some((now, of_maps));
        let share = match self.samples {
            _ if now < self.cheap => CHEAP_MAP_SHARE,
            Some(_) => MOST_MAP_SHARE,
            None => MAP_SHARE,
        };
        let allowed = share * self.target.powi(2);
        if self.map_error <= allowed || now >= at_least(self.supply.turns, MOST_PHOTONS) {
            self.stage = Stage::Samples;
            return;
        }
        let missing = (self.map_error / allowed).clamp(1.25, 2.0);
        self.next_look = ((now as f64 * missing) as u64).next_multiple_of(self.supply.turns);
    }

    /// Learns from an estimate where samples are missing.
    pub fn note_errors(&mut self, errors: &TileErrors) {
        self.camera_error = Some(errors.mean(|tile| tile.squared_error));
        let target = self.target.powi(2);
        let allowed = (target - self.light_error()).max((1.0 - MOST_MAP_SHARE) * target) as f32;
        self.tile_count = errors.tiles.len();
        let guarded = errors.guarded();
        let may_go_on = |&tile: &usize| errors.tiles[tile].samples < MOST_SAMPLES;
        let (missing, within): (Vec<_>, Vec<_>) =
            (0..self.tile_count).filter(may_go_on).partition(|&tile| guarded[tile] > allowed);
        let mut listed = missing;
        if listed.len() <= (self.tile_count / TILES_FOR_EACH_MISS).max(1) {
            listed.clear();
        }
        listed.extend(self.cheap_tiles(within, &guarded, errors));
        listed.sort_unstable();
        // Twice as many: whole powers of two of the sequence's points are spread evenly, and the two halves are compared.
        self.listed = listed.into_iter().map(|tile| (tile as u32, errors.tiles[tile].samples)).collect();
        if self.listed.is_empty() {
            self.stage = Stage::Done;
        }
    }

    /// Of tiles within the target, those whose samples take most of the picture's error away for their rays, as many as cost little.
    fn cheap_tiles(&mut self, mut tiles: Vec<usize>, guarded: &[f32], errors: &TileErrors) -> Vec<usize> {
        let allowed = (CHEAP_TILE_SHARE * self.target.powi(2)) as f32;
        let rays = |tile: usize| u64::from(errors.tiles[tile].rays);
        let all: u64 = (0..self.tile_count).map(rays).sum();
        // As many samples again take as many rays again, and half the error away.
        let gain = |tile: usize| guarded[tile] * errors.tiles[tile].pixels as f32 / rays(tile).max(1) as f32;
        tiles.retain(|&tile| guarded[tile] > allowed);
        tiles.sort_by(|&a, &b| gain(b).total_cmp(&gain(a)).then(a.cmp(&b)));
        let most = (CHEAP_RAYS * all as f64) as u64;
        let fits = |&tile: &usize| {
            let after = self.cheap_rays + rays(tile);
            let fits = after <= most;
            self.cheap_rays = if fits { after } else { self.cheap_rays };
            fits
        };
        tiles.into_iter().take_while(fits).collect()
    }
}

/// What paths see.
struct Look<'l> {
    sightings: &'l [Sighting],
    /// The radiance that the maps bring to each, W/(m² sr).
    of_maps: &'l [Vec3],
}

impl Look<'_> {
    /// The brightness of what a path sees: the mean of the channels.
    fn brightness(&self, path: usize) -> f32 {
        self.sightings[path].radiance + self.of_maps[path].element_sum() / 3.0
    }

    /// The mean square of what the maps brought before and bring now, relative to the radiance, of colours as vectors, and at most 1 for each path; 0 without paths. Only
    /// those count to which the maps bring a part that is worth looking at; what is dark beside these paths' mean counts as if it were
    /// brighter.
    fn relative_change(&self, before: &[Vec3]) -> f64 {
        let is_lit = |path: &usize| {
            self.of_maps[*path].abs().element_sum() > 3.0 * LEAST_MAP_LIGHT * self.brightness(*path).abs()
        };
        let lit: Vec<usize> = (0..self.of_maps.len().min(before.len())).filter(is_lit).collect();
        let count = lit.len().max(1) as f32;
        let mean = lit.iter().map(|&path| self.brightness(path)).sum::<f32>() / count;
        let floor = (DARKNESS * mean * mean).max(f32::MIN_POSITIVE);
        let relative = |&path: &usize| {
            let change = (before[path] - self.of_maps[path]).length_squared();
            // What the path saw beside the maps is known without its colour.
            let radiance = self.of_maps[path] + self.sightings[path].radiance;
            f64::from((change / (radiance.length_squared() + 3.0 * floor)).min(1.0))
        };
        lit.iter().map(relative).sum::<f64>() / f64::from(count)
    }
}

/// Photons that cost little beside the samples that every pixel gets in any case.
fn cheap_photons(settings: &RenderSettings) -> u64 {
    let pixels = f64::from(settings.width) * f64::from(settings.height);
    let samples = settings.samples.map_or(FIRST_SAMPLES, |samples| samples.min(MOST_SAMPLES));
    (CHEAP_PHOTONS * pixels * f64::from(samples)) as u64
}

/// At least 2^`bits` photons, of which each light has its turns.
fn at_least(turns: u64, bits: u32) -> u64 {
    let turns = turns.max(1);
    turns << bits.saturating_sub(turns.ilog2())
}

#[cfg(test)]
mod tests {
    use diacaustic_shaders::TileError;

    use super::*;

    const SUPPLY: PhotonSupply = PhotonSupply { turns: 3, most: 3 << 32 };

    fn settings(photons: Option<u64>, samples: Option<u32>) -> RenderSettings {
        RenderSettings { photons, samples, width: 64, height: 32, target_error: 0.1, ..RenderSettings::default() }
    }

    fn errors(tiles: &[(f32, u32)]) -> TileErrors {
        let tile = |&(squared_error, samples)| TileError {
            squared_error,
            radiance: 1.0,
            samples,
            pixels: 64,
            rays: 64 * samples,
        };
        TileErrors { columns: tiles.len(), tiles: tiles.iter().map(tile).collect() }
    }

    #[test]
    fn both_sides_of_the_device_forgive_the_same_darkness() {
        let after =
            diacaustic_shaders::ERRORS.source.split("const DARKNESS: f32 = ").nth(1).expect("the kernel's constant");
        let written = after.split(';').next().expect("its end");
        assert_eq!(written.trim_end_matches('f').parse::<f32>().unwrap(), DARKNESS, "{written}");
    }

    #[test]
    fn stated_numbers_are_kept() {
        let mut course = Course::new(&settings(Some(1_000_000), Some(5)), SUPPLY);
        let (mut photons, mut samples) = (0, 0);
        loop {
            match course.next_step() {
                Step::Emit(range) => {
                    assert!(range.start == photons && (range.end - range.start).is_multiple_of(3));
                    photons = range.end;
                    course.note_photons(photons);
                }
                Step::Sample(count) => {
                    samples += count;
                    course.note_samples(count);
                }
                Step::Rest => break,
                step => panic!("{step:?}"),
            }
        }
        assert_eq!((photons, samples), (1_000_002, 5));
        assert_eq!(course.stage, Stage::Done);
    }

    #[test]
    fn photons_end_when_the_maps_no_longer_change() {
        let mut course = Course::new(&settings(None, None), SUPPLY);
        let mut looks = 0;
        while course.stage == Stage::Photons {
            match course.next_step() {
                Step::Emit(range) => course.note_photons(range.end),
                Step::Probe => {
                    looks += 1;
                    // An error that falls with the root of the photons, of 1 at 10,000, alternately up and down.
                    let sign = if looks % 2 == 0 { 1.0 } else { -1.0 };
                    let off = sign * (10_000.0 / course.emitted as f32).sqrt();
                    course.note_probe(&[Sighting::default(); 8], vec![Vec3::splat(4.0 + off); 8]);
                }
                step => panic!("{step:?}"),
            }
        }
        let refinement = course.refinement(0.0);
        assert!((4..12).contains(&looks) && refinement.photons.is_multiple_of(3), "{looks} looks, {refinement:?}");
        assert!(course.map_error <= 0.5 * 0.01);
        assert_eq!(course.next_step(), Step::Sample(1));
    }

    #[test]
    fn photons_go_on_while_they_are_cheap() {
        let settings = RenderSettings { width: 1024, height: 512, ..settings(None, None) };
        let mut course = Course::new(&settings, SUPPLY);
        // Far below a quarter of the target's square, and above a twentieth.
        let mut sign = 1.0;
        while course.stage == Stage::Photons {
            match course.next_step() {
                Step::Emit(range) => course.note_photons(range.end),
                Step::Probe => {
                    sign = -sign;
                    course.note_probe(&[Sighting::default(); 8], vec![Vec3::splat(4.0 + 0.07 * sign); 8]);
                }
                step => panic!("{step:?}"),
            }
        }
        let fewest = u64::from(settings.width * settings.height) / 2;
        assert!((fewest..3 * fewest).contains(&course.emitted), "{} photons", course.emitted);
    }

    #[test]
    fn coloured_noise_counts_as_white_noise_does() {
        let change = |color: Vec3| {
            let look = Look { sightings: &[Sighting::default()], of_maps: &[color] };
            look.relative_change(&[1.1 * color])
        };
        let (white, red) = (change(Vec3::ONE), change(Vec3::X));
        assert!((white - 0.01 / 1.01).abs() < 1e-4, "{white}");
        // Of a single channel the darkness that is forgiven is a third.
        assert!((red - 0.01 / (1.0 + 1.0 / 300.0)).abs() < 1e-3, "{red}");
    }

    #[test]
    fn samples_go_where_errors_are() {
        let mut course = Course::new(&settings(Some(0), None), SUPPLY);
        course.note_samples(2);
        course.note_samples(2);
        assert_eq!(course.next_step(), Step::Estimate);
        course.note_errors(&errors(&[(0.0, 4), (0.0, 4), (0.0, 4), (0.2, 4)]));
        // The third is doubted for its neighbour's sake.
        assert_eq!(course.next_step(), Step::SampleTiles { tiles: vec![2, 3], count: 4 });
        course.note_tile_samples(4);
        assert_eq!(course.next_step(), Step::Estimate);
        course.note_errors(&errors(&[(0.0, 4), (0.0, 4), (0.0, 8), (0.004, 8)]));
        assert_eq!(course.next_step(), Step::Rest);
        assert!((course.refinement(0.0).error.unwrap() - 0.001f64.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn tiles_that_never_settle_end_at_the_most_samples() {
        let mut course = Course::new(&settings(Some(0), None), SUPPLY);
        course.note_samples(FIRST_SAMPLES);
        course.note_errors(&errors(&[(0.0, 4), (1.0, MOST_SAMPLES), (0.0, 4)]));
        assert_eq!(course.next_step(), Step::SampleTiles { tiles: vec![0, 2], count: 3 });
        course.note_errors(&errors(&[(0.0, 4), (1.0, MOST_SAMPLES), (0.0, MOST_SAMPLES)]));
        assert_eq!(course.next_step(), Step::Rest);
    }

    #[test]
    fn without_photons_there_are_samples_alone() {
        let course = Course::new(&settings(None, None), PhotonSupply { turns: 0, most: 0 });
        assert_eq!(course.stage, Stage::Samples);
    }
}
