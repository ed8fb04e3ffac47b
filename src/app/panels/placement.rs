//! Placement of a volume, and the measures of one that is a shape.

use egui::{DragValue, Ui, vec2};

use crate::app::ui::theme::space;
use crate::app::ui::widgets::{
    Number, Vector, choice, doubled_help, finite, is_reset, key_help, row_label,
};
use crate::scene::keys;
use crate::scene::settings::{Extent, RampKind, VolumeSettings, VolumeShape};

/// Degrees that a point of a drag turns.
const DEGREES: f32 = 0.5;

/// Shows translation, rotation and scale; the name of the edit if anything changed. `size` is how
/// large the volume is.
pub fn show(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
    size: f32,
) -> Option<&'static str> {
    if volume.matrix.is_some() {
        let help = key_help("volume.N.matrix");
        row_label(ui, "Placement", &help);
        let give_up = "Remove the matrix; the volume is then placed as in its file.";
        return ui.button("Remove matrix").on_hover_text(give_up).clicked().then(|| {
            volume.matrix = None;
            "placement"
        });
    }
    let mut edit = None;
    let place = |name, key, speed, unit, reset| Vector { name, key, speed, unit, reset };
    let speed = (size * 0.005).max(1e-4);
    let translate = place("Translate", "volume.N.translate", speed, "", opened.translate);
    if translate.show(ui, &mut volume.translate) {
        edit = Some("move the volume");
    }
    let rotate = place("Rotate", "volume.N.rotate", DEGREES, "°", opened.rotate);
    if rotate.show(ui, &mut volume.rotate) {
        edit = Some("rotate the volume");
    }
    let scale = ("Scale", "volume.N.scale", &*key_help("volume.N.scale"));
    if extent(ui, scale, &mut volume.scale, opened.scale) {
        edit = Some("scale the volume");
    }
    edit
}

/// A length for all axes, or one each where the scene file says so or the button is pressed.
fn extent(
    ui: &mut Ui,
    (name, key, help): (&str, &str, &str),
    value: &mut Extent,
    reset: Extent,
) -> bool {
    let before = *value;
    match value {
        Extent::Uniform(length) => {
            let around = reset.axes()[0];
            let number = Number {
                name,
                key,
                soft: 0.0..=(around * 4.0).max(1e-3),
                logarithmic: false,
                unit: "",
                reset: around,
            };
            // Nothing may shrink to a point.
            let kept = *length;
            let limits = keys::find(key).map_or([f64::MIN, f64::MAX], |key| key.limits);
            if number.show_as(ui, length, help, limits) && *length == 0.0 {
                *length = kept;
            }
        }
        Extent::Axes(axes) => {
            let speed = (axes[0].abs() * 0.01).max(1e-4);
            let vector = Vector { name, key, speed, unit: "", reset: reset.axes() };
            let kept = *axes;
            if vector.show_as(ui, axes, help) && axes.contains(&0.0) {
                *axes = kept;
            }
        }
    }
    *value != before
}

/// The full size of something whose key in the scene file is half of it; whether it changed.
pub fn size(ui: &mut Ui, key: &str, half: &mut Extent, reset: Extent) -> bool {
    let mut whole = scaled(*half, 2.0);
    let changed = extent(ui, ("Size", key, &doubled_help(key)), &mut whole, scaled(reset, 2.0));
    if changed {
        *half = scaled(whole, 0.5);
    }
    changed
}

fn scaled(extent: Extent, factor: f32) -> Extent {
    match extent {
        Extent::Uniform(length) => Extent::Uniform(factor * length),
        Extent::Axes(axes) => Extent::Axes(axes.map(|length| factor * length)),
    }
}

/// Shows the keys of the volume's shape, if it is one; the name of the edit if anything changed.
pub fn shape(
    ui: &mut Ui,
    volume: &mut VolumeSettings,
    opened: &VolumeSettings,
) -> Option<&'static str> {
    let mut changed = false;
    match volume.shape? {
        VolumeShape::Everywhere => {}
        VolumeShape::Sphere => {
            let mut radius = volume.radius();
            if number(ui, "Radius", "radius", &mut radius, opened.radius()) {
                volume.radius = Some(radius);
                changed = true;
            }
        }
        VolumeShape::Box => changed = half_size(ui, volume, opened),
        VolumeShape::Ramp => {
            changed = half_size(ui, volume, opened) | ramp(ui, volume, opened);
        }
        VolumeShape::Noise => {
            changed = half_size(ui, volume, opened) | noise(ui, volume, opened);
        }
    }
    changed.then_some("shape of the volume")
}

fn half_size(ui: &mut Ui, volume: &mut VolumeSettings, opened: &VolumeSettings) -> bool {
    let mut half_size = volume.half_size();
    let changed = size(ui, "volume.N.half_size", &mut half_size, opened.half_size());
    if changed {
        volume.half_size = Some(half_size);
    }
    changed
}

fn ramp(ui: &mut Ui, volume: &mut VolumeSettings, opened: &VolumeSettings) -> bool {
    let mut changed = false;
    let mut axis = volume.axis();
    if choice(ui, "Axis", "volume.N.axis", &mut axis) {
        volume.axis = Some(axis);
        changed = true;
    }
    let mut kind = volume.kind();
    if choice(ui, "Falloff", "volume.N.kind", &mut kind) && kind != volume.kind() {
        volume.kind = Some(kind);
        // What the other kind is measured by means nothing to this one.
        (volume.b, volume.h) = (None, None);
        changed = true;
    }
    let mut a = volume.a();
    if number(ui, "Start value", "a", &mut a, opened.a()) {
        volume.a = Some(a);
        changed = true;
    }
    if volume.kind() == RampKind::Linear {
        let mut b = volume.b();
        if number(ui, "Slope", "b", &mut b, opened.b()) {
            volume.b = Some(b);
            changed = true;
        }
    } else {
        let mut h = volume.h();
        if number(ui, "Falloff length", "h", &mut h, opened.h()) {
            volume.h = Some(h);
            changed = true;
        }
    }
    changed
}

fn noise(ui: &mut Ui, volume: &mut VolumeSettings, opened: &VolumeSettings) -> bool {
    let mut changed = false;
    let mut frequency = volume.frequency();
    if number(ui, "Frequency", "frequency", &mut frequency, opened.frequency()) {
        volume.frequency = Some(frequency);
        changed = true;
    }
    let mut contrast = volume.contrast();
    if number(ui, "Contrast", "contrast", &mut contrast, opened.contrast()) {
        volume.contrast = Some(contrast);
        changed = true;
    }
    let (mut octaves, mut seed) = (volume.octaves(), volume.seed());
    if whole(ui, "Octaves", "octaves", &mut octaves, 1..=12, opened.octaves()) {
        volume.octaves = Some(octaves);
        changed = true;
    }
    if whole(ui, "Noise seed", "seed", &mut seed, 0..=u32::MAX, opened.seed()) {
        volume.seed = Some(seed);
        changed = true;
    }
    changed
}

/// A number of a shape over four times what it was when opened.
fn number(ui: &mut Ui, name: &str, key: &str, value: &mut f32, reset: f32) -> bool {
    let before = *value;
    let reach = if reset == 0.0 { 1.0 } else { reset.abs() * 4.0 };
    // Only the slope of a ramp may fall; what measures a length must not shrink to nothing.
    let low = if key == "b" { -reach } else { 0.0 };
    let is_length = ["radius", "h", "frequency"].contains(&key);
    let key = &format!("volume.N.{key}");
    let number = Number { name, key, soft: low..=reach, logarithmic: false, unit: "", reset };
    if number.show(ui, value) && is_length && *value <= 0.0 {
        *value = before;
    }
    *value != before
}

fn whole(
    ui: &mut Ui,
    name: &str,
    key: &str,
    value: &mut u32,
    range: std::ops::RangeInclusive<u32>,
    reset: u32,
) -> bool {
    let before = *value;
    let help =
        format!("{}\n\nDouble-click to reset to {reset}.", key_help(&format!("volume.N.{key}")));
    ui.horizontal(|ui| {
        let label = row_label(ui, name, &help);
        let field = DragValue::new(value).speed(0.1).range(range).custom_parser(finite);
        let field = ui.add_sized(vec2(space::NUMBER + 20.0, space::ROW_HEIGHT), field);
        field.accessible_name(name).on_hover_text(&help);
        if is_reset(ui, &[&label]) {
            *value = reset;
        }
    });
    *value != before
}
