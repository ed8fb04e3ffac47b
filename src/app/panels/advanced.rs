//! The advanced settings behind the toggles.

use egui::Ui;

use super::{Panel, explain};
use crate::app::ui::theme::space;
use crate::app::ui::widgets::{Number, capitalized, choice, choice_but, key_help};
use crate::transport::strategy::{Advanced, BoostMode, Strategy, Tracker};

/// Shows the advanced settings. A setting that its toggle does not use is dimmed.
pub fn show(ui: &mut Ui, panel: &mut Panel<'_>) {
    let opened = panel.editor.opened().settings.strategy.advanced;
    let strategy = &mut panel.editor.document.settings.strategy;
    let mut edit = None;
    integrator(ui, strategy, opened, &mut edit);
    ui.add_space(space::TIGHT);
    boost(ui, strategy, opened, &mut edit);
    ui.add_space(space::TIGHT);
    fire_as_light(ui, strategy, &mut edit);
    ui.add_space(space::TIGHT);
    guided_scattering(ui, strategy, opened, &mut edit);
    ui.add_space(space::TIGHT);
    walks(ui, strategy, &mut edit);
    let spread = &mut strategy.advanced.low_discrepancy;
    let help = key_help("strategy.advanced.low_discrepancy");
    if ui.checkbox(spread, "Low-discrepancy samples").on_hover_text(help).changed() {
        edit = Some("low-discrepancy samples");
    }
    if let Some(name) = edit {
        panel.editor.name_edit(name);
    }
}

fn integrator(
    ui: &mut Ui,
    strategy: &mut Strategy,
    opened: Advanced,
    edit: &mut Option<&'static str>,
) {
    if choice(ui, "Integrator", "strategy.integrator", &mut strategy.integrator) {
        *edit = Some("integrator");
    }
    ui.add_enabled_ui(strategy.is_biased(), |ui| {
        if march_step(opened).show(ui, &mut strategy.advanced.march_step) {
            *edit = Some("march step");
        }
    });
}

fn boost(ui: &mut Ui, strategy: &mut Strategy, opened: Advanced, edit: &mut Option<&'static str>) {
    let clamps = is_clamped(strategy);
    let boosts = strategy.majorant_boost && !strategy.is_biased();
    let advanced = &mut strategy.advanced;
    ui.add_enabled_ui(boosts, |ui| {
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
        if choice(ui, "Fire sampling", "strategy.advanced.nee_evaluation", evaluation) {
            *edit = Some("fire sampling");
        }
    });
    // Not only for fire: lamps are chosen this way too.
    let selection = &mut advanced.light_selection;
    if choice(ui, "Light selection", "strategy.advanced.light_selection", selection) {
        *edit = Some("light selection");
    }
}

/// The choices of the light probes.
fn guided_scattering(
    ui: &mut Ui,
    strategy: &mut Strategy,
    opened: Advanced,
    edit: &mut Option<&'static str>,
) {
    let guides = strategy.probe_mis && !strategy.is_biased();
    let advanced = &mut strategy.advanced;
    ui.add_enabled_ui(guides, |ui| {
        if choice(ui, "Distance sampling", "strategy.advanced.distance", &mut advanced.distance) {
            *edit = Some("distance sampling");
        }
        let (key, value) =
            ("strategy.advanced.scatter_probability", &mut advanced.scatter_probability);
        if choice(ui, "Scatter probability", key, value) {
            *edit = Some("scatter probability");
        }
        let mut count = advanced.probe_count as f32;
        if probe_count(opened).show(ui, &mut count) {
            advanced.probe_count = count as u32;
            *edit = Some("probe count");
        }
        for (value, name, key) in [
            (
                &mut advanced.probe_learning,
                "Learn indirect light",
                "strategy.advanced.probe_learning",
            ),
            (&mut advanced.share_learning, "Adapt to the shot", "strategy.advanced.share_learning"),
            (&mut advanced.equiangular, "Equiangular sampling", "strategy.advanced.equiangular"),
            (
                &mut advanced.guide_directions,
                "Guide directions",
                "strategy.advanced.guide_directions",
            ),
            (&mut advanced.guide_caustics, "Guide caustics", "strategy.advanced.guide_caustics"),
            (
                &mut advanced.guide_all_vertices,
                "Guide all bounces",
                "strategy.advanced.guide_all_vertices",
            ),
        ] {
            if ui.checkbox(value, name).on_hover_text(key_help(key)).changed() {
                *edit = Some(name);
            }
        }
    });
}

/// Rows for the trackers and estimators in smoke: towards lamps, and for distances.
fn walks(ui: &mut Ui, strategy: &mut Strategy, edit: &mut Option<&'static str>) {
    let estimator = &mut strategy.advanced.transmittance;
    if choice(ui, "Shadow rays", "strategy.advanced.transmittance", estimator) {
        *edit = Some("shadow rays");
    }
    let ray_end = &mut strategy.advanced.ray_end;
    if choice(ui, "Light at ray ends", "strategy.advanced.ray_end", ray_end) {
        *edit = Some("light at ray ends");
    }
    let reason = strategy.refusal_of(Tracker::Decomposition);
    let refused = reason.map(|_| Tracker::Decomposition);
    let tracker = &mut strategy.advanced.tracker;
    if choice_but(ui, "Tracker", "strategy.advanced.tracker", tracker, refused) {
        *edit = Some("tracker");
    }
    if let Some(reason) = reason {
        explain(ui, &format!("Not available with these settings: {}.", capitalized(reason)));
    }
}

fn probe_count(opened: Advanced) -> Number<'static> {
    Number {
        name: "Probe count",
        key: "strategy.advanced.probe_count",
        soft: 256.0..=65536.0,
        logarithmic: true,
        unit: "",
        reset: opened.probe_count as f32,
    }
}

fn march_step(opened: Advanced) -> Number<'static> {
    Number {
        name: "March step",
        key: "strategy.advanced.march_step",
        soft: 0.1..=8.0,
        logarithmic: true,
        unit: " vx",
        reset: opened.march_step,
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
