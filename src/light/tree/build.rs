//! Building a light hierarchy: splits that keep power, extent and directions of each side small.

use glam::Vec3A;

use super::cone::Cone;
use super::nodes::{LightNode, LightTree, NodeKind};
use crate::light::emitter::Emitter;
use crate::math::Aabb;

/// Bins per axis that splits are tried between.
const BINS: usize = 16;
/// Beyond this depth nodes are halved by count, so that a trail of 64 choices always suffices.
const DEEPEST_BY_COST: u32 = 32;
/// Coordinates beyond this would leave single precision when squared.
const FARTHEST: f32 = 1e18;
/// Smallest intensity relative to the brightest, so that single precision holds both.
const FAINTEST: f64 = 1e-30;

/// An emitter while it is placed in the tree.
struct PlacedEmitter {
    index: u32,
    bounds: Aabb,
    center: Vec3A,
    /// Intensity relative to the brightest emitter's.
    intensity: f64,
    cone: Cone,
}

/// The extent, power and directions of a set of emitters.
#[derive(Clone, Copy)]
struct EmitterSummary {
    count: usize,
    bounds: Aabb,
    intensity: f64,
    /// Directions of emission; `None` without emitters.
    cone: Option<Cone>,
}

/// Builds the hierarchy over `emitters`.
pub(super) fn build(emitters: &[Emitter]) -> LightTree {
    let brightest = emitters.iter().map(intensity).fold(0.0, f32::max);
    let mut items: Vec<PlacedEmitter> = emitters
        .iter()
        .enumerate()
        .filter(|(_, emitter)| intensity(emitter) > 0.0)
        .filter_map(|(index, emitter)| item(index as u32, emitter, brightest))
        .collect();
    let count = emitters.len();
    let mut tree = LightTree {
        nodes: Vec::new(),
        trails: vec![None; count],
        leaves: vec![0; count],
        brightest,
    };
    if !items.is_empty() {
        tree.nodes.reserve(2 * items.len());
        tree.nodes.push(node(&items, NodeKind::Leaf(0)));
        split(&mut tree, 0, &mut items, 0, 0);
    }
    tree
}

fn intensity(emitter: &Emitter) -> f32 {
    if emitter.intensity.is_nan() { 0.0 } else { emitter.intensity.min(f32::MAX) }
}

fn item(index: u32, emitter: &Emitter, brightest: f32) -> Option<PlacedEmitter> {
    let Aabb { min, max } = emitter.bounds;
    if min.is_nan() || max.is_nan() || emitter.bounds.is_empty() {
        return None;
    }
    let limit = Vec3A::splat(FARTHEST);
    let bounds = Aabb::new(min.clamp(-limit, limit), max.clamp(-limit, limit));
    let relative = f64::from(intensity(emitter)) / f64::from(brightest);
    Some(PlacedEmitter {
        index,
        bounds,
        center: bounds.center(),
        intensity: relative.max(FAINTEST),
        cone: emitter.cone.map_or(Cone::EVERYWHERE, |(axis, cos)| Cone::new(axis, cos)),
    })
}

/// Fills the node `at` with `items` and all below it. `trail` holds the `depth` choices on the path
/// to it.
fn split(tree: &mut LightTree, at: usize, items: &mut [PlacedEmitter], depth: u32, trail: u64) {
    if let [only] = items {
        tree.nodes[at].kind = NodeKind::Leaf(only.index);
        tree.trails[only.index as usize] = Some(trail);
        tree.leaves[only.index as usize] = at as u32;
        return;
    }
    let middle = match cheapest_split(items, &tree.nodes[at].bounds) {
        Some(plane) if depth < DEEPEST_BY_COST => plane.partition(items),
        _ => halve(items),
    };
    let (low, high) = items.split_at_mut(middle);
    let first = tree.nodes.len();
    tree.nodes[at].kind = NodeKind::Inner(first as u32);
    // Kinds are set when the children are filled.
    tree.nodes.extend([node(low, NodeKind::Leaf(0)), node(high, NodeKind::Leaf(0))]);
    split(tree, first, low, depth + 1, trail);
    split(tree, first + 1, high, depth + 1, trail | 1 << depth);
}

fn node(items: &[PlacedEmitter], kind: NodeKind) -> LightNode {
    let all = items.iter().fold(EmitterSummary::EMPTY, |sum, item| sum.with(item));
    LightNode {
        bounds: all.bounds,
        intensity: all.intensity as f32,
        least_squared: least_distance(&all).powi(2),
        cone: all.cone.unwrap_or(Cone::EVERYWHERE),
        kind,
    }
}

/// A distance below which the nearest emitter of a node is not expected. Among emitters on a line
/// that is a part of their spacing; among emitters on a plane or in space the farther ones matter
/// more than the nearest, and a part of their extent across stands for 1/d² averaged over it.
fn least_distance(all: &EmitterSummary) -> f32 {
    let mut size = all.bounds.size().to_array();
    size.sort_by(f32::total_cmp);
    (0.15 * size[1]).max(0.25 * size[2] / all.count as f32)
}

/// Halves a set of emitters along the longest axis.
fn halve(items: &mut [PlacedEmitter]) -> usize {
    let centers = items.iter().fold(Aabb::EMPTY, |b, i| b.union(&Aabb::new(i.center, i.center)));
    let axis = centers.size().max_position();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        a.center[axis].total_cmp(&b.center[axis]).then_with(|| a.index.cmp(&b.index))
    });
    middle
}

/// A plane between two bins of an axis.
struct Plane {
    bins: Bins,
    /// Bins below this one are on the low side.
    bin: usize,
}

/// Equal bins along an axis for the emitters' centers.
#[derive(Clone, Copy)]
struct Bins {
    axis: usize,
    low: f32,
    per_length: f32,
}

impl Bins {
    fn of(&self, item: &PlacedEmitter) -> usize {
        let bin = (item.center[self.axis] - self.low) * self.per_length;
        (bin as usize).min(BINS - 1)
    }
}

impl Plane {
    /// Brings the low side to the front and returns its length.
    fn partition(&self, items: &mut [PlacedEmitter]) -> usize {
        let mut middle = 0;
        for i in 0..items.len() {
            if self.bins.of(&items[i]) < self.bin {
                items.swap(i, middle);
                middle += 1;
            }
        }
        middle
    }
}

/// The plane with the least sum of intensity × extent × directions over its sides, with splits of
/// the longest axis preferred (the paper's surface area orientation heuristic; the diagonal's
/// square stands for the area, which points on a line do not have). `None` if no plane parts them.
fn cheapest_split(items: &[PlacedEmitter], bounds: &Aabb) -> Option<Plane> {
    let centers = items.iter().fold(Aabb::EMPTY, |b, i| b.union(&Aabb::new(i.center, i.center)));
    let mut best: Option<(f64, Plane)> = None;
    for axis in 0..3 {
        let extent = centers.size()[axis];
        let bins = Bins { axis, low: centers.min[axis], per_length: BINS as f32 / extent };
        if !(bins.per_length > 0.0 && bins.per_length.is_finite()) {
            continue;
        }
        let elongation = f64::from(bounds.size().max_element()) / f64::from(extent);
        for (bin, cost) in costs(items, bins) {
            let cost = elongation * cost;
            if best.as_ref().is_none_or(|best| cost < best.0) {
                best = Some((cost, Plane { bins, bin }));
            }
        }
    }
    best.map(|best| best.1)
}

/// The cost of each plane of an axis that has emitters on both sides, with the bin above it.
fn costs(items: &[PlacedEmitter], bins: Bins) -> impl Iterator<Item = (usize, f64)> {
    let mut sums = [EmitterSummary::EMPTY; BINS];
    for item in items {
        let bin = bins.of(item);
        sums[bin] = sums[bin].with(item);
    }
    let mut above = [EmitterSummary::EMPTY; BINS];
    let mut sum = EmitterSummary::EMPTY;
    for bin in (0..BINS).rev() {
        sum = sum.union(&sums[bin]);
        above[bin] = sum;
    }
    let mut below = EmitterSummary::EMPTY;
    (1..BINS).filter_map(move |bin| {
        below = below.union(&sums[bin - 1]);
        let parts = below.count > 0 && above[bin].count > 0;
        parts.then(|| (bin, below.cost() + above[bin].cost()))
    })
}

impl EmitterSummary {
    const EMPTY: Self = Self { count: 0, bounds: Aabb::EMPTY, intensity: 0.0, cone: None };

    fn with(&self, item: &PlacedEmitter) -> Self {
        self.union(&Self {
            count: 1,
            bounds: item.bounds,
            intensity: item.intensity,
            cone: Some(item.cone),
        })
    }

    fn union(&self, other: &Self) -> Self {
        let cone = match (self.cone, other.cone) {
            (Some(a), Some(b)) if a.is_everywhere() || b.is_everywhere() => Some(Cone::EVERYWHERE),
            (Some(a), Some(b)) => Some(a.union(&b)),
            (a, b) => a.or(b),
        };
        Self {
            count: self.count + other.count,
            bounds: self.bounds.union(&other.bounds),
            intensity: self.intensity + other.intensity,
            cone,
        }
    }

    fn cost(&self) -> f64 {
        let extent = f64::from(self.bounds.diagonal()).powi(2);
        let directions = self.cone.map_or(0.0, |cone| cone.share());
        self.intensity * extent * f64::from(directions)
    }
}
