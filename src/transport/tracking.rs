//! Null-collision tracking: the one loop that walks tentative collisions, and the scattering walk,
//! which uses it.
//!
//! A heterogeneous medium is filled up with fictitious matter μ_n = μ̄ − μ_t to a piecewise constant
//! majorant μ̄, in which distances to collisions are exponential. With T̄ the transmittance of μ̄,
//! L = ∫ T̄ [ε + μ_s L_s + μ_n L] dt + T̄(d) L_end (Miller et al. 2019, eq. 10, with emission), and
//! each walk is a Monte Carlo reading of it. All are unbiased: the majorants hold
//! everywhere, and roulette compensates for what it ends.

mod decomposition;

use std::ops::ControlFlow;

use super::{
    emission::EmissionMajorant,
    strategy::{Strategy, Tracker},
};
use crate::{
    math::{PathRng, Rgb, mean},
    volume::{
        medium::{Coefficients, Segment},
        phase::PhaseMix,
        world::MediumRay,
    },
};

/// Least collisions along a volume's brightest chord where emission is gathered by collisions, and
/// least absorptions where it is gathered by those, so that fire without soot is found at all.
pub(super) const EMISSION_FLOOR: f32 = 0.1;
/// Most tentative collisions of one walk. One that gets here is cut, and its path counted as cut:
/// it takes coefficients far beyond what single precision can step through.
pub const MOST_COLLISIONS: u32 = 1 << 17;
/// Below this weight a walk of transmittance goes on by chance only.
pub(super) const ROULETTE_BELOW: f32 = 0.05;

/// What a walk does on its way.
pub(super) trait Walk {
    /// The rate of tentative collisions μ̄ in a segment, at least its majorant. Asked for once in
    /// each, from near to far; the walk's history may have a say in it.
    fn rate(&mut self, medium: &MediumRay, segment: &Segment) -> f32;

    /// Crosses a uniform segment in closed form; false to be given its collisions instead.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool;

    /// Where the walk ends; at the end of the medium, if not before.
    #[inline]
    fn until(&self) -> f32 {
        f32::INFINITY
    }

    /// The end of the walk at [`Walk::until`], if that lies in the medium.
    fn arrive(&mut self, _medium: &MediumRay, _at: &Collision) {}

    /// A tentative collision under the majorant [`Collision::rate`].
    fn collide(&mut self, medium: &MediumRay, at: &Collision, rng: &mut PathRng)
    -> ControlFlow<()>;
}

/// A tentative collision.
pub(super) struct Collision<'s> {
    /// Where it is, as a ray parameter.
    pub(super) t: f32,
    /// The majorant μ̄ it was drawn under.
    pub(super) rate: f32,
    /// The segment it lies in.
    pub(super) segment: &'s Segment,
}

/// Calls `walk` for each tentative collision along the medium, from near to far, and returns how
/// many there were. A step that lands beyond the end of its segment is no collision.
///
/// The first step is `optical_distance` long, which has density exp(-x).
pub(super) fn track(
    mut medium: MediumRay,
    mut optical_distance: f32,
    rng: &mut PathRng,
    walk: &mut impl Walk,
) -> u32 {
    let mut collisions = 0;
    let until = walk.until();
    while let Some(segment) = medium.next_segment() {
        if segment.t0 > until {
            break;
        }
        if segment.uniform && walk.cross(&medium, &segment, rng) {
            continue;
        }
        let rate = walk.rate(&medium, &segment);
        if rate <= 0.0 {
            continue;
        }
        let mut t = segment.t0;
        let end = segment.t1.min(until);
        loop {
            let depth_left = rate * (end - t);
            if optical_distance >= depth_left {
                optical_distance -= depth_left;
                if segment.t1 >= until {
                    walk.arrive(&medium, &Collision { t: until, rate, segment: &segment });
                    return collisions;
                }
                break;
            }
            // However short the step, the walk moves on.
            t = (t + optical_distance / rate).max(t.next_up());
            collisions += 1;
            let at = Collision { t, rate, segment: &segment };
            if walk.collide(&medium, &at, rng).is_break() || collisions == MOST_COLLISIONS {
                return collisions;
            }
            optical_distance = rng.exponential();
        }
    }
    collisions
}

/// μ_n = μ̄ − μ_t per channel. Never below zero: at a border of cells rounding may read the
/// neighbor's coefficient.
#[inline]
pub(super) fn null_coefficient(rate: f32, mu_t: Rgb) -> Rgb {
    (Rgb::splat(rate) - mu_t).max(Rgb::ZERO)
}

/// Ends a walk of small weight by chance, and makes up for it where it goes on.
#[inline]
pub(super) fn roulette(weight: &mut Rgb, rng: &mut PathRng) -> ControlFlow<()> {
    roulette_below(weight, ROULETTE_BELOW, rng)
}

/// [`roulette`] of weights below a given one.
#[inline]
pub(super) fn roulette_below(weight: &mut Rgb, below: f32, rng: &mut PathRng) -> ControlFlow<()> {
    let largest = weight.abs().max_element();
    if !largest.is_finite() {
        // Leads nowhere, and is counted with the sample it spoils.
        return ControlFlow::Break(());
    }
    if largest >= below {
        return ControlFlow::Continue(());
    }
    let survival = largest / below;
    if rng.uniform() >= survival {
        *weight = Rgb::ZERO;
        return ControlFlow::Break(());
    }
    *weight /= survival;
    ControlFlow::Continue(())
}

/// exp(−τ) per channel; an infinite path through nothing is clear.
pub(super) fn exp_neg(mu_t: Rgb, length: f32) -> Rgb {
    let clear = mu_t.cmpeq(Rgb::ZERO);
    Rgb::select(clear, Rgb::ONE, (-mu_t * length).exp())
}

/// Where the scattering walk gathers emission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionGathering {
    /// On absorption, which ends the path (the baseline).
    Absorption,
    /// At every tentative collision (decoupled).
    EveryCollision,
    /// Nowhere: the emission has its own walk.
    Nothing,
}

impl EmissionGathering {
    /// What the toggles ask of the scattering walk; ratio tracking overrides decoupling.
    pub fn of(strategy: &Strategy) -> Self {
        if strategy.emission_ratio_tracking {
            Self::Nothing
        } else if strategy.emission_decoupling {
            Self::EveryCollision
        } else {
            Self::Absorption
        }
    }
}

pub use decomposition::scatter as scatter_by_decomposition;

/// How a flight through the medium ended.
#[derive(Clone, Debug)]
pub enum Event {
    /// It reached the end of the ray.
    Reached,
    /// It was absorbed.
    Absorbed {
        /// Where.
        t: f32,
        /// Whether by the medium; or only to show emission that comes without absorption.
        real: bool,
    },
    /// It scatters.
    Scattered {
        /// Where.
        t: f32,
        /// Into which directions.
        phase: PhaseMix,
    },
}

/// One flight of the scattering walk.
#[derive(Clone, Debug)]
pub struct Flight {
    /// How it ended.
    pub event: Event,
    /// Factor of the path's throughput up to and including the event, over the density of the
    /// scattering walk.
    pub weight: Rgb,
    /// Emission gathered on the way, by the mode it was asked for.
    pub emission: Rgb,
    /// Where it scatters, the density with which the scattering walk would, given the tentative
    /// collisions before and apart from their own density: Π P_n · μ̄ P_s, 1/length. 0 from
    /// decomposition tracking, which does not know it.
    pub pdf_null: f32,
    /// Tentative collisions on the way.
    pub collisions: u32,
}

/// The scattering walk: at each tentative collision one of absorption, scattering and null (or,
/// with the albedo in the weight, one of the latter two) is chosen with P ∝ the channels' mean of
/// w·μ, so that the throughput stays near one color and the factors μ/(μ̄ P) near 1 (Kutz et al.
/// 2017, section 5.1, history-aware probabilities). The first step is `optical_distance` long,
/// which has density exp(-x).
///
/// That is spectral MIS in closed form: with f_c what the path so far brings to channel c, which
/// is also how likely that channel's own analog walk is to take it, the probabilities make the
/// path's density the mean of f over the channels, and its weight f_c / mean f (Miller et al.
/// 2019).
///
/// With the tracker `spectral` it is P ∝ the largest channel of μ instead, whatever the path has
/// come through (the same paper's section 5.1, maximum probabilities): spectral tracking, whose
/// weights grow with every collision that the channels disagree at. Gray media take it for `delta`.
pub fn scatter(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    optical_distance: f32,
    rng: &mut PathRng,
) -> Flight {
    let mut walk = Scattering::new(strategy, throughput, f32::INFINITY);
    let collisions = track(medium, optical_distance, rng, &mut walk);
    walk.flight(collisions)
}

/// The way to a scattering event at parameter `t`, however that was drawn: a scattering walk all
/// of whose collisions before are null, P_n = 1, and the density it would have had by chance. The
/// weight is still over that density. Ends lost, with weight 0, where nothing scatters.
pub fn fill(
    medium: MediumRay,
    strategy: &Strategy,
    throughput: Rgb,
    t: f32,
    rng: &mut PathRng,
) -> Flight {
    let mut walk = Scattering::new(strategy, throughput, t);
    let collisions = track(medium, rng.exponential(), rng, &mut walk);
    if !matches!(walk.event, Event::Scattered { .. }) {
        walk.weight = Rgb::ZERO;
        walk.event = Event::Absorbed { t, real: false };
    }
    walk.flight(collisions)
}

struct Scattering {
    majorant: EmissionMajorant,
    gather: EmissionGathering,
    /// The path's throughput before the flight; only its color matters here.
    throughput: Rgb,
    /// Whether events are chosen whatever the color of the path.
    spectral: bool,
    weight: Rgb,
    emission: Rgb,
    event: Event,
    /// Where the event is, if that is given.
    until: f32,
    /// Π P_n so far, and T of the uniform stretches that have no null collisions.
    null_probability: f32,
    /// T of such a stretch, if the walk is in one.
    null_probability_ahead: f32,
    pdf_null: f32,
}

/// The events' shares of a collision, in proportion to their probabilities.
struct EventProbabilities {
    absorb: f32,
    scatter: f32,
    null: f32,
    total: f32,
}

impl Walk for Scattering {
    fn rate(&mut self, _: &MediumRay, segment: &Segment) -> f32 {
        let rate = match self.gather {
            EmissionGathering::Nothing => segment.majorant,
            EmissionGathering::EveryCollision => self.majorant.rate(segment),
            EmissionGathering::Absorption => {
                segment.majorant.max(EMISSION_FLOOR * segment.emission_rate)
            }
        };
        self.null_probability *= self.null_probability_ahead;
        self.null_probability_ahead = if self.has_no_nulls(segment) {
            (-rate * (segment.t1 - segment.t0)).exp()
        } else {
            1.0
        };
        rate
    }

    /// Where a uniform medium goes on for ever, a channel it is clear to never collides, and one
    /// it is not clear to always does. One of the two kinds is chosen, so that neither waits for
    /// the other; the rest of uniform media is left to the collisions.
    fn cross(&mut self, medium: &MediumRay, segment: &Segment, rng: &mut PathRng) -> bool {
        if segment.t1.is_finite() {
            return false;
        }
        let clear = medium.coefficients(segment.t0).mu_t.cmpeq(Rgb::ZERO);
        if !clear.any() {
            return false;
        }
        let color = self.throughput * self.weight;
        let total = mean(color);
        if !(total > 0.0 && total.is_finite()) {
            self.weight *= total;
            return true;
        }
        let escape = mean(Rgb::select(clear, color, Rgb::ZERO)) / total;
        let escapes = escape >= 1.0 || !self.is_filled() && rng.uniform() < escape;
        self.weight = if escapes {
            Rgb::select(clear, self.weight / escape, Rgb::ZERO)
        } else {
            self.null_probability *= 1.0 - escape;
            Rgb::select(clear, Rgb::ZERO, self.weight / (1.0 - escape))
        };
        escapes
    }

    #[inline]
    fn until(&self) -> f32 {
        self.until
    }

    fn arrive(&mut self, medium: &MediumRay, at: &Collision) {
        if self.is_gray(at.segment) {
            let (mu_t, mu_s) = medium.extinction(at.t);
            let mu_n = self.gray_null(at, mu_t);
            self.scatter_gray(medium, at, mu_t.x, mu_s.x, mu_n);
            return;
        }
        let c = medium.coefficients(at.t);
        let shares = self.shares(&c, null_coefficient(at.rate, c.mu_t), at.segment);
        if shares.total > 0.0 && shares.total.is_finite() {
            self.scatter(medium, at, &c, &shares);
        }
    }

    fn collide(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        if self.is_gray(at.segment) {
            return self.collide_gray(medium, at, rng);
        }
        let &Collision { t, rate, .. } = at;
        let c = medium.coefficients(t);
        if self.gather == EmissionGathering::EveryCollision {
            self.emission += self.weight * c.emission / rate;
        }
        let mu_n = null_coefficient(rate, c.mu_t);
        let shares = self.shares(&c, mu_n, at.segment);
        let EventProbabilities { absorb, scatter, null, total } = shares;
        if !(total > 0.0 && total.is_finite()) {
            // Nothing is left to follow; what is no number stays one and is counted.
            self.weight *= total;
            self.event = Event::Absorbed { t, real: false };
            return ControlFlow::Break(());
        }
        let u = if self.is_filled() { 0.0 } else { rng.uniform() * total };
        if u < null {
            self.weight *= mu_n / rate * (total / null);
            self.null_probability *= null / total;
            return ControlFlow::Continue(());
        }
        if self.is_filled() {
            return ControlFlow::Break(());
        }
        if u < null + scatter && self.scatter(medium, at, &c, &shares) {
            return ControlFlow::Break(());
        }
        if self.gather == EmissionGathering::Absorption {
            self.emission += self.weight * c.emission / rate * (total / absorb);
        }
        let real = u - null - scatter < self.share(c.mu_a());
        self.event = Event::Absorbed { t, real };
        ControlFlow::Break(())
    }
}

impl Scattering {
    fn new(strategy: &Strategy, throughput: Rgb, until: f32) -> Self {
        Self {
            majorant: EmissionMajorant::of(strategy),
            gather: EmissionGathering::of(strategy),
            throughput,
            spectral: strategy.advanced.tracker == Tracker::Spectral,
            weight: Rgb::ONE,
            emission: Rgb::ZERO,
            event: Event::Reached,
            until,
            null_probability: 1.0,
            null_probability_ahead: 1.0,
            pdf_null: 0.0,
        }
    }

    /// What the walk has come to. What a filled one gathers counts for nothing: where emission is
    /// gathered is up to the scattering walk alone.
    fn flight(self, collisions: u32) -> Flight {
        let emission = if self.is_filled() { Rgb::ZERO } else { self.emission };
        let Self { event, weight, pdf_null, .. } = self;
        Flight { event, weight, emission, pdf_null, collisions }
    }

    /// Whether its event is given.
    #[inline]
    fn is_filled(&self) -> bool {
        self.until < f32::INFINITY
    }

    /// Whether one channel stands for all, and absorption for nothing.
    #[inline]
    fn is_gray(&self, segment: &Segment) -> bool {
        segment.gray && self.gather == EmissionGathering::Nothing
    }

    /// Whether every collision is real: where the majorant is the extinction itself.
    #[inline]
    fn has_no_nulls(&self, segment: &Segment) -> bool {
        segment.uniform && self.is_gray(segment)
    }

    /// [`Scattering::collide`] where all channels are the same: whatever the color, each event's
    /// probability is its share of the collisions, and the weight is the albedo.
    fn collide_gray(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        if self.is_filled() && self.has_no_nulls(at.segment) {
            // Crossed in closed form.
            return ControlFlow::Continue(());
        }
        let (mu_t, mu_s) = medium.extinction(at.t);
        let mu_n = self.gray_null(at, mu_t);
        let total = mu_n + mu_t.x;
        if !total.is_finite() {
            self.weight *= total;
            self.event = Event::Absorbed { t: at.t, real: false };
            return ControlFlow::Break(());
        }
        let u = if self.is_filled() { 0.0 } else { rng.uniform() * total };
        if u < mu_n {
            self.null_probability *= mu_n / total;
            return ControlFlow::Continue(());
        }
        if !self.is_filled() && !self.scatter_gray(medium, at, mu_t.x, mu_s.x, mu_n) {
            self.event = Event::Absorbed { t: at.t, real: true };
        }
        ControlFlow::Break(())
    }

    #[inline]
    fn gray_null(&self, at: &Collision, mu_t: Rgb) -> f32 {
        if self.has_no_nulls(at.segment) { 0.0 } else { (at.rate - mu_t.x).max(0.0) }
    }

    /// Scatters in a gray segment; false where nothing does.
    fn scatter_gray(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        mu_t: f32,
        mu_s: f32,
        mu_n: f32,
    ) -> bool {
        if mu_s <= 0.0 {
            return false;
        }
        let clear = if self.has_no_nulls(at.segment) {
            (-at.rate * (at.t - at.segment.t0)).exp()
        } else {
            1.0
        };
        self.pdf_null = self.null_probability * clear * at.rate * (mu_t / (mu_n + mu_t));
        self.weight *= mu_s / mu_t;
        self.event = Event::Scattered { t: at.t, phase: medium.phase(at.t) };
        true
    }

    /// Scatters; false where nothing does.
    fn scatter(
        &mut self,
        medium: &MediumRay,
        at: &Collision,
        c: &Coefficients,
        shares: &EventProbabilities,
    ) -> bool {
        if c.mu_s == Rgb::ZERO || shares.scatter <= 0.0 {
            return false;
        }
        self.pdf_null = self.null_probability * at.rate * (shares.scatter / shares.total);
        self.weight *= c.mu_s / at.rate * (shares.total / shares.scatter);
        self.event = Event::Scattered { t: at.t, phase: medium.phase(at.t) };
        true
    }

    /// What a coefficient's event is chosen in proportion to.
    #[inline]
    fn share(&self, mu: Rgb) -> f32 {
        if self.spectral { mu.max_element() } else { mean(self.throughput * self.weight * mu) }
    }

    /// In which proportion a collision is an absorption, a scattering event or null.
    ///
    /// Where emission is not gathered by absorption, a real collision always scatters, and the
    /// weight carries the albedo: a path that lives on dimly beats one that mostly dies.
    ///
    /// Where absorption alone shows the emission, it happens as often as μ_a says, and often
    /// enough to show it: ε may be positive with little or no μ_a. The other events make up for
    /// that share by their weights, so that the floor absorbs nothing by itself.
    fn shares(&self, c: &Coefficients, mu_n: Rgb, segment: &Segment) -> EventProbabilities {
        let [absorb, scatter] = if self.gather != EmissionGathering::Absorption {
            [Rgb::ZERO, c.mu_t]
        } else if c.emission.max_element() > 0.0 {
            [c.mu_a().max(Rgb::splat(EMISSION_FLOOR * segment.emission_rate)), c.mu_s]
        } else {
            [c.mu_a(), c.mu_s]
        };
        let [absorb, scatter, null] = [absorb, scatter, mu_n].map(|mu| self.share(mu));
        EventProbabilities { absorb, scatter, null, total: absorb + scatter + null }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Affine3A, UVec2, Vec3A};

    use super::*;
    use crate::math::{Aabb, Ray};
    use crate::transport::strategy::Preset;
    use crate::volume::emission::Emission;
    use crate::volume::field::{RgbField, ScalarField};
    use crate::volume::procedural::Noise;
    use crate::volume::world::{Instance, World};
    use crate::volume::{MediumProperties, Region, Volume};

    /// Every tentative collision of a walk that shares another's random numbers, and what there is.
    struct Recorder {
        /// None where emission is no matter of the walk.
        majorant: Option<EmissionMajorant>,
        until: f32,
        /// Whether the walk drew a number at each collision.
        draws: bool,
        /// Where the other walk had its event by chance.
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
            density: ScalarField::Noise(Noise {
                frequency: 2.0,
                octaves: 3,
                contrast: 2.0,
                seed: 0,
            }),
            density_scale: density,
            albedo: RgbField::Constant(albedo),
            g: 0.5,
            emission,
        };
        let volume =
            Volume::varying(Aabb::centered(Vec3A::ONE), properties, Vec3A::splat(0.25), None);
        World::new(vec![Instance::new(Arc::new(volume), Affine3A::IDENTITY)])
    }

    /// Paths with an event, by chance and filled, whose density was checked.
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
            let nulls =
                before.iter().fold(Rgb::ONE, |p, &(t, rate)| p * (1.0 - matter(t)[0] / rate));
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

    /// What the walk says of its density, by chance or filled, is the product along it, evaluated
    /// directly: per channel Π (μ_n/μ̄) · μ, and over the channels the mean of it by the color the
    /// path came with. For gray and colored smoke, whatever gathers emission, for thousands of
    /// paths.
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
            g: 0.0,
            emission: gathered,
        };
        let region = Region::Box(Aabb::centered(Vec3A::ONE));
        let volume = Arc::new(Volume::uniform(region, properties));
        let world = World::new(vec![Instance::new(volume, Affine3A::IDENTITY)]);
        let mut medium = world.along(Ray::new(-3.0 * Vec3A::X, Vec3A::X), f32::INFINITY);
        let segment = medium.next_segment().unwrap();
        let strategy = Strategy { emission_decoupling: true, ..Preset::Baseline.strategy() };
        let mut walk = Scattering::new(&strategy, Rgb::ONE, f32::INFINITY);
        let at = Collision { t: 3.0, rate: 1e-30, segment: &segment };
        let goes_on = walk.collide(&medium, &at, &mut PathRng::new(0, UVec2::ZERO, 0));
        assert!(goes_on.is_continue());
        assert_eq!((walk.weight, walk.emission), (Rgb::ONE, Rgb::ONE));
    }
}
