//! Scenes as text, estimates with their standard errors, and the z-tests that judge them.
//!
//! Every comparison asks for |z| <= 5, so that one false alarm has probability 5.7e-7 and a family
//! of M comparisons at most M times that; no family here has more than a thousand. An error of 3.7
//! % of the expected value is found in any of them with a probability of 99 %, unless a test says
//! why not, by a standard error of 0.5 % or by a test in steps (`sequential`) that lets no more
//! through. What many settings have in common is held much closer (`verdicts`).

pub mod sequential;
mod verdicts;

use std::{
    collections::BTreeSet,
    path::Path,
    sync::{Arc, Mutex},
};

use flambeau::{
    error::NO_PROGRESS,
    math::{ACCUMULATORS, Rgb},
    render::{Film, estimate::PixelEstimate},
    scene::{self, Overrides, VolumeCache},
    transport::{
        Frame, PathSample, PreparedFrame, Scene,
        prepare::SceneProbes,
        probes::Probes,
        strategy::{
            Advanced, BoostMode, Distance, LightSelection, NeeEvaluation, ScatterProbability,
            Strategy, TransmittanceEstimator,
        },
    },
};
use glam::UVec2;
use rayon::prelude::*;

pub use sequential::Z_LIMIT;
pub use verdicts::{Expected, Verdicts};

/// Fire with soot inside scattering smoke on a floor, a lamp, a sun and a metal ball.
pub const EVERYTHING: &str = r#"
    [camera]
    position = [0, -5, 1.5]
    target = [0, 0, 0]
    fov_x = 40
    [environment]
    radiance = [0.02, 0.03, 0.05]
    [[volume]]
    name = "fire"
    shape = "noise"
    half_size = [0.5, 0.5, 0.9]
    frequency = 2.0
    contrast = 3.0
    density = { scale = 1.5 }
    albedo = 0.3
    emission = { mode = "source", le = [8.0, 3.0, 1.0] }
    [[volume]]
    name = "smoke"
    shape = "noise"
    half_size = [1.2, 0.8, 1.0]
    translate = [0.2, -0.4, 0.0]
    frequency = 1.0
    contrast = 2.0
    density = { scale = 2.0 }
    albedo = [0.9, 0.8, 0.7]
    phase = { g = 0.5 }
    [[light]]
    type = "sphere"
    center = [1.5, -1.0, 1.2]
    radius = 0.2
    radiance = [2.0, 4.0, 8.0]
    [[light]]
    type = "sun"
    direction = [-1, 1, -1]
    irradiance = 0.5
    angle = 3
    [[light]]
    type = "spot"
    position = [-2, -2, 3]
    target = [0, 0, 0]
    intensity = 4.0
    cone = 30
    blend = 0.5
    [[surface]]
    shape = "plane"
    point = [0, 0, -1.0]
    normal = [0, 0, 1]
    half_size = 5.0
    material = { type = "diffuse", reflectance = 0.5 }
    [[surface]]
    shape = "sphere"
    center = [1.2, -0.6, -0.6]
    radius = 0.4
    material = { type = "conductor", alpha = 0.3, reflectance = 0.9 }
"#;

/// Largest standard error, relative to the expected value, that a test may rest on.
pub const POWER: f64 = 0.005;
/// The same of a measurement that others are held against.
pub const CLOSELY: f64 = 0.7 * POWER;
/// The same of a difference from such a measurement.
pub const REFERENCED: f64 = 1.12 * POWER;

/// A mean per channel, with the variance of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Estimate {
    pub mean: [f64; 3],
    pub variance: [f64; 3],
}

impl Estimate {
    /// Standard error of a channel.
    pub fn error(&self, channel: usize) -> f64 {
        self.variance[channel].sqrt()
    }
}

/// The seed of a run: 0 unless fresh seeds are asked for through FLAMBEAU_FRESH_SEEDS.
pub fn seed() -> u64 {
    match std::env::var_os("FLAMBEAU_FRESH_SEEDS") {
        None => 0,
        Some(_) => {
            let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap();
            let seed = now.as_nanos() as u64;
            eprintln!("fresh seed {seed}");
            seed
        }
    }
}

/// Builds a scene from its text; file names are relative to the tests' folder.
pub fn build(text: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let settings = scene::parse(text, "test scene", &folder, &Overrides::default()).unwrap();
    flambeau::scene::assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap()
}

/// A built scene under another strategy.
pub fn with_strategy(scene: &Scene, strategy: Strategy) -> Scene {
    scene.clone().with_strategy(strategy)
}

/// The finer keys at their defaults, but for the probes, which are asked whether that pays or not.
pub fn asking() -> Advanced {
    Advanced { share_learning: false, ..Advanced::default() }
}

/// Every combination of the toggles, half of them with few guided flights and half with as many as
/// light asks for.
pub fn all_strategies() -> Vec<Strategy> {
    (0..32).map(toggles).collect()
}

/// Half of [`all_strategies`], in which every combination of any four occurs.
pub fn half_of_strategies() -> Vec<Strategy> {
    (0..32_u32).filter(|bits| bits.count_ones() % 2 == 1).map(toggles).collect()
}

fn toggles(bits: u32) -> Strategy {
    let scatter_probability =
        if bits & 1 != 0 { ScatterProbability::Light } else { ScatterProbability::Even };
    Strategy {
        emission_decoupling: bits & 1 != 0,
        emission_ratio_tracking: bits & 2 != 0,
        majorant_boost: bits & 4 != 0,
        nee: bits & 8 != 0,
        probe_mis: bits & 16 != 0,
        advanced: Advanced { scatter_probability, ..asking() },
        ..Strategy::default()
    }
}

/// Every strategy on, with each boost mode but the default.
pub fn boost_modes() -> [Strategy; 3] {
    [BoostMode::Optimal, BoostMode::Clamped, BoostMode::Literal].map(|boost_mode| {
        let advanced = Advanced { boost_mode, ..Advanced::default() };
        Strategy { advanced, ..Strategy::default() }
    })
}

/// The finer keys in eight rows, an orthogonal array: every two keys meet in every pair of their
/// values, and so do the last three, all three of them. The three estimators of transmittance meet
/// most of them, and two ways to choose lights share the place of one.
pub fn finer() -> [Advanced; 8] {
    use TransmittanceEstimator::{Marching, Ratio, Residual};
    let modes = [BoostMode::Stratified, BoostMode::Optimal, BoostMode::Clamped, BoostMode::Literal];
    std::array::from_fn(|row| {
        let [a, b, c] = [row & 1 != 0, row & 2 != 0, row & 4 != 0];
        Advanced {
            boost_mode: modes[row % 4],
            boost_amount: if c { 64.0 } else { 2.0 },
            nee_evaluation: if a ^ c { NeeEvaluation::Point } else { NeeEvaluation::Line },
            light_selection: match (b ^ c, a) {
                (false, _) => LightSelection::Hierarchy,
                (true, false) => LightSelection::Uniform,
                (true, true) => LightSelection::Probes,
            },
            low_discrepancy: a ^ b ^ c,
            distance: if a ^ b { Distance::Probes } else { Distance::Mis },
            scatter_probability: if b {
                ScatterProbability::Even
            } else {
                ScatterProbability::Light
            },
            transmittance: [Marching, Residual, Ratio, Marching][row / 2],
            equiangular: !c,
            guide_directions: !(a ^ c),
            guide_all_vertices: b ^ c,
            ..asking()
        }
    })
}

/// Every way to choose a distance with every other guide on and off.
pub fn every_guide() -> Vec<Strategy> {
    let mut all = Vec::new();
    for distance in [Distance::Mis, Distance::Probes] {
        for bits in 0..8_u32 {
            let advanced = Advanced {
                distance,
                equiangular: bits & 1 != 0,
                guide_directions: bits & 2 != 0,
                guide_all_vertices: bits & 4 != 0,
                ..asking()
            };
            all.push(Strategy { advanced, ..Strategy::default() });
        }
    }
    all
}

/// Every way to choose a distance with all other guides on and with none.
pub fn few_guides() -> Vec<Strategy> {
    let all = |a: &Advanced| a.equiangular && a.guide_directions && a.guide_all_vertices;
    let none = |a: &Advanced| !a.equiangular && !a.guide_directions && !a.guide_all_vertices;
    every_guide().into_iter().filter(|s| all(&s.advanced) || none(&s.advanced)).collect()
}

/// Every `n`th of some settings: scenes with known values take these, and one scene
/// takes all. Each toggle is on and off among them, and each finer key has all its values.
pub fn every_nth(n: usize, settings: impl IntoIterator<Item = Strategy>) -> Vec<Strategy> {
    let all: Vec<Strategy> = settings.into_iter().collect();
    let some: Vec<Strategy> = all.iter().copied().step_by(n).collect();
    assert_eq!(choices(&some), choices(&all), "every {n}th leaves something out");
    some
}

/// Each choice that is made in some settings, toggles and finer keys alike.
fn choices(settings: &[Strategy]) -> BTreeSet<String> {
    settings.iter().flat_map(choices_of).collect()
}

/// The choices that are made in a setting.
fn choices_of(setting: &Strategy) -> BTreeSet<String> {
    let [toggles, finer] = [name(setting), full_name(setting)];
    let toggles = toggles.char_indices().map(|(place, letter)| format!("{place} {letter}"));
    let finer = finer.split(' ').skip(1).map(str::to_owned).collect::<Vec<_>>();
    toggles.chain(finer).collect()
}

/// Every combination of the toggles with each row of [`finer`], those that are the same by
/// definition once: ratio tracking overrides decoupling, and a key without its toggle says nothing.
pub fn every_setting() -> Vec<Strategy> {
    let mut settings: Vec<Strategy> = Vec::new();
    for toggles in half_of_strategies() {
        for advanced in finer() {
            let setting = effective(Strategy { advanced, ..toggles });
            if !settings.contains(&setting) {
                settings.push(setting);
            }
        }
    }
    settings
}

/// Those of [`every_setting`] whose looks at fire gather its glow all along the line. To a vertex
/// inside fire, its glow at one point has infinite variance: no z-test can judge it there.
pub fn every_line_setting() -> Vec<Strategy> {
    let line = |setting: &Strategy| setting.advanced.nee_evaluation == NeeEvaluation::Line;
    every_setting().into_iter().filter(line).collect()
}

fn effective(mut strategy: Strategy) -> Strategy {
    let plain = Advanced::default();
    let has_own_walk = strategy.emission_ratio_tracking;
    strategy.emission_decoupling &= !has_own_walk;
    strategy.majorant_boost &= has_own_walk || strategy.emission_decoupling;
    let advanced = &mut strategy.advanced;
    if !strategy.majorant_boost {
        (advanced.boost_mode, advanced.boost_amount) = (plain.boost_mode, plain.boost_amount);
    } else if !has_own_walk && advanced.boost_mode != BoostMode::Literal {
        advanced.boost_mode = BoostMode::Clamped;
    }
    if !strategy.nee {
        advanced.nee_evaluation = plain.nee_evaluation;
    }
    if !strategy.probe_mis {
        advanced.distance = plain.distance;
        advanced.scatter_probability = plain.scatter_probability;
        advanced.share_learning = plain.share_learning;
        advanced.equiangular = plain.equiangular;
        advanced.guide_directions = plain.guide_directions;
        advanced.guide_all_vertices = plain.guide_all_vertices;
    }
    strategy
}

/// The name of a strategy with its finer keys.
pub fn full_name(strategy: &Strategy) -> String {
    let Advanced { boost_mode, boost_amount, nee_evaluation, light_selection, .. } =
        strategy.advanced;
    let spread = if strategy.advanced.low_discrepancy { "even" } else { "random" };
    let on = |flag: bool, name: &'static str| if flag { name } else { "" };
    let Advanced { transmittance, distance, scatter_probability, equiangular, .. } =
        strategy.advanced;
    let Advanced { guide_directions, guide_all_vertices, .. } = strategy.advanced;
    let guides = [
        on(equiangular, " angles"),
        on(guide_directions, " directions"),
        on(guide_all_vertices, " bounces"),
    ];
    format!(
        "{} {boost_mode:?} {boost_amount} {nee_evaluation:?} {light_selection:?} {spread} \
         {distance:?} {scatter_probability:?} {transmittance:?}{}",
        name(strategy),
        guides.concat()
    )
}

/// A short name of a strategy for messages.
pub fn name(strategy: &Strategy) -> String {
    let on = |flag: bool, letter: char| if flag { letter } else { '-' };
    [
        on(strategy.emission_decoupling, 'd'),
        on(strategy.emission_ratio_tracking, 'r'),
        on(strategy.majorant_boost, 'b'),
        on(strategy.nee, 'n'),
        on(strategy.probe_mis, 'p'),
    ]
    .iter()
    .collect()
}

/// A scene on a film, its pilot pass run.
pub fn frame_of(scene: impl Into<Arc<Scene>>, size: UVec2, seed: u64) -> PreparedFrame {
    PreparedFrame::new(scene.into(), size, seed, NO_PROGRESS).unwrap()
}

/// A frame whose pilot pass has run.
pub fn prepared(frame: Frame) -> PreparedFrame {
    frame.prepared(NO_PROGRESS).unwrap()
}

/// All probes of a scene, if its strategy asks for any.
pub fn probes_of(scene: &Scene) -> Option<Arc<Probes>> {
    let placed = placed(scene)?;
    Some(placed.fine(scene, NO_PROGRESS).unwrap().clone())
}

/// The probes of a scene in their two stages, if its strategy asks for any.
pub fn placed(scene: &Scene) -> Option<Arc<SceneProbes>> {
    SceneProbes::placed(scene, NO_PROGRESS).unwrap().map(Arc::new)
}

/// Probes by the scene they were placed in.
type Placed = Vec<(Scene, Option<Arc<SceneProbes>>)>;

/// A scene on a square film, its pilot pass run if the strategy learns how often probes guide; all
/// other counts are those of first samples without it, as what they are changes no picture (see
/// `counts`). Strategies that ask for the same probes of one scene share them, as in
/// the window: to place them anew for each of a hundred settings takes longer than the paths.
pub fn framed(scene: &Scene, side: u32) -> PreparedFrame {
    framed_by_seed(scene, side, 0)
}

/// [`framed`] with the random numbers of another seed.
pub fn framed_by_seed(scene: &Scene, side: u32, number: u64) -> PreparedFrame {
    static PLACED: Mutex<Placed> = Mutex::new(Vec::new());
    let same = |(other, _): &&(Scene, Option<Arc<SceneProbes>>)| {
        let [one, two] = [scene, other].map(|scene| scene.world.instances());
        let same_build = std::iter::zip(one, two).all(|(a, b)| Arc::ptr_eq(a.volume(), b.volume()));
        same_build
            && one.len() == two.len()
            && Probes::recipe(scene.strategy()) == Probes::recipe(other.strategy())
    };
    let known = PLACED.lock().unwrap().iter().find(same).map(|(_, probes)| probes.clone());
    let probes = known.unwrap_or_else(|| {
        let probes = placed(scene);
        PLACED.lock().unwrap().push((scene.clone(), probes.clone()));
        probes
    });
    let seed = seed().wrapping_add(number);
    let frame = Frame::with_probes(Arc::new(scene.clone()), UVec2::splat(side), seed, probes);
    match scene.strategy().learns_share() {
        true => prepared(frame),
        false => frame.with_first_counts(NO_PROGRESS).unwrap(),
    }
}

/// Side of the film that single-value scenes are rendered on.
const SIDE: u32 = 32;

/// The mean over the whole film of what `of` takes from each path, and its variance as the film's
/// accumulators tell it, which holds for samples that depend on each other too.
pub fn measure_with(scene: &Scene, paths: u32, of: impl Fn(&PathSample) -> Rgb + Sync) -> Estimate {
    let (frame, mut rows) = (framed(scene, SIDE), Rows::default());
    rows.add(paths.div_ceil(SIDE * SIDE).max(2), |_| &frame, of);
    rows.estimate()
}

/// A film that is filled further and further.
struct Rows {
    films: Vec<Film>,
    samples: u32,
}

impl Default for Rows {
    fn default() -> Self {
        let films = (0..SIDE).map(|_| Film::new(UVec2::new(SIDE, 1)).unwrap()).collect();
        Self { films, samples: 0 }
    }
}

impl Rows {
    /// Adds samples until each pixel has so many, each from its frame.
    fn add<'f>(
        &mut self,
        samples: u32,
        frame: impl Fn(u32) -> &'f PreparedFrame + Sync,
        of: impl Fn(&PathSample) -> Rgb + Sync,
    ) {
        let present = self.samples;
        self.films.par_iter_mut().enumerate().for_each(|(y, film)| {
            for x in 0..SIDE {
                for s in present..samples {
                    let direct = of(&frame(s).sample(UVec2::new(x, y as u32), s));
                    film.add(UVec2::new(x, 0), &PathSample { direct, ..PathSample::default() });
                }
            }
            assert_eq!(film.totals.non_finite, 0);
        });
        self.samples = samples;
    }

    /// The mean over all pixels.
    fn estimate(&self) -> Estimate {
        let pixels = f64::from(SIDE * SIDE);
        let mut sum = Estimate::default();
        for film in &self.films {
            for x in 0..SIDE {
                let pixel = PixelEstimate::of(film, UVec2::new(x, 0)).unwrap();
                let (mean, variance) = (pixel.mean(), pixel.variance().unwrap());
                (0..3).for_each(|c| sum.mean[c] += mean[c] / pixels);
                (0..3).for_each(|c| sum.variance[c] += variance[c] / (pixels * pixels));
            }
        }
        sum
    }
}

/// The mean radiance over the whole film.
pub fn measure(scene: &Scene, paths: u32) -> Estimate {
    measure_with(scene, paths, PathSample::beauty)
}

/// The mean radiance over the whole film, of so many paths as bring its standard error to
/// [`CLOSELY`], to hold others against, and about `most` at most.
pub fn measure_closely(scene: &Scene, most: u32) -> Estimate {
    measure_to(scene, most, CLOSELY, PathSample::beauty)
}

/// The mean over the whole film of what `of` takes from each path of all `scenes` together, by so
/// many rounds in which each has as many samples in every accumulator.
pub fn measure_in_turn(
    scenes: &[Scene],
    rounds: u32,
    of: impl Fn(&PathSample) -> Rgb + Sync,
) -> Estimate {
    let frames: Vec<_> = scenes.iter().map(|scene| framed(scene, SIDE)).collect();
    let turn = |s: u32| (s / ACCUMULATORS as u32) as usize % frames.len();
    let samples = rounds * ACCUMULATORS as u32 * frames.len() as u32;
    let mut rows = Rows::default();
    rows.add(samples, |s| &frames[turn(s)], of);
    rows.estimate()
}

/// The mean over the whole film of what `of` takes from each path, by so many paths as bring its
/// standard error to `power`, relative to it, and about `most` at most.
///
/// It goes on until the samples so far have brought the error. To stop by their variance moves
/// their mean by next to nothing, there being thousands of pixels.
pub fn measure_to(
    scene: &Scene,
    most: u32,
    power: f64,
    of: impl Fn(&PathSample) -> Rgb + Sync,
) -> Estimate {
    const ROUND: u32 = ACCUMULATORS as u32;
    const MARGIN: f64 = 0.98;
    let frame = framed(scene, SIDE);
    let most = most.div_ceil(SIDE * SIDE * ROUND).max(1) * ROUND;
    let (mut rows, mut wanted) = (Rows::default(), ROUND);
    loop {
        rows.add(wanted, |_| &frame, &of);
        let estimate = rows.estimate();
        let missing = worst_error(&estimate) / (MARGIN * power);
        if missing <= 1.0 || wanted >= most {
            return estimate;
        }
        let next = f64::from(wanted) * missing.powi(2).min(4.0);
        wanted = (next as u32 / ROUND + 1).saturating_mul(ROUND).min(most);
    }
}

/// The largest standard error among the channels, relative to its mean.
fn worst_error(estimate: &Estimate) -> f64 {
    let relative = |channel: usize| estimate.error(channel) / estimate.mean[channel].abs();
    let worst = (0..3).map(relative).fold(0.0, f64::max);
    if worst.is_finite() { worst } else { f64::INFINITY }
}

/// The folder of large test data beside the repository; `None`, said aloud, where it is absent.
pub fn shared(file: &str) -> Option<std::path::PathBuf> {
    let folder = std::env::var_os("FLAMBEAU_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        std::path::PathBuf::from,
    );
    let path = folder.join(file);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is not there", path.display());
    None
}
