//! Header of a file: its magic number, and the layout of the rest.

use super::compression::Compression;
use super::stream::{Fault, Result, Stream};

/// The versions of the format that are read. Older ones have other layouts; 220 was OpenVDB 2.0.
const VERSIONS: std::ops::RangeInclusive<u32> = 220..=225;
/// From this version on nodes are compressed by their masks and grids name their own compression.
const NODE_MASK_COMPRESSION: u32 = 222;
const MAGIC: [u8; 8] = *b" BDV\0\0\0\0";
const UUID_LENGTH: usize = 36;

/// Properties that all grids of a file share.
#[derive(Clone, Copy, Debug)]
pub(super) struct VdbHeader {
    pub version: u32,
    /// Whether each grid stores where it ends.
    pub has_offsets: bool,
    /// Compression, for versions whose grids do not store their own.
    pub compression: Compression,
}

impl VdbHeader {
    pub fn read(stream: &mut Stream) -> Result<Self> {
        stream.enter("header");
        check_magic(stream)?;
        let version = stream.u32()?;
        check_version(version).map_err(Fault::Unsupported)?;
        let _library_version = stream.take(8)?;
        let has_offsets = stream.u8()? != 0;
        let zipped = version < NODE_MASK_COMPRESSION && stream.u8()? != 0;
        let compression = if zipped { Compression::ZIP } else { Compression::NONE };
        let _uuid = stream.take(UUID_LENGTH)?;
        Ok(Self { version, has_offsets, compression })
    }

    /// Whether nodes are compressed by their masks.
    pub fn has_node_masks(&self) -> bool {
        self.version >= NODE_MASK_COMPRESSION
    }
}

/// Whether a file that starts with these bytes is an OpenVDB file.
pub(in crate::volume) fn is_openvdb(start: &[u8]) -> bool {
    start.starts_with(&MAGIC)
}

/// Whether a file that starts with these bytes may be an OpenVDB file of a version that is read;
/// the reason if it is none.
pub(in crate::volume) fn check_start(start: &[u8]) -> Result<(), String> {
    check_first_bytes(start)?;
    match start.get(MAGIC.len()..).and_then(|rest| rest.first_chunk()) {
        Some(&version) => check_version(u32::from_le_bytes(version)),
        None => Ok(()),
    }
}

fn check_version(version: u32) -> Result<(), String> {
    if VERSIONS.contains(&version) {
        return Ok(());
    }
    let (first, last) = (VERSIONS.start(), VERSIONS.end());
    Err(format!(
        "version {version} of the file format, versions {first} to {last} are read; save the file \
         again with OpenVDB 2.0 or newer, in a format up to {last}"
    ))
}

fn check_first_bytes(start: &[u8]) -> Result<(), String> {
    let reason = if start.is_empty() {
        "the file is empty; export or copy it again"
    } else if start.starts_with(b"version https://git-lfs") {
        "this is a Git LFS pointer, not the volume itself; fetch the file with `git lfs pull`"
    } else if start.len() >= MAGIC.len() && !start.starts_with(&MAGIC) {
        "this is no volume, neither of OpenVDB nor of NanoVDB (its first bytes differ); choose a \
         .vdb or .nvdb file"
    } else {
        return Ok(());
    };
    Err(reason.to_owned())
}

fn check_magic(stream: &mut Stream) -> Result<()> {
    let start = stream.clone().take(stream.remaining().min(24))?;
    check_first_bytes(start).map_err(|reason| stream.broken(reason))?;
    stream.take(MAGIC.len()).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(version: u32) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(version.to_le_bytes());
        bytes.extend([0; 8]);
        bytes.push(1);
        if version < NODE_MASK_COMPRESSION {
            bytes.push(1);
        }
        bytes.extend([b'-'; UUID_LENGTH]);
        bytes
    }

    fn read(bytes: &[u8]) -> Result<VdbHeader> {
        VdbHeader::read(&mut Stream::new(bytes, 0, ""))
    }

    #[test]
    fn old_versions_say_for_the_whole_file_whether_it_is_zipped() {
        let old = read(&header(220)).unwrap();
        assert!(old.compression.is_zip() && old.has_offsets && !old.has_node_masks());
        let new = read(&header(225)).unwrap();
        assert!(!new.compression.is_zip() && new.has_node_masks());
    }

    #[test]
    fn what_is_no_vdb_gets_its_own_message() {
        let message = |bytes: &[u8]| read(bytes).unwrap_err().into_error("f.vdb", "").to_string();
        assert!(message(b"").contains("empty"));
        assert!(message(b"version https://git-lfs.github.com/spec/v1\n").contains("git lfs pull"));
        assert!(message(b"\x89PNG\r\n\x1a\n....").contains("no volume"));
        assert!(message(b" BDV").contains("cut short"));
        assert!(message(&header(219)).contains("version 219"));
        assert!(message(&header(999)).contains("220 to 225"));
        let full = header(224);
        (0..full.len()).for_each(|length| assert!(read(&full[..length]).is_err()));
    }
}
