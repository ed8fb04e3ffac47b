//! Cameras with a lens of some size.

use flambeau::transport::strategy::Preset;

use crate::common::{Expected, Verdicts, build, full_name, with_strategy};

/// A lens of radius 0.5, focused at distance 5, before an edge at distance 10: rays of one film
/// point, which cross at the focus, reach the edge's plane mirrored and as far apart as on the
/// lens. What they see is the part of the lens beyond a chord at `CHORD` from its middle.
#[test]
fn a_lens_blurs_an_edge_by_the_circle_of_confusion() {
    const RADIUS: f64 = 0.5;
    const CHORD: f64 = 0.25;
    let share = CHORD / RADIUS;
    let beyond = (share.acos() - share * (1.0 - share * share).sqrt()) / std::f64::consts::PI;
    // A film so narrow that it has one direction; 57.3 mm of focal length at f/1.
    let units_per_mm = 2.0 * RADIUS / (0.5e-3 / 0.5e-3_f64.to_radians().tan());
    let scene = |edge: &str| {
        build(&format!(
            "[camera]
            position = [0, 0, 0]
            target = [0, 1, 0]
            fov_x = 0.001
            sensor_width = 0.001
            f_stop = 1.0
            units_per_mm = {units_per_mm}
            focus_distance = 5.0
            [[light]]
            type = 'quad'
            radiance = [1.0, 2.0, 3.0]
            center = {edge}
            half_u = [50, 0, 0]
            half_v = [0, 0, 50]"
        ))
    };
    let expected = Expected::known(&[1.0, 2.0, 3.0].map(|radiance| radiance * beyond));
    let whole = Expected::known(&[1.0, 2.0, 3.0]);
    let mut verdicts = Verdicts::default();
    for preset in [Preset::Baseline, Preset::Full] {
        let strategy = preset.strategy();
        let name = full_name(&strategy);
        for (label, scene, expected) in [
            ("edge on the right", scene("[50.25, 10, 0]"), &expected),
            ("edge on the left", scene("[-50.25, 10, 0]"), &expected),
            ("in focus", scene("[49.99, 5, 0]"), &whole),
        ] {
            let scene = with_strategy(&scene, strategy);
            verdicts.hold(&format!("{label}, {name}"), &scene, 2_000_000, expected);
        }
    }
    verdicts.finish();
}
