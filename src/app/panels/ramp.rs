//! The editor of a color ramp: the ramp over the values of its grid, and a handle for each stop.

use std::ops::RangeInclusive;

use egui::{
    Color32, Id, Key, Mesh, Modifiers, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2,
};

use super::grids::histogram_bars;
use crate::app::document::ramp_stops;
use crate::app::document::ramp_stops::Stop;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::{Number, arrow_steps, from_rgb, key_help, scaled, strength, tint};
use crate::scene::VoxelDescription;
use crate::scene::settings::Color;

const KEY: &str = "volume.N.emission.stops";
/// Colors across the ramp that are drawn; linear in between.
const SAMPLES: u16 = 64;
/// Step of an arrow key for a stop, as a share of the ramp.
const NUDGE: f32 = 0.01;
/// The share of the ramp's height that the histogram behind it takes.
const BARS: f32 = 0.4;

/// Shows the editor of `stops` over the values of the grid; the name of the edit if anything
/// changed. `opened` is what the ramp goes back to.
pub fn show(
    ui: &mut Ui,
    stops: &mut Vec<Stop>,
    opened: &[Stop],
    voxels: Option<&VoxelDescription>,
) -> Option<&'static str> {
    let memory = ui.scope_id().with("ramp stop");
    let selected = ui.data(|data| data.get_temp::<usize>(memory)).unwrap_or(0);
    let mut editor =
        RampEditor { selected: selected.min(stops.len().saturating_sub(1)), edit: None };
    let span = steady_span(ui, memory, stops, voxels);
    editor.ramp(ui, stops, &span, voxels);
    editor.handles(ui, stops, &span);
    editor.buttons(ui, stops, opened, &span);
    editor.stop(ui, stops, opened, &span);
    ui.data_mut(|data| data.insert_temp(memory, editor.selected));
    editor.edit
}

/// The values that the ramp is drawn over: those of the grid, from zero, and those of the stops.
fn span(stops: &[Stop], voxels: Option<&VoxelDescription>) -> RangeInclusive<f32> {
    let ends = |pick: fn(f32, f32) -> f32, grid: Option<f32>| {
        stops.iter().map(|stop| stop[0]).chain(grid).fold(0.0, pick)
    };
    let low = ends(f32::min, voxels.map(|voxels| voxels.min));
    let high = ends(f32::max, voxels.map(|voxels| voxels.max));
    low..=if high > low { high } else { low + 1.0 }
}

/// The values that the ramp is drawn over, unchanged while a stop is dragged: the ramp must not
/// move under the pointer.
fn steady_span(
    ui: &Ui,
    memory: Id,
    stops: &[Stop],
    voxels: Option<&VoxelDescription>,
) -> RangeInclusive<f32> {
    let memory = memory.with("span");
    let dragged = |index| ui.ctx().is_being_dragged(handle_id(ui, index));
    let kept = ui.data(|data| data.get_temp::<RangeInclusive<f32>>(memory));
    match kept.filter(|_| (0..stops.len()).any(dragged)) {
        Some(kept) => kept,
        None => {
            let span = span(stops, voxels);
            ui.data_mut(|data| data.insert_temp(memory, span.clone()));
            span
        }
    }
}

fn handle_id(ui: &Ui, index: usize) -> Id {
    ui.scope_id().with(("stop", index))
}

struct RampEditor {
    selected: usize,
    edit: Option<&'static str>,
}

impl RampEditor {
    fn ramp(
        &mut self,
        ui: &mut Ui,
        stops: &mut Vec<Stop>,
        span: &RangeInclusive<f32>,
        voxels: Option<&VoxelDescription>,
    ) {
        let size = vec2(ui.available_width() - space::STOP, space::RAMP[0]);
        let margin = 0.5 * space::STOP;
        let (rect, _) = ui.allocate_exact_size(size + vec2(2.0 * margin, 0.0), Sense::empty());
        let rect = rect.shrink2(vec2(margin, 0.0));
        let response = ui.interact(rect, ui.scope_id().with("ramp"), Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Color ramp"));
        ui.painter().add(gradient(rect, stops, span));
        if let Some(voxels) = voxels {
            let bars = rect.with_min_y(rect.bottom() - BARS * rect.height());
            let place = |value| rect.left() + rect.width() * share(value, span);
            let bars = bars.with_min_x(place(voxels.min)).with_max_x(place(voxels.max));
            histogram_bars(ui.painter(), bars, voxels, color::TEXT_DIM.gamma_multiply(0.5));
        }
        let help = format!(
            "{}\n\nDouble-click to add a stop. The bars are the histogram of the grid.",
            key_help(KEY)
        );
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.double_clicked()) {
            self.selected = ramp_stops::add(stops, value_at(at.x, rect, span));
            self.edit = Some("add a stop");
        }
        response.on_hover_text(help);
    }

    fn handles(&mut self, ui: &mut Ui, stops: &mut Vec<Stop>, span: &RangeInclusive<f32>) {
        let size = vec2(ui.available_width(), space::RAMP[1]);
        ui.add_space(-ui.spacing().item_spacing.y);
        let (row, _) = ui.allocate_exact_size(size, Sense::empty());
        let rail = row.shrink2(vec2(0.5 * space::STOP, 0.0));
        let mut index = 0;
        while let Some(stop) = stops.get(index).copied() {
            let x = rail.left() + rail.width() * share(stop[0], span);
            let rect = Rect::from_center_size(pos2(x, row.center().y), vec2(space::STOP, size.y));
            let id = handle_id(ui, index);
            let response = ui.interact(rect, id, Sense::click_and_drag());
            let name = format!("Ramp stop {}", index + 1);
            response.widget_info(|| egui::WidgetInfo::slider(true, stop[0].into(), &name));
            if response.clicked() || response.drag_started() {
                response.request_focus();
            }
            if response.has_focus() || response.dragged() {
                self.selected = index;
            }
            if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
                ramp_stops::shift(stops, index, value_at(at.x, rail, span), span);
                self.edit = Some("move a stop");
            }
            let is_gone = response.has_focus() && self.keys(ui, id, stops, index, span);
            paint_handle(ui, rect, &response, stop, self.selected == index);
            response.on_hover_text("Drag, or move with the arrow keys; Delete removes it.");
            if is_gone {
                // The next one takes its place and its identity, in the next frame.
                ui.ctx().request_repaint();
                return;
            }
            index += 1;
        }
    }

    /// Keys for the stop that has the focus; whether it is gone.
    fn keys(
        &mut self,
        ui: &Ui,
        id: Id,
        stops: &mut Vec<Stop>,
        index: usize,
        span: &RangeInclusive<f32>,
    ) -> bool {
        let steps = arrow_steps(ui, id).x;
        if steps != 0.0 {
            let value = stops.get(index).map_or(0.0, |stop| stop[0]);
            let step = NUDGE * (span.end() - span.start());
            ramp_stops::shift(stops, index, value + steps * step, span);
            self.edit = Some("move a stop");
        }
        // Consumed, so that the next stop, which takes its place and focus, does not go too.
        let consume = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let deletes = (consume(Key::Delete) || consume(Key::Backspace)) && stops.len() > 1;
        if deletes {
            self.selected = ramp_stops::remove(stops, index);
            self.edit = Some("delete a stop");
        }
        deletes
    }

    fn buttons(
        &mut self,
        ui: &mut Ui,
        stops: &mut Vec<Stop>,
        opened: &[Stop],
        span: &RangeInclusive<f32>,
    ) {
        ui.horizontal(|ui| {
            let help = "Add a stop in the largest gap, in the color the ramp has there.";
            if ui.button("Add stop").on_hover_text(help).clicked() {
                self.selected = ramp_stops::add_anywhere(stops, span);
                self.edit = Some("add a stop");
            }
            let delete = ui.add_enabled(stops.len() > 1, egui::Button::new("Delete stop"));
            if delete.on_hover_text("Remove the selected stop.").clicked() {
                self.selected = ramp_stops::remove(stops, self.selected);
                self.edit = Some("delete a stop");
            }
            let reset = ui.add_enabled(*stops != opened, egui::Button::new("Reset ramp"));
            if reset.on_hover_text("Reset the ramp to the opened one.").clicked() {
                *stops = opened.to_vec();
                self.edit = Some("reset the ramp");
            }
        });
    }

    /// The numbers of the chosen stop.
    fn stop(
        &mut self,
        ui: &mut Ui,
        stops: &mut [Stop],
        opened: &[Stop],
        span: &RangeInclusive<f32>,
    ) {
        self.selected = self.selected.min(stops.len().saturating_sub(1));
        let Some(&[value, r, g, b]) = stops.get(self.selected) else { return };
        let reset = opened.get(self.selected).copied().unwrap_or([value, r, g, b]);
        let (name, mut moved) = (format!("Stop {} value", self.selected + 1), value);
        let number = Number {
            name: &name,
            key: KEY,
            soft: span.clone(),
            logarithmic: false,
            unit: "",
            reset: reset[0],
        };
        if number.show(ui, &mut moved) {
            // What is typed may lie beyond what is drawn.
            let wide = span.start().min(moved)..=span.end().max(moved);
            ramp_stops::shift(stops, self.selected, moved, &wide);
            self.edit = Some("move a stop");
        }
        let before = from_rgb([r, g, b]);
        let (mut hue, mut bright) = (before, strength(before));
        let brightness = Number {
            name: "Stop brightness",
            key: KEY,
            soft: 0.0..=strongest(stops).max(1.0) * 2.0,
            logarithmic: true,
            unit: "",
            reset: strength(from_rgb([reset[1], reset[2], reset[3]])),
        };
        brightness.show(ui, &mut bright);
        tint(ui, "Stop color", &key_help(KEY), &mut hue);
        let after = scaled(hue, bright.max(0.0));
        if after != scaled(before, strength(before))
            && let Some(stop) = stops.get_mut(self.selected)
        {
            let [r, g, b] = after.rgb().to_array();
            *stop = [stop[0], r, g, b];
            self.edit = Some("color of a stop");
        }
    }
}

fn share(value: f32, span: &RangeInclusive<f32>) -> f32 {
    ((value - span.start()) / (span.end() - span.start())).clamp(0.0, 1.0)
}

fn value_at(x: f32, rail: Rect, span: &RangeInclusive<f32>) -> f32 {
    let share = ((x - rail.left()) / rail.width().max(1.0)).clamp(0.0, 1.0);
    span.start() + share * (span.end() - span.start())
}

/// The largest channel of all stops.
fn strongest(stops: &[Stop]) -> f32 {
    stops.iter().flat_map(|[_, rgb @ ..]| rgb).copied().fold(0.0, f32::max)
}

/// A color as the screen shows it where `brightest` is white.
fn shown(rgb: [f32; 3], brightest: f32) -> Color32 {
    let [r, g, b] = rgb.map(|channel| (channel / brightest).clamp(0.0, 1.0));
    egui::Rgba::from_rgb(r, g, b).into()
}

fn gradient(rect: Rect, stops: &[Stop], span: &RangeInclusive<f32>) -> Mesh {
    let brightest = strongest(stops).max(f32::MIN_POSITIVE);
    let mut mesh = Mesh::default();
    for index in 0..=SAMPLES {
        let x = egui::lerp(rect.x_range(), f32::from(index) / f32::from(SAMPLES));
        let rgb = ramp_stops::color(stops, value_at(x, rect, span)).to_array();
        let color = shown(rgb, brightest);
        mesh.colored_vertex(pos2(x, rect.top()), color);
        mesh.colored_vertex(pos2(x, rect.bottom()), color);
        if index > 0 {
            let at = 2 * u32::from(index);
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at, at + 1);
        }
    }
    mesh
}

/// A house with its tip at the ramp, in the hue of its stop.
fn paint_handle(ui: &Ui, rect: Rect, response: &Response, stop: Stop, is_selected: bool) {
    let rect = rect.shrink2(vec2(1.5, 1.0));
    let shoulder = rect.top() + 0.4 * rect.height();
    let outline = vec![
        rect.center_top(),
        pos2(rect.right(), shoulder),
        rect.right_bottom(),
        rect.left_bottom(),
        pos2(rect.left(), shoulder),
    ];
    let [_, rgb @ ..] = stop;
    let hue = scaled(Color::Rgb(rgb), 1.0).rgb().to_array();
    let fill = shown(if rgb == [0.0; 3] { rgb } else { hue }, 1.0);
    let line = match (is_selected, response.hovered() || response.has_focus()) {
        (true, _) => Stroke::new(2.0, color::ACCENT),
        (false, true) => Stroke::new(1.0, color::TEXT_STRONG),
        (false, false) => Stroke::new(1.0, color::TEXT_DIM),
    };
    ui.painter().add(Shape::convex_polygon(outline, fill, line));
}
