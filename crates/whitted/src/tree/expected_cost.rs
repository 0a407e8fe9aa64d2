//! What a walk is expected to cost.

use super::Tree;
use super::build::WIDE_NODE_COST;
use super::node::{Child, ChildKind, WIDTH};

impl Tree {
    /// The surface area heuristic's cost of a ray that meets the whole, in tests of a leaf block: each node and each block
    /// counts with the area of its box as a share of the area of all. A node costs as much as two blocks.
    ///
    /// NaN for a tree whose box has no area.
    pub fn expected_cost(&self) -> f64 {
        let Some(root) = self.nodes.first() else { return f64::NAN };
        let lanes = |node: usize| (0..WIDTH).filter(move |&lane| self.nodes[node].child(lane) != Child::UNUSED);
        let cost = |node: usize, lane: usize| match self.nodes[node].child(lane).decode() {
            ChildKind::Interior(_) => f64::from(WIDE_NODE_COST),
            ChildKind::Leaf { count, .. } => count as f64,
        };
        let area = |node: usize, lane: usize| f64::from(self.nodes[node].bounds(lane).half_area());
        let whole = lanes(0).map(|lane| root.bounds(lane)).reduce(|a, b| a.union(b)).map_or(0.0, |all| all.half_area());
        let under: f64 = (0..self.nodes.len())
            .flat_map(|node| lanes(node).map(move |lane| area(node, lane) * cost(node, lane)))
            .sum();
        f64::from(WIDE_NODE_COST) + under / f64::from(whole)
    }
}
