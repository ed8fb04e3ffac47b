//! Light samples at the vertices of a path (next-event estimation): as many of fires and of other
//! lights as the counts expect.

use super::current::Path;
use super::state::State;
use crate::light::LightGroup;
use crate::math::{PathRng, Slot, mean};
use crate::transport::direct::{self, LightSampling};
use crate::transport::guiding;
use crate::transport::learned_counts::{self, BounceClass};
use crate::transport::observer::{Observer, PathStep, Technique};
use crate::transport::vertex::Vertex;

/// First of the light samples of fires at a vertex; those of other lights begin at 0.
const FIRST_FIRE_SAMPLE: u32 = 8;

impl Path<'_> {
    /// Sampling of fires and of other lights at a vertex: the choice among them, and the expected
    /// counts.
    pub(super) fn light_sampling(&self, vertex: &Vertex) -> (LightSampling, LightSampling) {
        let (scene, context) = (self.scene, &self.context);
        let receiver = vertex.receiver();
        let share_of_fires = match scene.strategy.nee {
            true => scene.lights.share_of_fires(&receiver),
            false => 0.0,
        };
        let class = BounceClass::new(self.state.scatters, vertex.is_surface());
        let throughput = mean(self.state.throughput);
        let position = receiver.position;
        let counts = context.counts.at_vertex(class, position, throughput, share_of_fires);
        let sampling = |among, expected: f32, rays, share| {
            let samples = if scene.lights.len(among) > 0 { expected } else { 0.0 };
            // No probe is asked where nothing is chosen.
            let choice = match samples > 0.0 {
                true => guiding::light_choice(scene, context, vertex, among),
                false => direct::choice_among(&scene.strategy, among),
            };
            LightSampling { choice, samples, rays, share }
        };
        let fires = if scene.strategy.nee { counts.fire_samples } else { 0.0 };
        let walks = match scene.strategy.gathers_whole_rays() {
            true => counts.emission_walks,
            // The scattering walk gathers the emission of every ray.
            false => 1.0,
        };
        (
            sampling(LightGroup::Fires, fires, walks, share_of_fires),
            sampling(LightGroup::Lamps, counts.lamp_samples, 1.0, 1.0 - share_of_fires),
        )
    }

    /// Draws the light samples of a group of lights at a vertex.
    pub(super) fn sample_lights(
        &mut self,
        vertex: &Vertex,
        sampling: &LightSampling,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) {
        let State { scatters, throughput, .. } = self.state;
        let fires = sampling.choice.among == LightGroup::Fires;
        let (slot, first) =
            if fires { (Slot::FireCount, FIRST_FIRE_SAMPLE) } else { (Slot::LampCount, 0) };
        for index in 0..learned_counts::draw(sampling.samples, slot, rng) {
            rng.enter_light_sample(first + index);
            let estimator = self.context.emission_estimator;
            let sample = direct::sample_lights(self.scene, estimator, vertex, sampling, rng);
            self.contributions.count(sample.collisions);
            let contribution = throughput * sample.contribution;
            self.contributions.add_scattered(scatters, contribution);
            let technique = Technique {
                class: BounceClass::new(scatters, vertex.is_surface()),
                throughput: self.state.throughput_before,
                share: sampling.share,
                counts: [sampling.samples, sampling.rays],
                pdfs: sample.pdfs,
                collisions: sample.collisions,
            };
            let shadow_ray = sample.shadow_ray;
            observer.step(PathStep::Light { contribution, technique, fires, shadow_ray });
            self.state.light_point = self.state.light_point.or(sample.point);
        }
    }
}
