//! The panels, one file each.

pub mod advanced;
pub mod bars;
pub mod camera;
mod chooser;
pub mod column;
pub mod compare;
pub mod diagnostics;
pub mod display;
pub mod emission;
pub mod figures;
pub mod film;
pub mod grids;
pub mod help;
pub mod lights;
pub mod measures;
pub mod menu;
pub mod noise_plot;
pub mod palette;
pub mod placement;
pub mod ramp;
pub mod sections;
pub mod start;
pub mod status;
pub mod strategy;
pub mod strip;
pub mod surfaces;
pub mod sweep;
pub mod unsaved;
pub mod volume;

use egui::{RichText, Ui};

pub use sections::{folded_section, section};

use super::commands::Command;
use super::diagnostics::Wanted;
use super::duel::Duel;
use super::loader::Grids;
use super::state::Editor;
use super::theme::color;
use super::yardstick::Yardstick;
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
    pub duel: &'a Duel,
    /// How many sides take turns at the machine.
    pub turns: usize,
    /// The reference and the errors against it.
    pub yardstick: &'a mut Yardstick,
    /// What is shown to understand the render.
    pub wanted: &'a mut Wanted,
    /// Files that were open before, the last one first.
    pub recent: &'a [String],
    /// The one of them that a menu asks for.
    pub reopened: &'a mut Option<String>,
    /// Commands that buttons ask for.
    pub commands: &'a mut Vec<Command>,
}

/// Small dim text that explains.
pub fn explain(ui: &mut Ui, text: &str) {
    ui.add(egui::Label::new(RichText::new(text).small().color(color::TEXT_DIM)).wrap());
}
