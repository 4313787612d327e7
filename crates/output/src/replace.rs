//! Replaces files whole or not at all.

use std::{
    fs::{self, File},
    io::{self, BufWriter, Write as _},
    path::{Path, PathBuf},
};

use crate::Error;

/// Writes a file beside its place and moves it there once it is complete and on the disk.
///
/// # Errors
/// If it cannot be written, or `write` fails; what was there before then stays.
pub fn replace<E>(path: &Path, write: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), E>) -> Result<(), Error>
where
    E: Into<Box<dyn std::error::Error + Send + Sync>>,
{
    let failed = |source: Box<dyn std::error::Error + Send + Sync>| Error::Write { path: path.to_owned(), source };
    if is_device_or_pipe(path) {
        let mut file = File::options().write(true).open(path).map_err(|error| failed(error.into()))?;
        return write_all(&mut file, write).map_err(failed);
    }
    // A link's target, if there is one.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut draft = draft_in(&folder_of(&target)).map_err(|error| failed(error.into()))?;
    write_all(draft.as_file_mut(), write).map_err(failed)?;
    draft.as_file().sync_all().map_err(|error| failed(error.into()))?;
    draft.persist(&target).map_err(|error| failed(error.error.into()))?;
    Ok(())
}

/// Writes a text file.
///
/// # Errors
/// If it cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<(), Error> {
    replace(path, |file| file.write_all(text.as_bytes()))
}

/// Checks, without changing anything, that a file can be written: its folder exists and takes new files.
///
/// # Errors
/// If it cannot.
pub fn check_writable(path: &Path) -> Result<(), Error> {
    if path.is_dir() {
        return Err(Error::IsFolder(path.to_owned()));
    }
    if is_device_or_pipe(path) {
        return Ok(());
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(Error::NoFolder { path: path.to_owned(), folder });
    }
    draft_in(&folder).map(drop).map_err(|error| Error::Write { path: path.to_owned(), source: error.into() })
}

fn write_all<E>(
    file: &mut File,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), E>,
) -> Result<(), Box<dyn std::error::Error + Send + Sync>>
where
    E: Into<Box<dyn std::error::Error + Send + Sync>>,
{
    let mut buffered = BufWriter::new(file);
    write(&mut buffered).map_err(Into::into)?;
    Ok(buffered.flush()?)
}

/// Whether a path leads to neither a file nor a folder, so that what is written cannot be replaced.
pub fn is_device_or_pipe(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// A file that vanishes unless it is moved to its place.
fn draft_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".diacaustic-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for any new file; the user's mask narrows it.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_write_leaves_the_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        fs::write(&path, "before").unwrap();
        let error = replace(&path, |file| {
            file.write_all(b"half of it")?;
            Err::<(), _>(io::Error::other("the disk is full"))
        });
        let Err(Error::Write { path: named, source }) = error else { panic!("the write failed") };
        assert_eq!((named, source.to_string()), (path.clone(), "the disk is full".to_owned()));
        assert_eq!(fs::read(&path).unwrap(), b"before");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_write_replaces_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        for content in ["first", "2"] {
            replace(&path, |file| file.write_all(content.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), content);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "before").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        replace(&link, |file| file.write_all(b"after")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"after");
        assert!(is_device_or_pipe(Path::new("/dev/null")) && !is_device_or_pipe(&link));
        replace(Path::new("/dev/null"), |file| file.write_all(b"gone")).unwrap();
        assert!(is_device_or_pipe(Path::new("/dev/null")));
    }

    #[test]
    fn what_cannot_be_written_is_found_before() {
        let folder = tempfile::tempdir().unwrap();
        assert!(check_writable(&folder.path().join("new.exr")).is_ok());
        assert!(matches!(check_writable(folder.path()), Err(Error::IsFolder(_))));
        let missing = folder.path().join("missing/new.exr");
        assert!(matches!(check_writable(&missing), Err(Error::NoFolder { .. })));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        assert_eq!(folder_of(Path::new("new.exr")), Path::new("."));
    }
}
