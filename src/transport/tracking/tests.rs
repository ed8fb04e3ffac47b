//! Densities of flights, by null-collision sampling and filled, against their definition.

use std::sync::Arc;

use glam::{Affine3A, UVec2, Vec3A};

use super::event::{EmissionGathering, Event};
use super::fill::fill;
use super::majorant::EmissionMajorant;
use super::scattering::{Scattering, scatter};
use super::*;
use crate::error::NO_PROGRESS;
use crate::math::{Aabb, Ray, mean};
use crate::transport::strategy::{Preset, Strategy};
use crate::volume::emission::Emission;
use crate::volume::field::{RgbField, ScalarField};
use crate::volume::phase::Phase;
use crate::volume::procedural::Noise;
use crate::volume::world::{Instance, World};
use crate::volume::{MediumProperties, Region, Volume};

/// Recorder of every tentative collision of a walk with another's random numbers, and of the
/// coefficients there.
struct Recorder {
    /// None where the walk gathers no emission.
    majorant: Option<EmissionMajorant>,
    until: f32,
    /// Whether the walk drew a number at each collision.
    draws: bool,
    /// Ray parameter of the other walk's event.
    event: f32,
    collisions: Vec<(f32, f32)>,
}

impl Walk for Recorder {
    fn until(&self) -> f32 {
        self.until
    }
    fn rate(&mut self, _: &MediumRay, segment: &Segment) -> f32 {
        self.majorant.map_or(segment.majorant, |majorant| majorant.rate(segment))
    }
    fn cross(&mut self, _: &MediumRay, _: &Segment, _: &mut PathRng) -> bool {
        false
    }
    fn collide(&mut self, _: &MediumRay, at: &Collision, rng: &mut PathRng) -> ControlFlow<()> {
        self.collisions.push((at.t, at.rate));
        if self.draws {
            rng.uniform();
        }
        if at.t == self.event { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn arrive(&mut self, _: &MediumRay, at: &Collision) {
        self.collisions.push((at.t, at.rate));
    }
}

/// Smoke with holes, as a world.
fn smoke(density: Rgb, albedo: Rgb, emission: Emission) -> World {
    let properties = MediumProperties {
        density: ScalarField::Noise(Noise { frequency: 2.0, octaves: 3, contrast: 2.0, seed: 0 }),
        density_scale: density,
        albedo: RgbField::Constant(albedo),
        phase: Phase::of(0.5),
        emission,
    };
    let (bounds, cells) = (Aabb::centered(Vec3A::ONE), Vec3A::splat(0.25));
    let volume = Volume::varying(bounds, properties, cells, None, NO_PROGRESS).unwrap();
    World::new(vec![Instance::new(Arc::new(volume), Affine3A::IDENTITY)])
}

/// Number of paths with an event, by null-collision sampling and filled, whose density was checked.
fn check_densities(world: &World, strategy: &Strategy, throughput: Rgb) -> [u32; 2] {
    let gather = EmissionGathering::of(strategy);
    let boosted = gather == EmissionGathering::EveryCollision;
    let mut checked = [0, 0];
    for i in 0..2000 {
        let mut rng = PathRng::new(i, UVec2::ZERO, 0);
        let target = 0.6 * Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
        let origin = Vec3A::new(-3.0, 0.2, 0.1);
        let ray = Ray::new(origin, (target - origin).normalize());
        let along = || world.along(ray, f32::INFINITY);
        let filled = i % 2 == 1;
        let until = if filled { 2.0 + 2.0 * rng.uniform() } else { f32::INFINITY };
        let mut again = rng.clone();
        let flight = if filled {
            fill(along(), strategy, throughput, until, &mut rng)
        } else {
            let first = rng.exponential();
            scatter(along(), strategy, throughput, first, &mut rng)
        };
        let Event::Scattered { t, .. } = flight.event else { continue };
        let majorant = boosted.then(|| EmissionMajorant::of(strategy));
        let mut recorder =
            Recorder { majorant, until, draws: !filled, event: t, collisions: vec![] };
        let first = again.exponential();
        track(along(), first, &mut again, &mut recorder);
        let matter = |t: f32| {
            let at = world.matter_at(ray.at(t));
            at.map_or([Rgb::ZERO; 2], |m| [m.mu_t, m.mu_s])
        };
        let (last, before) = recorder.collisions.split_last().unwrap();
        assert_eq!(last.0, t);
        let nulls = before.iter().fold(Rgb::ONE, |p, &(t, rate)| p * (1.0 - matter(t)[0] / rate));
        let [mu_t, mu_s] = matter(t);
        let drawn = if gather == EmissionGathering::Absorption { mu_s } else { mu_t };
        let density = mean(throughput * nulls * drawn) / mean(throughput);
        let error = (flight.pdf_null - density).abs();
        assert!(error < 3e-3 * density + 1e-6, "{t}: {density}, said {}", flight.pdf_null);
        let weight = nulls * mu_s / density;
        let error = (flight.weight - weight).abs().max_element();
        assert!(error < 1e-2 * weight.max_element() || density < 1e-5, "{t}: {weight}");
        checked[usize::from(filled)] += 1;
    }
    checked
}

/// The density that a walk returns, by null-collision sampling or filled, is the product along it,
/// evaluated directly: per channel Π (μ_n/μ̄) · μ, and over the channels its mean by the color of
/// the path. For gray and colored smoke, whatever gathers emission, for thousands of paths.
#[test]
fn the_density_of_a_path_is_the_product_along_it() {
    let full = Preset::Full.strategy();
    let decoupled = Strategy { emission_ratio_tracking: false, ..full };
    let unboosted = Strategy { majorant_boost: false, ..decoupled };
    let baseline = Preset::Baseline.strategy();
    let gathered = || Emission::Source { le: Rgb::new(2.0, 1.0, 0.5) };
    let none = || Emission::None;
    let mut checked = [0, 0];
    for density in [1.0, 4.0, 16.0] {
        for color in [Rgb::ONE, Rgb::new(1.0, 0.5, 0.1)] {
            let smoke = |emission| smoke(density * color, 0.8 * color.powf(0.5), emission);
            for (strategy, emission) in [
                (full, none()),
                (full, gathered()),
                (decoupled, gathered()),
                (unboosted, gathered()),
                (baseline, none()),
            ] {
                let world = smoke(emission);
                for throughput in [Rgb::ONE, Rgb::new(0.1, 0.5, 2.0)] {
                    let found = check_densities(&world, &strategy, throughput);
                    (0..2).for_each(|i| checked[i] += found[i]);
                }
            }
        }
    }
    assert!(checked[0] > 20_000 && checked[1] > 20_000, "{checked:?}");
}

/// A draw of zero distance collides in however thin a medium.
#[test]
fn a_collision_of_vanishing_rate_leaves_the_weight_alone() {
    let gathered =
        Emission::Field { field: RgbField::Constant(Rgb::ONE), scale: Rgb::splat(1e-30) };
    let properties = MediumProperties {
        density: ScalarField::Constant(0.0),
        density_scale: Rgb::ONE,
        albedo: RgbField::Constant(Rgb::ZERO),
        phase: Phase::default(),
        emission: gathered,
    };
    let region = Region::Box(Aabb::centered(Vec3A::ONE));
    let volume = Arc::new(Volume::uniform(region, properties));
    let world = World::new(vec![Instance::new(volume, Affine3A::IDENTITY)]);
    let mut medium = world.along(Ray::new(-3.0 * Vec3A::X, Vec3A::X), f32::INFINITY);
    let segment = medium.next_segment().unwrap();
    let strategy = Strategy { emission_decoupling: true, ..Preset::Baseline.strategy() };
    let mut walk = Scattering::new(&strategy, Rgb::ONE);
    let at = Collision { t: 3.0, rate: 1e-30, segment: &segment };
    let goes_on = walk.collide(&medium, &at, &mut PathRng::new(0, UVec2::ZERO, 0));
    assert!(goes_on.is_continue());
    assert_eq!((walk.state.weight, walk.emission), (Rgb::ONE, Rgb::ONE));
}
