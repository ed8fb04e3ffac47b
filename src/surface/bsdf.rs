//! Reflection: diffuse, rough metal, black. All are two-sided.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::{Vec2, Vec3A};

use crate::{
    math::{OrthonormalBasis, Rgb},
    sampling::warp::{cosine_hemisphere, cosine_hemisphere_pdf, uniform_disk},
};

/// Material of a surface: its reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Lambert's law.
    Diffuse {
        /// Albedo, 0 to 1.
        reflectance: Rgb,
    },
    /// A rough metal: GGX microfacets with height-correlated Smith masking and a Fresnel factor
    /// that is constant.
    Conductor {
        /// GGX roughness α.
        alpha: f32,
        /// The constant Fresnel factor, 0 to 1.
        reflectance: Rgb,
    },
    /// No reflection.
    Black,
}

/// The BSDF of a material at a point, oriented to the side it is seen from. Directions point away
/// from the point.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    material: Material,
    frame: OrthonormalBasis,
    /// The direction towards the viewer in the frame, above the horizon.
    outgoing: Vec3A,
}

impl Bsdf {
    /// The BSDF for the unit direction `outgoing` (away from the surface); `normal` may be of
    /// either side.
    pub fn new(material: Material, normal: Vec3A, outgoing: Vec3A) -> Self {
        let facing = if normal.dot(outgoing) < 0.0 { -normal } else { normal };
        let frame = OrthonormalBasis::around(facing);
        Self { material, frame, outgoing: frame.local_from_world(outgoing) }
    }

    /// Unit normal on the side of the outgoing direction.
    pub fn normal(&self) -> Vec3A {
        self.frame.normal
    }

    /// Whether the material is a metal.
    pub fn is_metal(&self) -> bool {
        matches!(self.material, Material::Conductor { .. })
    }

    /// BSDF times |cos θ| of the unit `incoming`, and the density over solid angle that
    /// [`Bsdf::sample`] draws it with.
    pub fn eval(&self, incoming: Vec3A) -> (Rgb, f32) {
        let incoming = self.frame.local_from_world(incoming);
        if incoming.z <= 0.0 || self.outgoing.z <= 0.0 {
            return (Rgb::ZERO, 0.0);
        }
        match self.material {
            Material::Diffuse { reflectance } => {
                (reflectance * (incoming.z * FRAC_1_PI), cosine_hemisphere_pdf(incoming.z))
            }
            Material::Conductor { alpha, reflectance } => {
                let half = (self.outgoing + incoming).normalize_or_zero();
                let d = ggx_distribution(alpha, half);
                let (lambda_o, lambda_i) = (lambda(alpha, self.outgoing), lambda(alpha, incoming));
                // D·G/(4 cos_o cos_i)·cos_i, and the density of visible normals over 4 (o·h).
                let value = d / (4.0 * self.outgoing.z * (1.0 + lambda_o + lambda_i));
                let pdf = d / (4.0 * self.outgoing.z * (1.0 + lambda_o));
                (reflectance * value, pdf)
            }
            Material::Black => (Rgb::ZERO, 0.0),
        }
    }

    /// Draws an incoming direction; `None` where nothing is reflected.
    pub fn sample(&self, u: Vec2) -> Option<Vec3A> {
        if self.outgoing.z <= 0.0 {
            return None;
        }
        let incoming = match self.material {
            Material::Diffuse { .. } => cosine_hemisphere(u),
            Material::Conductor { alpha, .. } => {
                let half = sample_visible_normal(alpha, self.outgoing, u);
                2.0 * self.outgoing.dot(half) * half - self.outgoing
            }
            Material::Black => return None,
        };
        (incoming.z > 0.0).then(|| self.frame.world_from_local(incoming))
    }
}

/// GGX distribution of microfacet normals (Walter et al. 2007, equation 33), its denominator
/// written as α² cos² + sin² so that smooth metals keep their digits.
fn ggx_distribution(alpha: f32, half: Vec3A) -> f32 {
    let a2 = alpha * alpha;
    let base = a2 * half.z * half.z + half.x * half.x + half.y * half.y;
    a2 / (PI * base * base)
}

/// Smith's Λ for GGX (Heitz 2014, equation 72).
fn lambda(alpha: f32, v: Vec3A) -> f32 {
    let cos2 = v.z * v.z;
    let tan2 = (1.0 - cos2).max(0.0) / cos2;
    0.5 * ((1.0 + alpha * alpha * tan2).sqrt() - 1.0)
}

/// Draws a microfacet normal visible from `outgoing` (Heitz 2018, *Sampling the GGX Distribution
/// of Visible Normals*).
fn sample_visible_normal(alpha: f32, outgoing: Vec3A, u: Vec2) -> Vec3A {
    let stretched = Vec3A::new(alpha * outgoing.x, alpha * outgoing.y, outgoing.z).normalize();
    let frame = OrthonormalBasis::around(stretched);
    let disk = uniform_disk(u);
    // The lower half of the disk is squeezed to where the hemisphere is visible.
    let s = 0.5 * (1.0 + stretched.z);
    let (x, y) = project_visible(&frame, disk, s);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let n = frame.world_from_local(Vec3A::new(x, y, z));
    Vec3A::new(alpha * n.x, alpha * n.y, n.z.max(1e-6)).normalize()
}

/// Maps a disk sample onto the visible part of the hemisphere around the frame's normal. The axis
/// to squeeze along is the frame's direction that leans towards the surface normal.
fn project_visible(frame: &OrthonormalBasis, disk: Vec2, s: f32) -> (f32, f32) {
    let up = Vec2::new(frame.tangent.z, frame.bitangent.z).normalize_or(Vec2::Y);
    let across = Vec2::new(-up.y, up.x);
    let (a, b) = (disk.dot(across), disk.dot(up));
    let b = (1.0 - s) * (1.0 - a * a).max(0.0).sqrt() + s * b;
    let p = a * across + b * up;
    (p.x, p.y)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use glam::UVec2;

    use super::*;
    use crate::{
        math::PathRng,
        sampling::{chi2::Sphere, warp::spherical},
    };

    /// Integrates value, density and the first moment of the density over the hemisphere.
    fn quadrature(bsdf: &Bsdf) -> (Rgb, f32, Vec3A) {
        let (n, m) = (2000, 400);
        let (mut value, mut total, mut moment) = (Rgb::ZERO, 0.0, Vec3A::ZERO);
        for i in 0..n {
            for j in 0..m {
                let cos_theta = (i as f32 + 0.5) / n as f32;
                let direction = spherical(cos_theta, TAU * (j as f32 + 0.5) / m as f32);
                let (f, pdf) = bsdf.eval(direction);
                let weight = TAU / (n * m) as f32;
                value += f * weight;
                total += pdf * weight;
                moment += direction * (pdf * weight);
            }
        }
        (value, total, moment)
    }

    #[test]
    fn samples_follow_their_density() {
        let white = Rgb::ONE;
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        for material in [
            Material::Diffuse { reflectance: white },
            Material::Conductor { alpha: 0.2, reflectance: white },
            Material::Conductor { alpha: 0.8, reflectance: white },
        ] {
            let outgoing = spherical(0.45, 1.1);
            let bsdf = Bsdf::new(material, Vec3A::Z, outgoing);
            let (value, total, moment) = quadrature(&bsdf);
            assert!(value.max_element() <= 1.001, "{material:?} gains energy");
            let n = 200_000;
            let (mut kept, mut mean) = (0.0, Vec3A::ZERO);
            for _ in 0..n {
                if let Some(d) = bsdf.sample(Vec2::new(rng.uniform(), rng.uniform())) {
                    kept += 1.0 / n as f32;
                    mean += d / n as f32;
                }
            }
            assert!((kept - total).abs() < 6e-3, "{material:?}: {kept} {total}");
            assert!((mean - moment).abs().max_element() < 8e-3, "{material:?}: {mean} {moment}");
        }
    }

    /// From steep to grazing views; what would leave below the surface is not drawn.
    #[test]
    fn counts_follow_the_density() {
        let reflectance = Rgb::ONE;
        for (cosine, phi) in [(0.95, 0.3), (0.45, 1.1), (0.1, 4.0)] {
            let outgoing = spherical(cosine, phi);
            for material in [
                Material::Diffuse { reflectance },
                Material::Conductor { alpha: 0.1, reflectance },
                Material::Conductor { alpha: 0.4, reflectance },
                Material::Conductor { alpha: 0.9, reflectance },
            ] {
                let bsdf = Bsdf::new(material, Vec3A::Z, outgoing);
                let sample =
                    |rng: &mut PathRng| bsdf.sample(Vec2::new(rng.uniform(), rng.uniform()));
                let name = format!("{material:?} seen at {cosine}");
                Sphere::even(Vec3A::Z).assert_follows(&name, sample, |d| bsdf.eval(d).1);
            }
        }
    }
}
