//! What is wrong with a glTF file, before its name is known.

use std::path::Path;

use crate::{Error, Warning};

/// A fault: the part of the file, and what is wrong with it.
#[derive(Debug)]
pub(super) struct Fault {
    place: Option<String>,
    problem: String,
}

pub(super) type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    /// A fault of a part such as `meshes[3] "Cup"`.
    pub(super) fn new(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { place: Some(place.into()), problem: problem.into() }
    }

    /// A fault of the file as a whole.
    pub(super) fn of_file(problem: impl Into<String>) -> Self {
        Self { place: None, problem: problem.into() }
    }

    pub(super) fn error(self, path: &Path) -> Error {
        Error::Gltf { path: path.to_owned(), place: self.place, problem: self.problem }
    }

    pub(super) fn warning(self, path: &Path) -> Warning {
        Warning::Gltf { path: path.to_owned(), place: self.place, problem: self.problem }
    }
}

/// The name of an entry of one of the file's lists, as messages give it.
pub(super) fn place(list: &str, index: usize, name: Option<&str>) -> String {
    let name = name.map(|name| format!(" {:?}", shortened(name))).unwrap_or_default();
    format!("{list}[{index}]{name}")
}

/// A name, cut where it is too long for messages and the names of files.
pub(super) fn shortened(name: &str) -> String {
    const MOST: usize = 80;
    name.chars().take(MOST).collect()
}

/// The entry of a list that an index names.
pub(super) fn entry<'a, T>(list: &'a [T], list_name: &str, index: usize, user: &str) -> Result<&'a T> {
    list.get(index).ok_or_else(|| {
        Fault::new(user, format!("names {list_name}[{index}], but the file has {} {list_name}, from 0", list.len()))
    })
}
