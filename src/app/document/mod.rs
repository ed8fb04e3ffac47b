//! The document that is edited, and undo.

mod document;
pub mod ramp_stops;
pub mod undo;
pub mod up_axis;

pub use document::{Compared, Document, Editor, Side, strategy_name};
