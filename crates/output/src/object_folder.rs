//! Folders with files for each object.

use std::{
    collections::HashSet,
    fs,
    path::{Path, PathBuf},
};

use crate::{Error, check_writable};

/// A folder whose files are named after objects.
///
/// Characters of an object's name that some file systems refuse are written as `_`; a name that is taken then gets a number.
#[derive(Debug)]
pub struct ObjectFolder {
    path: PathBuf,
    taken: HashSet<String>,
}

impl ObjectFolder {
    /// Opens a folder, creates it where it is missing, and checks that it takes files. Files in it stay until they are
    /// replaced.
    ///
    /// # Errors
    /// If the folder cannot be created or written to.
    pub fn open(path: &Path) -> Result<Self, Error> {
        fs::create_dir_all(path).map_err(|source| Error::Create { path: path.to_owned(), source })?;
        check_writable(&path.join("map.exr"))?;
        Ok(Self { path: path.to_owned(), taken: HashSet::new() })
    }

    /// The path of a file in the folder.
    pub fn path_of(&self, file_name: &str) -> PathBuf {
        self.path.join(file_name)
    }

    /// What the names of an object's files begin with: it differs from all given before also where case does not count.
    pub fn stem(&mut self, object: &str) -> String {
        let allowed = |c: char| if c.is_control() || r#"/\:*?"<>|"#.contains(c) { '_' } else { c };
        let stem: String = object.chars().map(allowed).collect();
        let mut candidate = stem.clone();
        let mut number = 2;
        while !self.taken.insert(candidate.to_lowercase()) {
            candidate = format!("{stem} {number}");
            number += 1;
        }
        candidate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fit_every_file_system() {
        let mut maps = ObjectFolder { path: PathBuf::new(), taken: HashSet::new() };
        let names = ["a:b", "a?b", "A_B", "ä ö.1"].map(|name| maps.stem(name));
        assert_eq!(names, ["a_b", "a_b 2", "A_B 3", "ä ö.1"]);
    }
}
