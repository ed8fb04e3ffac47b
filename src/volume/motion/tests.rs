//! Bounds of volumes in motion hold at every time, and cost only where something moves.

use std::sync::Arc;

use glam::{Affine3A, IVec3, Mat3A, UVec2, UVec3, Vec3A};

use super::*;
use crate::error::NO_PROGRESS;
use crate::math::{PathRng, Rgb, luminance};
use crate::volume::emission::Emission;
use crate::volume::field::RgbField;
use crate::volume::grid::SparseGrid;
use crate::volume::phase::Phase;
use crate::volume::procedural::Noise;
use crate::volume::{CoefficientBounds, MediumProperties, Volume};

const BOX: Aabb = Aabb { min: Vec3A::new(-1.0, -0.5, -2.0), max: Vec3A::new(1.5, 1.0, 2.0) };
/// Open from -0.01 to 0.03 after the time of the grids.
const SHUTTER: Shutter = Shutter { frame: 0.01, open: 0.04 };

fn noise(seed: u32) -> ScalarField {
    ScalarField::Noise(Noise { frequency: 1.3, octaves: 3, contrast: 2.0, seed })
}

fn properties() -> MediumProperties {
    MediumProperties {
        density: noise(1),
        density_scale: Rgb::new(3.0, 2.0, 1.0),
        albedo: RgbField::Constant(Rgb::splat(0.5)),
        phase: Phase::default(),
        emission: Emission::Field { field: RgbField::Tinted(noise(2), Rgb::ONE), scale: Rgb::ONE },
    }
}

/// A swirl of noise that moves matter by about a fifth of the box, within `support`.
fn swirl(support: Aabb, shutter: Shutter) -> Motion {
    let columns = [Vec3A::new(40.0, -30.0, 0.0), Vec3A::new(-20.0, 0.0, 25.0), -30.0 * Vec3A::ONE];
    let velocity = VelocityField::Components([3, 4, 5].map(noise));
    let linear = Mat3A::from_cols(columns[0], columns[1], columns[2]);
    Motion::new(velocity, support, linear, BOX, shutter)
}

fn moving(motion: Motion) -> Volume {
    Volume::moving(motion, properties(), Vec3A::splat(0.2), None, NO_PROGRESS).unwrap()
}

fn point(rng: &mut PathRng, bounds: &Aabb) -> Vec3A {
    let u = Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform());
    bounds.min + u * bounds.size()
}

#[test]
fn bounds_hold_at_every_point_and_time() {
    let everywhere = Aabb::centered(Vec3A::splat(9.0));
    let volume = moving(swirl(everywhere, SHUTTER));
    let CoefficientBounds::Cells(cells) = volume.bounds() else { panic!("it varies") };
    let reach = volume.region().bounds();
    assert!(reach.size().cmpgt(BOX.size() + 0.2).all() && reach.size().max_element() < 8.0);
    let wide = Aabb::centered(Vec3A::splat(4.0));
    let mut rng = PathRng::new(0, UVec2::ZERO, 0);
    let (mut met, mut near, mut beyond) = (0, 0, 0);
    for _ in 0..200_000 {
        let (at, time) = (point(&mut rng, &wide), (rng.uniform() - 0.5) * SHUTTER.open);
        let Some(source) = volume.source(at, time) else { continue };
        let found = volume.properties().at(source);
        assert!(reach.contains(at), "{at} at {time} lies outside of {reach:?}");
        let index = cells.grid().index(cells.grid().cell_at(at));
        let bound = cells.cells()[index];
        assert!(found.mu_t.max_element() <= bound.mu_t, "{at} at {time}: {found:?} {bound:?}");
        assert!(luminance(found.emission) <= bound.emission, "{at} at {time}");
        let energy = volume.energy().unwrap();
        assert!(luminance(found.emission) <= 0.0 || energy.pdf_at(at) > 0.0, "{at} at {time}");
        let ray = crate::math::Ray::new(at, Vec3A::X);
        let mut walk = cells.walk(&ray, 0.0, 1e-4);
        if cells.next_occupied(&mut walk).is_some() {
            assert!(cells.minorant(&walk) <= found.mu_t.max_element(), "{at} at {time}");
        }
        met += 1;
        near += u32::from(found.mu_t.max_element() > 0.8 * bound.mu_t);
        beyond += u32::from(!BOX.contains(at));
    }
    assert!(met > 5000 && near > 100 && beyond > 500, "{met} {near} {beyond}");
}

/// Where nothing moves, or in the one moment of the grids, all is as without motion.
#[test]
fn without_motion_the_bounds_are_those_of_the_still() {
    let still = Volume::varying(BOX, properties(), Vec3A::splat(0.2), None, NO_PROGRESS).unwrap();
    let [CoefficientBounds::Cells(still), ..] = [still.bounds()] else { panic!("it varies") };
    let nothing = VelocityField::Components([0.0; 3].map(ScalarField::Constant));
    let resting = Motion::new(nothing, BOX, Mat3A::IDENTITY, BOX, SHUTTER);
    let motion = moving(resting);
    assert_eq!(motion.region().bounds(), BOX);
    let CoefficientBounds::Cells(cells) = motion.bounds() else { panic!("it varies") };
    assert_eq!(cells.cells(), still.cells());
    assert_eq!(motion.source(Vec3A::splat(0.3), 0.02), Some(Vec3A::splat(0.3)));
    assert_eq!(motion.source(Vec3A::splat(1.2), 0.02), None);
}

/// A vector field is read where its samples lie: at the middle of voxels, or with each component at
/// the faces across its axis.
#[test]
fn components_are_read_at_their_faces() {
    let values: Vec<Vec3A> = (0..512)
        .map(|n| IVec3::new(n / 64, n / 8 % 8, n % 8).as_vec3a())
        .map(|voxel| Vec3A::new(voxel.x + 10.0 * voxel.y, voxel.y, 2.0 * voxel.z + voxel.x))
        .collect();
    let grid = SparseGrid::from_dense(IVec3::ZERO, UVec3::splat(8), &values, Vec3A::ZERO).unwrap();
    let grid = Arc::new(grid);
    let field = |offset: Vec3A| {
        let place = Affine3A::from_translation(offset.into());
        GridField::new(grid.clone(), place, None)
    };
    let centers = VelocityField::Centers(field(Vec3A::ZERO));
    let faces = VelocityField::Faces([Vec3A::X, Vec3A::Y, Vec3A::Z].map(|axis| field(0.5 * axis)));
    let at = Vec3A::new(2.25, 3.5, 4.75);
    assert_eq!(centers.at(at), Vec3A::new(37.25, 3.5, 11.75));
    assert_eq!(faces.at(at), Vec3A::new(37.75, 4.0, 12.75));
    let (low, high) = faces.range(&Aabb::new(at, at));
    assert!(low.cmple(faces.at(at)).all() && high.cmpge(faces.at(at)).all());
}

/// One voxel faster than the box is wide reaches it from afar; the volume grows to it, and no
/// further.
#[test]
fn a_volume_reaches_as_far_as_something_moves() {
    let mut values = vec![Vec3A::ZERO; 64 * 8 * 8];
    values[40 * 64 + 3 * 8 + 3] = 1000.0 * Vec3A::X;
    let dims = UVec3::new(64, 8, 8);
    let grid = SparseGrid::from_dense(IVec3::ZERO, dims, &values, Vec3A::ZERO).unwrap();
    let velocity = VelocityField::Centers(GridField::new(Arc::new(grid), Affine3A::IDENTITY, None));
    let support = Aabb::new(Vec3A::splat(-0.5), Vec3A::new(63.5, 7.5, 7.5));
    let still = Aabb::new(Vec3A::splat(-0.5), Vec3A::splat(7.5));
    let reach = |linear: Mat3A, shutter: Shutter| {
        Motion::new(velocity.clone(), support, linear, still, shutter).reach()
    };
    let far = reach(Mat3A::IDENTITY, Shutter { frame: 0.05, open: 0.1 });
    assert!(far.max.x >= 41.0 && far.max.x < 50.0, "{far:?}");
    assert!(reach(Mat3A::IDENTITY, Shutter { frame: -0.05, open: 0.1 }).max.x < 7.6);
    let slow = Mat3A::from_diagonal(glam::Vec3::splat(0.01));
    assert!(reach(slow, Shutter { frame: 0.05, open: 0.1 }).max.x < 8.1);
    let absurd = Mat3A::from_diagonal(glam::Vec3::splat(f32::MAX));
    assert!(support.union(&still).contains(reach(absurd, SHUTTER).max));
}

/// Velocities beyond all numbers give no value that is none.
#[test]
fn absurd_velocities_lead_nowhere() {
    let velocity = VelocityField::Components([f32::MAX / 2.0; 3].map(ScalarField::Constant));
    let linear = Mat3A::from_diagonal(glam::Vec3::splat(1e9));
    let volume = moving(Motion::new(velocity, BOX, linear, BOX, SHUTTER));
    for time in [-0.01, 0.0, 0.01] {
        assert_eq!(volume.source(Vec3A::ZERO, time), None);
    }
    let CoefficientBounds::Cells(cells) = volume.bounds() else { panic!("it varies") };
    assert!(cells.cells().iter().all(|cell| cell.mu_t.is_finite()));
}
