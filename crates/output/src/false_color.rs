//! Irradiance as a picture in false colours, with a scale.

mod canvas;
mod scale;

use std::path::Path;

use self::{
    canvas::{Canvas, Color, LETTER},
    scale::Scale,
};
use crate::{Error, Irradiance, png::write_rgb8};

/// The least width of a map in the picture, pixels: smaller maps are enlarged by a whole factor.
const LEAST_WIDTH: u32 = 512;
/// Between things, pixels before enlarging text.
const GAP: u32 = 16;
/// Width of the scale's bar.
const BAR: u32 = 32;
/// Letters beside the bar.
const TICK_LETTERS: u32 = 8;
/// The least factor by which text is enlarged.
const LEAST_TEXT: u32 = 1;
/// Pixels of a map for each further factor.
const WIDTH_PER_TEXT_SIZE: u32 = 3072;

const PAPER: Color = [250, 250, 250];
const INK: Color = [20, 20, 20];
const NO_LIGHT: Color = [0, 0, 0];
const BORDER: Color = [255, 255, 255];

/// Writes the mean of the channels as PNG: Viridis over a scale that the picture states, black where there is no light, the borders of
/// charts in white. The back stands below the front.
pub(crate) fn write_false_colors(path: &Path, map: &Irradiance<'_>) -> Result<(), Error> {
    let texels_in_layer = map.width as usize * map.height as usize;
    let means: Vec<f32> = map.texels.iter().map(|texel| texel.iter().sum::<f32>() / 3.0).collect();
    let layers: Vec<&[f32]> = means.chunks(texels_in_layer.max(1)).collect();
    let scale = Scale::of(&means);
    let plan = Plan::new(map, layers.len() as u32);
    let mut canvas = Canvas::new(plan.width, plan.height, PAPER);
    for (number, texels) in layers.iter().enumerate() {
        let top = plan.top_of(number as u32);
        let name = if number == 0 { "front" } else { "back" };
        if layers.len() > 1 {
            canvas.text([plan.gap, top - plan.line], name, plan.text, INK);
        }
        draw_map(&mut canvas, map, texels, &scale, [plan.gap, top], plan.enlarged);
    }
    draw_scale(&mut canvas, &scale, &plan);
    write_rgb8(path, plan.width, plan.height, canvas.bytes())
}

/// Where things stand in the picture, pixels.
struct Plan {
    /// Pixels for each texel along each axis.
    enlarged: u32,
    /// Pixels for each of a letter's.
    text: u32,
    gap: u32,
    /// Height of a line of text with the space below.
    line: u32,
    map_width: u32,
    map_height: u32,
    layers: u32,
    width: u32,
    height: u32,
}

impl Plan {
    fn new(map: &Irradiance<'_>, layers: u32) -> Self {
        let enlarged = LEAST_WIDTH.div_ceil(map.width).max(1);
        let (map_width, map_height) = (map.width * enlarged, map.height * enlarged);
        let text = LEAST_TEXT + map_width / WIDTH_PER_TEXT_SIZE;
        let (gap, line) = (GAP * text, (LETTER[1] + 8) * text);
        let caption = if layers > 1 { line } else { 0 };
        Self {
            enlarged,
            text,
            gap,
            line,
            map_width,
            map_height,
            layers,
            width: map_width + 4 * gap + (BAR + TICK_LETTERS * LETTER[0]) * text,
            height: gap + line + layers * (caption + map_height + gap),
        }
    }

    /// The upper edge of a layer.
    fn top_of(&self, layer: u32) -> u32 {
        let caption = if self.layers > 1 { self.line } else { 0 };
        self.gap + self.line + layer * (caption + self.map_height + self.gap) + caption
    }
}

fn draw_map(
    canvas: &mut Canvas,
    map: &Irradiance<'_>,
    texels: &[f32],
    scale: &Scale,
    [left, top]: [u32; 2],
    enlarged: u32,
) {
    for (index, &value) in texels.iter().enumerate() {
        let (column, row) = (index as u32 % map.width, index as u32 / map.width);
        let color = if value > 0.0 { viridis(scale.part(value)) } else { NO_LIGHT };
        canvas.fill([left + column * enlarged, top + row * enlarged], [enlarged; 2], color);
    }
    // A texel's middle stands at a whole number.
    let pixel = |place: [f32; 2]| {
        let along = |at: f32, start: u32| start as f32 + (at + 0.5) * enlarged as f32 - 0.5;
        [along(place[0], left), along(place[1], top)]
    };
    for [from, to] in map.chart_borders {
        canvas.line(pixel(*from), pixel(*to), BORDER);
    }
}

fn draw_scale(canvas: &mut Canvas, scale: &Scale, plan: &Plan) {
    let (left, top) = (plan.map_width + 2 * plan.gap, plan.top_of(0));
    let kind = if scale.is_logarithmic() { "logarithmic" } else { "linear" };
    let title = format!("W/m^2, mean of channels, {kind}");
    canvas.text([plan.gap, plan.gap], &title, plan.text, INK);
    let height = plan.map_height.max(1);
    for y in 0..height {
        let part = 1.0 - (y as f32 + 0.5) / height as f32;
        canvas.fill([left, top + y], [BAR * plan.text, 1], viridis(part));
    }
    let space = (LETTER[1] + 4) * plan.text;
    let mut free_below = u32::MAX;
    for (part, label) in scale.ticks() {
        let y = top + ((1.0 - part) * (height - 1) as f32).round() as u32;
        canvas.fill([left + BAR * plan.text, y], [plan.gap / 2, plan.text], INK);
        // Numbers that would cover the one before are left out, from the lowest up.
        let text_top =
            y.saturating_sub(LETTER[1] * plan.text / 2).min(top + height - (LETTER[1] * plan.text).min(height));
        if free_below >= space && text_top <= free_below.saturating_sub(space) {
            canvas.text([left + BAR * plan.text + plan.gap, text_top], &label, plan.text, INK);
            free_below = text_top;
        }
    }
}

fn viridis(part: f32) -> Color {
    let color = colorous::VIRIDIS.eval_continuous(f64::from(part.clamp(0.0, 1.0)));
    [color.r, color.g, color.b]
}
