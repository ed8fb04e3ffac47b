//! The window: panels around a picture that refines itself.
//!
//! The settings' panels are in `panels`. A feature with a model of its own has a folder, with that
//! model and its panel; what ties it to the window is in `shell`.
//!
//! The folders are layers, listed here with the lowest first: each uses those above it in this list
//! only, as `tests/rooms` checks.
//!
//! - `command`, a single file: every command of the user.
//! - `ui`: theme, widgets, sections, notices.
//! - `document`: the settings that are edited, and undo.
//! - `jobs`: from edits to pictures, without ever blocking the window.
//! - `picture`: the picture and the input on it.
//! - `compare`: two strategies side by side, errors against a reference.
//! - `sweep`: every strategy tried on the shot and ranked.
//! - `time_line`: the frames of a sequence, played from a flipbook.
//! - `snapshots`: stored pictures in a strip.
//! - `diagnostics`: cells over the picture and maps in its place.
//! - `panels`: the column of settings.
//! - `shell`: the window itself.

mod command;
mod compare;
mod diagnostics;
mod document;
mod jobs;
mod panels;
mod picture;
mod shell;
mod snapshots;
mod sweep;
mod time_line;
mod ui;

pub use command::Command;
pub use compare::measure::Measure;
pub use compare::second_side::CompareLayout;
pub use document::{Compared, Document, Editor, Side};
pub use jobs::dialogs::Dialogs;
pub use jobs::live_render::LiveRender;
pub use picture::ramp_color::color as ramp_color;
pub use shell::{App, Options};
pub use sweep::{Results, Sweep};
pub use time_line::TimeLine;
pub use ui::notices::{Level, Notice, Notices};

use crate::error::{Error, Result};
pub use crate::image::ramp::Scale;

/// The window as eframe runs it.
struct Window {
    app: App,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.app.frame(ui);
    }

    fn on_exit(&mut self) {
        self.app.close();
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        ui::theme::color::PANEL.to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}

/// The shortest time between frames that the cores draw themselves: what they draw in vain they do
/// not render.
const SOFTWARE_PACE: std::time::Duration = std::time::Duration::from_millis(33);

/// The flame of the torch; the system's own icon should it be unreadable.
fn icon() -> egui::IconData {
    let png = include_bytes!("../../assets/icon.png");
    eframe::icon_data::from_png_bytes(png).unwrap_or_default()
}

/// Opens the window on a scene, a volume or a snapshot (a path or `builtin:NAME`), or on the
/// default scene, and returns when it is closed.
///
/// # Errors
/// When there is no display or no graphics adapter, with a hint at what to do.
pub fn run(source: Option<String>) -> Result<()> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("Flambeau")
        .with_icon(icon())
        .with_app_id("flambeau")
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([720.0, 420.0])
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Wgpu,
        // Flat panels have no gradients to dither, and each pixel costs on a software driver.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(|creation| {
        let state = creation.wgpu_render_state.as_ref().ok_or("there is no graphics adapter")?;
        let is_software = state.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        let pace = is_software.then_some(SOFTWARE_PACE);
        let options = Options { source, cleared: true, pace, ..Options::default() };
        Ok(Box::new(Window { app: App::new(&creation.egui_ctx, state, options)? }))
    });
    eframe::run_native("flambeau", options, create).map_err(|error| no_window(&error))
}

fn no_window(error: &eframe::Error) -> Error {
    let what = match error {
        eframe::Error::AppCreation(error) => error.to_string(),
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => {
            "there is no display (are DISPLAY or WAYLAND_DISPLAY set?)".to_owned()
        }
        eframe::Error::Wgpu(error) => format!("there is no graphics adapter: {error}"),
    };
    Error::invalid(
        "the window",
        "",
        format!(
            "{what}\nA window needs a display and a driver for Vulkan, Metal, DirectX 12 or \
             OpenGL; without a graphics card, Mesa's lavapipe will do. `flambeau render SCENE -o \
             OUT.exr` renders without a window."
        ),
    )
}
