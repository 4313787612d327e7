//! All pictures in one, with their headings.

use std::path::Path;

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use crate::{CellResult, Error, Experiment, Rendered};

/// Width of a picture on the sheet, pixels.
const PICTURE: u32 = 160;
/// Space around pictures.
const GAP: u32 = 8;
/// Space around the whole.
const MARGIN: u32 = 20;
const TEXT: RasterHeight = RasterHeight::Size16;
const LINE: u32 = 20;
const INK: u8 = 40;

/// A picture of gray paper.
struct Sheet {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Sheet {
    fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![255; 3 * width as usize * height as usize] }
    }

    /// Writes text from its upper left corner on, at most `room` pixels of it. Letters that the font has not become spaces.
    fn write(&mut self, text: &str, x: u32, y: u32, room: u32) {
        let width = get_raster_width(FontWeight::Regular, TEXT) as u32;
        for (at, letter) in text.chars().take((room / width) as usize).enumerate() {
            let Some(raster) = get_raster(letter, FontWeight::Regular, TEXT) else { continue };
            for (row, coverages) in raster.rows().enumerate() {
                for (column, &coverage) in coverages.iter().enumerate() {
                    let shade = 255 - (u32::from(coverage) * u32::from(255 - INK) / 255) as u8;
                    self.set(x + at as u32 * width + column as u32, y + row as u32, [shade; 3]);
                }
            }
        }
    }

    fn set(&mut self, x: u32, y: u32, color: [u8; 3]) {
        if x < self.width && y < self.height {
            let at = 3 * (y as usize * self.width as usize + x as usize);
            self.pixels[at..at + 3].copy_from_slice(&color);
        }
    }

    /// Shows a picture, scaled to the sheet's width of one: each pixel is the mean of those that it covers.
    fn show(&mut self, cell: &CellResult, x: u32, y: u32) {
        for row in 0..shown_height(cell) {
            for column in 0..PICTURE {
                self.set(x + column, y + row, mean_color(cell, column, row));
            }
        }
    }
}

fn shown_height(cell: &CellResult) -> u32 {
    (PICTURE * cell.height / cell.width.max(1)).max(1)
}

/// The mean of the pixels that lie under a pixel of the sheet.
fn mean_color(cell: &CellResult, column: u32, row: u32) -> [u8; 3] {
    let span = |at: u32, of: u32, shown: u32| {
        let from = at * of / shown;
        from..((at + 1) * of / shown).clamp(from + 1, of.max(from + 1))
    };
    let mut sum = [0u32; 3];
    let mut count = 0;
    for y in span(row, cell.height, shown_height(cell)) {
        for x in span(column, cell.width, PICTURE) {
            let at = 3 * (y as usize * cell.width as usize + x as usize);
            for (channel, sum) in sum.iter_mut().enumerate() {
                *sum += u32::from(cell.pixels[at + channel]);
            }
            count += 1;
        }
    }
    sum.map(|sum| (sum / count.max(1)) as u8)
}

/// A row of pictures with what stands over them.
struct Strip<'r> {
    heading: Option<String>,
    labels: Vec<String>,
    cells: Vec<&'r CellResult>,
}

/// The strips of all tables: of a row, its pictures in each model side by side.
fn strips<'r>(experiment: &Experiment, rendered: &'r Rendered) -> Vec<Strip<'r>> {
    let mut strips = Vec::new();
    for (index, table) in experiment.tables.iter().enumerate() {
        for (row, step) in table.row_steps().iter().enumerate() {
            let mut strip =
                Strip { heading: (row == 0).then(|| table.title.clone()), labels: Vec::new(), cells: Vec::new() };
            for (model, of_model) in experiment.models.iter().enumerate() {
                for (column, column_step) in table.columns.steps.iter().enumerate() {
                    let Some(cell) = rendered.cell(index, row, column, model) else { continue };
                    let first = match (column, step.label.as_str()) {
                        (0, "") => format!("{}: {}", of_model.name, table.columns.label),
                        (0, of_row) => format!("{}, {of_row}: {}", of_model.name, table.columns.label),
                        _ => String::new(),
                    };
                    strip.labels.push(format!("{first}\n{}", column_step.label));
                    strip.cells.push(cell);
                }
            }
            strips.push(strip);
        }
    }
    strips
}

/// Writes the sheet as PNG.
pub(crate) fn write_contact_sheet(path: &Path, experiment: &Experiment, rendered: &Rendered) -> Result<(), Error> {
    let strips = strips(experiment, rendered);
    let columns = strips.iter().map(|strip| strip.cells.len()).max().unwrap_or(0).max(1) as u32;
    let strip_height = |strip: &Strip| {
        let pictures = strip.cells.iter().map(|cell| shown_height(cell)).max().unwrap_or(0);
        pictures + 2 * LINE + GAP + if strip.heading.is_some() { 2 * LINE } else { 0 }
    };
    let width = 2 * MARGIN + columns * (PICTURE + GAP) - GAP;
    let height = 2 * MARGIN + LINE + strips.iter().map(strip_height).sum::<u32>();
    let mut sheet = Sheet::new(width, height);
    let room = width - 2 * MARGIN;
    sheet.write(&experiment.title, MARGIN, MARGIN, room);
    let mut y = MARGIN + LINE;
    for strip in &strips {
        let bottom = y + strip_height(strip);
        if let Some(heading) = &strip.heading {
            y += LINE;
            sheet.write(heading, MARGIN, y, room);
            y += LINE;
        }
        for (column, (cell, label)) in strip.cells.iter().zip(&strip.labels).enumerate() {
            let x = MARGIN + column as u32 * (PICTURE + GAP);
            for (line, text) in label.lines().enumerate() {
                // Only a model's first picture has a first line, which may go on over the next.
                let room = if line == 0 { 2 * PICTURE } else { PICTURE };
                sheet.write(text, x, y + line as u32 * LINE, room);
            }
            sheet.show(cell, x, y + 2 * LINE);
        }
        y = bottom;
    }
    Ok(diacaustic_output::write_rgb8(path, sheet.width, sheet.height, &sheet.pixels)?)
}
