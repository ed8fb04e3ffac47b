//! The panels, one file each.

pub mod advanced;
pub mod camera;
pub mod column;
pub mod display;
pub mod emission;
pub mod film;
pub mod grids;
pub mod lights;
pub mod placement;
pub mod ramp;
pub mod strategy;
pub mod surfaces;
pub mod volume;

pub use super::ui::sections::{folded_section, section};
pub use super::ui::widgets::explain;

use super::command::Command;
use super::compare::reference::MeasuredReference;
use super::compare::second_side::SecondSide;
use super::diagnostics::Wanted;
use super::document::Editor;
use super::jobs::built::Grids;
use crate::math::Aabb;
use crate::scene::Note;

/// What a panel may read and change.
pub struct Panel<'a> {
    /// The document and its record of edits.
    pub editor: &'a mut Editor,
    /// The grids of all files seen so far.
    pub grids: &'a Grids,
    /// What was guessed when a bare volume was opened.
    pub notes: &'a [Note],
    /// The box around all that fills space, or around the camera's target where nothing does.
    pub bounds: Aabb,
    /// The light whose keys and handles are shown.
    pub selected_light: &'a mut Option<usize>,
    /// How often probes are asked in the picture, relative to what they propose, if that is known.
    pub guided_flights: Option<f32>,
    /// The other side of a comparison.
    pub second_side: &'a SecondSide,
    /// How many sides take turns at the machine.
    pub turns: usize,
    /// The reference and the errors against it.
    pub reference: &'a mut MeasuredReference,
    /// What is shown to understand the render.
    pub wanted: &'a mut Wanted,
    /// Files that were open before, the last one first.
    pub recent: &'a [String],
    /// The one of them that a menu asks for.
    pub reopened: &'a mut Option<String>,
    /// Commands that buttons ask for.
    pub commands: &'a mut Vec<Command>,
}
