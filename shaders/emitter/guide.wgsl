// The guide moves emission numbers to where a pilot found that photons matter; docs/photon-paths.md, "Guide".

import package::layout::photon_pass::{guide, photon_params};
import package::layout::records::record_texel;

/// The largest f32 below 1.
const BELOW_ONE: f32 = 0.99999994;

/// A number in [0, 1) that has moved.
struct Moved {
    /// The interval that it moved into.
    interval: u32,
    /// The number there, in [0, 1).
    number: f32,
    /// Density there; 1 on average.
    density: f32,
}

/// Lower and upper end of the part of [0, 1) that moves into an interval, as bits; where the search for numbers of this interval begins.
fn load_entry(entry: u32) -> vec3<u32> {
    return textureLoad(guide, record_texel(entry), 0).xyz;
}

/// Moves `u` by the `count` entries from `first` on, each of which leads into one of equally wide intervals.
fn move_number(first: u32, count: u32, u: f32) -> Moved {
    // Search from a cut point (Chen and Asau 1974): few steps, where halving always takes log₂ of the count.
    var interval = load_entry(first + min(u32(u * f32(count)), count - 1u)).z;
    var bounds = bitcast<vec2<f32>>(load_entry(first + interval).xy);
    while bounds.y <= u {
        interval += 1u;
        bounds = bitcast<vec2<f32>>(load_entry(first + interval).xy);
    }
    let share = bounds.y - bounds.x;
    let number = (f32(interval) + (u - bounds.x) / share) / f32(count);
    return Moved(interval, min(number, BELOW_ONE), share * f32(count));
}

/// A point of the unit square that has moved.
struct MovedPoint {
    /// Index of the cell that it moved into, column by column.
    cell: u32,
    /// The point there.
    point: vec2<f32>,
    /// Density there; 1 on average.
    density: f32,
}

/// Moves `u` by the table that begins at entry `first`: the columns, then the rows of each column.
fn move_point(first: u32, columns: u32, rows: u32, u: vec2<f32>) -> MovedPoint {
    let x = move_number(first, columns, u.x);
    let y = move_number(first + columns + x.interval * rows, rows, u.y);
    return MovedPoint(x.interval * rows + y.interval, vec2<f32>(x.number, y.number), x.density * y.density);
}

/// Share of [0, 1), times `count`, that moves into the interval of the `count` entries from `first` on.
fn interval_density(first: u32, count: u32, interval: u32) -> f32 {
    let bounds = bitcast<vec2<f32>>(load_entry(first + interval).xy);
    return (bounds.y - bounds.x) * f32(count);
}

/// The density of the first two emission numbers where `u` stands after the move; 1 on average.
fn aim_density(u: vec2<f32>) -> f32 {
    let columns = photon_params.guide_columns;
    let rows = photon_params.guide_rows;
    let column = min(u32(u.x * f32(columns)), columns - 1u);
    let row = min(u32(u.y * f32(rows)), rows - 1u);
    return interval_density(0u, columns, column) * interval_density(columns + column * rows, rows, row);
}

/// Emission numbers that have moved.
struct GuidedNumbers {
    numbers: vec4<f32>,
    /// Density of the first two; 1 on average.
    aim_density: f32,
    /// Density of the next two; 1 on average.
    place_density: f32,
    /// Cells of the first and of the second table.
    cells: vec2<u32>,
}

fn guide_numbers(u: vec4<f32>) -> GuidedNumbers {
    let columns = photon_params.guide_columns;
    let rows = photon_params.guide_rows;
    let side = photon_params.guide_side;
    let aim = move_point(0u, columns, rows, u.xy);
    let place = move_point(columns * (rows + 1u), side, side, u.zw);
    return GuidedNumbers(vec4<f32>(aim.point, place.point), aim.density, place.density, vec2<u32>(aim.cell, place.cell));
}
