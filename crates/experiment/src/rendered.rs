//! Renders the cells.

use std::{collections::BTreeMap, ops::ControlFlow, path::Path, rc::Rc, time::Instant};

use diacaustic::{
    Film, Renderer, Stage,
    scene::{OutputSettings, Override, Scene, SceneOptions, ToneCurve, load_scene_with},
};
use diacaustic_output::{Display, Picture, Tone};

use crate::{
    ClosedForm, Error, Experiment, Figures, Measure, MeasuredRefraction,
    contact_sheet::write_contact_sheet,
    csv::csv,
    figures::relative_error,
    measured_refraction::measure_refractions,
    page::page,
    plan::{Cell, Job},
};

/// How far an experiment is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress<'p> {
    /// The picture that is rendered next.
    pub name: &'p str,
    /// Pictures done.
    pub done: usize,
    /// Pictures in all.
    pub total: usize,
}

/// A rendered cell.
#[derive(Clone, Debug, PartialEq)]
pub struct CellResult {
    /// Index of its table.
    pub table: usize,
    /// Its row, from 0.
    pub row: usize,
    /// Its column, from 0.
    pub column: usize,
    /// Index of its model.
    pub model: usize,
    /// Its picture's file, relative to the page.
    pub picture: String,
    /// What was measured.
    pub figures: Figures,
    /// Photons emitted.
    pub photons: u64,
    /// The picture's pixels as 8-bit sRGB, row by row.
    pub pixels: Vec<u8>,
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
}

/// An experiment's results.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rendered {
    /// Every cell.
    pub cells: Vec<CellResult>,
    /// What the kernels make of equation 3 and of Snell's law, if the experiment plots them.
    pub refractions: Vec<MeasuredRefraction>,
}

/// A job that is done.
struct Done {
    film: Film,
    display: Display,
    figures: Figures,
    photons: u64,
}

impl Experiment {
    /// Renders every cell; cells with equal scenes once. Blocks until all is done; `progress` hears of each picture before it begins, and may
    /// end the work there: then the cells so far are all that there is, and findings about others are not judged.
    ///
    /// # Errors
    /// If a scene cannot be read or rendered, or has no such object with an energy map.
    pub fn render(
        &self,
        renderer: &mut Renderer,
        mut progress: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Rendered, Error> {
        let cells = self.cells();
        let keys = cells.iter().flat_map(|cell| std::iter::once(&cell.job).chain(&cell.reference));
        let total = keys.collect::<std::collections::BTreeSet<_>>().len();
        let mut done: BTreeMap<Job, Rc<Done>> = BTreeMap::new();
        let mut rendered = Rendered::default();
        for cell in &cells {
            let mut get = |job: &Job, what: &str| {
                if let Some(known) = done.get(job) {
                    return Ok(Some(Rc::clone(known)));
                }
                if progress(Progress { name: &format!("{}{what}", cell.name), done: done.len(), total }).is_break() {
                    return Ok(None);
                }
                let result = Rc::new(self.run(renderer, cell, job)?);
                done.insert(job.clone(), Rc::clone(&result));
                Ok::<_, Error>(Some(result))
            };
            let Some(result) = get(&cell.job, "")? else { return Ok(rendered) };
            let reference = match &cell.reference {
                None => None,
                Some(job) => match get(job, ", reference")? {
                    None => return Ok(rendered),
                    reference => reference,
                },
            };
            rendered.cells.push(self.result(cell, &result, reference.as_deref()));
        }
        if self.closed_forms.contains(&ClosedForm::Refraction) {
            rendered.refractions = measure_refractions(renderer)?;
        }
        Ok(rendered)
    }

    fn run(&self, renderer: &mut Renderer, cell: &Cell, job: &Job) -> Result<Done, Error> {
        let of_scene = |cause| Error::Scene { cell: cell.name.clone(), cause: Box::new(cause) };
        let of_render = |cause| Error::Render { cell: cell.name.clone(), cause: Box::new(cause) };
        let overrides = job.sets.iter().map(|(key, value)| Override::parse(&format!("{key}={value}")));
        let overrides = overrides.collect::<Result<_, _>>().map_err(of_scene)?;
        let options = SceneOptions { overrides, ..SceneOptions::default() };
        let scene = load_scene_with(&job.scene, &options).map_err(of_scene)?.scene;
        renderer.set_scene(&scene).map_err(of_render)?;
        // What a driver compiles when a kernel first runs is not the photons' time.
        renderer
            .add_samples(1)
            .and_then(|()| renderer.emit_photons(0..1))
            .and_then(|()| renderer.wait())
            .map_err(of_render)?;
        renderer.restart().map_err(of_render)?;
        let start = Instant::now();
        let mut photon_seconds = 0.0;
        let photons = loop {
            let refinement = renderer.refine().map_err(of_render)?;
            match refinement.stage {
                Stage::Photons => {}
                // The first samples begin when photons are done.
                Stage::Samples if refinement.samples == 0.0 => photon_seconds = start.elapsed().as_secs_f64(),
                Stage::Samples => {}
                Stage::Done => break refinement.photons,
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        let film = renderer.film().map_err(of_render)?;
        let object = self.object(&scene, cell)?;
        let map = renderer.energy_map(object).map_err(of_render)?.ok_or_else(|| self.no_map(cell))?;
        if map.tiles.tiles.len() != map.layers as usize {
            return Err(self.no_stated_size(cell));
        }
        let figures = Figures { photon_seconds, seconds, ..Figures::of_map(&map, &cell.measure) };
        Ok(Done { film, display: display(&scene.output), figures, photons })
    }

    /// The object whose map is measured.
    fn object(&self, scene: &Scene, cell: &Cell) -> Result<usize, Error> {
        let Measure { object, .. } = &cell.measure;
        scene.objects.iter().position(|of_scene| of_scene.name == *object).ok_or_else(|| {
            let known: Vec<_> = scene.objects.iter().map(|object| object.name.as_str()).collect();
            Error::Invalid {
                path: self.path.clone(),
                part: cell.name.clone(),
                problem: format!("the scene has no object {object:?} to measure; it has {}", known.join(", ")),
            }
        })
    }

    fn no_map(&self, cell: &Cell) -> Error {
        Error::Invalid {
            path: self.path.clone(),
            part: cell.name.clone(),
            problem: format!("object {:?} has no energy map; measure one with a diffuse share", cell.measure.object),
        }
    }

    fn no_stated_size(&self, cell: &Cell) -> Error {
        let object = &cell.measure.object;
        let problem = format!(
            "the energy map of object {object:?} has texels of several sizes, which figures at the scale of a texel cannot compare; set render.map_size"
        );
        Error::Invalid { path: self.path.clone(), part: cell.name.clone(), problem }
    }

    fn result(&self, cell: &Cell, done: &Done, reference: Option<&Done>) -> CellResult {
        let Film { width, height, radiance, .. } = &done.film;
        let (table, model) = (&self.tables[cell.table], &self.models[cell.model]);
        let error = reference.map(|reference| relative_error(radiance, &reference.film.radiance));
        let model_name: String =
            model.name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
        CellResult {
            table: cell.table,
            row: cell.row,
            column: cell.column,
            model: cell.model,
            picture: format!("pictures/{}-{}-{}-{}.png", table.id, cell.row + 1, cell.column + 1, model_name),
            figures: Figures { error, ..done.figures },
            photons: done.photons,
            pixels: done.display.encode(&Picture { width: *width, height: *height, pixels: radiance }),
            width: *width,
            height: *height,
        }
    }
}

fn display(output: &OutputSettings) -> Display {
    let tone = match output.tone {
        ToneCurve::Plain => Tone::Plain,
        ToneCurve::Filmic => Tone::Filmic,
    };
    Display { exposure: output.exposure, tone }
}

impl Rendered {
    /// The cell of a table in a model.
    pub fn cell(&self, table: usize, row: usize, column: usize, model: usize) -> Option<&CellResult> {
        self.cells.iter().find(|c| (c.table, c.row, c.column, c.model) == (table, row, column, model))
    }

    /// Writes `index.html`, `contact-sheet.png`, `figures.csv`, the pictures and the plots into a folder, which is made where it is missing.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, experiment: &Experiment, folder: &Path) -> Result<(), Error> {
        for folder in [folder, &folder.join("pictures"), &folder.join("plots")] {
            std::fs::create_dir_all(folder).map_err(|cause| Error::Folder { path: folder.to_owned(), cause })?;
        }
        for cell in &self.cells {
            diacaustic_output::write_rgb8(&folder.join(&cell.picture), cell.width, cell.height, &cell.pixels)?;
        }
        for (id, svg) in self.plots(experiment) {
            diacaustic_output::write_text(&folder.join("plots").join(id).with_extension("svg"), &svg)?;
        }
        write_contact_sheet(&folder.join("contact-sheet.png"), experiment, self)?;
        diacaustic_output::write_text(&folder.join("figures.csv"), &csv(experiment, self))?;
        Ok(diacaustic_output::write_text(&folder.join("index.html"), &page(experiment, self))?)
    }
}
