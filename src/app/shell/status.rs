//! The status line: progress and cost of the picture, display, zoom and the pixel under the
//! pointer.

use egui::{Align, Button, DragValue, Layout, RichText, Ui};
use glam::UVec2;

use crate::app::command::Command;
use crate::app::compare::panel;
use crate::app::compare::second_side::SecondSide;
use crate::app::document::Editor;
use crate::app::jobs::live_render::LiveRender;
use crate::app::picture::viewport::Viewport;
use crate::app::snapshots::{Snapshots, StripItem};
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::{count, finite};
use crate::app::ui::words::{percent, samples, seconds, time_left};
use crate::image::tone::{Channel, Tone};
use crate::render::{Layer, RenderStats};

/// Room that the zoom takes.
const ZOOM_WIDTH: f32 = 70.0;
/// Room that the value under the pointer takes.
const PROBE_WIDTH: f32 = 280.0;

/// The contents of the status line, and what it may change.
pub struct StatusLine<'a> {
    /// The document and its record of edits.
    pub editor: &'a mut Editor,
    /// The render of the side that is edited.
    pub live_render: &'a LiveRender,
    /// Second side of the comparison.
    pub second_side: &'a SecondSide,
    /// Number of sides that share time slices.
    pub turns: usize,
    /// The viewport, for the zoom and the pixel under the pointer.
    pub viewport: &'a Viewport,
    /// The snapshots, one of which may be shown in place of the live picture.
    pub snapshots: &'a Snapshots,
    /// The layer that is shown in place of the picture.
    pub layer: Option<Layer>,
    /// Commands that buttons ask for.
    pub commands: &'a mut Vec<Command>,
}

/// Shows the line.
pub fn show(ui: &mut Ui, panel: &mut StatusLine<'_>) {
    let (live_render, viewport, snapshots) = (panel.live_render, panel.viewport, panel.snapshots);
    ui.horizontal_centered(|ui| {
        let (text, help) = if live_render.paused() {
            ("Resume", "Resume sampling.")
        } else {
            ("Pause", "Stop sampling and keep the picture.")
        };
        let key = ui.ctx().format_shortcut(&Command::PauseResume.shortcut());
        let button = Button::new(text).min_size(egui::vec2(64.0, 0.0));
        if ui.add(button).on_hover_text(format!("{help}  [{key}]")).clicked() {
            panel.commands.push(Command::PauseResume);
        }
        let snapshot = snapshots.strip.shown_item().filter(|_| panel.second_side.stored.is_none());
        if snapshot.is_none() {
            bias(ui, panel);
        }
        match live_render.picture() {
            _ if let Some(item) = snapshot => snapshot_figures(ui, item),
            Some(picture) => progress(ui, &picture.stats, live_render, panel.turns),
            None => {
                let opening = live_render.opening().is_some() || live_render.built().is_some();
                let text =
                    if opening { "Waiting for the first picture…" } else { "Nothing is open." };
                ui.weak(text);
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            // What does not fit beside the figures is left out, the least needed first.
            display(ui, panel);
            if let Some(picture) = snapshots.picture().or_else(|| live_render.picture())
                && ui.available_width() > ZOOM_WIDTH
            {
                ui.separator();
                zoom(ui, viewport.scale(picture.size));
            }
            if ui.available_width() > PROBE_WIDTH {
                probe(ui, viewport);
            }
        });
    });
}

/// Marks a biased picture; of two, says which one it is.
fn bias(ui: &mut Ui, panel: &StatusLine<'_>) {
    if let Some(text) = panel::bias(&panel.editor.document, panel.second_side) {
        let help = "Ray marching is on (Strategy, Advanced): the picture converges to a slightly \
                    different result; more samples do not change that.";
        ui.label(RichText::new(text).color(color::WARNING)).on_hover_text(help);
    }
}

/// Shows the figures of a snapshot in place of the live picture.
fn snapshot_figures(ui: &mut Ui, item: &StripItem) {
    let record = &item.record;
    if item.picture().is_none() {
        ui.label(RichText::new(format!("Reading {}…", record.name)).color(color::ACCENT));
        return;
    }
    let spp = samples(record.spp);
    let text = RichText::new(format!("Snapshot: {}, {spp} spp", record.name)).color(color::ACCENT);
    ui.add(egui::Label::new(text).truncate())
        .on_hover_text("A snapshot is shown instead of the live picture. Press Escape to go back.");
}

fn progress(ui: &mut Ui, stats: &RenderStats, live_render: &LiveRender, turns: usize) {
    let spp = samples(stats.samples_per_pixel);
    figure(ui, &spp, "spp", "Samples per pixel so far.", 38.0);
    figure(ui, &seconds(stats.seconds), "", "Time spent on this picture.", 50.0);
    let noise = match stats.noise {
        Some(noise) => percent(noise),
        None => "–".to_owned(),
    };
    let help = "Relative standard error of the picture. Four times the samples halve it.";
    figure(ui, &noise, "% noise", help, 42.0);
    let rate = if stats.seconds > 0.0 { stats.tracking_steps as f64 / stats.seconds } else { 0.0 };
    let help = "Tentative collisions per second: tracking steps through the volume, real and null.";
    figure(ui, &count(rate), "collisions/s", help, 50.0);
    if stats.non_finite > 0 {
        let text = format!("{} samples dropped", stats.non_finite);
        ui.label(RichText::new(text).color(color::WARNING))
            .on_hover_text("Samples that were not finite numbers and count as black.");
    }
    let has_volumes =
        live_render.built().is_some_and(|built| !built.scene.world.instances().is_empty());
    if has_volumes && stats.tracking_steps == 0 && stats.samples_per_pixel >= 1.0 {
        let help = "No path has met any volume. Frame it with F, or look at its placement.";
        ui.label(RichText::new("no volume in sight").color(color::WARNING)).on_hover_text(help);
    }
    let state = match (live_render.paused(), stats.finished) {
        (true, _) => "paused",
        (false, false) if live_render.held() => "paused while strategies are tried",
        (false, true) => "finished",
        (false, false) if live_render.picture().is_some_and(|picture| picture.region.is_some()) => {
            "region only"
        }
        (false, false) => return ending(ui, stats, live_render, turns),
    };
    ui.label(RichText::new(state).color(color::ACCENT));
}

/// Shows the time until the end of a render with a limit, one of so many that share time slices.
fn ending(ui: &mut Ui, stats: &RenderStats, live_render: &LiveRender, turns: usize) {
    let wanted = live_render.built().map_or(0, |built| built.settings.film.spp);
    // A region that gets all samples has another pace than the picture.
    let is_whole = live_render.picture().is_some_and(|picture| picture.region.is_none());
    let Some(left) = seconds_left(stats, wanted).filter(|_| is_whole) else { return };
    let left = left * turns.max(1) as f64;
    let text = RichText::new(format!("{} left", time_left(left))).color(color::TEXT_DIM);
    ui.label(text).on_hover_text(format!("Time left until each pixel has {wanted} samples."));
}

/// Seconds left at the pace so far; `None` before there is one, at the end, and without a limit.
fn seconds_left(stats: &RenderStats, wanted: u32) -> Option<f64> {
    let have = stats.samples_per_pixel;
    let is_known = have >= 1.0 && have < f64::from(wanted);
    is_known.then(|| stats.seconds * (f64::from(wanted) / have - 1.0))
}

/// A number set to the right in a field of fixed width, so that nothing jumps, with its unit.
fn figure(ui: &mut Ui, value: &str, unit: &str, help: &str, width: f32) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.x = space::TIGHT;
        let size = egui::vec2(width, space::ROW_HEIGHT);
        let layout = Layout::right_to_left(Align::Center);
        ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_size(size);
            ui.label(RichText::new(value).color(color::TEXT_STRONG)).on_hover_text(help);
        });
        if !unit.is_empty() {
            ui.label(RichText::new(unit).color(color::TEXT_DIM)).on_hover_text(help);
        }
    });
}

fn zoom(ui: &mut Ui, scale: f32) {
    let text = format!("{:.0} %", 100.0 * scale);
    ui.label(RichText::new(text).color(color::TEXT_DIM))
        .on_hover_text("Zoom of the picture. Ctrl+wheel zooms to pixels; Home fits the picture.");
}

fn probe(ui: &mut Ui, viewport: &Viewport) {
    let Some(probe) = viewport.probe else { return };
    ui.separator();
    if let Some((number, layer)) = probe.number {
        let unit = layer.map_or("", unit_of);
        let UVec2 { x, y } = probe.pixel;
        let text = format!("{x:>4}, {y:<4} {:>9} {unit}", channel(number));
        ui.label(RichText::new(text).monospace().color(color::TEXT))
            .on_hover_text("The pixel under the pointer and its value in the layer or map shown.");
        return;
    }
    let [r, g, b, _] = probe.value;
    let text = format!(
        "{:>4}, {:<4} {:>8} {:>8} {:>8}",
        probe.pixel.x,
        probe.pixel.y,
        channel(r),
        channel(g),
        channel(b)
    );
    ui.label(RichText::new(text).monospace().color(color::TEXT))
        .on_hover_text("The pixel under the pointer and its linear red, green and blue values.");
}

/// The unit of the numbers of a layer.
fn unit_of(layer: Layer) -> &'static str {
    match layer {
        Layer::Depth => "length",
        Layer::Samples => "samples",
        Layer::Noise => "error",
        Layer::Steps => "steps",
        Layer::Emission | Layer::Direct | Layer::Indirect | Layer::Background => "",
    }
}

/// A channel in about four digits.
fn channel(value: f32) -> String {
    if value == 0.0 || (0.001..10_000.0).contains(&value.abs()) {
        let digits = if value.abs() >= 100.0 { 1 } else { 4 };
        format!("{value:.digits$}")
    } else {
        format!("{value:.1e}")
    }
}

/// The name of the tone curve, or of the channel shown in its place.
fn curve_name(tone: Tone) -> &'static str {
    match tone.channel {
        Channel::Color => tone.curve.name(),
        other => other.name(),
    }
}

/// Exposure and tone curve, from right to left.
fn display(ui: &mut Ui, panel: &mut StatusLine<'_>) {
    let mut edit = None;
    let tone = &mut panel.editor.document.tone;
    let button = Button::new(curve_name(*tone)).min_size(egui::vec2(58.0, 0.0));
    let help = "Tone curve: filmic rolls bright fire off softly, AgX more softly, linear clips it. \
                For display and PNG only. Click for the next one.  [T]";
    if ui.add(button).on_hover_text(help).clicked() {
        tone.curve = tone.curve.next();
        edit = Some("tone curve");
    }
    let field = DragValue::new(&mut tone.exposure)
        .range(-20.0..=20.0)
        .speed(0.02)
        .custom_formatter(|value, _| format!("{value:+.1}"))
        .custom_parser(finite);
    let response = ui.add_sized([44.0, space::ROW_HEIGHT], field).accessible_name("Exposure");
    let help = "Exposure in stops, for display and PNG only. Drag, or click to type. E and Shift+E \
                change it by half a stop, A is auto exposure.";
    if response.on_hover_text(help).changed() {
        edit = Some("exposure");
    }
    ui.label(RichText::new("exposure").color(color::TEXT_DIM));
    if let Some(layer) = panel.layer {
        let text = RichText::new(format!("Layer: {}", layer.name())).color(color::ACCENT);
        ui.label(text).on_hover_text(
            "This layer is shown in place of the picture. Choose another under Display.",
        );
    }
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_is_that_of_the_samples_left() {
        let stats = RenderStats { samples_per_pixel: 16.0, seconds: 8.0, ..Default::default() };
        assert_eq!(seconds_left(&stats, 64), Some(24.0));
        assert_eq!(seconds_left(&stats, 16), None, "it is there");
        assert_eq!(seconds_left(&stats, 0), None, "there is no end");
        let stats = RenderStats { samples_per_pixel: 0.2, ..stats };
        assert_eq!(seconds_left(&stats, 64), None, "the pace is not known yet");
    }
}
