//! The display transform: exposure, white balance, tone curve, channel and layer. Nothing here
//! changes the render.

use egui::Ui;

use super::{Panel, section};
use crate::app::command::Command;
use crate::app::ui::widgets::{Number, key_of, list, row, segments};
use crate::image::tone::{Channel, Tone, ToneCurve, white};
use crate::render::Layer;

/// Exposures that the slider covers, in stops.
const STOPS: [f32; 2] = [-8.0, 8.0];
/// Temperatures that the slider covers, in kelvin.
const KELVIN: [f32; 2] = [1700.0, 15_000.0];

const CURVES: [(ToneCurve, &str); 3] = [
    (
        ToneCurve::Filmic,
        "Rolls highlights off, fire through yellow to white, and keeps blacks deep.",
    ),
    (ToneCurve::Agx, "Softer: bright colors fade to white early, as in Blender."),
    (ToneCurve::Linear, "No curve: values above 1 clip."),
];

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Display", |ui| {
        let reset = Tone::default();
        let tone = &mut panel.editor.document.tone;
        let mut edit = None;
        if exposure(reset).show_as(ui, &mut tone.exposure, EXPOSURE_HELP, [-20.0, 20.0]) {
            edit = Some("exposure");
        }
        let command = Command::AutoExposure;
        row(ui, "", "", |ui| {
            let button = egui::Button::new(command.text()).shortcut_text(key_of(ui, command));
            if ui.add(button).on_hover_text(command.tooltip()).clicked() {
                panel.commands.push(command);
            }
        });
        let limits = white::RANGE.map(f64::from);
        if balance(reset).show_as(ui, &mut tone.white, WHITE_HELP, limits) {
            edit = Some("white balance");
        }
        let limits = white::TINTS.map(f64::from);
        if tint(reset).show_as(ui, &mut tone.tint, TINT_HELP, limits) {
            edit = Some("tint");
        }
        if curve(ui, tone) {
            edit = Some("tone curve");
        }
        if channel(ui, tone) {
            edit = Some("channel");
        }
        layer(ui, &mut panel.wanted.layer);
        if let Some(name) = edit {
            panel.editor.name_edit(name);
        }
    });
}

const EXPOSURE_HELP: &str = "Exposure of the display in stops: one stop more is twice as bright. \
                             For display and PNG only; an EXR stays linear.";

const WHITE_HELP: &str = "Color temperature of the light that is displayed as white. 6500 K leaves \
                          colors unchanged; 2500 K makes a torch white and daylight blue. For \
                          display and PNG only.";

const TINT_HELP: &str = "Green-magenta balance: higher values remove green, lower ones remove \
                         magenta. For display and PNG only.";

fn exposure(reset: Tone) -> Number<'static> {
    Number {
        name: "Exposure",
        key: "",
        soft: STOPS[0]..=STOPS[1],
        logarithmic: false,
        unit: " stops",
        reset: reset.exposure,
    }
}

fn balance(reset: Tone) -> Number<'static> {
    Number {
        name: "White balance",
        key: "",
        soft: KELVIN[0]..=KELVIN[1],
        logarithmic: true,
        unit: " K",
        reset: reset.white,
    }
}

fn tint(reset: Tone) -> Number<'static> {
    Number {
        name: "Tint",
        key: "",
        soft: white::TINTS[0]..=white::TINTS[1],
        logarithmic: false,
        unit: "",
        reset: reset.tint,
    }
}

/// Whether another curve was chosen.
fn curve(ui: &mut Ui, tone: &mut Tone) -> bool {
    let choices = CURVES.map(|(curve, help)| (curve.name(), help));
    let chosen = CURVES.iter().position(|(curve, _)| *curve == tone.curve);
    let help = "Maps exposed linear light to the range of a screen. For display and PNG only.";
    let clicked = row(ui, "Tone curve", help, |ui| segments(ui, &choices, chosen)).inner;
    let Some((curve, _)) = clicked.and_then(|index| CURVES.get(index)) else { return false };
    tone.curve = *curve;
    true
}

/// The layer that is shown.
fn layer(ui: &mut Ui, wanted: &mut Option<Layer>) {
    let help = "The beauty pass, one component of its light, or data of its pixels. An EXR \
                contains all layers.";
    row(ui, "Layer", help, |ui| {
        let choice = |layer: Option<Layer>| (layer, layer.map_or("Beauty", Layer::name), "");
        let choices: Vec<_> =
            std::iter::once(None).chain(Layer::ALL.map(Some)).map(choice).collect();
        list(ui, ("Layer", help), wanted, &choices);
    });
}

/// Whether another channel was chosen.
fn channel(ui: &mut Ui, tone: &mut Tone) -> bool {
    let help = "Full color, one channel as gray, or false color for the stops from middle gray. \
                For display and PNG only.";
    row(ui, "Show", help, |ui| {
        let choices = Channel::ALL.map(|channel| (channel, channel.name(), ""));
        list(ui, ("Show", help), &mut tone.channel, &choices)
    })
    .inner
}
