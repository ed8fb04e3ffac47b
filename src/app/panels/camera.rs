//! The camera: place, target and field of view.

use egui::{DragValue, Ui};

use super::{Panel, section};
use crate::app::command::Command;
use crate::app::ui::theme::space;
use crate::app::ui::widgets::{Number, Vector, finite, key_help};
use crate::scene::keys;

/// Width of the sensor that focal lengths are given for, in millimeters: full frame.
const SENSOR: f32 = 36.0;
/// Width of the field for a focal length, in points.
const FOCAL_LENGTH: f32 = 58.0;

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Camera", |ui| {
        let opened = panel.editor.opened().settings.camera;
        let camera = &mut panel.editor.document.settings.camera;
        let distance = glam::Vec3::from(camera.position).distance(camera.target.into());
        let speed = (distance * 0.005).max(1e-4);
        let mut edit = None;
        let vector = |name, key, speed, reset| Vector { name, key, speed, unit: "", reset };
        let position = vector("Position", "camera.position", speed, opened.position);
        if position.show(ui, &mut camera.position) {
            edit = Some("camera position");
        }
        let target = vector("Target", "camera.target", speed, opened.target);
        if target.show(ui, &mut camera.target) {
            edit = Some("camera target");
        }
        if vector("Up", "camera.up", 0.01, opened.up).show(ui, &mut camera.up) {
            edit = Some("camera up");
        }
        if field_of_view(ui, &mut camera.fov_x, opened.fov_x) {
            edit = Some("field of view");
        }
        if let Some(name) = edit {
            panel.editor.name_edit(name);
        }
        let frame = Command::FrameVolume;
        let key = ui.ctx().format_shortcut(&frame.shortcut());
        let button = egui::Button::new(frame.text()).shortcut_text(key);
        if ui.add(button).on_hover_text(frame.tooltip()).clicked() {
            panel.commands.push(frame);
        }
    });
}

/// The field of view in degrees, with the focal length beside it; whether it changed.
fn field_of_view(ui: &mut Ui, fov: &mut f32, reset: f32) -> bool {
    let key = "camera.fov_x";
    let number = Number {
        name: "Field of view",
        key,
        soft: 5.0..=120.0,
        logarithmic: false,
        unit: "°",
        reset,
    };
    let limits = keys::find(key).map_or([0.0, 180.0], |key| key.limits);
    number.show_beside(ui, fov, (&key_help(key), limits), (FOCAL_LENGTH, focal_length_field))
}

/// A field for the focal length that goes with a field of view in degrees.
fn focal_length_field(ui: &mut Ui, fov: &mut f32) {
    let mut length = focal_length(*fov);
    let field = DragValue::new(&mut length)
        .range(1.0..=2000.0)
        .clamp_existing_to_range(false)
        .speed(0.1)
        .max_decimals(1)
        .suffix(" mm")
        .custom_parser(finite);
    ui.spacing_mut().button_padding.x = 2.0;
    let field = ui.add_sized([FOCAL_LENGTH, space::ROW_HEIGHT], field);
    let help = "The focal length for a sensor 36 mm wide (full frame).";
    if field.accessible_name("Focal length").on_hover_text(help).changed() {
        *fov = field_of_view_of(length);
    }
}

/// The focal length, in millimeters, of a horizontal field of view in degrees.
fn focal_length(fov: f32) -> f32 {
    0.5 * SENSOR / (0.5 * fov.to_radians()).tan()
}

/// The horizontal field of view in degrees of a focal length in millimeters.
fn field_of_view_of(focal_length: f32) -> f32 {
    2.0 * (0.5 * SENSOR / focal_length).atan().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn focal_lengths_are_those_of_full_frame() {
        assert!((focal_length(39.6) - 50.0).abs() < 0.05, "a normal lens");
        assert!((focal_length(90.0) - 18.0).abs() < 1e-4);
        for fov in [5.0, 36.0, 120.0] {
            assert!((field_of_view_of(focal_length(fov)) - fov).abs() < 1e-3);
        }
    }
}
