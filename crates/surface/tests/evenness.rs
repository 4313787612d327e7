//! Even light looks even: at the borders of charts as inside, on any mesh and at any resolution of its map.

mod any_mesh;
mod even_light;
mod shapes;

use diacaustic_scene::Mesh;
use diacaustic_surface::{MapLayout, Weld, Welds};
use even_light::{Surface, Unevenness, check_deposits};
use glam::Vec3;
use proptest::{
    strategy::{Strategy, ValueTree},
    test_runner::TestRunner,
};

/// Photons for each texel of area.
const PHOTONS: f64 = 16.0;
/// How much more the squared deviation may be at borders than inside.
const MOST: f64 = 1.1;

/// What maps show of even light.
#[derive(Default)]
struct Shown {
    /// Inside charts, near their borders and in cells: in units of what chance makes of flat texels, and of texels that hold as much surface as
    /// those there.
    flat: [Unevenness; 3],
    dense: [Unevenness; 3],
    /// Near borders if texels stand alone.
    alone: Unevenness,
    /// Texels inside, at borders and in cells.
    texels: [f64; 3],
}

impl Shown {
    fn add(&mut self, surface: &Surface) {
        let photons = (PHOTONS * surface.whole_texels()) as u32;
        let points = photons / 2;
        let lit = surface.lit_evenly(photons);
        let shown = surface.shown(&lit, &surface.welds());
        let join = |sums: &mut [Unevenness; 3], new: [Unevenness; 3]| {
            sums.iter_mut().zip(new).for_each(|(sum, new)| sum.join(&new));
        };
        let flat = surface.unevenness(photons, &shown, points, false);
        let places: f64 = flat.iter().map(|of| of.places).sum();
        for (texels, of) in self.texels.iter_mut().zip(&flat) {
            *texels += of.places / places * surface.whole_texels();
        }
        join(&mut self.flat, flat);
        join(&mut self.dense, surface.unevenness(photons, &shown, points, true));
        let alone = surface.shown(&lit, &Welds::default());
        self.alone.join(&surface.unevenness(photons, &alone, points, true)[1]);
    }

    /// Checks that borders and cells are as even as the inside of charts, but for chance: three standard deviations of what so many texels show,
    /// each a mean over about four, so that a quarter of them count. The square of a normal number has a variance of 2.
    fn check(&self, name: &str) {
        let [inside, border, cells] = &self.dense;
        println!(
            "{name}: inside {:.3} ({:.0} texels), borders {:.3} ({:.0}; {:.3} if texels stand alone), cells {:.3} ({:.0}); \
             over flat texels {:.3}, {:.3}, {:.3}; the largest {:.0}, {:.0} ({:.0} alone)",
            inside.mean(),
            self.texels[0],
            border.mean(),
            self.texels[1],
            self.alone.mean(),
            cells.mean(),
            self.texels[2],
            self.flat[0].mean(),
            self.flat[1].mean(),
            self.flat[2].mean(),
            inside.most,
            border.most,
            self.alone.most,
        );
        let [few_inside, few_border, few_cells] = self.texels.map(|texels| 2.0 / (0.25 * texels).max(1.0));
        // Where hardly any place is inside a chart, what would be there is known.
        let (inside, few_inside) = if self.texels[0] > 500.0 { (inside.mean(), few_inside) } else { (1.0, 0.0) };
        for (place, of, few) in [("borders", border, few_border), ("cells", cells, few_cells)] {
            let chance = 3.0 * (few + few_inside).sqrt();
            assert!(
                of.places == 0.0 || of.mean() < MOST * inside + chance,
                "{name}, {place}: {} of {inside}",
                of.mean()
            );
        }
        assert!(self.flat[1].mean() < MOST + 3.0 * few_border.sqrt(), "{name}: {:?}", self.flat);
        assert!(border.most < 100.0, "{name}: a speck, {} times what is expected", border.most);
        assert!(border.mean() < self.alone.mean(), "{name}: the comparison cannot fail");
    }
}

fn check_shape(name: &str, mesh: Mesh, map_sizes: &[u32]) {
    let object = shapes::object(mesh);
    for &map_size in map_sizes {
        let layout = MapLayout::new(&object, map_size);
        assert!((map_size * 9 / 10..=map_size).contains(&layout.width.max(layout.height)), "{name}, {map_size}");
        let surface = Surface::new(&object, layout);
        if map_size == map_sizes[0] {
            check_deposits(name, &surface, 600_000);
        }
        let mut shown = Shown::default();
        shown.add(&surface);
        shown.check(&format!("{name}, {map_size}"));
    }
}

#[test]
fn sphere_is_lit_evenly() {
    check_shape("sphere", Mesh::sphere(Vec3::ZERO, 1.0, 5), &[96, 400]);
}

#[test]
fn torus_knot_is_lit_evenly() {
    check_shape("torus knot", shapes::torus_knot(300, 16), &[160, 500]);
}

#[test]
fn l_shaped_room_is_lit_evenly() {
    check_shape("room", shapes::l_room(), &[96, 400]);
}

#[test]
fn teapot_is_lit_evenly() {
    check_shape("teapot", shapes::teapot(), &[160, 600]);
}

/// Texels wider than the triangles, about as wide, and finer, as those of a picture are.
#[test]
fn scanned_surface_is_lit_evenly() {
    let mesh = shapes::scanned(180, 0.5);
    assert!(mesh.triangles.len() >= 100_000);
    check_shape("scanned", mesh, &[160, 400, 1000]);
}

/// Noise that turns every triangle away from its neighbours.
#[test]
fn rough_surface_is_lit_evenly() {
    check_shape("rough", shapes::scanned(180, 3.0), &[160, 400, 1000]);
}

#[test]
fn bumpy_surface_is_lit_evenly() {
    check_shape("bumpy", shapes::scanned(45, 0.5), &[60, 160, 400]);
}

#[test]
fn random_surfaces_are_lit_evenly() {
    for (map_size, count) in [(50, 40), (160, 40), (300, 8)] {
        let mut shown = Shown::default();
        for seed in 0..count {
            let object = shapes::object(shapes::random_mesh(seed));
            shown.add(&Surface::new(&object, MapLayout::new(&object, map_size)));
        }
        shown.check(&format!("random, {map_size}"));
    }
}

#[test]
fn arbitrary_triangles_are_lit_evenly() {
    let mut runner = TestRunner::deterministic();
    for (map_size, count) in [(40, 60), (120, 40), (300, 10)] {
        let mut shown = Shown::default();
        for _ in 0..count {
            let tree = any_mesh::any_mesh().new_tree(&mut runner).unwrap_or_else(|reason| panic!("{reason}"));
            let object = shapes::object(tree.current());
            let surface = Surface::new(&object, MapLayout::new(&object, map_size));
            if surface.whole_texels() > 100.0 {
                shown.add(&surface);
            }
        }
        shown.check(&format!("arbitrary, {map_size}"));
    }
}

/// Joining scraps blurs no more than it must.
#[test]
fn welds_are_small() {
    for (name, mesh, map_size) in [
        ("sphere", Mesh::sphere(Vec3::ZERO, 1.0, 5), 96),
        ("torus knot", shapes::torus_knot(300, 16), 160),
        ("teapot", shapes::teapot(), 160),
        ("scanned", shapes::scanned(90, 0.5), 160),
    ] {
        let object = shapes::object(mesh);
        let welds = Surface::new(&object, MapLayout::new(&object, map_size)).welds().welds;
        // Texels that lie between several welds count by their parts.
        let texels = |weld: &Weld| weld.sources.iter().map(|part| part.weight).sum::<f64>();
        let mut sizes: Vec<f64> = welds.iter().map(texels).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let (mean, median) = (sizes.iter().sum::<f64>() / sizes.len() as f64, sizes[sizes.len() / 2]);
        println!("{name}: {} welds, mean {mean:.2} texels, median {median:.2}, most {:?}", sizes.len(), sizes.last());
        assert!(sizes.len() > 100 && mean < 8.0 && median < 3.5, "{name}: {mean}, {median}");
    }
}

/// Where a surface goes on smoothly from one chart to another, what is shown of even light does not jump.
#[test]
fn smooth_surfaces_show_no_seams() {
    for (name, mesh, map_size) in [
        ("sphere", Mesh::sphere(Vec3::ZERO, 1.0, 5), 96),
        ("torus knot", shapes::torus_knot(300, 16), 300),
        ("teapot", shapes::teapot(), 300),
    ] {
        let object = shapes::object(mesh);
        let surface = Surface::new(&object, MapLayout::new(&object, map_size));
        let lit = surface.lit_evenly((PHOTONS * surface.whole_texels()) as u32);
        let [welded, alone] =
            [surface.welds(), Welds::default()].map(|welds| surface.jumps(&surface.shown(&lit, &welds)));
        println!("{name}: {} edges, mean squared jump {:.5}, {:.5} if texels stand alone", welded.1, welded.0, alone.0);
        assert!(welded.1 > 100 && welded.0 < 0.1 * alone.0, "{name}: {welded:?}, {alone:?}");
    }
}
