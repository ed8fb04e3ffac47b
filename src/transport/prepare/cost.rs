//! Cost of a path, counted instead of timed, so that decisions based on it are the same on any
//! machine and at any time.

use glam::Vec3A;

use crate::light::LightGroup;
use crate::math::Ray;
use crate::surface;
use crate::transport::observer::{Observer, PathStep};
use crate::transport::sample::PathSample;
use crate::transport::scene::Scene;

/// Cost of a ray beside its walks, in tracking steps. All costs were measured on the
/// scenes of the noise benchmark, by the time that a path takes with more and less of each: good to
/// a factor of 1.5.
const RAY_COST: f64 = 6.0;
/// Cost of a vertex beside its light samples.
const VERTEX_COST: f64 = 4.0;
/// Cost of a segment of the medium that a walk crosses for the transmittance alone.
const SEGMENT_COST: f64 = 1.0;
/// Cost of a segment of the medium that an emission walk crosses.
const EMISSION_SEGMENT_COST: f64 = 1.8;
/// Cost of a light sample beside its walk.
const SAMPLE_COST: f64 = 10.0;
/// Cost of a level of the light tree, for the choice of a light and its probability.
const LEVEL_COST: f64 = 6.0;

/// Counts what a path costs.
#[derive(Debug)]
pub(in crate::transport) struct Cost<'s> {
    scene: &'s Scene,
    /// The present ray, and its length.
    ray: (Ray, f32),
    /// Segments along the present ray, once they have been counted.
    segments: Option<f64>,
    /// Origin of shadow rays.
    vertex: Vec3A,
    /// Levels of the light trees of fires and of other lights.
    levels: [f64; 2],
    /// Cost of all steps of the path, without tracking steps.
    total: f64,
    /// Cost of the last step, with its tracking steps.
    last: f64,
}

impl<'s> Cost<'s> {
    pub(in crate::transport) fn new(scene: &'s Scene) -> Self {
        let ray = (Ray::new(Vec3A::ZERO, Vec3A::X), 0.0);
        let levels = [LightGroup::Fires, LightGroup::Lamps]
            .map(|group| (scene.lights.len(group).max(1) as f64).log2());
        Self { scene, ray, segments: None, vertex: Vec3A::ZERO, levels, total: 0.0, last: 0.0 }
    }

    /// Cost of the path of `sample`, in tracking steps.
    pub(in crate::transport) fn of(&self, sample: &PathSample) -> f64 {
        f64::from(sample.tracking_steps) + self.total
    }

    /// Cost of the last step alone, its tracking steps included.
    pub(in crate::transport) fn of_last_step(&self) -> f64 {
        self.last
    }

    fn add(&mut self, cost: f64, collisions: u32) {
        self.total += cost;
        self.last = cost + f64::from(collisions);
    }

    /// Segments along the present ray.
    fn segments_of_ray(&mut self) -> f64 {
        let (ray, t_max) = self.ray;
        let scene = self.scene;
        *self.segments.get_or_insert_with(|| segments(scene, &ray, t_max))
    }

    /// Segments along a shadow ray from the last vertex.
    fn segments_of_shadow_ray(&self, (direction, length): (Vec3A, f32)) -> f64 {
        let ray = Ray::new(self.vertex, direction);
        let end = surface::intersect(&self.scene.surfaces, &ray);
        let t_max = end.map_or(f32::INFINITY, |end| end.hit.t);
        segments(self.scene, &ray, t_max.min(length))
    }
}

/// Segments of the medium along a ray.
fn segments(scene: &Scene, ray: &Ray, t_max: f32) -> f64 {
    let mut medium = scene.world.along(*ray, t_max);
    let mut count = 0;
    while medium.next_segment().is_some() {
        count += 1;
    }
    f64::from(count)
}

impl Observer for Cost<'_> {
    fn step(&mut self, step: PathStep) {
        match step {
            PathStep::Ray { ray, t_max, .. } => {
                (self.ray, self.segments) = ((*ray, t_max), None);
                self.add(RAY_COST, 0);
            }
            PathStep::Vertex { vertex, .. } => {
                self.vertex = vertex.receiver().position;
                self.add(VERTEX_COST, 0);
            }
            PathStep::Emission { technique, .. } => {
                let segments = self.segments_of_ray();
                self.add(EMISSION_SEGMENT_COST * segments, technique.collisions);
            }
            PathStep::End { own_walk: Some(collisions), .. } => {
                let segments = self.segments_of_ray();
                self.add(SEGMENT_COST * segments, collisions);
            }
            PathStep::Light { technique, fires, shadow_ray, .. } => {
                let segments = shadow_ray.map_or(0.0, |ray| self.segments_of_shadow_ray(ray));
                let [levels, of_segment] = match fires {
                    true => [self.levels[0], EMISSION_SEGMENT_COST],
                    false => [self.levels[1], SEGMENT_COST],
                };
                let cost = SAMPLE_COST + LEVEL_COST * levels + of_segment * segments;
                self.add(cost, technique.collisions);
            }
            PathStep::End { .. } | PathStep::Absorbed { .. } => self.last = 0.0,
        }
    }
}
