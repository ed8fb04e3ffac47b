//! Progressive rendering: the film, the order of samples, and the threads that take them.
//!
//! - [`film`]: per-pixel sums in independent accumulators, stored so that a render can be continued
//!   bit for bit; [`area`]: rectangular regions of its pixels; [`layers`]: its layers (AOVs).
//! - [`estimate`]: means and variances of a film; [`picture`]: whole pictures read from it.
//! - [`coarse`]: blocks that one pixel stands for while the others have no samples.
//! - [`schedule`]: pure logic from what is done and what it cost to the next piece of work.
//! - [`pool`]: the threads, which do one piece of work; `thread_time`: their CPU time.
//! - [`progressive`]: one render, piece by piece; driven by [`session`] in the window and by
//!   [`headless`] on the command line.
//! - [`turns`]: the rule by which several renders take turns on one machine; [`time_slice`]:
//!   renders without a window that take turns by it; [`side_by_side`]: two of them. In the window,
//!   sessions take turns by the same rule, through tokens (`session::sharing`).
//! - [`compare`]: speed-up and agreement of two renders; [`sweep`]: all toggles of the strategy,
//!   alone and left out, each a render that takes turns.

pub mod area;
pub mod coarse;
pub mod compare;
pub mod estimate;
pub mod film;
pub mod headless;
pub mod layers;
pub mod picture;
pub mod pool;
pub mod progressive;
pub mod schedule;
pub mod session;
pub mod side_by_side;
pub mod sweep;
mod thread_time;
pub mod time_slice;
pub mod turns;

pub use area::Area;
pub use estimate::FilmStats;
pub use film::Film;
pub use headless::{Headless, RenderJob, render_headless};
pub use layers::{Layer, LayerMap};
pub use picture::{Picture, RenderStats};
pub use pool::Failure;
pub use session::{Request, Resume, Session};

#[cfg(test)]
pub(crate) mod synthetic;
