//! Scenes: the one settings struct, its file format, and what is built from it.
//!
//! ```text
//! name --load--> text --parse--> settings --build--> transport::Scene
//!         \----> bare volume --guess--/  \--save--> text
//! ```

mod additions;
mod assemble;
pub mod cache;
mod check;
mod conventions;
mod describe;
pub mod effect;
mod embedded;
mod files;
mod fingerprints;
mod frame;
mod grid_names;
mod guess;
pub mod keys;
mod load;
mod overrides;
mod parse;
mod resume;
mod role;
mod rules;
mod save;
mod schema;
pub mod settings;

pub use additions::{floor_under, new_light};
pub use assemble::{assemble, camera};
pub use cache::VolumeCache;
pub use conventions::{Program, upright};
pub use describe::{FileDescription, GridDescription, VoxelDescription, describe};
pub use embedded::{DEFAULT_SCENE, scenes as embedded_scenes};
pub use fingerprints::{fingerprints, volume_files};
pub use frame::frame;
pub use guess::{About, Note};
pub use load::{Opened, is_scene, load, open, scene_file};
pub use overrides::Overrides;
pub use parse::{apply, parse, tidy, validate};
pub use resume::{Blocker, Compatibility, compatibility, settings_of};
pub use role::Role;
pub use save::{save, to_toml};
pub use settings::Settings;
