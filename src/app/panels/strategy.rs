//! The strategy: presets, toggles and advanced settings.

use egui::{CollapsingHeader, Layout, RichText, Ui};

use super::{Panel, advanced, explain, section};
use crate::app::command::Command;
use crate::app::compare::panel;
use crate::app::ui::sections::mark;
use crate::app::ui::theme::{color, space};
use crate::app::ui::widgets::{capitalized, key_help, key_of, key_summary, row, segments};
use crate::scene::effect::no_effect;
use crate::transport::strategy::Preset;
use crate::transport::toggle::Toggle;

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Strategy", |ui| {
        panel::sides(ui, &mut panel.compare());
        mark(ui, "toggles");
        presets(ui, panel);
        if panel.editor.document.settings.strategy.is_biased() {
            let text = "Biased: ray marching is on (Advanced).";
            let text = RichText::new(text).small().color(color::WARNING);
            ui.add(egui::Label::new(text).wrap()).on_hover_text(key_help("strategy.integrator"));
        }
        for toggle in Toggle::all() {
            ui.add_space(space::TIGHT);
            row_of(ui, panel, toggle);
        }
        ui.add_space(space::TIGHT);
        mark(ui, "advanced");
        CollapsingHeader::new("Advanced").id_salt("strategy advanced").show(ui, |ui| {
            advanced::show(ui, panel);
        });
    });
}

fn row_of(ui: &mut Ui, panel: &mut Panel<'_>, toggle: Toggle) {
    let (key, name) = (toggle.key(), toggle.name());
    let idle = no_effect(toggle, &panel.editor.document.settings);
    ui.horizontal(|ui| {
        let strategy = &mut panel.editor.document.settings.strategy;
        let text = RichText::new(name).color(match idle {
            Some(_) => color::TEXT_DIM,
            None => color::TEXT_STRONG,
        });
        let response = ui.checkbox(toggle.switch(strategy), text).on_hover_text(key_help(key));
        if response.changed() {
            panel.editor.name_edit(name.to_lowercase());
        }
        ui.with_layout(Layout::right_to_left(egui::Align::Center), |ui| {
            let key = key_of(ui, Command::Toggle(toggle));
            ui.label(RichText::new(key).monospace().color(color::TEXT_DIM));
        });
    });
    ui.indent(key, |ui| {
        explain(ui, &key_summary(key));
        let unpaid = toggle == Toggle::LightProbes && panel.guided_flights == Some(0.0);
        let why = match idle {
            Some(reason) => Some(format!("No effect here: {reason}")),
            None => unpaid.then(|| "Switched off automatically: no gain in this shot.".to_owned()),
        };
        if let Some(text) = why {
            ui.add(egui::Label::new(RichText::new(text).small().color(color::WARNING)).wrap());
        }
    });
}

fn presets(ui: &mut Ui, panel: &mut Panel<'_>) {
    // Presets that mean the same toggles show once, under the fuller name.
    let distinct: Vec<Preset> = Preset::ALL
        .into_iter()
        .filter(|preset| preset.strategy().preset() == Some(*preset))
        .collect();
    let choices: Vec<(String, String)> = distinct
        .iter()
        .map(|preset| {
            let help = match preset {
                Preset::Baseline => "All strategies off: a plain volume path tracer.",
                Preset::Emission => "The strategies for fire on, light probes off.",
                Preset::Full => "All strategies on.",
            };
            (capitalized(preset.name()), help.to_owned())
        })
        .collect();
    let choices: Vec<(&str, &str)> =
        choices.iter().map(|(name, help)| (name.as_str(), help.as_str())).collect();
    let strategy = &mut panel.editor.document.settings.strategy;
    let present = strategy.preset();
    let chosen = distinct.iter().position(|preset| present == Some(*preset));
    let clicked =
        row(ui, "Preset", &key_help("strategy.preset"), |ui| segments(ui, &choices, chosen));
    if let Some(preset) = clicked.inner.and_then(|index| distinct.get(index)) {
        *strategy = strategy.with_toggles_of(*preset);
        panel.editor.name_edit(format!("preset {}", preset.name()));
    }
}
