//! Expected counts that a pilot pass learns, by classes of vertices: see
//! [`prepare`](crate::transport::prepare).

use glam::Vec3A;

use crate::math::{PathRng, Slot};

/// Least expected count of a technique that is in use. Its inverse bounds the weights of what the
/// other technique rarely finds.
pub const LEAST_COUNT: f32 = 0.05;

/// Classes of the vertices of a path, and of the rays that leave them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BounceClass {
    /// The camera.
    Camera,
    /// The first scattering event in a medium.
    FirstInMedium,
    /// The first reflection by a surface.
    FirstOnSurface,
    /// Any later scattering event in a medium.
    LaterInMedium,
    /// Any later reflection by a surface.
    LaterOnSurface,
}

impl BounceClass {
    /// All classes, in their order.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Camera,
        Self::FirstInMedium,
        Self::FirstOnSurface,
        Self::LaterInMedium,
        Self::LaterOnSurface,
    ];
    /// Number of classes.
    pub const COUNT: usize = 5;

    /// The class of vertex number `scatters` of a path, counted from 0 at the camera.
    pub fn new(scatters: u32, is_surface: bool) -> Self {
        match (scatters, is_surface) {
            (0, _) => Self::Camera,
            (1, false) => Self::FirstInMedium,
            (1, true) => Self::FirstOnSurface,
            (_, false) => Self::LaterInMedium,
            (_, true) => Self::LaterOnSurface,
        }
    }
}

/// An expected count: in proportion to the throughput of the path, within bounds. For light samples
/// it is in proportion to the share of the lights in the irradiance at the vertex as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountRule {
    /// Expected count for each unit of the mean of the throughput's channels.
    pub per_throughput: f32,
    /// Most expected count.
    pub most: f32,
}

impl CountRule {
    /// None, whatever the throughput.
    pub const NONE: Self = Self { per_throughput: 0.0, most: 0.0 };
    /// One, whatever the throughput.
    pub const ONE: Self = Self { per_throughput: f32::INFINITY, most: 1.0 };

    /// The expected count at a vertex of so much mean throughput: 0, or at least [`LEAST_COUNT`].
    #[inline]
    pub fn at(self, throughput: f32) -> f32 {
        let wanted = self.per_throughput * throughput;
        // A throughput of zero times infinity is no number, and leads nowhere.
        let least = if self.most > 0.0 { LEAST_COUNT } else { 0.0 };
        if wanted > least { wanted.min(self.most) } else { least }
    }
}

/// Expected counts at the vertices of one class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassCounts {
    /// Light samples of fires.
    pub fire_samples: CountRule,
    /// Light samples of all other lights.
    pub lamp_samples: CountRule,
    /// Emission walks along the ray that leaves the vertex.
    pub emission_walks: CountRule,
    /// Share, 0 to 1, of the light at the end of the ray that leaves the vertex which is gathered
    /// through its transmittance; the rest is gathered by arrival.
    pub by_transmittance: f32,
}

/// Expected counts of a picture, fixed before its second sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearnedCounts {
    /// Scale of the number of guided flights of a camera ray, relative to what the probes propose;
    /// 0 switches guided flights off.
    pub guided_flights: f32,
    /// Whether probes guide directions at vertices, if there are any.
    pub guided_directions: bool,
    classes: [ClassCounts; BounceClass::COUNT],
    /// Counts by a hash of the vertex in place of the rules, see [`LearnedCounts::hashed`].
    hash: Option<u32>,
}

/// Expected counts at one vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexCounts {
    /// Light samples of fires.
    pub fire_samples: f32,
    /// Light samples of all other lights.
    pub lamp_samples: f32,
    /// Emission walks along the ray that leaves the vertex, at most one.
    pub emission_walks: f32,
}

impl LearnedCounts {
    /// One sample of each technique, and light at the end of camera rays through the transmittance,
    /// of others by arrival: the counts of first samples, which wait for no pilot pass.
    pub fn first(guided_flights: f32) -> Self {
        let one = ClassCounts {
            fire_samples: CountRule::ONE,
            lamp_samples: CountRule::ONE,
            emission_walks: CountRule::ONE,
            by_transmittance: 0.0,
        };
        let classes = [one; BounceClass::COUNT];
        let mut counts = Self { guided_flights, guided_directions: true, classes, hash: None };
        counts.at_mut(BounceClass::Camera).by_transmittance = 1.0;
        counts
    }

    /// Counts that are a hash of technique, class, position and throughput, for tests: the mean of
    /// a picture does not depend on them.
    pub fn hashed(guided_flights: f32, hash: u32) -> Self {
        Self { hash: Some(hash), ..Self::first(guided_flights) }
    }

    /// The expected counts at a vertex of a class, of so much mean throughput, in whose irradiance
    /// fires have the share `share_of_fires`.
    #[inline]
    pub fn at_vertex(
        &self,
        class: BounceClass,
        position: Vec3A,
        throughput: f32,
        share_of_fires: f32,
    ) -> VertexCounts {
        if let Some(hash) = self.hash {
            return VertexCounts::hashed(hash, class, position, throughput);
        }
        let rules = self.at(class);
        VertexCounts {
            fire_samples: rules.fire_samples.at(throughput * share_of_fires),
            lamp_samples: rules.lamp_samples.at(throughput * (1.0 - share_of_fires)),
            emission_walks: rules.emission_walks.at(throughput),
        }
    }

    /// Share, 0 to 1, of the light at the end of a ray from a vertex which is gathered through the
    /// transmittance.
    #[inline]
    pub fn by_transmittance(&self, class: BounceClass, position: Vec3A) -> f32 {
        match self.hash {
            Some(hash) => unit_hash(hash, [class as u32, 3], position, 0.0),
            None => self.at(class).by_transmittance,
        }
    }

    /// The counts of a class.
    #[inline]
    pub fn at(&self, class: BounceClass) -> &ClassCounts {
        &self.classes[class as usize]
    }

    /// The counts of a class, to be changed.
    pub fn at_mut(&mut self, class: BounceClass) -> &mut ClassCounts {
        &mut self.classes[class as usize]
    }

    /// These counts with another scale of guided flights, and directions guided or not.
    pub fn with_guidance(self, guided_flights: f32, guided_directions: bool) -> Self {
        Self { guided_flights, guided_directions, ..self }
    }

    /// These counts with one light sample of each kind and one emission walk everywhere, so that
    /// paths tell what each of them finds.
    pub fn with_one_of_each(mut self) -> Self {
        for class in &mut self.classes {
            class.fire_samples = CountRule::ONE;
            class.lamp_samples = CountRule::ONE;
            class.emission_walks = CountRule::ONE;
        }
        self
    }

    /// These counts with the same share of light through the transmittance for all classes.
    pub fn with_all_by_transmittance(mut self, share: f32) -> Self {
        self.classes.iter_mut().for_each(|class| class.by_transmittance = share);
        self
    }
}

impl VertexCounts {
    /// Counts that are a hash: 0 for every third vertex where another technique finds the same
    /// light, and few at first vertices. Were counts of successive vertices distributed alike, the
    /// errors of a weight with the count of the wrong one would cancel.
    fn hashed(hash: u32, class: BounceClass, position: Vec3A, throughput: f32) -> Self {
        let unit = |technique| unit_hash(hash, [class as u32, technique], position, throughput);
        let count = |u: f32, most: f32| LEAST_COUNT + u * (most - LEAST_COUNT);
        let most = match class {
            BounceClass::FirstInMedium | BounceClass::FirstOnSurface => 0.5,
            _ => 4.0,
        };
        let fires = unit(0);
        Self {
            fire_samples: if fires < 1.0 / 3.0 { 0.0 } else { count(1.5 * fires - 0.5, most) },
            lamp_samples: count(unit(1), most),
            emission_walks: count(unit(2), 1.0),
        }
    }
}

/// A number in [0, 1) that depends on all bits of its arguments.
fn unit_hash(hash: u32, of: [u32; 2], position: Vec3A, throughput: f32) -> f32 {
    let bits = position.to_array().map(f32::to_bits);
    let all = [hash, of[0], of[1], bits[0], bits[1], bits[2], throughput.to_bits()];
    let mixed = all.into_iter().fold(0_u64, |mixed, bits| {
        let mixed = (mixed ^ u64::from(bits)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 29)
    });
    (mixed >> 40) as f32 / (1_u64 << 24) as f32
}

/// Rounds an `expected` count up or down, by the random number of `slot`, so that its mean is
/// right.
#[inline]
pub fn draw(expected: f32, slot: Slot, rng: &mut PathRng) -> u32 {
    let whole = expected.floor();
    let more = expected > whole && rng.at(slot) < expected - whole;
    whole as u32 + u32::from(more)
}
