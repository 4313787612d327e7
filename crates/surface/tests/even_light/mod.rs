//! Surfaces on which photons fall evenly, and what their maps show.
#![allow(dead_code, reason = "each user takes some of it")]

use std::collections::HashMap;

use diacaustic_scene::Object;
use diacaustic_surface::{MapLayout, MapTiles, TexelChart, TexelSurface, Welds, WorldTriangle, texel_surfaces};
use glam::{Vec2, Vec3};

use crate::shapes::hashed;

/// Units of a photon's flux.
pub const UNITS: i64 = 1 << 24;
/// Mean squared relative deviation of the irradiance read inside a flat chart, for one photon a texel: photons are laid and read bilinearly.
const INSIDE: f64 = 0.25;

/// A photon's texels and its shares there.
pub type Deposit = [(usize, i64); 4];

/// The triangles of an object that have an area.
pub fn world_triangles(object: &Object) -> Vec<WorldTriangle> {
    let place = |p: Vec3| object.world_from_object.transform_point3(p);
    let triangle = |number: usize| WorldTriangle {
        corners: object.mesh.corners(number).map(place),
        normals: None,
        uvs: None,
        object: 0,
        triangle: number as u32,
        material: 0,
        exchanged: false,
    };
    let all = (0..object.mesh.triangles.len()).map(triangle);
    all.filter(|triangle| triangle.double_area_normal() != Vec3::ZERO).collect()
}

/// m².
pub fn area(triangle: &WorldTriangle) -> f64 {
    let [a, b, c] = triangle.corners.map(Vec3::as_dvec3);
    0.5 * (b - a).cross(c - a).length()
}

/// A texel's sum of flux and of the squares of its shares.
#[derive(Clone, Copy, Default)]
pub struct Texel {
    pub sum: i64,
    pub squares: f64,
}

/// A surface with its map.
pub struct Surface {
    pub layout: MapLayout,
    pub triangles: Vec<WorldTriangle>,
    pub tiles: MapTiles,
    pub texels: Vec<TexelSurface>,
    /// Whether less than all of a texel's surroundings on the plane is covered.
    pub is_border: Vec<bool>,
    /// The areas of the triangles, each added to those before.
    ends: Vec<f64>,
}

/// How uneven something shows even light: squared relative deviations, 1 in the mean inside a flat chart.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unevenness {
    pub squares: f64,
    pub places: f64,
    pub most: f64,
}

impl Unevenness {
    pub fn mean(&self) -> f64 {
        self.squares / self.places
    }

    fn add(&mut self, square: f64) {
        *self = Self { squares: self.squares + square, places: self.places + 1.0, most: square.max(self.most) };
    }

    pub fn join(&mut self, other: &Self) {
        self.squares += other.squares;
        self.places += other.places;
        self.most = self.most.max(other.most);
    }
}

impl Surface {
    pub fn new(object: &Object, layout: MapLayout) -> Self {
        let triangles = world_triangles(object);
        let tiles = MapTiles::dense(&layout);
        let texels = texel_surfaces(&layout, &tiles, &triangles);
        let ends = triangles.iter().scan(0.0, |sum, triangle| {
            *sum += area(triangle);
            Some(*sum)
        });
        let is_border = texels.iter().map(|texel| texel.covered < 0.999).collect();
        Self { ends: ends.collect(), layout, tiles, texels, is_border, triangles }
    }

    pub fn welds(&self) -> Welds {
        Welds::new(&self.layout, &self.tiles, &self.texels, &self.triangles)
    }

    /// The areas of the texels, m².
    pub fn areas(&self) -> Vec<f64> {
        self.texels.iter().map(|texel| texel.area).collect()
    }

    /// The area of both sides if both are kept, m².
    pub fn area(&self) -> f64 {
        f64::from(self.layout.layers) * self.ends.last().copied().unwrap_or(0.0)
    }

    /// Texels that the surface's area makes.
    pub fn whole_texels(&self) -> f64 {
        self.area() / f64::from(self.layout.metres_per_texel).powi(2)
    }

    /// The texels around a point of a triangle, by its place in the list, and their shares of a photon, as the kernel lays them.
    pub fn deposit(&self, number: usize, layer: u32, [u, v]: [f32; 2]) -> Deposit {
        let layout = &self.layout;
        let c = layout.corners[self.triangles[number].triangle as usize];
        let at = (1.0 - u - v) * c[0] + u * c[1] + v * c[2];
        let cell = at.floor().clamp(Vec2::ZERO, Vec2::new((layout.width - 2) as f32, (layout.height - 2) as f32));
        let f = (at - cell).clamp(Vec2::ZERO, Vec2::ONE);
        let weights = [(1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y];
        let [a, b, c] = weights.map(|weight| (UNITS as f32 * weight).round() as i64);
        let width = layout.width as usize;
        let first = (layer as usize * layout.height as usize + cell.y as usize) * width + cell.x as usize;
        [(first, a), (first + 1, b), (first + width, c), (first + width + 1, UNITS - a - b - c)]
    }

    /// Points spread evenly over the surface.
    pub fn even_points(&self, points: std::ops::Range<u32>) -> impl Iterator<Item = Deposit> + '_ {
        points.map(move |point| {
            let [pick, u, v] = [0, 1, 2].map(|k| hashed(3 * point + k));
            // The side is in the bits that pick the triangle.
            let (pick, layer) =
                ((pick * f64::from(self.layout.layers)).fract(), (pick * f64::from(self.layout.layers)) as u32);
            let number = self.ends.partition_point(|end| *end <= pick * self.ends[self.ends.len() - 1]);
            let b = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] }.map(|x| x as f32);
            self.deposit(number.min(self.triangles.len() - 1), layer, b)
        })
    }

    /// Lays photons on points spread evenly over the surface.
    pub fn lit_evenly(&self, photons: u32) -> Vec<Texel> {
        let mut texels = vec![Texel::default(); self.texels.len()];
        for (texel, share) in self.even_points(0..photons).flatten() {
            texels[texel].sum += share;
            texels[texel].squares += (share as f64 / UNITS as f64).powi(2);
        }
        texels
    }

    /// The mean squared difference of what is shown on both sides of edges between charts whose triangles face within 37°, and how many there are.
    pub fn jumps(&self, shown: &[f64]) -> (f64, usize) {
        let mut sides: HashMap<[[u32; 3]; 2], (usize, usize)> = HashMap::new();
        let (mut squares, mut count) = (0.0, 0u32);
        for (number, triangle) in self.triangles.iter().enumerate() {
            let corners = triangle.corners.map(|p| p.to_array().map(f32::to_bits));
            for edge in 0..3 {
                let next = (edge + 1) % 3;
                let Some((other, other_edge)) = sides.remove(&[corners[next], corners[edge]]) else {
                    sides.insert([corners[edge], corners[next]], (number, edge));
                    continue;
                };
                let pair = [number, other].map(|k| self.triangles[k]);
                let [a, b] = pair.map(|triangle| triangle.double_area_normal().normalize());
                let charts = pair.map(|triangle| self.layout.charts[triangle.triangle as usize]);
                if charts[0] != charts[1] && a.dot(b) > 0.8 {
                    let middle = |number: usize, edge: usize| {
                        let at = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]][edge];
                        read(&self.deposit(number, 0, at), shown)
                    };
                    squares += (middle(number, edge) - middle(other, other_edge)).powi(2);
                    count += 1;
                }
            }
        }
        (squares / f64::from(count), count as usize)
    }

    /// The irradiance that follows from photons by some welds, over its mean.
    pub fn shown(&self, photons: &[Texel], welds: &Welds) -> Vec<f64> {
        let flux: Vec<f64> = photons.iter().map(|texel| texel.sum as f64 / UNITS as f64).collect();
        let mean = flux.iter().sum::<f64>() / self.area();
        welds.irradiance(&flux, &self.areas()).into_iter().map(|value| value / mean).collect()
    }

    /// The unevenness of what is shown of even light, at places spread evenly over the surface: inside charts, near their borders, and in cells.
    ///
    /// In units of what chance makes of a flat texel, or with `by_density` of one with as much surface for its part of the plane as the four around
    /// a place have.
    pub fn unevenness(&self, photons: u32, shown: &[f64], points: u32, by_density: bool) -> [Unevenness; 3] {
        let unit = INSIDE * self.whole_texels() / f64::from(photons);
        let density = |place: &Deposit| {
            let sum = |of: &dyn Fn(&TexelSurface) -> f64| {
                place.iter().map(|&(texel, _)| of(&self.texels[texel])).sum::<f64>()
            };
            let covered = sum(&|texel| f64::from(texel.covered).min(1.0));
            sum(&|texel| texel.area) / covered / f64::from(self.layout.metres_per_texel).powi(2)
        };
        let mut sums = [Unevenness::default(); 3];
        for place in self.even_points(1 << 30..(1 << 30) + points) {
            let value = read(&place, shown);
            let class = match self.texels[place[0].0].chart {
                TexelChart::Cell(_) => 2,
                _ => usize::from(place.iter().any(|&(texel, _)| self.is_border[texel])),
            };
            let unit = if by_density && class < 2 { unit / density(&place) } else { unit };
            sums[class].add((value - 1.0).powi(2) / unit);
        }
        sums
    }
}

/// What texels show at a place.
pub fn read(place: &Deposit, shown: &[f64]) -> f64 {
    place.iter().map(|&(texel, share)| share as f64 / UNITS as f64 * shown[texel]).sum()
}

/// Checks that evenly lit a surface has one irradiance, at the borders of charts as inside them, and that texels scatter as much as chance makes them.
pub fn check_deposits(name: &str, surface: &Surface, photons: u32) -> Vec<Texel> {
    let texels = surface.lit_evenly(photons);
    assert_eq!(texels.iter().map(|texel| texel.sum).sum::<i64>(), i64::from(photons) * UNITS, "{name}");
    let mut counted = 0;
    for (place, is_border) in [("inside charts", false), ("at their borders", true)] {
        let (mut bias, mut variance, mut squares, mut count) = (0.0, 0.0, 0.0, 0);
        for (k, (texel, TexelSurface { area, .. })) in texels.iter().zip(&surface.texels).enumerate() {
            assert!(*area > 0.0 || texel.sum == 0, "{name}: light on a texel without surface");
            let expected = f64::from(photons) * area / surface.area();
            if surface.is_border[k] != is_border {
                continue;
            }
            let deviation = texel.sum as f64 / UNITS as f64 - expected;
            bias += deviation;
            variance += texel.squares;
            if expected > 8.0 {
                squares += deviation * deviation / texel.squares;
                count += 1;
            }
        }
        if count < 20 {
            continue;
        }
        counted += count;
        // Shares of one photon fall on neighbours, so that the variance of the sum is up to four times the sum of theirs.
        assert!(bias.abs() < 5.0 * (4.0 * variance).sqrt(), "{name}: {bias} of {variance} {place}");
        let deviation = squares / f64::from(count);
        let spread = 6.0 * (2.0 / f64::from(count)).sqrt() + 0.03;
        assert!((deviation - 1.0).abs() < spread, "{name}: {deviation} ± {spread} times the variance expected {place}");
    }
    assert!(counted > 500, "{name}: {counted} texels");
    texels
}
