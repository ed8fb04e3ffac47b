//! The camera: place, target, lens and keys.

use egui::{Button, DragValue, Ui};

use super::{Panel, section};
use crate::app::command::Command;
use crate::app::ui::theme::space;
use crate::app::ui::widgets::{
    Number, Vector, finite, is_reset, key_help, row, row_label, significant,
};
use crate::scene::keys;
use crate::scene::settings::{CameraSettings, field_of_view, focal_length};

/// Width of the field for a focal length, in points.
const FOCAL_LENGTH: f32 = 58.0;
/// Width of the button that chooses the focus on the picture, in points.
const PICK: f32 = 40.0;

/// Shows the section: the camera of the present frame.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Camera", |ui| {
        let opened = panel.editor.opened().settings.present_camera();
        let mut camera = panel.editor.document.settings.present_camera();
        let edit = view_rows(ui, &mut camera, &opened);
        let edit = edit.or(lens_rows(ui, panel, &mut camera, &opened));
        if let Some(name) = edit {
            panel.editor.document.settings.set_present_camera(camera);
            panel.editor.name_edit(name);
        }
        key_row(ui, panel);
        command_button(ui, panel, Command::FrameVolume);
    });
}

/// Shows place, target and field of view; the name of the edit, if one was made.
fn view_rows(
    ui: &mut Ui,
    camera: &mut CameraSettings,
    opened: &CameraSettings,
) -> Option<&'static str> {
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
    if field_of_view_row(ui, camera, opened.fov_x) {
        edit = Some("field of view");
    }
    edit
}

/// Shows shift, aperture and focus; the name of the edit, if one was made.
fn lens_rows(
    ui: &mut Ui,
    panel: &mut Panel<'_>,
    camera: &mut CameraSettings,
    opened: &CameraSettings,
) -> Option<&'static str> {
    let mut edit = None;
    if shift_row(ui, &mut camera.shift, opened.shift) {
        edit = Some("lens shift");
    }
    let number =
        |name, key, soft, reset| Number { name, key, soft, logarithmic: true, unit: "", reset };
    let f_stop = number("F-stop", "camera.f_stop", 0.0..=32.0, opened.f_stop);
    if f_stop.show(ui, &mut camera.f_stop) {
        edit = Some("f-stop");
    }
    if camera.f_stop == 0.0 {
        return edit;
    }
    let units = number("Units per mm", "camera.units_per_mm", 1e-4..=10.0, opened.units_per_mm);
    if units.show(ui, &mut camera.units_per_mm) {
        edit = Some("units per millimeter");
    }
    if focus_row(ui, panel, camera, opened) {
        edit = Some("focus distance");
    }
    edit
}

/// The distance of the plane of focus, with a button that chooses it on the picture; whether it
/// changed.
fn focus_row(
    ui: &mut Ui,
    panel: &mut Panel<'_>,
    camera: &mut CameraSettings,
    opened: &CameraSettings,
) -> bool {
    let key = "camera.focus_distance";
    let mut distance = camera.focus_distance();
    let number = Number {
        name: "Focus distance",
        key,
        soft: 0.0..=2.0 * opened.focus_distance(),
        logarithmic: false,
        unit: "",
        reset: opened.focus_distance(),
    };
    let limits = keys::find(key).map_or([0.0, f64::MAX], |key| key.limits);
    let limits = [limits[0].max(f64::from(f32::MIN_POSITIVE)), limits[1]];
    let (pick, commands) = (Command::FocusByClick, &mut *panel.commands);
    let button = |ui: &mut Ui, _: &mut f32| {
        let button = ui.add_sized([PICK, space::ROW_HEIGHT], Button::new("Pick"));
        if button.accessible_name(pick.text()).on_hover_text(pick.tooltip()).clicked() {
            commands.push(pick);
        }
    };
    let changed = number.show_beside(ui, &mut distance, (&key_help(key), limits), (PICK, button));
    if changed {
        camera.focus_distance = Some(distance);
    }
    changed
}

/// Two numbers for the shift of the lens; whether they changed.
fn shift_row(ui: &mut Ui, shift: &mut [f32; 2], reset: [f32; 2]) -> bool {
    let before = *shift;
    let key = "camera.shift";
    let help = format!("{}\n\nDouble-click the name to reset.", key_help(key));
    let [low, high] = keys::find(key).map_or([f64::MIN, f64::MAX], |key| key.limits);
    ui.horizontal(|ui| {
        let label = row_label(ui, "Lens shift", &help);
        for (value, name) in shift.iter_mut().zip(["Lens shift x", "Lens shift y"]) {
            let field = DragValue::new(value)
                .speed(0.002)
                .range(low..=high)
                .custom_formatter(|value, _| significant(value))
                .custom_parser(finite);
            let response = ui.add_sized([space::NUMBER, space::ROW_HEIGHT], field);
            response.accessible_name(name).on_hover_text(&help);
        }
        if is_reset(ui, &[&label]) {
            *shift = reset;
        }
    });
    *shift != before
}

/// Shows the keys of the camera, and the command that sets one for the frame or removes it.
fn key_row(ui: &mut Ui, panel: &mut Panel<'_>) {
    let settings = &panel.editor.document.settings;
    let camera = &settings.camera;
    if panel.frames.is_none() && camera.key.is_empty() {
        return;
    }
    let count = camera.key.len();
    let text = match camera.key_of(settings.time.frame) {
        Some(_) => "Remove key",
        None => "Set key",
    };
    let command = Command::CameraKey;
    let clicked = row(ui, "Camera keys", command.tooltip(), |ui| {
        let clicked = ui.button(text).on_hover_text(command.tooltip()).clicked();
        ui.weak(match count {
            0 => "none: the camera stands still".to_owned(),
            1 => "one".to_owned(),
            _ => format!("{count}"),
        });
        clicked
    });
    if clicked.inner {
        panel.commands.push(command);
    }
}

fn command_button(ui: &mut Ui, panel: &mut Panel<'_>, command: Command) {
    let key = ui.ctx().format_shortcut(&command.shortcut());
    let button = Button::new(command.text()).shortcut_text(key);
    if ui.add(button).on_hover_text(command.tooltip()).clicked() {
        panel.commands.push(command);
    }
}

/// The field of view in degrees, with the focal length beside it; whether it changed.
fn field_of_view_row(ui: &mut Ui, camera: &mut CameraSettings, reset: f32) -> bool {
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
    let sensor = camera.sensor_width;
    let beside = |ui: &mut Ui, fov: &mut f32| focal_length_field(ui, fov, sensor);
    number.show_beside(ui, &mut camera.fov_x, (&key_help(key), limits), (FOCAL_LENGTH, beside))
}

/// A field for the focal length that goes with a field of view in degrees on a sensor of a width.
fn focal_length_field(ui: &mut Ui, fov: &mut f32, sensor: f32) {
    let mut length = focal_length(*fov, sensor);
    let field = DragValue::new(&mut length)
        .range(1.0..=2000.0)
        .clamp_existing_to_range(false)
        .speed(0.1)
        .max_decimals(1)
        .suffix(" mm")
        .custom_parser(finite);
    ui.spacing_mut().button_padding.x = 2.0;
    let field = ui.add_sized([FOCAL_LENGTH, space::ROW_HEIGHT], field);
    let help = format!("The focal length for a sensor {sensor} mm wide.");
    if field.accessible_name("Focal length").on_hover_text(help).changed() {
        *fov = field_of_view(length.into(), sensor.into()) as f32;
    }
}
