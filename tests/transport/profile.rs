//! The table along a ray against closed forms.

use std::sync::Arc;

use crate::common::{build, with_strategy};
use flambeau::math::Ray;
use flambeau::transport::{
    PreparedFrame, Scene,
    profile::{Profile, ProfileRow},
    strategy::{Advanced, Strategy},
};
use glam::{UVec2, Vec3A};

const ROWS: u32 = 2001;
const SIZE: UVec2 = UVec2::splat(64);

fn along_y() -> Ray {
    Ray::new(Vec3A::new(0.0, -5.0, 0.0), Vec3A::Y)
}

/// With the probes, whether they pay or not.
fn frame(scene: &Scene) -> PreparedFrame {
    let advanced = Advanced { share_learning: false, ..scene.strategy().advanced };
    let strategy = Strategy { advanced, ..*scene.strategy() };
    crate::common::frame_of(Arc::new(with_strategy(scene, strategy)), SIZE, 0)
}

fn profile(scene: &Scene) -> Profile {
    Profile::along(&frame(scene), &along_y(), ROWS).unwrap()
}

/// The trapezoidal rule.
fn integral(rows: &[ProfileRow], value: impl Fn(&ProfileRow) -> f32) -> f64 {
    let pieces = rows.windows(2);
    let area = |pair: &[ProfileRow]| {
        0.5 * f64::from(value(&pair[0]) + value(&pair[1])) * f64::from(pair[1].t - pair[0].t)
    };
    pieces.map(area).sum()
}

/// Smoke of μ_t = 2 with a lamp beside it, from t = 4 to 6.
const BALL: &str = r#"
    [[volume]]
    shape = "sphere"
    density.scale = 2.0
    albedo = 0.9
    emission = { mode = "constant", value = 3.0 }
    [[light]]
    type = "point"
    position = [0.3, 0.2, 0.1]
    intensity = 2.0
"#;

/// T = exp(−μ_t (t − 4)) and p_null = μ_t T, whose integral is 1 − exp(−4); what guides integrates
/// to 1; the weights sum to 1.
#[test]
fn homogeneous_smoke_is_as_its_formula() {
    let profile = profile(&build(BALL));
    assert_eq!(profile.rows.len(), ROWS as usize);
    assert!((profile.optical_depth - 4.0).abs() < 1e-4, "{}", profile.optical_depth);
    let (first, last) = (profile.rows[0], profile.rows[ROWS as usize - 1]);
    assert!((first.t - 4.0).abs() < 1e-5 && (last.t - 6.0).abs() < 1e-5);
    for row in &profile.rows {
        let transmittance = (-2.0 * (row.t - 4.0)).exp();
        assert!((row.transmittance / transmittance - 1.0).abs() < 1e-4, "{row:?}");
        assert!((row.p_null / (2.0 * transmittance) - 1.0).abs() < 1e-4, "{row:?}");
        assert!((row.mu_t - 2.0).abs() < 1e-6 && (row.emission - 3.0).abs() < 1e-5);
        assert!((row.weight_null + row.weight_guided - 1.0).abs() < 1e-5, "{row:?}");
    }
    let p_null = integral(&profile.rows, |row| row.p_null);
    assert!((p_null - (1.0 - (-4.0_f64).exp())).abs() < 1e-4, "{p_null}");
    assert!(profile.guided);
    let p_select = integral(&profile.rows, |row| row.p_select);
    assert!((p_select - 1.0).abs() < 2e-3, "{p_select}");
}

/// The lamp is nearest to the ray at t = 5.2.
#[test]
fn thin_smoke_is_looked_at_where_the_lamp_is() {
    let thin = BALL.replace("density.scale = 2.0", "density.scale = 0.1").replace("3.0", "0.0");
    let profile = profile(&build(&thin));
    let brightest = profile.rows.iter().max_by(|a, b| a.p_select.total_cmp(&b.p_select)).unwrap();
    assert!((brightest.t - 5.2).abs() < 0.2, "{brightest:?}");
    assert!(brightest.weight_guided > 0.9, "{brightest:?}");
}

#[test]
fn without_guides_the_other_strategy_has_all_the_weight() {
    let scene = build(&format!("strategy.probe_mis = false\n{BALL}"));
    let all = profile(&scene);
    assert!(!all.guided && all.rows.iter().all(|row| row.p_select == 0.0));
    assert!(all.rows.iter().all(|row| (row.weight_null, row.weight_guided) == (1.0, 0.0)));
    let scene = build(&format!("strategy.advanced.distance = 'probes'\n{BALL}"));
    let all = profile(&scene);
    assert!(all.rows.iter().all(|row| (row.weight_null, row.weight_guided) == (0.0, 1.0)));
}

/// μ_t = 3 exp(−(y + 1)) in a box from y = −1 to 1: the optical depth up to t = y + 5 is
/// 3 (1 − exp(−(t − 4))), also by the midpoint rule.
#[test]
fn a_ramp_is_integrated() {
    let profile = profile(&build(
        r#"
        [[volume]]
        shape = "ramp"
        half_size = 1.0
        axis = "y"
        kind = "exponential"
        a = 3.0
        h = 1.0
        albedo = 0.5
        "#,
    ));
    for row in profile.rows.iter().skip(1) {
        let depth = 3.0 * -(-(row.t - 4.0)).exp_m1();
        assert!((-row.transmittance.ln() / depth - 1.0).abs() < 2e-3, "{row:?} for {depth}");
    }
}

/// Between two slabs there is nothing; channels have their own T, and what counts is their mean.
/// The second slab is cut by a black wall in its middle.
#[test]
fn gaps_are_clear_channels_apart_and_surfaces_end_it() {
    let slab = |y: f32| {
        format!(
            "[[volume]]\nshape = 'box'\nhalf_size = [9, 0.5, 9]\ntranslate = [0, {y}, 0]\n\
             density.scale = [1.0, 2.0, 4.0]\nalbedo = 0.5\n"
        )
    };
    let wall = "[[surface]]\nshape = 'plane'\npoint = [0, 2, 0]\nnormal = [0, 1, 0]\n";
    let scene = build(&format!("{}{}{wall}", slab(-1.0), slab(2.0)));
    let profile = profile(&scene);
    let transmittance = |depth: f32| {
        [1.0, 2.0, 4.0].map(|mu_t: f32| (-mu_t * depth).exp()).iter().sum::<f32>() / 3.0
    };
    for row in &profile.rows {
        let depth = (row.t - 3.5).clamp(0.0, 1.0) + (row.t - 6.5).clamp(0.0, 0.5);
        assert!((row.transmittance / transmittance(depth) - 1.0).abs() < 1e-4, "{row:?}");
        if (4.51..6.49).contains(&row.t) {
            assert_eq!((row.mu_t, row.p_null, row.p_select), (0.0, 0.0, 0.0));
        }
    }
    let last = profile.rows[ROWS as usize - 1].t;
    assert!((last - 7.0).abs() < 1e-4, "the wall is at 7: {last}");
}

/// A fog that never ends is shown until it is dark; with μ_t = 0.5, to t = 14.
#[test]
fn fog_ends_where_it_is_dark() {
    let fog = "[[volume]]\nshape = 'everywhere'\ndensity.scale = 0.5\nalbedo = 0.9\n";
    let scene = build(fog);
    let all = profile(&scene);
    assert!((all.rows[ROWS as usize - 1].t - 14.0).abs() < 1e-3);
    assert_eq!(all, profile(&scene), "no chance is involved");
    let aside = Ray::new(Vec3A::new(0.0, -5.0, 3.0), Vec3A::Y);
    assert!(Profile::along(&frame(&build(BALL)), &aside, ROWS).is_none(), "nothing is there");
}
