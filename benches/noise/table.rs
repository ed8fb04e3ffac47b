//! Printing the figures, row by row as they come, as a Markdown table.

use std::sync::Arc;

use flambeau::transport::Scene;

use super::{
    measure::{self, Noise, Plan, SEEDS, SIDE, THREADS},
    rows::Row,
    scenes::BenchScene,
};

/// Prints the meaning of the figures of all tables.
pub fn preamble(plan: &Plan) {
    let Plan { spp, error, budget, film } = plan;
    let how = if *film { "with film and schedule" } else { "by a bare loop over the pixels" };
    println!(
        "Pictures of {SIDE} x {SIDE} pixels, {how}.\n\
         - variance: of gray, mean over the pixels, between pictures of {spp} samples with \
         independent seeds, times {spp}.\n\
         - ±: its relative standard error. Seeds are added, from {} to {}, until that is {:.0} % or \
         {budget} CPU seconds are spent; where rare bright samples make the noise it may say too \
         little.\n\
         - setup ms, ms/spp: CPU time of all threads for placing the probes and per sample of every \
         pixel, over {THREADS}.\n\
         - efficiency: 1 / (variance x seconds). Equal samples, equal time: how many times less \
         variance than in the first row.\n\
         - the old system, ray marching, is biased: how far its mean is from the others' stays.",
        SEEDS[0],
        SEEDS[1],
        100.0 * error,
    );
}

/// The columns and their widths, wide enough for any figure.
const COLUMNS: [(&str, usize); 12] = [
    ("strategy", 26),
    ("mean", 9),
    ("±", 6),
    ("variance", 9),
    ("±", 5),
    ("seeds", 5),
    ("setup ms", 8),
    ("ms/spp", 8),
    ("steps/path", 10),
    ("efficiency", 10),
    ("eq samples", 10),
    ("eq time", 10),
];

/// Measures every row of a table and prints it.
pub fn print(scene: &BenchScene, built: &Scene, rows: &[Row], plan: &Plan) {
    println!("\n## {}: {}\n", scene.name, scene.shows);
    print_cells(&COLUMNS.map(|(name, _)| name.to_owned()));
    println!("|---{}|", "|--:".repeat(COLUMNS.len() - 1));
    let (mut first, left_out) = (None, scene.left_out);
    for row in rows {
        let scene = Arc::new(built.clone().with_strategy(row.strategy));
        let noise = measure::measure(&scene, plan, left_out);
        let first = first.get_or_insert([noise.variance, noise.efficiency()]);
        print_cells(&cells(row, &noise, *first));
    }
}

fn cells(row: &Row, noise: &Noise, [variance, efficiency]: [f64; 2]) -> [String; COLUMNS.len()] {
    [
        row.name.clone(),
        format!("{:.3e}", noise.mean),
        format!("{:.2} %", 100.0 * noise.mean_error),
        format!("{:.3e}", noise.variance),
        format!("{:.0} %", 100.0 * noise.variance_error),
        noise.seeds.to_string(),
        format!("{:.0}", 1.0e3 * noise.setup),
        format!("{:.3}", 1.0e3 * noise.seconds),
        format!("{:.3}", noise.steps),
        format!("{:.3e}", noise.efficiency()),
        format!("{:.2}", variance / noise.variance),
        format!("{:.2}", noise.efficiency() / efficiency),
    ]
}

/// Prints one line of cells: the first aligned to the left, figures to the right.
fn print_cells(cells: &[String; COLUMNS.len()]) {
    for (column, (cell, (_, width))) in std::iter::zip(cells, COLUMNS).enumerate() {
        match column {
            0 => print!("| {cell:<width$} |"),
            _ => print!(" {cell:>width$} |"),
        }
    }
    println!();
}
