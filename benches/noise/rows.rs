//! The strategies that are compared.

use flambeau::transport::strategy::{
    Advanced, BoostMode, Distance, Integrator, LightSelection, NeeEvaluation, Preset,
    ScatterProbability, Strategy, Tracker, TransmittanceEstimator,
};

use super::scenes::BenchScene;
use super::which::Table;

/// The rows of a table for a scene.
pub fn of(table: Table, scene: &BenchScene) -> Vec<Row> {
    match table {
        Table::Toggles => toggles(scene),
        Table::Modes => modes(),
        Table::Distances => distances(),
        Table::Walks => walks(),
        // Its rows are the combinations of the toggles that differ in the scene.
        Table::NeverWorse => Vec::new(),
    }
}

/// A row of a table.
pub struct Row {
    /// Name of the row.
    pub name: String,
    /// The strategy that is measured.
    pub strategy: Strategy,
}

/// The modes, the one the talk states first.
const MODES: [(BoostMode, &str); 4] = [
    (BoostMode::Literal, "literal"),
    (BoostMode::Clamped, "clamped"),
    (BoostMode::Optimal, "optimal"),
    (BoostMode::Stratified, "stratified"),
];

/// Collisions along the brightest chord that modes are compared at; of the optimal majorant, 32nds
/// of what it finds.
const AMOUNTS: [f32; 5] = [0.25, 1.0, 4.0, 16.0, 64.0];

/// Toggle upon toggle, from none to all, then all but one of the finer choices, then the old system.
fn toggles(scene: &BenchScene) -> Vec<Row> {
    let baseline = Preset::Baseline.strategy();
    let decoupling = Strategy { emission_decoupling: true, ..baseline };
    let ratio = Strategy { emission_ratio_tracking: true, ..decoupling };
    let boosted = |boost_mode| Strategy {
        majorant_boost: true,
        advanced: Advanced { boost_mode, ..Advanced::default() },
        ..ratio
    };
    let full = Preset::Full.strategy();
    let full_but = |advanced: Advanced| Strategy { advanced, ..full };
    let default = Advanced::default();

    let mut rows = vec![
        row("baseline", baseline),
        row("+ decoupling", decoupling),
        row("+ ratio tracking", ratio),
    ];
    rows.extend(MODES.map(|(mode, name)| row(&format!("+ boost, {name}"), boosted(mode))));
    let emission = Preset::Emission.strategy();
    let point = Advanced { nee_evaluation: NeeEvaluation::Point, ..default };
    rows.push(row("+ nee, point", Strategy { advanced: point, ..emission }));
    rows.push(row("+ nee, line", emission));
    rows.push(row("+ probes = full", full));
    if scene.many_lights {
        let uniform = Advanced { light_selection: LightSelection::Uniform, ..default };
        rows.push(row("full, lights uniform", full_but(uniform)));
        let probes = Advanced { light_selection: LightSelection::Probes, ..default };
        rows.push(row("full, lights by probes", full_but(probes)));
    }
    let independent = Advanced { low_discrepancy: false, ..default };
    rows.push(row("full, independent samples", full_but(independent)));
    rows.push(row("old system, biased", Strategy { integrator: Integrator::March, ..full }));
    rows
}

/// Every mode of the boost at every amount, without the probes, which do nothing for emission.
fn modes() -> Vec<Row> {
    let emission = Preset::Emission.strategy();
    let mut rows = vec![row("unboosted", Strategy { majorant_boost: false, ..emission })];
    for (boost_mode, name) in MODES {
        rows.extend(AMOUNTS.map(|boost_amount| {
            let advanced = Advanced { boost_mode, boost_amount, ..emission.advanced };
            row(&format!("{name} {boost_amount}"), Strategy { advanced, ..emission })
        }));
    }
    rows
}

/// Distances by null-collision sampling, by the probes, by both; then without or with more of what else guides.
fn distances() -> Vec<Row> {
    let full = Preset::Full.strategy();
    let but = |name, change: fn(&mut Advanced)| {
        let mut strategy = full;
        change(&mut strategy.advanced);
        row(name, strategy)
    };
    vec![
        row("null", Preset::Emission.strategy()),
        but("probes alone", |a| a.distance = Distance::Probes),
        but("mis", |_| ()),
        but("mis, share not learned", |a| a.share_learning = false),
        but("mis, probes unlearned", |a| a.probe_learning = false),
        but("mis, all rays alike", |a| a.scatter_probability = ScatterProbability::Even),
        but("mis, no equal angles", |a| a.equiangular = false),
        but("mis, directions unguided", |a| a.guide_directions = false),
        but("mis, metals unguided", |a| a.guide_caustics = false),
        but("mis, bounces guided", |a| a.guide_all_vertices = true),
        but("mis, bounces guided, unlearned", |a| {
            (a.guide_all_vertices, a.probe_learning) = (true, false);
        }),
        row("old system, biased", Strategy { integrator: Integrator::March, ..full }),
    ]
}

/// The estimators of transmittance, then the trackers. Without the probes, whose noise is another
/// matter and which not every tracker knows.
fn walks() -> Vec<Row> {
    let plain = Preset::Emission.strategy();
    let estimators = [
        (TransmittanceEstimator::Ratio, "transmittance ratio"),
        (TransmittanceEstimator::Residual, "transmittance residual"),
        (TransmittanceEstimator::Marching, "transmittance marching"),
    ];
    let trackers = [
        (Tracker::Delta, "tracker delta"),
        (Tracker::Decomposition, "tracker decomposition"),
        (Tracker::Spectral, "tracker spectral"),
    ];
    let mut rows = Vec::from(estimators.map(|(transmittance, name)| {
        let advanced = Advanced { transmittance, ..plain.advanced };
        row(name, Strategy { advanced, ..plain })
    }));
    rows.extend(trackers.map(|(tracker, name)| {
        let advanced = Advanced { tracker, ..plain.advanced };
        row(name, Strategy { advanced, ..plain })
    }));
    rows
}

fn row(name: &str, strategy: Strategy) -> Row {
    Row { name: name.to_owned(), strategy }
}
