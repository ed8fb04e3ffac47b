//! The grids of a file, found without unpacking one.

use std::fmt;
use std::ops::Range;

use super::bytes::{Bytes, broken};
use super::layout::GRID_HEADER;
use super::stored::{Codec, StoredGrid};
use crate::error::{Error, Result};

/// Version of the format: 32.4.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Version(u32);

impl Version {
    /// The major version whose layout is read.
    const MAJOR: u32 = 32;

    /// The version as a file has it.
    pub(super) fn read(bytes: Bytes, at: usize) -> Result<Self> {
        bytes.u32(at).map(Self)
    }

    pub(super) fn is_read(self) -> bool {
        self.0 >> 21 == Self::MAJOR
    }

    /// Reason why this version is not read.
    pub(super) fn refusal(self) -> String {
        format!(
            "version {self} of NanoVDB, versions {}.x are read; convert the volume again with \
             OpenVDB 9 or newer",
            Self::MAJOR
        )
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.0 >> 21, self.0 >> 10 & 0x7ff, self.0 & 0x3ff)
    }
}

/// The magic numbers but for their last digit.
const MAGIC: &[u8] = b"NanoVDB";
/// A magic number on a machine that stores numbers the other way round, but for its first digit.
const REVERSED: &[u8] = b"BDVonaN";
const SEGMENT_HEADER: usize = 16;
const ENTRY: usize = 176;
const ENTRY_NAME_SIZE: usize = 136;

/// Whether a file that starts with these bytes calls itself a NanoVDB file.
pub(in crate::volume) fn is_nanovdb(start: &[u8]) -> bool {
    start.starts_with(MAGIC) || start.get(1..8) == Some(REVERSED)
}

/// Whether a file that starts with these bytes may be a NanoVDB file of a version that is read; the
/// reason if it is none.
pub(super) fn check_start(start: &[u8]) -> Result<(), String> {
    match Arrangement::of(Bytes(start)).and_then(|arrangement| arrangement.version(Bytes(start))) {
        Ok(_) | Err(Error::Cancelled) => Ok(()),
        Err(Error::Invalid { reason, .. } | Error::Unsupported { reason, .. }) => Err(reason),
        Err(other) => Err(other.to_string()),
    }
}

/// The arrangement of a file.
enum Arrangement {
    Segments,
    Buffer,
}

/// Finds the grids of a file, and its version.
pub(super) fn find(bytes: Bytes) -> Result<(Version, Vec<StoredGrid>)> {
    let arrangement = Arrangement::of(bytes)?;
    let grids = match arrangement {
        Arrangement::Segments => segments(bytes),
        Arrangement::Buffer => buffer(bytes),
    };
    Ok((arrangement.version(bytes)?, grids?))
}

impl Arrangement {
    fn of(bytes: Bytes) -> Result<Self> {
        let magic = bytes.slice(0, 8)?;
        if magic[1..] == *REVERSED {
            let reason = "a NanoVDB file of a big-endian machine; convert the volume on another";
            return Err(Error::unsupported("", "", reason));
        }
        match (magic.starts_with(MAGIC), magic[7]) {
            (true, b'0') => {}
            (true, b'1') => return Ok(Self::Buffer),
            (true, b'2') => return Ok(Self::Segments),
            _ => {
                let reason = "this is not a NanoVDB file (its first bytes differ); choose a .nvdb \
                              file";
                return Err(broken(0, reason));
            }
        }
        // The old magic number stands for both. The version of a segment lies where a buffer has
        // half of its checksum, so that the codec must fit as well.
        let version = Version::read(bytes, 8)?;
        let codec = bytes.u16(14)?;
        let is_buffer = || Version::read(bytes, 16).is_ok_and(Version::is_read);
        match version.is_read() && Codec::of(codec).is_some() {
            false if is_buffer() => Ok(Self::Buffer),
            _ => Ok(Self::Segments),
        }
    }

    /// The version of the first segment or grid, if it is one that is read.
    fn version(&self, bytes: Bytes) -> Result<Version> {
        let version = Version::read(bytes, if let Self::Segments = self { 8 } else { 16 })?;
        match version.is_read() {
            true => Ok(version),
            false => Err(Error::unsupported("", "", version.refusal())),
        }
    }
}

fn segments(bytes: Bytes) -> Result<Vec<StoredGrid>> {
    let mut grids = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        at = segment(bytes, at, &mut grids)?;
    }
    Ok(grids)
}

/// Finds the grids of the segment at `at`; returns where it ends.
fn segment(bytes: Bytes, at: usize, grids: &mut Vec<StoredGrid>) -> Result<usize> {
    let magic = bytes.slice(at, 8)?;
    if !magic.starts_with(MAGIC) {
        let reason = "no segment where one should start; the file is damaged, export or copy it \
                      again";
        return Err(broken(at, reason));
    }
    let version = Version::read(bytes, at + 8)?;
    if !version.is_read() {
        return Err(Error::unsupported("", "", version.refusal()));
    }
    let (count, codec) = (bytes.u16(at + 12)?, bytes.u16(at + 14)?);
    let Some(codec) = Codec::of(codec) else {
        let reason = format!(
            "grids packed with codec {codec}; save the file again without compression or with \
             that of ZIP or Blosc"
        );
        return Err(Error::unsupported("", "", reason));
    };
    let mut entry = at + SEGMENT_HEADER;
    let mut entries = Vec::new();
    for _ in 0..count {
        let name_length = bytes.u32(entry + ENTRY_NAME_SIZE)? as usize;
        let name = bytes.text(entry + ENTRY, name_length)?;
        entries.push((name, bytes.size(entry)?, bytes.size(entry + 8)?));
        entry += ENTRY + name_length;
    }
    for (name, length, packed) in entries {
        let range = range(bytes, entry, packed)?;
        entry = range.end;
        grids.push(StoredGrid { name, codec, packed: range, length });
    }
    Ok(entry)
}

/// The `length` bytes from `start` on, which must be there.
fn range(bytes: Bytes, start: usize, length: usize) -> Result<Range<usize>> {
    bytes.slice(start, length)?;
    Ok(start..start + length)
}

fn buffer(bytes: Bytes) -> Result<Vec<StoredGrid>> {
    const COUNT: usize = 28;
    const SIZE: usize = 32;
    let count = bytes.u32(COUNT)?.max(1);
    let mut grids = Vec::new();
    let mut at = 0;
    for _ in 0..count {
        bytes.slice(at, GRID_HEADER)?;
        let length = bytes.size(at + SIZE)?;
        if length < GRID_HEADER {
            let reason = format!("a grid of {length} bytes; the file is damaged, export it again");
            return Err(broken(at + SIZE, reason));
        }
        let packed = range(bytes, at, length)?;
        at = packed.end;
        grids.push(StoredGrid { name: String::new(), codec: Codec::None, packed, length });
    }
    Ok(grids)
}
