//! The finer choices behind the toggles.

use egui::Ui;

use super::Panel;
use crate::app::theme::space;
use crate::app::widgets::{Number, choice, key_help};
use crate::transport::strategy::{Advanced, BoostMode, Strategy};

/// Shows them; what its toggle does not use is dimmed.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    let opened = panel.editor.opened().settings.strategy.advanced;
    let strategy = &mut panel.editor.document.settings.strategy;
    let mut edit = None;
    boost(ui, strategy, opened, &mut edit);
    ui.add_space(space::TIGHT);
    fire_as_light(ui, strategy, &mut edit);
    let spread = &mut strategy.advanced.low_discrepancy;
    let help = key_help("strategy.advanced.low_discrepancy");
    if ui.checkbox(spread, "Spread samples").on_hover_text(help).changed() {
        edit = Some("spread samples");
    }
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

fn boost(ui: &mut Ui, strategy: &mut Strategy, opened: Advanced, edit: &mut Option<&'static str>) {
    let clamps = is_clamped(strategy);
    let advanced = &mut strategy.advanced;
    ui.add_enabled_ui(strategy.majorant_boost, |ui| {
        if choice(ui, "Boost mode", "strategy.advanced.boost_mode", &mut advanced.boost_mode) {
            *edit = Some("boost mode");
        }
        if boost_amount(opened).show(ui, &mut advanced.boost_amount) {
            *edit = Some("boost amount");
        }
        ui.add_enabled_ui(clamps, |ui| {
            if boost_clamp(opened).show(ui, &mut advanced.boost_clamp_voxels) {
                *edit = Some("boost clamp");
            }
        });
    });
}

/// Whether the boost heeds the shortest step: the modes that have a walk of their own leave it to
/// decoupling, which shares the walk of scattering.
fn is_clamped(strategy: &Strategy) -> bool {
    match strategy.advanced.boost_mode {
        BoostMode::Clamped => true,
        BoostMode::Literal => false,
        BoostMode::Stratified | BoostMode::Optimal => {
            strategy.emission_decoupling && !strategy.emission_ratio_tracking
        }
    }
}

fn fire_as_light(ui: &mut Ui, strategy: &mut Strategy, edit: &mut Option<&'static str>) {
    let advanced = &mut strategy.advanced;
    ui.add_enabled_ui(strategy.nee, |ui| {
        let evaluation = &mut advanced.nee_evaluation;
        if choice(ui, "Look at fire", "strategy.advanced.nee_evaluation", evaluation) {
            *edit = Some("look at fire");
        }
    });
    // Not only for fire: lamps are chosen this way too.
    let selection = &mut advanced.light_selection;
    if choice(ui, "Choose lights", "strategy.advanced.light_selection", selection) {
        *edit = Some("choose lights");
    }
}

fn boost_amount(opened: Advanced) -> Number<'static> {
    Number {
        name: "Boost amount",
        key: "strategy.advanced.boost_amount",
        soft: 0.0..=32.0,
        logarithmic: true,
        unit: "",
        reset: opened.boost_amount,
    }
}

fn boost_clamp(opened: Advanced) -> Number<'static> {
    Number {
        name: "Boost clamp",
        key: "strategy.advanced.boost_clamp_voxels",
        soft: 0.1..=10.0,
        logarithmic: true,
        unit: " vx",
        reset: opened.boost_clamp_voxels,
    }
}
