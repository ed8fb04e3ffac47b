//! A small bounding volume hierarchy over boxes that finds every box a ray enters.

use glam::Vec3A;

use super::{Aabb, Ray};

/// Items per leaf: testing a few boxes costs less than descending further.
const LEAF_SIZE: usize = 2;

/// A hierarchy over the boxes of items, by index.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Aabb,
    /// First item of a leaf, or index of the right child (the left one follows its parent).
    first_or_right: u32,
    /// Number of items of a leaf; 0 for an inner node.
    count: u32,
}

impl Bvh {
    /// Builds the hierarchy by splitting at the median of the longest axis.
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut bvh = Self { nodes: Vec::new(), items: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            bvh.split(boxes, 0, boxes.len());
        }
        bvh
    }

    fn split(&mut self, boxes: &[Aabb], start: usize, end: usize) {
        let items = &mut self.items[start..end];
        let bounds = items.iter().fold(Aabb::EMPTY, |b, &i| b.union(&boxes[i as usize]));
        let node = self.nodes.len();
        if items.len() <= LEAF_SIZE {
            let count = items.len() as u32;
            self.nodes.push(Node { bounds, first_or_right: start as u32, count });
            return;
        }
        let axis = longest_axis(bounds.size());
        let middle = items.len() / 2;
        let center = |i: &u32| boxes[*i as usize].center()[axis];
        items.select_nth_unstable_by(middle, |a, b| {
            center(a).total_cmp(&center(b)).then_with(|| a.cmp(b))
        });
        self.nodes.push(Node { bounds, first_or_right: 0, count: 0 });
        self.split(boxes, start, start + middle);
        self.nodes[node].first_or_right = self.nodes.len() as u32;
        self.split(boxes, start + middle, end);
    }

    /// Calls `visit` with the index of every item whose neighborhood `ray` enters before `t_max`;
    /// the item's own box is left to the caller. `visit` returns the new `t_max`.
    pub fn visit(&self, ray: &Ray, mut t_max: f32, mut visit: impl FnMut(u32, f32) -> f32) {
        if self.nodes.is_empty() {
            return;
        }
        // A median split halves the items, so 64 levels hold any count that fits in memory.
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if node.bounds.intersect(ray, 0.0, t_max).is_none() {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.first_or_right;
                stack[depth + 1] = index as u32 + 1;
                depth += 2;
                continue;
            }
            let first = node.first_or_right as usize;
            for &item in &self.items[first..first + node.count as usize] {
                t_max = visit(item, t_max);
            }
        }
    }
}

fn longest_axis(size: Vec3A) -> usize {
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::math::PathRng;

    #[test]
    fn finds_every_box_that_a_linear_search_finds() {
        let mut rng = PathRng::new(0, glam::UVec2::ZERO, 0);
        let mut point = |scale: f32| {
            scale * Vec3A::new(rng.random::<f32>(), rng.random::<f32>(), rng.random::<f32>())
        };
        let boxes: Vec<Aabb> = (0..200)
            .map(|_| {
                let min = point(10.0);
                Aabb::new(min, min + point(1.0))
            })
            .collect();
        let bvh = Bvh::new(&boxes);
        for _ in 0..200 {
            let ray = Ray::new(point(10.0), (point(2.0) - Vec3A::ONE).normalize());
            let hit = |b: &Aabb| b.intersect(&ray, 0.0, f32::INFINITY).is_some();
            let linear: Vec<u32> = (0..200).filter(|&i| hit(&boxes[i as usize])).collect();
            let mut found = Vec::new();
            bvh.visit(&ray, f32::INFINITY, |i, t_max| {
                found.extend(hit(&boxes[i as usize]).then_some(i));
                t_max
            });
            found.sort_unstable();
            assert_eq!(found, linear);
        }
    }
}
