//! The toggles, what each does, and the finer choices behind them.

use egui::{CollapsingHeader, Layout, RichText, Ui};

use super::{Panel, explain, section};
use crate::app::commands::Command;
use crate::app::effect::{Toggle, no_effect};
use crate::app::theme::{color, space};
use crate::app::widgets::{Number, key_help, key_summary, row, segments};
use crate::transport::strategy::{Advanced, BoostMode, Preset, Strategy};

/// A toggle with its command, which knows its name and key, and its key in the scene file.
const TOGGLES: [(Toggle, Command, &str); 3] = [
    (Toggle::EmissionDecoupling, Command::EmissionDecoupling, "strategy.emission_decoupling"),
    (
        Toggle::EmissionRatioTracking,
        Command::EmissionRatioTracking,
        "strategy.emission_ratio_tracking",
    ),
    (Toggle::MajorantBoost, Command::MajorantBoost, "strategy.majorant_boost"),
];

/// The switch of `toggle` in `strategy`.
pub fn switch(strategy: &mut Strategy, toggle: Toggle) -> &mut bool {
    match toggle {
        Toggle::EmissionDecoupling => &mut strategy.emission_decoupling,
        Toggle::EmissionRatioTracking => &mut strategy.emission_ratio_tracking,
        Toggle::MajorantBoost => &mut strategy.majorant_boost,
    }
}

/// The toggle that `command` switches.
pub fn toggle_of(command: Command) -> Option<Toggle> {
    TOGGLES.iter().find(|(_, other, _)| *other == command).map(|(toggle, ..)| *toggle)
}

/// Shows the section.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    section(ui, "Strategy", |ui| {
        presets(ui, panel);
        for (toggle, command, key) in TOGGLES {
            ui.add_space(space::TIGHT);
            row_of(ui, panel, toggle, command, key);
        }
        ui.add_space(space::TIGHT);
        CollapsingHeader::new("Advanced").id_salt("strategy advanced").show(ui, |ui| {
            advanced(ui, panel);
        });
    });
}

fn row_of(ui: &mut Ui, panel: &mut Panel<'_>, toggle: Toggle, command: Command, key: &str) {
    let idle = no_effect(toggle, &panel.editor.document.settings);
    ui.horizontal(|ui| {
        let strategy = &mut panel.editor.document.settings.strategy;
        let text = RichText::new(command.text()).color(match idle {
            Some(_) => color::TEXT_DIM,
            None => color::TEXT_STRONG,
        });
        let response = ui.checkbox(switch(strategy, toggle), text).on_hover_text(key_help(key));
        if response.changed() {
            panel.editor.name_edit(command.text().to_lowercase());
        }
        ui.with_layout(Layout::right_to_left(egui::Align::Center), |ui| {
            let key = ui.ctx().format_shortcut(&command.shortcut());
            ui.label(RichText::new(key).monospace().color(color::TEXT_DIM));
        });
    });
    ui.indent(key, |ui| {
        explain(ui, &key_summary(key));
        if let Some(reason) = idle {
            let text = format!("No effect here: {reason}");
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
                Preset::Baseline => "Every strategy off: what a plain volume path tracer does.",
                Preset::Emission => "The strategies for fire on.",
                Preset::Full => "Every strategy on.",
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
        *strategy = Strategy { advanced: strategy.advanced, ..preset.strategy() };
        panel.editor.name_edit(format!("preset {}", preset.name()));
    }
}

fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn advanced(ui: &mut Ui, panel: &mut Panel<'_>) {
    let opened = panel.editor.opened().settings.strategy.advanced;
    let advanced = &mut panel.editor.document.settings.strategy.advanced;
    let mut edit = None;
    let modes = [
        ("Clamped", "Never takes steps much shorter than a voxel."),
        ("Literal", "The talk's maximum of the two majorants, without the clamp."),
    ];
    let all = [BoostMode::Clamped, BoostMode::Literal];
    let chosen = all.iter().position(|mode| *mode == advanced.boost_mode);
    let clicked = row(ui, "Boost mode", &key_help("strategy.advanced.boost_mode"), |ui| {
        segments(ui, &modes, chosen)
    });
    if let Some(mode) = clicked.inner.and_then(|index| all.get(index)) {
        advanced.boost_mode = *mode;
        edit = Some("boost mode");
    }
    if boost_amount(ui, advanced, opened) {
        edit = Some("boost amount");
    }
    let clamped = advanced.boost_mode == BoostMode::Clamped;
    ui.add_enabled_ui(clamped, |ui| {
        if boost_clamp(ui, advanced, opened) {
            edit = Some("boost clamp");
        }
    });
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

fn boost_amount(ui: &mut Ui, advanced: &mut Advanced, opened: Advanced) -> bool {
    Number {
        name: "Boost amount",
        key: "strategy.advanced.boost_amount",
        soft: 0.0..=32.0,
        logarithmic: true,
        unit: "",
        reset: opened.boost_amount,
    }
    .show(ui, &mut advanced.boost_amount)
}

fn boost_clamp(ui: &mut Ui, advanced: &mut Advanced, opened: Advanced) -> bool {
    Number {
        name: "Boost clamp",
        key: "strategy.advanced.boost_clamp_voxels",
        soft: 0.1..=10.0,
        logarithmic: true,
        unit: " vx",
        reset: opened.boost_clamp_voxels,
    }
    .show(ui, &mut advanced.boost_clamp_voxels)
}
