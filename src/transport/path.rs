//! The path: camera, flights through the medium, scattering and reflection, light on the way.
//!
//! | what the ray from a vertex gathers | settings without ratio tracking | with it, or marching |
//! |---|---|---|
//! | ε on the ray | the scattering walk's own, up to its event | the emission walk, whole ray |
//! | the end of the ray | when the scattering walk gets there | with the emission walk's T |
//!
//! With ratio tracking the scattering walk gathers neither, so that nothing counts twice.
//! Every combination of toggles has the same mean. A marched ray stands for both walks, biased.

use glam::Vec3A;

use super::direct::PrevVertex;
use super::distance::{DistanceGuide, GuidedDistances};
use super::emission::EmissionEstimator;
use super::emission::ray::{RayEmission, RayKind};
use super::observer::{Observer, PathStep};
use super::probes::{Brightness, Probes};
use super::sample::PathSample;
use super::scene::Scene;
use super::strategy::Strategy;
use super::tracking::event::{Event, Flight};
use super::vertex::{DirectionSample, Vertex};
use super::weight_window::{MOST_NESTED, Splitting};
use super::{direct, distance, guiding, march, tracking};
use crate::{
    light::{LightChoice, Receiver},
    math::{PathRng, Ray, Rgb, mean},
    sampling::equiangular::Equiangular,
    surface::{self, Intersection},
    volume::world::MediumRay,
};

/// Most scattering events and reflections of any path. A path that gets here is counted.
pub const GUARD: u32 = 100_000;
/// Scattering events and reflections before roulette may end a path.
const ROULETTE_AFTER: u32 = 3;
/// Throughput below which it does. Paths that may yet come to light are not worth less for being
/// dim: at 1 the noise of dense smoke costs a third more time, that of lights inside of it several
/// times as much.
const ROULETTE_BELOW: f32 = 0.1;
/// Rays of a path that are guided at most: later ones bring so little that guides cost more than
/// they gain, and each adds to the spread of the path's weight.
const GUIDED_RAYS: u32 = 4;
/// Turns up to which the weight window is asked: the spread that guides bring is behind by then, and
/// to look up a probe at each of a thousand turns costs more than the walk.
const WEIGHED_TURNS: u32 = 8;

/// What was prepared for the scene.
#[derive(Clone, Copy, Debug)]
pub struct PathContext<'s> {
    /// The emission's own walk.
    pub emission_estimator: &'s EmissionEstimator,
    /// What says where scattering pays and which light to look at, as far as that is asked for.
    pub probes: Option<&'s Probes>,
    /// What the probes think of the film.
    pub brightness: Brightness,
    /// Guided flights of the camera rays, relative to what the probes propose; 0 asks the probes
    /// nowhere where scattering pays.
    pub flights: f32,
}

impl<'s> PathContext<'s> {
    /// The probes, where they say where scattering pays.
    fn guides(&self, strategy: &Strategy) -> Option<&'s Probes> {
        self.probes.filter(|_| self.flights > 0.0 && strategy.guides())
    }
}

/// Follows one path from the camera along `ray`.
pub fn trace(
    scene: &Scene,
    context: PathContext<'_>,
    ray: Ray,
    rng: &mut PathRng,
    observer: &mut impl Observer,
) -> PathSample {
    let mut path = Path {
        scene,
        context,
        ray,
        throughput: Rgb::ONE,
        guiding_ratio: 1.0,
        scatters: 0,
        prev_vertex: None,
        light: None,
        expected: 0.0,
        nested: 0,
        table: march::MarchTable::default(),
        branch: Branch::Main,
        sample: PathSample::default(),
    };
    while path.advance(rng, observer) {}
    path.sample
}

struct Path<'s> {
    scene: &'s Scene,
    context: PathContext<'s>,
    ray: Ray,
    throughput: Rgb,
    /// How many times as often as by chance alone the last turn to everywhere was drawn so: a path
    /// that was sent to light is not dim for being one of many.
    guiding_ratio: f32,
    /// Scattering events and reflections so far.
    scatters: u32,
    /// None for the camera ray.
    prev_vertex: Option<PrevVertex>,
    /// A point of a light that guides the ray.
    light: Option<Vec3A>,
    /// What a flight of the camera ray is expected to bring; 0 where that is not known.
    expected: f32,
    /// Splits whose copies are being followed.
    nested: u32,
    /// Of the ray, where it is marched.
    table: march::MarchTable,
    branch: Branch,
    sample: PathSample,
}

/// The camera ray may have several flights: one that is unguided, and guided ones.
#[derive(Clone, Copy, PartialEq)]
enum Branch {
    /// The unguided one is followed.
    Main,
    /// A guided one is followed, the first of them or not.
    Guided { first: bool },
}

impl Path<'_> {
    /// One ray and the vertex at its end; false when the path is over.
    fn advance(&mut self, rng: &mut PathRng, observer: &mut impl Observer) -> bool {
        let scene = self.scene;
        let end = surface::intersect(&scene.surfaces, &self.ray);
        let t_max = end.map_or(f32::INFINITY, |end| end.hit.t);
        observer.step(PathStep::Ray { ray: &self.ray, t_max, throughput: self.throughput });

        let medium = scene.world.along(self.ray, t_max);
        let marched = scene.strategy.is_biased().then(|| self.march(medium.clone(), rng));
        let coverage = scene
            .strategy
            .gathers_whole_rays()
            .then(|| self.gather_whole_ray(medium.clone(), marched, end.as_ref(), rng, observer));
        if coverage.is_some() && self.is_last_ray() {
            return false;
        }
        let flight = match marched {
            Some(_) => self.table.draw(medium, goes_on(end.as_ref()), rng),
            None => self.fly(medium, end.as_ref(), rng, observer),
        };
        if flight.emission != Rgb::ZERO {
            let weight = direct::weight_of_emission(scene, &self.ray, self.prev_vertex.as_ref());
            self.gather_emission(weight * flight.emission, observer);
        }
        self.throughput *= flight.weight;
        if !self.throughput.is_finite() {
            // Leads nowhere, and is counted with the sample it spoils.
            self.sample.indirect += self.throughput;
            return false;
        }
        if self.scatters == 0 {
            self.note_first_event(&flight, end.as_ref(), coverage);
        }
        match self.arrive(flight.event, end.as_ref(), observer) {
            Some(vertex) => self.split(&vertex, rng, observer),
            None => false,
        }
    }

    /// Goes on from a vertex as often as pays; false when the path is over. All copies but the last
    /// are followed to their end.
    fn split(&mut self, vertex: &Vertex, rng: &mut PathRng, observer: &mut impl Observer) -> bool {
        let copies = self.copies(vertex, rng);
        self.throughput *= copies.factor;
        for _ in 1..copies.count {
            let (ray, throughput, light) = (self.ray, self.throughput, self.light);
            let (scatters, prev_vertex, branch) = (self.scatters, self.prev_vertex, self.branch);
            self.branch = Branch::Guided { first: false };
            self.nested += 1;
            let mut goes_on = self.turn(vertex, rng, observer);
            while goes_on {
                goes_on = self.advance(rng, observer);
            }
            self.nested -= 1;
            (self.ray, self.throughput, self.light) = (ray, throughput, light);
            (self.scatters, self.prev_vertex, self.branch) = (scatters, prev_vertex, branch);
        }
        copies.count > 0 && self.turn(vertex, rng, observer)
    }

    /// How often to go on from a vertex: once, where probes don't tell what comes of it.
    fn copies(&self, vertex: &Vertex, rng: &mut PathRng) -> Splitting {
        match self.context.guides(&self.scene.strategy) {
            Some(probes) if self.is_weighed(vertex) => {
                let position = vertex.receiver().position;
                let radiance = probes.radiance_at(position, self.ray.direction);
                let value = mean(self.throughput) * radiance / self.expected;
                let brightness = self.throughput.max_element() / ROULETTE_BELOW;
                Splitting::draw(value, brightness, self.nested < MOST_NESTED, rng)
            }
            _ => Splitting { count: 1, factor: 1.0 },
        }
    }

    /// Whether the weight window says how a path goes on from a vertex; else it is roulette.
    fn is_weighed(&self, vertex: &Vertex) -> bool {
        self.expected > 0.0 && self.scatters < WEIGHED_TURNS && !vertex.is_surface()
    }

    /// Follows a guided flight of the camera ray to its end, then goes back to where it set out.
    fn follow(
        &mut self,
        guided: Flight,
        first: bool,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) {
        self.count(guided.collisions);
        let (ray, throughput, light) = (self.ray, self.throughput, self.light);
        self.throughput *= guided.weight;
        if let Event::Scattered { t, phase } = guided.event
            && self.throughput.is_finite()
            && self.throughput != Rgb::ZERO
        {
            self.branch = Branch::Guided { first };
            let vertex = Vertex::volume(ray.at(t), ray.direction, phase);
            let mut goes_on = self.split(&vertex, rng, observer);
            while goes_on {
                goes_on = self.advance(rng, observer);
            }
        }
        (self.ray, self.throughput, self.light) = (ray, throughput, light);
        (self.branch, self.scatters, self.prev_vertex) = (Branch::Main, 0, None);
        self.guiding_ratio = 1.0;
        rng.enter_vertex(0);
    }

    /// The vertex a flight leads to, if there is one.
    fn arrive(
        &mut self,
        event: Event,
        end: Option<&Intersection>,
        observer: &mut impl Observer,
    ) -> Option<Vertex> {
        match event {
            Event::Absorbed { t, .. } => {
                observer.step(PathStep::Absorbed { point: self.ray.at(t) });
                None
            }
            Event::Scattered { t, phase } => {
                Some(Vertex::volume(self.ray.at(t), self.ray.direction, phase))
            }
            Event::Reached => {
                if !self.scene.strategy.gathers_whole_rays() {
                    let prev_vertex = self.prev_vertex.as_ref();
                    let radiance = direct::at_the_end(self.scene, &self.ray, end, prev_vertex);
                    self.gather_end(radiance, observer);
                }
                end.and_then(|end| Vertex::reflecting(end, &self.ray))
            }
        }
    }

    /// The flight to the next scattering event, or to the end of the ray. The camera ray may have
    /// guided ones beside it, which are followed first. Rays from vertices have one, which is
    /// guided where nothing is gained by getting to their end.
    fn fly(
        &mut self,
        medium: MediumRay,
        end: Option<&Intersection>,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Flight {
        let strategy = &self.scene.strategy;
        let needs_end = !strategy.emission_ratio_tracking || goes_on(end);
        let is_first = self.scatters == 0;
        let guide = if is_first || !needs_end { self.guide(&medium, rng) } else { None };
        let flight = match guide {
            None => distance::unguided(medium, strategy, self.throughput, rng),
            Some(guide) if is_first => self.fan_out(medium, &guide, rng, observer),
            Some(guide) => distance::null_or_guided(medium, strategy, &guide, self.throughput, rng),
        };
        self.count(flight.collisions);
        flight
    }

    /// The camera ray's flights: as many guided ones as pay, each of which is followed, and the
    /// unguided one.
    fn fan_out(
        &mut self,
        medium: MediumRay,
        guide: &DistanceGuide,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Flight {
        let strategy = &self.scene.strategy;
        let film = self.context.brightness.scaled(self.context.flights);
        let fan = GuidedDistances::new(strategy, guide, film, rng);
        self.expected = fan.expected();
        for (index, t) in fan.distances().enumerate() {
            let flight = fan.guided(medium.clone(), strategy, t, self.throughput, rng);
            self.follow(flight, index == 0, rng, observer);
        }
        fan.unguided(medium, strategy, self.throughput, rng)
    }

    /// What guides the flight along the present ray.
    fn guide(&mut self, medium: &MediumRay, rng: &mut PathRng) -> Option<DistanceGuide> {
        let guides = self.context.guides(&self.scene.strategy);
        let probes = guides.filter(|_| self.scatters < GUIDED_RAYS)?;
        let advanced = &self.scene.strategy.advanced;
        let (t0, t1) = medium.extent()?;
        let asks = self.scatters == 0 || advanced.guide_all_vertices;
        let distance_pdf = if asks { Some(probes.along(medium.clone(), &self.ray)?) } else { None };
        if !advanced.equiangular {
            return DistanceGuide::new(distance_pdf, None);
        }
        if self.scatters == 0 {
            let middle = distance::middle(&self.ray, t0, t1);
            let from = Receiver { position: middle, normal: None };
            let choice = direct::choice(&self.scene.strategy);
            self.light = direct::point_of_light(self.scene, &from, &choice, rng);
        }
        let light = self
            .light
            .and_then(|point| Equiangular::new(&self.ray, point, probes.mean_cosine(), t0, t1));
        DistanceGuide::new(distance_pdf, light)
    }

    /// Marches along the present ray and keeps its table.
    fn march(&mut self, medium: MediumRay, rng: &mut PathRng) -> RayEmission {
        let voxels = self.scene.strategy.advanced.march_step;
        let gathered = self.table.fill(medium, voxels, self.throughput, rng);
        self.count(gathered.collisions);
        gathered
    }

    /// The emission of the whole ray, by the emission walk if it was not `marched`, and what lies at
    /// its end through the same T, which is returned.
    fn gather_whole_ray(
        &mut self,
        medium: MediumRay,
        marched: Option<RayEmission>,
        end: Option<&Intersection>,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Rgb {
        let prev_vertex = self.prev_vertex.as_ref();
        let radiance = direct::at_the_end(self.scene, &self.ray, end, prev_vertex);
        let dark = radiance == Rgb::ZERO && !self.scene.world.emits();
        if dark && prev_vertex.is_some() {
            return Rgb::ZERO;
        }
        let is_seen = prev_vertex.is_none() && !dark;
        let gathered = marched.unwrap_or_else(|| {
            let ray_kind = if is_seen { RayKind::Camera } else { RayKind::Scattered };
            let gathered = self.context.emission_estimator.gather(medium, ray_kind, rng);
            self.count(gathered.collisions);
            gathered
        });
        let prev_vertex = self.prev_vertex.as_ref();
        if gathered.emission != Rgb::ZERO {
            let weight = direct::weight_of_emission(self.scene, &self.ray, prev_vertex);
            self.gather_emission(weight * gathered.emission, observer);
        }
        self.gather_end(gathered.transmittance * radiance, observer);
        gathered.transmittance
    }

    /// Whether the path may not turn any more: its last ray still gathers, both halves of the MIS
    /// of the last vertex being due.
    fn is_last_ray(&self) -> bool {
        self.scene.max_scatters > 0 && self.scatters == self.scene.max_scatters
    }

    /// Next-event estimation at a vertex, then a new direction; false when the path ends there.
    fn turn(&mut self, vertex: &Vertex, rng: &mut PathRng, observer: &mut impl Observer) -> bool {
        if self.is_last_ray() {
            return false;
        }
        if self.scatters == GUARD {
            self.sample.guard_hit = true;
            return false;
        }
        self.scatters += 1;
        match self.branch {
            Branch::Main => rng.enter_vertex(self.scatters),
            Branch::Guided { first: true } => rng.enter_vertex_of_branch(self.scatters),
            Branch::Guided { first: false } => rng.enter_vertex(u32::MAX),
        }
        observer.step(PathStep::Vertex { vertex, throughput: self.throughput });
        let choice = self.choice(vertex);
        let look = direct::sample_lights(
            self.scene,
            self.context.emission_estimator,
            vertex,
            &choice,
            rng,
        );
        self.count(look.collisions);
        let light = self.throughput * look.light;
        observer.step(PathStep::Light { contribution: light });
        self.add_scattered(light);

        if self.sample.guard_hit {
            return false;
        }
        self.light = look.point;
        let Some(turn) = self.choose_direction(vertex, rng) else { return false };
        self.throughput *= turn.weight;
        if vertex.is_broad() {
            self.guiding_ratio = turn.guiding_ratio;
        }
        self.ray = vertex.ray(turn.direction);
        let (from, pdf_solid_angle) = (vertex.receiver(), turn.pdf_solid_angle);
        self.prev_vertex = Some(PrevVertex { from, choice, pdf_solid_angle });
        self.survives(vertex, rng)
    }

    /// How a vertex chooses the light it looks at: by the probe around it, if there is one.
    fn choice(&self, vertex: &Vertex) -> LightChoice {
        let choice = direct::choice(&self.scene.strategy);
        let from = vertex.receiver();
        match self.context.probes.and_then(|probes| probes.scores(from.position)) {
            Some(scores) => {
                self.scene.lights.choice_by(scores, &from, choice.volumes, |direction| {
                    vertex.rough_value(direction)
                })
            }
            None => choice,
        }
    }

    /// Where the path goes on from a vertex: sometimes where the probes know of light.
    fn choose_direction(&self, vertex: &Vertex, rng: &mut PathRng) -> Option<DirectionSample> {
        let strategy = &self.scene.strategy;
        match self.context.probes.filter(|_| self.scatters < GUIDED_RAYS && strategy.guides()) {
            Some(probes) => {
                // Without guided flights there are no splits that would even out what the glow brings.
                let light = self.light.filter(|_| self.context.flights > 0.0);
                let guiding = guiding::guiding(&strategy.advanced, probes, vertex, light);
                vertex.sample_guided(&guiding, rng)
            }
            None => vertex.sample(rng),
        }
    }

    /// Counts the collisions of a walk, and notes a walk that was cut.
    fn count(&mut self, collisions: u32) {
        self.sample.tracking_steps = self.sample.tracking_steps.saturating_add(collisions);
        self.sample.guard_hit |= collisions >= tracking::MOST_COLLISIONS;
    }

    /// Russian roulette on the throughput, compensated, where the weight window has not spoken.
    fn survives(&mut self, vertex: &Vertex, rng: &mut PathRng) -> bool {
        if self.is_weighed(vertex) {
            return self.throughput != Rgb::ZERO;
        }
        let survival =
            (self.throughput.max_element() * self.guiding_ratio / ROULETTE_BELOW).min(1.0);
        if self.scatters < ROULETTE_AFTER || survival >= 1.0 {
            return survival > 0.0;
        }
        let survives = rng.uniform() < survival;
        if survives {
            self.throughput /= survival;
        }
        survives
    }

    fn gather_emission(&mut self, emission: Rgb, observer: &mut impl Observer) {
        let contribution = self.throughput * emission;
        if self.scatters == 0 {
            self.sample.emission += contribution;
        } else {
            self.add_scattered(contribution);
        }
        observer.step(PathStep::Emission { contribution });
    }

    fn gather_end(&mut self, radiance: Rgb, observer: &mut impl Observer) {
        let contribution = self.throughput * radiance;
        if self.scatters == 0 {
            self.sample.background += contribution;
        } else {
            self.add_scattered(contribution);
        }
        observer.step(PathStep::End { contribution });
    }

    fn add_scattered(&mut self, contribution: Rgb) {
        if self.scatters == 1 {
            self.sample.direct += contribution;
        } else {
            self.sample.indirect += contribution;
        }
    }

    /// Coverage and depth of the camera ray; `transmittance` is the emission walk's, if it had one.
    fn note_first_event(
        &mut self,
        flight: &Flight,
        end: Option<&Intersection>,
        transmittance: Option<Rgb>,
    ) {
        let (opacity, depth) = match (&flight.event, end) {
            (Event::Absorbed { real: false, .. }, _) => (1.0, None),
            (Event::Absorbed { t, .. } | Event::Scattered { t, .. }, _) => (1.0, Some(*t)),
            (Event::Reached, Some(end)) => (1.0, Some(end.hit.t)),
            (Event::Reached, None) => (1.0 - mean(flight.weight), None),
        };
        let smooth = transmittance.filter(|_| end.is_none()).map(|t| 1.0 - mean(t));
        (self.sample.alpha, self.sample.depth) = (smooth.unwrap_or(opacity), depth);
    }
}

/// Whether a path goes on from the end of its ray.
fn goes_on(end: Option<&Intersection>) -> bool {
    end.is_some_and(|end| end.surface.reflects())
}
