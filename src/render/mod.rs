//! Progressive rendering: what a film keeps, what to sample next, and who does it.
//!
//! - [`film`]: per-pixel sums in independent accumulators, kept so that a render can be continued
//!   bit for bit; [`estimate`] reads means and variances from them, [`publish`] whole pictures.
//!   An [`area`] is a rectangle of its pixels.
//! - [`coarse`]: blocks that one pixel stands for while the others have no samples.
//! - [`schedule`]: pure logic; from what is done and what it cost to the next piece of work.
//! - [`pool`] does one piece of work on all threads, [`progressive`] repeats that. The window's
//!   [`session`] and the command line's [`headless`] both drive that loop; where several
//!   share the threads, [`turns`] says whose turn it is; [`side_by_side`] renders two so, and
//!   [`compare`] holds their films against each other; [`sweep`] does it with all strategies.

pub mod area;
pub mod coarse;
pub mod compare;
pub mod estimate;
pub mod film;
pub mod headless;
pub mod layers;
pub mod pool;
pub mod progressive;
pub mod publish;
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
pub use pool::Failure;
pub use publish::{Picture, RenderStats};
pub use session::{Request, Resume, Session};

#[cfg(test)]
pub(crate) mod synthetic;
