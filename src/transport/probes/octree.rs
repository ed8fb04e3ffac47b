//! An octree over a cube, and its leaves along a ray.

use glam::{IVec3, UVec3, Vec3A};

use crate::math::{Aabb, Ray};

/// Most cuts above a leaf.
pub(super) const DEEPEST: u32 = 12;
/// A ray moves on by at least this share of a leaf's edge, lest rounding hold it at a face.
const LEAST_STEP: f32 = 1e-3;

/// The octree. Nodes are identified by their index; 0 is the root.
#[derive(Clone, Debug)]
pub(super) struct Octree {
    low: Vec3A,
    edge: f32,
    /// The first of a node's eight children; 0 for leaves.
    children: Vec<u32>,
}

/// Location of a point of a ray in the octree.
#[derive(Clone, Copy, Debug)]
pub(super) struct OctreePoint {
    /// The leaf, none outside of the cube.
    pub(super) leaf: Option<u32>,
    /// Ray parameter up to which the ray stays in the leaf, or at which it enters the cube.
    pub(super) t_end: f32,
}

impl Octree {
    /// One leaf: the smallest cube with the center of `bounds` around it, which must be finite.
    pub(super) fn new(bounds: &Aabb) -> Self {
        let edge = bounds.size().max_element().max(f32::MIN_POSITIVE);
        let low = bounds.center() - Vec3A::splat(0.5 * edge);
        Self { low, edge, children: vec![0] }
    }

    /// The cube.
    pub(super) fn bounds(&self) -> Aabb {
        Aabb::new(self.low, self.low + Vec3A::splat(self.edge))
    }

    /// Number of nodes, leaves among them.
    pub(super) fn len(&self) -> usize {
        self.children.len()
    }

    /// Cuts a leaf into eight; the first of them is returned, the others follow it, x first.
    pub(super) fn split(&mut self, leaf: u32) -> u32 {
        let first = self.children.len() as u32;
        self.children[leaf as usize] = first;
        self.children.extend([0; 8]);
        first
    }

    /// The first of a node's eight children, which follow each other; `None` for leaves.
    pub(super) fn first_child(&self, node: u32) -> Option<u32> {
        self.children.get(node as usize).copied().filter(|&child| child != 0)
    }

    /// The parent of each node, which comes before it; that of the root is the root.
    pub(super) fn parents(&self) -> Vec<u32> {
        let mut parents = vec![0; self.children.len()];
        for (node, &first) in self.children.iter().enumerate().filter(|(_, first)| **first != 0) {
            parents[first as usize..first as usize + 8].fill(node as u32);
        }
        parents
    }

    /// The leaf around a point, none outside of the cube.
    pub(super) fn leaf_at(&self, point: Vec3A) -> Option<u32> {
        self.find(point).map(|(node, ..)| node)
    }

    /// Every leaf with its box.
    pub(super) fn leaves(&self) -> Vec<(u32, Aabb)> {
        let mut leaves = Vec::new();
        let mut open = vec![(0, self.bounds())];
        while let Some((node, bounds)) = open.pop() {
            match self.children[node as usize] {
                0 => leaves.push((node, bounds)),
                first => open.extend((0..8).map(|i| (first + i, child_of(&bounds, i)))),
            }
        }
        leaves
    }

    /// The leaf of `ray` at parameter `t`, and where it leaves it.
    pub(super) fn locate(&self, ray: &Ray, t: f32) -> OctreePoint {
        let Some((node, place, depth)) = self.find(ray.at(t)) else {
            return OctreePoint { leaf: None, t_end: self.entry(ray, t) };
        };
        let edge = self.edge / (1u32 << depth) as f32;
        let low = self.low + (place >> (DEEPEST - depth)).as_vec3a() * edge;
        OctreePoint { leaf: Some(node), t_end: exit(ray, t, low, edge) }
    }

    /// The leaf around a point, the point in finest cells, and the cuts above the leaf.
    #[inline]
    fn find(&self, point: Vec3A) -> Option<(u32, UVec3, u32)> {
        const CELLS: f32 = (1 << DEEPEST) as f32;
        let scaled = (point - self.low) * (CELLS / self.edge);
        if scaled.cmplt(Vec3A::ZERO).any() || !scaled.cmplt(Vec3A::splat(CELLS)).all() {
            return None;
        }
        let place = scaled.as_ivec3().as_uvec3();
        let (mut node, mut depth) = (0, 0);
        while self.children[node as usize] != 0 {
            let bits = (place >> (DEEPEST - 1 - depth)) & UVec3::ONE;
            node = self.children[node as usize] + bits.x + 2 * bits.y + 4 * bits.z;
            depth += 1;
        }
        Some((node, place, depth))
    }

    /// Ray parameter at which a ray that is outside of the cube at `t` enters it; infinite if it
    /// does not.
    fn entry(&self, ray: &Ray, t: f32) -> f32 {
        match self.bounds().intersect(ray, t, f32::INFINITY) {
            Some((t0, _)) => t0.max(t + LEAST_STEP * self.edge).max(t.next_up()),
            None => f32::INFINITY,
        }
    }
}

/// Ray parameter at which `ray`, at `t` in the cube at `low`, leaves it.
fn exit(ray: &Ray, t: f32, low: Vec3A, edge: f32) -> f32 {
    let forward = ray.direction.cmpgt(Vec3A::ZERO);
    let face = Vec3A::select(forward, low + Vec3A::splat(edge), low);
    let along = (face - ray.origin) / ray.direction;
    let still = ray.direction.cmpeq(Vec3A::ZERO);
    let nearest = Vec3A::select(still, Vec3A::INFINITY, along).min_element();
    nearest.max(t + LEAST_STEP * edge).max(t.next_up())
}

/// The box of child number `index` of the box `parent`.
pub(super) fn child_of(parent: &Aabb, index: u32) -> Aabb {
    let half = 0.5 * parent.size();
    let bits = IVec3::new(index as i32 & 1, index as i32 >> 1 & 1, index as i32 >> 2 & 1);
    let low = parent.min + bits.as_vec3a() * half;
    Aabb::new(low, low + half)
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::math::PathRng;

    /// A tree with a fine corner, and the boxes of its nodes.
    fn tree() -> (Octree, Vec<Aabb>) {
        let mut tree =
            Octree::new(&Aabb::new(Vec3A::new(-2.0, -1.0, 0.0), Vec3A::new(2.0, 1.0, 1.0)));
        let mut boxes = vec![tree.bounds()];
        let mut leaf = 0;
        for _ in 0..5 {
            let parent = boxes[leaf as usize];
            let first = tree.split(leaf);
            boxes.extend((0..8).map(|index| child_of(&parent, index)));
            leaf = first + 6;
        }
        (tree, boxes)
    }

    /// A ray's leaves follow each other without gaps, and each holds its piece of the ray.
    #[test]
    fn leaves_along_a_ray_hold_their_pieces() {
        let (tree, boxes) = tree();
        let mut rng = PathRng::new(0, UVec2::ZERO, 0);
        let mut leaves = 0;
        for i in 0..2000 {
            let mut point = || {
                6.0 * (Vec3A::new(rng.uniform(), rng.uniform(), rng.uniform()) - Vec3A::splat(0.5))
            };
            let (origin, mut direction) = (point(), point().normalize());
            if i % 4 == 0 {
                direction = Vec3A::new(direction.x, 0.0, direction.z).normalize();
            }
            let ray = Ray::new(origin, direction);
            let mut t = 0.0;
            while t < 20.0 {
                let place = tree.locate(&ray, t);
                assert!(place.t_end > t);
                let middle = ray.at(0.5 * (t + place.t_end.min(20.0)));
                let slack = Vec3A::splat(0.01);
                let inside = |b: &Aabb| {
                    middle.cmpge(b.min - slack).all() && middle.cmple(b.max + slack).all()
                };
                match place.leaf {
                    Some(leaf) => assert!(inside(&boxes[leaf as usize]), "{leaf} at {middle}"),
                    None => {
                        let bounds = tree.bounds();
                        let shrunk = Aabb::new(bounds.min + 2.0 * slack, bounds.max - 2.0 * slack);
                        assert!(!inside(&shrunk), "nothing at {middle}");
                    }
                }
                leaves += u32::from(place.leaf.is_some());
                t = place.t_end;
            }
        }
        assert!(leaves > 2000);
    }
}
