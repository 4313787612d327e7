//! Files that another file names: where they may lie.

use std::{
    fs::{self, File},
    io::Read,
    path::{Component, Path, PathBuf},
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

    /// The path of a file in the folder, or what is wrong with its name: it leads out of the folder, or to no file.
    pub(crate) fn resolve(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.path.join(name);
        if !self.allow_outside && leads_outside(Path::new(name)) {
            return Err(outside(name));
        }
        let place = |problem| format!("names the file {}, which {problem}", path.display());
        let real = fs::canonicalize(&path).map_err(|error| place(format!("cannot be read: {error}")))?;
        let root = fs::canonicalize(&self.path).map_err(|error| place(format!("cannot be read: {error}")))?;
        if !self.allow_outside && !real.starts_with(root) {
            return Err(outside(name));
        }
        if real.is_file() { Ok(path) } else { Err(place("is no ordinary file".to_owned())) }
    }

    /// The bytes of a file in the folder, `most` at most.
    pub(crate) fn read(&self, name: &str, most: u64) -> Result<Vec<u8>, String> {
        let path = self.resolve(name)?;
        let problem = |error| format!("names the file {}, which cannot be read: {error}", path.display());
        let mut bytes = Vec::new();
        File::open(&path).map_err(problem)?.take(most).read_to_end(&mut bytes).map_err(problem)?;
        Ok(bytes)
    }
}

fn outside(name: &str) -> String {
    format!("names the file {name:?}, which lies outside the folder; copy it there, or give --allow-outside")
}

/// Whether a relative path has more steps up than down at some point, or is none.
fn leads_outside(path: &Path) -> bool {
    // A Windows path in a file from there.
    if path.to_string_lossy().contains('\\') {
        return true;
    }
    let mut depth = 0i64;
    for component in path.components() {
        match component {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir => depth -= 1,
            Component::RootDir | Component::Prefix(_) => return true,
        }
        if depth < 0 {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_up_are_counted() {
        for outside in ["/etc/passwd", "../a", "a/../../b", "./../a", "a\\..\\b", "C:\\a"] {
            assert!(leads_outside(Path::new(outside)), "{outside}");
        }
        for inside in ["a", "a/b.bin", "./a", "a/../b", "..a/b", "a b"] {
            assert!(!leads_outside(Path::new(inside)), "{inside}");
        }
    }
}
