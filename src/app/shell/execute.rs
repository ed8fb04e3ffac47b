//! Carries out commands.

use egui::Context;

use super::app::App;
use crate::app::command::Command;
use crate::app::document::Side;
use crate::app::jobs::dialogs::Purpose;
use crate::image::tone::{Channel, auto_exposure};
use crate::transport::toggle::Toggle;

impl App {
    /// Carries out one command.
    #[allow(clippy::too_many_lines, reason = "a table with one row for each command")]
    pub(super) fn execute(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Open => self.ask(ctx, Purpose::Open),
            Command::OpenPath => self.ask_typed(Purpose::Open),
            Command::LoadEnvironment => self.ask(ctx, Purpose::Environment),
            Command::SaveExr => self.ask(ctx, Purpose::SaveExr),
            Command::SavePng => self.ask(ctx, Purpose::SavePng),
            Command::SaveScene => self.ask(ctx, Purpose::SaveScene),
            Command::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
            Command::Undo => self.editor.undo(),
            Command::Redo => self.editor.redo(),
            Command::PauseResume => self.live_render.set_paused(!self.live_render.paused()),
            Command::Restart => self.restart(),
            Command::Toggle(toggle) => self.switch(toggle),
            Command::Play => self.play_or_stop(),
            Command::PreviousFrame => self.step_frame(-1),
            Command::SaveFlipbook => self.ask_to_save_flipbook(ctx),
            Command::NextFrame => self.step_frame(1),
            Command::CameraKey => self.set_or_remove_camera_key(),
            Command::NextSetup => self.next_setup(),
            Command::FrameVolume => self.frame_volume(),
            Command::FocusByClick => self.pick_focus(),
            Command::FitPicture => self.viewport.zoom = Default::default(),
            Command::ZoomToPixels => self.zoom_to_pixels(),
            Command::ExposureUp => self.expose_by(0.5),
            Command::ExposureDown => self.expose_by(-0.5),
            Command::AutoExposure => self.auto_expose(),
            Command::NextToneCurve => self.next_tone_curve(),
            Command::FalseColor => self.toggle_false_color(),
            Command::GoToPicture => self.viewport.wants_keyboard = true,
            Command::FoldPanels => self.chrome.folded = !self.chrome.folded,
            Command::FullScreen => self.chrome.set_full_screen(ctx, !self.chrome.full_screen),
            Command::Larger => egui::gui_zoom::zoom_in(ctx),
            Command::Smaller => egui::gui_zoom::zoom_out(ctx),
            Command::NormalSize => ctx.set_zoom_factor(1.0),
            Command::ResetWindow => self.reset_window(ctx),
            Command::Palette => toggle_open(&mut self.chrome.palette),
            Command::Start => toggle_open(&mut self.chrome.start),
            Command::Shortcuts => self.chrome.help = !self.chrome.help,
            Command::Compare => self.compare_or_end(),
            Command::SwitchSide => self.switch_side(),
            Command::SwapSides => self.swap_sides(),
            Command::CopySide => self.copy_side(),
            Command::NextLayout => self.next_layout(),
            Command::CompareAsA => self.set_against_live(Side::A),
            Command::CompareAsB => self.set_against_live(Side::B),
            Command::SaveComparison => self.ask_to_save_comparison(ctx),
            Command::MeasureRegion => self.compare.region.arm(),
            Command::RenderRegionOnly => self.toggle_region_only(),
            Command::LoadReference => self.ask(ctx, Purpose::Reference),
            Command::PictureAsReference => self.take_picture(ctx),
            Command::RemoveReference => self.compare.reference.remove(),
            Command::Sweep => self.sweep.request(&self.editor.document.settings),
            Command::KeepSnapshot => self.snapshots.wants_keep = true,
            Command::PreviousSnapshot => self.snapshots.strip.show_previous(),
            Command::NextSnapshot => self.show_next_snapshot(),
            Command::LivePicture => self.close_front(ctx),
            Command::ContinueSnapshot => self.go_on_from_shown(),
            Command::DeleteSnapshot => self.snapshots.delete(),
            Command::UndoDelete => self.snapshots.undo_delete(),
            Command::FoldStrip => self.snapshots.strip.toggle(),
        }
        ctx.request_repaint();
    }

    /// Discards the samples of every side.
    fn restart(&mut self) {
        self.live_render.restart();
        self.compare.second_side.restart();
    }

    /// Switches a toggle of the edited strategy.
    fn switch(&mut self, toggle: Toggle) {
        let on = toggle.switch(&mut self.editor.document.settings.strategy);
        *on = !*on;
        self.editor.name_edit(toggle.name());
    }

    fn zoom_to_pixels(&mut self) {
        let size = self.shown_picture().map(|picture| picture.size);
        self.viewport.toggle_pixel_zoom(size);
    }

    /// Changes the exposure by `stops`.
    fn expose_by(&mut self, stops: f32) {
        self.editor.document.tone.exposure += stops;
        self.editor.name_edit("exposure");
    }

    fn next_tone_curve(&mut self) {
        let tone = &mut self.editor.document.tone;
        tone.curve = tone.curve.next();
        self.editor.name_edit("tone curve");
    }

    fn toggle_false_color(&mut self) {
        let tone = &mut self.editor.document.tone;
        tone.channel = match tone.channel {
            Channel::FalseColor => Channel::Color,
            _ => Channel::FalseColor,
        };
        self.editor.name_edit("false color");
    }

    /// Closes what is open in front, unless the key closes a popup already.
    fn close_front(&mut self, ctx: &Context) {
        if !ctx.any_popup_open() {
            self.close_front_most(ctx);
        }
    }

    /// Closes or takes back what is there beside the live picture, the front one first.
    fn close_front_most(&mut self, ctx: &Context) {
        if self.chrome.help {
            self.chrome.help = false;
        } else if self.unsaved.pending.is_some() {
            self.stay();
        } else if self.sweep.open && self.sweep.results().is_some() {
            self.sweep.open = false;
        } else if self.viewport.picks_focus {
            self.viewport.picks_focus = false;
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

    /// Exposes for the picture that is shown.
    fn auto_expose(&mut self) {
        let stops = self.shown_picture().and_then(|picture| auto_exposure(&picture.pixels));
        if let Some(stops) = stops {
            self.editor.document.tone.exposure = stops;
            self.editor.name_edit("exposure");
        }
    }
}

/// Opens something anew, or closes it.
fn toggle_open<T: Default>(part: &mut Option<T>) {
    *part = match part.take() {
        Some(_) => None,
        None => Some(T::default()),
    };
}
