//! The density along one ray that the probes near it give: pieces, falling exponentially inside.

use smallvec::SmallVec;

/// Most pieces of a line; where there would be more, neighbors are joined.
const MOST_PIECES: usize = 64;
/// Share that goes to all scattering matter on the ray alike, whatever the probes say. It bounds
/// by its inverse what a place costs that the probes think dark.
const SHARE_OF_MATTER: f32 = 0.1;

/// A density over the parameter of a ray. The very same table draws and weighs.
#[derive(Clone, Debug)]
pub struct DistancePdf {
    /// T of all of it, as the probes think.
    transmittance: f32,
    /// Radiance scattered into it, as they think.
    light: f32,
    /// Second moment of an unguided flight's find of it, relative to the square of `light`.
    spread: f32,
    pieces: SmallVec<[Piece; MOST_PIECES]>,
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    t0: f32,
    /// Infinite at most in the last.
    t1: f32,
    /// The density falls as exp(−falloff (t − t0)).
    falloff: f32,
    /// Probability of this piece.
    share: f32,
    /// Probability of all pieces before it.
    before: f32,
}

/// What a stretch of a ray is thought to hold.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct RayPiece {
    /// Where it begins.
    pub(super) t0: f32,
    /// Where it ends; may be infinite.
    pub(super) t1: f32,
    /// Extinction, 1/length.
    pub(super) mu_t: f32,
    /// Upper bound of what it scatters, 1/length; zero only where nothing does.
    pub(super) majorant: f32,
    /// Radiance scattered back along the ray, per length.
    pub(super) scattered: f32,
}

impl RayPiece {
    /// exp(−τ) of it.
    pub(in crate::transport) fn transmittance(&self) -> f32 {
        (-self.mu_t * (self.t1 - self.t0)).exp()
    }

    /// ∫ T dt over it, T being 1 where it begins.
    pub(in crate::transport) fn absorbed(&self) -> f32 {
        mass(self.mu_t, self.t1 - self.t0)
    }

    /// The parameter in its middle.
    pub(in crate::transport) fn middle(&self) -> f32 {
        0.5 * (self.t0 + self.t1)
    }
}

/// Collects stretches from near to far.
#[derive(Debug)]
pub(super) struct DistancePdfBuilder {
    /// With the guess at their light in `share` and their matter in `before`.
    pieces: SmallVec<[Piece; MOST_PIECES]>,
    /// exp(−τ) of all before.
    transmittance: f32,
    /// Σ light²/P, P the probability that an unguided flight ends in a stretch.
    square: f32,
    /// Stretches in a piece, and in the last one so far.
    stride: u32,
    held: u32,
}

impl DistancePdfBuilder {
    pub(super) fn new() -> Self {
        Self { pieces: SmallVec::new(), transmittance: 1.0, square: 0.0, stride: 1, held: 0 }
    }

    /// Adds what comes next.
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

    /// exp(−τ) of all that was added.
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
            piece.share = even + (1.0 - SHARE_OF_MATTER) * (guided - even);
            piece.before = before;
            before += piece.share;
        }
        let (light, spread) = if lit { (light, self.square / light / light) } else { (0.0, 1.0) };
        Some(DistancePdf { transmittance: self.transmittance, light, spread, pieces })
    }
}

/// Two pieces that follow each other as one, both finite.
fn joined(a: &Piece, b: &Piece) -> Piece {
    let (share, before) = (a.share + b.share, a.before + b.before);
    Piece { t0: a.t0, t1: b.t1, falloff: 0.0, share, before }
}

impl DistancePdf {
    /// T of all of it, as the probes think.
    pub fn transmittance(&self) -> f32 {
        self.transmittance
    }

    /// Radiance scattered into it, as the probes think; 0 where they know of none.
    pub fn light(&self) -> f32 {
        self.light
    }

    /// How much an unguided flight misses of that light: the variance of what it finds, relative to
    /// the square of its mean. 0 where it finds the same whatever it does.
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

    fn line(stretches: &[RayPiece]) -> DistancePdf {
        let mut builder = DistancePdfBuilder::new();
        stretches.iter().for_each(|ray_piece| builder.add(ray_piece));
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

    /// The density integrates to one, and samples lie where it says: the share of them below t is
    /// its integral up to t.
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

    /// However many stretches there are, the whole way is covered and the bright place stays so.
    #[test]
    fn many_stretches_are_joined() {
        let all: Vec<RayPiece> = (0..1000)
            .map(|i| ray_piece(i as f32, i as f32 + 1.0, 1e-4, if i == 700 { 1e3 } else { 1.0 }))
            .collect();
        let line = line(&all);
        assert!(line.pieces.len() <= MOST_PIECES);
        assert!((0..1000).all(|i| line.pdf(i as f32 + 0.5) > 0.0));
        assert!(line.pdf(700.5) > 10.0 * line.pdf(100.5));
    }

    #[test]
    fn what_cannot_be_measured_gives_no_line() {
        assert!(DistancePdfBuilder::new().finish().is_none());
        let mut builder = DistancePdfBuilder::new();
        builder.add(&RayPiece { majorant: f32::NAN, ..ray_piece(0.0, 1.0, 1.0, 1.0) });
        builder.add(&RayPiece { majorant: f32::INFINITY, ..ray_piece(0.0, 1.0, 1.0, 1.0) });
        assert!(builder.finish().is_none());
        let light = line(&[RayPiece { scattered: f32::INFINITY, ..ray_piece(0.0, 2.0, 0.0, 1.0) }]);
        assert_eq!(light.pdf(1.0), 0.5);
    }
}
