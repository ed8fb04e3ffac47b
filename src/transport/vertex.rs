//! A vertex of a path, on a surface or in a volume, behind one interface: evaluation, density and
//! sampling of directions.

use std::f32::consts::PI;

use glam::{Vec2, Vec3A};

use crate::light::Receiver;
use crate::math::{PathRng, Ray, Rgb, Slot, mean};
use crate::sampling::guiding_mixture::GuidingMixture;
use crate::surface::{Bsdf, Hit, Intersection};
use crate::volume::phase::PhaseMix;

/// Share of a vertex's rough value that is the same for all directions.
const SHARE_OF_EVEN: f32 = 0.2;

/// A vertex of a path: a scattering event or a reflection.
#[derive(Clone, Debug)]
pub struct Vertex {
    /// Position in world space.
    pub position: Vec3A,
    /// Time of the path, as rays have it.
    pub time: f32,
    kind: VertexKind,
}

#[derive(Clone, Debug)]
enum VertexKind {
    Volume { phase: PhaseMix, forward: Vec3A },
    Surface { bsdf: Bsdf, offset: f32 },
}

/// A direction drawn at a vertex.
#[derive(Clone, Copy, Debug)]
pub struct DirectionSample {
    /// The unit direction.
    pub direction: Vec3A,
    /// Value over density.
    pub weight: Rgb,
    /// Density over solid angle of BSDF or phase sampling alone, 1/sr.
    pub pdf_solid_angle: f32,
    /// Ratio of the mixture density with guiding to that of BSDF or phase sampling alone.
    pub guiding_ratio: f32,
}

impl Vertex {
    /// A vertex on the surface at the end of `ray`; `None` for black surfaces.
    pub fn reflecting(end: &Intersection, ray: &Ray) -> Option<Self> {
        let bsdf = || Bsdf::new(end.surface.material, end.hit.normal, -ray.direction);
        let surface = || Self { time: ray.time, ..Self::surface(&end.hit, bsdf()) };
        end.surface.reflects().then(surface)
    }

    /// A vertex in a volume at parameter `t` of the ray that the path came along.
    pub fn volume(ray: &Ray, t: f32, phase: PhaseMix) -> Self {
        let kind = VertexKind::Volume { phase, forward: ray.direction };
        Self { position: ray.at(t), time: ray.time, kind }
    }

    /// A vertex on a surface, at the time of the frame.
    pub fn surface(hit: &Hit, bsdf: Bsdf) -> Self {
        let kind = VertexKind::Surface { bsdf, offset: hit.offset() };
        Self { position: hit.point, time: 0.0, kind }
    }

    /// Whether the vertex lies on a surface.
    pub fn is_surface(&self) -> bool {
        matches!(self.kind, VertexKind::Surface { .. })
    }

    /// Whether the vertex scatters into all directions, as all but metals do.
    pub fn is_broad(&self) -> bool {
        match &self.kind {
            VertexKind::Volume { .. } => true,
            VertexKind::Surface { bsdf, .. } => !bsdf.is_metal(),
        }
    }

    /// The share of light from the unit `direction` that goes on along the path (for a surface
    /// with its cosine), and the density [`Vertex::sample`] draws it with.
    pub fn eval(&self, direction: Vec3A) -> (Rgb, f32) {
        match &self.kind {
            VertexKind::Volume { phase, forward } => phase.eval(*forward, direction),
            VertexKind::Surface { bsdf, .. } => bsdf.eval(direction),
        }
    }

    /// A rough estimate of the share of light from around the unit `direction` that goes on along
    /// the path; above zero, since a light is more than its middle.
    pub fn rough_value(&self, direction: Vec3A) -> f32 {
        const EVEN: f32 = SHARE_OF_EVEN / (4.0 * PI);
        EVEN + (1.0 - SHARE_OF_EVEN) * mean(self.eval(direction).0)
    }

    /// Draws the direction the path goes on along; `None` where it ends.
    pub fn sample(&self, rng: &mut PathRng) -> Option<DirectionSample> {
        let pick = rng.at(Slot::DirectionPick);
        let u = Vec2::new(rng.at(Slot::DirectionX), rng.at(Slot::DirectionY));
        let direction = match &self.kind {
            VertexKind::Volume { phase, forward } => phase.sample(*forward, pick, u),
            VertexKind::Surface { bsdf, .. } => bsdf.sample(u)?,
        };
        let (value, pdf_solid_angle) = self.eval(direction);
        (pdf_solid_angle > 0.0).then(|| DirectionSample {
            direction,
            weight: value / pdf_solid_angle,
            pdf_solid_angle,
            guiding_ratio: 1.0,
        })
    }

    /// [`Vertex::sample`], or one of the directions of `guiding` with their shares; the weight is
    /// over the mixture of all. The density is still that of [`Vertex::sample`]: MIS with light
    /// samples is by that alone, and as those do the same the weights of both sum to one.
    pub fn sample_guided(
        &self,
        guiding: &GuidingMixture,
        rng: &mut PathRng,
    ) -> Option<DirectionSample> {
        let pick = rng.at(Slot::DirectionPick);
        let u = Vec2::new(rng.at(Slot::DirectionX), rng.at(Slot::DirectionY));
        let share = guiding.share();
        let direction = match &self.kind {
            _ if pick < share => guiding.sample(pick, u)?,
            VertexKind::Volume { phase, forward } => {
                phase.sample(*forward, (pick - share) / (1.0 - share), u)
            }
            VertexKind::Surface { bsdf, .. } => bsdf.sample(u)?,
        };
        let (value, pdf_solid_angle) = self.eval(direction);
        let mixture = (1.0 - share) * pdf_solid_angle + guiding.pdf_times_share(direction);
        let met = mixture > 0.0 && value.max_element() > 0.0;
        met.then(|| DirectionSample {
            direction,
            weight: value / mixture,
            pdf_solid_angle,
            guiding_ratio: mixture / pdf_solid_angle,
        })
    }

    /// The ray that leaves along `direction` without meeting the surface it starts on.
    pub fn ray(&self, direction: Vec3A) -> Ray {
        Ray { origin: self.receiver().position, direction, time: self.time }
    }

    /// Receiver at the vertex for light samples: the origin of every ray that leaves, and the side
    /// it leaves from.
    pub fn receiver(&self) -> Receiver {
        match &self.kind {
            VertexKind::Volume { .. } => Receiver { position: self.position, normal: None },
            VertexKind::Surface { bsdf, offset } => {
                let normal = bsdf.normal();
                Receiver { position: self.position + *offset * normal, normal: Some(normal) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::airlight::Airlight;
    use crate::sampling::chi2::Sphere;
    use crate::sampling::guiding_mixture::GuidingLobe;
    use crate::sampling::von_mises_fisher::VonMisesFisher;

    /// Directions by chance and towards light, as dense as the mixture that the weight is over.
    #[test]
    fn guided_directions_follow_the_mixture() {
        let axis = Vec3A::new(0.2, 1.0, 0.3).normalize();
        let mut phase = PhaseMix::default();
        phase.add(&crate::volume::phase::Phase::of(0.6), Rgb::ONE);
        let vertex = Vertex::volume(&Ray::new(Vec3A::ZERO, Vec3A::X), 0.0, phase);
        let mut guiding = GuidingMixture::default();
        guiding.add(0.3, GuidingLobe::Airlight(Airlight::new(axis, 0.5)));
        guiding.add(0.2, GuidingLobe::Caustic(VonMisesFisher::new(axis, 40.0)));
        let mixture = |direction| {
            let by_chance = vertex.eval(direction).1;
            (1.0 - guiding.share()) * by_chance + guiding.pdf_times_share(direction)
        };
        let sample = |rng: &mut PathRng| {
            let turn = vertex.sample_guided(&guiding, rng).unwrap();
            let expected = mixture(turn.direction);
            assert!(
                (turn.guiding_ratio * turn.pdf_solid_angle - expected).abs() <= 1e-4 * expected
            );
            let value = vertex.eval(turn.direction).0.x;
            assert!((turn.weight.x * expected - value).abs() <= 1e-4 * value);
            Some(turn.direction)
        };
        Sphere::narrow(axis, 0.01).assert_follows("mixture", sample, mixture);
    }
}
