//! Where charts would take many more texels than their surface asks for, they share cells.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{
    facets::Facets,
    flattening::{Frame, MARGIN},
};

/// Texels for each texel of area that charts may take before the most wasteful share cells.
const MOST_TEXELS: f64 = 4.0;
/// Texels that are always granted.
const FREE_TEXELS: f64 = 24.0;
/// Texels of area from which on a cell, which takes four texels, is full.
const CELL_AREA: f64 = 4.0;

/// A chart: its frame and its triangles.
pub(super) type FlatChart = (Frame, Vec<u32>);

/// Keeps charts whose texels are few for their area; the others' triangles share cells of one texel's width, each with what is near
/// and faces the same of six ways. Returns the charts, and how many cells there are at their end.
pub(super) fn share_cells(
    facets: &Facets<'_>,
    frames: Vec<Frame>,
    members: Vec<Vec<u32>>,
    texel: f64,
) -> (Vec<FlatChart>, usize) {
    let areas: Vec<f64> =
        members.iter().map(|own| own.iter().map(|&t| facets.area(t)).sum::<f64>() / (texel * texel)).collect();
    let costs: Vec<f64> = frames.iter().map(|frame| frame.texels(texel).element_product()).collect();
    let shares = wasteful(&areas, &costs);
    let mut charts = Vec::new();
    let mut sharing: BTreeMap<usize, Vec<Sharer>> = BTreeMap::new();
    for (number, (frame, own)) in frames.into_iter().zip(members).enumerate() {
        if shares[number] {
            let axis = frame.u.cross(frame.v);
            let middle = frame.u * (frame.low.x + 0.5 * frame.size.x)
                + frame.v * (frame.low.y + 0.5 * frame.size.y)
                + axis * axis.dot(facets.corners(own[0])[0]);
            let sharer = Sharer { place: z_order(middle), area: areas[number], triangles: own };
            sharing.entry(way(axis)).or_default().push(sharer);
        } else {
            charts.push((frame, own));
        }
    }
    let kept = charts.len();
    for (way, mut sharers) in sharing {
        sharers.sort_by_key(|sharer| sharer.place);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let (u, v) = (axes[(way / 2 + 1) % 3], axes[(way / 2 + 2) % 3]);
        let (mut cell, mut area) = (Vec::new(), 0.0);
        let frame = |cell: &[u32]| Frame::shrunk(u, v, facets.corners_with_area(cell), (1.0 - 2.0 * MARGIN) * texel);
        for sharer in sharers {
            cell.extend(sharer.triangles);
            area += sharer.area;
            if area >= CELL_AREA {
                charts.push((frame(&cell), std::mem::take(&mut cell)));
                area = 0.0;
            }
        }
        if !cell.is_empty() {
            charts.push((frame(&cell), cell));
        }
    }
    let cells = charts.len() - kept;
    (charts, cells)
}

/// A chart that shares a cell.
struct Sharer {
    /// Along a Z-order curve.
    place: u64,
    /// Texels.
    area: f64,
    triangles: Vec<u32>,
}

/// Which charts take the most texels for their area, until the rest take few enough.
fn wasteful(areas: &[f64], costs: &[f64]) -> Vec<bool> {
    let allowed = MOST_TEXELS * areas.iter().sum::<f64>() + FREE_TEXELS;
    let mut taken: f64 = costs.iter().sum();
    let mut shares = vec![false; areas.len()];
    let mut order: Vec<usize> = (0..areas.len()).collect();
    let waste = |chart: usize| costs[chart] / areas[chart].max(f64::MIN_POSITIVE);
    order.sort_by(|&a, &b| waste(b).total_cmp(&waste(a)).then(a.cmp(&b)));
    for chart in order {
        if taken <= allowed {
            break;
        }
        shares[chart] = true;
        taken -= costs[chart] - areas[chart] * 4.0 / CELL_AREA;
    }
    shares
}

/// Which of the six ways along the axes a direction is nearest to.
fn way(direction: DVec3) -> usize {
    let axis = direction.abs().max_position();
    2 * axis + usize::from(direction[axis] < 0.0)
}

/// The place along a Z-order curve of a point with coordinates from −1 to 1.
fn z_order(point: DVec3) -> u64 {
    let cell = ((point + 1.0) * f64::from(1 << 19)).max(DVec3::ZERO).to_array().map(|x| x as u64);
    let spread = |x: u64| (0..20).map(|bit| (x >> bit & 1) << (3 * bit)).sum::<u64>();
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}
