//! Checks OBJ text and rewrites it so that tobj reads it without fault.
//!
//! tobj 4.0.5 names no line, loses the names of materials that no library defines, pairs normals with the wrong
//! vertices when some corners have none, takes a polyline for a face, and overflows on relative indices that reach
//! before the first vertex. The rewritten text has absolute indices on every corner and no groups.

use std::{fmt::Write, path::Path, str::SplitWhitespace};

use crate::Error;

/// OBJ text that tobj can read, and what it leaves out.
pub(super) struct Checked {
    /// The rewritten text. Its first texture coordinate and first normal stand for missing ones.
    pub(super) text: String,
    /// Names of the materials that faces use, in the order of first use; "" before the first `usemtl`.
    pub(super) slots: Vec<String>,
    /// The file names after `mtllib`.
    pub(super) libraries: Vec<String>,
    /// Corners of faces.
    pub(super) corners: usize,
    /// Corners without texture coordinates.
    pub(super) without_texcoord: usize,
    /// Corners without a normal.
    pub(super) without_normal: usize,
    /// Faces of fewer than three corners.
    pub(super) skipped_faces: usize,
}

/// The name under which the rewritten text refers to a slot.
pub(super) fn slot_keyword(slot: usize) -> String {
    format!("slot{slot}")
}

/// Checks and rewrites OBJ text; `path` is for messages.
pub(super) fn check(text: &str, path: &Path) -> Result<Checked, Error> {
    let mut checker = Checker::new();
    let mut lines = text.lines().zip(1..);
    while let Some((line, number)) = lines.next() {
        let mut joined = line.to_owned();
        while joined.ends_with('\\') {
            joined.pop();
            joined.push(' ');
            joined += lines.next().map_or("", |(next, _)| next);
        }
        let error = |problem| Error::Obj { path: path.to_owned(), line: Some(number), problem };
        checker.line(&joined).map_err(error)?;
    }
    Ok(checker.checked)
}

/// How many of a thing there are so far, and its name.
struct Count {
    what: &'static str,
    so_far: usize,
}

struct Checker {
    checked: Checked,
    positions: Count,
    texcoords: Count,
    normals: Count,
    /// The name after the last `usemtl`.
    material: String,
    /// Whether the rewritten text already names the slot of that material.
    is_slot_written: bool,
}

impl Checker {
    fn new() -> Self {
        let checked = Checked {
            text: "mtllib slots\nvt 0 0\nvn 0 0 0\n".to_owned(),
            slots: Vec::new(),
            libraries: Vec::new(),
            corners: 0,
            without_texcoord: 0,
            without_normal: 0,
            skipped_faces: 0,
        };
        Self {
            checked,
            positions: Count { what: "vertex (v)", so_far: 0 },
            texcoords: Count { what: "texture coordinate (vt)", so_far: 0 },
            normals: Count { what: "normal (vn)", so_far: 0 },
            material: String::new(),
            is_slot_written: false,
        }
    }

    fn line(&mut self, line: &str) -> Result<(), String> {
        let Some(keyword) = line.split_whitespace().next() else { return Ok(()) };
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        words.next();
        let rest = || line.trim_start()[keyword.len()..].trim().to_owned();
        match keyword {
            "v" => self.position(words),
            "vt" => self.texcoord(words),
            "vn" => self.normal(words),
            "f" => self.face(words),
            "usemtl" if rest().is_empty() => Err("usemtl without the name of a material".to_owned()),
            "usemtl" => {
                self.material = rest();
                self.is_slot_written = false;
                Ok(())
            }
            "mtllib" => {
                self.checked.libraries.push(rest());
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn position(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let mut numbers = finite_numbers("v", words)?;
        match numbers.as_slice() {
            [_, _, _] => {}
            [x, y, z, w] => {
                let divided = [x / w, y / w, z / w];
                if !divided.iter().all(|coordinate| coordinate.is_finite()) {
                    return Err(format!("v with the weight {w}; it must not be 0"));
                }
                numbers = divided.to_vec();
            }
            [_, _, _, ..] => numbers.truncate(3),
            few => return Err(format!("v with {} numbers; a vertex takes x y z", few.len())),
        }
        self.positions.so_far += 1;
        self.write_numbers("v", &numbers);
        Ok(())
    }

    fn texcoord(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let numbers = finite_numbers("vt", words)?;
        let Some(&u) = numbers.first() else { return Err("vt without numbers; it takes u and v".to_owned()) };
        self.texcoords.so_far += 1;
        self.write_numbers("vt", &[u, numbers.get(1).copied().unwrap_or(0.0)]);
        Ok(())
    }

    fn normal(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let mut numbers = numbers("vn", words)?;
        if numbers.len() < 3 {
            return Err(format!("vn with {} numbers; a normal takes x y z", numbers.len()));
        }
        numbers.truncate(3);
        let largest = numbers.iter().fold(0.0f32, |largest, number| largest.max(number.abs()));
        let is_usable = numbers.iter().all(|number| number.is_finite()) && largest > 0.0;
        for number in &mut numbers {
            *number = if is_usable { *number / largest } else { 0.0 };
        }
        self.normals.so_far += 1;
        self.write_numbers("vn", &numbers);
        Ok(())
    }

    fn face(&mut self, words: SplitWhitespace<'_>) -> Result<(), String> {
        let mut corners = Vec::new();
        for word in words {
            corners.push(self.corner(word)?);
        }
        if corners.len() < 3 {
            self.checked.skipped_faces += 1;
            return Ok(());
        }
        self.write_slot();
        self.checked.text.push('f');
        for (position, texcoord, normal) in corners {
            self.checked.corners += 1;
            self.checked.without_texcoord += usize::from(texcoord.is_none());
            self.checked.without_normal += usize::from(normal.is_none());
            let (texcoord, normal) = (texcoord.map_or(1, |i| i + 2), normal.map_or(1, |i| i + 2));
            let _ = write!(self.checked.text, " {}/{texcoord}/{normal}", position + 1);
        }
        self.checked.text.push('\n');
        Ok(())
    }

    /// The indices of `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 0.
    fn corner(&self, word: &str) -> Result<(usize, Option<usize>, Option<usize>), String> {
        let mut parts = word.split('/');
        let mut index = |count: &Count| match parts.next() {
            None | Some("") => Ok(None),
            Some(index) => resolve(index, count).map(Some),
        };
        let (position, texcoord, normal) = (index(&self.positions)?, index(&self.texcoords)?, index(&self.normals)?);
        match (position, parts.next()) {
            (Some(position), None) => Ok((position, texcoord, normal)),
            _ => Err(format!("face corner {word:?}; it must be v, v/vt, v//vn or v/vt/vn")),
        }
    }

    /// Names the slot of the current material, if the rewritten text does not already stand at it.
    fn write_slot(&mut self) {
        if std::mem::replace(&mut self.is_slot_written, true) {
            return;
        }
        let known = self.checked.slots.iter().position(|slot| *slot == self.material);
        let slot = known.unwrap_or_else(|| {
            self.checked.slots.push(self.material.clone());
            self.checked.slots.len() - 1
        });
        let _ = writeln!(self.checked.text, "usemtl {}", slot_keyword(slot));
    }

    fn write_numbers(&mut self, keyword: &str, numbers: &[f32]) {
        self.checked.text += keyword;
        for number in numbers {
            let _ = write!(self.checked.text, " {number:e}");
        }
        self.checked.text.push('\n');
    }
}

/// The index, from 0, that an OBJ index means: counted from 1, or backwards from the last if negative.
fn resolve(index: &str, Count { what, so_far }: &Count) -> Result<usize, String> {
    let number: i64 = index.parse().map_err(|_| format!("face index {index:?} is not a whole number"))?;
    let from_end = usize::try_from(number.unsigned_abs()).ok().and_then(|back| so_far.checked_sub(back));
    let resolved = match number {
        0 => return Err(format!("face index 0 for the {what}; indices start at 1")),
        1.. => usize::try_from(number - 1).ok().filter(|index| index < so_far),
        _ => from_end,
    };
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
