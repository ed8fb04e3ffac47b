//! Placed volumes as lights: points that emit, directions towards them, and their densities.

use glam::Vec3A;

use super::{FEW, Instance, World};
use crate::{
    math::{Aabb, Bvh, Ray},
    volume::energy::{Energy, finite},
};

/// The instances that emit and a hierarchy over where they do.
#[derive(Clone, Debug, Default)]
pub(super) struct Emissive {
    indices: Vec<u32>,
    hierarchy: Bvh,
    /// Whether anything glows that is no light.
    unsampled: bool,
}

impl Emissive {
    pub(super) fn new(instances: &[Instance]) -> Self {
        let indices: Vec<u32> =
            (0..instances.len() as u32).filter(|&i| instances[i as usize].emits()).collect();
        let boxes: Vec<Aabb> =
            indices.iter().map(|&i| instances[i as usize].emission_bounds()).collect();
        let unsampled =
            instances.iter().any(|i| !i.emits() && i.volume().properties().emission.is_some());
        Self { indices, hierarchy: Bvh::new(&boxes), unsampled }
    }
}

impl Instance {
    /// Where its emitted power comes from, in the volume's own space; `None` where it is no light.
    pub fn energy(&self) -> Option<&Energy> {
        self.volume.energy()
    }

    /// Whether it can be sampled as a light.
    pub fn emits(&self) -> bool {
        self.energy().is_some()
    }

    /// A world point with density [`Instance::emission_pdf_at`], from `pick` in [0, 1) and `u` in
    /// [0, 1)³ as in [`Energy::sample`].
    pub fn sample_emission(&self, pick: f64, u: Vec3A) -> Option<Vec3A> {
        let local = self.energy()?.sample(pick, u);
        Some(self.world_from_local.transform_point3a(local))
    }

    /// Density of [`Instance::sample_emission`] at a world point, 1/world volume.
    pub fn emission_pdf_at(&self, world: Vec3A) -> f32 {
        self.energy().map_or(0.0, |energy| {
            let local = self.local_from_world.transform_point3a(world);
            finite(energy.density_at(local) / self.world_volume)
        })
    }

    /// Density over solid angle, 1/sr, with which the directions from the ray's origin to the
    /// points of [`Instance::sample_emission`] meet the ray's own; its direction is a unit vector.
    pub fn emission_pdf_along(&self, ray: &Ray) -> f32 {
        self.energy().map_or(0.0, |energy| {
            finite(energy.cone_along(&self.local_ray(ray)) / self.world_volume)
        })
    }

    /// ∫ lum ε dV over the world: the luminance of the radiant intensity that the volume would
    /// have if it absorbed nothing, W/sr. ε is per world length whatever the placement.
    pub fn emitted_power(&self) -> f32 {
        self.energy().map_or(0.0, |energy| finite(energy.total() * self.world_volume))
    }

    /// A world box around all that emits; empty where nothing does.
    pub fn emission_bounds(&self) -> Aabb {
        self.energy()
            .map_or(Aabb::EMPTY, |energy| energy.bounds().transformed(&self.world_from_local))
    }
}

impl World {
    /// Whether anything glows at all.
    pub fn emits(&self) -> bool {
        self.emissive.unsampled || !self.emissive.indices.is_empty()
    }

    /// Whether anything glows where no sampled point lies: media without borders.
    pub fn emits_beyond_lights(&self) -> bool {
        self.emissive.unsampled
    }

    /// Indices of the instances that can be sampled as lights, ascending.
    pub fn emissive(&self) -> &[u32] {
        &self.emissive.indices
    }

    /// Calls `visit` with each emissive instance that sampling can find along the whole of `ray`,
    /// whose direction is a unit vector, and its [`Instance::emission_pdf_along`], above zero.
    pub fn emissive_along(&self, ray: &Ray, mut visit: impl FnMut(u32, f32)) {
        let mut meet = |index: u32| {
            let pdf = self.instances[index as usize].emission_pdf_along(ray);
            if pdf > 0.0 {
                visit(index, pdf);
            }
        };
        let Emissive { indices, hierarchy, .. } = &self.emissive;
        if indices.len() <= FEW {
            indices.iter().for_each(|&index| meet(index));
        } else {
            hierarchy.visit(ray, f32::INFINITY, |item, t_max| {
                meet(indices[item as usize]);
                t_max
            });
        }
    }
}
