//! A volume placed in the world, as a medium and as a light.

use std::sync::Arc;

use glam::{Affine3A, Vec3A};

use crate::math::{Aabb, Ray};
use crate::volume::energy::{Energy, finite};
use crate::volume::{Region, Volume};

/// Up to this many volumes are tried one by one, which costs less than a hierarchy.
pub(super) const FEW: usize = 3;

/// A volume placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    pub(super) volume: Arc<Volume>,
    pub(super) world_from_local: Affine3A,
    pub(super) local_from_world: Affine3A,
    pub(super) bounds: Aabb,
    /// World volume of a unit of the volume's own.
    world_volume: f64,
    /// Factor from a bound of lum ε to collisions per length along the brightest chord.
    pub(super) emission_rate: f32,
    pub(super) voxel_rate: f32,
}

impl Instance {
    /// Places `volume`. The placement must be invertible.
    pub fn new(volume: Arc<Volume>, world_from_local: Affine3A) -> Self {
        let columns = world_from_local.matrix3;
        let lengths =
            Vec3A::new(columns.x_axis.length(), columns.y_axis.length(), columns.z_axis.length());
        let chord = (volume.chords() * lengths).max_element();
        let emission_rate = if chord > 0.0 { 1.0 / chord } else { 0.0 };
        let voxel_rate = volume.voxel().map_or(0.0, |v| 1.0 / (v * lengths.min_element()));
        let bounds = match volume.region() {
            Region::Everywhere => Aabb::centered(Vec3A::INFINITY),
            region => region.bounds().transformed(&world_from_local),
        };
        let local_from_world = world_from_local.inverse();
        let world_volume = columns.as_dmat3().determinant().abs();
        Self {
            volume,
            world_from_local,
            local_from_world,
            bounds,
            world_volume,
            emission_rate,
            voxel_rate,
        }
    }

    /// The volume that is placed.
    pub fn volume(&self) -> &Arc<Volume> {
        &self.volume
    }

    /// Transform from the volume's space to the world.
    pub fn world_from_local(&self) -> &Affine3A {
        &self.world_from_local
    }

    /// World volume of a unit of the volume's own.
    pub fn world_volume(&self) -> f64 {
        self.world_volume
    }

    /// A ray of the world in the volume's space; its parameter and its time stay the world's.
    pub(super) fn local_ray(&self, ray: &Ray) -> Ray {
        Ray {
            origin: self.local_from_world.transform_point3a(ray.origin),
            direction: self.local_from_world.transform_vector3a(ray.direction),
            time: ray.time,
        }
    }

    /// World box around the volume; infinite for a volume without borders.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Distribution of the emitted power, in the volume's own space; `None` where the volume is no
    /// light.
    pub fn energy(&self) -> Option<&Energy> {
        self.volume.energy()
    }

    /// Whether the volume can be sampled as a light.
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
