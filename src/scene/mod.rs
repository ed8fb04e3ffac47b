//! Scenes: the one settings struct, its file format, and what is built from it.

mod check;
mod files;
pub mod keys;
mod overrides;
mod parse;
mod rules;
mod save;
mod schema;
pub mod settings;

pub use overrides::Overrides;
pub use parse::{apply, parse, tidy, validate};
pub use save::{save, to_toml};
pub use settings::Settings;
