//! Floors, walls and other solid things: a list to add to, and the keys of each.

use egui::{CollapsingHeader, RichText, Ui};

use super::{Panel, folded_section, placement};
use crate::app::ui::theme::color;
use crate::app::ui::widgets::{
    Number, Vector, choice, color_rows, key_help, row_label, segments, strength,
};
use crate::math::Aabb;
use crate::scene::floor_under;
use crate::scene::settings::{
    Extent, MaterialKind, MaterialSettings, SurfaceSettings, SurfaceShape,
};

/// The shapes with their names and what they are good for.
const SHAPES: [(SurfaceShape, &str, &str); 4] = [
    (SurfaceShape::Plane, "Plane", "An infinite plane, or a square."),
    (SurfaceShape::Quad, "Quad", "A parallelogram: a wall or a card."),
    (SurfaceShape::Sphere, "Sphere", "A sphere."),
    (SurfaceShape::Box, "Box", "An axis-aligned box."),
];
/// The size of a new surface, relative to that of what fills space.
const NEW_SIZE: f32 = 0.25;
const MATERIALS: [(Option<MaterialKind>, &str, &str); 4] = [
    (None, "Auto", "Diffuse gray, or black if the surface emits."),
    (Some(MaterialKind::Diffuse), "Diffuse", "Reflects evenly in all directions, like chalk."),
    (Some(MaterialKind::Conductor), "Metal", "Reflects like rough metal."),
    (Some(MaterialKind::Black), "Black", "Reflects nothing."),
];

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    folded_section(ui, "Surfaces", |ui| {
        let bounds = panel.bounds;
        let up = glam::Vec3A::from(panel.editor.document.settings.camera.up);
        let opened = panel.editor.opened().settings.surface.clone();
        let surfaces = &mut panel.editor.document.settings.surface;
        let shapes: Vec<SurfaceShape> = surfaces.iter().map(|surface| surface.shape).collect();
        let mut edit = floor_button(ui, surfaces, &bounds, up);
        edit = edit.or(add(ui, surfaces, &bounds));
        if surfaces.is_empty() {
            ui.weak("No surfaces yet.");
        }
        for index in 0..surfaces.len() {
            let count = surfaces.len();
            let header = CollapsingHeader::new(title(&surfaces[index], index));
            let header = header.id_salt(("surface", index)).default_open(index >= shapes.len());
            let shown = header.show(ui, |ui| {
                let reset = opened.get(index).cloned().unwrap_or_else(|| surfaces[index].clone());
                let changed = keys(ui, &mut surfaces[index], &reset, &bounds);
                changed.or(buttons(ui, surfaces, index))
            });
            edit = edit.or(shown.body_returned.flatten());
            // The list is another one after that.
            if surfaces.len() != count {
                break;
            }
        }
        let chose = surfaces.iter().zip(&shapes).any(|(surface, shape)| surface.shape != *shape);
        if let Some(name) = edit {
            panel.editor.name_edit(name);
        }
        if chose {
            panel.editor.choose();
        }
    });
}

fn title(surface: &SurfaceSettings, index: usize) -> String {
    let name = SHAPES.iter().find(|(shape, ..)| *shape == surface.shape);
    let emits = if surface.emission.is_black() { "" } else { ", emitting" };
    format!("{} {}{emits}", name.map_or("Surface", |(_, name, _)| name), index + 1)
}

fn floor_button(
    ui: &mut Ui,
    surfaces: &mut Vec<SurfaceSettings>,
    bounds: &Aabb,
    up: glam::Vec3A,
) -> Option<&'static str> {
    let help = "A gray floor just below the volumes, twenty times as wide. Fire lights it, and it \
                reflects light to the smoke from below.";
    ui.button("Add floor").on_hover_text(help).clicked().then(|| {
        surfaces.push(floor_under(bounds, up));
        "add a floor"
    })
}

/// A button for each shape.
fn add(ui: &mut Ui, surfaces: &mut Vec<SurfaceSettings>, bounds: &Aabb) -> Option<&'static str> {
    let mut edit = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.label(RichText::new("Add").color(color::TEXT_DIM));
        for (shape, name, help) in SHAPES {
            let response = ui.button(name).on_hover_text(format!("Add a surface. {help}"));
            let name = format!("Add {}", name.to_lowercase());
            if response.accessible_name(format!("{name} surface")).clicked() {
                surfaces.push(new_surface(shape, bounds));
                edit = Some("add a surface");
            }
        }
    });
    edit
}

/// A surface beside what fills space.
fn new_surface(shape: SurfaceShape, bounds: &Aabb) -> SurfaceSettings {
    let size = NEW_SIZE * bounds.size().max_element();
    let beside = bounds.center() + glam::Vec3A::X * (0.5 * bounds.size().x + 1.5 * size);
    let fresh = SurfaceSettings { shape, ..SurfaceSettings::default() };
    match shape {
        SurfaceShape::Plane => {
            let point = [0.0, 0.0, bounds.min.z - size];
            SurfaceSettings { point: Some(point), ..fresh }
        }
        SurfaceShape::Quad => SurfaceSettings {
            center: Some(beside.to_array()),
            half_u: Some([0.0, size, 0.0]),
            half_v: Some([0.0, 0.0, size]),
            ..fresh
        },
        SurfaceShape::Sphere => {
            SurfaceSettings { center: Some(beside.to_array()), radius: Some(size), ..fresh }
        }
        SurfaceShape::Box => SurfaceSettings {
            center: Some(beside.to_array()),
            half_size: Some(Extent::Axes([size; 3])),
            ..fresh
        },
    }
}

fn buttons(ui: &mut Ui, surfaces: &mut Vec<SurfaceSettings>, index: usize) -> Option<&'static str> {
    let mut edit = None;
    ui.horizontal(|ui| {
        let help = "Add a copy of the surface at the same place.";
        if ui.button("Duplicate surface").on_hover_text(help).clicked() {
            let copy = surfaces.get(index).cloned();
            surfaces.splice(index + 1..index + 1, copy);
            edit = Some("duplicate a surface");
        }
        let help = "Remove the surface from the scene. This can be undone.";
        if ui.button("Delete surface").on_hover_text(help).clicked() && index < surfaces.len() {
            surfaces.remove(index);
            edit = Some("delete a surface");
        }
    });
    edit
}

/// Rows for shape, place, material and emission; the name of the edit if anything changed.
fn keys(
    ui: &mut Ui,
    surface: &mut SurfaceSettings,
    reset: &SurfaceSettings,
    bounds: &Aabb,
) -> Option<&'static str> {
    let mut edit = None;
    if choice(ui, "Shape", "surface.N.shape", &mut surface.shape) {
        let fresh = new_surface(surface.shape, bounds);
        let center = surface.center.or(surface.point);
        let is_plane = surface.shape == SurfaceShape::Plane;
        *surface = SurfaceSettings {
            material: surface.material,
            emission: surface.emission,
            center: if is_plane { None } else { center.or(fresh.center) },
            point: if is_plane { center.or(fresh.point) } else { None },
            ..fresh
        };
        return Some("shape of a surface");
    }
    edit = edit.or(place(ui, surface, reset, bounds));
    edit = edit.or(material(ui, surface, reset));
    let around = strength(reset.emission);
    let number = Number {
        name: "Emission",
        key: "surface.N.emission",
        soft: 0.0..=if around > 0.0 { around * 10.0 } else { 10.0 },
        logarithmic: true,
        unit: "",
        reset: around,
    };
    if color_rows(ui, number, "Emission color", &mut surface.emission) {
        edit = Some("surface emission");
    }
    edit
}

fn place(
    ui: &mut Ui,
    surface: &mut SurfaceSettings,
    reset: &SurfaceSettings,
    bounds: &Aabb,
) -> Option<&'static str> {
    let size = bounds.size().max_element();
    let speed = (size * 0.005).max(1e-4);
    let mut changed = false;
    let mut row = |value: &mut Option<[f32; 3]>,
                   mut present: [f32; 3],
                   (name, key, speed): (&str, &str, f32),
                   reset: [f32; 3]| {
        let vector = Vector { name, key, speed, unit: "", reset };
        if vector.show(ui, &mut present) {
            *value = Some(present);
            changed = true;
        }
    };
    if surface.shape == SurfaceShape::Plane {
        let (point, normal) = (surface.point(), surface.normal());
        let row_point = ("Position", "surface.N.point", speed);
        row(&mut surface.point, point, row_point, reset.point());
        row(&mut surface.normal, normal, ("Normal", "surface.N.normal", 0.01), reset.normal());
    } else {
        let center = surface.center();
        let row_center = ("Center", "surface.N.center", speed);
        row(&mut surface.center, center, row_center, reset.center());
    }
    if surface.shape == SurfaceShape::Quad {
        let (u, v) = (surface.half_u(), surface.half_v());
        row(&mut surface.half_u, u, ("Edge u", "surface.N.half_u", speed), reset.half_u());
        row(&mut surface.half_v, v, ("Edge v", "surface.N.half_v", speed), reset.half_v());
    }
    changed |= measures(ui, surface, reset, size);
    changed.then_some("place of a surface")
}

/// Rows for the measures of a surface; whether one changed.
fn measures(
    ui: &mut Ui,
    surface: &mut SurfaceSettings,
    reset: &SurfaceSettings,
    size: f32,
) -> bool {
    let key = "surface.N.half_size";
    match surface.shape {
        SurfaceShape::Quad => false,
        SurfaceShape::Sphere => {
            let mut radius = surface.radius();
            let number = Number {
                name: "Radius",
                key: "surface.N.radius",
                soft: 0.0..=reset.radius() * 5.0,
                logarithmic: false,
                unit: "",
                reset: reset.radius(),
            };
            let changed = number.show(ui, &mut radius) && radius > 0.0;
            if changed {
                surface.radius = Some(radius);
            }
            changed
        }
        SurfaceShape::Box => {
            let mut half = surface.half_size.unwrap_or_default();
            let reset = reset.half_size.unwrap_or_default();
            let changed = placement::size(ui, key, &mut half, reset);
            if changed {
                surface.half_size = Some(half);
            }
            changed
        }
        SurfaceShape::Plane => square(ui, surface, reset, size),
    }
}

/// Whether a plane ends, and where; whether that changed.
fn square(ui: &mut Ui, surface: &mut SurfaceSettings, reset: &SurfaceSettings, size: f32) -> bool {
    let key = "surface.N.half_size";
    let mut changed = false;
    let mut ends = surface.half_size.is_some();
    if ui.checkbox(&mut ends, "Finite").on_hover_text(key_help(key)).changed() {
        surface.half_size = ends.then_some(Extent::Uniform(20.0 * size.max(1e-3)));
        changed = true;
    }
    if let Some(mut half) = surface.half_size {
        let reset = reset.half_size.unwrap_or(half);
        if placement::size(ui, key, &mut half, reset) {
            surface.half_size = Some(half);
            changed = true;
        }
    }
    changed
}

fn material(
    ui: &mut Ui,
    surface: &mut SurfaceSettings,
    reset: &SurfaceSettings,
) -> Option<&'static str> {
    let mut edit = None;
    let kind = surface.material.map(|material| material.kind);
    let choices = MATERIALS.map(|(_, name, help)| (name, help));
    let chosen = MATERIALS.iter().position(|(other, ..)| *other == kind);
    let help = key_help("surface.N.material.type");
    row_label(ui, "Material", &help);
    let clicked = ui.name_inputs("Material", |ui| segments(ui, &choices, chosen));
    if let Some((other, ..)) = clicked.and_then(|index| MATERIALS.get(index)) {
        let reflectance = surface.material.and_then(|material| material.reflectance);
        surface.material = other.map(|kind| MaterialSettings {
            kind,
            reflectance: reflectance.filter(|_| kind != MaterialKind::Black),
            alpha: None,
        });
        edit = Some("material");
    }
    let Some(material) = &mut surface.material else { return edit };
    if material.kind == MaterialKind::Black {
        return edit;
    }
    let before = reset.material.unwrap_or_default();
    let mut reflectance = material.reflectance();
    let number = Number {
        name: "Reflectance",
        key: "surface.N.material.reflectance",
        soft: 0.0..=1.0,
        logarithmic: false,
        unit: "",
        reset: strength(before.reflectance()),
    };
    if color_rows(ui, number, "Reflectance color", &mut reflectance) {
        material.reflectance = Some(reflectance);
        edit = Some("reflectance");
    }
    if material.kind == MaterialKind::Conductor {
        let mut alpha = material.alpha();
        let number = Number {
            name: "Roughness",
            key: "surface.N.material.alpha",
            soft: 0.001..=1.0,
            logarithmic: false,
            unit: "",
            reset: before.alpha(),
        };
        if number.show(ui, &mut alpha) {
            material.alpha = Some(alpha.clamp(0.001, 1.0));
            edit = Some("roughness");
        }
    }
    edit
}
