//! How far a render is, to be kept and gone on with later.

use std::io::{self, BufRead, Read, Write};

use serde::{Deserialize, Serialize};

use crate::{
    Error,
    fingerprint::{Fingerprint, digest_of},
};

/// How a written state begins; the number is that of its format.
const MAGIC: &str = "diacaustic render state 2";
/// Bytes of the longest header that is read.
const LONGEST_HEADER: u64 = 1 << 20;

/// Everything that the photons and samples of a scene have left on the device: [`Renderer::save_state`](crate::Renderer::save_state) reads it, and
/// [`Renderer::restore_state`](crate::Renderer::restore_state) goes on from it to the same bits as a render that never stopped.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderState {
    /// Whatever the application wants to know of it later, such as the scene's name.
    pub note: String,
    pub(crate) photons: u64,
    pub(crate) samples: u32,
    /// Samples over all pixels.
    pub(crate) sample_sum: u64,
    /// How far a render to a target error is.
    pub(crate) course: Vec<u32>,
    /// Of what it is.
    pub(crate) fingerprint: Fingerprint,
    pub(crate) buffers: Vec<SavedBuffer>,
}

/// The content of a buffer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SavedBuffer {
    pub name: String,
    pub words: Vec<u32>,
}

/// What is written before the buffers.
#[derive(Serialize, Deserialize)]
struct Header {
    note: String,
    photons: u64,
    samples: u32,
    sample_sum: u64,
    /// Words of the course, which come before the buffers.
    course: u64,
    fingerprint: Fingerprint,
    /// Names and sizes in words.
    buffers: Vec<(String, u64)>,
}

impl RenderState {
    /// Photons emitted.
    pub fn photons(&self) -> u64 {
        self.photons
    }

    /// Samples in each pixel, at least.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Writes it: a line with a checksum, a line of JSON, and the buffers.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, mut to: impl Write) -> io::Result<()> {
        let buffers = self.buffers.iter().map(|buffer| (buffer.name.clone(), buffer.words.len() as u64)).collect();
        let (note, fingerprint) = (self.note.clone(), self.fingerprint.clone());
        let Self { photons, samples, sample_sum, .. } = *self;
        let header =
            Header { note, photons, samples, sample_sum, course: self.course.len() as u64, fingerprint, buffers };
        let header = serde_json::to_string(&header)? + "\n";
        writeln!(to, "{MAGIC} {:016x}", self.checksum(&header))?;
        to.write_all(header.as_bytes())?;
        to.write_all(bytemuck::cast_slice(&self.course))?;
        self.buffers.iter().try_for_each(|buffer| to.write_all(bytemuck::cast_slice(&buffer.words)))
    }

    /// Reads what [`RenderState::write`] has written.
    ///
    /// # Errors
    /// If reading fails, what is read is no state, or it is cut off or damaged.
    pub fn read(mut from: impl BufRead) -> Result<Self, Error> {
        let bad = |problem: &str| Error::BadState(problem.to_owned());
        let cut_off = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => bad("it is cut off"),
            _ => Error::BadState(format!("it cannot be read: {error}")),
        };
        let first = line(&mut from).map_err(cut_off)?;
        let digits = first.strip_prefix(MAGIC).and_then(|rest| rest.strip_prefix(' '));
        let digits = digits.and_then(|rest| rest.strip_suffix('\n')).filter(|digits| digits.len() == 16);
        let Some(checksum) = digits.and_then(|digits| u64::from_str_radix(digits, 16).ok()) else {
            return Err(bad("it is no render state that this version reads"));
        };
        let text = line(&mut from).map_err(cut_off)?;
        let header: Header = serde_json::from_str(&text).map_err(|_| bad("it is cut off or damaged"))?;
        let course = words(&mut from, header.course).map_err(cut_off)?;
        let mut buffers = Vec::new();
        for (name, count) in header.buffers {
            buffers.push(SavedBuffer { name, words: words(&mut from, count).map_err(cut_off)? });
        }
        let Header { note, photons, samples, sample_sum, fingerprint, .. } = header;
        let state = Self { note, photons, samples, sample_sum, course, fingerprint, buffers };
        if state.checksum(&text) != checksum {
            return Err(bad("it is damaged: its checksum is wrong"));
        }
        Ok(state)
    }

    fn checksum(&self, header: &str) -> u64 {
        let buffers = self.buffers.iter().map(|buffer| bytemuck::cast_slice(&buffer.words));
        digest_of([header.as_bytes(), bytemuck::cast_slice(&self.course)].into_iter().chain(buffers))
    }
}

/// A line of text.
fn line(from: &mut impl BufRead) -> io::Result<String> {
    let mut line = Vec::new();
    from.take(LONGEST_HEADER).read_until(b'\n', &mut line)?;
    if line.last() != Some(&b'\n') {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    String::from_utf8(line).map_err(|_| io::ErrorKind::InvalidData.into())
}

/// `count` words; memory grows with what there is to read.
fn words(from: &mut impl Read, count: u64) -> io::Result<Vec<u32>> {
    let mut bytes = Vec::new();
    let size = count.checked_mul(4).ok_or(io::ErrorKind::UnexpectedEof)?;
    if from.take(size).read_to_end(&mut bytes)? as u64 != size {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> RenderState {
        let mut fingerprint = Fingerprint::default();
        fingerprint.say("seed", 3);
        let buffers = [("film", vec![1, 2, 0xffff_ffff]), ("ledger", vec![])];
        let buffers = buffers.map(|(name, words)| SavedBuffer { name: name.to_owned(), words });
        RenderState {
            note: "a\nb".to_owned(),
            photons: 1 << 40,
            samples: 7,
            sample_sum: 9,
            course: vec![3, 4],
            fingerprint,
            buffers: buffers.into(),
        }
    }

    fn written(state: &RenderState) -> Vec<u8> {
        let mut bytes = Vec::new();
        state.write(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn what_is_written_is_read() {
        assert_eq!(RenderState::read(&written(&state())[..]).unwrap(), state());
    }

    #[test]
    fn damage_is_found_wherever_it_is() {
        let whole = written(&state());
        for at in 0..whole.len() {
            RenderState::read(&whole[..at]).expect_err("cut off");
            let mut changed = whole.clone();
            changed[at] ^= 0x10;
            RenderState::read(&changed[..]).expect_err("changed");
        }
        let message = RenderState::read(&b"PNG\n"[..]).unwrap_err().to_string();
        assert!(message.contains("no render state"), "{message}");
    }

    #[test]
    fn sizes_that_lie_take_no_memory() {
        let text = String::from_utf8_lossy(&written(&state())).replace("\"film\",3", "\"film\",4611686018427387903");
        let message = RenderState::read(text.as_bytes()).unwrap_err().to_string();
        assert!(message.contains("cut off"), "{message}");
    }
}
