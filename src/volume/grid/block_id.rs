//! Names of blocks, as the index holds them.

/// Where a block's values are stored: how, in the lowest two bits, and the number of its kind.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct BlockId(u32);

/// The ways to store a block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum BlockKind {
    /// All values are one.
    Constant,
    Half,
    Float,
    /// Floats, with the first ones of the next blocks.
    Padded,
}

impl BlockId {
    /// The background, where all that interpolating in the block reads is background too.
    pub const BACKGROUND: Self = Self(0);

    pub fn new(kind: BlockKind, number: usize) -> Self {
        Self((number as u32) << 2 | kind as u32)
    }

    #[inline(always)]
    pub fn kind(self) -> BlockKind {
        match self.0 & 3 {
            0 => BlockKind::Constant,
            1 => BlockKind::Half,
            2 => BlockKind::Float,
            _ => BlockKind::Padded,
        }
    }

    #[inline(always)]
    pub fn number(self) -> usize {
        (self.0 >> 2) as usize
    }

    pub fn is_constant(self) -> bool {
        self.kind() == BlockKind::Constant
    }
}
