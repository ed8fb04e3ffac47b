//! The lights beside the fire itself: the environment, a list of lamps to add to, and the keys of
//! the one that is selected.

use egui::{Button, RichText, Ui, vec2};

use super::{Panel, environment, folded_section, setup};
use crate::app::ui::theme::color;
use crate::app::ui::widgets::{
    Number, Vector, color_rows, key_help, row_label, scaled, segments, significant, strength,
};
use crate::scene::new_light;
use crate::scene::settings::{CameraSettings, LightKind, LightSettings};

/// The kinds with their names and what they are good for.
const KINDS: [(LightKind, &str, &str); 5] = [
    (LightKind::Sun, "Sun", "A distant light from one direction: sun or moon."),
    (LightKind::Point, "Point", "A point that shines in all directions: hard shadows, no size."),
    (LightKind::Spot, "Spot", "A point that shines into a cone."),
    (LightKind::Sphere, "Sphere light", "An emitting sphere: a lamp that the camera can see."),
    (LightKind::Quad, "Area light", "An emitting parallelogram: a window or a softbox."),
];

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    folded_section(ui, "Lights", |ui| {
        let edit = setup::show(ui, panel);
        let mut edit = edit.or(environment::rows(ui, panel));
        let camera = panel.editor.document.settings.present_camera();
        let opened = panel.editor.opened().settings.light.clone();
        let lights = &mut panel.editor.document.settings.light;
        edit = edit.or(add(ui, lights, &camera, panel.selected_light));
        *panel.selected_light = panel.selected_light.filter(|index| *index < lights.len());
        if lights.is_empty() {
            ui.weak("No lights yet.");
        }
        let kinds: Vec<LightKind> = lights.iter().map(|light| light.kind).collect();
        for index in 0..kinds.len() {
            item(ui, lights, index, panel.selected_light);
            if *panel.selected_light == Some(index) {
                let reset = opened.get(index).filter(|light| light.kind == kinds[index]);
                let reset = reset.cloned().unwrap_or_else(|| new_light(kinds[index], &camera));
                let shown = ui.indent(("light", index), |ui| {
                    let changed = keys(ui, &mut lights[index], &reset, &camera);
                    changed.or(buttons(ui, lights, index, panel.selected_light))
                });
                edit = edit.or(shown.inner);
            }
            // The list is another one after that.
            if lights.len() != kinds.len() {
                break;
            }
        }
        let same = lights.iter().zip(&kinds).all(|(light, kind)| light.kind == *kind);
        if let Some(name) = edit {
            panel.editor.name_edit(name);
        }
        if !same {
            panel.editor.choose();
        }
    });
}

/// A button for each kind.
fn add(
    ui: &mut Ui,
    lights: &mut Vec<LightSettings>,
    camera: &CameraSettings,
    selected: &mut Option<usize>,
) -> Option<&'static str> {
    let mut edit = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.label(RichText::new("Add").color(color::TEXT_DIM));
        for (kind, name, help) in KINDS {
            let response = ui.button(name).on_hover_text(format!("Add a light. {help}"));
            if response.accessible_name(format!("Add {}", name.to_lowercase())).clicked() {
                *selected = Some(lights.len());
                lights.push(new_light(kind, camera));
                edit = Some("add a light");
            }
        }
    });
    edit
}

/// The row of a light: its name, which selects it, and how bright it is.
fn item(ui: &mut Ui, lights: &[LightSettings], index: usize, selected: &mut Option<usize>) {
    let Some(light) = lights.get(index) else { return };
    let is_selected = *selected == Some(index);
    let name = format!("{} {}", name_of(light.kind), index + 1);
    let tint = if is_selected { color::TEXT_STRONG } else { color::TEXT_DIM };
    let bright = RichText::new(brightness(light)).small().color(tint);
    let button = Button::selectable(is_selected, &*name).right_text(bright);
    let response = ui.add(button.min_size(vec2(ui.available_width(), 0.0)));
    let help = "Show the settings of this light, and handles over the picture that move it.";
    if response.on_hover_text(help).accessible_name(&name).clicked() {
        *selected = if is_selected { None } else { Some(index) };
    }
}

fn buttons(
    ui: &mut Ui,
    lights: &mut Vec<LightSettings>,
    index: usize,
    selected: &mut Option<usize>,
) -> Option<&'static str> {
    let mut edit = None;
    ui.horizontal(|ui| {
        let help = "Add a copy of the light at the same place.";
        if ui.button("Duplicate light").on_hover_text(help).clicked() {
            let copy = lights.get(index).cloned();
            lights.splice(index + 1..index + 1, copy);
            *selected = Some(index + 1);
            edit = Some("duplicate a light");
        }
        let help = "Remove the light from the scene. This can be undone.";
        if ui.button("Delete light").on_hover_text(help).clicked() && index < lights.len() {
            lights.remove(index);
            *selected = None;
            edit = Some("delete a light");
        }
    });
    edit
}

fn name_of(kind: LightKind) -> &'static str {
    KINDS.iter().find(|(other, ..)| *other == kind).map_or("Light", |(_, name, _)| name)
}

/// Brightness of a light in words.
fn brightness(light: &LightSettings) -> String {
    let number = significant(strength(light.intensity).into());
    match light.kind {
        LightKind::Sun => format!("irradiance {number}"),
        LightKind::Point | LightKind::Spot => format!("{number} W/sr"),
        LightKind::Sphere | LightKind::Quad => format!("radiance {number}"),
    }
}

/// Shows the kind, brightness, place and size of a light; the name of the edit if anything changed.
fn keys(
    ui: &mut Ui,
    light: &mut LightSettings,
    reset: &LightSettings,
    camera: &CameraSettings,
) -> Option<&'static str> {
    let mut edit = None;
    if choose_type(ui, &mut light.kind) {
        *light = changed_kind(light, camera);
        return Some("light type");
    }
    let kind = light.kind;
    let name = match kind {
        LightKind::Sun => "Irradiance",
        LightKind::Point | LightKind::Spot => "Intensity",
        LightKind::Sphere | LightKind::Quad => "Radiance",
    };
    let around = strength(reset.intensity);
    let number = Number {
        name,
        key: "light.N.intensity",
        soft: 0.0..=if around > 0.0 { around * 10.0 } else { 10.0 },
        logarithmic: true,
        unit: if name == "Intensity" { " W/sr" } else { "" },
        reset: around,
    };
    if color_rows(ui, number, "Light color", &mut light.intensity) {
        edit = Some("brightness of a light");
    }
    edit = edit.or(place(ui, light, reset, camera)).or(shape(ui, light, reset));
    if !matches!(kind, LightKind::Point | LightKind::Spot) {
        let help = key_help("light.N.visible");
        if ui.checkbox(&mut light.visible, "Visible to camera").on_hover_text(help).changed() {
            edit = Some("light visibility");
        }
    }
    edit
}

/// The types of light by their names in the window; whether another one was chosen.
fn choose_type(ui: &mut Ui, kind: &mut LightKind) -> bool {
    let choices = KINDS.map(|(_, name, help)| (name, help));
    let chosen = KINDS.iter().position(|(other, ..)| other == kind);
    row_label(ui, "Light type", &key_help("light.N.type"));
    let clicked = ui.name_inputs("Light type", |ui| segments(ui, &choices, chosen));
    let clicked = clicked.filter(|index| Some(*index) != chosen);
    let Some((other, ..)) = clicked.and_then(|index| KINDS.get(index)) else { return false };
    *kind = *other;
    true
}

/// A light of the kind that was just chosen, where the old one stood, with its hue.
fn changed_kind(light: &LightSettings, camera: &CameraSettings) -> LightSettings {
    let stood = light.position.or(light.center);
    let mut fresh = new_light(light.kind, camera);
    fresh.intensity = scaled(light.intensity, strength(fresh.intensity));
    fresh.visible = light.visible;
    if fresh.position.is_some() {
        fresh.position = stood.or(fresh.position);
    } else if fresh.center.is_some() {
        fresh.center = stood.or(fresh.center);
    }
    fresh
}

/// Rows for the position or the direction of a light.
fn place(
    ui: &mut Ui,
    light: &mut LightSettings,
    reset: &LightSettings,
    camera: &CameraSettings,
) -> Option<&'static str> {
    let distance = glam::Vec3::from(camera.position).distance(camera.target.into());
    let speed = (distance * 0.002).max(1e-4);
    let vector = |name, key, speed, reset| Vector { name, key, speed, unit: "", reset };
    let mut changed = false;
    let mut row = |value: &mut Option<[f32; 3]>, mut present: [f32; 3], vector: Vector<'_>| {
        if vector.show(ui, &mut present) {
            *value = Some(present);
            changed = true;
        }
    };
    match light.kind {
        LightKind::Sun => {
            let present = light.direction();
            let shown = vector("Direction", "light.N.direction", 0.01, reset.direction());
            row(&mut light.direction, present, shown);
        }
        LightKind::Point | LightKind::Spot => {
            let present = light.position();
            let shown = vector("Light position", "light.N.position", speed, reset.position());
            row(&mut light.position, present, shown);
            if light.kind == LightKind::Spot {
                let present = light.target();
                let shown = vector("Target", "light.N.target", speed, reset.target());
                row(&mut light.target, present, shown);
            }
        }
        LightKind::Sphere | LightKind::Quad => {
            let present = light.center();
            let shown = vector("Light center", "light.N.center", speed, reset.center());
            row(&mut light.center, present, shown);
            if light.kind == LightKind::Quad {
                let present = light.half_u();
                let shown = vector("Edge u", "light.N.half_u", speed, reset.half_u());
                row(&mut light.half_u, present, shown);
                let present = light.half_v();
                let shown = vector("Edge v", "light.N.half_v", speed, reset.half_v());
                row(&mut light.half_v, present, shown);
            }
        }
    }
    changed.then_some("place of a light")
}

/// Rows for the size or the angle of a light.
fn shape(ui: &mut Ui, light: &mut LightSettings, reset: &LightSettings) -> Option<&'static str> {
    let number = |name, key, most: f32, unit, reset| Number {
        name,
        key,
        soft: 0.0..=most,
        logarithmic: false,
        unit,
        reset,
    };
    let mut changed = false;
    let mut row = |value: &mut Option<f32>, mut present: f32, least: f32, number: Number<'_>| {
        if number.show(ui, &mut present) {
            *value = Some(present.max(least));
            changed = true;
        }
    };
    match light.kind {
        LightKind::Sun => {
            let present = light.angle();
            let shown = number("Angular diameter", "light.N.angle", 30.0, "°", reset.angle());
            row(&mut light.angle, present, 0.0, shown);
        }
        LightKind::Spot => {
            let present = light.cone();
            let shown = number("Cone", "light.N.cone", 180.0, "°", reset.cone());
            row(&mut light.cone, present, 0.1, shown);
            let present = light.blend();
            let shown = number("Blend", "light.N.blend", 1.0, "", reset.blend());
            row(&mut light.blend, present, 0.0, shown);
        }
        LightKind::Sphere => {
            let present = light.radius();
            let most = reset.radius() * 5.0;
            let shown = number("Light radius", "light.N.radius", most, "", reset.radius());
            row(&mut light.radius, present, most * 1e-4, shown);
        }
        LightKind::Point | LightKind::Quad => {}
    }
    changed.then_some("size of a light")
}
