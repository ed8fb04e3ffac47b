//! The window: [`App`] and everything around the picture.
//!
//! - `app`: the state behind the window; `frame`: one frame of it; `news`: what comes from threads.
//! - `layout`, `chrome`: what is where, and which of it is shown; `pace`: the time between frames.
//! - `execute`: commands; `menu`, `palette`, `help`: lists of them.
//! - `bars`, `unsaved_bar`, `start`, `status`: rows that come and go, and the status line.
//! - `paths`, `file_requests`, `save`, `export`, `opened`: choosing, opening and writing files.
//! - `guard`, `unsaved`: no change of the scene is lost unasked; `changed_scene`, `reload`: its
//!   file was written again.
//! - `measures`, `snapshots`, `sweep`, `time_line`, `view`: where the window meets those features.
//! - `preferences`: what the window keeps between runs, and where.
//! - `frame_stats`: what the window costs (`FLAMBEAU_FRAME_STATS=FILE`).

mod app;
mod bars;
mod camera;
mod changed_scene;
mod chrome;
mod compare;
mod execute;
mod export;
mod file_requests;
mod frame;
mod frame_stats;
mod guard;
mod help;
mod layout;
mod measures;
mod menu;
mod news;
mod opened;
mod pace;
mod palette;
mod paths;
mod preferences;
mod reload;
mod save;
mod snapshots;
mod start;
mod status;
mod sweep;
mod time_line;
mod unsaved;
mod unsaved_bar;
mod view;

pub use app::{App, Options};
