//! Volumes that move by a velocity while the shutter is open: pictures are the means of stills over
//! the shutter's time, whatever the strategy; everything else is as it is without motion.

#[path = "../vdb/grids.rs"]
mod grids;

use flambeau::math::{PathRng, Ray, Rgb};
use flambeau::transport::observer::{Observer, PathStep};
use flambeau::transport::strategy::{Advanced, Integrator, NeeEvaluation, Preset, Strategy};
use flambeau::transport::{PathSample, PreparedFrame, Scene};
use flambeau::volume::Shutter;
use flambeau::volume::medium::Coefficients;
use flambeau::volume::world::World;
use glam::{DAffine3, DQuat, DVec3, EulerRot, IVec3, UVec2, Vec3A};

use crate::common::{
    EVERYTHING, Expected, Verdicts, build, frame_of, full_name, measure_in_turn, with_strategy,
};
use grids::{Grid, ball, file};

/// Largest standard error of the mean of stills, and of differences from it, relative to it:
/// deviations of 11 % are found with a probability of 99 % in a single setting, and smaller ones in
/// all of them together.
const CLOSELY: f64 = 0.008;
const REFERENCED: f64 = 0.015;

/// A file in a folder of its own, which goes with it.
struct File {
    _folder: tempfile::TempDir,
    name: String,
}

impl File {
    fn of(grids: &[Grid]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("moving.vdb");
        std::fs::write(&path, file(grids)).unwrap();
        Self { name: path.to_str().unwrap().to_owned(), _folder: folder }
    }
}

/// A number in 0..1 for each voxel, far from that of its neighbors.
fn rough(voxel: IVec3) -> f32 {
    let n = (voxel.x * 73 + voxel.y * 179 + voxel.z * 283).rem_euclid(101);
    n as f32 / 101.0
}

/// The voxels of a cube of so many on each side of the origin.
fn cube(half: i32, value: impl Fn(IVec3) -> f32) -> Vec<(IVec3, f32)> {
    let edge = 2 * half + 1;
    let places = (0..edge.pow(3)).map(|n| IVec3::new(n / edge / edge, n / edge % edge, n % edge));
    places.map(|place| place - half).map(|voxel| (voxel, value(voxel))).collect()
}

/// A ball of rough smoke with a flame in it.
fn smoke_and_flame() -> Vec<Grid> {
    let mut smoke = ball(IVec3::ZERO, 6, 1.0);
    smoke.iter_mut().for_each(|(voxel, value)| *value = 0.2 + rough(*voxel));
    let mut flame = ball(IVec3::new(2, 0, -1), 3, 1.0);
    flame.iter_mut().for_each(|(voxel, value)| *value = rough(*voxel));
    vec![Grid::fog("density", smoke), Grid::fog("flame", flame)]
}

/// Everything, with a volume of that file in place of the fire.
fn scene_of(file: &File, volume: &str, time: &str) -> Scene {
    let (before, after) = EVERYTHING.split_once("[[volume]]").unwrap();
    let (_, others) = after.split_once("[[volume]]").unwrap();
    let fire = format!(
        "[[volume]]\nfile = '{}'\ndensity = {{ scale = 3.0 }}\nalbedo = [0.8, 0.5, 0.3]
        emission = {{ mode = 'grid', grid = 'flame', scale = 20.0, color = [1.0, 0.5, 0.2] }}",
        file.name
    );
    build(&format!("{before}\n[time]\n{time}\n{fire}\n{volume}\n[[volume]]{others}"))
}

/// Stills at the middles of equal parts of an interval around 0.
fn middles(count: u32, length: f64) -> impl Iterator<Item = f64> {
    (0..count).map(move |n| length * ((f64::from(n) + 0.5) / f64::from(count) - 0.5))
}

fn strategies() -> Vec<Strategy> {
    let point = Advanced { nee_evaluation: NeeEvaluation::Point, ..Advanced::default() };
    let mut all: Vec<Strategy> =
        [Preset::Baseline, Preset::Emission, Preset::Full].map(Preset::strategy).into();
    all.push(Strategy { advanced: point, ..Preset::Full.strategy() });
    all
}

/// Holds what `of` takes from the blurred picture under every strategy against the mean of stills
/// by so many rounds of samples.
fn hold_against_stills(blurred: &Scene, stills: &[Scene], rounds: u32, of: fn(&PathSample) -> Rgb) {
    let full = Preset::Full.strategy();
    let stills: Vec<Scene> = stills.iter().map(|still| with_strategy(still, full)).collect();
    let reference = measure_in_turn(&stills, rounds, of);
    (0..3).for_each(|c| assert!(reference.error(c) < CLOSELY * reference.mean[c], "{reference:?}"));
    let expected = Expected::measured(&reference);
    let mut verdicts = Verdicts::of_power(REFERENCED);
    for strategy in strategies() {
        let scene = with_strategy(blurred, strategy);
        verdicts.hold_part(&full_name(&strategy), &scene, 1_000_000, &expected, of);
    }
    verdicts.finish();
}

/// Light after scattering.
fn scattered(sample: &PathSample) -> Rgb {
    sample.direct + sample.indirect
}

/// Smoke that is always in the shadow of a black cloud above it and always lit by the same flame
/// beside it, seen from below, while all three move by far more than their sizes: whatever part of
/// a path saw another moment would find the sun there, and the flame elsewhere.
#[test]
fn a_uniform_velocity_blurs_as_translated_stills() {
    let mut smoke = ball(IVec3::ZERO, 3, 1.0);
    smoke.iter_mut().for_each(|(voxel, value)| *value = 0.2 + rough(*voxel));
    smoke.extend(ball(IVec3::new(0, 0, 9), 4, 20.0));
    let flame = ball(IVec3::new(0, 11, 0), 5, 1.0);
    smoke.extend(flame.clone());
    let components = [45.0, 5.0, 0.0];
    // The cloud is black.
    let albedo = Grid::fog("albedo", ball(IVec3::ZERO, 3, 0.8));
    let file = File::of(&[
        Grid::fog("density", smoke),
        albedo,
        Grid::fog("flame", flame),
        Grid { kind: "vec3s", components, ..Grid::fog("vel", cube(26, |_| 1.0)) },
    ]);
    let scene = |at: DVec3, more: &str| {
        build(&format!(
            "camera = {{ position = [0, 0, -6], target = [0, 0, 0], up = [0, 1, 0], fov_x = 28 }}
            [time]\nfps = 25\n{more}
            [[volume]]\nfile = '{}'\nscale = 1.2\nrotate = [0, 0, 90]
            translate = [{}, {}, {}]\nvelocity.grid = 'vel'
            density = {{ scale = 3.0 }}\nalbedo = {{ grid = 'albedo' }}
            emission = {{ mode = 'grid', grid = 'flame', scale = 20.0, color = [1.0, 0.5, 0.2] }}
            [[light]]\ntype = 'sun'\ndirection = [0, 0, -1]\nirradiance = 30.0\nangle = 1",
            file.name, at.x, at.y, at.z
        ))
    };
    let at = DVec3::new(0.1, 0.2, 0.1);
    // A quarter turn about z.
    let velocity = 1.2 * DVec3::new(-5.0, 45.0, 0.0);
    let still = |seconds: f64| scene(at + seconds * velocity, "");
    let stills: Vec<Scene> = middles(12, 1.0 / 25.0).map(still).collect();
    hold_against_stills(&scene(at, "shutter = 1"), &stills, 16, scattered);
}

/// A vortex that shrinks on one side: stills of a fraction of the frame, which are one moment each.
#[test]
fn a_varying_velocity_blurs_as_stills_of_fractional_frames() {
    let mut grids = smoke_and_flame();
    let along = |axis: usize| {
        cube(12, move |voxel| {
            let p = 0.1 * voxel.as_vec3();
            [20.0 * p.y + 5.0 * p.x * p.z, -20.0 * p.x, 8.0 * p.x - 6.0 * p.z][axis]
        })
    };
    let names = ["vel.x", "vel.y", "vel.z"];
    grids.extend((0..3).map(|axis| Grid::fog(names[axis], along(axis))));
    let file = File::of(&grids);
    let moving = "translate = [0.1, 0.2, 0.1]\nvelocity = { grids = ['vel.x', 'vel.y', 'vel.z'] }";
    let blurred = scene_of(&file, moving, "frame = 3\nshutter = 0.9");
    let stills: Vec<Scene> = middles(12, 0.9)
        .map(|frames| scene_of(&file, moving, &format!("frame = {}", 3.0 + frames)))
        .collect();
    hold_against_stills(&blurred, &stills, 2, PathSample::beauty);
}

/// A camera that passes a key while the shutter is open, goes on another way from there, and zooms.
#[test]
fn a_moving_camera_blurs_as_stills_of_fractional_frames() {
    let keys = "
    [[camera.key]]
    frame = 2.5
    position = [-1.2, -5, 1.5]
    fov_x = 30
    [[camera.key]]
    frame = 3.1
    position = [0.9, -4, 1.5]
    target = [0.3, 0, 0]
    fov_x = 42
    [[camera.key]]
    frame = 3.6
    position = [0.9, -4, -0.3]
    [environment]";
    let (camera, others) = EVERYTHING.split_once("[environment]").unwrap();
    let scene = |time: &str| build(&format!("{camera}{keys}{others}\n[time]\n{time}"));
    let stills: Vec<Scene> =
        middles(18, 0.9).map(|frames| scene(&format!("frame = {}", 3.0 + frames))).collect();
    hold_against_stills(&scene("frame = 3\nshutter = 0.9"), &stills, 2, PathSample::beauty);
}

/// The medium at a point and a time.
fn medium_at(world: &World, point: Vec3A, time: f32) -> Coefficients {
    let mut medium = world.along(Ray::new(point, Vec3A::X).at_time(time), 1e-4);
    medium.next_segment().map_or_else(Coefficients::default, |one| medium.coefficients(one.t0))
}

/// A velocity in a file, and the same as a formula.
struct Field {
    name: &'static str,
    grids: Vec<Grid>,
    keys: &'static str,
    at: Box<dyn Fn(DVec3) -> DVec3>,
}

/// Edge of the voxels of the fields, and the place of the first.
const EDGE: f64 = 0.2;
const FIRST: DVec3 = DVec3::new(0.13, -0.07, 0.02);

/// Linear functions, which interpolation keeps.
fn linear(axis: usize, p: DVec3) -> f64 {
    let slopes =
        [DVec3::new(9.0, -7.0, 4.0), DVec3::new(-3.0, 8.0, 2.0), DVec3::new(5.0, 1.0, -6.0)];
    [4.0, -3.0, 6.0][axis] + slopes[axis].dot(p)
}

fn field_grid(name: &'static str, class: &'static str, axis: usize, offset: DVec3) -> Grid {
    let translation = FIRST + offset;
    let value = move |voxel: IVec3| linear(axis, translation + EDGE * voxel.as_dvec3()) as f32;
    Grid { class, voxel_size: EDGE, translation, ..Grid::fog(name, cube(11, value)) }
}

/// Vectors and components, at the middles of voxels and at their faces.
fn fields() -> Vec<Field> {
    let half = |axis: usize| 0.5 * EDGE * DVec3::AXES[axis];
    let three = |class: &'static str, offset: f64| {
        let grid = |axis: usize| {
            field_grid(["v.x", "v.y", "v.z"][axis], class, axis, -offset * half(axis))
        };
        vec![grid(0), grid(1), grid(2)]
    };
    let components = [2.0_f32, -1.0, 1.5];
    let vector = |class: &'static str| {
        vec![Grid { kind: "vec3s", components, ..field_grid("vel", class, 0, DVec3::ZERO) }]
    };
    let of = |at: &dyn Fn(usize) -> f64| DVec3::new(at(0), at(1), at(2));
    let factor = move |axis: usize| f64::from(components[axis]);
    let (one, all) = ("grid = 'vel'", "grids = ['v.x', 'v.y', 'v.z']");
    vec![
        Field {
            name: "vectors",
            grids: vector("unknown"),
            keys: one,
            at: Box::new(move |p| of(&|axis| factor(axis) * linear(0, p))),
        },
        Field {
            name: "vectors at faces",
            grids: vector("staggered"),
            keys: one,
            at: Box::new(move |p| of(&|axis| factor(axis) * linear(0, p + half(axis)))),
        },
        Field {
            name: "components",
            grids: three("unknown", 0.0),
            keys: all,
            at: Box::new(move |p| of(&|axis| linear(axis, p))),
        },
        Field {
            name: "components at faces",
            grids: three("staggered", 0.0),
            keys: all,
            at: Box::new(move |p| of(&|axis| linear(axis, p + half(axis)))),
        },
        Field {
            name: "components that their places put at faces",
            grids: three("staggered", 1.0),
            keys: all,
            at: Box::new(move |p| of(&|axis| linear(axis, p))),
        },
    ]
}

/// The coefficients at (x, t) are the still's at x − t v(x), with v in the file's units, turned and
/// scaled by the placement.
#[test]
fn the_medium_comes_from_where_the_velocity_says() {
    let place = "scale = [1.5, 0.7, 2.0]\nrotate = [20, -30, 40]\ntranslate = [0.3, -0.2, 0.5]";
    let rotation = [20.0_f64, -30.0, 40.0].map(f64::to_radians);
    let rotation = DQuat::from_euler(EulerRot::ZYX, rotation[2], rotation[1], rotation[0]);
    let scale = DVec3::new(1.5, 0.7, 2.0);
    let world_from_file =
        DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::new(0.3, -0.2, 0.5));
    for field in fields() {
        let mut grids = smoke_and_flame();
        grids.extend(field.grids);
        let file = File::of(&grids);
        // The fire alone.
        let alone = |volume: &str, time: &str| {
            let world = scene_of(&file, volume, time).world;
            World::new(world.instances()[..1].to_vec())
        };
        let still = alone(place, "frame = 1");
        for (unit, fps, scale, factor) in
            [("second", 24.0, 1.0, 1.0), ("frame", 30.0, -0.02, -0.02 * 30.0)]
        {
            let keys = field.keys;
            let velocity = format!("velocity = {{ {keys}, unit = '{unit}', scale = {scale} }}");
            let moving =
                alone(&format!("{place}\n{velocity}"), &format!("fps = {fps}\nshutter = 1"));
            let (mut met, mut farthest) = (0, 0.0_f64);
            let mut rng = PathRng::new(0, UVec2::ZERO, 0);
            for _ in 0..4000 {
                let mut random = || f64::from(rng.uniform()) - 0.5;
                let in_file = DVec3::new(random(), random(), random()) * 2.2;
                let time = random() / fps;
                let world = world_from_file.transform_point3(in_file);
                let way = factor * time * world_from_file.transform_vector3((field.at)(in_file));
                let expected = medium_at(&still, (world - way).as_vec3a(), 0.0);
                let found = medium_at(&moving, world.as_vec3a(), time as f32);
                let apart = [
                    (found.mu_t - expected.mu_t).abs().max_element(),
                    (found.mu_s - expected.mu_s).abs().max_element(),
                    (found.emission - expected.emission).abs().max_element() / 20.0,
                ];
                assert!(
                    apart.iter().all(|apart| *apart < 2e-3),
                    "{}, {unit}, {in_file} at {time}: {found:?} for {expected:?}",
                    field.name
                );
                met += u32::from(found.mu_t.x > 0.1);
                farthest = farthest.max(way.length());
            }
            assert!(met > 200 && farthest > 0.15, "{}: {met} points, {farthest}", field.name);
        }
    }
}

fn uniform_file(components: [f32; 3]) -> File {
    let mut grids = smoke_and_flame();
    grids.push(Grid { kind: "vec3s", components, ..Grid::fog("vel", cube(12, |_| 1.0)) });
    File::of(&grids)
}

const MOVING: &str = "velocity = { grid = 'vel' }";

/// Keeps the times of all rays.
#[derive(Default)]
struct Times(Vec<f32>);

impl Observer for Times {
    fn step(&mut self, step: PathStep) {
        match step {
            PathStep::Ray { ray, .. } => self.0.push(ray.time),
            PathStep::Vertex { vertex, .. } => self.0.push(vertex.time),
            _ => {}
        }
    }
}

fn samples(frame: &PreparedFrame) -> Vec<[f32; 3]> {
    let pixels = (0..256).map(|i| UVec2::new(i % 16, i / 16));
    let of_pixel = |pixel| (0..8).map(move |s| frame.sample(pixel, s).beauty().to_array());
    pixels.flat_map(of_pixel).collect()
}

/// Bit for bit the same path by path, for every strategy.
#[test]
fn without_a_shutter_the_picture_is_the_still() {
    let file = uniform_file([12.0, 4.0, -8.0]);
    let mut strategies = strategies();
    strategies.push(Strategy { integrator: Integrator::March, ..Strategy::default() });
    for strategy in strategies {
        let of = |volume: &str, time: &str| {
            let scene = with_strategy(&scene_of(&file, volume, time), strategy);
            samples(&frame_of(scene, UVec2::splat(16), 3))
        };
        let still = of("", "frame = 2\nshutter = 0.5");
        assert_eq!(still, of(MOVING, "frame = 2"), "{}", full_name(&strategy));
        assert_ne!(still, of(MOVING, "frame = 2\nshutter = 0.5"), "{}", full_name(&strategy));
    }
}

/// All of a path is at one time, which is uniform over the shutter and the same whenever the path
/// is walked again.
#[test]
fn every_path_has_a_time_of_its_own() {
    const BINS: usize = 16;
    let file = uniform_file([12.0, 4.0, -8.0]);
    for low_discrepancy in [false, true] {
        let advanced = Advanced { low_discrepancy, ..Advanced::default() };
        let strategy = Strategy { advanced, ..Strategy::default() };
        let build = || {
            let scene = scene_of(&file, MOVING, "frame = 2.25\nshutter = 0.5\nfps = 20");
            frame_of(with_strategy(&scene, strategy), UVec2::splat(16), 3)
        };
        let (frame, again) = (build(), build());
        let mut counts = [0.0; BINS];
        for i in 0..256 {
            let pixel = UVec2::new(i % 16, i / 16);
            for s in 0..8 {
                let mut times = Times::default();
                let sample = frame.trace(pixel, s, &mut times);
                assert_eq!(sample, again.sample(pixel, s));
                let first = times.0[0];
                assert!(times.0.iter().all(|time| *time == first), "{:?}", times.0);
                assert!((-0.0125..0.0125).contains(&first), "{first}");
                counts[((first / 0.025 + 0.5) * BINS as f32) as usize] += 1.0;
            }
        }
        let chi_square: f64 = counts.iter().map(|n| (n - 128.0_f64).powi(2) / 128.0).sum();
        // Fifteen degrees of freedom; 1e-5 of all lie above.
        assert!(chi_square < 51.0, "{chi_square}: {counts:?}");
    }
}

/// Mean tracking steps of a path.
fn steps(scene: &Scene) -> f64 {
    let scene = with_strategy(scene, Preset::Baseline.strategy());
    let frame = frame_of(scene, UVec2::splat(32), 0);
    let sum: u64 = (0..1024)
        .flat_map(|i| (0..16).map(move |s| (UVec2::new(i % 32, i / 32), s)))
        .map(|(pixel, s)| u64::from(frame.sample(pixel, s).tracking_steps))
        .sum();
    sum as f64 / (1024.0 * 16.0)
}

/// Thin smoke with a dense core: one voxel of absurd velocity could bring the core anywhere in its
/// own cells alone, and costs next to nothing in all.
#[test]
fn an_outlier_costs_in_its_own_cells() {
    let mut smoke = ball(IVec3::ZERO, 14, 0.05);
    for (voxel, value) in &mut smoke {
        if (*voxel - IVec3::new(6, 0, 0)).length_squared() < 6 {
            *value = 4.0;
        }
    }
    let scene = |outlier: f32, time: &str| {
        let velocity = cube(18, |voxel| match voxel {
            IVec3 { x: -5, y: 2, z: 3 } => outlier,
            _ => 1.0,
        });
        let file = File::of(&[
            Grid::fog("density", smoke.clone()),
            Grid { kind: "vec3s", components: [4.0, 0.0, 3.0], ..Grid::fog("vel", velocity) },
        ]);
        build(&format!(
            "camera = {{ position = [0, -5, 0], fov_x = 36 }}\nenvironment.radiance = 1.0
            [time]\n{time}\n[[volume]]\nfile = '{}'\n{MOVING}\ndensity = {{ scale = 5.0 }}
            albedo = 0.5",
            file.name
        ))
    };
    let [still, moving] = ["shutter = 0", "shutter = 1"].map(|time| steps(&scene(1.0, time)));
    let outlier = steps(&scene(1e7, "shutter = 1"));
    println!("steps: {still:.3} still, {moving:.3} in motion, {outlier:.3} with an outlier");
    assert!(outlier < 1.1 * moving, "{outlier} for {moving}");
}

/// Frames see a moving world for as long as the shutter is open; a fraction of a frame is a moment.
#[test]
fn the_world_tells_how_long_it_is_seen() {
    let file = uniform_file([1.0, 0.0, 0.0]);
    let world = |volume: &str, time: &str| scene_of(&file, volume, time).world;
    let motion = |world: &World| world.instances()[0].volume().motion().map(|m| m.shutter());
    for still in [world(MOVING, "frame = 4"), world("", "frame = 4.2\nshutter = 0.5")] {
        assert_eq!((still.open_seconds(), motion(&still)), (0.0, None));
    }
    let moving = world(MOVING, "frame = 4\nshutter = 0.5\nfps = 25");
    assert_eq!(moving.open_seconds(), 0.02);
    assert_eq!(motion(&moving), Some(Shutter { frame: 0.0, open: 0.02 }));
    let moment = world(MOVING, "frame = 3.75\nfps = 25");
    assert_eq!(moment.open_seconds(), 0.0);
    assert_eq!(motion(&moment), Some(Shutter { frame: -0.01, open: 0.0 }));
}

/// An albedo of a grid moves with the density, whichever way it is read.
#[test]
fn the_albedo_moves_with_the_smoke() {
    let mut albedo = ball(IVec3::ZERO, 6, 1.0);
    albedo.iter_mut().for_each(|(voxel, value)| *value = rough(*voxel));
    let components = [12.0, 4.0, -8.0];
    let file = File::of(&[
        Grid::fog("density", ball(IVec3::ZERO, 6, 1.0)),
        Grid::fog("albedo", albedo),
        Grid { kind: "vec3s", components, ..Grid::fog("vel", cube(12, |_| 1.0)) },
    ]);
    let scene = build(&format!(
        "time.shutter = 1\n[[volume]]\nfile = '{}'\n{MOVING}\nalbedo = {{ grid = 'albedo' }}",
        file.name
    ));
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    let mut seen = 0;
    for _ in 0..1000 {
        let mut random = || rng.uniform() - 0.5;
        let (point, time) = (Vec3A::new(random(), random(), random()), random() / 24.0);
        let mut medium = scene.world.along(Ray::new(point, Vec3A::X).at_time(time), 1e-4);
        let Some(segment) = medium.next_segment() else { continue };
        let Coefficients { mu_t, mu_s, .. } = medium.coefficients(segment.t0);
        if mu_t.x > 0.0 {
            let (albedo, _) = medium.scattering(segment.t0);
            assert!((albedo - mu_s / mu_t).abs().max_element() < 1e-4, "{point} at {time}");
            seen += 1;
        }
    }
    assert!(seen > 500, "{seen}");
}
