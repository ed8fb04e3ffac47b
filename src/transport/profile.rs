//! Tabulated medium along one ray and densities of its scattering distances, for diagnostics, not
//! for rendering. All random numbers are fixed.

use glam::UVec2;

use super::{
    counts::Allocation,
    direct, distance,
    frame::PreparedFrame,
    path_setup::Guides,
    probes::{DistancePdf, Probes},
    scene::Scene,
    tracking::{event::EmissionGathering, exp_neg},
};
use crate::{
    light::Receiver,
    math::{PathRng, Ray, Rgb, luminance, mean},
    sampling::{equiangular::Equiangular, mis},
    surface,
    volume::{medium::Segment, world::MediumRay},
};

/// Places between two rows at which the medium is read.
const STEPS: u32 = 4;
/// Points of lights that p_select is averaged over.
const POINTS: u32 = 128;
/// Optical depth to which a medium without end is followed.
const DEEPEST: f32 = 7.0;
/// Places along a ray at which something may be seen.
const DEPTHS: u32 = 512;
/// Transmittance above which a medium hides too little to be what is looked at.
const MOSTLY_CLEAR: f32 = 0.9;
/// Fixed seed, which no picture is likely to use.
const SEED: u64 = 0x7072_6f66_696c_652e;

/// A table over the distance along a ray.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Rows in even steps from the beginning of the medium to its end, or to a surface.
    pub rows: Vec<ProfileRow>,
    /// Optical depth of the whole ray, from the channels' mean transmittance.
    pub optical_depth: f32,
    /// Whether anything could guide distances along the ray.
    pub guided: bool,
    /// Guided flights relative to the number that the probes propose; 0 where guiding does not pay
    /// in this picture.
    pub flights_scale: f32,
}

/// Values at one distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProfileRow {
    /// The distance from the ray's origin.
    pub t: f32,
    /// Extinction μ_t, mean of the channels, 1/length.
    pub mu_t: f32,
    /// Transmittance T from the origin, mean of the channels.
    pub transmittance: f32,
    /// Luminance of the emission ε, radiance/length.
    pub emission: f32,
    /// Density with which null-collision tracking scatters here, μ_t T, 1/length: the mean over the
    /// channels, which spectral MIS makes it. Where absorption gathers the emission, μ_s T instead.
    pub p_null: f32,
    /// Density with which the guides scatter here, 1/length: the mean over the points of lights
    /// that a path may draw.
    pub p_select: f32,
    /// MIS weight of null-collision tracking for scattering here.
    pub weight_null: f32,
    /// MIS weight of the guides for scattering here; both weights sum to 1 where anything scatters.
    pub weight_guided: f32,
}

impl Profile {
    /// Tabulates `count` rows, two at least, along a ray from the camera of `frame`; `None` where
    /// it meets no medium.
    ///
    /// T is integrated by the midpoint rule. The weights are those of the expected densities, as
    /// they would be were the transmittance known; a path has those of its own null collisions,
    /// which scatter around them.
    pub fn along(prepared: &PreparedFrame, ray: &Ray, count: u32) -> Option<Self> {
        let frame = prepared.frame();
        let scene: &Scene = &frame.scene;
        let end = surface::intersect(&scene.surfaces, ray);
        let medium = scene.world.along(*ray, end.map_or(f32::INFINITY, |end| end.hit.t));
        let (t0, end) = medium.extent()?;
        let t1 = if end.is_finite() { end } else { visible_end(medium.clone(), t0) };
        if !(t0 < t1 && t1.is_finite()) {
            return None;
        }
        let count = count.max(2);
        let step = (t1 - t0) / (count - 1) as f32;
        let mut rows: Vec<ProfileRow> = (0..count)
            .map(|i| ProfileRow { t: (t0 + i as f32 * step).min(t1), ..ProfileRow::default() })
            .collect();
        let gather = EmissionGathering::of(&scene.strategy);
        let optical_depth = read_medium(medium.clone(), gather, &mut rows, step);
        let guides = prepared.guides().filter(|_| scene.strategy.guides());
        let flights_scale = prepared.guided_flights();
        let guided = guides.is_some_and(|Guides { probes, brightness }| {
            let distance_pdf = probes.along(medium, ray);
            let allocation =
                Allocation::new(&scene.strategy, distance_pdf.as_ref(), brightness, flights_scale);
            let lights = match scene.strategy.advanced.equiangular {
                true => points_of_light(scene, probes, ray, [t0, end]),
                false => Vec::new(),
            };
            guide(distance_pdf.as_ref(), &lights, &allocation, &mut rows)
        });
        Some(Self { rows, optical_depth, guided, flights_scale })
    }
}

/// Distance along `ray` of what is seen there: the middle of the light of fire; else of what the
/// medium hides, where that is more than a tenth; else the surface at the end. `None` where there
/// is nothing to see.
pub fn depth_seen(scene: &Scene, ray: &Ray) -> Option<f32> {
    let surface = surface::intersect(&scene.surfaces, ray).map(|end| end.hit.t);
    let medium = scene.world.along(*ray, surface.unwrap_or(f32::INFINITY));
    let extent = medium
        .extent()
        .map(|(t0, end)| (t0, if end.is_finite() { end } else { visible_end(medium.clone(), t0) }));
    let Some((t0, t1)) = extent.filter(|(t0, t1)| t0 < t1 && t1.is_finite()) else {
        return surface;
    };
    let step = (t1 - t0) / (DEPTHS - 1) as f32;
    let row = |i| ProfileRow { t: t0 + i as f32 * step, ..ProfileRow::default() };
    let mut rows: Vec<ProfileRow> = (0..DEPTHS).map(row).collect();
    let optical_depth =
        read_medium(medium, EmissionGathering::of(&scene.strategy), &mut rows, step);
    let light = |row: &ProfileRow| row.transmittance * row.emission;
    let hidden = |row: &ProfileRow| row.transmittance * row.mu_t;
    let hides = (-optical_depth).exp() < MOSTLY_CLEAR;
    middle(&rows, light).or_else(|| middle(&rows, hidden).filter(|_| hides)).or(surface)
}

/// Distance at which half of the sum of `share` over all rows is reached; `None` where that is 0.
fn middle(rows: &[ProfileRow], share: impl Fn(&ProfileRow) -> f32) -> Option<f32> {
    let sum: f32 = rows.iter().map(&share).sum();
    let mut below = 0.0;
    let row = rows.iter().find(|row| {
        below += share(row);
        2.0 * below >= sum
    });
    row.filter(|_| sum > 0.0 && sum.is_finite()).map(|row| row.t)
}

/// Distance at which a medium without end has become dark.
fn visible_end(mut medium: MediumRay, t0: f32) -> f32 {
    let (mut depth, mut last) = (0.0, t0);
    while let Some(segment) = medium.next_segment() {
        if segment.t1.is_finite() {
            depth += mean(medium.mu_t(0.5 * (segment.t0 + segment.t1))) * (segment.t1 - segment.t0);
            last = segment.t1;
        } else {
            let left = (DEEPEST - depth).max(1.0);
            return segment.t0 + left / mean(medium.mu_t(segment.t0));
        }
    }
    last
}

/// Fills in the values of the medium; returns the optical depth of the whole ray.
fn read_medium(
    mut medium: MediumRay,
    gather: EmissionGathering,
    rows: &mut [ProfileRow],
    step: f32,
) -> f32 {
    let mut transmittance = Rgb::ONE;
    let mut next = 0;
    let last = rows.len() - 1;
    while let Some(segment) = medium.next_segment() {
        // Gaps are clear.
        while next <= last && rows[next].t < segment.t0 {
            rows[next].transmittance = mean(transmittance);
            next += 1;
        }
        let mut t = segment.t0;
        while next <= last && rows[next].t <= segment.t1 {
            transmittance *= crossed(&medium, &segment, t, rows[next].t, step);
            t = rows[next].t;
            read_point(&medium, gather, transmittance, &mut rows[next]);
            next += 1;
        }
        if next > last {
            break;
        }
        transmittance *= crossed(&medium, &segment, t, segment.t1, step);
    }
    rows[next.min(last + 1)..].iter_mut().for_each(|row| row.transmittance = mean(transmittance));
    -mean(transmittance).ln()
}

/// T of a part of a segment, per channel.
fn crossed(medium: &MediumRay, segment: &Segment, t0: f32, t1: f32, step: f32) -> Rgb {
    if segment.uniform {
        return exp_neg(medium.mu_t(segment.t0), t1 - t0);
    }
    let parts = (STEPS as f32 * (t1 - t0) / step).ceil().clamp(1.0, STEPS as f32) as u32;
    let length = (t1 - t0) / parts as f32;
    let depth = |i| medium.mu_t(t0 + (i as f32 + 0.5) * length) * length;
    (-(0..parts).map(depth).sum::<Rgb>()).exp()
}

fn read_point(
    medium: &MediumRay,
    gather: EmissionGathering,
    transmittance: Rgb,
    row: &mut ProfileRow,
) {
    let c = medium.coefficients(row.t);
    let scatters = if gather == EmissionGathering::Absorption { c.mu_s } else { c.mu_t };
    // A medium that absorbs without scattering draws no distance that is used.
    let scatters = if c.mu_s == Rgb::ZERO { Rgb::ZERO } else { scatters };
    row.mu_t = mean(c.mu_t);
    row.transmittance = mean(transmittance);
    row.emission = luminance(c.emission);
    row.p_null = mean(transmittance * scatters);
    row.weight_null = if row.p_null > 0.0 { 1.0 } else { 0.0 };
}

/// Fills in the densities and weights of the guides; returns whether there are any.
fn guide(
    distance_pdf: Option<&DistancePdf>,
    lights: &[Option<Equiangular>],
    allocation: &Allocation,
    rows: &mut [ProfileRow],
) -> bool {
    if distance_pdf.is_none() {
        return false;
    }
    for row in rows {
        let of_line = distance_pdf.map(|distance_pdf| distance_pdf.pdf(row.t));
        let sum = |pdfs: f32, light: &Option<Equiangular>| {
            let light = light.as_ref().map(|light| light.pdf(row.t));
            pdfs + distance::pdf_of_both(of_line, light)
        };
        row.p_select = match lights.len() {
            0 => distance::pdf_of_both(of_line, None),
            count => lights.iter().fold(0.0, sum) / count as f32,
        };
        (row.weight_null, row.weight_guided) = weights(row, allocation);
    }
    true
}

/// The equiangular densities that a path may draw from.
fn points_of_light(
    scene: &Scene,
    probes: &Probes,
    ray: &Ray,
    [t0, t1]: [f32; 2],
) -> Vec<Option<Equiangular>> {
    let from = Receiver { position: distance::middle(ray, t0, t1), normal: None };
    let choice = direct::choice(&scene.strategy);
    let equiangular = |sample| {
        let mut rng = PathRng::new(SEED, UVec2::ZERO, sample);
        let point = direct::point_of_light(scene, &from, &choice, &mut rng)?;
        Equiangular::new(ray, point, probes.mean_cosine(), t0, t1)
    };
    (0..POINTS).map(equiangular).collect()
}

/// The MIS weights of both strategies.
fn weights(row: &ProfileRow, allocation: &Allocation) -> (f32, f32) {
    if row.p_null <= 0.0 {
        return (0.0, 0.0);
    }
    if allocation.alone {
        return (0.0, 1.0);
    }
    let null = mis::mixture([1.0, allocation.mean_flights], [row.p_null, row.p_select]);
    (null, 1.0 - null)
}
