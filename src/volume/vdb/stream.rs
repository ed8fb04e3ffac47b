//! A checked cursor over the bytes of a file.

use crate::error::Error;

/// Reason why a part of a file could not be read; [`Fault::into_error`] adds file and grid.
#[derive(Debug)]
pub(super) enum Fault {
    /// The bytes at `offset` break the format.
    Broken { section: &'static str, offset: usize, reason: String },
    /// Well formed, but not something that can be shown.
    Unsupported(String),
    /// The caller cancelled.
    Cancelled,
    /// The file can no longer be read.
    Io(std::io::Error),
    /// Bytes up to this offset are needed, and not in memory; [`Reader`](super::reader::Reader)
    /// reads them and tries again.
    Beyond(usize),
}

pub(super) type Result<T, E = Fault> = std::result::Result<T, E>;

impl Fault {
    /// The error for the user. `grid` is empty for what belongs to the file as a whole.
    pub fn into_error(self, file: &str, grid: &str) -> Error {
        let of_grid = if grid.is_empty() { String::new() } else { format!("grid '{grid}'") };
        match self {
            Self::Broken { section, offset, reason } => {
                let comma = if of_grid.is_empty() { "" } else { ", " };
                let field = format!("{of_grid}{comma}{section}");
                Error::invalid(file, field, format!("at byte {offset}: {reason}"))
            }
            Self::Unsupported(reason) => Error::unsupported(file, of_grid, reason),
            Self::Cancelled => Error::Cancelled,
            Self::Io(error) => Error::io(file, error),
            Self::Beyond(offset) => {
                Error::invalid(file, of_grid, format!("at byte {offset}: the file is cut short"))
            }
        }
    }
}

impl From<Error> for Fault {
    /// Converts errors that name neither file nor grid, such as those of the grid builder.
    fn from(error: Error) -> Self {
        match error {
            Error::Cancelled => Self::Cancelled,
            Error::Unsupported { reason, .. } => Self::Unsupported(reason),
            other => Self::Broken { section: "tree", offset: 0, reason: other.to_string() },
        }
    }
}

/// Reads values one after another, little-endian; every failure names the section and the offset.
#[derive(Clone)]
pub(super) struct Stream<'a> {
    /// The bytes of the file from `start` on that are in memory.
    bytes: &'a [u8],
    start: usize,
    /// Offsets in the file: of the next byte, and where the last one that may be read ends.
    position: usize,
    end: usize,
    section: &'static str,
}

impl<'a> Stream<'a> {
    /// A stream over the bytes up to `end` of a file, of which only `bytes`, from `start` on, are
    /// in memory.
    pub fn part(
        bytes: &'a [u8],
        start: usize,
        position: usize,
        end: usize,
        section: &'static str,
    ) -> Self {
        Self { bytes, start, position: position.min(end), end, section }
    }

    /// A stream over bytes that are all in memory.
    #[cfg(test)]
    pub fn new(bytes: &'a [u8], position: usize, section: &'static str) -> Self {
        Self::part(bytes, 0, position, bytes.len(), section)
    }

    /// Names the section that is read from here on.
    pub fn enter(&mut self, section: &'static str) {
        self.section = section;
    }

    pub fn position(&self) -> usize {
        self.position
    }

    /// The bytes that are left.
    pub fn rest(&self) -> std::ops::Range<usize> {
        self.position..self.end
    }

    pub fn remaining(&self) -> usize {
        self.end - self.position
    }

    /// A fault at this place.
    pub fn broken(&self, reason: impl Into<String>) -> Fault {
        Fault::Broken { section: self.section, offset: self.position, reason: reason.into() }
    }

    /// The next `count` bytes, without a copy.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        if count > self.remaining() {
            return Err(self.broken(format!(
                "{count} bytes expected where {} are left; the file is cut short or damaged, \
                 export or copy it again",
                self.remaining()
            )));
        }
        let first = self.position.checked_sub(self.start);
        let taken = first.and_then(|first| self.bytes.get(first..first + count));
        let Some(taken) = taken else { return Err(Fault::Beyond(self.position + count)) };
        self.position += count;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub fn u8(&mut self) -> Result<u8> {
        self.array().map(u8::from_le_bytes)
    }

    pub fn u32(&mut self) -> Result<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn i32(&mut self) -> Result<i32> {
        self.array().map(i32::from_le_bytes)
    }

    pub fn i64(&mut self) -> Result<i64> {
        self.array().map(i64::from_le_bytes)
    }

    pub fn f64(&mut self) -> Result<f64> {
        self.array().map(f64::from_le_bytes)
    }

    /// A count that is stored in 32 bits, each item of which takes at least `item_bytes`.
    pub fn count(&mut self, item_bytes: usize) -> Result<usize> {
        let count = self.u32()? as usize;
        if count.saturating_mul(item_bytes) > self.remaining() {
            return Err(self.broken(format!(
                "{count} items announced where {} bytes are left; the file is damaged, export or \
                 copy it again",
                self.remaining()
            )));
        }
        Ok(count)
    }

    /// A text with its length before it; what is not UTF-8 is replaced.
    pub fn text(&mut self) -> Result<String> {
        let length = self.count(1)?;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}
