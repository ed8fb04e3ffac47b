//! A path: the camera, flights through the medium, scattering and reflection, and the light along
//! it.
//!
//! In the symbols of the talk, with d the distance to the surface that the ray meets,
//! L(x, ω) = ∫₀^d T [μ_s L_s + ε] dt + T(d) L_end, and L_s(x, ω) = ∫ ρ(ω, ω') L(x, ω') dω'.
//!
//! | term | settings without ratio tracking | with it, or marching |
//! |---|---|---|
//! | ∫ T ε dt | the scattering walk's own, up to its event | an emission walk over the whole ray |
//! | T(d) L_end | when the scattering walk gets there, or with an estimate of T | the same |
//! | ∫ T μ_s L_s dt | the next vertex: light samples, then a direction | the same |
//!
//! With ratio tracking the scattering walk gathers no emission, and of the light at the end only
//! the share that is not gathered by T, so that nothing counts twice. Every combination of toggles
//! has the same mean. A marched ray stands for both walks, biased.
//!
//! A camera ray may have several guided flights, and a vertex may be left several times. Each
//! branch but the last is followed to its end at once, then `State` is restored.
//!
//! The talk's ideas in this code: emission at every collision in [`super::tracking::scattering`],
//! emission ratio tracking in [`super::emission::ratio`], the majorant boost in [`super::emission`]
//! (its modes) and `tracking::majorant` (clamped, literal), fires as lights in [`super::direct`],
//! probe MIS in `distance` and [`super::probes`]; the number of samples of each in `counts`.

mod current;
mod gather;
mod lights;
mod state;

use self::current::Path;
use self::gather::LightAtEnd;
use self::state::{Branch, State};
use super::context::PathContext;
use super::counts::{Counts, PathValue};
use super::direct::PrevVertex;
use super::distance::{self, DistanceGuide, GuidedDistances};
use super::guiding;
use super::learned_counts::BounceClass;
use super::march;
use super::observer::{Observer, PathStep};
use super::sample::{Contributions, PathSample};
use super::scene::Scene;
use super::tracking::event::{Event, Flight};
use super::vertex::Vertex;
use crate::math::{PathRng, Ray, Rgb, mean};
use crate::surface::{self, Intersection};
use crate::volume::world::MediumRay;

/// Most vertices of any path: scattering events and reflections. A path that reaches this limit is
/// cut and counted.
pub const MOST_VERTICES: u32 = 100_000;

/// Follows one path from the camera along `ray`.
pub fn trace(
    scene: &Scene,
    context: PathContext<'_>,
    ray: Ray,
    rng: &mut PathRng,
    observer: &mut impl Observer,
) -> PathSample {
    let state = State::new(ray);
    let (table, contributions) = (march::MarchTable::default(), Contributions::default());
    let (expected, nested, branches) = (0.0, 0, 0);
    let mut path = Path { scene, context, state, expected, nested, branches, table, contributions };
    while path.advance(rng, observer) {}
    path.contributions.finish()
}

impl Path<'_> {
    /// Follows one ray: gathers its emission and what lies at its end, and scatters at the vertex
    /// on it. Returns false when the path is over.
    fn advance(&mut self, rng: &mut PathRng, observer: &mut impl Observer) -> bool {
        let (scene, ray, throughput) = (self.scene, self.state.ray, self.state.throughput);
        let end = surface::intersect(&scene.surfaces, &ray);
        let d = end.map_or(f32::INFINITY, |end| end.hit.t);
        observer.step(PathStep::Ray { ray: &ray, t_max: d, throughput });

        let medium = scene.world.along(ray, d);
        let at_end = self.light_at_end(end.as_ref());
        let marched = scene.strategy.marches().then(|| self.march(medium.clone(), rng));
        let transmittance = self.gather_whole_ray(medium.clone(), marched, &at_end, rng, observer);
        if self.is_last_ray() && !self.flight_gathers(&at_end) {
            return false;
        }
        let flight = match marched {
            Some(_) => self.table.draw(medium, end_reflects(end.as_ref()), rng),
            None => self.fly(medium, (end.as_ref(), &at_end), rng, observer),
        };
        if flight.emission != Rgb::ZERO {
            self.add_emission(flight.emission, flight.collisions, observer);
        }
        self.state.throughput *= flight.weight;
        if !self.state.throughput.is_finite() {
            // Leads nowhere, and is counted with the sample it spoils.
            self.contributions.spoil(self.state.throughput);
            return false;
        }
        if self.state.scatters == 0 {
            self.contributions.note_first_event(&flight, d, transmittance);
        }
        match self.arrive(flight.event, (end.as_ref(), &at_end), observer) {
            Some(vertex) => self.split_and_scatter(&vertex, rng, observer),
            None => false,
        }
    }

    /// The vertex at the end of a flight; `None` where the path ends.
    fn arrive(
        &mut self,
        event: Event,
        (end, at_end): (Option<&Intersection>, &LightAtEnd),
        observer: &mut impl Observer,
    ) -> Option<Vertex> {
        let ray = self.state.ray;
        match event {
            Event::Absorbed { t, .. } => {
                observer.step(PathStep::Absorbed { point: ray.at(t) });
                None
            }
            Event::Scattered { t, phase } => Some(Vertex::volume(&ray, t, phase)),
            Event::Reached => {
                if at_end.arrives() {
                    let share = 1.0 - at_end.by_transmittance;
                    let contribution = self.state.throughput * (share * at_end.radiance);
                    self.add_end(contribution, false, None, observer);
                }
                end.and_then(|end| Vertex::reflecting(end, &ray))
            }
        }
    }

    /// Splits the path at a vertex as often as the weight window asks for and scatters each branch.
    /// All branches but the last are followed to their end. Returns false when the path is over.
    fn split_and_scatter(
        &mut self,
        vertex: &Vertex,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> bool {
        let State { ray, throughput, scatters, .. } = self.state;
        let Self { expected, nested, branches, .. } = *self;
        let value = PathValue { throughput, scatters, expected, nested, branches };
        let strategy = &self.scene.strategy;
        let counts = Counts::at(&self.context, strategy, vertex, ray.direction, value);
        let splitting = counts.splitting(rng);
        self.state.throughput *= splitting.factor;
        for _ in 1..splitting.count {
            self.nested += 1;
            self.branches += 1;
            self.follow(Branch::Other, rng, observer, |path, rng, observer| {
                path.scatter(vertex, &counts, rng, observer)
            });
            self.nested -= 1;
        }
        splitting.count > 0 && self.scatter(vertex, &counts, rng, observer)
    }

    /// Scatters at a vertex: light samples, then a new direction; false when the path ends there.
    fn scatter(
        &mut self,
        vertex: &Vertex,
        counts: &Counts,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> bool {
        if self.is_last_ray() {
            return false;
        }
        if self.state.scatters == MOST_VERTICES {
            self.contributions.cut();
            return false;
        }
        self.state.scatters += 1;
        match self.state.branch {
            Branch::Main => rng.enter_vertex(self.state.scatters),
            Branch::FirstGuided => rng.enter_vertex_of_branch(self.state.scatters),
            Branch::Other => rng.enter_vertex(u32::MAX),
        }
        let class = BounceClass::new(self.state.scatters, vertex.is_surface());
        observer.step(PathStep::Vertex { vertex, class, throughput: self.state.throughput });
        let (fires, lamps) = self.light_sampling(vertex);
        self.state.throughput_before = mean(self.state.throughput);
        self.state.light_point = None;
        self.sample_lights(vertex, &fires, rng, observer);
        self.sample_lights(vertex, &lamps, rng, observer);
        if self.contributions.is_cut() {
            return false;
        }
        let (scene, context, scatters) = (self.scene, &self.context, self.state.scatters);
        if self.state.light_point.is_none() {
            self.state.light_point = guiding::light_point(scene, context, scatters, vertex, rng);
        }
        let light_point = self.state.light_point;
        let drawn = guiding::direction(scene, context, scatters, vertex, light_point, rng);
        let Some(drawn) = drawn else { return false };
        self.state.throughput *= drawn.weight;
        if vertex.is_broad() {
            self.state.guiding_ratio = drawn.guiding_ratio;
        }
        self.state.ray = vertex.ray(drawn.direction);
        let (from, pdf_solid_angle) = (vertex.receiver(), drawn.pdf_solid_angle);
        self.state.prev_vertex = Some(PrevVertex { from, fires, lamps, pdf_solid_angle });
        self.survives(counts, rng)
    }

    /// Russian roulette; the throughput of a path that survives compensates for it.
    fn survives(&mut self, counts: &Counts, rng: &mut PathRng) -> bool {
        let survival = counts.survival(self.state.throughput, self.state.guiding_ratio);
        if survival >= 1.0 || survival <= 0.0 {
            return survival > 0.0;
        }
        let survives = rng.uniform() < survival;
        if survives {
            self.state.throughput /= survival;
        }
        survives
    }

    /// Follows a branch to its end, from the step that `begin` takes. The state of the path is then
    /// restored.
    fn follow<O: Observer>(
        &mut self,
        branch: Branch,
        rng: &mut PathRng,
        observer: &mut O,
        begin: impl FnOnce(&mut Self, &mut PathRng, &mut O) -> bool,
    ) {
        let saved = self.state;
        self.state.branch = branch;
        let mut goes_on = begin(self, rng, observer);
        while goes_on {
            goes_on = self.advance(rng, observer);
        }
        self.state = saved;
    }

    /// The flight to the next scattering event, or to the end of the ray. The camera ray may have
    /// guided flights beside it, which are followed first. Rays from vertices have one flight,
    /// which is guided where the end of the ray need not be reached.
    fn fly(
        &mut self,
        medium: MediumRay,
        (end, at_end): (Option<&Intersection>, &LightAtEnd),
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Flight {
        let (scene, State { ray, throughput, scatters, .. }) = (self.scene, self.state);
        let needs_end = self.flight_gathers(at_end) || end_reflects(end);
        let is_first = scatters == 0;
        let guide = if is_first || !needs_end {
            let (context, light_point) = (&self.context, self.state.light_point);
            let (guide, light_point) =
                guiding::draw_guide(scene, context, (scatters, &ray), &medium, light_point, rng);
            self.state.light_point = light_point;
            guide
        } else {
            None
        };
        let strategy = &scene.strategy;
        let flight = match guide {
            None => distance::unguided(medium, strategy, throughput, rng),
            Some(guide) if is_first => self.camera_flights(medium, &guide, rng, observer),
            Some(guide) => distance::null_or_guided(medium, strategy, &guide, throughput, rng),
        };
        self.contributions.count(flight.collisions);
        flight
    }

    /// The camera ray's flights: guided ones in their allocated number, each of which is followed,
    /// and the unguided one, which is returned.
    fn camera_flights(
        &mut self,
        medium: MediumRay,
        guide: &DistanceGuide,
        rng: &mut PathRng,
        observer: &mut impl Observer,
    ) -> Flight {
        let (strategy, throughput) = (&self.scene.strategy, self.state.throughput);
        let film = (&self.context.brightness, self.context.counts.guided_flights);
        let distances = GuidedDistances::new(strategy, guide, film, rng);
        self.expected = distances.expected();
        for (index, t) in distances.iter().enumerate() {
            let guided = distances.guided(medium.clone(), strategy, t, throughput, rng);
            self.contributions.count(guided.collisions);
            let branch = if index == 0 { Branch::FirstGuided } else { Branch::Other };
            self.follow(branch, rng, observer, |path, rng, observer| {
                path.state.throughput *= guided.weight;
                let Event::Scattered { t, phase } = guided.event else { return false };
                let State { ray, throughput, .. } = path.state;
                let vertex = Vertex::volume(&ray, t, phase);
                let is_lit = throughput.is_finite() && throughput != Rgb::ZERO;
                is_lit && path.split_and_scatter(&vertex, rng, observer)
            });
            rng.enter_vertex(0);
        }
        distances.unguided(medium, strategy, throughput, rng)
    }

    /// Whether the path has reached its limit of scattering events: its last ray still gathers
    /// emission and background, as both halves of the MIS of the last vertex must be counted.
    fn is_last_ray(&self) -> bool {
        self.scene.max_scatters > 0 && self.state.scatters == self.scene.max_scatters
    }
}

/// Whether a surface that reflects ends a ray, so that the path continues from there.
fn end_reflects(end: Option<&Intersection>) -> bool {
    end.is_some_and(|end| end.surface.reflects())
}
