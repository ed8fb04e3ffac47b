//! The distance density along one ray that the probes near it give: pieces, each falling
//! exponentially.

use smallvec::SmallVec;

/// Most pieces of a density; where there would be more, neighbors are joined.
const MOST_PIECES: usize = 64;
/// Share of the density that follows the scattering majorant alone, whatever the probes estimate.
/// Its inverse bounds the weights of places that the probes estimate as dark.
const EVEN_SHARE: f32 = 0.1;

/// A density over the parameter of a ray. The same table is used for sampling and for evaluation.
#[derive(Clone, Debug)]
pub struct DistancePdf {
    /// Transmittance T along the whole ray, estimated from the probes.
    transmittance: f32,
    /// Radiance scattered into the ray, estimated from the probes.
    in_scattered: f32,
    /// Second moment of an unguided flight's contribution, relative to the square of
    /// `in_scattered`.
    spread: f32,
    pieces: SmallVec<[Piece; MOST_PIECES]>,
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    t0: f32,
    /// End of the piece; infinite only in the last one.
    t1: f32,
    /// The density falls as exp(−falloff (t − t0)).
    falloff: f32,
    /// Probability of this piece.
    share: f32,
    /// Probability of all pieces before it.
    before: f32,
}

/// Estimates for a piece of a ray inside of one leaf and segment.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct RayPiece {
    /// Ray parameter at which the piece begins.
    pub(super) t0: f32,
    /// Ray parameter at which the piece ends; may be infinite.
    pub(super) t1: f32,
    /// Extinction, 1/length.
    pub(super) mu_t: f32,
    /// Upper bound of scattering, 1/length; zero only where nothing scatters.
    pub(super) majorant: f32,
    /// Radiance scattered back along the ray, per length.
    pub(super) scattered: f32,
}

impl RayPiece {
    /// Transmittance exp(−τ) of the piece.
    pub(in crate::transport) fn transmittance(&self) -> f32 {
        (-self.mu_t * (self.t1 - self.t0)).exp()
    }

    /// ∫ T dt over the piece, T being 1 at its beginning.
    pub(in crate::transport) fn absorbed(&self) -> f32 {
        mass(self.mu_t, self.t1 - self.t0)
    }

    /// Ray parameter of the middle of the piece.
    pub(in crate::transport) fn middle(&self) -> f32 {
        0.5 * (self.t0 + self.t1)
    }
}

/// Collects pieces of a ray from near to far.
#[derive(Debug)]
pub(super) struct DistancePdfBuilder {
    /// Pieces with the estimate of their light in `share` and of their scattering majorant in
    /// `before`.
    pieces: SmallVec<[Piece; MOST_PIECES]>,
    /// Transmittance exp(−τ) of all pieces so far.
    transmittance: f32,
    /// Σ light²/P, P the probability that an unguided flight ends in a piece.
    square: f32,
    /// Number of added pieces that are joined to one, and of those in the last one so far.
    stride: u32,
    held: u32,
}

impl DistancePdfBuilder {
    pub(super) fn new() -> Self {
        Self { pieces: SmallVec::new(), transmittance: 1.0, square: 0.0, stride: 1, held: 0 }
    }

    /// Adds the next piece of the ray.
    pub(super) fn add(&mut self, ray_piece: &RayPiece) {
        let RayPiece { t0, t1, mu_t, majorant, scattered } = *ray_piece;
        let depth = mu_t * (t1 - t0);
        let lost = -(-depth).exp_m1();
        let absorbed = if depth < FLAT { t1 - t0 } else { lost / mu_t };
        let light = self.transmittance * scattered * absorbed;
        let matter = majorant * absorbed;
        if !(matter > 0.0 && matter.is_finite()) {
            return;
        }
        let light = if light.is_finite() { light } else { 0.0 };
        if light > 0.0 {
            self.square += light * (light / (self.transmittance * lost));
        }
        self.transmittance *= 1.0 - lost;
        let piece = Piece { t0, t1, falloff: mu_t, share: light, before: matter };
        self.held += 1;
        match self.pieces.last_mut() {
            Some(last) if self.held <= self.stride && t1.is_finite() => {
                *last = joined(last, &piece)
            }
            _ => self.push(piece),
        }
    }

    /// Transmittance exp(−τ) of all pieces that were added.
    pub(super) fn transmittance(&self) -> f32 {
        self.transmittance
    }

    fn push(&mut self, piece: Piece) {
        if self.pieces.len() == MOST_PIECES {
            for i in 0..MOST_PIECES / 2 {
                self.pieces[i] = joined(&self.pieces[2 * i], &self.pieces[2 * i + 1]);
            }
            self.pieces.truncate(MOST_PIECES / 2);
            self.stride *= 2;
        }
        self.pieces.push(piece);
        self.held = 1;
    }

    /// The density; `None` where nothing scatters.
    pub(super) fn finish(self) -> Option<DistancePdf> {
        let mut pieces = self.pieces;
        let light: f32 = pieces.iter().map(|piece| piece.share).sum();
        let matter: f32 = pieces.iter().map(|piece| piece.before).sum();
        if !(matter > 0.0 && matter.is_finite()) {
            return None;
        }
        let lit = light > 0.0 && light.is_finite();
        let mut before = 0.0;
        for piece in &mut pieces {
            let even = piece.before / matter;
            let guided = if lit { piece.share / light } else { even };
            piece.share = even + (1.0 - EVEN_SHARE) * (guided - even);
            piece.before = before;
            before += piece.share;
        }
        let (in_scattered, spread) =
            if lit { (light, self.square / light / light) } else { (0.0, 1.0) };
        Some(DistancePdf { transmittance: self.transmittance, in_scattered, spread, pieces })
    }
}

/// Joins two adjacent finite pieces.
fn joined(a: &Piece, b: &Piece) -> Piece {
    let (share, before) = (a.share + b.share, a.before + b.before);
    Piece { t0: a.t0, t1: b.t1, falloff: 0.0, share, before }
}

impl DistancePdf {
    /// Transmittance T along the whole ray, estimated from the probes.
    pub fn transmittance(&self) -> f32 {
        self.transmittance
    }

    /// Radiance scattered into the ray, estimated from the probes; 0 where they estimate none.
    pub fn in_scattered(&self) -> f32 {
        self.in_scattered
    }

    /// Variance of an unguided flight's contribution, relative to the square of its mean. 0 where
    /// every flight contributes the same.
    pub fn missed(&self) -> f32 {
        (self.spread - 1.0).max(0.0)
    }

    /// A parameter with density [`DistancePdf::pdf`], from `u` in [0, 1).
    pub fn sample(&self, u: f32) -> f32 {
        let index = self.pieces.partition_point(|piece| piece.before <= u).max(1) - 1;
        let piece = &self.pieces[index];
        let within = ((u - piece.before) / piece.share).clamp(0.0, 1.0 - f32::EPSILON);
        let length = piece.t1 - piece.t0;
        let depth = piece.falloff * length;
        let t = if depth < FLAT {
            piece.t0 + within * length
        } else {
            piece.t0 - (within * (-depth).exp_m1()).ln_1p() / piece.falloff
        };
        t.clamp(piece.t0, piece.t1)
    }

    /// Density at parameter `t`, 1/length.
    pub fn pdf(&self, t: f32) -> f32 {
        let index = self.pieces.partition_point(|piece| piece.t0 <= t);
        let Some(piece) = index.checked_sub(1).map(|index| &self.pieces[index]) else { return 0.0 };
        if t > piece.t1 {
            return 0.0;
        }
        let falloff =
            if piece.falloff * (piece.t1 - piece.t0) < FLAT { 0.0 } else { piece.falloff };
        piece.share * (-falloff * (t - piece.t0)).exp() / mass(falloff, piece.t1 - piece.t0)
    }
}

/// Optical distance below which a piece counts as flat.
const FLAT: f32 = 1e-3;

/// ∫₀^length exp(−falloff t) dt.
fn mass(falloff: f32, length: f32) -> f32 {
    let depth = falloff * length;
    if depth < FLAT { length } else { -(-depth).exp_m1() / falloff }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::PathRng, sampling::chi2::assert_numbers_follow};

    fn line(pieces: &[RayPiece]) -> DistancePdf {
        let mut builder = DistancePdfBuilder::new();
        pieces.iter().for_each(|ray_piece| builder.add(ray_piece));
        builder.finish().unwrap()
    }

    fn ray_piece(t0: f32, t1: f32, mu_t: f32, scattered: f32) -> RayPiece {
        RayPiece { t0, t1, mu_t, majorant: 0.5 + mu_t, scattered }
    }

    /// Bright and dark, thin and thick pieces, a gap, a tail without end.
    fn mixed() -> DistancePdf {
        line(&[
            ray_piece(1.0, 2.0, 0.0, 1.0),
            ray_piece(2.0, 2.5, 3.0, 20.0),
            ray_piece(4.0, 7.0, 1e-5, 0.0),
            ray_piece(7.0, 8.0, 40.0, 5.0),
            ray_piece(8.0, f32::INFINITY, 0.25, 0.1),
        ])
    }

    /// The density integrates to one, and samples follow it: their share below t is its integral up
    /// to t.
    #[test]
    fn samples_follow_the_density() {
        let line = mixed();
        let n = 400_000;
        let (mut integral, end) = (0.0, 100.0);
        let mut checked = 0;
        for i in 0..n {
            let t = end * (i as f32 + 0.5) / n as f32;
            integral += f64::from(line.pdf(t)) * f64::from(end) / f64::from(n);
            if i % 5000 == 2500 {
                // The inverse of the distribution, by bisection on u.
                let (mut low, mut high) = (0.0_f32, 1.0_f32);
                for _ in 0..24 {
                    let middle = 0.5 * (low + high);
                    if line.sample(middle) <= t { low = middle } else { high = middle }
                }
                assert!((f64::from(low) - integral).abs() < 2e-4, "{t}: {low} for {integral}");
                checked += 1;
            }
        }
        assert!(checked > 50 && (integral - 1.0).abs() < 1e-3, "{integral}");
    }

    #[test]
    fn every_draw_has_a_density_and_gaps_have_none() {
        let line = mixed();
        for i in 0..100_000 {
            let t = line.sample(i as f32 / 100_000.0);
            assert!(line.pdf(t) > 0.0 && t.is_finite(), "{t}");
            assert!(!(2.51..3.99).contains(&t));
        }
        assert_eq!((line.pdf(3.0), line.pdf(0.5)), (0.0, 0.0));
    }

    /// However many pieces there are, the whole ray is covered and the bright place stays bright.
    #[test]
    fn many_pieces_are_joined() {
        let all: Vec<RayPiece> = (0..1000)
            .map(|i| ray_piece(i as f32, i as f32 + 1.0, 1e-4, if i == 700 { 1e3 } else { 1.0 }))
            .collect();
        let line = line(&all);
        assert!(line.pieces.len() <= MOST_PIECES);
        assert!((0..1000).all(|i| line.pdf(i as f32 + 0.5) > 0.0));
        assert!(line.pdf(700.5) > 10.0 * line.pdf(100.5));
    }

    #[test]
    fn unusable_pieces_give_no_density() {
        assert!(DistancePdfBuilder::new().finish().is_none());
        let mut builder = DistancePdfBuilder::new();
        builder.add(&RayPiece { majorant: f32::NAN, ..ray_piece(0.0, 1.0, 1.0, 1.0) });
        builder.add(&RayPiece { majorant: f32::INFINITY, ..ray_piece(0.0, 1.0, 1.0, 1.0) });
        assert!(builder.finish().is_none());
        let light = line(&[RayPiece { scattered: f32::INFINITY, ..ray_piece(0.0, 2.0, 0.0, 1.0) }]);
        assert_eq!(light.pdf(1.0), 0.5);
    }

    /// Bins end where pieces do.
    #[test]
    fn counts_follow_the_density() {
        let ends = [1.0, 2.0, 2.5, 4.0, 7.0, 8.0, 20.0, 40.0];
        let parts = |pair: &[f32]| {
            let [from, to] = [pair[0], pair[1]];
            (0..24).map(move |i| from + (to - from) * i as f32 / 24.0)
        };
        let edges: Vec<f32> = ends.windows(2).flat_map(parts).chain([40.0]).collect();
        let line = mixed();
        let sample = |rng: &mut PathRng| Some(line.sample(rng.uniform())).filter(|t| *t < 40.0);
        assert_numbers_follow("line", &edges, sample, |t| line.pdf(t));
    }
}
