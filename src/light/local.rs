//! Point and spot lights. Inside a scattering medium their 1/d² has infinite variance, unlike that
//! of sphere lights.

use glam::Vec3A;

use super::emitter::Emitter;
use super::sample::LightSample;
use crate::math::{Aabb, Rgb, luminance};

/// A point light: the same intensity in all directions.
#[derive(Clone, Debug)]
pub struct Point {
    /// Position in world space.
    pub position: Vec3A,
    /// Radiant intensity, W/sr.
    pub intensity: Rgb,
}

/// A spot light: a cone of light with a soft edge.
#[derive(Clone, Debug)]
pub struct Spot {
    position: Vec3A,
    /// Unit axis of the cone.
    axis: Vec3A,
    intensity: Rgb,
    cos_edge: f32,
    /// Cosine of the angle to the axis inside of which the intensity is full.
    cos_full: f32,
}

impl Point {
    pub(super) fn emitter(&self) -> Emitter {
        let bounds = Aabb::new(self.position, self.position);
        Emitter { bounds, intensity: luminance(self.intensity), cone: None }
    }

    pub(super) fn sample(&self, from: Vec3A) -> Option<LightSample> {
        towards(self.position, from, self.intensity)
    }
}

impl Spot {
    /// A spot light aimed at `target`. `cone` is the cone's full angle in degrees; `blend`, 0 to 1,
    /// the share of the half angle over which the edge fades.
    pub fn new(position: Vec3A, target: Vec3A, intensity: Rgb, cone: f32, blend: f32) -> Self {
        let half = 0.5 * cone.to_radians();
        let axis = (target - position).normalize();
        let cos_full = (half * (1.0 - blend)).cos();
        Self { position, axis, intensity, cos_edge: half.cos(), cos_full }
    }

    pub(super) fn emitter(&self) -> Emitter {
        let bounds = Aabb::new(self.position, self.position);
        let cone = Some((self.axis, self.cos_edge));
        Emitter { bounds, intensity: luminance(self.intensity), cone }
    }

    pub(super) fn sample(&self, from: Vec3A) -> Option<LightSample> {
        towards(self.position, from, self.intensity_towards(from))
    }

    fn intensity_towards(&self, point: Vec3A) -> Rgb {
        let cos_theta = (point - self.position).normalize_or_zero().dot(self.axis);
        if cos_theta >= self.cos_full {
            return self.intensity;
        }
        let t = ((cos_theta - self.cos_edge) / (self.cos_full - self.cos_edge)).clamp(0.0, 1.0);
        self.intensity * (t * t * (3.0 - 2.0 * t))
    }
}

fn towards(position: Vec3A, from: Vec3A, intensity: Rgb) -> Option<LightSample> {
    let to_light = position - from;
    let distance = to_light.length();
    (distance > 0.0 && intensity.max_element() > 0.0).then(|| LightSample {
        direction: to_light / distance,
        distance,
        radiance: intensity / (distance * distance),
        pdf: 1.0,
        can_be_met: false,
    })
}
