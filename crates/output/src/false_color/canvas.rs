//! A picture to draw on.

use font8x8::{BASIC_FONTS, UnicodeFonts as _};

/// Red, green and blue, sRGB.
pub(super) type Color = [u8; 3];

/// Width and height of a letter.
pub(super) const LETTER: u32 = 8;

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

    /// Writes ASCII text of letters enlarged by a whole factor, its upper left corner at a place; other letters are blocks.
    pub fn text(&mut self, [left, top]: [u32; 2], text: &str, size: u32, color: Color) {
        for (place, letter) in text.chars().enumerate() {
            let glyph = BASIC_FONTS.get(letter).unwrap_or([0xff; 8]);
            for (row, bits) in glyph.iter().enumerate() {
                for column in (0..8).filter(|column| bits >> column & 1 == 1) {
                    let x = left + (place as u32 * LETTER + column) * size;
                    self.fill([x, top + row as u32 * size], [size; 2], color);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stand_upright_and_lines_end_where_they_should() {
        let mut canvas = Canvas::new(20, 10, [0; 3]);
        canvas.text([1, 1], "L^", 1, [255; 3]);
        let is_set = |canvas: &Canvas, x: usize, y: usize| canvas.pixels[y * 20 + x] == [255; 3];
        // The stem of an L is on the left, its foot at the bottom.
        assert!((1..7).all(|y| is_set(&canvas, 2, y)) && !is_set(&canvas, 6, 2) && is_set(&canvas, 6, 7));
        assert!((9..17).any(|x| is_set(&canvas, x, 1)));
        canvas.line([17.0, 9.0], [19.0, 8.0], [255; 3]);
        assert!(is_set(&canvas, 17, 9) && is_set(&canvas, 19, 8));
        canvas.line([-5.0, 3.0], [40.0, 3.0], [255; 3]);
        assert!((0..20).all(|x| is_set(&canvas, x, 3)));
    }
}
