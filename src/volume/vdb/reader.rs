//! Reads a file piece by piece, so that no more of it is in memory than is being decoded.

use std::borrow::Cow;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

use super::stream::{Fault, Result, Stream};

/// Bytes read at a time of lists of grids and of trees, unless something needs more.
const LIST_PIECE: usize = 64 << 10;
const TREE_PIECE: usize = 4 << 20;

/// Bytes of a file: in memory, or on a disk and opened.
pub(super) enum Source {
    Memory(Cow<'static, [u8]>),
    Disk(OpenFile),
}

/// A file and its state when it was opened.
pub(super) struct OpenFile {
    file: Mutex<File>,
    length: u64,
    modified: Option<SystemTime>,
}

impl Source {
    /// The bytes of an open file.
    pub fn of_file(file: File) -> std::io::Result<Self> {
        let metadata = file.metadata()?;
        let (length, modified) = (metadata.len(), metadata.modified().ok());
        Ok(Self::Disk(OpenFile { file: Mutex::new(file), length, modified }))
    }

    fn length(&self) -> usize {
        match self {
            Self::Memory(bytes) => bytes.len(),
            Self::Disk(file) => usize::try_from(file.length).unwrap_or(usize::MAX),
        }
    }

    /// Whether the file was written to since it was opened; what is read of it then fits nothing.
    pub fn has_changed(&self) -> bool {
        let Self::Disk(open) = self else { return false };
        let file = open.file.lock().unwrap_or_else(PoisonError::into_inner);
        let now = file.metadata();
        !now.is_ok_and(|now| now.len() == open.length && now.modified().ok() == open.modified)
    }
}

impl OpenFile {
    /// Reads as many bytes from `offset` on as fit and are there.
    fn read(&self, offset: usize, length: usize, piece: &mut Vec<u8>) -> Result<()> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset as u64)).map_err(Fault::Io)?;
        piece.clear();
        piece.reserve_exact(length);
        (&mut *file).take(length as u64).read_to_end(piece).map_err(Fault::Io)?;
        Ok(())
    }
}

/// A position in a file, and the piece of it in memory.
pub(super) struct Reader<'a> {
    source: &'a Source,
    position: usize,
    end: usize,
    /// Bytes of a file on a disk from `piece_start` on.
    piece: Vec<u8>,
    piece_start: usize,
    /// Bytes to read at a time.
    piece_length: usize,
}

impl<'a> Reader<'a> {
    /// A reader of a whole file, for its list of grids.
    pub fn of_list(source: &'a Source) -> Self {
        Self::new(source, 0..source.length(), LIST_PIECE)
    }

    /// A reader of the bytes of a tree.
    pub fn of_tree(source: &'a Source, bytes: Range<usize>) -> Self {
        Self::new(source, bytes, TREE_PIECE)
    }

    fn new(source: &'a Source, bytes: Range<usize>, piece_length: usize) -> Self {
        let (position, end) = (bytes.start, bytes.end.min(source.length()));
        Self { source, position, end, piece: Vec::new(), piece_start: position, piece_length }
    }

    /// A reader of the bytes from `start` to `end` of the file, which must lie ahead.
    pub fn window(&self, start: i64, end: i64) -> Result<Self> {
        let bounds = usize::try_from(start).ok().zip(usize::try_from(end).ok());
        match bounds {
            Some((start, end)) if self.position <= start && start <= end && end <= self.end => {
                Ok(Self::new(self.source, start..end, self.piece_length))
            }
            _ => Err(Fault::Broken {
                section: "list of grids",
                offset: self.position,
                reason: format!(
                    "the grid should lie between bytes {start} and {end} of a file of {} bytes; \
                     the file is cut short or damaged, export or copy it again",
                    self.end
                ),
            }),
        }
    }

    /// Goes on behind the last byte of `window`.
    pub fn skip(&mut self, window: &Reader) {
        self.position = self.position.max(window.end);
    }

    /// Share of the bytes that have been read.
    pub fn fraction(&self, start: usize) -> f32 {
        (self.position - start) as f32 / (self.end - start).max(1) as f32
    }

    pub fn position(&self) -> usize {
        self.position
    }

    /// Takes a step from the position on. It is taken again with more bytes where those in memory
    /// did not suffice, so it must change nothing before it has read all that it reads.
    pub fn step<T>(
        &mut self,
        section: &'static str,
        mut step: impl FnMut(&mut Stream) -> Result<T>,
    ) -> Result<T> {
        let mut least = 0;
        loop {
            let (bytes, start) = match self.source {
                Source::Memory(bytes) => (&**bytes, 0),
                Source::Disk(_) => (&*self.piece, self.piece_start),
            };
            let mut stream = Stream::part(bytes, start, self.position, self.end, section);
            match step(&mut stream) {
                Err(Fault::Beyond(needed)) => {
                    // Twice as much each time keeps the steps few.
                    least = (needed - self.position).max(2 * least);
                    self.refill(least)?;
                }
                done => {
                    self.position = stream.position();
                    return done;
                }
            }
        }
    }

    /// Reads at least `least` bytes from the position on, or all that are left.
    fn refill(&mut self, least: usize) -> Result<()> {
        let Source::Disk(file) = self.source else { return Ok(()) };
        let length = least.max(self.piece_length).min(self.end - self.position);
        file.read(self.position, length, &mut self.piece)?;
        self.piece_start = self.position;
        if self.piece.len() < length {
            return Err(Fault::Io(std::io::ErrorKind::UnexpectedEof.into()));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_file_is_read_in_pieces_wherever_they_end() {
        let bytes: Vec<u8> = (0..200_000_u32).flat_map(|n| n.to_le_bytes()).collect();
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(&bytes).unwrap();
        let source = Source::of_file(file.reopen().unwrap()).unwrap();
        let mut reader = Reader::of_list(&source);
        for (step, length) in [3, 70_000, 65_535, 1, 300_000].into_iter().enumerate() {
            let at = reader.position();
            let taken = reader.step("", |stream| {
                let half = length / 2;
                Ok([stream.take(half)?, stream.take(length - half)?].concat())
            });
            assert!(taken.unwrap() == bytes[at..at + length], "step {step}");
        }
        let rest = bytes.len() - reader.position();
        assert!(matches!(
            reader.step("", |s| s.take(rest + 1).map(|_| ())),
            Err(Fault::Broken { .. })
        ));
        assert!(!source.has_changed());
        file.write_all(&[0]).unwrap();
        assert!(source.has_changed());
    }
}
