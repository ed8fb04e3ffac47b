//! Sources of a volume's values: the grids of a file or the formula of a shape. Both have the same
//! interface, so that density, albedo and emission need not know which it is.

use glam::{Affine3A, DAffine3, Vec3A};

use crate::error::{Error, Progress, Result};
use crate::math::{Aabb, Rgb};
use crate::scene::cache::{GridValues, PlacedGrid, VolumeFile};
use crate::scene::file_box::FileBox;
use crate::scene::sequence::Gap;
use crate::scene::settings::{RampKind, VolumeSettings, VolumeShape};
use crate::volume::curve::Curve;
use crate::volume::field::{GridField, RgbField, ScalarField, grid_support};
use crate::volume::grid::GridClass;
use crate::volume::procedural;
use crate::volume::procedural::{Noise, Ramp};
use crate::volume::{Region, Taper};

/// The grids of a file that a volume has asked for. Its own space is the index space of the first
/// of them.
pub(super) struct GridSource<'a> {
    file: &'a VolumeFile,
    /// Whether the file lacks a grid that other frames of its sequence have.
    lacks: &'a dyn Fn(&str) -> Result<bool>,
    gaps: Vec<Gap>,
    progress: Progress<'a>,
    file_from_local: Option<DAffine3>,
    bounds: Aabb,
    /// Edge of the smallest voxel, in the volume's own space.
    voxel: f32,
}

/// Source of a shape, which has one field.
pub(super) struct ShapeSource {
    pub(super) region: Region,
    pub(super) field: ScalarField,
    /// The size of the cells that bound a field that varies.
    pub(super) cell_size: Vec3A,
}

/// Source of a volume's values: a file or a shape.
pub(super) enum VolumeSource<'a> {
    Grids(GridSource<'a>),
    Shape(ShapeSource),
}

impl<'a> VolumeSource<'a> {
    /// The density: a grid of single numbers, or the fog of a level set; `field` is the key that
    /// names the grid.
    pub(super) fn density(
        &mut self,
        settings: &VolumeSettings,
        field: &str,
    ) -> Result<ScalarField> {
        let name = settings.density_grid();
        let curve = Curve::new(&settings.density.curve);
        match self {
            Self::Grids(grids) if settings.density.level_set => {
                let found = grids.find_fog(name, field)?;
                Ok(through(grids.scalar(found, name, field)?, curve))
            }
            _ => self.curved(name, field, &settings.density.curve),
        }
    }

    /// The values of a grid of single numbers, mapped by the curve through `points`; `field` is the
    /// key that names the grid.
    pub(super) fn curved(
        &mut self,
        grid: &str,
        field: &str,
        points: &[[f32; 2]],
    ) -> Result<ScalarField> {
        let (values, curve) = (self.scalar(grid, field)?, Curve::new(points));
        Ok(match self {
            Self::Shape(_) => values.through(curve),
            Self::Grids(_) => through(values, curve),
        })
    }

    /// The values of a grid of single numbers; `field` is the key that names the grid.
    pub(super) fn scalar(&mut self, grid: &str, field: &str) -> Result<ScalarField> {
        match self {
            Self::Shape(shape) => shape.scalar(grid, field),
            Self::Grids(grids) => {
                let found = grids.find(grid, field)?;
                grids.scalar(found, grid, field)
            }
        }
    }

    /// The values of a grid of colors or of single numbers, which stand for grays.
    pub(super) fn rgb(&mut self, grid: &str, field: &str) -> Result<RgbField> {
        let gray = |values| RgbField::Tinted(values, Rgb::ONE);
        match self {
            Self::Shape(shape) => shape.scalar(grid, field).map(gray),
            Self::Grids(grids) => Ok(match grids.find(grid, field)?.map(|g| grids.place(g)) {
                None => RgbField::Constant(Rgb::ZERO),
                Some((GridValues::Float(values), from_local, taper)) => {
                    gray(ScalarField::Grid(GridField::new(values, from_local, taper.as_ref())))
                }
                Some((GridValues::Vector(values), from_local, taper)) => {
                    RgbField::Grid(GridField::new(values, from_local, taper.as_ref()))
                }
            }),
        }
    }
}

/// The values of a grid through a curve. One that the file lacks stays zero, whatever the curve.
fn through(values: ScalarField, curve: Option<Curve>) -> ScalarField {
    match values {
        ScalarField::Constant(_) => values,
        _ => values.through(curve),
    }
}

impl<'a> GridSource<'a> {
    /// The grids of `file`, of which those that it `lacks` count as zero.
    pub(super) fn new(
        file: &'a VolumeFile,
        lacks: &'a dyn Fn(&str) -> Result<bool>,
        progress: Progress<'a>,
    ) -> Self {
        let (gaps, bounds, voxel) = (Vec::new(), Aabb::EMPTY, f32::INFINITY);
        Self { file, lacks, gaps, progress, file_from_local: None, bounds, voxel }
    }

    /// The grids asked for that the file lacks.
    pub(super) fn into_gaps(self) -> Vec<Gap> {
        self.gaps
    }

    /// Transform from the volume's own space to that of the file.
    pub(super) fn file_from_local(&self) -> DAffine3 {
        self.file_from_local.unwrap_or(DAffine3::IDENTITY)
    }

    /// The box around all grids asked for, in the volume's own space.
    pub(super) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Edge of the smallest voxel of the grids asked for, in the volume's own space.
    pub(super) fn voxel(&self) -> Option<f32> {
        self.voxel.is_finite().then_some(self.voxel)
    }

    /// The values of a grid of single numbers that was `found`; zero without one.
    fn scalar(
        &mut self,
        found: Option<PlacedGrid>,
        name: &str,
        field: &str,
    ) -> Result<ScalarField> {
        match found.map(|grid| self.place(grid)) {
            None => Ok(ScalarField::Constant(0.0)),
            Some((GridValues::Float(values), from_local, taper)) => {
                Ok(ScalarField::Grid(GridField::new(values, from_local, taper.as_ref())))
            }
            Some((GridValues::Vector(_), ..)) => {
                let reason = format!("the grid \"{name}\" holds vectors; name one of numbers");
                Err(Error::invalid(self.file.name(), field, reason))
            }
        }
    }

    /// The values of a grid, and the transform to its index space from the volume's own.
    fn place(&mut self, grid: PlacedGrid) -> (GridValues, Affine3A, Option<Taper>) {
        let local_from_grid = self.local_from_grid(&grid);
        self.voxel = self.voxel.min(shortest_edge(&local_from_grid));
        let local_from_grid = local_from_grid.as_affine3a();
        self.bounds = self.bounds.union(&support(&grid).transformed(&local_from_grid));
        (grid.values, local_from_grid.inverse(), grid.taper)
    }

    /// Transform from the index space of a grid, of a frustum its spread space, to the volume's
    /// own.
    pub(super) fn local_from_grid(&mut self, grid: &PlacedGrid) -> DAffine3 {
        let file_from_local = *self.file_from_local.get_or_insert(grid.world_from_index);
        file_from_local.inverse() * grid.world_from_index
    }

    /// A grid of the file; `None` for one that it lacks and that counts as zero.
    pub(super) fn find(&mut self, name: &str, field: &str) -> Result<Option<PlacedGrid>> {
        if self.is_gap(name)? {
            return Ok(None);
        }
        let grid = self.file.grid(name, field, self.progress)?;
        if grid.class == GridClass::LevelSet {
            let help = match field.strip_suffix(".density.grid") {
                Some(volume) => {
                    format!("{volume}.density.level_set = true shows its inside as fog")
                }
                None => "convert it to a fog volume before exporting it".to_owned(),
            };
            let reason =
                format!("the grid \"{name}\" is a level set, distances to a surface; {help}");
            return Err(Error::unsupported(self.file.name(), field, reason));
        }
        Ok(Some(grid))
    }

    /// The fog of a level set of the file; `None` for one that it lacks and that counts as zero.
    fn find_fog(&mut self, name: &str, field: &str) -> Result<Option<PlacedGrid>> {
        if self.is_gap(name)? {
            return Ok(None);
        }
        self.file.fog(name, field, self.progress).map(Some)
    }

    /// Whether the file lacks a grid that counts as zero, which is remembered then.
    fn is_gap(&mut self, name: &str) -> Result<bool> {
        let is_gap = (self.lacks)(name)?;
        if is_gap {
            let (file, grid) = (self.file.name().to_owned(), name.to_owned());
            self.gaps.push(Gap::Grid { file, grid });
        }
        Ok(is_gap)
    }

    /// Name of the file.
    pub(super) fn file_name(&self) -> &str {
        self.file.name()
    }
}

impl ShapeSource {
    pub(super) fn new(shape: VolumeShape, settings: &VolumeSettings) -> Self {
        let half_size = Vec3A::from_array(settings.half_size().axes());
        let bounds = Aabb::centered(half_size);
        let (region, field, cell_size) = match shape {
            VolumeShape::Box => (Region::Box(bounds), ScalarField::Constant(1.0), bounds.size()),
            VolumeShape::Sphere => {
                let radius = settings.radius();
                (Region::Sphere { radius }, ScalarField::Constant(1.0), Vec3A::splat(radius))
            }
            VolumeShape::Everywhere => (Region::Everywhere, ScalarField::Constant(1.0), Vec3A::ONE),
            VolumeShape::Ramp => {
                let axis = settings.axis().index();
                let mut cell_size = bounds.size();
                cell_size[axis] /= RAMP_CELLS;
                (Region::Box(bounds), ScalarField::Ramp(ramp(settings, &bounds)), cell_size)
            }
            VolumeShape::Noise => {
                let noise = noise(settings);
                let cell_size = Vec3A::splat(NOISE_CELL / noise.frequency).min(bounds.size());
                (Region::Box(bounds), ScalarField::Noise(noise), cell_size)
            }
        };
        Self { region, field, cell_size }
    }

    fn scalar(&self, grid: &str, field: &str) -> Result<ScalarField> {
        if grid == VolumeSettings::DENSITY {
            return Ok(self.field.clone());
        }
        let reason = format!(
            "there is no grid \"{grid}\"; a shape has only \"{}\", its own value",
            VolumeSettings::DENSITY
        );
        Err(Error::invalid("", field, reason))
    }
}

/// Cells along a ramp's axis.
const RAMP_CELLS: f32 = 64.0;
/// Edge of the cells of a noise, in lattice cells of its first octave.
const NOISE_CELL: f32 = 0.25;

fn ramp(settings: &VolumeSettings, bounds: &Aabb) -> Ramp {
    let axis = settings.axis().index();
    let kind = match settings.kind() {
        RampKind::Linear => procedural::RampKind::Linear { a: settings.a(), b: settings.b() },
        RampKind::Exponential => {
            procedural::RampKind::Exponential { a: settings.a(), h: settings.h() }
        }
    };
    Ramp { axis, low: bounds.min[axis], kind }
}

fn noise(settings: &VolumeSettings) -> Noise {
    Noise {
        frequency: settings.frequency(),
        octaves: settings.octaves(),
        contrast: settings.contrast(),
        seed: settings.seed(),
    }
}

/// The box that a grid fills, in its index space or, of a frustum, around it in spread space.
fn support(grid: &PlacedGrid) -> Aabb {
    match (grid.taper, grid.bounds(), &grid.values) {
        (Some(taper), Some(voxels), _) => {
            FileBox::around(&voxels, &DAffine3::IDENTITY, Some(&taper)).to_aabb()
        }
        (_, _, GridValues::Float(values)) => grid_support(values),
        (_, _, GridValues::Vector(values)) => grid_support(values),
    }
}

fn shortest_edge(affine: &DAffine3) -> f32 {
    let matrix = affine.matrix3;
    let edges = [matrix.x_axis.length(), matrix.y_axis.length(), matrix.z_axis.length()];
    edges.into_iter().fold(f64::INFINITY, f64::min) as f32
}
