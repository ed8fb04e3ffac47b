//! Scenes at the ends of single precision: a render of them ends, and says what it could not do.

use std::sync::Arc;

use crate::common::{self, build};
use flambeau::transport::{
    PathSample,
    strategy::{BoostMode, Preset, Strategy},
    tracking::MOST_COLLISIONS,
};
use glam::UVec2;

/// Samples a small picture and returns its paths.
fn paths(text: &str, strategy: Strategy) -> Vec<PathSample> {
    let scene = common::with_strategy(&build(text), strategy);
    let size = UVec2::splat(6);
    let frame = crate::common::frame_of(Arc::new(scene), size, 0);
    (0..size.x * size.y).map(|i| frame.sample(UVec2::new(i % size.x, i / size.x), 0)).collect()
}

const NOISE: &str = r#"
    [camera]
    position = [0, -4, 0]
    target = [0, 0, 0]
    [environment]
    radiance = 1.0
    [[volume]]
    shape = "noise"
    half_size = 1.0
    frequency = 2.0
    contrast = 5.0
    albedo = 0.0
"#;

/// A camera ray without scattering has at most two walks; each is cut where it gets too long, and
/// the path says so.
#[test]
fn enormous_densities_end() {
    let mut cut = 0;
    for scale in ["1e9", "1e12", "1e30", "3e38"] {
        for preset in Preset::ALL {
            for path in paths(&format!("{NOISE}density.scale = {scale}\n"), preset.strategy()) {
                assert!(path.tracking_steps <= 2 * MOST_COLLISIONS, "{scale} {preset}");
                let is_long = path.tracking_steps >= 2 * MOST_COLLISIONS;
                assert!(path.was_cut || !is_long, "{scale} {preset}");
                cut += usize::from(path.was_cut);
            }
        }
    }
    assert!(cut > 0, "no path was long enough to try the cut");
}

/// Sparks that the probing chords miss are not sampled without bound: nearly everything glows next
/// to nothing, and rare spots between the cells' centers glow 20 orders of magnitude brighter.
#[test]
fn tiny_bright_sparks_cost_little() {
    let text = r#"
        [[volume]]
        shape = "noise"
        frequency = 2.0
        octaves = 1
        density = { scale = 0.0 }
        emission = { mode = "ramp", stops = [
            [0.0, 1e-20, 1e-20, 1e-20], [0.97, 1e-20, 1e-20, 1e-20], [1.0, 1.0, 1.0, 1.0]] }
    "#;
    for preset in Preset::ALL {
        let steps: u32 =
            paths(text, preset.strategy()).iter().map(|path| path.tracking_steps).sum();
        assert!(steps < 36 * 1000, "{preset}: {steps}");
    }
}

/// The optimal majorant measures what it meets first, and heeds the weight of a walk that dense or
/// blinding matter leaves nothing of.
#[test]
fn the_optimal_majorant_takes_whatever_comes() {
    let mut strategy = Strategy::default();
    strategy.advanced.boost_mode = BoostMode::Optimal;
    for le in ["1e30", "1.0", "1e-30"] {
        for density in ["0.0", "1e-30", "1.0", "1e9", "3e38"] {
            let text = format!(
                "{NOISE}density.scale = {density}\nemission = {{ mode = \"source\", le = {le} }}\n"
            );
            for path in paths(&text, strategy) {
                let named = || format!("le {le}, density {density}: {path:?}");
                assert!(path.tracking_steps <= 2 * MOST_COLLISIONS, "{}", named());
                // The product of the two is emitted; beyond single precision it has no number.
                let has_number =
                    le.parse::<f64>().unwrap() * density.parse::<f64>().unwrap() < 1e38;
                assert!(path.beauty().is_finite() || !has_number, "{}", named());
            }
        }
    }
}

#[test]
fn placements_that_cannot_be_undone_are_refused_by_name() {
    for scale in ["1e-30", "1e30"] {
        let text = format!("{NOISE}density.scale = 1.0\nscale = {scale}\n");
        let folder = std::path::Path::new(".");
        let result = flambeau::scene::parse(&text, "extreme", folder, &Default::default())
            .and_then(|settings| {
                let cache = flambeau::scene::VolumeCache::default();
                flambeau::scene::assemble(&settings, &cache, flambeau::error::NO_PROGRESS)
            });
        if let Err(error) = result {
            assert!(error.to_string().contains("volume.0.scale"), "{error}");
        } else {
            for path in paths(&text, Preset::Full.strategy()) {
                assert!(path.beauty().is_finite(), "{scale}");
            }
        }
    }
}
