//! The lines of OBJ and MTL files.

use std::{
    io::{BufRead, Read},
    path::{Path, PathBuf},
};

use crate::Error;

/// The most bytes of a line, with those that continue it.
const MOST_BYTES: u64 = 1 << 24;

/// Reads lines one by one, joined where they end in a backslash. Bytes that are not UTF-8 become U+FFFD.
pub(super) struct Lines<R> {
    source: R,
    path: PathBuf,
    /// Lines read so far.
    number: usize,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(source: R, path: &Path) -> Self {
        Self { source, path: path.to_owned(), number: 0 }
    }

    /// The next line and the number, from 1, of its first part; none at the end.
    ///
    /// # Errors
    /// If the file cannot be read or the line is too long.
    pub(super) fn next(&mut self) -> Result<Option<(usize, String)>, Error> {
        let mut bytes = Vec::new();
        let first = self.number + 1;
        loop {
            let before = bytes.len();
            let left = MOST_BYTES.saturating_sub(before as u64);
            let read = self.source.by_ref().take(left).read_until(b'\n', &mut bytes);
            let read = read.map_err(|cause| Error::Read { path: self.path.clone(), cause })?;
            if bytes.len() as u64 >= MOST_BYTES {
                let problem = format!("a line of more than {MOST_BYTES} bytes; the file is no text of this format");
                return Err(Error::Obj { path: self.path.clone(), line: Some(first), problem });
            }
            if read == 0 {
                break;
            }
            self.number += 1;
            while bytes.last().is_some_and(|byte| b"\r\n".contains(byte)) {
                bytes.pop();
            }
            if bytes.len() == before || bytes.last() != Some(&b'\\') {
                return Ok(Some((first, String::from_utf8_lossy(&bytes).into_owned())));
            }
            *bytes.last_mut().expect("the backslash") = b' ';
        }
        Ok((!bytes.is_empty()).then(|| (first, String::from_utf8_lossy(&bytes).into_owned())))
    }
}
