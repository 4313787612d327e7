//! A surface's charts, laid flat and packed into one rectangle.

use glam::{DVec2, DVec3, UVec2, Vec2};
use rayon::prelude::*;

use super::{
    cells::share_cells,
    facets::Facets,
    flattening::{Frame, MARGIN},
    growing::grow_charts,
    packing::{Packing, pack},
    patches::Patches,
};

/// A surface's charts.
pub(super) struct Atlas {
    /// The chart of each triangle.
    pub chart_of: Vec<u32>,
    pub frames: Vec<Frame>,
    /// How many of the last are cells.
    pub cells: usize,
}

/// Charts at their places.
pub(super) struct Placed {
    /// Texels along both sides.
    pub size: UVec2,
    pub corners: Vec<[Vec2; 3]>,
    /// Width of a texel, units.
    pub texel: f64,
}

impl Atlas {
    /// Divides a surface into charts for texels that are `texel` units wide.
    pub(super) fn new(facets: &Facets<'_>, texel: f64) -> Self {
        let patches = Patches::new(facets, texel);
        let grown = grow_charts(facets, &patches, texel);
        let used: Vec<_> = grown.charts.iter().filter(|chart| !chart.patches.is_empty()).collect();
        let triangles = |patches_of: &[u32]| -> Vec<u32> {
            patches_of.iter().flat_map(|&patch| patches.triangles(patch).iter().copied()).collect()
        };
        let members: Vec<Vec<u32>> = used.iter().map(|chart| triangles(&chart.patches)).collect();
        let frame = |(axis, members): (DVec3, &Vec<u32>)| Frame::tight(axis, facets.corners_with_area(members));
        let frames: Vec<Frame> = used.par_iter().map(|chart| chart.axis).zip(&members).map(frame).collect();
        let (charts, cells) = share_cells(facets, frames, members, texel);
        let mut chart_of = vec![0; facets.mesh.triangles.len()];
        let mut frames = Vec::with_capacity(charts.len());
        for (number, (frame, members)) in charts.into_iter().enumerate() {
            frames.push(frame);
            members.into_iter().for_each(|triangle| chart_of[triangle as usize] = number as u32);
        }
        if frames.is_empty() {
            // Triangles without area lie on one point.
            frames.push(Frame::default());
        }
        Self { chart_of, frames, cells }
    }

    /// Packs the charts at a texel of given width into a rectangle that is about a square.
    pub(super) fn place(&self, facets: &Facets<'_>, texel: f64) -> Placed {
        let sizes = self.sizes(texel);
        let texels: f64 = sizes.iter().map(|size| f64::from(size.x) * f64::from(size.y)).sum();
        let widest = sizes.iter().map(|size| size.x).max().unwrap_or(2);
        // Skylines end raggedly, by about the height of the charts placed last.
        let width = ((1.02 * texels).sqrt().ceil() as u32).max(widest);
        let packing = pack(&sizes, width).unwrap_or(Packing { places: Vec::new(), height: 0 });
        self.put(facets, texel, &sizes, &packing)
    }

    /// Packs the charts into at most `side` × `side` texels that are about as fine as possible and at most `coarsest` units wide.
    pub(super) fn fit(&self, facets: &Facets<'_>, side: u32, start: f64, coarsest: f64) -> Option<Placed> {
        let longest = self.frames.iter().map(|frame| frame.size.x).fold(0.0, f64::max);
        // The longest chart's limit, with room for rounding.
        let finest = (longest / (f64::from(side) - 1.0 - 2.0 * MARGIN).max(0.5) * (1.0 + 1e-9)).max(0.25 * start);
        let mut best = None;
        let (mut too_fine, mut texel) = (finest, start.max(finest));
        for _ in 0..12 {
            if texel > coarsest.max(finest) {
                break;
            }
            let sizes = self.sizes(texel);
            let packing = pack(&sizes, side);
            let height = packing.as_ref().map_or(side + 1, |packing| packing.height);
            let fill = (f64::from(height) / f64::from(side)).sqrt();
            if let Some(packing) = packing.filter(|packing| packing.height <= side) {
                best = Some((texel, sizes, packing));
                let next = if too_fine > finest { (too_fine * texel).sqrt() } else { (texel * fill).max(finest) };
                if next > 0.99 * texel {
                    break;
                }
                texel = next;
            } else {
                too_fine = texel;
                texel = match &best {
                    Some((fits, ..)) if fits / texel < 1.01 => break,
                    Some((fits, ..)) => (fits * texel).sqrt(),
                    None => texel * fill.clamp(1.01, 2.0),
                };
            }
        }
        best.map(|(texel, sizes, packing)| self.put(facets, texel, &sizes, &packing))
    }

    /// The texels that each chart takes.
    fn sizes(&self, texel: f64) -> Vec<UVec2> {
        self.frames.iter().map(|frame| frame.texels(texel).as_uvec2()).collect()
    }

    fn put(&self, facets: &Facets<'_>, texel: f64, sizes: &[UVec2], packing: &Packing) -> Placed {
        let size = sizes.iter().zip(&packing.places).fold(UVec2::splat(2), |size, (own, place)| size.max(own + place));
        let origin = |(frame, (own, place)): (&Frame, (&UVec2, &UVec2))| {
            place.as_dvec2() + 0.5 * (own.as_dvec2() - 1.0 - frame.size / texel)
        };
        let origins: Vec<DVec2> = self.frames.iter().zip(sizes.iter().zip(&packing.places)).map(origin).collect();
        let corners = |(triangle, &chart): (usize, &u32)| {
            let (frame, origin) = (&self.frames[chart as usize], origins[chart as usize]);
            facets.corners(triangle as u32).map(|corner| (origin + frame.place(corner) / texel).as_vec2())
        };
        Placed { size, corners: self.chart_of.par_iter().enumerate().map(corners).collect(), texel }
    }
}
