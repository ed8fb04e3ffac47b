//! Carries out commands.

use egui::Context;
use glam::UVec2;

use super::app::App;
use crate::app::command::Command;
use crate::app::jobs::dialogs::Purpose;
use crate::app::panels::strategy;
use crate::app::shell::palette::Palette;
use crate::app::shell::start::StartRow;
use crate::image::tone::{Channel, auto_exposure};
use crate::scene;

impl App {
    /// Carries out one command.
    pub(super) fn execute(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Open => self.ask(ctx, Purpose::Open),
            Command::OpenPath => self.ask_typed(Purpose::Open),
            Command::SaveExr => self.ask(ctx, Purpose::SaveExr),
            Command::SavePng => self.ask(ctx, Purpose::SavePng),
            Command::SaveScene => self.ask(ctx, Purpose::SaveScene),
            Command::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            Command::Undo => self.editor.undo(),
            Command::Redo => self.editor.redo(),
            Command::PauseResume => self.engine.set_paused(!self.engine.paused()),
            Command::Restart => {
                self.engine.restart();
                self.compare.second_side.restart();
            }
            Command::FrameVolume => self.frame_volume(),
            Command::FitPicture => self.viewport.zoom = Default::default(),
            Command::ZoomToPixels => {
                let size = self.shown_picture().map(|picture| picture.size);
                self.viewport.toggle_pixel_zoom(size);
            }
            Command::GoToPicture => self.viewport.wants_keyboard = true,
            Command::AutoExposure => self.expose(),
            Command::FullScreen => self.chrome.set_full_screen(ctx, !self.chrome.full_screen),
            Command::Start => {
                self.chrome.start = match self.chrome.start.take() {
                    Some(_) => None,
                    None => Some(StartRow::default()),
                };
            }
            Command::FoldPanels => self.chrome.folded = !self.chrome.folded,
            Command::Palette => {
                self.chrome.palette = match self.chrome.palette.take() {
                    Some(_) => None,
                    None => Some(Palette::default()),
                };
            }
            Command::Larger => egui::gui_zoom::zoom_in(ctx),
            Command::Smaller => egui::gui_zoom::zoom_out(ctx),
            Command::NormalSize => ctx.set_zoom_factor(1.0),
            Command::ResetWindow => self.reset_window(ctx),
            Command::Sweep => self.sweep.ask(&self.editor.document.settings),
            Command::Shortcuts => self.chrome.help = !self.chrome.help,
            _ if self.execute_stored(ctx, command) || self.execute_measure(ctx, command) => {}
            _ => self.edit(command),
        }
        ctx.request_repaint();
    }

    /// Closes or takes back what is there beside the live picture, the front one first.
    pub(super) fn leave(&mut self, ctx: &Context) {
        if self.chrome.help {
            self.chrome.help = false;
        } else if self.unsaved.pending.is_some() {
            self.stay();
        } else if self.sweep.open && self.sweep.results().is_some() {
            self.sweep.open = false;
        } else if self.compare.region.is_armed() {
            self.compare.region.remove();
        } else if self.chrome.full_screen {
            self.chrome.set_full_screen(ctx, false);
        } else if self.snapshots.strip.shown().is_some() {
            self.snapshots.strip.show(None);
        } else if !self.compare.region.remove() && self.gizmo.selected.take().is_none() {
            self.chrome.start = None;
        }
    }

    /// Brings the preferences of the window and the display back to the first start, and what
    /// hides parts of it.
    fn reset_window(&mut self, ctx: &Context) {
        ctx.set_zoom_factor(1.0);
        self.chrome.set_full_screen(ctx, false);
        self.chrome.folded = false;
        self.chrome.sections.reset();
        self.preferences.start = true;
        self.viewport.zoom = Default::default();
        self.compare.second_side.layout = Default::default();
        self.editor.document.tone = Default::default();
        self.editor.name_edit("display");
    }

    /// Commands that change the document.
    fn edit(&mut self, command: Command) {
        let document = &mut self.editor.document;
        let name = match command {
            Command::ExposureUp => {
                document.tone.exposure += 0.5;
                "exposure"
            }
            Command::ExposureDown => {
                document.tone.exposure -= 0.5;
                "exposure"
            }
            Command::NextToneCurve => {
                document.tone.curve = document.tone.curve.next();
                "tone curve"
            }
            Command::FalseColor => {
                document.tone.channel = match document.tone.channel {
                    Channel::FalseColor => Channel::Color,
                    _ => Channel::FalseColor,
                };
                "false color"
            }
            Command::Compare => {
                match document.compared {
                    None => document.compare(),
                    Some(_) => document.compared = None,
                }
                "comparison"
            }
            Command::SwitchSide => {
                document.switch_side();
                "edited side"
            }
            Command::SwapSides => {
                document.swap_sides();
                "swap of A and B"
            }
            Command::CopySide => {
                document.copy_to_other_side();
                "copy to the other side"
            }
            other => {
                let Some(toggle) = strategy::toggle_of(other) else { return };
                let switch = toggle.switch(&mut document.settings.strategy);
                *switch = !*switch;
                other.text()
            }
        };
        self.editor.name_edit(name);
    }

    /// Exposes for the picture that is shown.
    fn expose(&mut self) {
        let stops = self.shown_picture().and_then(|picture| auto_exposure(&picture.pixels));
        if let Some(stops) = stops {
            self.editor.document.tone.exposure = stops;
            self.editor.name_edit("exposure");
        }
    }

    /// Moves the camera so that everything finite that fills space is in the picture.
    fn frame_volume(&mut self) {
        let Some(built) = self.engine.built() else { return };
        let Some(bounds) = built.scene.world.finite_bounds() else { return };
        let size = self.film_size().unwrap_or(UVec2::ONE).as_vec2();
        let camera = &mut self.editor.document.settings.camera;
        *camera = scene::frame(camera, &bounds, size.x / size.y);
        self.editor.name_edit("frame the volume");
    }
}
