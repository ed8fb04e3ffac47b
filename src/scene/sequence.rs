//! Numbered sets of volume files: one file a frame.

mod frames;
mod numbered_set;
mod pattern;
mod volume_frame;

pub use frames::{FrameFile, Frames, FramesOnDisk, Shown};
pub use numbered_set::NumberedSet;
pub use pattern::Pattern;
pub use volume_frame::{Gap, Listings, VolumeFrame, time_range, volume_frame};
