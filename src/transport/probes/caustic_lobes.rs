//! Volume caustics as lobes: light that specular surfaces reflect into the medium, as it arrives in
//! the leaves. Each lobe points back to an image of its light, so that one direction does not have
//! to stand for a leaf.

use glam::{Mat3A, Vec3A};
use smallvec::SmallVec;

use crate::volume::phase::henyey_greenstein;

/// Most caustic lobes of a leaf.
const MOST: usize = 4;
/// Least rays of a caustic lobe.
const LEAST_RAYS: usize = 3;
/// Weight of the image of the light in a flat mirror, against the meeting point of the rays.
const TRUST: f32 = 1e-4;
/// Prior spread of a lobe as 1 − cos, and the number of rays it counts as.
const PRIOR: (f32, f32) = (0.01, 1.0);
/// Least spread of a lobe, as 1 − cos.
const NARROWEST: f32 = 1e-6;

/// Piece of a photon's ray inside of a leaf, after reflection by a specular surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct PhotonSegment {
    /// The leaf.
    pub(in crate::transport) leaf: u32,
    /// The specular surface and the light, by their indices in the scene.
    pub(in crate::transport) origin: (u32, u32),
    /// ∫ L dω, averaged over the leaf, that the piece contributes.
    pub(in crate::transport) fluence: f32,
    /// A point of the piece.
    pub(in crate::transport) point: Vec3A,
    /// Unit direction towards the photon's origin.
    pub(in crate::transport) direction: Vec3A,
    /// Image of the light: its position if the mirrors were windows.
    pub(in crate::transport) image: Vec3A,
}

/// A volume caustic in a leaf: light of one source off one specular surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct CausticLobe {
    /// Point that the caustic's rays come from.
    pub(in crate::transport) point: Vec3A,
    /// Unit mean direction towards the rays' origin.
    direction: Vec3A,
    /// Concentration κ of the rays' directions about the direction to `point`.
    pub(in crate::transport) concentration: f32,
    /// ∫ L dω of the caustic, averaged over the leaf.
    pub(in crate::transport) fluence: f32,
}

/// Caustic lobes of all leaves; empty by default.
#[derive(Clone, Debug, Default)]
pub(super) struct CausticLobes {
    all: Vec<CausticLobe>,
    /// For each node the index of its first lobe in `all` and their number; empty without any
    /// lobes.
    places: Vec<(u32, u32)>,
}

impl CausticLobes {
    /// Gathers `segments`, in any order, for an octree of so many `nodes`.
    pub(super) fn new(mut segments: Vec<PhotonSegment>, nodes: usize) -> Self {
        let mut caustic_lobes = Self::default();
        segments.sort_by_key(|segment| (segment.leaf, segment.origin));
        for segments in segments.chunk_by(|a, b| a.leaf == b.leaf) {
            let groups = segments.chunk_by(|a, b| a.origin == b.origin);
            let mut found: SmallVec<[CausticLobe; MOST]> =
                groups.filter_map(CausticLobe::new).collect();
            found.sort_by(|a, b| b.fluence.total_cmp(&a.fluence));
            found.truncate(MOST);
            if found.is_empty() {
                continue;
            }
            caustic_lobes.places.resize(nodes, (0, 0));
            let place = (caustic_lobes.all.len() as u32, found.len() as u32);
            caustic_lobes.places[segments[0].leaf as usize] = place;
            caustic_lobes.all.extend(found);
        }
        caustic_lobes
    }

    /// Whether there are none anywhere.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Caustic lobes of a leaf.
    #[inline]
    pub(super) fn of(&self, leaf: u32) -> &[CausticLobe] {
        let Some(&(first, count)) = self.places.get(leaf as usize) else { return &[] };
        &self.all[first as usize..(first + count) as usize]
    }
}

impl CausticLobe {
    /// Fits a lobe to the rays of one light off one specular surface in one leaf; `None` where they
    /// are too few.
    fn new(segments: &[PhotonSegment]) -> Option<Self> {
        let fluence: f32 = segments.iter().map(|segment| segment.fluence).sum();
        if segments.len() < LEAST_RAYS || !(fluence > 0.0 && fluence.is_finite()) {
            return None;
        }
        let mean = |of: &dyn Fn(&PhotonSegment) -> Vec3A| {
            segments.iter().map(|segment| segment.fluence / fluence * of(segment)).sum::<Vec3A>()
        };
        let direction = mean(&|segment| segment.direction).try_normalize()?;
        let point = meeting(segments, fluence, mean(&|segment| segment.point))?;
        let off = |segment: &PhotonSegment| {
            let axis = (point - segment.point).normalize_or_zero();
            segment.fluence / fluence * 0.5 * (segment.direction - axis).length_squared()
        };
        let spread: f32 = segments.iter().map(off).sum();
        let rays = segments.len() as f32;
        let spread = (rays * spread + PRIOR.1 * PRIOR.0) / (rays + PRIOR.1);
        let concentration = 1.0 / spread.max(NARROWEST);
        Some(Self { point, direction, concentration, fluence })
    }

    /// ∫ L ρ dω back along a ray with the unit `direction`, for a phase function of mean cosine
    /// `g`.
    #[inline]
    pub(super) fn in_scattered(&self, g: f32, direction: Vec3A) -> f32 {
        self.fluence * henyey_greenstein(g, direction, self.direction)
    }
}

/// The point nearest to the lines of the rays, in the mean of squares, and with little weight to
/// their images, which tell the distance where the lines are parallel.
fn meeting(segments: &[PhotonSegment], fluence: f32, center: Vec3A) -> Option<Vec3A> {
    let (mut matrix, mut right) = (Mat3A::ZERO, Vec3A::ZERO);
    for segment in segments {
        let weight = segment.fluence / fluence;
        let d = segment.direction;
        let across = Mat3A::IDENTITY - Mat3A::from_cols(d.x * d, d.y * d, d.z * d);
        matrix += weight * (across + TRUST * Mat3A::IDENTITY);
        right += weight * (across * (segment.point - center) + TRUST * (segment.image - center));
    }
    let point = center + matrix.inverse() * right;
    point.is_finite().then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rays from a point, as segments in a leaf of half size 0.1 about the origin.
    fn segments(from: Vec3A, image: Vec3A) -> Vec<PhotonSegment> {
        let at = |i: usize| 0.1 * Vec3A::from([0.7, 0.3, 0.9].map(|s| (s * i as f32).sin()));
        let segment = |i| {
            let direction = (from - at(i)).normalize();
            PhotonSegment { leaf: 8, origin: (0, 0), fluence: 0.5, point: at(i), direction, image }
        };
        (0..32).map(segment).collect()
    }

    #[test]
    fn lobes_point_to_the_image_of_their_light() {
        // A flat mirror, with the image known; a bent one, where only the rays tell; the sun, whose
        // rays are parallel.
        let near = Vec3A::new(0.5, -0.3, 0.8);
        let sun = 1e4 * Vec3A::new(0.6, 0.0, 0.8);
        for (from, image, error) in [(near, near, 1e-4), (near, 3.0 * near, 0.05), (sun, sun, 10.0)]
        {
            let caustic_lobes = CausticLobes::new(segments(from, image), 9);
            let [lobe] = caustic_lobes.of(8) else { panic!("one bundle: {caustic_lobes:?}") };
            let off = (lobe.point - from).length();
            assert!(off < error, "{from}: {} is off by {off}", lobe.point);
            assert!((lobe.fluence - 16.0).abs() < 1e-4 && lobe.concentration > 1e3, "{lobe:?}");
            assert!(caustic_lobes.of(7).is_empty());
        }
    }

    #[test]
    fn few_rays_and_faint_lobes_are_left_out() {
        let near = Vec3A::X;
        assert!(CausticLobes::new(segments(near, near)[..2].to_vec(), 9).of(8).is_empty());
        let many: Vec<PhotonSegment> = (0..6)
            .flat_map(|light| {
                let with = move |segment: PhotonSegment| PhotonSegment {
                    origin: (0, light),
                    fluence: light as f32 + 1.0,
                    ..segment
                };
                segments(near, near).into_iter().map(with)
            })
            .collect();
        let caustic_lobes = CausticLobes::new(many, 9);
        let kept: Vec<f32> = caustic_lobes.of(8).iter().map(|lobe| lobe.fluence / 32.0).collect();
        assert_eq!(kept, [6.0, 5.0, 4.0, 3.0]);
    }
}
