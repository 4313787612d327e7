//! A picture to draw on.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Red, green and blue, sRGB.
pub(super) type Color = [u8; 3];

/// Width of a letter, and height of a line.
pub(super) const LETTER: [u32; 2] =
    [get_raster_width(FontWeight::Regular, RasterHeight::Size16) as u32, RasterHeight::Size16.val() as u32];

/// Pixels, row by row from the top left.
pub(super) struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<Color>,
}

impl Canvas {
    pub fn new(width: u32, height: u32, color: Color) -> Self {
        Self { width, height, pixels: vec![color; width as usize * height as usize] }
    }

    pub fn bytes(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// Fills a rectangle, as far as it lies on the canvas.
    pub fn fill(&mut self, [left, top]: [u32; 2], [width, height]: [u32; 2], color: Color) {
        let right = left.saturating_add(width).min(self.width);
        for y in top..top.saturating_add(height).min(self.height) {
            for x in left.min(right)..right {
                self.pixels[y as usize * self.width as usize + x as usize] = color;
            }
        }
    }

    /// Draws a line a pixel wide.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], color: Color) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let steps = along[0].abs().max(along[1].abs()).ceil().max(1.0);
        for step in 0..=steps as u32 {
            let part = step as f32 / steps;
            let [x, y] = [0, 1].map(|axis| (from[axis] + part * along[axis]).round());
            if x >= 0.0 && y >= 0.0 {
                self.fill([x as u32, y as u32], [1, 1], color);
            }
        }
    }

    /// Writes ASCII text of letters enlarged by a whole factor, its upper left corner at a place; other letters are spaces.
    pub fn text(&mut self, [left, top]: [u32; 2], text: &str, size: u32, color: Color) {
        for (place, letter) in text.chars().enumerate() {
            let Some(glyph) = get_raster(letter, FontWeight::Regular, RasterHeight::Size16) else { continue };
            for (row, coverages) in glyph.rows().enumerate() {
                for (column, &coverage) in coverages.iter().enumerate() {
                    let x = left + (place as u32 * LETTER[0] + column as u32) * size;
                    self.blend([x, top + row as u32 * size], [size; 2], color, coverage);
                }
            }
        }
    }

    /// Fills a rectangle, as far as it lies on the canvas, with a color that covers a part of it, of 255.
    fn blend(&mut self, [left, top]: [u32; 2], [width, height]: [u32; 2], color: Color, coverage: u8) {
        let part = f32::from(coverage) / 255.0;
        let mixed =
            |below: u8, above: u8| (f32::from(below) + part * (f32::from(above) - f32::from(below))).round() as u8;
        let right = left.saturating_add(width).min(self.width);
        for y in top..top.saturating_add(height).min(self.height) {
            for x in left.min(right)..right {
                let pixel = &mut self.pixels[y as usize * self.width as usize + x as usize];
                *pixel = std::array::from_fn(|channel| mixed(pixel[channel], color[channel]));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stand_upright_and_lines_end_where_they_should() {
        let mut canvas = Canvas::new(20, 24, [0; 3]);
        canvas.text([1, 1], "L^", 1, [255; 3]);
        let ink = |canvas: &Canvas, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
            let of_row = |y: usize| columns.clone().map(move |x| u32::from(canvas.pixels[y * 20 + x][1]));
            rows.flat_map(of_row).sum::<u32>()
        };
        // The stem of an L is on the left, its foot at the bottom; a caret is at the top.
        assert!(
            ink(&canvas, 1..4, 3..10) > 2 * 255 && ink(&canvas, 5..8, 3..9) == 0 && ink(&canvas, 4..8, 10..16) > 255
        );
        assert!(ink(&canvas, 8..15, 1..10) > 255 && ink(&canvas, 8..15, 12..17) == 0);
        let is_set = |canvas: &Canvas, x: usize, y: usize| canvas.pixels[y * 20 + x] == [255; 3];
        canvas.line([17.0, 9.0], [19.0, 8.0], [255; 3]);
        assert!(is_set(&canvas, 17, 9) && is_set(&canvas, 19, 8));
        canvas.line([-5.0, 20.0], [40.0, 20.0], [255; 3]);
        assert!((0..20).all(|x| is_set(&canvas, x, 20)));
    }
}
