//! The nodes of a light hierarchy, and the estimated irradiance of the emitters below one.

use glam::Vec3A;

use super::cone::Cone;
use crate::light::emitter::Receiver;
use crate::math::Aabb;

/// Least product of distances, so that a light at the very point stays finite.
const LEAST_SQUARED: f64 = 1e-60;

/// Allowance for rounding in the horizon test, relative to the distance.
const HORIZON_SLACK: f32 = 1e-6;

/// A hierarchy over lights; empty by default.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    /// The root first, children of a node side by side.
    pub(super) nodes: Vec<LightNode>,
    /// For each emitter the choices on the path from the root, the first in the lowest bit, 1 for
    /// the second child; `None` for those that are not in the tree.
    pub(super) trails: Vec<Option<u64>>,
    /// For each emitter its node; the root for those that are not in the tree.
    pub(super) leaves: Vec<u32>,
    /// Intensity of the brightest emitter.
    pub(super) brightest: f32,
}

/// A node: all emitters below it as one.
#[derive(Clone, Debug)]
pub(super) struct LightNode {
    pub(super) bounds: Aabb,
    /// Sum of the intensities of its emitters, relative to the brightest of the tree.
    pub(super) intensity: f32,
    /// Square of the distance below which the nearest emitter is not expected.
    pub(super) least_squared: f32,
    pub(super) cone: Cone,
    pub(super) kind: NodeKind,
}

/// The content of a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum NodeKind {
    /// One emitter, by its index.
    Leaf(u32),
    /// Index of the first child; the second follows it.
    Inner(u32),
}

impl LightNode {
    /// Rough irradiance of its emitters at the receiver, all facing it, relative to the brightest
    /// of the tree.
    ///
    /// 1/d² is replaced by 1/(nearest · farthest distance of the box), which is its mean along a
    /// line towards the receiver and within π/2 of it along one across.
    #[inline]
    pub(super) fn importance(&self, to: &Receiver) -> f64 {
        let (low, high) = (self.bounds.min - to.position, self.bounds.max - to.position);
        let nearest_squared = low.max(-high).max(Vec3A::ZERO).length_squared();
        let farthest_squared = low.abs().max(high.abs()).length_squared();
        let cosine = to.normal.map_or(1.0, |normal| {
            // The greatest height of the box above the tangent plane.
            let height = (normal * low).max(normal * high).element_sum();
            let slack = HORIZON_SLACK * farthest_squared.sqrt();
            if height < -slack {
                return 0.0;
            }
            (height.max(slack) / nearest_squared.sqrt()).min(1.0)
        });
        if cosine == 0.0 || !self.cone.may_reach(&self.bounds, to.position) {
            return 0.0;
        }
        let nearest_squared = f64::from(nearest_squared.max(self.least_squared).min(f32::MAX));
        let farthest_squared = f64::from(farthest_squared.min(f32::MAX));
        let squared = (nearest_squared * farthest_squared).sqrt().max(LEAST_SQUARED);
        f64::from(self.intensity) * f64::from(cosine) / squared
    }
}
