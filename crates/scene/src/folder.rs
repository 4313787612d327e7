//! Files that another file names: where they may lie.

use std::{
    fs::{self, File},
    io::Read,
    path::{Path, PathBuf},
};

/// What a reader of files may do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Whether glTF and OBJ files may name files outside their own folder.
    pub allow_outside: bool,
}

/// The folder of a file, in which the files lie that it names.
pub(crate) struct Folder {
    path: PathBuf,
    allow_outside: bool,
}

impl Folder {
    /// The folder of `file`.
    pub(crate) fn of(file: &Path, options: ReadOptions) -> Self {
        let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty());
        Self { path: parent.unwrap_or(Path::new(".")).to_owned(), allow_outside: options.allow_outside }
    }

    /// The path of a file in the folder; refused if it leads out of it, by its name or by a link.
    pub(crate) fn inside(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.path.join(name);
        let leaves = || match (fs::canonicalize(&path), fs::canonicalize(&self.path)) {
            (Ok(real), Ok(root)) => !real.starts_with(root),
            _ => false,
        };
        if !self.allow_outside && (leads_outside(name) || leaves()) {
            return Err(format!(
                "names the file {name:?}, which lies outside the folder; copy it there, or give --allow-outside"
            ));
        }
        Ok(path)
    }

    /// The bytes of a file in the folder, `most` at most.
    pub(crate) fn read(&self, name: &str, most: u64) -> Result<Vec<u8>, String> {
        let path = self.inside(name)?;
        let problem = |error| format!("names the file {}, which cannot be read: {error}", path.display());
        if !fs::metadata(&path).map_err(problem)?.is_file() {
            return Err(format!("names the file {}, which is no ordinary file", path.display()));
        }
        let mut bytes = Vec::new();
        File::open(&path).map_err(problem)?.take(most).read_to_end(&mut bytes).map_err(problem)?;
        Ok(bytes)
    }
}

/// Whether a path has more steps up than down at some point, or begins at a root or drive, on whatever system it was written.
fn leads_outside(name: &str) -> bool {
    let name = name.replace('\\', "/");
    let mut depth = 0i64;
    for step in name.split('/') {
        match step {
            "" | "." => {}
            ".." => depth -= 1,
            _ => depth += 1,
        }
        if depth < 0 {
            return true;
        }
    }
    name.starts_with('/') || name.as_bytes().get(1) == Some(&b':')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_up_are_counted() {
        for outside in ["/etc/passwd", "../a", "a/../../b", "./../a", "a\\..\\..\\b", "C:\\a"] {
            assert!(leads_outside(outside), "{outside}");
        }
        for inside in ["a", "a/b.bin", "./a", "a/../b", "..a/b", "a b", "a\\b"] {
            assert!(!leads_outside(inside), "{inside}");
        }
    }
}
