//! A volume in its own space: its region, its medium and bounds of the coefficients.

use glam::{IVec3, Vec3A};

use super::phase::Phase;
use super::{
    emission::Emission,
    energy::Energy,
    field::{RgbField, ScalarField},
    majorant::{Majorant, MajorantGrid},
    medium::Coefficients,
    motion::Motion,
    region::Region,
};
use crate::error::{Progress, Result, report};
use crate::math::{Aabb, Rgb, luminance};

/// The properties of a medium at the time of its grids. Coefficients are per unit of *world*
/// length, whatever the volume's placement.
#[derive(Clone, Debug)]
pub struct MediumProperties {
    /// The density field; μ_t = `density_scale` · value.
    pub density: ScalarField,
    /// Multiplier of the density, per channel.
    pub density_scale: Rgb,
    /// Single-scattering albedo μ_s / μ_t, 0 to 1.
    pub albedo: RgbField,
    /// Phase function of the medium.
    pub phase: Phase,
    /// Emission of the medium.
    pub emission: Emission,
}

impl MediumProperties {
    /// The coefficients at a point of the volume's space.
    #[inline]
    pub fn at(&self, local: Vec3A) -> Coefficients {
        let density = self.density.at(local).max(0.0);
        let mu_t = self.density_scale * density;
        let mu_s = self.albedo(local) * mu_t;
        let emission = self.emission.at(local, mu_t - mu_s, density);
        Coefficients { mu_t, mu_s, emission }
    }

    /// Whether the medium may scatter anywhere, as far as is known without a read of its fields.
    pub fn scatters(&self) -> bool {
        let dark = matches!(self.albedo, RgbField::Constant(albedo) if albedo.max_element() <= 0.0);
        let clear = matches!(self.density, ScalarField::Constant(density) if density <= 0.0);
        !dark && !clear && self.density_scale.max_element() > 0.0
    }

    /// Whether μ_t and μ_s are the same in all channels, whatever the emission.
    #[inline]
    pub fn is_gray(&self) -> bool {
        self.density_scale == Rgb::splat(self.density_scale.x) && self.albedo.is_gray()
    }

    /// μ_t alone at a point of the volume's space.
    #[inline]
    pub fn mu_t(&self, local: Vec3A) -> Rgb {
        self.density_scale * self.density.at(local).max(0.0)
    }

    /// μ_t and μ_s alone at a point of the volume's space.
    #[inline]
    pub fn extinction(&self, local: Vec3A) -> (Rgb, Rgb) {
        let mu_t = self.mu_t(local);
        (mu_t, self.albedo(local) * mu_t)
    }

    /// ε alone at a point of the volume's space.
    #[inline]
    pub fn emission(&self, local: Vec3A) -> Rgb {
        if self.emission.needs_density() {
            self.at(local).emission
        } else {
            self.emission.at(local, Rgb::ZERO, 0.0)
        }
    }

    /// [`MediumProperties::bounds_over`] for all times of a `motion`.
    fn bounds_in_motion(&self, motion: &Motion, local: &Aabb) -> (Majorant, f32) {
        let (sources, is_whole) = motion.filled_sources(local);
        if sources.is_empty() {
            return (Majorant::default(), 0.0);
        }
        let (majorant, minorant) = self.bounds_over(&sources);
        (majorant, if is_whole { minorant } else { 0.0 })
    }

    /// Majorant over a box, and minorant of the extinction's largest channel.
    fn bounds_over(&self, local: &Aabb) -> (Majorant, f32) {
        let (least, most) = self.density.range(local);
        let [least, density] = [least, most].map(|density| density.max(0.0));
        let mu_t = self.density_scale * density;
        let emission = self.emission.upper_bound(local, mu_t, density);
        let largest = self.density_scale.max_element();
        (Majorant { mu_t: mu_t.max_element(), emission }, largest * least)
    }

    /// μ_t relative to its largest channel.
    pub fn tint(&self) -> Rgb {
        let largest = self.density_scale.max_element();
        if largest > 0.0 { self.density_scale / largest } else { Rgb::ZERO }
    }

    /// The albedo alone at a point of the volume's space.
    #[inline]
    pub fn albedo(&self, local: Vec3A) -> Rgb {
        self.albedo.at(local).clamp(Rgb::ZERO, Rgb::ONE)
    }
}

/// A volume in its own space, ready to be placed any number of times.
#[derive(Clone, Debug)]
pub struct Volume {
    region: Region,
    properties: MediumProperties,
    motion: Option<Motion>,
    bounds: CoefficientBounds,
    /// Edge of a voxel in the volume's space; `None` where nothing has voxels.
    voxel: Option<f32>,
    /// Largest ∫ lum ε along the probing chords of each axis, in the volume's own lengths.
    chords: Vec3A,
    energy: Option<Energy>,
}

/// The bounds of a volume's coefficients.
#[derive(Clone, Debug)]
pub enum CoefficientBounds {
    /// The coefficients are the same everywhere, these exactly.
    Uniform(Coefficients, Majorant),
    /// The coefficients vary; bounds of each cell.
    Cells(MajorantGrid),
}

impl Volume {
    /// A volume with the same coefficients throughout.
    pub fn uniform(region: Region, properties: MediumProperties) -> Self {
        let inside = properties.at(Vec3A::ZERO);
        let emission = luminance(inside.emission);
        let majorant = Majorant { mu_t: inside.mu_t.max_element(), emission };
        let size = match region {
            // All of space has no chord; one unit of length stands in.
            Region::Everywhere => Vec3A::ONE,
            _ => region.bounds().size(),
        };
        let bounds = CoefficientBounds::Uniform(inside, majorant);
        let energy = Energy::uniform(region, emission);
        let chords = emission * size;
        Self { region, properties, motion: None, bounds, voxel: None, chords, energy }
    }

    /// A volume whose coefficients vary inside a box, bounded over cells of about `cell_size`.
    /// `voxel` is the edge of the smallest stored voxel in the volume's space, if any is stored.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn varying(
        bounds: Aabb,
        properties: MediumProperties,
        cell_size: Vec3A,
        voxel: Option<f32>,
        progress: Progress,
    ) -> Result<Self> {
        Self::bounded(bounds, properties, None, (cell_size, voxel), progress)
    }

    /// [`Volume::varying`] in `motion`. All its bounds hold while the shutter is open, and its box
    /// is as large as that takes.
    ///
    /// # Errors
    /// [`Error::Cancelled`](crate::error::Error::Cancelled) where `progress` says so.
    pub fn moving(
        motion: Motion,
        properties: MediumProperties,
        cell_size: Vec3A,
        voxel: Option<f32>,
        progress: Progress,
    ) -> Result<Self> {
        Self::bounded(motion.reach(), properties, Some(motion), (cell_size, voxel), progress)
    }

    fn bounded(
        bounds: Aabb,
        properties: MediumProperties,
        motion: Option<Motion>,
        (cell_size, voxel): (Vec3A, Option<f32>),
        progress: Progress,
    ) -> Result<Self> {
        let part = |index: usize| move |fraction: f32| progress((index as f32 + fraction) / 3.0);
        let bounds_over = |cell: &Aabb| match &motion {
            None => properties.bounds_over(cell),
            Some(motion) => properties.bounds_in_motion(motion, cell),
        };
        let cells = MajorantGrid::build(bounds, cell_size, bounds_over, &part(0))?;
        // Read at times spread over the shutter, so that the light is sought where it passes.
        let emission = |local: Vec3A, u: f32| match &motion {
            None => luminance(properties.at(local).emission),
            Some(motion) => motion
                .source(local, (u - 0.5) * motion.shutter().open)
                .map_or(0.0, |source| luminance(properties.at(source).emission)),
        };
        let chords = match properties.emission.is_some() {
            true => probe_chords(&cells, &|local| emission(local, 0.5), &part(1))?,
            false => Vec3A::ZERO,
        };
        let energy = Energy::varying(&cells, emission, &part(2))?;
        let (region, bounds) = (Region::Box(bounds), CoefficientBounds::Cells(cells));
        Ok(Self { region, properties, motion, bounds, voxel, chords, energy })
    }

    /// Region of the volume; of one in motion wherever it can be while the shutter is open.
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// Properties of the volume's medium, which hold at [`Volume::source`] of a point.
    pub fn properties(&self) -> &MediumProperties {
        &self.properties
    }

    /// Motion of the volume; `None` for one that stands still.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// The point of the volume's space that has moved to `local` at a time, in seconds after that
    /// of the frame; `None` where there is nothing. `local` itself where nothing moves.
    #[inline]
    pub fn source(&self, local: Vec3A, time: f32) -> Option<Vec3A> {
        match &self.motion {
            None => Some(local),
            Some(motion) => motion.source(local, time),
        }
    }

    /// Bounds of the volume's coefficients.
    pub fn bounds(&self) -> &CoefficientBounds {
        &self.bounds
    }

    /// Edge of a voxel in the volume's space, if any is stored.
    pub fn voxel(&self) -> Option<f32> {
        self.voxel
    }

    /// Largest ∫ lum ε along the probing chords of each axis, in the volume's own lengths.
    pub fn chords(&self) -> Vec3A {
        self.chords
    }

    /// Distribution of the emitted power; `None` for volumes that don't emit or fill all of space.
    pub fn energy(&self) -> Option<&Energy> {
        self.energy.as_ref()
    }
}

/// Sums the emission at the cells' centers along every row of cells of each axis, at the time of
/// the frame, and keeps the largest sum. It only sets the unit of the boost amount, so a coarse sum
/// will do; but sparks between the centers count too, half a cell long, so that the unit does not
/// vanish.
fn probe_chords(
    cells: &MajorantGrid,
    emission: &dyn Fn(Vec3A) -> f32,
    progress: Progress,
) -> Result<Vec3A> {
    let mut brightest = 0.0_f32;
    let mut rows = std::collections::BTreeMap::<(usize, i32, i32), f32>::new();
    for (index, majorant) in cells.cells().iter().enumerate() {
        if majorant.emission <= 0.0 {
            continue;
        }
        report(progress, index as f32 / cells.cells().len() as f32)?;
        let cell = cells.grid().cell(index);
        let region = cells.grid().whole(cell);
        let emission = emission(region.center());
        brightest = brightest.max(majorant.emission);
        for axis in 0..3 {
            let row: IVec3 = cell;
            let key = (axis, row[(axis + 1) % 3], row[(axis + 2) % 3]);
            *rows.entry(key).or_default() += emission * cells.cell_size()[axis];
        }
    }
    let least = 0.5 * brightest * cells.cell_size();
    Ok(rows.iter().fold(least, |mut chords, (&(axis, ..), &sum)| {
        chords[axis] = chords[axis].max(sum);
        chords
    }))
}
