//! Scenes: the one settings struct, its file format, and what is built from it.
//!
//! ```text
//! name --load--> text + Overrides --parse--> Settings --assemble--> transport::Scene
//!         \----> bare volume --------guess------/  \--save--> text
//! ```
//!
//! - `load`, `files`, `embedded`: opening a source by name; [`cache`]: files in memory, with the
//!   `radiance_maps` of environments, read again by their `stamp`.
//! - `parse`, `overrides`: TOML text to settings, or, by [`apply`], values of `--set` laid over
//!   settings later; `save`: settings to text.
//! - `check`, `rules`: errors in keys and values, for `parse`; `schema`, [`keys`]: the schema and
//!   its keys.
//! - [`settings`]: the settings struct; [`effect`]: toggles that change nothing in a scene.
//! - `assemble`: settings to the scene that is rendered; [`sequence`]: the file of each frame.
//! - `guess`, `conventions`, `grid_names`, `role`: settings for a bare volume; `fit_camera`: its
//!   camera.
//! - `setup`: the surroundings of a volume that stands alone.
//! - `grid_address`: names of grids in scenes; `file_box`: boxes in the space of a file.
//! - `additions`: new lights and floors; `describe`: the contents of a volume file for people.
//! - `resume`, `fingerprints`: whether a snapshot can be continued, and whether its files changed.

mod additions;
mod assemble;
pub mod cache;
mod check;
mod conventions;
mod describe;
pub mod effect;
mod embedded;
mod file_box;
mod files;
mod fingerprints;
mod fit_camera;
mod grid_address;
mod grid_names;
mod guess;
pub mod keys;
mod load;
mod overrides;
mod parse;
mod radiance_maps;
mod resume;
mod role;
mod rules;
mod save;
mod schema;
pub mod sequence;
pub mod settings;
mod setup;
mod stamp;

pub use additions::{floor_under, new_light};
pub use assemble::{Assembled, assemble, assemble_frame, camera, prefetch};
pub use cache::VolumeCache;
pub use conventions::{Program, upright};
pub use describe::{FileDescription, GridDescription, VoxelDescription, describe, stamp};
pub use embedded::{DEFAULT_SCENE, scenes as embedded_scenes};
pub use fingerprints::{files_on_disk, fingerprints};
pub use fit_camera::fit_camera;
pub use guess::{About, Note};
pub use load::{Opened, is_scene, load, open, scene_file};
pub use overrides::Overrides;
pub use parse::{apply, parse, tidy, validate};
pub use resume::{Blocker, Compatibility, compatibility, settings_of};
pub use role::Role;
pub use save::{save, to_toml};
pub use settings::Settings;
pub use setup::Setup;
pub use stamp::Stamp;
