//! The statements of an OBJ file, checked line by line; polygons are cut into triangles as they come.

use std::{collections::HashMap, str::SplitWhitespace};

use glam::{Vec2, Vec3};

use crate::polygons::PolygonCutter;

/// The most triangles of a file, as of glTF files.
const MOST_TRIANGLES: usize = 1 << 27;
/// The most materials that faces use.
const MOST_MATERIALS: usize = 1 << 14;
/// The most corners of a face: cutting takes time with the square of their number.
const MOST_CORNERS: usize = 4096;

/// Stands for the index of what a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// Indices, from 0, of a corner's position, texture coordinates and normal; the last two or [`NONE`].
pub(super) type Corner = [u32; 3];

/// What an OBJ file says of its surface.
#[derive(Default)]
pub(super) struct Statements {
    pub(super) positions: Vec<Vec3>,
    pub(super) texcoords: Vec<Vec2>,
    /// Not of unit length; zero where unusable.
    pub(super) normals: Vec<Vec3>,
    /// Those of each triangle.
    pub(super) corners: Vec<[Corner; 3]>,
    /// The slot of each triangle.
    pub(super) slots: Vec<u32>,
    /// The smoothing group of each triangle, 0 for none; empty where the file names none.
    pub(super) smoothing: Vec<u32>,
    /// Names of the materials that faces use, in the order of first use; "" before the first `usemtl`.
    pub(super) slot_names: Vec<String>,
    /// The file names after `mtllib`.
    pub(super) libraries: Vec<String>,
    /// Corners of faces, and how many of them have no texture coordinates.
    pub(super) face_corners: usize,
    pub(super) without_texcoord: usize,
    /// Faces of fewer than three corners.
    pub(super) skipped_faces: usize,
    slot_numbers: HashMap<String, u32>,
    /// The name after the last `usemtl`, and its slot once a face has used it.
    material: String,
    slot: Option<u32>,
    /// The group after the last `s`, if there was one.
    group: Option<u32>,
    polygon: Vec<Corner>,
    cutter: PolygonCutter,
}

impl Statements {
    /// Reads a line.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn read_line(&mut self, line: &str) -> Result<(), String> {
        let Some(keyword) = line.split_whitespace().next() else { return Ok(()) };
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        words.next();
        let rest = || line.trim_start()[keyword.len()..].trim().to_owned();
        match keyword {
            "v" => self.position(words),
            "vt" => self.texcoord(words),
            "vn" => self.normal(words),
            "f" => self.face(words),
            "s" => self.smoothing_group(words),
            "usemtl" if rest().is_empty() => Err("usemtl without the name of a material".to_owned()),
            "usemtl" => {
                self.material = rest();
                self.slot = None;
                Ok(())
            }
            "mtllib" => {
                self.libraries.push(rest());
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn position(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let numbers = finite_numbers("v", words)?;
        let position = match numbers.as_slice() {
            [x, y, z] => Vec3::new(*x, *y, *z),
            [x, y, z, w] => {
                let divided = Vec3::new(*x, *y, *z) / *w;
                if !divided.is_finite() {
                    return Err(format!("v with the weight {w}; it must not be 0"));
                }
                divided
            }
            [x, y, z, ..] => Vec3::new(*x, *y, *z),
            few => return Err(format!("v with {} numbers; a vertex takes x y z", few.len())),
        };
        self.positions.push(position);
        Ok(())
    }

    fn texcoord(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let numbers = finite_numbers("vt", words)?;
        let Some(&u) = numbers.first() else { return Err("vt without numbers; it takes u and v".to_owned()) };
        self.texcoords.push(Vec2::new(u, numbers.get(1).copied().unwrap_or(0.0)));
        Ok(())
    }

    fn normal(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let numbers = numbers("vn", words)?;
        let [x, y, z, ..] = numbers[..] else {
            return Err(format!("vn with {} numbers; a normal takes x y z", numbers.len()));
        };
        let normal = Vec3::new(x, y, z);
        let scaled = normal / normal.abs().max_element();
        self.normals.push(if scaled.is_finite() { scaled } else { Vec3::ZERO });
        Ok(())
    }

    /// `s 3` begins a group, `s off` and `s 0` end it.
    fn smoothing_group(&mut self, mut words: SplitWhitespace<'_>) -> Result<(), String> {
        let word = words.next().unwrap_or("off");
        let number = if matches!(word, "off" | "null") { Some(0) } else { word.parse().ok() };
        self.group = Some(number.ok_or_else(|| format!("s with {word:?}; it takes a whole number or off"))?);
        Ok(())
    }

    /// A face: a line of corners.
    fn face(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        self.polygon.clear();
        for word in words {
            let corner = self.corner(word)?;
            self.polygon.push(corner);
        }
        let count = self.polygon.len();
        if count < 3 {
            self.skipped_faces += 1;
            return Ok(());
        }
        if count > MOST_CORNERS {
            return Err(format!("f with {count} corners; a face has at most {MOST_CORNERS}"));
        }
        if self.corners.len() + count > MOST_TRIANGLES {
            return Err(format!("f brings the file to more than {MOST_TRIANGLES} triangles, the most that are read"));
        }
        self.face_corners += count;
        self.without_texcoord += self.polygon.iter().filter(|corner| corner[1] == NONE).count();
        let slot = self.current_slot()?;
        let triangles = if count == 3 { vec![[0, 1, 2]] } else { self.cut() };
        for triangle in triangles {
            self.corners.push(triangle.map(|corner: u32| self.polygon[corner as usize]));
            self.slots.push(slot);
            if self.group.is_some() || !self.smoothing.is_empty() {
                self.smoothing.resize(self.corners.len() - 1, 0);
                self.smoothing.push(self.group.unwrap_or(0));
            }
        }
        Ok(())
    }

    fn cut(&mut self) -> Vec<[u32; 3]> {
        let places: Vec<_> = self.polygon.iter().map(|corner| self.positions[corner[0] as usize]).collect();
        self.cutter.cut(&places)
    }

    /// The indices of `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 0.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut parts = word.split('/');
        let mut index = |what: &str, so_far: usize| match parts.next() {
            None | Some("") => Ok(NONE),
            Some(index) => resolve(index, what, so_far),
        };
        let corner = [
            index("vertex (v)", self.positions.len())?,
            index("texture coordinate (vt)", self.texcoords.len())?,
            index("normal (vn)", self.normals.len())?,
        ];
        match parts.next() {
            None if corner[0] != NONE => Ok(corner),
            _ => Err(format!("face corner {word:?}; it must be v, v/vt, v//vn or v/vt/vn")),
        }
    }

    /// The slot of the current material.
    fn current_slot(&mut self) -> Result<u32, String> {
        if let Some(slot) = self.slot {
            return Ok(slot);
        }
        let next = self.slot_names.len() as u32;
        let slot = *self.slot_numbers.entry(self.material.clone()).or_insert(next);
        if slot == next {
            if self.slot_names.len() == MOST_MATERIALS {
                return Err(format!("f with one more than {MOST_MATERIALS} materials, the most that are read"));
            }
            self.slot_names.push(self.material.clone());
        }
        self.slot = Some(slot);
        Ok(slot)
    }
}

/// The index, from 0, that an OBJ index means: counted from 1, or backwards from the last if negative.
fn resolve(index: &str, what: &str, so_far: usize) -> Result<u32, String> {
    let number: i64 = index.parse().map_err(|_| format!("face index {index:?} is not a whole number"))?;
    let from_end = usize::try_from(number.unsigned_abs()).ok().and_then(|back| so_far.checked_sub(back));
    let resolved = match number {
        0 => return Err(format!("face index 0 for the {what}; indices start at 1")),
        1.. => usize::try_from(number - 1).ok().filter(|index| *index < so_far),
        _ => from_end,
    };
    let resolved = resolved.and_then(|index| u32::try_from(index).ok()).filter(|index| *index != NONE);
    resolved.ok_or_else(|| format!("face index {index} for the {what}, of which there are {so_far} so far"))
}

fn numbers(keyword: &str, words: SplitWhitespace<'_>) -> Result<Vec<f32>, String> {
    words.map(|word| word.parse().map_err(|_| format!("{keyword} with {word:?}, which is not a number"))).collect()
}

fn finite_numbers(keyword: &str, words: SplitWhitespace<'_>) -> Result<Vec<f32>, String> {
    let numbers = numbers(keyword, words)?;
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(number) => Err(format!("{keyword} with {number}; it must be finite and less than 3.4e38")),
        None => Ok(numbers),
    }
}
