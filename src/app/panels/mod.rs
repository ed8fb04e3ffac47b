//! Panels of settings in a column, one file each.
//!
//! - `column`: the column that they stand in.
//! - `strategy`, `advanced`: toggles and presets, and what is behind them.
//! - `volume`, `grids`, `emission`, `ramp`, `placement`, `sequence`: a volume, its grids,
//!   emission, place and frames.
//! - `setup`: the surroundings of a volume that stands alone.
//! - `lights`, `environment`, `surfaces`, `camera`, `film`, `display`: the rest of the scene and of
//!   the view.

pub mod advanced;
pub mod camera;
pub mod column;
pub mod display;
pub mod emission;
pub mod environment;
pub mod film;
pub mod grids;
pub mod lights;
pub mod placement;
pub mod ramp;
pub mod sequence;
pub mod setup;
pub mod strategy;
pub mod surfaces;
pub mod volume;

pub use super::ui::sections::{folded_section, section};
pub use super::ui::widgets::explain;

use super::command::Command;
use super::compare::panel::ComparePanel;
use super::compare::reference::MeasuredReference;
use super::compare::second_side::SecondSide;
use super::diagnostics::Wanted;
use super::document::Editor;
use super::jobs::built::Grids;
use crate::math::Aabb;
use crate::scene::Note;
use crate::transport::spending::Spending;

/// The state that a panel may read and change.
pub struct Panel<'a> {
    /// The document and its record of edits.
    pub editor: &'a mut Editor,
    /// The grids of all files seen so far.
    pub grids: &'a Grids,
    /// The guesses made when a bare volume was opened.
    pub notes: &'a [Note],
    /// First and last frame of the time line; `None` for a scene of one frame.
    pub frames: Option<[i32; 2]>,
    /// The box around all that fills space, or around the camera's target where nothing does.
    pub bounds: Aabb,
    /// The light whose keys and handles are shown.
    pub selected_light: &'a mut Option<usize>,
    /// Guided flights of a camera ray, relative to those that the probes propose, if that is known.
    pub guided_flights: Option<f32>,
    /// How the time of the render is spent, if that is known.
    pub spending: Option<Spending>,
    /// Second side of a comparison.
    pub second_side: &'a SecondSide,
    /// The reference and the errors against it.
    pub reference: &'a mut MeasuredReference,
    /// The diagnostics that are shown.
    pub wanted: &'a mut Wanted,
    /// Commands that buttons ask for.
    pub commands: &'a mut Vec<Command>,
}

impl Panel<'_> {
    /// The part of it that the panel of a comparison shows.
    pub fn compare(&mut self) -> ComparePanel<'_> {
        ComparePanel {
            editor: self.editor,
            second_side: self.second_side,
            reference: self.reference,
            commands: self.commands,
        }
    }
}
