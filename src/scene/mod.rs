//! Scenes: the one settings struct, its file format, and what is built from it.

mod check;
pub mod keys;
mod schema;
pub mod settings;

pub use settings::Settings;
