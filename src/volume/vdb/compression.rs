//! The codecs that buffers of values are stored with.

use super::stream::{Result, Stream};
use crate::volume::packing::blosc;
use crate::volume::packing::inflate::Inflate;

/// The compression flags of a file or a grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compression(u32);

impl Compression {
    pub const NONE: Self = Self(0);
    pub const ZIP: Self = Self(1);
    const ACTIVE_MASK: u32 = 2;
    const BLOSC: u32 = 4;

    pub fn read(stream: &mut Stream) -> Result<Self> {
        stream.enter("compression");
        let flags = stream.u32()?;
        if flags & !(Self::ZIP.0 | Self::ACTIVE_MASK | Self::BLOSC) != 0 {
            return Err(stream.broken(format!("unknown compression flags {flags:#x}")));
        }
        Ok(Self(flags))
    }

    pub fn is_zip(self) -> bool {
        self.0 & Self::ZIP.0 != 0
    }

    /// Whether inactive values are left out of the buffers.
    pub fn has_active_mask(self) -> bool {
        self.0 & Self::ACTIVE_MASK != 0
    }

    /// Finds the next buffer, of `length` bytes when unpacked, without unpacking it.
    pub fn buffer<'a>(self, stream: &mut Stream<'a>, length: usize) -> Result<Buffer<'a>> {
        let is_blosc = self.0 & Self::BLOSC != 0;
        if !is_blosc && !self.is_zip() {
            return Ok(Buffer { packing: Packing::None, bytes: stream.take(length)?, length });
        }
        let packed = stream.i64()?;
        let bytes = stream.take(usize::try_from(packed.unsigned_abs()).unwrap_or(usize::MAX))?;
        // A negative size says that the bytes were not worth compressing.
        let packing = match (packed > 0, is_blosc) {
            (false, _) if bytes.len() != length => {
                let reason = format!("a buffer of {} bytes instead of {length}", bytes.len());
                return Err(stream.broken(reason));
            }
            (false, _) => Packing::None,
            (true, true) => Packing::Blosc,
            (true, false) => Packing::Zip,
        };
        Ok(Buffer { packing, bytes, length })
    }
}

#[derive(Clone, Copy)]
enum Packing {
    None,
    Zip,
    Blosc,
}

/// A buffer as stored in the file.
#[derive(Clone, Copy)]
pub(super) struct Buffer<'a> {
    packing: Packing,
    bytes: &'a [u8],
    length: usize,
}

impl Buffer<'_> {
    /// A buffer that takes no bytes in the file.
    pub const EMPTY: Self = Self { packing: Packing::None, bytes: &[], length: 0 };
}

/// Unpacks buffers, keeping its working memory from one to the next.
#[derive(Default)]
pub(super) struct Codec {
    inflate: Inflate,
    unpacked: Vec<u8>,
    blosc: blosc::Scratch,
}

impl Codec {
    /// The bytes of a buffer, exactly as many as it promised; the reason if it cannot be unpacked.
    pub fn unpack<'b>(&'b mut self, buffer: &Buffer<'b>) -> Result<&'b [u8], String> {
        if let Packing::None = buffer.packing {
            return Ok(buffer.bytes);
        }
        self.unpacked.clear();
        self.unpacked.resize(buffer.length, 0);
        match buffer.packing {
            Packing::Zip => {
                if !self.inflate.unpack(buffer.bytes, &mut self.unpacked) {
                    return Err("damaged zlib data; export or copy the file again".into());
                }
            }
            _ => blosc::decompress(buffer.bytes, &mut self.unpacked, &mut self.blosc)?,
        }
        Ok(&self.unpacked)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn stored(packed: &[u8], size: i64) -> Vec<u8> {
        let mut bytes = size.to_le_bytes().to_vec();
        bytes.extend(packed);
        bytes
    }

    fn unpack(flags: u32, bytes: &[u8], length: usize) -> Result<Vec<u8>, String> {
        let mut stream = Stream::new(bytes, 0, "");
        let buffer = Compression(flags).buffer(&mut stream, length);
        let buffer = buffer.map_err(|fault| format!("{fault:?}"))?;
        let mut codec = Codec::default();
        codec.unpack(&buffer).map(<[u8]>::to_vec)
    }

    #[test]
    fn zipped_and_plain_buffers() {
        let data: Vec<u8> = (0..2000_u32).map(|i| (i / 7) as u8).collect();
        let mut zip = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        zip.write_all(&data).unwrap();
        let zip = zip.finish().unwrap();
        let bytes = stored(&zip, zip.len() as i64);
        assert_eq!(unpack(1, &bytes, 2000).unwrap(), data);
        assert!(unpack(1, &bytes, 1999).is_err(), "longer than promised");
        assert!(unpack(1, &bytes, 2001).is_err(), "shorter than promised");
        let cut = stored(&zip[..zip.len() - 1], zip.len() as i64 - 1);
        assert!(unpack(1, &cut, 2000).is_err(), "without its checksum");
        assert_eq!(unpack(0, &data, 2000).unwrap(), data);
        for codec in [1, 4] {
            assert_eq!(unpack(codec, &stored(&data, -2000), 2000).unwrap(), data);
            assert!(unpack(codec, &stored(&data, -2000), 1000).is_err());
            assert!(unpack(codec, &stored(&data, i64::MIN), 2000).is_err());
            assert!(unpack(codec, &stored(&data, i64::MAX), 2000).is_err());
            assert_eq!(unpack(codec, &stored(&[], 0), 0).unwrap(), [0; 0]);
        }
    }
}
