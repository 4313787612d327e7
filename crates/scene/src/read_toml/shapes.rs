//! Reads the shapes that objects can have without a file.

use super::table::Table;
use crate::{Error, Mesh, primitives::are_perpendicular};

/// Subdivisions of a sphere that names none: 16128 triangles.
const SPHERE_SUBDIVISIONS: u32 = 6;

/// The mesh of a `sphere`.
pub(super) fn read_sphere(table: &Table<'_>) -> Result<Mesh, Error> {
    table.allow_only(&["center", "radius", "subdivisions"])?;
    let center = table.require("center", "3 numbers [x, y, z], metres")?.vector()?;
    let radius_entry = table.require("radius", "a number, metres")?;
    let radius = radius_entry.number()?;
    if radius <= 0.0 {
        return Err(radius_entry.error(format!("is {radius}; it must be greater than 0 (metres)")));
    }
    let mut subdivisions = SPHERE_SUBDIVISIONS;
    if let Some(entry) = table.get("subdivisions") {
        subdivisions = entry.whole32()?;
        let most = Mesh::MAX_SPHERE_SUBDIVISIONS;
        if !(1..=most).contains(&subdivisions) {
            return Err(entry.error(format!("is {subdivisions}; it must be from 1 to {most}")));
        }
    }
    Ok(Mesh::sphere(center, radius, subdivisions))
}

/// The mesh of a `rectangle`.
pub(super) fn read_rectangle(table: &Table<'_>) -> Result<Mesh, Error> {
    table.allow_only(&["center", "edge_u", "edge_v"])?;
    let vector = |key| table.require(key, "3 numbers [x, y, z], metres")?.vector();
    let (center, edge_u, edge_v) = (vector("center")?, vector("edge_u")?, vector("edge_v")?);
    if edge_u.length() == 0.0 || edge_v.length() == 0.0 {
        return Err(table.error("edge_u and edge_v must not have length 0"));
    }
    if !are_perpendicular(edge_u, edge_v) {
        return Err(table.error("edge_u and edge_v must be perpendicular; for another shape, use an OBJ mesh"));
    }
    Ok(Mesh::rectangle(center, edge_u, edge_v))
}

/// The mesh of a `box`.
pub(super) fn read_box(table: &Table<'_>) -> Result<Mesh, Error> {
    table.allow_only(&["min", "max"])?;
    let vector = |key| table.require(key, "3 numbers [x, y, z], metres")?.vector();
    let (min, max) = (vector("min")?, vector("max")?);
    if !min.cmplt(max).all() {
        return Err(table.error(format!("min {min} must be less than max {max} along each axis")));
    }
    Ok(Mesh::cuboid(min, max))
}
