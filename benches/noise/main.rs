//! The worth of each strategy: variance at equal samples and at equal time, scene by scene.
//!
//! `cargo bench --bench noise -- [TABLE] [SCENE ...] [--quick]` prints a table per scene with one
//! row per strategy: toggle upon toggle, or with `modes` the modes of the majorant boost by their
//! amounts, with `distances` the ways to choose where a ray scatters, with `walks` the estimators
//! of transmittance and the trackers. `never-worse` holds the full preset against every combination
//! of the toggles, and against another build with `--other`. `-- --list` names the scenes.
//! All of it takes an hour of CPU time, `--quick` some minutes.

mod measure;
mod never_worse;
mod rows;
mod scenes;
mod table;
mod which;

use clap::Parser;

use measure::Plan;
use rows::Row;
use scenes::BenchScene;
use which::Table;

#[derive(Parser)]
#[command(name = "noise", about = "Variance and cost of each strategy, scene by scene")]
struct Arguments {
    /// Only scenes whose name contains one of these, or is `=` and one of these; `modes`, `distances` or `walks` for another
    /// table than that of the toggles.
    filters: Vec<String>,
    /// Fewer samples and seeds: figures good to 10 to 20 %.
    #[arg(long)]
    quick: bool,
    /// Samples per pixel of each picture [default: 64, quick 16].
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    spp: Option<u32>,
    /// Seeds are added until the variance is known to this relative standard error [default: 0.05,
    /// quick 0.1].
    #[arg(long)]
    error: Option<f64>,
    /// CPU seconds after which a row gets no further seeds [default: 60, quick 6].
    #[arg(long)]
    budget: Option<f64>,
    /// Render as the command line does, film and schedule included, not by a bare loop over pixels.
    #[arg(long)]
    film: bool,
    /// Only rows whose name contains one of these, or is `=` and one of these; `;` between them.
    #[arg(long, value_delimiter = ';')]
    rows: Vec<String>,
    /// Name the scenes.
    #[arg(long)]
    list: bool,
    /// With `never-worse`: the program of another build, whose combinations take part.
    #[arg(long)]
    other: Option<std::path::PathBuf>,
    /// Passed by `cargo bench`; without it, as in `cargo test`, scenes are built but not measured.
    #[arg(long, hide = true)]
    bench: bool,
}

impl Arguments {
    fn plan(&self) -> Plan {
        let [spp, error, budget] = if self.quick { [16.0, 0.1, 6.0] } else { [64.0, 0.05, 60.0] };
        Plan {
            spp: self.spp.unwrap_or(spp as u32),
            error: self.error.unwrap_or(error),
            budget: self.budget.unwrap_or(budget),
            film: self.film,
        }
    }

    /// The table that is asked for.
    fn table(&self) -> Table {
        self.filters.iter().find_map(|filter| Table::named(filter)).unwrap_or(Table::Toggles)
    }

    /// The requested scenes and rows.
    fn selection(&self) -> Vec<(BenchScene, Vec<Row>)> {
        let table = self.table();
        let filters: Vec<&String> =
            self.filters.iter().filter(|filter| Table::named(filter).is_none()).collect();
        let chosen = |scene: &BenchScene| {
            let in_table = scene.tables.contains(&table) || table == Table::NeverWorse;
            let all = filters.is_empty() && in_table;
            all || filters.iter().any(|filter| answers_to(scene.name, filter))
        };
        let named = |row: &Row| {
            self.rows.is_empty() || self.rows.iter().any(|filter| answers_to(&row.name, filter))
        };
        let rows = |scene: &BenchScene| rows::of(table, scene).into_iter().filter(named).collect();
        scenes::all().into_iter().filter(chosen).map(|s| (s, rows(&s))).collect()
    }
}

fn answers_to(name: &str, filter: &str) -> bool {
    filter.strip_prefix('=').map_or_else(|| name.contains(filter), |whole| name == whole)
}

fn main() {
    let arguments = Arguments::parse();
    let selection = arguments.selection();
    if arguments.list {
        selection.iter().for_each(|(scene, _)| println!("{:<16} {}", scene.name, scene.shows));
        return;
    }
    if arguments.bench && arguments.table() == Table::NeverWorse {
        never_worse::head();
        let effort = never_worse::Effort::new(arguments.quick);
        for (scene, _) in selection {
            let Some(built) = scene.build() else { continue };
            never_worse::print(&scene, &built, effort, arguments.other.as_deref());
        }
        return;
    }
    let plan = arguments.plan();
    if arguments.bench {
        table::preamble(&plan);
    }
    for (scene, rows) in selection {
        let Some(built) = scene.build() else { continue };
        if arguments.bench {
            table::print(&scene, &built, &rows, &plan);
        }
    }
}
