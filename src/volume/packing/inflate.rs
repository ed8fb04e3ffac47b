//! Unpacking of zlib streams.

use flate2::{Decompress, FlushDecompress, Status};

/// Bytes unpacked between two questions whether to go on.
const PIECE: usize = 4 << 20;

/// Unpacks zlib streams.
#[derive(Default)]
pub(in crate::volume) struct Inflate(Option<Decompress>);

/// Outcome of a stream that took long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::volume) enum Outcome {
    /// It is sound and filled its target exactly.
    Complete,
    /// It is not sound, or of another length.
    Damaged,
    /// The caller stopped it.
    Stopped,
}

impl Inflate {
    /// Unpacks `source`; false unless it is sound and fills `target` exactly.
    pub fn unpack(&mut self, source: &[u8], target: &mut [u8]) -> bool {
        let state = self.begin();
        let status = state.decompress(source, target, FlushDecompress::Finish);
        matches!(status, Ok(Status::StreamEnd)) && state.total_out() == target.len() as u64
    }

    /// Unpacks a long `source`, which must fill `target` exactly; `go_on` is asked after each
    /// piece, with the number of bytes that are done.
    pub fn unpack_while(
        &mut self,
        source: &[u8],
        target: &mut [u8],
        go_on: impl Fn(usize) -> bool,
    ) -> Outcome {
        let state = self.begin();
        loop {
            let (read, written) = (state.total_in() as usize, state.total_out() as usize);
            if !go_on(written) {
                return Outcome::Stopped;
            }
            let end = target.len().min(written + PIECE);
            let status =
                state.decompress(&source[read..], &mut target[written..end], FlushDecompress::None);
            let moved = (read, written) != (state.total_in() as usize, state.total_out() as usize);
            match status {
                Ok(Status::StreamEnd) if state.total_out() == target.len() as u64 => {
                    return Outcome::Complete;
                }
                Ok(Status::Ok) if moved => {}
                _ => return Outcome::Damaged,
            }
        }
    }

    /// Unpacks the first bytes of `source` into `target`; false unless they are sound.
    pub fn unpack_start(&mut self, source: &[u8], target: &mut [u8]) -> bool {
        let state = self.begin();
        let status = state.decompress(source, target, FlushDecompress::None);
        status.is_ok() && state.total_out() == target.len() as u64
    }

    /// The state, ready for another stream.
    fn begin(&mut self) -> &mut Decompress {
        let state = self.0.get_or_insert_with(|| Decompress::new(true));
        state.reset(true);
        state
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn zipped(data: &[u8]) -> Vec<u8> {
        let mut zip = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        zip.write_all(data).unwrap();
        zip.finish().unwrap()
    }

    #[test]
    fn long_streams_are_unpacked_in_pieces_and_can_be_stopped() {
        let data: Vec<u8> = (0..2 * PIECE + 99).map(|n| (n / 1000) as u8).collect();
        let zip = zipped(&data);
        let mut inflate = Inflate::default();
        let mut target = vec![0; data.len()];
        assert_eq!(inflate.unpack_while(&zip, &mut target, |_| true), Outcome::Complete);
        assert_eq!(target, data);
        let stopped = inflate.unpack_while(&zip, &mut target, |done| done < PIECE);
        assert_eq!(stopped, Outcome::Stopped);
        let cut = &zip[..zip.len() - 1];
        assert_eq!(inflate.unpack_while(cut, &mut target, |_| true), Outcome::Damaged);
        for length in [data.len() - 1, data.len() + 1] {
            let mut target = vec![0; length];
            assert_eq!(inflate.unpack_while(&zip, &mut target, |_| true), Outcome::Damaged);
        }
    }

    #[test]
    fn the_start_of_a_stream_is_enough_for_its_first_bytes() {
        let data: Vec<u8> = (0..100_000_u32).map(|n| (n % 251) as u8).collect();
        let zip = zipped(&data);
        let mut start = [0; 700];
        assert!(Inflate::default().unpack_start(&zip, &mut start));
        assert_eq!(start, data[..700]);
        assert!(!Inflate::default().unpack_start(&zip[..20], &mut start));
        assert!(!Inflate::default().unpack_start(b"no zlib stream", &mut start));
    }
}
