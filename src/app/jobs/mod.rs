//! Work off the thread of the window.
//!
//! - `live_render`: keeps the picture up to date with the document.
//! - `scene_loader`, `built`, `reopen`: reads and builds scenes and snapshots.
//! - `probe_placer`: starts renders and places their probes meanwhile.
//! - `mailbox`: one message to a thread, the latest wins; `background`: one value made anew
//!   whenever what it is made from changes.
//! - `file_watch`: whether files of the scene have changed; `scene_reader`: reads its own again.
//! - `dialogs`, `film_file`: choosing files, and films on their way into them.

pub mod background;
pub mod built;
pub mod dialogs;
pub mod file_watch;
pub mod film_file;
pub mod live_render;
pub mod mailbox;
pub mod probe_placer;
pub mod reopen;
pub mod scene_loader;
pub mod scene_reader;
