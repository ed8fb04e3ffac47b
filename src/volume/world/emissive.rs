//! The placed volumes that emit, and a hierarchy to find those along a ray.

use super::instance::{FEW, Instance};
use crate::math::{Aabb, Bvh, Ray};

/// The instances that emit, and a hierarchy over the boxes around their emission.
#[derive(Clone, Debug, Default)]
pub(super) struct Emissive {
    indices: Vec<u32>,
    hierarchy: Bvh,
    /// Whether any instance emits that cannot be sampled as a light.
    unsampled: bool,
}

impl Emissive {
    pub(super) fn new(instances: &[Instance]) -> Self {
        let indices: Vec<u32> =
            (0..instances.len() as u32).filter(|&i| instances[i as usize].emits()).collect();
        let boxes: Vec<Aabb> =
            indices.iter().map(|&i| instances[i as usize].emission_bounds()).collect();
        let is_unsampled = |instance: &Instance| {
            let bounds = instance.bounds();
            let ends = bounds.min.is_finite() && bounds.max.is_finite();
            instance.volume().properties().emission.is_some() && !ends
        };
        let unsampled = instances.iter().any(is_unsampled);
        Self { indices, hierarchy: Bvh::new(&boxes), unsampled }
    }

    /// Whether any instance emits, sampled as a light or not.
    pub(super) fn any(&self) -> bool {
        self.unsampled || !self.indices.is_empty()
    }

    /// Whether any instance emits that cannot be sampled as a light.
    pub(super) fn has_unsampled(&self) -> bool {
        self.unsampled
    }

    /// Indices of the instances that can be sampled as lights, ascending.
    pub(super) fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// See [`World::emissive_along`](super::World::emissive_along); `instances` are those that this
    /// was made of.
    pub(super) fn along(&self, instances: &[Instance], ray: &Ray, mut visit: impl FnMut(u32, f32)) {
        let mut meet = |index: u32| {
            let pdf = instances[index as usize].emission_pdf_along(ray);
            if pdf > 0.0 {
                visit(index, pdf);
            }
        };
        if self.indices.len() <= FEW {
            self.indices.iter().for_each(|&index| meet(index));
        } else {
            self.hierarchy.visit(ray, f32::INFINITY, |item, t_max| {
                meet(self.indices[item as usize]);
                t_max
            });
        }
    }
}
