//! The parts of the window around the picture, and which of them are shown.

use egui::{Context, Frame};

use super::palette::Palette;
use super::preferences::Preferences;
use super::start::StartRow;
use crate::app::ui::sections::Sections;
use crate::app::ui::theme::color;

/// The parts of the window that come and go.
pub struct Chrome {
    /// Whether the panel column is folded.
    pub folded: bool,
    /// The sections of the panel column.
    pub sections: Sections,
    /// Whether the picture has the whole screen.
    pub full_screen: bool,
    /// Whether the page of keys is shown.
    pub help: bool,
    /// The start row, while it is shown.
    pub start: Option<StartRow>,
    /// The list of all commands, while it is open.
    pub palette: Option<Palette>,
    /// Whether each frame begins in the color of the panels.
    cleared: bool,
}

impl Chrome {
    /// Chrome as `preferences` have it. `is_plain` says that no file was asked for, `cleared` that
    /// each frame begins in the color of the panels.
    pub fn new(ctx: &Context, preferences: &Preferences, is_plain: bool, cleared: bool) -> Self {
        Self {
            folded: preferences.folded,
            sections: Sections::install(ctx, preferences.sections.clone()),
            full_screen: false,
            help: false,
            start: (is_plain && preferences.start).then(StartRow::default),
            palette: None,
            cleared,
        }
    }

    /// The ground of fixed panels. A window that is cleared to their color spares the painting,
    /// which a software driver feels.
    pub fn panel_frame(&self) -> Frame {
        if self.cleared { Frame::new() } else { Frame::new().fill(color::PANEL) }
    }

    /// Gives the picture the whole screen, or menus and panels their place again.
    pub fn set_full_screen(&mut self, ctx: &Context, full: bool) {
        self.full_screen = full;
        ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(full));
    }
}
