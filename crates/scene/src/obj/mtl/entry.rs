//! What an MTL file says, line by line.

use std::{io::BufRead, ops::RangeInclusive, path::Path};

use glam::Vec3;

use super::{
    super::lines::Lines,
    maps::{Map, read_map},
};
use crate::Error;

/// The most materials of a library.
const MOST_ENTRIES: usize = 1 << 20;

/// What an MTL file says about one material.
#[derive(Default)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) ambient: Option<Vec3>,
    pub(super) diffuse: Option<Vec3>,
    pub(super) specular: Option<Vec3>,
    pub(super) transmission: Option<Vec3>,
    /// Radiance, W/(m² sr).
    pub(super) emission: Option<Vec3>,
    pub(super) shininess: Option<f32>,
    pub(super) ior: Option<f32>,
    /// 1 for an opaque material.
    pub(super) dissolve: Option<f32>,
    /// 0 for an opaque material.
    pub(super) transparency: Option<f32>,
    pub(super) illumination_model: Option<f32>,
    /// `Pr`, `Pm`, `Pc` and `Pcr`: roughness, share of metal, strength and roughness of a clear coat.
    pub(super) roughness: Option<f32>,
    pub(super) metallic: Option<f32>,
    pub(super) coat: Option<f32>,
    pub(super) coat_roughness: Option<f32>,
    pub(super) maps: Maps,
}

/// The pictures of a material, of those that are read.
#[derive(Default)]
pub(super) struct Maps {
    pub(super) diffuse: Option<Map>,
    pub(super) emission: Option<Map>,
    pub(super) dissolve: Option<Map>,
    pub(super) roughness: Option<Map>,
    pub(super) metallic: Option<Map>,
    pub(super) normal: Option<Map>,
    /// The keywords of the others.
    pub(super) ignored: Vec<String>,
}

impl Entry {
    fn read_line(&mut self, keyword: &str, words: &[&str], rest: &str) -> Result<(), String> {
        let share = 0.0..=1.0;
        match keyword {
            "Ka" => self.ambient = Some(color(keyword, words, share)?),
            "Kd" => self.diffuse = Some(color(keyword, words, share)?),
            "Ks" => self.specular = Some(color(keyword, words, share)?),
            "Tf" => self.transmission = Some(color(keyword, words, share)?),
            "Ke" => self.emission = Some(color(keyword, words, 0.0..=f32::MAX)?),
            "Ns" => self.shininess = Some(number(keyword, words, 0.0..=f32::MAX)?),
            "Ni" => self.ior = Some(number(keyword, words, f32::MIN_POSITIVE..=f32::MAX)?),
            "d" => self.dissolve = Some(number(keyword, words.strip_prefix(&["-halo"]).unwrap_or(words), share)?),
            "Tr" => self.transparency = Some(number(keyword, words, share)?),
            "illum" => self.illumination_model = Some(number(keyword, words, 0.0..=f32::MAX)?),
            "Pr" => self.roughness = Some(number(keyword, words, share)?),
            "Pm" => self.metallic = Some(number(keyword, words, share)?),
            "Pc" => self.coat = Some(number(keyword, words, share)?),
            "Pcr" => self.coat_roughness = Some(number(keyword, words, share)?),
            _ => self.read_map_line(keyword, rest)?,
        }
        Ok(())
    }

    fn read_map_line(&mut self, keyword: &str, rest: &str) -> Result<(), String> {
        let lower = keyword.to_lowercase();
        let map = match lower.as_str() {
            "map_kd" => &mut self.maps.diffuse,
            "map_ke" => &mut self.maps.emission,
            "map_d" => &mut self.maps.dissolve,
            "map_pr" => &mut self.maps.roughness,
            "map_pm" => &mut self.maps.metallic,
            "norm" | "map_kn" | "map_norm" => &mut self.maps.normal,
            // A switch without a picture.
            "map_aat" => return Ok(()),
            _ if lower.starts_with("map_") || ["bump", "disp", "decal", "refl"].contains(&lower.as_str()) => {
                self.maps.ignored.push(keyword.to_owned());
                return Ok(());
            }
            _ => return Ok(()),
        };
        *map = Some(read_map(keyword, rest)?);
        Ok(())
    }
}

/// The materials of a library.
///
/// # Errors
/// If it cannot be read or a line makes no sense.
pub(super) fn read_entries(mut lines: Lines<impl BufRead>, path: &Path) -> Result<Vec<Entry>, Error> {
    let mut entries: Vec<Entry> = Vec::new();
    while let Some((number, line)) = lines.next()? {
        let error = |problem| Error::Obj { path: path.to_owned(), line: Some(number), problem };
        let line = line.split(" #").next().unwrap_or_default();
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else { continue };
        let rest = line.trim_start()[keyword.len()..].trim();
        if keyword == "newmtl" {
            if rest.is_empty() {
                return Err(error("newmtl without a name".to_owned()));
            }
            if entries.len() == MOST_ENTRIES {
                return Err(error(format!("newmtl after {MOST_ENTRIES} materials, the most that are read")));
            }
            entries.push(Entry { name: rest.to_owned(), ..Entry::default() });
        } else if let Some(entry) = entries.last_mut() {
            entry.read_line(keyword, &words.collect::<Vec<_>>(), rest).map_err(error)?;
        }
    }
    Ok(entries)
}

/// Three channels, or one number that stands for all three.
fn color(keyword: &str, words: &[&str], allowed: RangeInclusive<f32>) -> Result<Vec3, String> {
    let mut channels = Vec::new();
    for word in words.iter().take(3) {
        channels.push(number(keyword, &[word], allowed.clone())?);
    }
    match channels[..] {
        [gray] => Ok(Vec3::splat(gray)),
        [r, g, b] => Ok(Vec3::new(r, g, b)),
        _ => Err(format!("{keyword} with {} numbers; it takes r g b", channels.len())),
    }
}

pub(super) fn number(keyword: &str, words: &[&str], allowed: RangeInclusive<f32>) -> Result<f32, String> {
    let Some(word) = words.first() else { return Err(format!("{keyword} without a number")) };
    let number: f32 = word.parse().map_err(|_| format!("{keyword} with {word:?}, which is not a number"))?;
    if allowed.contains(&number) {
        return Ok(number);
    }
    let range = match (*allowed.start(), *allowed.end()) {
        (f32::MIN, f32::MAX) => "finite".to_owned(),
        (start, f32::MAX) if start > 0.0 => "greater than 0 and finite".to_owned(),
        (start, f32::MAX) => format!("{start} or greater and finite"),
        (start, end) => format!("from {start} to {end}"),
    };
    Err(format!("{keyword} with {number}; it must be {range}"))
}
