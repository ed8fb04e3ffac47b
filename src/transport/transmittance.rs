//! Transmittance along a ray, estimated progressively: unbiased at every point.
//!
//! The optical distance τ is estimated by combs, each of which reads μ_t at one jittered place in
//! each unit of a multiple of the majorants' optical distance, and so errs little. T = exp(−τ) is
//! made unbiased from several of them by its power series about one: with X_i independent unbiased
//! estimates of τ, exp(−X_0) Σ_k Π_{i≤k} (X_0 − X_i)/k! has mean exp(−τ), since each factor has
//! mean X_0 − τ (Georgiev et al. 2019; Kettunen et al. 2021, section 4, from which the
//! average over all choices of pivot and factors, a U-statistic, comes as well). Two combs nearly
//! do, and the higher terms are left to roulette.
//!
//! The series is good for small errors only. So the ray is cut into blocks of a fixed optical
//! distance of the majorants, with combs of their own: the transmittances of blocks multiply, and
//! in each the terms fall fast whatever the medium.

use std::ops::ControlFlow;

use smallvec::SmallVec;

use super::tracking::{MOST_COLLISIONS, exp_neg, roulette};
use crate::{
    math::{PathRng, Rgb, Slot},
    volume::{medium::Segment, world::MediumRay},
};

/// Probability of one more comb than there are, beyond two.
const MORE_COMBS: f32 = 0.25;
/// The majorants' optical distance of a block.
const BLOCK_DEPTH: f32 = 2.0;
/// The golden ratio's fraction: jitters that advance by it never fall into step with the cells.
pub(super) const GOLDEN: f32 = 0.618_034;

/// One jittered place in each unit of a measure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comb {
    jitter: f32,
    /// Measure left to the next place.
    left: f32,
}

impl Comb {
    pub(super) fn new(jitter: f32) -> Self {
        Self { jitter, left: jitter }
    }

    /// The next place in (`t`, `end`), where the measure grows by `rate` per length.
    #[inline]
    pub(super) fn next(&mut self, rate: f32, t: f32, end: f32) -> Option<f32> {
        let ahead = rate * (end - t);
        if self.left >= ahead {
            self.left -= ahead;
            return None;
        }
        // However short the step, the walk moves on.
        let place = (t + self.left / rate).max(t.next_up());
        let advanced = self.jitter + GOLDEN;
        let jitter = if advanced < 1.0 { advanced } else { advanced - 1.0 };
        self.left = 1.0 - self.jitter + jitter;
        self.jitter = jitter;
        Some(place)
    }
}

/// Transmittance of the ray so far.
pub(super) struct Transmittance {
    /// The combs of the present block, each with its optical distance in it.
    combs: SmallVec<[(Comb, Rgb); 6]>,
    /// Places where a comb reads μ_t, for each unit of the majorants' optical distance.
    reads_per_depth: f32,
    /// The majorants' optical distance that is left of the block.
    depth_left: f32,
    /// T̂ of what lies before the block.
    before: Rgb,
    /// Places read so far.
    pub(super) reads: u32,
}

impl Transmittance {
    /// Starts at the beginning of a ray; `jitters` are those of the first two combs.
    pub(super) fn new(reads_per_depth: f32, jitters: [f32; 2], rng: &mut PathRng) -> Self {
        let mut estimate = Self {
            combs: SmallVec::new(),
            reads_per_depth,
            depth_left: BLOCK_DEPTH,
            before: Rgb::ONE,
            reads: 0,
        };
        estimate.set_combs(jitters, rng);
        estimate
    }

    fn set_combs(&mut self, jitters: [f32; 2], rng: &mut PathRng) {
        self.combs.clear();
        let mut add = |jitter| self.combs.push((Comb::new(jitter), Rgb::ZERO));
        jitters.into_iter().for_each(&mut add);
        while rng.uniform() < MORE_COMBS {
            add(rng.uniform());
        }
    }

    /// Moves on from `t` to `end` under a majorant; breaks where the walk ends.
    #[inline]
    pub(super) fn advance(
        &mut self,
        medium: &MediumRay,
        majorant: f32,
        mut t: f32,
        end: f32,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        while t < end && majorant > 0.0 {
            let depth = majorant * (end - t);
            if depth < self.depth_left {
                self.read(medium, majorant, t, end);
                self.depth_left -= depth;
                break;
            }
            // However short the block, the walk moves on.
            let block_end = (t + self.depth_left / majorant).max(t.next_up()).min(end);
            self.read(medium, majorant, t, block_end);
            self.end_block(rng)?;
            t = block_end;
        }
        ControlFlow::Continue(())
    }

    #[inline]
    fn read(&mut self, medium: &MediumRay, majorant: f32, t: f32, end: f32) {
        let rate = self.reads_per_depth * majorant;
        for (comb, x) in &mut self.combs {
            let mut t = t;
            while let Some(place) = comb.next(rate, t, end) {
                *x += medium.mu_t(place) / rate;
                t = place;
                self.reads += 1;
            }
        }
    }

    /// Ends the block and begins the next, with fewer reads, as segments behind many others matter
    /// less.
    fn end_block(&mut self, rng: &mut PathRng) -> ControlFlow<()> {
        self.before *= self.of_block();
        self.depth_left = BLOCK_DEPTH;
        self.reads_per_depth = (0.5 * self.reads_per_depth).max(1.0);
        let jitters = [rng.uniform(), rng.uniform()];
        self.set_combs(jitters, rng);
        if self.reads >= MOST_COLLISIONS {
            return ControlFlow::Break(());
        }
        roulette(&mut self.before, rng)
    }

    /// Crosses a uniform segment in closed form.
    pub(super) fn cross_uniform(
        &mut self,
        mu_t: Rgb,
        segment: &Segment,
        rng: &mut PathRng,
    ) -> ControlFlow<()> {
        self.before *= exp_neg(mu_t, segment.t1 - segment.t0);
        roulette(&mut self.before, rng)
    }

    /// T̂ up to here, unbiased.
    #[inline]
    pub(super) fn estimate(&self) -> Rgb {
        self.before * self.of_block()
    }

    #[inline]
    fn of_block(&self) -> Rgb {
        if let [(_, a), (_, b)] = self.combs.as_slice() {
            let apart = *a - *b;
            return 0.5 * (exp(-*a) * (Rgb::ONE + apart) + exp(-*b) * (Rgb::ONE - apart));
        }
        self.series()
    }

    /// The power series about each of the combs in turn, to as many terms as there are others.
    fn series(&self) -> Rgb {
        let others = self.combs.len() - 1;
        let mut sum = Rgb::ZERO;
        for (pivot, (_, about)) in self.combs.iter().enumerate() {
            // Elementary symmetric polynomials of the differences, one factor at a time.
            let mut symmetric: SmallVec<[Rgb; 8]> = SmallVec::from_elem(Rgb::ZERO, others + 1);
            symmetric[0] = Rgb::ONE;
            for (i, (_, x)) in self.combs.iter().enumerate().filter(|(i, _)| *i != pivot) {
                let top = if i < pivot { i + 1 } else { i };
                for k in (1..=top).rev() {
                    let lower = symmetric[k - 1];
                    symmetric[k] += (*about - *x) * lower;
                }
            }
            // Divided by the number of products and by k!, and by the probability of the term.
            let (mut term, mut scale) = (Rgb::ZERO, 1.0);
            for (k, polynomial) in symmetric.iter().enumerate() {
                if k > 0 {
                    scale /= (others + 1 - k) as f32;
                }
                if k > 1 {
                    scale /= MORE_COMBS;
                }
                term += *polynomial * scale;
            }
            sum += exp(-*about) * term;
        }
        sum / self.combs.len() as f32
    }
}

/// Transmittance along the whole medium by unbiased ray marching, with `reads` places of a comb for
/// each unit of the majorants' optical distance; also returns the number of reads.
pub(super) fn whole(
    mut medium: MediumRay,
    reads: f32,
    jitters: [Slot; 2],
    rng: &mut PathRng,
) -> (Rgb, u32) {
    let Some(mut segment) = medium.next_segment() else { return (Rgb::ONE, 0) };
    let jitters = jitters.map(|slot| rng.at(slot));
    let mut t_hat = Transmittance::new(reads, jitters, rng);
    loop {
        let crossed = if segment.uniform {
            t_hat.cross_uniform(medium.coefficients(segment.t0).mu_t, &segment, rng)
        } else {
            t_hat.advance(&medium, segment.majorant, segment.t0, segment.t1, rng)
        };
        if crossed.is_break() {
            break;
        }
        let Some(next) = medium.next_segment() else { break };
        segment = next;
    }
    // A walk that is cut may have read a few places more.
    (t_hat.estimate(), t_hat.reads.min(MOST_COLLISIONS))
}

/// exp per channel, at the cost of one where all are the same.
#[inline]
pub(super) fn exp(x: Rgb) -> Rgb {
    if x == Rgb::splat(x.x) { Rgb::splat(x.x.exp()) } else { x.exp() }
}

#[cfg(test)]
mod tests;
