//! Work off the thread of the window: the live render, loading, placing probes, dialogs, files.

pub mod background;
pub mod built;
pub mod dialogs;
pub mod film_file;
pub mod live_render;
pub mod probe_placer;
pub mod reopen;
pub mod scene_loader;
