// Flux over the footprint of the part of the emission that a photon stands for; docs/photon-paths.md, "Footprints".

import package::deposit::sums::add_to_texel;
import package::film::texels::TilePlace;

/// The most texels from the middle of a footprint to its end, along an axis.
const LARGEST_REACH: f32 = 12.0;
/// Cells along a tile that is large enough for footprints.
const LEAST_CELLS: f32 = 4.0;

/// An elliptic kernel on a tile of a map, texels.
struct Ellipse {
    middle: vec2<f32>,
    /// Unit axis.
    axis: vec2<f32>,
    /// Inverse squared radii along the axis and across it.
    inverse: vec2<f32>,
}

/// Two conjugate deviations of a photon's footprint, on the map's plane.
struct PlaneAxes {
    first: vec2<f32>,
    second: vec2<f32>,
}

/// Epanechnikov's kernel, not normalised.
fn kernel_weight(ellipse: Ellipse, place: vec2<f32>) -> f32 {
    let v = place - ellipse.middle;
    let w = vec2<f32>(dot(v, ellipse.axis), v.x * ellipse.axis.y - v.y * ellipse.axis.x);
    return max(1.0 - dot(w * w, ellipse.inverse), 0.0);
}

/// A texel's share of the kernel, not normalised: what would fall beyond the tile's nearest borders is folded back, and texels on a border
/// stand for half a cell. So even light stays even up to the border.
fn folded_weight(ellipse: Ellipse, texel: vec2<u32>, cells: vec2<f32>) -> f32 {
    let place = vec2<f32>(texel);
    let image = select(2.0 * cells - place, -place, ellipse.middle < 0.5 * cells);
    let cover = select(vec2<f32>(1.0), vec2<f32>(0.5), (place == vec2<f32>(0.0)) | (place == cells));
    let whole = kernel_weight(ellipse, place) + kernel_weight(ellipse, vec2<f32>(image.x, place.y))
        + kernel_weight(ellipse, vec2<f32>(place.x, image.y)) + kernel_weight(ellipse, image);
    return whole * cover.x * cover.y;
}

/// Lays units of flux over the ellipse around a place whose axes' deviations along the map's plane are `axes`, as far as it lies on the tile;
/// returns false if it is too small.
fn add_ellipse(place: TilePlace, axes: PlaneAxes, units: vec3<i32>) -> bool {
    let cells = vec2<f32>(place.cells);
    let p = place.scale * axes.first;
    let q = place.scale * axes.second;
    // Covariance, texels².
    let xx = p.x * p.x + q.x * q.x + 1.0 / 12.0;
    let xy = p.x * p.y + q.x * q.y;
    let yy = p.y * p.y + q.y * q.y + 1.0 / 12.0;
    let larger = max(xx, yy);
    if !(larger < 1e12) || larger < 0.25 || min(cells.x, cells.y) < LEAST_CELLS {
        return false;
    }
    // An Epanechnikov kernel over an ellipse has a sixth of its squared radius as variance. Larger ellipses shrink to the largest reach,
    // which is half a tile at most, so that no more than one border along each axis is near.
    let mean = 0.5 * (xx + yy);
    let half_difference = sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    let lambda = vec2<f32>(mean + half_difference, max(mean - half_difference, 1.0 / 12.0));
    let largest = min(LARGEST_REACH, 0.5 * min(cells.x, cells.y));
    let squares = 6.0 * min(lambda, vec2<f32>(largest * largest / 6.0));
    var axis = vec2<f32>(lambda.x - yy, xy);
    if dot(axis, axis) < 1e-8 * lambda.x * lambda.x {
        axis = select(vec2<f32>(0.0, 1.0), vec2<f32>(1.0, 0.0), xx >= yy);
    }
    axis = normalize(axis);
    let at = place.at;
    let ellipse = Ellipse(at, axis, 1.0 / squares);
    let reach = sqrt(vec2<f32>(
        squares.x * axis.x * axis.x + squares.y * axis.y * axis.y, squares.x * axis.y * axis.y + squares.y * axis.x * axis.x,
    ));
    let low = vec2<u32>(clamp(ceil(at - reach), vec2<f32>(0.0), cells));
    let high = vec2<u32>(max(clamp(floor(at + reach), vec2<f32>(0.0), cells), vec2<f32>(low)));
    let width = high.x - low.x + 1u;
    let texels = width * (high.y - low.y + 1u);
    var sum = 0.0;
    // Step by step, for software adapters divide integers lane by lane.
    var texel = low;
    for (var k = 0u; k < texels; k++) {
        sum += folded_weight(ellipse, texel, cells);
        let ends_row = texel.x == high.x;
        texel = vec2<u32>(select(texel.x + 1u, low.x, ends_row), texel.y + select(0u, 1u, ends_row));
    }
    if sum < 1e-6 {
        return false;
    }
    var before = vec3<i32>(0);
    var running = 0.0;
    texel = low;
    for (var k = 0u; k < texels; k++) {
        running += folded_weight(ellipse, texel, cells);
        var after = vec3<i32>(round(vec3<f32>(units) * (running / sum)));
        if k + 1u == texels {
            after = units;
        }
        add_to_texel(place.first_texel + texel.y * (place.cells.x + 1u) + texel.x, after - before);
        before = after;
        let ends_row = texel.x == high.x;
        texel = vec2<u32>(select(texel.x + 1u, low.x, ends_row), texel.y + select(0u, 1u, ends_row));
    }
    return true;
}
