//! The value buffer of a node: found without unpacking, then decoded into voxels.
//!
//! With mask compression only active values are stored; a code selects the one or two values that
//! inactive voxels have.

use super::compression::{Buffer, Codec, Compression};
use super::stream::{Result, Stream};
use crate::volume::grid::Voxel;
use crate::volume::half::widen_ieee;

/// Storage type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    F16,
    F32,
    F64,
    /// Some other type that is stepped over, never decoded.
    Opaque {
        bytes: usize,
    },
}

/// Layout of the values of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct ValueLayout {
    pub scalar: Scalar,
    pub components: usize,
    /// Buffers hold half floats; backgrounds, tiles at the root and inactive values do not.
    pub half: bool,
    pub compression: Compression,
    /// Whether nodes are compressed by their masks (since version 222).
    pub node_masks: bool,
}

impl ValueLayout {
    /// Size of a value outside buffers.
    pub fn value_bytes(&self) -> usize {
        self.components
            * match self.scalar {
                Scalar::F16 => 2,
                Scalar::F32 => 4,
                Scalar::F64 => 8,
                Scalar::Opaque { bytes } => bytes,
            }
    }

    /// Whether buffers hold half floats in place of the type's own.
    fn is_half(&self) -> bool {
        self.half && matches!(self.scalar, Scalar::F32 | Scalar::F64)
    }

    fn buffer<'a>(&self, stream: &mut Stream<'a>, count: usize) -> Result<Buffer<'a>> {
        match (self.is_half(), count) {
            // Empty buffers of half floats are not written at all, those of others are.
            (true, 0) => Ok(Buffer::EMPTY),
            (true, _) => self.compression.buffer(stream, count * self.components * 2),
            (false, _) => self.compression.buffer(stream, count * self.value_bytes()),
        }
    }

    /// The value that starts `bytes`, which has [`ValueLayout::value_bytes`].
    pub fn value<V: Voxel>(&self, bytes: &[u8]) -> V {
        let mut value = [V::ZERO];
        match self.scalar {
            Scalar::F16 => decode(bytes, &mut value, half_value),
            Scalar::F64 => decode(bytes, &mut value, |bytes| f64::from_le_bytes(bytes) as f32),
            _ => decode(bytes, &mut value, f32::from_le_bytes),
        }
        value[0]
    }

    fn decode_buffer<V: Voxel>(&self, bytes: &[u8], values: &mut [V]) {
        match (self.is_half(), self.scalar) {
            (true, _) | (_, Scalar::F16) => decode(bytes, values, half_value),
            (false, Scalar::F64) => decode(bytes, values, |bytes| f64::from_le_bytes(bytes) as f32),
            (false, _) => decode(bytes, values, f32::from_le_bytes),
        }
    }
}

fn half_value(bytes: [u8; 2]) -> f32 {
    widen_ieee(u16::from_le_bytes(bytes))
}

fn decode<V: Voxel, const N: usize>(
    bytes: &[u8],
    values: &mut [V],
    scalar: impl Fn([u8; N]) -> f32,
) {
    let (scalars, _) = bytes.as_chunks::<N>();
    for (value, scalars) in values.iter_mut().zip(scalars.chunks_exact(V::COMPONENTS)) {
        let mut components = [0.0; 3];
        for (component, &bytes) in components.iter_mut().zip(scalars) {
            *component = scalar(bytes);
        }
        *value = V::from_components(components);
    }
}

/// A set of bits, the lowest of each byte first.
#[derive(Clone, Copy)]
pub(super) struct Mask<'a>(&'a [u8]);

impl<'a> Mask<'a> {
    pub fn read(stream: &mut Stream<'a>, bits: usize) -> Result<Self> {
        stream.take(bits / 8).map(Self)
    }

    pub fn is_on(&self, bit: usize) -> bool {
        self.0[bit >> 3] >> (bit & 7) & 1 == 1
    }

    pub fn count(&self) -> usize {
        let (words, _) = self.0.as_chunks();
        words.iter().map(|&bytes| u64::from_le_bytes(bytes).count_ones() as usize).sum()
    }

    /// The first 512 bits in words of 64, those that are missing off.
    pub fn words(&self) -> [u64; 8] {
        let (words, _) = self.0.as_chunks();
        std::array::from_fn(|n| words.get(n).map_or(0, |&bytes| u64::from_le_bytes(bytes)))
    }
}

/// Values of inactive voxels.
#[derive(Clone, Copy)]
enum Inactive<'a> {
    Background,
    MinusBackground,
    One(&'a [u8]),
    /// Selected by a mask: minus the background where off, the background where on.
    Signs(Mask<'a>),
    /// Selected by a mask: this one where off, the background where on.
    OneOrBackground(&'a [u8], Mask<'a>),
    /// Selected by a mask: the first where off, the second where on.
    Two(&'a [u8], &'a [u8], Mask<'a>),
    /// All values are stored.
    Stored,
}

impl<'a> Inactive<'a> {
    fn read(stream: &mut Stream<'a>, layout: &ValueLayout, bits: usize) -> Result<Self> {
        let size = layout.value_bytes();
        Ok(match stream.u8()? {
            0 => Self::Background,
            1 => Self::MinusBackground,
            2 => Self::One(stream.take(size)?),
            3 => Self::Signs(Mask::read(stream, bits)?),
            4 => Self::OneOrBackground(stream.take(size)?, Mask::read(stream, bits)?),
            5 => Self::Two(stream.take(size)?, stream.take(size)?, Mask::read(stream, bits)?),
            6 => Self::Stored,
            code => {
                let reason = format!(
                    "unknown code {code} for inactive values; the file is damaged, export or copy \
                     it again"
                );
                return Err(stream.broken(reason));
            }
        })
    }
}

/// Stored values of a node and their encoding.
#[derive(Clone, Copy)]
pub(super) struct PackedValues<'a> {
    inactive: Inactive<'a>,
    buffer: Buffer<'a>,
    /// Number of stored values.
    stored: usize,
    /// Whether only the values of active voxels are stored.
    masked: bool,
    /// Offset of the buffer's end, for messages.
    end: usize,
}

impl<'a> PackedValues<'a> {
    /// Finds the values of a node with as many places as `active` has bits: `count` of them are
    /// stored before version 222, and since then all or the active ones.
    pub fn read(
        stream: &mut Stream<'a>,
        layout: &ValueLayout,
        active: &Mask<'a>,
        count: usize,
    ) -> Result<Self> {
        let inactive = match layout.node_masks {
            true => Inactive::read(stream, layout, active.0.len() * 8)?,
            false => Inactive::Stored,
        };
        let all = matches!(inactive, Inactive::Stored) || !layout.compression.has_active_mask();
        let stored = if all { count } else { active.count() };
        let buffer = layout.buffer(stream, stored)?;
        Ok(Self { inactive, buffer, stored, masked: !all, end: stream.position() })
    }

    /// Decodes the values into `values`, which has a place for each bit of `active`; before
    /// version 222 only the first ones may be set.
    pub fn decode<V: Voxel>(
        &self,
        layout: &ValueLayout,
        active: &Mask,
        background: V,
        codec: &mut Codec,
        values: &mut [V],
    ) -> Result<()> {
        let bytes = codec.unpack(&self.buffer).map_err(|reason| super::stream::Fault::Broken {
            section: "values",
            offset: self.end,
            reason,
        })?;
        layout.decode_buffer(bytes, &mut values[..self.stored]);
        // Where all voxels are active, all values are in their places already.
        if self.masked && self.stored < values.len() {
            self.spread(layout, active, background, values);
        }
        Ok(())
    }

    /// Moves the stored values to their places and fills in the inactive ones, from the end so
    /// that nothing is overwritten before it moved.
    fn spread<V: Voxel>(
        &self,
        layout: &ValueLayout,
        active: &Mask,
        background: V,
        values: &mut [V],
    ) {
        // Past zero by as much again: a negation that needs no operator of its own.
        let minus = V::lerp(background, V::ZERO, 2.0);
        let value = |bytes: &[u8]| layout.value::<V>(bytes);
        let (off, on, mask) = match self.inactive {
            Inactive::Background | Inactive::Stored => (background, background, None),
            Inactive::MinusBackground => (minus, minus, None),
            Inactive::One(bytes) => (value(bytes), background, None),
            Inactive::Signs(mask) => (minus, background, Some(mask)),
            Inactive::OneOrBackground(bytes, mask) => (value(bytes), background, Some(mask)),
            Inactive::Two(first, second, mask) => (value(first), value(second), Some(mask)),
        };
        let mut next = self.stored;
        for place in (0..values.len()).rev() {
            values[place] = if active.is_on(place) {
                next -= 1;
                values[next]
            } else if mask.is_some_and(|mask| mask.is_on(place)) {
                on
            } else {
                off
            };
        }
    }
}
