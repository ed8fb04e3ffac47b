//! Printing the figures, row by row as they come, as a Markdown table.

use std::sync::Arc;

use flambeau::transport::Scene;

use super::{
    measure::{self, Noise, Plan, SEEDS, SIDE, THREADS},
    rows::Row,
    scenes::BenchScene,
};

/// What the figures of all tables mean.
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
         - ms/spp: CPU time of all threads per sample of every pixel, over {THREADS}.\n\
         - efficiency: 1 / (variance x seconds). Equal samples, equal time: how many times less \
         variance than in the first row.",
        SEEDS[0],
        SEEDS[1],
        100.0 * error,
    );
}

/// Measures every row and prints it.
pub fn print(scene: &BenchScene, built: &Scene, rows: &[Row], plan: &Plan) {
    println!("\n## {}: {}\n", scene.name, scene.shows);
    println!(
        "| {:<26} | {:>9} | {:>6} | {:>9} | {:>5} | {:>5} | {:>8} | {:>10} | {:>10} | {:>10} | {:>10} |",
        "strategy",
        "mean",
        "±",
        "variance",
        "±",
        "seeds",
        "ms/spp",
        "steps/path",
        "efficiency",
        "eq samples",
        "eq time",
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    let mut first = None;
    for row in rows {
        let scene = Arc::new(Scene { strategy: row.strategy, ..built.clone() });
        let noise = measure::measure(&scene, plan);
        let first = first.get_or_insert([noise.variance, noise.efficiency()]);
        print_row(&row.name, &noise, *first);
    }
}

fn print_row(name: &str, noise: &Noise, [variance, efficiency]: [f64; 2]) {
    println!(
        "| {name:<26} | {:>9.3e} | {:>4.2} % | {:>9.3e} | {:>3.0} % | {:>5} | {:>8.3} | {:>10.3} | {:>10.3e} | {:>10.2} | {:>10.2} |",
        noise.mean,
        100.0 * noise.mean_error,
        noise.variance,
        100.0 * noise.variance_error,
        noise.seeds,
        1.0e3 * noise.seconds,
        noise.steps,
        noise.efficiency(),
        variance / noise.variance,
        noise.efficiency() / efficiency,
    );
}
