//! What is known of the lights around a place: what the best few of them bring, by name, and what
//! is left to the hierarchy.
//!
//! At a receiver x light l is chosen with probability q_l(x) = s_l(x) + r h_l(x), where h_l is the
//! hierarchy's and r, the share that is left to it, never vanishes: whatever the scores say, each
//! light that can bring anything may be chosen. Scores are relative to the hierarchy's guess at an
//! unhindered light, so that they hold around the place: s_l(x) goes with the guess at x.

/// Most lights that a place knows by name.
pub const BEST: usize = 8;
/// Least share of the choices that is left to the hierarchy. It bounds by its inverse what a light
/// costs that the scores think dark.
const LEAST_REST: f32 = 0.3;
/// Looks that a light is taken to have been seen by whatever the others say.
const DOUBT: f32 = 0.25;

/// What a look at one of the lights tells of it from near a place.
#[derive(Clone, Copy, Debug)]
pub struct Visibility {
    /// The light, by its index in the scene; the hierarchy chose it.
    pub light: u32,
    /// The part of its light that is not hidden or dimmed.
    pub seen: f32,
    /// The hierarchy's guess at its unhindered light, over the probability of choosing it.
    pub guess: f32,
}

/// Scores of the lights around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scores {
    /// Lights with the part that is seen of them, the best first; 0 where there are no more.
    best: [(u32, f32); BEST],
    /// r.
    rest: f32,
}

/// A distribution over the lights at one receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightProbabilities {
    /// Lights with s_l, which sum to 1 − r.
    best: [(u32, f32); BEST],
    /// r.
    rest: f32,
}

/// What several looks tell of one light.
#[derive(Clone, Copy, Debug)]
struct LightTally {
    light: u32,
    /// Mean of what is seen of it.
    seen: f32,
    /// Its light, times the number of all looks.
    found: f32,
    looks: f32,
}

impl Scores {
    /// From looks that the hierarchy has chosen, in any order; `None` where none is known.
    ///
    /// With S_l the share of light l in what is seen and h_l its share of the looks, those without
    /// a name get theirs by r = Σ S_l / Σ h_l over them.
    pub fn new(visibilities: &mut [Visibility]) -> Option<Self> {
        visibilities.sort_by_key(|visibility| visibility.light);
        let mut tallies: Vec<LightTally> =
            visibilities.chunk_by(|a, b| a.light == b.light).map(LightTally::new).collect();
        tallies.sort_by(|a, b| b.found.total_cmp(&a.found));
        let sums = |of: &[LightTally]| {
            of.iter().fold((0.0, 0.0), |(found, looks), t| (found + t.found, looks + t.looks))
        };
        let (found, looks) = sums(&tallies);
        if !(found > 0.0 && found.is_finite()) {
            return None;
        }
        let (named, others) = tallies.split_at(BEST.min(tallies.len()));
        let (found_of_others, looks_of_others) = sums(others);
        let rest = (found_of_others / found) / (looks_of_others / looks).max(f32::MIN_POSITIVE);
        let rest = rest.clamp(LEAST_REST, 1.0);
        let mut best = [(0, 0.0); BEST];
        for (slot, tally) in best.iter_mut().zip(named) {
            *slot = (tally.light, tally.seen);
        }
        Some(Self { best, rest })
    }

    /// The distribution at a receiver where `guess` tells what to expect of a light by name.
    pub(super) fn at(&self, guess: impl Fn(u32) -> f32) -> LightProbabilities {
        let mut best = self.best;
        let mut total = 0.0;
        for (light, score) in best.iter_mut().filter(|named| named.1 > 0.0) {
            *score *= guess(*light);
            total += *score;
        }
        if !(total >= f32::MIN_POSITIVE && total.is_finite()) {
            return LightProbabilities { best: [(0, 0.0); BEST], rest: 1.0 };
        }
        let scale = (1.0 - self.rest) / total;
        best.iter_mut().for_each(|(_, share)| *share *= scale);
        LightProbabilities { best, rest: self.rest }
    }
}

impl LightTally {
    /// Of looks at one light, of which there is at least one. Few looks don't say that it is hidden
    /// for good.
    fn new(visibilities: &[Visibility]) -> Self {
        let looks = visibilities.len() as f32;
        let sum = |of: fn(&Visibility) -> f32| visibilities.iter().map(of).sum::<f32>();
        let seen = (sum(|g| g.seen) + DOUBT) / (looks + DOUBT);
        Self { light: visibilities[0].light, seen, found: seen * sum(|g| g.guess), looks }
    }
}

impl LightProbabilities {
    /// The light that `pick`, in [0, 1), chooses by name, or the pick that is left to the hierarchy.
    pub(super) fn pick(&self, pick: f64) -> Result<u32, f64> {
        let mut left = pick;
        for &(light, share) in &self.best {
            if left < f64::from(share) {
                return Ok(light);
            }
            left -= f64::from(share);
        }
        Err((left / f64::from(self.rest)).clamp(0.0, 1.0 - f64::EPSILON))
    }

    /// q_l of a light whose probability in the hierarchy is h_l.
    pub(super) fn probability(&self, light: u32, hierarchy: f32) -> f32 {
        let named = self.best.iter().filter(|named| named.0 == light);
        named.map(|named| named.1).sum::<f32>() + self.rest * hierarchy
    }
}
