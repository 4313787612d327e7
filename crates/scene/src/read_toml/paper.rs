//! Reads the profile `paper`.

use glam::Vec3;

use super::table::Table;
use crate::{Error, PaperMapSize, PaperProfile, PaperRefraction, PaperSampling};

/// The energy of the paper's second table.
const ENERGY: f32 = 35.0;
/// The larger map size of its fourth.
const MAP_SIZE: f32 = 10.0;
const TRANSPARENCY: f32 = 0.9;

/// Whether `[render]` asks for the paper's model of light.
pub(super) fn is_paper(render: &Table<'_>) -> Result<bool, Error> {
    let profiles = [("physical", false), ("paper", true)];
    render.get("profile").map_or(Ok(false), |entry| entry.choice("profile", &profiles))
}

/// Reads `[paper]`, which may be missing.
pub(super) fn read_paper(table: Option<&Table<'_>>) -> Result<PaperProfile, Error> {
    let mut profile = PaperProfile {
        energy: Vec3::splat(ENERGY),
        refraction: PaperRefraction::default(),
        sampling: PaperSampling::default(),
        pole: Vec3::Z,
        map_size: PaperMapSize::Millimetres(MAP_SIZE),
        transparency: TRANSPARENCY,
    };
    let Some(table) = table else { return Ok(profile) };
    table.allow_only(&["energy", "refraction", "sampling", "pole", "map_size", "map_size_in", "transparency"])?;
    let refractions = [("printed", PaperRefraction::Printed), ("exact", PaperRefraction::Exact)];
    let samplings = [("grid", PaperSampling::Grid), ("random", PaperSampling::Random)];
    profile.energy = table.get("energy").map_or(Ok(profile.energy), |entry| entry.color())?;
    profile.refraction =
        table.get("refraction").map_or(Ok(profile.refraction), |entry| entry.choice("refraction", &refractions))?;
    profile.sampling =
        table.get("sampling").map_or(Ok(profile.sampling), |entry| entry.choice("sampling", &samplings))?;
    profile.pole = table.get("pole").map_or(Ok(profile.pole), |entry| entry.vector())?;
    profile.map_size = read_map_size(table)?;
    profile.transparency = table.get("transparency").map_or(Ok(profile.transparency), |entry| entry.number())?;
    Ok(profile)
}

fn read_map_size(table: &Table<'_>) -> Result<PaperMapSize, Error> {
    let units = [("millimetres", false), ("texels", true)];
    let in_texels = table.get("map_size_in").map_or(Ok(false), |entry| entry.choice("unit", &units))?;
    let size = table.get("map_size");
    if in_texels {
        return Ok(PaperMapSize::Texels(size.map_or(Ok(MAP_SIZE as u32), |entry| entry.whole32())?));
    }
    Ok(PaperMapSize::Millimetres(size.map_or(Ok(MAP_SIZE), |entry| entry.number())?))
}
