//! Light along the rays of a path: volume emission, and the surface or environment at their ends.

use super::current::Path;
use super::state::State;
use crate::math::{PathRng, Rgb, Slot};
use crate::surface::Intersection;
use crate::transport::direct;
use crate::transport::emission;
use crate::transport::emission::ray::{RayEmission, RayKind};
use crate::transport::learned_counts;
use crate::transport::observer::{Observer, PathStep, Technique};
use crate::volume::world::MediumRay;

/// Light at the end of a ray: of the surface there or of the environment.
pub(super) struct LightAtEnd {
    /// Radiance, MIS-weighted against light samples, without the medium in front of it.
    pub(super) radiance: Rgb,
    /// Share, 0 to 1, that is gathered through the transmittance of the ray; the rest is gathered
    /// where the path arrives.
    pub(super) by_transmittance: f32,
}

impl LightAtEnd {
    /// Whether any of it is gathered through the transmittance of the ray.
    pub(super) fn shines_through(&self) -> bool {
        self.by_transmittance > 0.0 && self.radiance != Rgb::ZERO
    }

    /// Whether any of it is gathered where the path arrives.
    pub(super) fn arrives(&self) -> bool {
        self.by_transmittance < 1.0 && self.radiance != Rgb::ZERO
    }
}

impl Path<'_> {
    /// Marches along the present ray and fills its table of steps.
    pub(super) fn march(&mut self, medium: MediumRay, rng: &mut PathRng) -> RayEmission {
        let voxels = self.scene.strategy.advanced.march_step;
        let marched = self.table.fill(medium, voxels, self.state.throughput, rng);
        self.contributions.count(marched.collisions);
        marched
    }

    /// The light at the end of the present ray, and the share of it that its transmittance gathers.
    pub(super) fn light_at_end(&self, end: Option<&Intersection>) -> LightAtEnd {
        let State { ray, prev_vertex, .. } = &self.state;
        let radiance = direct::at_the_end(self.scene, ray, end, prev_vertex.as_ref());
        let by_transmittance = match self.scene.strategy.marches() {
            true => 1.0,
            false => self.context.counts.by_transmittance(self.state.class(), ray.origin),
        };
        LightAtEnd { radiance, by_transmittance }
    }

    /// Whether the scattering walk gathers emission, or light at its end.
    pub(super) fn flight_gathers(&self, at_end: &LightAtEnd) -> bool {
        !self.scene.strategy.gathers_whole_rays() || at_end.arrives()
    }

    /// Gathers the emission of the whole ray, by the emission walk if it was not `marched`, and the
    /// share of the light at its end that its transmittance T gathers. Returns T, if it was
    /// estimated.
    pub(super) fn gather_whole_ray(
        &mut self,
        medium: MediumRay,
        marched: Option<RayEmission>,
        at_end: &LightAtEnd,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Option<Rgb> {
        let is_camera_ray = self.state.scatters == 0;
        let walks = self.scene.strategy.gathers_whole_rays();
        let expected = self.state.prev_vertex.as_ref().map_or(1.0, |prev| prev.fires.rays);
        let emission = walks && self.scene.world.emits();
        let (transmittance, own_walk) = match marched {
            Some(marched) => (self.take_emission(&marched, observer), None),
            None if emission && learned_counts::draw(expected, Slot::WalkCount, rng) > 0 => {
                let kind = if is_camera_ray { RayKind::Camera } else { RayKind::Scattered };
                let gathered = self.context.emission_estimator.gather(medium, kind, rng);
                self.contributions.count(gathered.collisions);
                (self.take_emission(&gathered, observer), None)
            }
            // Coverage is smooth wherever emission has a walk of its own, and without fire.
            None if at_end.shines_through() || (is_camera_ray && walks) => {
                let is_seen = is_camera_ray && at_end.shines_through();
                let kind = if is_seen { RayKind::Camera } else { RayKind::Scattered };
                let (transmittance, collisions) = emission::transmittance(medium, kind, rng);
                self.contributions.count(collisions);
                (transmittance, Some(collisions))
            }
            None => return None,
        };
        if at_end.shines_through() {
            let radiance = transmittance * (at_end.by_transmittance * at_end.radiance);
            self.add_end(self.state.throughput * radiance, true, own_walk, observer);
        }
        Some(transmittance)
    }

    /// Adds the emission that a walk along the ray gathered; returns its transmittance.
    pub(super) fn take_emission(
        &mut self,
        gathered: &RayEmission,
        observer: &mut impl Observer,
    ) -> Rgb {
        self.add_emission(gathered.emission, gathered.collisions, observer);
        gathered.transmittance
    }

    /// Adds volume emission along the present ray, weighted against light samples.
    pub(super) fn add_emission(
        &mut self,
        emission: Rgb,
        collisions: u32,
        observer: &mut impl Observer,
    ) {
        let State { ray, prev_vertex, scatters, throughput, .. } = self.state;
        let prev_vertex = prev_vertex.as_ref();
        let (w, pdfs) = match emission == Rgb::ZERO {
            true => (0.0, [1.0, 0.0]),
            false => direct::weight_of_emission(self.scene, &ray, prev_vertex),
        };
        let contribution = throughput * (w * emission);
        self.contributions.add_emission(scatters, contribution);
        let counts = prev_vertex.map_or([1.0, 0.0], |prev| [prev.fires.rays, prev.fires.samples]);
        let technique = Technique {
            class: self.state.class(),
            throughput: self.state.throughput_before,
            share: prev_vertex.map_or(1.0, |prev| prev.fires.share),
            counts,
            pdfs,
            collisions,
        };
        observer.step(PathStep::Emission { contribution, technique });
    }

    /// Adds light at the end of the present ray.
    pub(super) fn add_end(
        &mut self,
        contribution: Rgb,
        by_transmittance: bool,
        own_walk: Option<u32>,
        observer: &mut impl Observer,
    ) {
        let class = self.state.class();
        self.contributions.add_end(self.state.scatters, contribution);
        observer.step(PathStep::End { contribution, class, by_transmittance, own_walk });
    }
}
