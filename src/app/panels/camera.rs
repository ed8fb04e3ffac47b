//! Where the picture is taken from.

use egui::Ui;

use super::{Panel, section};
use crate::app::command::Command;
use crate::app::ui::widgets::{Number, Vector};

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
        let angle = Number {
            name: "Angle of view",
            key: "camera.fov_x",
            soft: 5.0..=120.0,
            logarithmic: false,
            unit: "°",
            reset: opened.fov_x,
        };
        if angle.show(ui, &mut camera.fov_x) {
            edit = Some("angle of view");
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
