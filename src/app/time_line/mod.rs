//! The time line: the frames of a sequence, shown one after the other.
//!
//! - `model`: the frames, the flipbook and the playback; `playback`: which frame comes when.
//! - `flipbook`: pictures of frames that were rendered; `bar`: the row below the picture.

pub mod bar;
pub mod flipbook;
mod model;
mod playback;

pub use model::{TimeLine, Turn};
