//! Scenes: the one settings struct, its file format, and what is built from it.

pub mod settings;

pub use settings::Settings;
