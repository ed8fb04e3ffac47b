//! Level sets as fog: the inside of a surface as a density that rises from 0 at the surface to 1 as
//! deep inside as distances were stored.

use std::collections::HashMap;

use glam::IVec3;

use super::block_id::BlockId;
use super::index::{NODE_EDGE, NODE_VOXEL_BITS, NodeBlocks, node_of};
use super::index_box::IndexBox;
use super::leaf::Leaf;
use super::{GridBuilder, SparseGrid};
use crate::error::{Error, Progress, Result};

/// Voxels along the edge of a node.
const NODE_VOXELS: u32 = 1 << NODE_VOXEL_BITS;
/// Voxels along the edge of a block.
const BLOCK_VOXELS: i32 = 8;
/// Part of the progress that reading the distances takes; the rest is building the fog.
const READING: f32 = 0.5;

/// Density of a fog by the signed distance, negative inside.
#[derive(Clone, Copy)]
struct Ramp {
    /// Distance inside the surface from which on the density is 1.
    half_width: f32,
}

impl Ramp {
    fn density(self, distance: f32) -> f32 {
        if distance < 0.0 { (-distance / self.half_width).min(1.0) } else { 0.0 }
    }
}

impl SparseGrid<f32> {
    /// The fog of a level set: at a voxel with the signed distance d it is −d divided by the
    /// half-width of the stored band, clamped to 0..1, and inactive where it is zero. The
    /// half-width is the background, which is the distance beyond the band; where that is zero,
    /// it is the largest distance inside.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the background is negative, so that all of space is inside;
    /// [`Error::Cancelled`].
    pub fn fog_of_level_set(&self, progress: Progress) -> Result<Self> {
        let background = self.background();
        if background < 0.0 {
            let reason = "its distances are negative outside as well, so that it has no inside";
            return Err(Error::invalid("", "", reason));
        }
        let half_width = if background > 0.0 { background } else { -self.total_range.0 };
        let ramp = Ramp { half_width };
        let mut fog = GridBuilder::new(0.0);
        let nodes = self.nodes();
        let mut uniform: HashMap<u32, Option<f32>> = HashMap::new();
        for (done, (position, number)) in nodes.iter().enumerate() {
            if !progress(READING * done as f32 / nodes.len() as f32) {
                return Err(Error::Cancelled);
            }
            let Some(node) = self.index.nodes.get(*number as usize) else { continue };
            let origin = *position << NODE_VOXEL_BITS;
            match *uniform.entry(*number).or_insert_with(|| self.constant_of(node)) {
                Some(distance) => add_tile(&mut fog, origin, NODE_VOXELS, ramp.density(distance))?,
                None => self.add_fog(&mut fog, origin, node, ramp)?,
            }
        }
        let mut fog = fog.finish(&|part| progress(READING + (1.0 - READING) * part))?;
        fog.origin = self.origin;
        Ok(fog)
    }

    /// Positions and numbers of the nodes with voxels that are not plain background.
    fn nodes(&self) -> Vec<(IVec3, u32)> {
        let mut nodes = Vec::new();
        if let Some(IndexBox { min, max }) = self.bounds() {
            let around = IndexBox { min: node_of(min), max: node_of(max) };
            self.index.visit(&around, |position, number| {
                if number != 0 {
                    nodes.push((position, number));
                }
            });
        }
        nodes
    }

    /// The value of a node that has the same one everywhere.
    fn constant_of(&self, node: &NodeBlocks) -> Option<f32> {
        let constant = |block: &BlockId| {
            block.is_constant().then(|| self.blocks.constants.get(block.number()).copied())?
        };
        let first = node.first().and_then(constant)?;
        node.iter().all(|block| constant(block) == Some(first)).then_some(first)
    }

    /// Adds the fog of a node that starts at the voxel `origin`.
    fn add_fog(
        &self,
        fog: &mut GridBuilder<f32>,
        origin: IVec3,
        node: &NodeBlocks,
        ramp: Ramp,
    ) -> Result<()> {
        let mut leaves = Vec::new();
        for (place, &block) in node.iter().enumerate() {
            let place = place as i32;
            let [x, y, z] =
                [place / NODE_EDGE / NODE_EDGE, place / NODE_EDGE % NODE_EDGE, place % NODE_EDGE];
            let origin = origin + BLOCK_VOXELS * IVec3::new(x, y, z);
            if block.is_constant() {
                let density = ramp.density(self.blocks.value(block, 0));
                add_tile(fog, origin, BLOCK_VOXELS as u32, density)?;
                continue;
            }
            let values = std::array::from_fn(|at| ramp.density(self.blocks.value(block, at)));
            let mut leaf = Leaf { origin, values, active: [0; 8] };
            for (at, _) in leaf.values.iter().enumerate().filter(|(_, value)| **value > 0.0) {
                leaf.active[at >> 6] |= 1 << (at & 63);
            }
            if leaf.active != [0; 8] {
                leaves.push(leaf);
            }
        }
        fog.add_leaves(leaves);
        Ok(())
    }
}

/// Adds a box of equal density, unless that is zero.
fn add_tile(fog: &mut GridBuilder<f32>, origin: IVec3, edge: u32, density: f32) -> Result<()> {
    match density > 0.0 {
        true => fog.add_tile(origin, edge, density, true),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::NO_PROGRESS;

    const HALF_WIDTH: f32 = 3.0;

    /// Distances to a sphere of that radius about the origin of index space, in leaves where they
    /// are within the half-width and in tiles elsewhere.
    fn sphere(radius: f32, background: f32) -> SparseGrid<f32> {
        let mut builder = GridBuilder::new(background);
        let mut leaves = Vec::new();
        let edge = radius as i32 / 8 + 2;
        let all = IndexBox { min: IVec3::splat(-edge), max: IVec3::splat(edge) };
        for origin in all.positions().map(|block| block * 8) {
            let mut leaf = Leaf { origin, values: [0.0; 512], active: [0; 8] };
            for at in 0..512 {
                let distance = leaf.voxel(at).as_vec3().length() - radius;
                leaf.values[at] = distance.clamp(-HALF_WIDTH, HALF_WIDTH);
                if distance.abs() < HALF_WIDTH {
                    leaf.active[at >> 6] |= 1 << (at & 63);
                }
            }
            match leaf.active == [0; 8] {
                true => builder.add_tile(origin, 8, leaf.values[0], false).unwrap(),
                false => leaves.push(leaf),
            }
        }
        builder.add_leaves(leaves);
        builder.finish(NO_PROGRESS).unwrap()
    }

    #[test]
    fn density_rises_with_the_depth_up_to_the_half_width() {
        for background in [HALF_WIDTH, 0.0] {
            let fog = sphere(30.0, background).fog_of_level_set(NO_PROGRESS).unwrap();
            let around = IndexBox { min: IVec3::splat(-36), max: IVec3::splat(36) };
            for voxel in around.positions() {
                let depth = 30.0 - voxel.as_vec3().length();
                let wanted = depth.clamp(0.0, HALF_WIDTH) / HALF_WIDTH;
                assert_eq!(fog.value(voxel), wanted, "{voxel}");
            }
            let bounds = IndexBox { min: IVec3::splat(-29), max: IVec3::splat(29) };
            assert_eq!(fog.bounds(), Some(bounds), "of what is above zero");
            assert_eq!(
                (fog.background(), fog.stats().min > 0.0, fog.stats().max),
                (0.0, true, 1.0)
            );
        }
    }

    #[test]
    fn tiles_of_any_size_stay_tiles() {
        let mut builder = GridBuilder::new(2.0);
        builder.add_tile(IVec3::splat(-4096), 4096, -2.0, false).unwrap();
        builder.add_tile(IVec3::ZERO, 8, -0.5, false).unwrap();
        let fog = builder.finish(NO_PROGRESS).unwrap().fog_of_level_set(NO_PROGRESS).unwrap();
        assert_eq!(fog.value(IVec3::splat(-4096)), 1.0);
        assert_eq!(fog.value(IVec3::splat(7)), 0.25);
        assert_eq!(fog.stats().active_voxels, (1 << 36) + 512);
        assert!(fog.stats().memory_bytes < 1 << 20, "{}", fog.stats().memory_bytes);
    }

    #[test]
    fn a_level_set_without_an_inside_is_empty_or_refused() {
        let outside = SparseGrid::from_dense(IVec3::ZERO, glam::UVec3::ONE, &[1.0], 1.0).unwrap();
        assert_eq!(outside.fog_of_level_set(NO_PROGRESS).unwrap().bounds(), None);
        let nothing = GridBuilder::<f32>::new(0.0).finish(NO_PROGRESS).unwrap();
        assert_eq!(nothing.fog_of_level_set(NO_PROGRESS).unwrap().bounds(), None);
        let inverted = GridBuilder::<f32>::new(-1.0).finish(NO_PROGRESS).unwrap();
        let error = inverted.fog_of_level_set(NO_PROGRESS).unwrap_err().to_string();
        assert!(error.contains("negative outside"), "{error}");
        assert!(matches!(sphere(9.0, 3.0).fog_of_level_set(&|_| false), Err(Error::Cancelled)));
    }

    #[test]
    fn a_grid_that_was_moved_stays_where_it_is() {
        let at = IVec3::splat(1_000_000);
        let mut grid = SparseGrid::from_dense(at, glam::UVec3::ONE, &[-1.0], 2.0).unwrap();
        grid.rebase();
        let fog = grid.fog_of_level_set(NO_PROGRESS).unwrap();
        assert_eq!(fog.origin(), grid.origin());
        assert_eq!(fog.value(at - fog.origin()), 0.5);
    }
}
