//! The environment: where its light comes from, and what is done to it.

use egui::{RichText, Ui};

use super::Panel;
use crate::app::command::Command;
use crate::app::ui::theme::color;
use crate::app::ui::widgets::{
    Number, choice, color_rows, key_help, row, scaled, segments, strength, tint,
};
use crate::scene::settings::{Color, EnvironmentSettings, SkySettings};

/// A source of the environment's light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Uniform,
    Image,
    Sky,
    Gradient,
}

/// The sources with their names and what they are good for.
const SOURCES: [(Source, &str, &str); 4] = [
    (Source::Uniform, "Uniform", "The same radiance from everywhere; 0 is none."),
    (Source::Image, "Image", "A picture of everything around, .hdr or .exr."),
    (Source::Sky, "Clear sky", "A clear sky with its sun, by the sun's elevation and the haze."),
    (Source::Gradient, "Gradient", "A sky by elevation: bottom, horizon and top."),
];
/// The gradient to begin with, where there was no light.
const FIRST_GRADIENT: [f32; 3] = [0.1, 0.3, 0.6];

/// Lets the light come from the image of that name alone.
pub fn set_image(environment: &mut EnvironmentSettings, file: String) {
    clear(environment);
    environment.file = Some(file);
}

/// Shows the rows; the name of the edit if anything changed.
pub fn rows(ui: &mut Ui, panel: &mut Panel<'_>) -> Option<&'static str> {
    let opened = panel.editor.opened().settings.environment.clone();
    let settings = &mut panel.editor.document.settings;
    let environment = &mut settings.environment;
    let mut edit = choose_source(ui, environment, panel.commands);
    edit = edit.or(match source_of(environment) {
        Source::Uniform => uniform(ui, environment, &opened),
        Source::Image => image(ui, environment, panel.commands),
        Source::Sky => sky(ui, environment, &opened),
        Source::Gradient => gradient(ui, environment, &opened),
    });
    if !environment.radiance.is_black() || source_of(environment) != Source::Uniform {
        edit = edit.or(factors(ui, environment, &opened));
    }
    if source_of(environment) != Source::Uniform {
        let changed = choice(ui, "World up", "scene.up", &mut settings.scene.up);
        edit = edit.or(changed.then_some("up of the world"));
    }
    edit
}

fn source_of(environment: &EnvironmentSettings) -> Source {
    match environment {
        EnvironmentSettings { file: Some(_), .. } => Source::Image,
        EnvironmentSettings { sky: Some(_), .. } => Source::Sky,
        EnvironmentSettings { gradient: Some(_), .. } => Source::Gradient,
        _ => Source::Uniform,
    }
}

fn clear(environment: &mut EnvironmentSettings) {
    environment.radiance = Color::default();
    environment.file = None;
    environment.sky = None;
    environment.gradient = None;
}

fn choose_source(
    ui: &mut Ui,
    environment: &mut EnvironmentSettings,
    commands: &mut Vec<Command>,
) -> Option<&'static str> {
    let present = source_of(environment);
    let choices = SOURCES.map(|(_, name, help)| (name, help));
    let chosen = SOURCES.iter().position(|(source, ..)| *source == present);
    let help = "The light from all around, behind everything else.";
    ui.label(RichText::new("Environment").color(color::TEXT_DIM)).on_hover_text(help);
    let clicked = ui.name_inputs("Environment", |ui| segments(ui, &choices, chosen));
    let (source, ..) = *clicked.and_then(|index| SOURCES.get(index))?;
    if source == Source::Image {
        commands.push(Command::LoadEnvironment);
        return None;
    }
    (source != present).then(|| {
        change_source(environment, source);
        "environment"
    })
}

/// Lets the light come from another source, as much alike as it can be.
fn change_source(environment: &mut EnvironmentSettings, source: Source) {
    let horizon = match environment.gradient {
        Some([_, horizon, _]) => horizon,
        None => environment.radiance,
    };
    clear(environment);
    match source {
        Source::Uniform if horizon.is_black() => environment.radiance = Color::Gray(0.25),
        Source::Uniform => environment.radiance = horizon,
        Source::Sky => environment.sky = Some(SkySettings::default()),
        Source::Gradient if horizon.is_black() => {
            environment.gradient = Some(FIRST_GRADIENT.map(Color::Gray));
        }
        Source::Gradient => {
            let bright = strength(horizon);
            let by = |factor: f32| scaled(horizon, factor * bright);
            environment.gradient = Some([by(0.5), horizon, by(2.0)]);
        }
        Source::Image => {}
    }
}

fn uniform(
    ui: &mut Ui,
    environment: &mut EnvironmentSettings,
    opened: &EnvironmentSettings,
) -> Option<&'static str> {
    let reset = strength(opened.radiance);
    let number = Number {
        name: "Sky",
        key: "environment.radiance",
        soft: 0.0..=reset.max(0.25) * 4.0,
        logarithmic: true,
        unit: "",
        reset,
    };
    color_rows(ui, number, "Sky color", &mut environment.radiance).then_some("sky")
}

fn image(
    ui: &mut Ui,
    environment: &EnvironmentSettings,
    commands: &mut Vec<Command>,
) -> Option<&'static str> {
    let file = environment.file.as_deref().unwrap_or_default();
    let path = crate::files::path_of(file);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    row(ui, "File", &key_help("environment.file"), |ui| {
        let help = "Choose another picture of everything around.";
        if ui.button("Choose image…").on_hover_text(help).clicked() {
            commands.push(Command::LoadEnvironment);
        }
        ui.add(egui::Label::new(&*name).truncate()).on_hover_text(file);
    });
    None
}

fn gradient(
    ui: &mut Ui,
    environment: &mut EnvironmentSettings,
    opened: &EnvironmentSettings,
) -> Option<&'static str> {
    let reset = opened.gradient.unwrap_or(FIRST_GRADIENT.map(Color::Gray));
    let colors = environment.gradient.as_mut()?;
    let names = [("Bottom", "Bottom color"), ("Horizon", "Horizon color"), ("Top", "Top color")];
    let mut changed = false;
    for ((color, reset), (name, hue)) in colors.iter_mut().zip(reset).zip(names) {
        let reset = strength(reset);
        let number = Number {
            name,
            key: "environment.gradient",
            soft: 0.0..=reset.max(0.25) * 4.0,
            logarithmic: true,
            unit: "",
            reset,
        };
        changed |= color_rows(ui, number, hue, color);
    }
    changed.then_some("gradient of the sky")
}

fn sky(
    ui: &mut Ui,
    environment: &mut EnvironmentSettings,
    opened: &EnvironmentSettings,
) -> Option<&'static str> {
    let reset = opened.sky.unwrap_or_default();
    let sky = environment.sky.as_mut()?;
    let number =
        |name, key, soft, unit, reset| Number { name, key, soft, logarithmic: false, unit, reset };
    let elevation = "environment.sky.sun_elevation";
    let elevation = number("Sun elevation", elevation, 0.0..=90.0, "°", reset.sun_elevation);
    let azimuth = "environment.sky.sun_azimuth";
    let azimuth = number("Sun azimuth", azimuth, -180.0..=180.0, "°", reset.sun_azimuth);
    let haze = number("Haze", "environment.sky.turbidity", 1.0..=10.0, "", reset.turbidity);
    let ground = "environment.sky.ground_albedo";
    let ground = number("Ground albedo", ground, 0.0..=1.0, "", reset.ground_albedo);
    let mut changed = elevation.show(ui, &mut sky.sun_elevation);
    changed |= azimuth.show(ui, &mut sky.sun_azimuth);
    changed |= haze.show(ui, &mut sky.turbidity);
    changed |= ground.show(ui, &mut sky.ground_albedo);
    let help = key_help("environment.sky.sun");
    changed |= ui.checkbox(&mut sky.sun, "Sun of the sky").on_hover_text(help).changed();
    changed.then_some("clear sky")
}

/// Rows for what is done to the light of any source.
fn factors(
    ui: &mut Ui,
    environment: &mut EnvironmentSettings,
    opened: &EnvironmentSettings,
) -> Option<&'static str> {
    let number = |name, key, most: f32, unit, reset| Number {
        name,
        key,
        soft: -most..=most,
        logarithmic: false,
        unit,
        reset,
    };
    let mut edit = None;
    if matches!(source_of(environment), Source::Image | Source::Sky) {
        let rotation = "environment.rotation";
        let rotation = number("Sky rotation", rotation, 180.0, "°", opened.rotation);
        edit = rotation.show(ui, &mut environment.rotation).then_some("rotation of the sky");
    }
    let exposure = "environment.exposure";
    let exposure = number("Sky exposure", exposure, 8.0, "", opened.exposure);
    if exposure.show(ui, &mut environment.exposure) {
        edit = edit.or(Some("exposure of the sky"));
    }
    if tint(ui, "Sky tint", &key_help("environment.tint"), &mut environment.tint) {
        edit = edit.or(Some("tint of the sky"));
    }
    let help = key_help("environment.visible");
    if ui.checkbox(&mut environment.visible, "Sky visible").on_hover_text(help).changed() {
        edit = edit.or(Some("visibility of the sky"));
    }
    edit
}
