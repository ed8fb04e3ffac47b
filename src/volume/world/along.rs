//! The medium along one ray: every volume it enters, each with its own cells, merged into segments
//! from near to far.

use glam::Vec3A;
use smallvec::SmallVec;

use super::instance::Instance;
use crate::math::{Ray, Rgb};
use crate::volume::cells::CellWalk;
use crate::volume::majorant::Majorant;
use crate::volume::medium::{Coefficients, Segment};
use crate::volume::phase::PhaseMix;
use crate::volume::{CoefficientBounds, MediumProperties};

/// A volume that the ray enters. Few bytes, since a ray may meet many.
#[derive(Clone, Copy, Debug)]
pub(super) struct VolumeEntry {
    t0: f32,
    t1: f32,
    instance: u32,
}

/// The volumes that a ray enters, with room for those of most rays without an allocation.
pub(super) type Entries = SmallVec<[VolumeEntry; 8]>;

impl VolumeEntry {
    /// The interval in which `ray` is inside of a volume; `None` if it misses the volume or that is
    /// empty.
    pub(super) fn new(instance: &Instance, index: u32, ray: &Ray, t_max: f32) -> Option<Self> {
        if let CoefficientBounds::Uniform(_, majorant) = instance.volume.bounds()
            && majorant.is_zero()
        {
            return None;
        }
        let local = instance.local_ray(ray);
        let (t0, t1) = instance.volume.region().intersect(&local, t_max)?;
        Some(Self { t0, t1, instance: index })
    }
}

/// The medium along one ray, walked from its origin outwards.
#[derive(Clone, Debug)]
pub struct MediumRay<'w> {
    instances: &'w [Instance],
    ray: Ray,
    /// Volumes not reached yet, nearest last.
    ahead: Entries,
    /// Volumes the ray is in: those that are not empty in the present segment, and those that are
    /// again further on.
    inside: SmallVec<[Cursor<'w>; 3]>,
    /// Ray parameter at which the last segment begins.
    from: f32,
    /// Ray parameter at which the last segment ends, and the next may begin.
    t: f32,
}

impl<'w> MediumRay<'w> {
    pub(super) fn new(instances: &'w [Instance], ray: Ray, mut ahead: Entries) -> Self {
        if ahead.len() > 1 {
            ahead.sort_by(|a, b| b.t0.total_cmp(&a.t0));
        }
        Self { instances, ray, ahead, inside: SmallVec::new(), from: 0.0, t: 0.0 }
    }

    /// Ray parameters at which the first volume begins and the last one ends, before the walk has
    /// begun; `None` where there is none. Either may be infinite in a medium without borders.
    pub fn extent(&self) -> Option<(f32, f32)> {
        let first = self.ahead.last()?.t0;
        Some((first, self.ahead.iter().fold(first, |end, entry| end.max(entry.t1))))
    }

    /// The next segment of the ray that is not empty.
    #[inline]
    pub fn next_segment(&mut self) -> Option<Segment> {
        if self.ahead.is_empty()
            && let [only] = self.inside.as_mut_slice()
        {
            // Nothing to merge: the volume's own segments are those of the ray.
            if !only.advance() {
                self.inside.clear();
                return None;
            }
            (self.from, self.t) = (only.t0, only.t1);
            return Some(only.segment());
        }
        self.next_merged()
    }

    fn next_merged(&mut self) -> Option<Segment> {
        loop {
            if self.inside.is_empty() {
                self.t = self.ahead.last()?.t0.max(self.t);
            }
            let t = self.t;
            while let Some(next) = self.ahead.last()
                && next.t0 <= t
            {
                let instance = &self.instances[next.instance as usize];
                self.inside.push(Cursor::enter(instance, &self.ray, next.t0, next.t1));
                self.ahead.pop();
            }
            self.inside.retain(|cursor| cursor.reaches_beyond(t));
            if self.inside.is_empty() {
                continue;
            }
            let segment = self.merged();
            (self.from, self.t) = (t, segment.t1);
            if self.inside.iter().any(|cursor| cursor.is_at(t)) {
                return Some(segment);
            }
        }
    }

    /// The segment from where the last one ended to the next border.
    fn merged(&self) -> Segment {
        let mut segment = Segment {
            t0: self.t,
            t1: self.ahead.last().map_or(f32::INFINITY, |next| next.t0),
            uniform: true,
            gray: true,
            ..Segment::default()
        };
        for cursor in &self.inside {
            if !cursor.is_at(self.t) {
                segment.t1 = segment.t1.min(cursor.t0);
                continue;
            }
            let own = cursor.segment();
            segment.t1 = segment.t1.min(own.t1);
            segment.majorant += own.majorant;
            segment.emission_rate += own.emission_rate;
            // The finest voxel decides how often the emission is worth reading.
            segment.voxel_rate = segment.voxel_rate.max(own.voxel_rate);
            segment.uniform &= own.uniform;
            segment.gray &= own.gray;
        }
        segment
    }

    /// The volumes that are not empty in the last segment.
    fn present(&self) -> impl Iterator<Item = &Cursor<'w>> {
        self.inside.iter().filter(|cursor| cursor.is_at(self.from))
    }

    /// The coefficients at parameter `t` of the segment handed out last.
    #[inline]
    pub fn coefficients(&self, t: f32) -> Coefficients {
        if let [cursor] = self.inside.as_slice() {
            return cursor.coefficients(t);
        }
        self.present().fold(Coefficients::default(), |sum, cursor| {
            let c = cursor.coefficients(t);
            Coefficients {
                mu_t: sum.mu_t + c.mu_t,
                mu_s: sum.mu_s + c.mu_s,
                emission: sum.emission + c.emission,
            }
        })
    }

    /// μ_t alone at parameter `t` of the segment handed out last.
    #[inline]
    pub fn mu_t(&self, t: f32) -> Rgb {
        if let [cursor] = self.inside.as_slice() {
            return cursor.mu_t(t);
        }
        self.present().fold(Rgb::ZERO, |sum, cursor| sum + cursor.mu_t(t))
    }

    /// Lower and upper bounds of μ_t, per channel, over the segment handed out last.
    pub fn bounds_of_mu_t(&self) -> (Rgb, Rgb) {
        self.present().fold((Rgb::ZERO, Rgb::ZERO), |sum, cursor| {
            let (low, high) = cursor.bounds_of_mu_t();
            (sum.0 + low, sum.1 + high)
        })
    }

    /// The albedo μ_s / μ_t and the phase function at parameter `t` of the segment handed out last.
    /// Where one volume is alone its density is not read: the phase function's weights are then
    /// relative, which is all that it needs.
    pub fn scattering(&self, t: f32) -> (Rgb, PhaseMix) {
        let mut mix = PhaseMix::default();
        if let [cursor] = self.inside.as_slice() {
            let properties = cursor.instance.volume.properties();
            let albedo = cursor.read(t, |properties, at| properties.albedo(at));
            mix.add(&properties.phase, albedo);
            return (albedo, mix);
        }
        let (mu_t, mu_s) = self.extinction(t);
        (ratio(mu_s, mu_t), self.phase(t))
    }

    /// μ_t and μ_s alone at parameter `t` of the segment handed out last.
    #[inline]
    pub fn extinction(&self, t: f32) -> (Rgb, Rgb) {
        if let [cursor] = self.inside.as_slice() {
            return cursor.extinction(t);
        }
        self.present().fold((Rgb::ZERO, Rgb::ZERO), |sum, cursor| {
            let (mu_t, mu_s) = cursor.extinction(t);
            (sum.0 + mu_t, sum.1 + mu_s)
        })
    }

    /// ε alone at parameter `t` of the segment handed out last.
    #[inline]
    pub fn emission(&self, t: f32) -> Rgb {
        if let [cursor] = self.inside.as_slice() {
            return cursor.emission(t);
        }
        self.present().fold(Rgb::ZERO, |sum, cursor| sum + cursor.emission(t))
    }

    /// The phase function at parameter `t` of the segment handed out last.
    pub fn phase(&self, t: f32) -> PhaseMix {
        let mut mix = PhaseMix::default();
        for cursor in self.present() {
            mix.add(&cursor.instance.volume.properties().phase, cursor.extinction(t).1);
        }
        mix
    }
}

/// Ratio per channel; 0 where the whole is 0.
fn ratio(part: Rgb, whole: Rgb) -> Rgb {
    Rgb::select(whole.cmpgt(Rgb::ZERO), part / whole, Rgb::ZERO)
}

/// One volume's segments along the ray: the one it is in or reaches next.
#[derive(Clone, Copy, Debug)]
struct Cursor<'w> {
    instance: &'w Instance,
    /// The ray in the volume's space, with the world's ray parameter.
    local: Ray,
    t0: f32,
    t1: f32,
    majorant: Majorant,
    crossing: Crossing,
}

/// Kind of a ray's crossing of a volume.
#[derive(Clone, Copy, Debug)]
enum Crossing {
    /// One segment, up to the end of a uniform volume.
    Uniform { end: f32 },
    /// Cell by cell.
    Cells(CellWalk),
}

impl<'w> Cursor<'w> {
    /// Starts before the first segment of a volume entered at `t0` and left at `t1`.
    fn enter(instance: &'w Instance, ray: &Ray, t0: f32, t1: f32) -> Self {
        let local = instance.local_ray(ray);
        let (majorant, crossing) = match instance.volume.bounds() {
            CoefficientBounds::Uniform(_, majorant) => (*majorant, Crossing::Uniform { end: t1 }),
            CoefficientBounds::Cells(grid) => {
                (Majorant::default(), Crossing::Cells(grid.walk(&local, t0, t1)))
            }
        };
        Self { instance, local, t0, t1: t0, majorant, crossing }
    }

    /// Goes to the next occupied segment; false at the end.
    #[inline]
    fn advance(&mut self) -> bool {
        match (&mut self.crossing, self.instance.volume.bounds()) {
            (Crossing::Cells(walk), CoefficientBounds::Cells(grid)) => {
                match grid.next_occupied(walk) {
                    Some((t0, t1, majorant)) => {
                        (self.t0, self.t1, self.majorant) = (t0, t1, majorant);
                        true
                    }
                    None => false,
                }
            }
            (Crossing::Uniform { end }, _) if self.t1 < *end => {
                self.t1 = *end;
                true
            }
            _ => false,
        }
    }

    /// Goes on until the segment ends behind `t`; false if none does.
    fn reaches_beyond(&mut self, t: f32) -> bool {
        while self.t1 <= t {
            if !self.advance() {
                return false;
            }
        }
        true
    }

    /// Whether the segment has begun at `t`.
    #[inline]
    fn is_at(&self, t: f32) -> bool {
        self.t0 <= t
    }

    fn segment(&self) -> Segment {
        Segment {
            t0: self.t0,
            t1: self.t1,
            majorant: self.majorant.mu_t,
            emission_rate: self.majorant.emission * self.instance.emission_rate,
            voxel_rate: self.instance.voxel_rate,
            uniform: matches!(self.crossing, Crossing::Uniform { .. }),
            gray: self.instance.volume.properties().is_gray(),
        }
    }

    fn bounds_of_mu_t(&self) -> (Rgb, Rgb) {
        match (&self.crossing, self.instance.volume.bounds()) {
            (Crossing::Cells(walk), CoefficientBounds::Cells(grid)) => {
                let tint = self.instance.volume.properties().tint();
                (tint * grid.minorant(walk), tint * self.majorant.mu_t)
            }
            _ => (self.mu_t(self.t0), self.mu_t(self.t0)),
        }
    }

    /// Reads the medium where that comes from which is at `t` at the time of the ray; zero where
    /// nothing is.
    #[inline]
    fn read<T: Default>(&self, t: f32, of: impl FnOnce(&MediumProperties, Vec3A) -> T) -> T {
        let volume = &self.instance.volume;
        let source = volume.source(self.local.at(t), self.local.time);
        source.map_or_else(T::default, |source| of(volume.properties(), source))
    }

    #[inline]
    fn mu_t(&self, t: f32) -> Rgb {
        match self.instance.volume.bounds() {
            CoefficientBounds::Uniform(coefficients, _) => coefficients.mu_t,
            CoefficientBounds::Cells(_) => self.read(t, MediumProperties::mu_t),
        }
    }

    #[inline]
    fn extinction(&self, t: f32) -> (Rgb, Rgb) {
        match self.instance.volume.bounds() {
            CoefficientBounds::Uniform(coefficients, _) => (coefficients.mu_t, coefficients.mu_s),
            CoefficientBounds::Cells(_) => self.read(t, MediumProperties::extinction),
        }
    }

    #[inline]
    fn emission(&self, t: f32) -> Rgb {
        match self.instance.volume.bounds() {
            CoefficientBounds::Uniform(coefficients, _) => coefficients.emission,
            CoefficientBounds::Cells(_) => self.read(t, MediumProperties::emission),
        }
    }

    #[inline]
    fn coefficients(&self, t: f32) -> Coefficients {
        match self.instance.volume.bounds() {
            CoefficientBounds::Uniform(coefficients, _) => *coefficients,
            CoefficientBounds::Cells(_) => self.read(t, MediumProperties::at),
        }
    }
}
