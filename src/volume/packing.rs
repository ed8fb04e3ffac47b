//! Codecs that bytes of volume files are packed with.

pub(super) mod blosc;
pub(super) mod inflate;
