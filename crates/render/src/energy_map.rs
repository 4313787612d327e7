//! Energy maps as the application reads them.

use std::sync::Arc;

use diacaustic_surface::{MapTile, MapTiles, Welds};
use glam::{DVec2, DVec3};

/// One object's energy map, read from the device.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyMap {
    /// Texels along x of the map's layout, and of [`Self::resampled`].
    pub width: u32,
    /// Texels along y.
    pub height: u32,
    /// 1, or 2: what fell on the front, then what fell on the back.
    pub layers: u32,
    /// Where the texels lie. A map of a stated size has one tile for each layer, with the texels of the layout.
    pub tiles: MapTiles,
    /// Fixed-point sums of flux, tile by tile and row by row: integers, so that equal photons give equal sums in any order. Of a map of a
    /// stated size layer by layer and row by row.
    pub sums: Vec<[i64; 3]>,
    /// Area of each texel, m².
    pub areas: Vec<f64>,
    /// How tiles join: texels of several tiles that stand at one place are one.
    pub welds: Arc<Welds>,
    /// Units of the sums in a watt.
    pub units_per_watt: f64,
    /// Photons that the sums are of, over every light.
    pub photons: u64,
    /// The size of the map by which the profile `paper` divides sums of energy, of which each photon brings the same, however many there are;
    /// none where photons share the light's flux.
    pub paper_size: Option<f64>,
    /// Smoothed irradiance of each texel, W/m², in a scene that asks for it; none after [`Self::merge`].
    pub smoothed: Option<Vec<[f32; 3]>>,
    /// Irradiance of each texel by its sums, W/m².
    pub(crate) unsmoothed: Vec<DVec3>,
}

/// The most points along each side of a resampled texel at which a map is looked at.
const MOST_POINTS: f64 = 64.0;

impl EnergyMap {
    /// Flux collected by a texel, W; in the profile `paper`, energy.
    ///
    /// # Panics
    /// If `texel` is out of range.
    pub fn flux(&self, texel: usize) -> DVec3 {
        let photons = if self.paper_size.is_some() { 1 } else { self.photons.max(1) };
        DVec3::from(self.sums[texel].map(|sum| sum as f64)) / (self.units_per_watt * photons as f64)
    }

    /// Irradiance of a texel as the picture shows it, W/m²: smoothed, or with mixed hues, where the scene asks for it. 0 where it holds no surface. In the profile
    /// `paper`, energy over the map's size.
    ///
    /// # Panics
    /// If `texel` is out of range.
    pub fn irradiance(&self, texel: usize) -> DVec3 {
        let smoothed = self.smoothed.as_ref().map(|smoothed| DVec3::from(smoothed[texel].map(f64::from)));
        smoothed.unwrap_or(self.unsmoothed[texel])
    }

    /// The irradiance that follows from the sums.
    pub(crate) fn resolve(&mut self) {
        let flux: Vec<DVec3> = (0..self.sums.len()).map(|texel| self.flux(texel)).collect();
        self.unsmoothed = match self.paper_size {
            Some(size) => {
                let over = |(flux, area): (&DVec3, &f64)| if *area > 0.0 { *flux / size } else { DVec3::ZERO };
                flux.iter().zip(&self.areas).map(over).collect()
            }
            None => self.welds.irradiance(&flux, &self.areas),
        };
    }

    /// Irradiance of a place of a layer's plane, in the layout's texels, W/m²: between the texels of its tile, as the picture shows it; 0
    /// where there is no such layer.
    pub fn irradiance_at(&self, layer: u32, place: DVec2) -> DVec3 {
        self.tiles.at(layer, place).map_or(DVec3::ZERO, |tile| self.irradiance_on(tile, place))
    }

    /// The same for a place on a known tile.
    fn irradiance_on(&self, tile: &MapTile, place: DVec2) -> DVec3 {
        let last = DVec2::new(f64::from(tile.cells[0] - 1), f64::from(tile.cells[1] - 1));
        let at = (place - self.tiles.origin(tile)) / self.tiles.cell_size(tile);
        let cell = at.floor().clamp(DVec2::ZERO, last);
        let f = (at - cell).clamp(DVec2::ZERO, DVec2::ONE);
        let columns = tile.cells[0] as usize + 1;
        let first = tile.first_texel as usize + cell.y as usize * columns + cell.x as usize;
        let row = |first: usize| self.irradiance(first).lerp(self.irradiance(first + 1), f.x);
        row(first).lerp(row(first + columns), f.y)
    }

    /// The map's irradiance as a picture of `width` × `height` texels for each layer, W/m², row by row. Where tiles are finer, a texel is the
    /// mean over its surroundings, which count as far as they hold a surface.
    pub fn resampled(&self) -> Vec<DVec3> {
        let texels = (0..self.layers).flat_map(|layer| (0..self.height).map(move |y| (layer, y)));
        let texels =
            texels.flat_map(|(layer, y)| (0..self.width).map(move |x| (layer, DVec2::new(x.into(), y.into()))));
        texels.map(|(layer, place)| self.mean_around(layer, place)).collect()
    }

    /// Mean irradiance over the square of the layout's texel at a place.
    fn mean_around(&self, layer: u32, place: DVec2) -> DVec3 {
        let Some(tile) = self.tiles.at(layer, place) else { return DVec3::ZERO };
        let cells = self.tiles.cell_size(tile).min_element().recip();
        // Texels of the layout, and what is coarser, stand for themselves.
        if cells <= 1.0 {
            return self.irradiance_on(tile, place);
        }
        let points = cells.ceil().min(MOST_POINTS) as u32;
        let mut sum = (DVec3::ZERO, 0.0);
        let mut tile = tile;
        for (y, x) in (0..points).flat_map(|y| (0..points).map(move |x| (y, x))) {
            let at = place + (DVec2::new(x.into(), y.into()) + 0.5) / f64::from(points) - 0.5;
            if at.cmplt(DVec2::ZERO).any() || at.cmpgt(self.tiles.extent).any() {
                continue;
            }
            if !self.tiles.covers(tile, at) {
                tile = self.tiles.at(layer, at).unwrap_or(tile);
            }
            if self.holds_surface(tile, at) {
                sum = (sum.0 + self.irradiance_on(tile, at), sum.1 + 1.0);
            }
        }
        sum.0 / f64::max(sum.1, 1.0)
    }

    /// Whether the texel nearest to a place has an area.
    fn holds_surface(&self, tile: &MapTile, place: DVec2) -> bool {
        let last = DVec2::new(tile.cells[0].into(), tile.cells[1].into());
        let at = ((place - self.tiles.origin(tile)) / self.tiles.cell_size(tile)).round().clamp(DVec2::ZERO, last);
        let texel = tile.first_texel + at.y as u64 * u64::from(tile.cells[0] + 1) + at.x as u64;
        self.areas[texel as usize] > 0.0
    }

    /// Adds the photons of another run of the same scene and seed: the sums of photons 0 to N and N to M are those of 0 to M. The result is not
    /// smoothed. Returns false, and changes nothing, if the maps differ in their texels or scale.
    #[must_use]
    pub fn merge(&mut self, other: &Self) -> bool {
        let alike = self.tiles == other.tiles && self.units_per_watt == other.units_per_watt;
        if alike {
            self.photons += other.photons;
            for (sum, more) in self.sums.iter_mut().zip(&other.sums) {
                *sum = std::array::from_fn(|channel| sum[channel].wrapping_add(more[channel]));
            }
            self.smoothed = None;
            self.resolve();
        }
        alike
    }
}
