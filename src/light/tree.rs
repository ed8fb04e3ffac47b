//! A light tree: a hierarchy over many lights that chooses one for a receiver by its estimated
//! contribution, from power, distance and facing (Conty Estevez and Kulla, *Importance Sampling of
//! Many Lights with Adaptive Tree Splitting*, 2018).
//!
//! At each node the descent chooses between two children by their importances. The path to each
//! light is stored as a trail of left and right choices, so that its probability costs one descent
//! too.

mod build;
mod cone;
mod nodes;
#[cfg(test)]
mod tests;

use glam::Vec3A;

use super::emitter::{Emitter, MOST_IMPORTANT, Receiver};
pub use nodes::LightTree;
use nodes::{LightNode, NodeKind};

impl LightTree {
    /// Builds the hierarchy; indices below are those of `emitters`.
    pub fn new(emitters: &[Emitter]) -> Self {
        build::build(emitters)
    }

    /// Rough irradiance at the receiver of all lights in the tree, which weights the tree against
    /// lights outside of it. Finite, and above zero wherever one of them can contribute.
    ///
    /// Summed over a descent to the greatest importance and all nodes that it passes by: next to
    /// one of many lights their common box is a poor estimate.
    pub fn importance(&self, to: &Receiver) -> f32 {
        let Some(mut node) = self.nodes.first() else { return 0.0 };
        let mut importance = node.importance(to);
        let mut passed = 0.0;
        while let NodeKind::Inner(first) = node.kind
            && importance > 0.0
        {
            let [a, b] = &self.nodes[first as usize..][..2] else { break };
            let [to_a, to_b] = [a, b].map(|child| child.importance(to));
            passed += to_a.min(to_b);
            (node, importance) = if to_a >= to_b { (a, to_a) } else { (b, to_b) };
        }
        let irradiance = f64::from(self.brightest) * (importance + passed);
        if irradiance > 0.0 {
            irradiance.clamp(f64::from(f32::MIN_POSITIVE), f64::from(MOST_IMPORTANT)) as f32
        } else {
            0.0
        }
    }

    /// Rough irradiance at the receiver of one emitter, if unoccluded; 0 where it cannot
    /// contribute.
    #[inline]
    pub fn importance_of(&self, index: u32, to: &Receiver) -> f32 {
        let Some(node) = self.node_of(index) else { return 0.0 };
        let irradiance = f64::from(self.brightest) * node.importance(to);
        if irradiance > 0.0 { irradiance.min(f64::from(MOST_IMPORTANT)) as f32 } else { 0.0 }
    }

    /// The middle of an emitter in the tree.
    #[inline]
    pub fn center_of(&self, index: u32) -> Option<Vec3A> {
        self.node_of(index).map(|node| node.bounds.center())
    }

    fn node_of(&self, index: u32) -> Option<&LightNode> {
        self.trails.get(index as usize).copied().flatten()?;
        self.nodes.get(self.leaves[index as usize] as usize)
    }

    /// An emitter and its probability. `None` where no emitter can contribute, or where the descent
    /// ends among emitters that cannot though their common box could. Near values of `pick`, in [0,
    /// 1), lead to near emitters.
    pub fn sample(&self, to: &Receiver, mut pick: f64) -> Option<(u32, f32)> {
        let mut node = self.nodes.first()?;
        if let NodeKind::Leaf(emitter) = node.kind {
            return (node.importance(to) > 0.0).then_some((emitter, 1.0));
        }
        let mut probability = 1.0;
        loop {
            let first = match node.kind {
                NodeKind::Leaf(emitter) => return Some((emitter, rounded(probability))),
                NodeKind::Inner(first) => first as usize,
            };
            let share = self.share_of_first(first, to)?;
            if pick < share {
                pick /= share;
                probability *= share;
                node = &self.nodes[first];
            } else {
                pick = (pick - share) / (1.0 - share);
                probability *= 1.0 - share;
                node = &self.nodes[first + 1];
            }
            pick = pick.clamp(0.0, 1.0 - f64::EPSILON);
        }
    }

    /// The probability with which [`LightTree::sample`] draws an emitter.
    pub fn probability(&self, index: u32, to: &Receiver) -> f32 {
        let Some(&Some(mut trail)) = self.trails.get(index as usize) else { return 0.0 };
        let mut node = &self.nodes[0];
        if let NodeKind::Leaf(_) = node.kind {
            return if node.importance(to) > 0.0 { 1.0 } else { 0.0 };
        }
        let mut probability = 1.0;
        while let NodeKind::Inner(first) = node.kind {
            let first = first as usize;
            let Some(share) = self.share_of_first(first, to) else { return 0.0 };
            let second = trail & 1;
            probability *= if second == 0 { share } else { 1.0 - share };
            node = &self.nodes[first + second as usize];
            trail >>= 1;
        }
        if probability > 0.0 { rounded(probability) } else { 0.0 }
    }

    /// The probability to go on with the first of two children; `None` if neither can contribute.
    #[inline]
    fn share_of_first(&self, first: usize, to: &Receiver) -> Option<f64> {
        let [a, b] = [0, 1].map(|child| self.nodes[first + child].importance(to));
        let total = a + b;
        if total <= 0.0 || total.is_nan() {
            return None;
        }
        // However faint, what can contribute must not round to never.
        let share = a / total;
        let (low, high) = (f64::from(u8::from(a > 0.0)), f64::from(u8::from(b > 0.0)));
        Some(share.clamp(low * f64::MIN_POSITIVE, 1.0 - high * f64::EPSILON))
    }
}

/// Rounds a probability to single precision, above zero where it was.
fn rounded(probability: f64) -> f32 {
    (probability as f32).max(f32::MIN_POSITIVE)
}
