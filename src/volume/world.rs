//! All volumes of a scene behind one majorant structure: a hierarchy over the placed volumes gives
//! each one's interval along a ray, each walks its own cells inside, and where they overlap the
//! stretches are cut at every border and the majorants added.

mod emissive;

use std::sync::Arc;

use glam::{Affine3A, Vec3A};
use smallvec::SmallVec;

use emissive::Emissive;

use super::{
    body::{Bounds, Region, Volume},
    cells::CellWalk,
    majorant::Majorant,
    medium::{Coefficients, Segment},
    phase::PhaseMix,
};
use crate::math::{Aabb, Bvh, Ray};

/// Up to this many volumes are tried one by one, which costs less than a hierarchy.
const FEW: usize = 3;

/// A volume placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    volume: Arc<Volume>,
    world_from_local: Affine3A,
    local_from_world: Affine3A,
    bounds: Aabb,
    /// World volume of a unit of the volume's own.
    world_volume: f64,
    /// Turns a bound of lum ε into collisions per length along the brightest chord.
    emission_rate: f32,
    voxel_rate: f32,
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

    /// A ray of the world in the volume's space; its parameter stays the world's.
    fn local_ray(&self, ray: &Ray) -> Ray {
        Ray::new(
            self.local_from_world.transform_point3a(ray.origin),
            self.local_from_world.transform_vector3a(ray.direction),
        )
    }

    /// A box around it in the world; infinite for a volume without borders.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }
}

/// Every volume of a scene.
#[derive(Clone, Debug, Default)]
pub struct World {
    instances: Vec<Instance>,
    bounded: Bvh,
    /// Indices of the bounded instances, in the hierarchy's order.
    bounded_indices: Vec<u32>,
    unbounded: Vec<u32>,
    emissive: Emissive,
}

impl World {
    /// Gathers the placed volumes.
    pub fn new(instances: Vec<Instance>) -> Self {
        let (mut bounded_indices, mut unbounded) = (Vec::new(), Vec::new());
        for (index, instance) in instances.iter().enumerate() {
            if instance.volume.region() == &Region::Everywhere {
                unbounded.push(index as u32);
            } else if !instance.bounds.is_empty() {
                bounded_indices.push(index as u32);
            }
        }
        let boxes: Vec<Aabb> =
            bounded_indices.iter().map(|&i| instances[i as usize].bounds).collect();
        let (bounded, emissive) = (Bvh::new(&boxes), Emissive::new(&instances));
        Self { instances, bounded, bounded_indices, unbounded, emissive }
    }

    /// The placed volumes.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// The medium along `ray` up to `t_max`, which may be infinite.
    pub fn along(&self, ray: Ray, t_max: f32) -> MediumRay<'_> {
        let mut medium =
            MediumRay { ahead: SmallVec::new(), inside: SmallVec::new(), t: 0.0, fresh: false };
        let mut enter = |index: u32| {
            let instance = &self.instances[index as usize];
            if let Some(cursor) = Cursor::enter(instance, &ray, t_max) {
                medium.ahead.push(cursor);
            }
        };
        self.unbounded.iter().for_each(|&index| enter(index));
        if self.bounded_indices.len() <= FEW {
            self.bounded_indices.iter().for_each(|&index| enter(index));
        } else {
            self.bounded.visit(&ray, t_max, |item, t_max| {
                enter(self.bounded_indices[item as usize]);
                t_max
            });
        }
        // Nearest last, so that entering pops.
        if medium.ahead.len() > 1 {
            medium.ahead.sort_by(|a, b| b.t0.total_cmp(&a.t0));
        }
        medium
    }
}

/// The medium along one ray, walked from its origin outwards.
#[derive(Clone, Debug)]
pub struct MediumRay<'w> {
    /// Volumes not reached yet, nearest last.
    ahead: SmallVec<[Cursor<'w>; 2]>,
    /// Volumes the current segment lies in.
    inside: SmallVec<[Cursor<'w>; 2]>,
    t: f32,
    /// Whether `inside` holds a segment that was handed out.
    fresh: bool,
}

impl<'w> MediumRay<'w> {
    /// The next stretch of the ray with something in it.
    #[inline]
    pub fn next_segment(&mut self) -> Option<Segment> {
        if self.fresh
            && self.ahead.is_empty()
            && let [only] = self.inside.as_mut_slice()
        {
            // Nothing to merge: the volume's own stretches are the segments.
            return only.advance().then(|| only.segment());
        }
        self.next_merged()
    }

    fn next_merged(&mut self) -> Option<Segment> {
        loop {
            if self.fresh {
                self.leave_stretch();
            }
            if self.inside.is_empty() {
                self.t = self.ahead.last()?.t0.max(self.t);
            }
            while let Some(next) = self.ahead.last()
                && next.t0 <= self.t
            {
                self.inside.extend(self.ahead.pop());
            }
            let segment = self.merged();
            self.fresh = true;
            self.t = segment.t1.max(segment.t0);
            if segment.t0 < segment.t1 {
                return Some(segment);
            }
        }
    }

    /// The coefficients at parameter `t` of the segment handed out last.
    #[inline]
    pub fn coefficients(&self, t: f32) -> Coefficients {
        if let [cursor] = self.inside.as_slice() {
            return cursor.coefficients(t);
        }
        self.inside.iter().fold(Coefficients::default(), |sum, cursor| {
            let c = cursor.coefficients(t);
            Coefficients {
                mu_t: sum.mu_t + c.mu_t,
                mu_s: sum.mu_s + c.mu_s,
                emission: sum.emission + c.emission,
            }
        })
    }

    /// The phase function at parameter `t` of the segment handed out last.
    pub fn phase(&self, t: f32) -> PhaseMix {
        let mut mix = PhaseMix::default();
        for cursor in &self.inside {
            mix.add(cursor.instance.volume.substance().g, cursor.coefficients(t).mu_s);
        }
        mix
    }

    fn merged(&self) -> Segment {
        let mut segment = Segment {
            t0: self.t,
            t1: self.ahead.last().map_or(f32::INFINITY, |next| next.t0),
            uniform: true,
            ..Segment::default()
        };
        for cursor in &self.inside {
            segment.t1 = segment.t1.min(cursor.t1);
            segment.majorant += cursor.majorant.mu_t;
            segment.emission_rate += cursor.majorant.emission * cursor.instance.emission_rate;
            // The finest voxel decides how often the emission is worth looking at.
            segment.voxel_rate = segment.voxel_rate.max(cursor.instance.voxel_rate);
            segment.uniform &= cursor.cells.is_none();
        }
        segment
    }

    /// Moves every volume whose stretch ends here on to its next one, or out.
    fn leave_stretch(&mut self) {
        let t = self.t;
        let mut i = 0;
        while i < self.inside.len() {
            let cursor = &mut self.inside[i];
            if cursor.t1 > t {
                i += 1;
            } else if !cursor.advance() {
                self.inside.remove(i);
            } else if cursor.t0 > t {
                let later = self.inside.remove(i);
                let place = self.ahead.partition_point(|other| other.t0 > later.t0);
                self.ahead.insert(place, later);
            } else {
                i += 1;
            }
        }
        self.fresh = false;
    }
}

/// One volume's way along the ray: the stretch it is in or comes to next.
#[derive(Clone, Copy, Debug)]
struct Cursor<'w> {
    instance: &'w Instance,
    /// The ray in the volume's space; its parameter is still the world's.
    local: Ray,
    t0: f32,
    t1: f32,
    majorant: Majorant,
    /// The walk through the cells; `None` in a uniform volume.
    cells: Option<CellWalk>,
}

impl<'w> Cursor<'w> {
    fn enter(instance: &'w Instance, ray: &Ray, t_max: f32) -> Option<Self> {
        let local = instance.local_ray(ray);
        let (t0, t1) = instance.volume.region().intersect(&local, t_max)?;
        match instance.volume.bounds() {
            Bounds::Uniform(_, majorant) => {
                let majorant = *majorant;
                (!majorant.is_zero()).then_some(Self {
                    instance,
                    local,
                    t0,
                    t1,
                    majorant,
                    cells: None,
                })
            }
            Bounds::Cells(grid) => {
                let cells = Some(grid.walk(&local, t0, t1));
                let majorant = Majorant::default();
                let mut cursor = Self { instance, local, t0, t1, majorant, cells };
                cursor.advance().then_some(cursor)
            }
        }
    }

    /// Goes to the next occupied stretch; false at the end.
    #[inline]
    fn advance(&mut self) -> bool {
        let (Some(walk), Bounds::Cells(grid)) = (&mut self.cells, self.instance.volume.bounds())
        else {
            return false;
        };
        match grid.next_occupied(walk) {
            Some((t0, t1, majorant)) => {
                (self.t0, self.t1, self.majorant) = (t0, t1, majorant);
                true
            }
            None => false,
        }
    }

    fn segment(&self) -> Segment {
        Segment {
            t0: self.t0,
            t1: self.t1,
            majorant: self.majorant.mu_t,
            emission_rate: self.majorant.emission * self.instance.emission_rate,
            voxel_rate: self.instance.voxel_rate,
            uniform: self.cells.is_none(),
        }
    }

    #[inline]
    fn coefficients(&self, t: f32) -> Coefficients {
        match self.instance.volume.bounds() {
            Bounds::Uniform(coefficients, _) => *coefficients,
            Bounds::Cells(_) => self.instance.volume.substance().at(self.local.at(t)),
        }
    }
}
