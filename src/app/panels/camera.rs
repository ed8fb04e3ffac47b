//! Where the picture is taken from.

use egui::Ui;

use super::{Panel, section};
use crate::app::commands::Command;
use crate::app::widgets::{Number, vector};

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Camera", |ui| {
        let reset = panel.editor.opened().settings.camera.fov_x;
        let camera = &mut panel.editor.document.settings.camera;
        let distance = glam::Vec3::from(camera.position).distance(camera.target.into());
        let speed = (distance * 0.005).max(1e-4);
        let mut edit = None;
        if vector(ui, "Position", "camera.position", &mut camera.position, speed) {
            edit = Some("camera position");
        }
        if vector(ui, "Target", "camera.target", &mut camera.target, speed) {
            edit = Some("camera target");
        }
        if vector(ui, "Up", "camera.up", &mut camera.up, 0.01) {
            edit = Some("camera up");
        }
        let angle = Number {
            name: "Angle of view",
            key: "camera.fov_x",
            soft: 5.0..=120.0,
            logarithmic: false,
            unit: "°",
            reset,
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
