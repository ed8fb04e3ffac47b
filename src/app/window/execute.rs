//! Carries out commands.

use egui::Context;
use glam::UVec2;

use super::App;
use crate::app::commands::Command;
use crate::app::files::Purpose;
use crate::app::panels::palette::Palette;
use crate::app::panels::start::Start;
use crate::app::panels::strategy;
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
                self.duel.restart();
            }
            Command::FrameVolume => self.frame_volume(),
            Command::FitPicture => self.viewport.zoom = Default::default(),
            Command::ZoomToPixels => {
                let size = self.shown_picture().map(|picture| picture.size);
                self.viewport.toggle_pixel_zoom(size);
            }
            Command::AutoExposure => self.expose(),
            Command::FullScreen => self.set_full_screen(ctx, !self.full_screen),
            Command::Start => {
                self.start = match self.start.take() {
                    Some(_) => None,
                    None => Some(Start::default()),
                };
            }
            Command::FoldPanels => self.folded = !self.folded,
            Command::Palette => {
                self.palette = match self.palette.take() {
                    Some(_) => None,
                    None => Some(Palette::default()),
                };
            }
            Command::Sweep => self.sweep.ask(&self.editor.document.settings),
            Command::Shortcuts => self.help = !self.help,
            _ if self.execute_stored(ctx, command) || self.execute_measure(ctx, command) => {}
            _ => self.edit(command),
        }
        ctx.request_repaint();
    }

    /// Gives the picture the whole screen, or menus and panels their place again.
    pub(super) fn set_full_screen(&mut self, ctx: &Context, full: bool) {
        self.full_screen = full;
        ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(full));
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
