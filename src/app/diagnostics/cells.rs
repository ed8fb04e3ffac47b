//! The strongest cells of a scene's volumes, gathered off the window's thread.

use std::sync::Arc;

use glam::Vec3A;

use crate::app::jobs::background::{Background, BackgroundPool};
use crate::image::ramp::Scale;
use crate::math::Aabb;
use crate::transport::Scene;
use crate::transport::probes::Probes;
use crate::volume::world::Instance;
use crate::volume::{CoefficientBounds, Region};

/// The most cells that are drawn.
pub const MOST: usize = 4000;

/// The value that the cells drawn over the picture are colored by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellValue {
    /// The local majorant: the largest extinction in the cell, 1/length.
    Majorant,
    /// The power the cell emits, radiance × length².
    Energy,
    /// The light scattered towards the camera as each probe estimates it, radiance/length.
    Probes,
}

/// A cell in the world.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Corners of the cell, numbered by the bits x, y, z.
    pub corners: [Vec3A; 8],
    /// Edge of the cube of the cell's volume.
    pub edge: f32,
    /// Value that the cell is colored by.
    pub value: f32,
}

impl Cell {
    fn new(candidate: &Candidate<'_>) -> Self {
        let Candidate { instance, local, value } = *candidate;
        let (mut corners, mut volume) =
            (local.corners(), f64::from(local.size().element_product()));
        if let Some(instance) = instance {
            corners = corners.map(|corner| instance.world_from_local().transform_point3a(corner));
            volume *= instance.world_volume();
        }
        Self { corners, edge: volume.cbrt() as f32, value }
    }

    /// Middle of the cell.
    pub fn center(&self) -> Vec3A {
        0.5 * (self.corners[0] + self.corners[7])
    }
}

/// The cells of a scene that have a value, as far as they are drawn.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// The strongest cells, in ascending order.
    pub strongest: Vec<Cell>,
    /// Number of cells that have a value.
    pub total: usize,
}

impl Cells {
    /// Gathers the cells of `instances`. Volumes without borders have none.
    pub fn gather(instances: &[Instance], value: CellValue) -> Self {
        let mut sieve = Sieve::default();
        for instance in instances {
            visit(instance, value, |local, value| sieve.push(Some(instance), local, value));
        }
        Self::sifted(sieve)
    }

    /// The probes by their scores towards an eye.
    fn of_probes(probes: &Probes, eye: Vec3A) -> Self {
        let mut sieve = Sieve::default();
        probes.for_each(|probe| {
            let direction = (probe.bounds.center() - eye).normalize_or(Vec3A::X);
            sieve.push(None, &probe.bounds, probe.score(direction));
        });
        Self::sifted(sieve)
    }

    fn sifted(mut sieve: Sieve<'_>) -> Self {
        let strongest = sieve.finish().iter().map(Cell::new).collect();
        Self { strongest, total: sieve.total }
    }

    /// Scale from the weakest to the strongest cell; `None` without cells.
    pub fn scale(&self) -> Option<Scale> {
        let (first, last) = (self.strongest.first()?, self.strongest.last()?);
        Some(Scale::exact([first.value, last.value]))
    }
}

/// Calls `found` with every cell of a volume in its own space, and its value in the world.
fn visit(instance: &Instance, value: CellValue, mut found: impl FnMut(&Aabb, f32)) {
    let volume = instance.volume();
    match (value, volume.bounds()) {
        (CellValue::Majorant, CoefficientBounds::Cells(grid)) => {
            grid.for_each_cell(|_, cell, majorant| found(cell, majorant.mu_t));
        }
        (CellValue::Majorant, CoefficientBounds::Uniform(_, majorant)) => {
            if *volume.region() != Region::Everywhere {
                found(&volume.region().bounds(), majorant.mu_t);
            }
        }
        (CellValue::Probes, _) => {}
        (CellValue::Energy, _) => {
            if let Some(energy) = volume.energy() {
                energy.for_each_cell(|cell, power| {
                    found(cell, (f64::from(power) * instance.world_volume()) as f32);
                });
            }
        }
    }
}

/// Keeps the largest [`MOST`] of any number of candidates.
#[derive(Default)]
struct Sieve<'a> {
    kept: Vec<Candidate<'a>>,
    /// The value that a candidate must exceed once there are enough.
    threshold: f32,
    total: usize,
}

struct Candidate<'a> {
    /// The instance in whose space the cell is given; the world's if `None`.
    instance: Option<&'a Instance>,
    local: Aabb,
    value: f32,
}

impl<'a> Sieve<'a> {
    fn push(&mut self, instance: Option<&'a Instance>, local: &Aabb, value: f32) {
        if !(value > 0.0 && value.is_finite()) {
            return;
        }
        self.total += 1;
        if value > self.threshold {
            self.kept.push(Candidate { instance, local: *local, value });
            if self.kept.len() >= 2 * MOST {
                self.prune();
            }
        }
    }

    fn prune(&mut self) {
        if self.kept.len() > MOST {
            let (_, last, _) =
                self.kept.select_nth_unstable_by(MOST - 1, |a, b| b.value.total_cmp(&a.value));
            self.threshold = last.value;
            self.kept.truncate(MOST);
        }
    }

    /// The largest, in ascending order.
    fn finish(&mut self) -> &[Candidate<'a>] {
        self.prune();
        self.kept.sort_unstable_by(|a, b| a.value.total_cmp(&b.value));
        &self.kept
    }
}

/// Gathers cells off the window's thread.
pub struct Gathering(Background<CellSource, Cells>);

/// The source that cells are gathered from.
#[derive(Clone)]
pub struct CellSource {
    /// The value that they are colored by.
    pub value: CellValue,
    /// Has the volumes and the camera.
    pub scene: Arc<Scene>,
    /// The probes of the scene, where they are wanted and there.
    pub probes: Option<Arc<Probes>>,
}

impl CellSource {
    fn gather(&self) -> Cells {
        match self.value {
            CellValue::Probes => match &self.probes {
                Some(probes) => Cells::of_probes(probes, self.scene.camera.position()),
                None => Cells::default(),
            },
            value => Cells::gather(self.scene.world.instances(), value),
        }
    }

    /// Whether both have the same cells: the same volumes in the same places, which a scene has
    /// that only the camera or the strategy changed; or the same probes, seen from the same place.
    fn has_cells_of(&self, other: &Self) -> bool {
        self.value == other.value
            && match self.value {
                CellValue::Probes => {
                    self.probes.as_ref().map(Arc::as_ptr) == other.probes.as_ref().map(Arc::as_ptr)
                        && self.scene.camera.position() == other.scene.camera.position()
                }
                _ => self.scene.world.has_volumes_of(&other.scene.world),
            }
    }
}

impl Gathering {
    /// No cells yet; `pool` will gather them.
    pub fn new(pool: &BackgroundPool) -> Self {
        Self(Background::new(pool))
    }

    /// Brings the cells in line with what is wanted; `wake` is called when they are there.
    pub fn update(&mut self, wanted: Option<CellSource>, wake: impl FnOnce() + Send + 'static) {
        self.0.update(wanted, CellSource::has_cells_of, CellSource::gather, wake);
    }

    /// The cells gathered last, if they are of the value wanted.
    pub fn cells(&self, wanted: Option<CellValue>) -> Option<(CellValue, &Cells)> {
        let (source, cells) = self.0.done()?;
        (wanted == Some(source.value)).then_some((source.value, cells))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::error::NO_PROGRESS;
    use crate::scene::{Overrides, Settings, VolumeCache, assemble, parse};
    use crate::transport::prepare::SceneProbes;

    fn settings() -> Settings {
        parse(TWO, "", Path::new(""), &Overrides::default()).unwrap()
    }

    fn scene() -> Scene {
        assemble(&settings(), &VolumeCache::default(), NO_PROGRESS).unwrap()
    }

    const TWO: &str = r#"
[[volume]]
shape = "noise"
half_size = 2.0
density = { scale = 3.0 }
emission = { mode = "source", le = 2.0 }
rotate = [0, 0, 30]
scale = [1, 2, 1]
translate = [5, 0, 0]

[[volume]]
shape = "box"
half_size = 0.5
density = { scale = 7.0 }
emission = { mode = "constant", value = 3.0 }

[[volume]]
shape = "everywhere"
density = { scale = 0.1 }
"#;

    #[test]
    fn cells_lie_where_their_volume_is_placed() {
        let scene = scene();
        let cells = Cells::gather(scene.world.instances(), CellValue::Majorant);
        let uniform: Vec<_> = cells.strongest.iter().filter(|cell| cell.value > 6.9).collect();
        let [uniform] = uniform.as_slice() else { panic!("{} uniform cells", uniform.len()) };
        assert!(uniform.center().length() < 1e-6 && (uniform.edge - 1.0).abs() < 1e-6);
        let bounds = scene.world.instances()[0].bounds();
        let noise = cells.strongest.iter().filter(|cell| cell.value < 6.9);
        let mut count = 0;
        for cell in noise {
            let center = cell.center();
            assert!(center.cmpge(bounds.min).all() && center.cmple(bounds.max).all(), "{center}");
            count += 1;
        }
        assert!(count > 100, "{count} cells of noise");
        assert!(cells.strongest.is_sorted_by(|a, b| a.value <= b.value));
    }

    /// The box: ε V = 3. The noise is placed with twice its own volume.
    #[test]
    fn powers_sum_to_those_of_the_volumes() {
        let scene = scene();
        for (instance, scale) in std::iter::zip(scene.world.instances(), [2.0, 1.0]) {
            let mut sum = 0.0;
            visit(instance, CellValue::Energy, |_, value| sum += f64::from(value));
            let power = scale * f64::from(instance.volume().energy().unwrap().power());
            assert!((sum / power - 1.0).abs() < 1e-4, "{sum} in cells, {power} in all");
        }
        let cells = Cells::gather(&scene.world.instances()[1..], CellValue::Energy);
        let values: Vec<f32> = cells.strongest.iter().map(|cell| cell.value).collect();
        assert!(matches!(values[..], [value] if (value - 3.0).abs() < 1e-5), "{values:?}");
    }

    #[test]
    fn only_the_strongest_of_many_are_kept_and_all_are_counted() {
        let scene = scene();
        let instance = Some(&scene.world.instances()[1]);
        let mut sieve = Sieve::default();
        let unit = Aabb::centered(Vec3A::ONE);
        let count = 5 * MOST;
        for i in 0..count {
            // Every value from 1 to `count` once, in no order.
            let value = (i * 7919) % count + 1;
            sieve.push(instance, &unit, value as f32);
        }
        for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            sieve.push(instance, &unit, bad);
        }
        let kept: Vec<f32> = sieve.finish().iter().map(|candidate| candidate.value).collect();
        let expected: Vec<f32> = (count - MOST + 1..=count).map(|value| value as f32).collect();
        assert_eq!(kept, expected);
        assert_eq!(sieve.total, count);
    }

    #[test]
    fn a_moved_camera_keeps_the_cells_and_a_moved_volume_does_not() {
        let mut settings = settings();
        let cache = VolumeCache::default();
        let mut source = || {
            let scene = assemble(&settings, &cache, NO_PROGRESS).unwrap();
            let source =
                CellSource { value: CellValue::Majorant, scene: Arc::new(scene), probes: None };
            settings.camera.position[0] += 1.0;
            source
        };
        let (first, second) = (source(), source());
        assert!(first.has_cells_of(&second));
        settings.volume[0].translate[2] = 1.0;
        let scene = Arc::new(assemble(&settings, &cache, NO_PROGRESS).unwrap());
        assert!(!first.has_cells_of(&CellSource { scene, ..second }));
    }

    /// The probes tile their cube, and score what they scatter towards the eye.
    #[test]
    fn probes_lie_in_their_cube_and_follow_the_eye() {
        let mut settings = settings();
        for volume in &mut settings.volume {
            volume.albedo = crate::scene::settings::Albedo::Gray(0.5);
        }
        let scene = assemble(&settings, &VolumeCache::default(), NO_PROGRESS).unwrap();
        let probes =
            SceneProbes::placed(&scene, NO_PROGRESS).unwrap().map(|probes| probes.coarse().clone());
        let scene = Arc::new(scene);
        let source = CellSource { value: CellValue::Probes, scene, probes };
        let mut volume = 0.0;
        let mut count = 0;
        source.probes.as_ref().unwrap().for_each(|probe| {
            volume += f64::from(probe.bounds.size().element_product());
            count += 1;
        });
        let fog_around = 1e3;
        assert!(volume > fog_around && count > 100, "{count} probes fill {volume}");
        let cells = source.gather();
        assert!(cells.total > 100 && cells.total <= count, "{} of {count}", cells.total);
        let mut moved = (*source.scene).clone();
        moved.camera = crate::transport::camera::Camera::look_at(
            Vec3A::new(9.0, 1.0, 2.0),
            Vec3A::ZERO,
            Vec3A::Z,
            40.0,
        )
        .unwrap();
        let moved = CellSource { scene: Arc::new(moved), ..source.clone() };
        assert!(!source.has_cells_of(&moved) && source.has_cells_of(&source.clone()));
        assert!(!source.has_cells_of(&CellSource { probes: None, ..source.clone() }));
    }
}
