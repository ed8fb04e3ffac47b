//! Unpacking of zlib streams.

use flate2::{Decompress, FlushDecompress, Status};

/// Unpacks zlib streams.
#[derive(Default)]
pub(super) struct Inflate(Option<Decompress>);

impl Inflate {
    /// Unpacks `source`; false unless it is sound and fills `target` exactly.
    pub fn unpack(&mut self, source: &[u8], target: &mut [u8]) -> bool {
        let state = self.0.get_or_insert_with(|| Decompress::new(true));
        state.reset(true);
        let status = state.decompress(source, target, FlushDecompress::Finish);
        matches!(status, Ok(Status::StreamEnd)) && state.total_out() == target.len() as u64
    }
}
