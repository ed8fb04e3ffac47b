//! The Blosc 1 container: blocks of LZ4 or zlib data whose bytes were shuffled.
//!
//! Layout, after the header format that the c-blosc project publishes: 16 bytes of header (format
//! version, codec version, flags, size of an item, then three 32-bit sizes: unpacked, of a block,
//! packed), the start of each block, and the blocks. A block is one stream or one for each byte of
//! an item, each after its packed size.

use super::inflate::Inflate;

const HEADER: usize = 16;
const SHUFFLED: u8 = 1;
const COPIED: u8 = 2;
const BIT_SHUFFLED: u8 = 4;
const NOT_SPLIT: u8 = 16;
/// Blocks are split into one stream a byte only up to this size of an item, and ...
const MAX_SPLITS: usize = 16;
/// ... if each stream has at least this many bytes.
const MIN_STREAM: usize = 128;

/// Working memory, kept from one buffer to the next.
#[derive(Default)]
pub(in crate::volume) struct Scratch {
    shuffled: Vec<u8>,
    inflate: Inflate,
}

#[derive(Clone, Copy)]
enum Inner {
    Lz4,
    Zlib,
}

struct BloscHeader {
    flags: u8,
    item: usize,
    block: usize,
    inner: Option<Inner>,
}

/// Unpacks `source`, which must fill `target` exactly; the reason if it does not.
pub(in crate::volume) fn decompress(
    source: &[u8],
    target: &mut [u8],
    scratch: &mut Scratch,
) -> Result<(), String> {
    let container = Container::open(source, target.len())?;
    let mut blocks = target.chunks_mut(container.block_bytes()).enumerate();
    blocks.try_for_each(|(number, block)| container.unpack_block(number, block, scratch))
}

/// A container whose blocks can be unpacked one by one.
pub(in crate::volume) struct Container<'a> {
    source: &'a [u8],
    header: BloscHeader,
}

impl<'a> Container<'a> {
    /// Reads the header of a container that holds `unpacked` bytes; the reason if it does not.
    pub fn open(source: &'a [u8], unpacked: usize) -> Result<Self, String> {
        Ok(Self { source, header: read_header(source, unpacked)? })
    }

    /// The length of all blocks but the last one, which may be shorter.
    pub fn block_bytes(&self) -> usize {
        self.header.block
    }

    /// Unpacks the block of that number, of which `block` must have the length.
    pub fn unpack_block(
        &self,
        number: usize,
        block: &mut [u8],
        scratch: &mut Scratch,
    ) -> Result<(), String> {
        let Self { source, header } = self;
        let Some(inner) = header.inner else {
            let start = HEADER + number * header.block;
            let plain = source.get(start..start + block.len()).ok_or_else(damaged)?;
            block.copy_from_slice(plain);
            return Ok(());
        };
        let start = word(source, HEADER + 4 * number).ok_or_else(damaged)?;
        let packed = source.get(start..).ok_or_else(damaged)?;
        decompress_block(packed, block, header, inner, scratch)
    }
}

fn read_header(source: &[u8], expected: usize) -> Result<BloscHeader, String> {
    let &[version, _, flags, item, ..] = source else { return Err(damaged()) };
    let sizes = (word(source, 4), word(source, 8), word(source, 12));
    let (Some(unpacked), Some(block), Some(packed)) = sizes else { return Err(damaged()) };
    if version > 2 {
        return Err(format!("Blosc data of version {version}, only 1 and 2 are read"));
    }
    if unpacked != expected || packed > source.len() || block == 0 || item == 0 {
        return Err(damaged());
    }
    let inner = match (flags & COPIED != 0, flags >> 5) {
        (true, _) => None,
        (false, 1) => Some(Inner::Lz4),
        (false, 3) => Some(Inner::Zlib),
        (false, other) => {
            let name = ["BloscLZ", "", "Snappy", "", "Zstandard"].get(other as usize);
            return Err(format!(
                "Blosc data packed with {}, only LZ4 and zlib are read; save the file again with \
                 OpenVDB's own compression",
                name.unwrap_or(&"an unknown codec")
            ));
        }
    };
    Ok(BloscHeader { flags, item: item.into(), block, inner })
}

fn damaged() -> String {
    "damaged Blosc data; export or copy the file again".into()
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word = bytes.get(at..)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*word)).ok()
}

fn decompress_block(
    mut packed: &[u8],
    block: &mut [u8],
    header: &BloscHeader,
    inner: Inner,
    scratch: &mut Scratch,
) -> Result<(), String> {
    let Scratch { shuffled, inflate } = scratch;
    let bits = header.flags & BIT_SHUFFLED != 0;
    let shuffle = bits || (header.flags & SHUFFLED != 0 && header.item > 1);
    shuffled.resize(block.len(), 0);
    let streams = if shuffle { &mut **shuffled } else { &mut *block };
    let length = streams.len();
    let split = header.flags & NOT_SPLIT == 0
        && length == header.block
        && header.item <= MAX_SPLITS
        && length / header.item >= MIN_STREAM;
    let count = if split { header.item } else { 1 };
    if !length.is_multiple_of(count) {
        return Err(damaged());
    }
    for stream in streams.chunks_mut(length / count) {
        let size = word(packed, 0).ok_or_else(damaged)?;
        let bytes = packed.get(4..4 + size).ok_or_else(damaged)?;
        packed = &packed[4 + size..];
        decompress_stream(bytes, stream, inner, inflate)?;
    }
    match (shuffle, bits) {
        (true, true) => unshuffle_bits(shuffled, block, header.item),
        (true, false) => unshuffle_bytes(shuffled, block, header.item),
        (false, _) => {}
    }
    Ok(())
}

fn decompress_stream(
    bytes: &[u8],
    stream: &mut [u8],
    inner: Inner,
    inflate: &mut Inflate,
) -> Result<(), String> {
    if bytes.len() == stream.len() {
        stream.copy_from_slice(bytes);
        return Ok(());
    }
    let complete = match inner {
        Inner::Lz4 => {
            lz4_flex::block::decompress_into(bytes, stream).is_ok_and(|n| n == stream.len())
        }
        Inner::Zlib => inflate.unpack(bytes, stream),
    };
    if complete { Ok(()) } else { Err(damaged()) }
}

/// Undoes the byte shuffle: from all first bytes, all second bytes, ... back to whole items; an
/// incomplete one stays last.
fn unshuffle_bytes(source: &[u8], target: &mut [u8], item: usize) {
    let items = source.len() / item;
    let (source, source_rest) = source.split_at(items * item);
    let (target, target_rest) = target.split_at_mut(items * item);
    for (byte, plane) in source.chunks_exact(items.max(1)).enumerate() {
        for (item, &value) in target.chunks_exact_mut(item).zip(plane) {
            item[byte] = value;
        }
    }
    target_rest.copy_from_slice(source_rest);
}

/// Undoes the bit shuffle: from all lowest bits, all second bits, ... back to whole items. Blocks
/// whose items are no multiple of 8 were never shuffled.
fn unshuffle_bits(source: &[u8], target: &mut [u8], item: usize) {
    let items = source.len() / item;
    if items == 0 || !items.is_multiple_of(8) {
        target.copy_from_slice(source);
        return;
    }
    let (source, source_rest) = source.split_at(items * item);
    let (target, target_rest) = target.split_at_mut(items * item);
    target.fill(0);
    for (bit, plane) in source.chunks_exact(items / 8).enumerate() {
        for (number, item) in target.chunks_exact_mut(item).enumerate() {
            item[bit / 8] |= (plane[number / 8] >> (number % 8) & 1) << (bit % 8);
        }
    }
    target_rest.copy_from_slice(source_rest);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Options for packing a test blob.
    struct Pack {
        flags: u8,
        item: usize,
        block: usize,
    }

    impl Pack {
        fn pack(&self, data: &[u8]) -> Vec<u8> {
            let blocks: Vec<_> = data.chunks(self.block).map(|block| self.block(block)).collect();
            let mut starts = Vec::new();
            let mut body = Vec::new();
            let first = HEADER + 4 * blocks.len();
            for block in &blocks {
                starts.extend(((first + body.len()) as u32).to_le_bytes());
                body.extend(block);
            }
            let mut bytes = vec![2, 1, self.flags, self.item as u8];
            for size in [data.len(), self.block, first + body.len()] {
                bytes.extend((size as u32).to_le_bytes());
            }
            [bytes, starts, body].concat()
        }

        fn block(&self, block: &[u8]) -> Vec<u8> {
            let shuffled = self.shuffle(block);
            let split = self.flags & NOT_SPLIT == 0
                && block.len() == self.block
                && block.len() / self.item >= MIN_STREAM;
            let count = if split { self.item } else { 1 };
            let mut bytes = Vec::new();
            for stream in shuffled.chunks(block.len() / count) {
                let mut packed = match self.flags >> 5 {
                    1 => lz4_flex::block::compress(stream),
                    _ => zlib(stream),
                };
                if packed.len() >= stream.len() {
                    packed = stream.to_vec();
                }
                bytes.extend((packed.len() as u32).to_le_bytes());
                bytes.extend(packed);
            }
            bytes
        }

        fn shuffle(&self, block: &[u8]) -> Vec<u8> {
            let items = block.len() / self.item;
            let mut out = block.to_vec();
            if self.flags & BIT_SHUFFLED != 0 && items.is_multiple_of(8) {
                out[..items * self.item].fill(0);
                for n in 0..items {
                    for bit in 0..8 * self.item {
                        let value = block[n * self.item + bit / 8] >> (bit % 8) & 1;
                        out[bit * items / 8 + n / 8] |= value << (n % 8);
                    }
                }
            } else if self.flags & SHUFFLED != 0 {
                for n in 0..items {
                    for byte in 0..self.item {
                        out[byte * items + n] = block[n * self.item + byte];
                    }
                }
            }
            out
        }
    }

    fn zlib(bytes: &[u8]) -> Vec<u8> {
        use std::io::Write;
        let mut zip = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        zip.write_all(bytes).unwrap();
        zip.finish().unwrap()
    }

    fn data(length: usize) -> Vec<u8> {
        (0..length as u32)
            .flat_map(|i| ((i as f32 * 0.01).sin() * f32::from(i % 9 != 0)).to_le_bytes())
            .take(length)
            .collect()
    }

    fn unpack(source: &[u8], length: usize) -> Result<Vec<u8>, String> {
        let mut target = vec![0xAA; length];
        decompress(source, &mut target, &mut Scratch::default()).map(|()| target)
    }

    #[test]
    fn every_codec_shuffle_and_split() {
        for codec in [1_u8, 3] {
            for shuffle in [0, SHUFFLED, BIT_SHUFFLED] {
                for split in [0, NOT_SPLIT] {
                    for (length, item, block) in [
                        (2048, 4, 2048),
                        (1027, 2, 256),
                        (3000, 4, 1024),
                        (100, 12, 48),
                        (64, 1, 64),
                    ] {
                        let flags = codec << 5 | shuffle | split;
                        let data = data(length);
                        let packed = Pack { flags, item, block }.pack(&data);
                        let unpacked = unpack(&packed, length);
                        assert_eq!(unpacked.unwrap(), data, "{flags:#x} {length} {item} {block}");
                    }
                }
            }
        }
    }

    #[test]
    fn copied_data_follows_the_header() {
        let data = data(500);
        let mut bytes = vec![2, 1, COPIED | 1 << 5, 4];
        for size in [500_u32, 500, 516] {
            bytes.extend(size.to_le_bytes());
        }
        bytes.extend(&data);
        assert_eq!(unpack(&bytes, 500).unwrap(), data);
        assert!(unpack(&bytes[..515], 500).is_err());
    }

    #[test]
    fn damage_is_found_or_harmless() {
        let data = data(1000);
        let packed = Pack { flags: 1 << 5 | SHUFFLED, item: 4, block: 512 }.pack(&data);
        assert_eq!(unpack(&packed, 1000).unwrap(), data);
        assert!(unpack(&packed, 1001).is_err() && unpack(&packed, 999).is_err());
        (0..packed.len()).for_each(|length| assert!(unpack(&packed[..length], 1000).is_err()));
        for at in 0..packed.len() {
            for bit in 0..8 {
                let mut damaged = packed.clone();
                damaged[at] ^= 1 << bit;
                let _any_result_without_a_panic = unpack(&damaged, 1000);
            }
        }
    }

    #[test]
    fn other_codecs_are_refused_by_name() {
        let mut packed = Pack { flags: 1 << 5, item: 4, block: 512 }.pack(&data(512));
        packed[2] = 4 << 5;
        assert!(unpack(&packed, 512).unwrap_err().contains("Zstandard"));
    }
}
