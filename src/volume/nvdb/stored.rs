//! A grid as its file stores it, and how it is unpacked.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::bytes::{Bytes, broken};
use crate::error::{Error, Progress, Result, report};
use crate::files::reserve;
use crate::volume::packing::blosc::{Container, Scratch};
use crate::volume::packing::inflate::{Inflate, Outcome};

/// How the grids of a segment are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    None,
    Zip,
    Blosc,
}

impl Codec {
    /// The codec of that number.
    pub fn of(number: u16) -> Option<Self> {
        [Self::None, Self::Zip, Self::Blosc].get(usize::from(number)).copied()
    }

    /// More than the most bytes that one packed byte can stand for.
    fn most_bytes(self) -> usize {
        match self {
            Self::None => 1,
            Self::Zip => 1040,
            Self::Blosc => 260,
        }
    }
}

/// A grid in its file.
#[derive(Clone, Debug)]
pub(super) struct StoredGrid {
    /// The name in the segment; empty in a buffer.
    pub name: String,
    pub codec: Codec,
    /// The bytes of the file that hold it.
    pub packed: Range<usize>,
    /// Its size when unpacked.
    pub length: usize,
}

/// Blosc containers hold at most this many bytes.
const PIECE: usize = 1 << 30;

impl StoredGrid {
    /// The first `count` bytes of the grid, or all if it is shorter.
    pub fn start<'a>(&self, file: Bytes<'a>, count: usize) -> Result<Cow<'a, [u8]>> {
        let packed = self.packed(file)?;
        let count = count.min(self.length);
        if self.codec == Codec::None {
            return packed.slice(0, count).map(Cow::Borrowed);
        }
        let stream = self.stream(packed, 0)?;
        let mut start = vec![0; count];
        if self.codec == Codec::Zip {
            return match Inflate::default().unpack_start(stream, &mut start) {
                true => Ok(Cow::Owned(start)),
                false => Err(self.damaged("zlib data that is damaged")),
            };
        }
        let container = self.container(stream, self.length.min(PIECE))?;
        let block_bytes = container.block_bytes().min(self.length.min(PIECE));
        let mut block = zeros(block_bytes)?;
        let mut scratch = Scratch::default();
        for (number, part) in start.chunks_mut(block_bytes).enumerate() {
            let unpacked = container.unpack_block(number, &mut block, &mut scratch);
            unpacked.map_err(|reason| self.damaged(&reason))?;
            part.copy_from_slice(&block[..part.len()]);
        }
        Ok(Cow::Owned(start))
    }

    /// The whole grid.
    pub fn unpack<'a>(&self, file: Bytes<'a>, progress: Progress) -> Result<Cow<'a, [u8]>> {
        let packed = self.packed(file)?;
        if self.codec == Codec::None {
            return packed.slice(0, self.length).map(Cow::Borrowed);
        }
        let mut unpacked = zeros(self.length)?;
        let part = |done: usize| progress(done as f32 / self.length.max(1) as f32);
        if self.codec == Codec::Zip {
            let stream = self.stream(packed, 0)?;
            return match Inflate::default().unpack_while(stream, &mut unpacked, part) {
                Outcome::Complete => Ok(Cow::Owned(unpacked)),
                Outcome::Damaged => Err(self.damaged("zlib data that is damaged")),
                Outcome::Stopped => Err(Error::Cancelled),
            };
        }
        let mut at = 0;
        for piece in unpacked.chunks_mut(PIECE) {
            let stream = self.stream(packed, at)?;
            at += 8 + stream.len();
            let container = self.container(stream, piece.len())?;
            self.unpack_container(&container, piece, &part)?;
        }
        Ok(Cow::Owned(unpacked))
    }

    fn unpack_container(
        &self,
        container: &Container,
        piece: &mut [u8],
        part: &(dyn Fn(usize) -> bool + Sync),
    ) -> Result<()> {
        let done = AtomicUsize::new(0);
        piece.par_chunks_mut(container.block_bytes()).enumerate().try_for_each_init(
            Scratch::default,
            |scratch, (number, block)| {
                let done = done.fetch_add(block.len(), Ordering::Relaxed);
                report(&|_| part(done), 0.0)?;
                let unpacked = container.unpack_block(number, block, scratch);
                unpacked.map_err(|reason| self.damaged(&reason))
            },
        )
    }

    /// The packed bytes, which the promised length must fit.
    fn packed<'a>(&self, file: Bytes<'a>) -> Result<Bytes<'a>> {
        let packed = file.slice(self.packed.start, self.packed.len())?;
        if self.length > packed.len().saturating_mul(self.codec.most_bytes()) {
            let reason = format!("{} bytes that should hold {}", packed.len(), self.length);
            return Err(self.damaged(&reason));
        }
        Ok(Bytes(packed))
    }

    /// The packed stream at `at`, behind its length.
    fn stream<'a>(&self, packed: Bytes<'a>, at: usize) -> Result<&'a [u8]> {
        packed.slice(at + 8, packed.size(at)?)
    }

    fn container<'a>(&self, stream: &'a [u8], length: usize) -> Result<Container<'a>> {
        Container::open(stream, length).map_err(|reason| self.damaged(&reason))
    }

    fn damaged(&self, what: &str) -> Error {
        broken(self.packed.start, format!("{what}; export or copy the file again"))
    }
}

fn zeros(length: usize) -> Result<Vec<u8>> {
    let mut bytes = reserve(length).map_err(|reason| Error::unsupported("", "", reason))?;
    bytes.resize(length, 0);
    Ok(bytes)
}
