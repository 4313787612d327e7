//! The 2016 paper's equations beside what is exact; docs/paper.md.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::{
    ClosedForm, MeasuredRefraction,
    plot::{Chart, Curve},
};

/// Indices of refraction of the paper's first table.
pub(crate) const INDICES: [f64; 3] = [1.3, 1.9, 2.4];
/// Points of a curve.
const POINTS: u32 = 180;

/// Points of a function over an interval.
fn curve(name: String, color: usize, dashed: bool, [from, to]: [f64; 2], f: impl Fn(f64) -> f64) -> Curve {
    let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(POINTS);
    let points = (0..=POINTS).map(|k| [at(k), f(at(k))]).collect();
    Curve { name, color, dashed, points, ..Curve::default() }
}

/// The angle of refraction by equation 3, radians, n the index of the incident side over that of the other.
pub(crate) fn refracted_by_equation_3(theta_i: f64, n: f64) -> f64 {
    (n * theta_i.tan()).atan()
}

/// The angle of refraction by Snell's law, radians, for the same n; below the critical angle.
pub(crate) fn refracted_by_snell(theta_i: f64, n: f64) -> f64 {
    (n * theta_i.sin()).asin()
}

/// A texel's weight by equation 2 for a ray at (f, g) of its cell, itself at (0, 0).
pub(crate) fn weight_by_equation_2(f: f64, g: f64) -> f64 {
    let distances = [f.hypot(g), (1.0 - f).hypot(g), f.hypot(1.0 - g), (1.0 - f).hypot(1.0 - g)];
    let sum: f64 = distances.iter().sum();
    (sum - distances[0]) / (3.0 * sum)
}

/// The density of equation 1's directions at angle φ off the equator, 1/sr.
pub(crate) fn density_by_equation_1(phi: f64) -> f64 {
    1.0 / (2.0 * PI * PI * phi.cos())
}

impl ClosedForm {
    /// A sentence about the plot.
    pub(crate) fn caption(self) -> &'static str {
        match self {
            Self::Directions => {
                "Even steps of θ and φ crowd the rays at the poles: the density is 1/(2π² cos φ) and has no bound, where even light has 1/(4π). A lamp by \
                 equation 1 is brighter along its axis than around its equator, where it has 0.64 of an even lamp's rays."
            }
            Self::Weights => {
                "The ray's place goes from a texel (0) to its neighbour (1). By equation 2 a texel never has more than a third of a ray and never less than a \
                 fifth, so that every ray is a spot two texels wide; bilinear weights go from 1 to 0."
            }
            Self::Refraction => {
                "Into glass (n < 1 in equation 3), and dashed by Snell's law. Both agree to first order; at grazing incidence equation 3 bends to 90°, where Snell's law \
                 stops at the critical angle: light through the printed equation is turned too little, and is never reflected back inside."
            }
        }
    }

    pub(crate) fn id(self) -> &'static str {
        match self {
            Self::Directions => "equation-1",
            Self::Weights => "equation-2",
            Self::Refraction => "equation-3",
        }
    }

    /// The plot; for refraction with the angles that were measured.
    pub(crate) fn chart(self, measured: &[MeasuredRefraction]) -> Chart {
        let named = |title: &str, x_label: &str, y_label: &str, curves| Chart {
            title: title.to_owned(),
            x_label: x_label.to_owned(),
            y_label: y_label.to_owned(),
            curves,
            ..Chart::default()
        };
        match self {
            Self::Directions => named(
                "Equation 1: density of rays over angle",
                "φ, degrees off the equator",
                "rays per steradian, share of all",
                vec![
                    curve("equation 1".to_owned(), 1, false, [-85.0, 85.0], |phi| {
                        density_by_equation_1(phi.to_radians())
                    }),
                    curve("even over the sphere".to_owned(), 0, true, [-85.0, 85.0], |_| 1.0 / (4.0 * PI)),
                ],
            ),
            Self::Weights => named(
                "Equation 2: a texel's share of a ray",
                "place of the ray, texels from the texel",
                "share",
                vec![
                    curve("equation 2, along a row".to_owned(), 1, false, [0.0, 1.0], |f| weight_by_equation_2(f, 0.0)),
                    curve("bilinear, along a row".to_owned(), 0, true, [0.0, 1.0], |f| 1.0 - f),
                    curve("equation 2, along the diagonal".to_owned(), 4, false, [0.0, 1.0], |f| {
                        weight_by_equation_2(f, f)
                    }),
                    curve("bilinear, along the diagonal".to_owned(), 5, true, [0.0, 1.0], |f| (1.0 - f).powi(2)),
                ],
            ),
            Self::Refraction => named(
                "Equation 3: refraction over angle",
                "angle of incidence, degrees",
                "angle of refraction, degrees",
                refractions(measured),
            ),
        }
    }
}

/// How far the rays that were measured are off their curves, degrees, at most.
fn farthest(measured: &[MeasuredRefraction]) -> f64 {
    let off = |points: &[[f64; 2]], law: fn(f64, f64) -> f64, ior: f64| {
        let of_ray = |[theta_i, theta_t]: &[f64; 2]| {
            let off = (theta_t - law(theta_i.to_radians(), 1.0 / ior).to_degrees()).abs();
            // A ray that met no wall is as far off as can be.
            if off.is_nan() { f64::INFINITY } else { off }
        };
        points.iter().map(of_ray).fold(0.0, f64::max)
    };
    let of_index = |MeasuredRefraction { ior, printed, exact }: &MeasuredRefraction| {
        off(printed, refracted_by_equation_3, *ior).max(off(exact, refracted_by_snell, *ior))
    };
    measured.iter().map(of_index).fold(0.0, f64::max)
}

/// What was measured of refraction, as a sentence; empty if nothing was.
pub(crate) fn about_rays(measured: &[MeasuredRefraction]) -> String {
    if measured.is_empty() {
        return String::new();
    }
    let rays: usize = measured.iter().map(|of_index| of_index.printed.len() + of_index.exact.len()).sum();
    format!(
        "The points are {rays} rays that the kernels have sent through slabs of glass, by the one law and by the other: {:.2}° off their curves at most.",
        farthest(measured)
    )
}

/// The two angles of refraction into each index, and what was measured of both.
fn refractions(measured: &[MeasuredRefraction]) -> Vec<Curve> {
    let end = FRAC_PI_2.to_degrees() - 0.5;
    let curves = INDICES.iter().enumerate().flat_map(|(color, &ior)| {
        [
            curve(format!("equation 3, into {ior}"), color, false, [0.0, end], move |degrees| {
                refracted_by_equation_3(degrees.to_radians(), 1.0 / ior).to_degrees()
            }),
            curve(format!("Snell, into {ior}"), color, true, [0.0, end], move |degrees| {
                refracted_by_snell(degrees.to_radians(), 1.0 / ior).to_degrees()
            }),
        ]
    });
    let points = measured.iter().flat_map(|of_index| of_index.printed.iter().chain(&of_index.exact)).copied();
    let rays = Curve { name: "rays of the kernel".to_owned(), points: points.collect(), color: 6, ..Curve::default() };
    let rays = (!measured.is_empty()).then_some(Curve { marked: true, unconnected: true, ..rays });
    curves.chain(rays).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_have_their_ends() {
        for (f, g) in [(0.0, 0.0), (0.3, 0.8), (0.5, 0.5)] {
            let corners = [(f, g), (1.0 - f, g), (f, 1.0 - g), (1.0 - f, 1.0 - g)];
            let sum: f64 = corners.into_iter().map(|(f, g)| weight_by_equation_2(f, g)).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
        assert!((weight_by_equation_2(0.0, 0.0) - 1.0 / 3.0).abs() < 1e-12);
        assert!((weight_by_equation_2(0.5, 0.5) - 0.25).abs() < 1e-12);
        assert!((weight_by_equation_2(1.0, 1.0) - 0.1953).abs() < 1e-4);
    }

    #[test]
    fn directions_sum_to_one() {
        let steps = 1000;
        let phi = |k: i32| (f64::from(k) + 0.5) / f64::from(steps) * PI - FRAC_PI_2;
        let sum: f64 =
            (0..steps).map(|k| density_by_equation_1(phi(k)) * 2.0 * PI * phi(k).cos() * PI / f64::from(steps)).sum();
        assert!((sum - 1.0).abs() < 1e-9);
    }

    #[test]
    fn equation_3_is_snells_law_to_first_order_only() {
        let n = 1.0 / 1.5;
        assert!((refracted_by_equation_3(0.01, n) - refracted_by_snell(0.01, n)).abs() < 1e-6);
        assert!(refracted_by_equation_3(1.2, n) > refracted_by_snell(1.2, n) + 0.2);
    }
}
