//! Light scores around a place: the visibility of the best few lights, and the share of the choices
//! that is left to the hierarchy for all others.
//!
//! At a receiver x light l is chosen with probability q_l(x) = s_l(x) + r h_l(x), where h_l is the
//! hierarchy's and r, the share that is left to it, never vanishes: whatever the scores, each light
//! that can contribute may be chosen. Scores are relative to the hierarchy's estimate of the
//! unoccluded light, so that they hold around the place: s_l(x) is proportional to the estimate at
//! x.

/// Most lights that are scored individually at a place.
pub const BEST: usize = 8;
/// Least share of the choices that is left to the hierarchy. Its inverse bounds the weight of a
/// light that the scores underestimate.
const LEAST_REST: f32 = 0.3;
/// Number of samples with full visibility that every light is assumed to have beside its own.
const DOUBT: f32 = 0.25;

/// Visibility of one light from a point near a place, estimated by a shadow ray.
#[derive(Clone, Copy, Debug)]
pub struct Visibility {
    /// Index of the light in the scene, as the hierarchy chose it.
    pub light: u32,
    /// Transmittance, 0 to 1, from the light to the point.
    pub seen: f32,
    /// The hierarchy's estimate of the unoccluded irradiance, over the probability of choosing the
    /// light.
    pub guess: f32,
}

/// Scores of the lights around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightScores {
    /// Lights with their visibility, the brightest first; 0 where there are no more.
    best: [(u32, f32); BEST],
    /// The share r of the choices that is left to the hierarchy.
    rest: f32,
}

/// A distribution over the lights at one receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightProbabilities {
    /// Lights with s_l, which sum to 1 − r.
    best: [(u32, f32); BEST],
    /// The share r of the choices that is left to the hierarchy.
    rest: f32,
}

/// Mean of several visibility samples of one light.
#[derive(Clone, Copy, Debug)]
struct LightTally {
    light: u32,
    /// Mean visibility of the light.
    seen: f32,
    /// Estimated irradiance of the light, times the number of all samples.
    found: f32,
    samples: f32,
}

impl LightScores {
    /// Scores from samples that the hierarchy has chosen, in any order; `None` where no light is
    /// visible.
    ///
    /// With S_l the share of light l in the visible light and h_l its share of the samples, lights
    /// that are not scored individually share r = Σ S_l / Σ h_l over them.
    pub fn new(visibilities: &mut [Visibility]) -> Option<Self> {
        visibilities.sort_by_key(|visibility| visibility.light);
        let mut tallies: Vec<LightTally> =
            visibilities.chunk_by(|a, b| a.light == b.light).map(LightTally::new).collect();
        tallies.sort_by(|a, b| b.found.total_cmp(&a.found));
        let sums = |of: &[LightTally]| {
            of.iter().fold((0.0, 0.0), |(found, samples), t| (found + t.found, samples + t.samples))
        };
        let (found, samples) = sums(&tallies);
        if !(found > 0.0 && found.is_finite()) {
            return None;
        }
        let (named, others) = tallies.split_at(BEST.min(tallies.len()));
        let (found_of_others, samples_of_others) = sums(others);
        let rest = (found_of_others / found) / (samples_of_others / samples).max(f32::MIN_POSITIVE);
        let rest = rest.clamp(LEAST_REST, 1.0);
        let mut best = [(0, 0.0); BEST];
        for (slot, tally) in best.iter_mut().zip(named) {
            *slot = (tally.light, tally.seen);
        }
        Some(Self { best, rest })
    }

    /// The distribution at a receiver where `guess` estimates the unoccluded irradiance of a scored
    /// light.
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
    /// Mean of the samples of one light, of which there is at least one. Few samples don't prove
    /// that a light is hidden everywhere.
    fn new(visibilities: &[Visibility]) -> Self {
        let samples = visibilities.len() as f32;
        let sum = |of: fn(&Visibility) -> f32| visibilities.iter().map(of).sum::<f32>();
        let seen = (sum(|g| g.seen) + DOUBT) / (samples + DOUBT);
        Self { light: visibilities[0].light, seen, found: seen * sum(|g| g.guess), samples }
    }
}

impl LightProbabilities {
    /// The light that `pick`, in [0, 1), chooses by its score, or the pick that is left to the
    /// hierarchy.
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
