//! Values that stand in for those of a scene file.

use std::{fmt, str::FromStr};

use toml::{
    Spanned,
    de::{DeArray, DeTable, DeValue},
};

use crate::{Error, error::suggestion};

/// A value in place of the scene file's: a path of keys with dots between, and a TOML value.
///
/// A step into an array is a number from 0, or the `name` of one of its tables. The last key may be new; where the scene file has no such
/// table, `[camera]`, `[render]`, `[output]` and the like begin empty. Overrides are applied one after the other, before anything else
/// looks at the file.
///
/// ```
/// use std::path::Path;
/// use diacaustic_scene::{Override, SceneOptions, parse_scene_with};
///
/// # let text = r#"
/// #     camera = { position = [0, 2, 3], look_at = [0, 0.2, 0], vertical_fov = 40 }
/// #     materials.glass = { type = "dielectric", ior = 1.5 }
/// #     lights = [{ name = "lamp", type = "point", position = [0, 2, 0], flux = 35 }]
/// #     objects = [{ name = "ball", sphere = { center = [0, 0.3, 0], radius = 0.3, subdivisions = 1 }, material = "glass" }]
/// # "#;
/// let overrides = ["render.samples=64", "lights.0.flux=10", "objects.ball.sphere.center=[0, 0.5, 0]"];
/// let overrides = overrides.into_iter().map(Override::parse).collect::<Result<_, _>>()?;
/// let options = SceneOptions { overrides, ..SceneOptions::default() };
/// let scene = parse_scene_with(text, Path::new("."), "ball.toml", &options)?.scene;
/// assert_eq!(scene.settings.samples, Some(64));
/// # Ok::<(), diacaustic_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// The keys from the root of the file on; not empty.
    path: Vec<String>,
    /// The value in TOML.
    value: String,
}

impl Override {
    /// Reads `KEY=VALUE`: a TOML key, whose parts may be quoted, and a TOML value.
    ///
    /// # Errors
    /// If it is not that.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let problem = |problem: &str| Error::Override { path: text.to_owned(), problem: problem.to_owned() };
        let splits = text.match_indices('=').map(|(at, _)| (&text[..at], text[at + 1..].trim()));
        let mut readable = splits.filter_map(|(key, value)| Some((key_parts(key)?, value)));
        let Some((path, value)) = readable.next() else {
            return Err(problem("expected KEY=VALUE with dots in the key, such as render.samples=64"));
        };
        if DeValue::parse(value).is_err() {
            return Err(problem("the value is no TOML; a string stands in quotes, a vector in brackets: [0, 1, 2]"));
        }
        Ok(Self { path, value: value.to_owned() })
    }

    /// Sets the value in a scene file, with `at` for its place in the text.
    pub(super) fn apply<'d>(&'d self, root: &mut Spanned<DeTable<'d>>, at: usize) -> Result<(), Error> {
        let fault = |problem| Error::Override { path: self.path(), problem };
        let value = DeValue::parse(&self.value).map_err(|error| fault(error.message().to_owned()))?;
        let mut table = DeValue::Table(std::mem::take(root.get_mut()));
        let set = Setter { path: &self.path, at }.set(&mut table, 0, placed(value, at));
        if let DeValue::Table(table) = table {
            *root.get_mut() = table;
        }
        set.map_err(fault)
    }

    /// The keys, with dots between.
    pub fn path(&self) -> String {
        let bare = |part: &str| !part.is_empty() && part.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
        let parts = self.path.iter().map(|part| if bare(part) { part.clone() } else { format!("{part:?}") });
        parts.collect::<Vec<_>>().join(".")
    }

    /// The value in TOML.
    pub fn value(&self) -> &str {
        &self.value
    }
}

impl FromStr for Override {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        Self::parse(text)
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path(), self.value)
    }
}

/// The parts of a TOML key, if it is one.
fn key_parts(key: &str) -> Option<Vec<String>> {
    if key.contains(['\n', '#']) {
        return None;
    }
    let text = format!("{key} = 0");
    let document = DeTable::parse(&text).ok()?;
    let mut table = document.get_ref();
    let mut parts = Vec::new();
    loop {
        let (part, value) = table.iter().next()?;
        parts.push(part.get_ref().to_string());
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => return Some(parts),
        }
    }
}

/// A value all of whose parts stand at one place.
fn placed(value: Spanned<DeValue<'_>>, at: usize) -> Spanned<DeValue<'_>> {
    let value = match value.into_inner() {
        DeValue::Array(array) => {
            let mut moved = DeArray::new();
            array.into_iter().for_each(|element| moved.push(placed(element, at)));
            DeValue::Array(moved)
        }
        DeValue::Table(table) => {
            let moved =
                table.into_iter().map(|(key, value)| (Spanned::new(at..at, key.into_inner()), placed(value, at)));
            DeValue::Table(moved.collect())
        }
        other => other,
    };
    Spanned::new(at..at, value)
}

/// Walks down a path of keys.
struct Setter<'d> {
    path: &'d [String],
    at: usize,
}

impl<'d> Setter<'d> {
    /// Sets what lies under the keys from number `depth` on.
    fn set(&self, inside: &mut DeValue<'d>, depth: usize, new: Spanned<DeValue<'d>>) -> Result<(), String> {
        let key = self.path[depth].as_str();
        let is_last = depth + 1 == self.path.len();
        match inside {
            DeValue::Table(table) if is_last => {
                // The key's own place moves as well.
                table.remove(key);
                table.insert(self.key(depth), new);
                Ok(())
            }
            DeValue::Table(table) => {
                if depth == 0 && !table.contains_key(key) {
                    table.insert(self.key(depth), Spanned::new(self.at..self.at, DeValue::Table(DeTable::new())));
                }
                let known: Vec<_> = table.keys().map(|key| key.get_ref().to_string()).collect();
                match table.get_mut(key) {
                    Some(value) => self.set(value.get_mut(), depth + 1, new),
                    None => Err(self.unknown(depth, &known, "keys")),
                }
            }
            DeValue::Array(array) => {
                let index = self.index(array, depth)?;
                // The array is rebuilt, for it gives no element away to be changed.
                let mut elements: Vec<_> = std::mem::replace(array, DeArray::new()).into_iter().collect();
                let set = match is_last {
                    true => {
                        elements[index] = new;
                        Ok(())
                    }
                    false => self.set(elements[index].get_mut(), depth + 1, new),
                };
                elements.into_iter().for_each(|element| array.push(element));
                set
            }
            other => {
                let (parent, kind) = (self.path[..depth].join("."), other.type_str());
                Err(format!("{parent} is a value of type {kind} in the scene file and has no {key:?} in it"))
            }
        }
    }

    fn key(&self, depth: usize) -> Spanned<toml::de::DeString<'d>> {
        Spanned::new(self.at..self.at, self.path[depth].as_str().into())
    }

    /// The element that a number or a name stands for.
    fn index(&self, array: &DeArray<'_>, depth: usize) -> Result<usize, String> {
        let (step, parent) = (self.path[depth].as_str(), self.path[..depth].join("."));
        if let Ok(index) = step.parse::<usize>() {
            let count = array.len();
            return if index < count {
                Ok(index)
            } else {
                Err(format!("{parent} has no element {index}; it has {count}, from 0"))
            };
        }
        let names: Vec<_> = array.iter().map(|element| element_name(element.get_ref()).unwrap_or_default()).collect();
        let mut named = (0..names.len()).filter(|&index| names[index] == step);
        match (named.next(), named.next()) {
            (Some(index), None) => Ok(index),
            (Some(_), Some(_)) => Err(format!("several elements of {parent} are named {step:?}; give a number from 0")),
            (None, _) => {
                let known: Vec<_> =
                    names.iter().filter(|name| !name.is_empty()).map(|name| (*name).to_owned()).collect();
                let numbers = format!("; or a number from 0 to {}", array.len().saturating_sub(1));
                Err(self.unknown(depth, &known, "names") + &numbers)
            }
        }
    }

    fn unknown(&self, depth: usize, known: &[String], plural: &str) -> String {
        let known: Vec<_> = known.iter().map(String::as_str).collect();
        let parent = match depth {
            0 => "the scene file".to_owned(),
            _ => self.path[..depth].join("."),
        };
        let key = &self.path[depth];
        format!("{parent} has no {key:?}; {}", suggestion(key, &known, plural))
    }
}

/// The name that a table gives itself.
fn element_name<'v>(element: &'v DeValue<'_>) -> Option<&'v str> {
    element.as_table()?.get("name")?.get_ref().as_str()
}
