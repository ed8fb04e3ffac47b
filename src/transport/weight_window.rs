//! The weight window: a path that is expected to contribute much more than a flight of its pixel is
//! split, one that contributes much less meets Russian roulette (Vorba and Křivánek 2016,
//! *Adjoint-Driven Russian Roulette and Splitting in Light Transport Simulation*).
//!
//! Guides draw from mixtures, and each draw adds to the spread of a path's weight; the window
//! reduces it before it compounds. The expected contribution of a path comes from the probes, fixed
//! before the path. The picture is unbiased whatever they estimate: the number of branches times
//! their factor is 1 on average.

use crate::math::PathRng;

/// Values, relative to the expected contribution of a flight, between which a path is neither split
/// nor ended.
const WINDOW: [f32; 2] = [0.33, 1.67];
/// Most splits of a path at one vertex.
const MOST_SPLITS: f32 = 8.0;
/// Least survival probability: probes underestimate places that are brighter than their
/// surroundings.
const LEAST_SURVIVAL: f32 = 0.3;
/// Most branches of one sample: where probes misjudge the light, splits beget splits.
pub(super) const MOST_BRANCHES: u32 = 128;
/// Most nested splits; each takes space on the stack.
pub(super) const MOST_NESTED: u32 = 24;

/// Number of continuations of a path from a vertex, and the factor of the throughput of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Splitting {
    pub(super) count: u32,
    pub(super) factor: f32,
}

impl Splitting {
    /// Draws the splitting of a path of `value`. A path of small value ends by roulette only if it
    /// is dim as well: `brightness` is its throughput relative to one worth keeping. In white media
    /// most paths are long and bright, and the probes estimate their contribution only roughly.
    pub(super) fn draw(value: f32, brightness: f32, may_split: bool, rng: &mut PathRng) -> Self {
        if value > WINDOW[1] && may_split {
            let wanted = value.min(MOST_SPLITS);
            return Self { count: (wanted + rng.uniform()) as u32, factor: 1.0 / wanted };
        }
        let survival = (value / WINDOW[0]).max(brightness).clamp(LEAST_SURVIVAL, 1.0);
        if survival < 1.0 && rng.uniform() >= survival {
            return Self { count: 0, factor: 0.0 };
        }
        Self { count: 1, factor: 1.0 / survival }
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    /// Splits times factor is 1 on average, within four standard errors; whatever the value.
    #[test]
    fn nothing_is_lost_or_gained() {
        const DRAWS: u32 = 100_000;
        let values = [0.0, 0.1, 0.2, 0.5, 1.0, 1.9, 3.3, 50.0, f32::INFINITY, f32::NAN];
        for (index, value) in values.into_iter().enumerate() {
            for (brightness, may_split) in [(0.0, true), (0.5, true), (2.0, false)] {
                let (mut sum, mut squares) = (0.0, 0.0);
                let mut rng = PathRng::new(0, UVec2::new(index as u32, 0), 0);
                for _ in 0..DRAWS {
                    let splitting = Splitting::draw(value, brightness, may_split, &mut rng);
                    assert!(splitting.count <= 1 || may_split);
                    let found = f64::from(splitting.count) * f64::from(splitting.factor);
                    sum += found;
                    squares += found * found;
                }
                let mean = sum / f64::from(DRAWS);
                let error = ((squares / f64::from(DRAWS) - mean * mean) / f64::from(DRAWS)).sqrt();
                assert!((mean - 1.0).abs() <= 4.0 * error + 1e-6, "{value}: {mean} ± {error}");
            }
        }
    }
}
