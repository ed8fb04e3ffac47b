//! The document that is edited, and undo.
//!
//! - `document`: the document and its editor; `undo`: its states and the names of the edits
//!   between.
//! - `ramp_stops`, `up_axis`: edits of a color ramp and of a volume's orientation.

mod document;
pub mod ramp_stops;
pub mod undo;
pub mod up_axis;

pub use document::{Compared, Document, Editor, Side, strategy_name};
