//! Checks meshes.

use glam::{Vec3, Vec4};

use super::at::{REACH, is_in_reach};
use crate::{Chart, Mesh};

/// How far the square of a unit normal's length may be from 1.
const UNIT_TOLERANCE: f32 = 1e-3;

/// What is wrong with a mesh.
pub(super) fn check_mesh(mesh: &Mesh) -> Result<(), String> {
    let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
    let ensure = |ok: bool, problem: &dyn Fn() -> String| if ok { Ok(()) } else { Err(problem()) };
    ensure(triangles > 0, &|| "has no triangles".to_owned())?;
    ensure(u32::try_from(vertices).is_ok(), &|| format!("has {vertices} vertices; it must have fewer than 2^32"))?;
    if let Some(triangle) = mesh.triangles.iter().position(|corners| corners.iter().any(|v| *v as usize >= vertices)) {
        let corners = mesh.triangles[triangle];
        return Err(format!("has the triangle {triangle} of vertices {corners:?}, but {vertices} vertices, from 0"));
    }
    if let Some(position) = mesh.positions.iter().find(|position| !is_in_reach(**position)) {
        return Err(format!("has the position {:?}; {REACH}", position.to_array()));
    }
    let counts = [
        ("normals", mesh.normals.len()),
        ("texture coordinates", mesh.uvs.len()),
        ("texture coordinates for its map", mesh.map_uvs.len()),
        ("colours", mesh.colors.len()),
        ("opacities", mesh.opacities.len()),
        ("tangents", mesh.tangents.len()),
    ];
    for (what, count) in counts {
        ensure(count == 0 || count == vertices, &|| format!("has {count} {what}; it must have {vertices} or none"))?;
    }
    let is_unit = |normal: &Vec3| (normal.length_squared() - 1.0).abs() <= UNIT_TOLERANCE;
    ensure(mesh.normals.iter().all(is_unit), &|| "has a normal whose length is not 1".to_owned())?;
    let has_finite_uvs = mesh.uvs.iter().chain(&mesh.map_uvs).all(|uv| uv.is_finite());
    ensure(has_finite_uvs, &|| "has a texture coordinate that is not finite".to_owned())?;
    let is_share = |color: &Vec3| color.to_array().iter().all(|channel| (0.0..=1.0).contains(channel));
    if let Some(color) = mesh.colors.iter().find(|color| !is_share(color)) {
        return Err(format!("has the vertex colour {color}; each channel must be from 0 to 1"));
    }
    if let Some(opacity) = mesh.opacities.iter().find(|opacity| !(0.0..=1.0).contains(*opacity)) {
        return Err(format!("has the vertex opacity {opacity}; it must be from 0 to 1"));
    }
    if let Some(tangent) = mesh.tangents.iter().find(|tangent| !is_tangent(tangent)) {
        return Err(format!(
            "has the tangent {tangent}; its length must be 1 and its fourth number 1 or -1, or all must be 0"
        ));
    }
    if let Chart::Natural(places) = &mesh.chart {
        let are_sound = places.len() == vertices && places.iter().all(|place| place.is_finite());
        ensure(are_sound, &|| {
            format!("has a natural chart of {} places; it must have {vertices}, all of them finite", places.len())
        })?;
    }
    let has_map = mesh.chart != Chart::Uvs || !mesh.map_places().is_empty();
    ensure(has_map, &|| "has no texture coordinates, which are to be its map; leave out map_uvs".to_owned())?;
    check_triangle_slots(mesh)?;
    ensure(mesh.degenerate_triangles() < triangles, &|| format!("has {triangles} triangles, all of zero area"))
}

/// Whether a tangent is of unit length and has a side, or is none.
fn is_tangent(tangent: &Vec4) -> bool {
    let is_unit = (tangent.truncate().length_squared() - 1.0).abs() <= UNIT_TOLERANCE && tangent.w.abs() == 1.0;
    is_unit || *tangent == Vec4::ZERO
}

/// What is wrong with the material slots of a mesh.
fn check_triangle_slots(mesh: &Mesh) -> Result<(), String> {
    let (count, triangles, slots) = (mesh.triangle_slots.len(), mesh.triangles.len(), mesh.material_slots.len());
    if count != triangles && (slots > 1 || count > 0) {
        return Err(format!("has {count} triangle slots; it must have {triangles}, one for each triangle"));
    }
    match mesh.triangle_slots.iter().find(|slot| **slot as usize >= slots.max(1)) {
        Some(slot) => Err(format!("has a triangle of material slot {slot}, but {} slots, from 0", slots.max(1))),
        None => Ok(()),
    }
}
