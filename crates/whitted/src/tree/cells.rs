//! Which boxes of the tree a ray enters: for pictures of the tree, one ray at a time.

use super::Tree;
use super::node::{Child, ChildKind, WIDTH};
use crate::math::Aabb;
use crate::ray::Ray;

/// A box of the tree that a ray enters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cell {
    /// The box, in the coordinates of the primitives.
    pub(crate) bounds: Aabb,
    /// Boxes around it.
    pub(crate) level: u32,
    /// Parameter where the ray enters it.
    pub(crate) entry: f64,
    /// Parameter where the ray leaves it.
    pub(crate) exit: f64,
    /// The primitives that a walk tests there, if it is a leaf.
    pub(crate) primitives: Option<Vec<u32>>,
}

impl Tree {
    /// The boxes that `ray` enters within its range: each after the one around it, and the nearer of two in the same one
    /// first.
    ///
    /// Give the ray its first hit as `t_max`, and these are the boxes that no walk can leave out. There are none if
    /// there is no tree, and for rays that are not finite.
    pub(crate) fn cells(&self, ray: &Ray) -> Vec<Cell> {
        let mut cells = Vec::new();
        let mut waiting = Vec::new();
        self.enter(ray, Child::interior(0), 0, &mut waiting);
        while let Some((child, cell)) = waiting.pop() {
            let level = cell.level + 1;
            cells.push(cell);
            self.enter(ray, child, level, &mut waiting);
        }
        cells
    }

    /// Put the boxes in an interior node that the ray enters on `waiting`, the nearest last.
    fn enter(&self, ray: &Ray, child: Child, level: u32, waiting: &mut Vec<(Child, Cell)>) {
        let ChildKind::Interior(index) = child.decode() else { return };
        let Some(node) = self.nodes.get(index) else { return };
        let first = waiting.len();
        for lane in (0..WIDTH).filter(|&lane| node.boxes() >> lane & 1 != 0) {
            let bounds = node.bounds(lane);
            let bounds = Aabb::new(bounds.lo / self.scale(), bounds.hi / self.scale());
            if let Some((entry, exit)) = within(ray, bounds) {
                let child = node.child(lane);
                waiting.push((child, Cell { bounds, level, entry, exit, primitives: self.primitives_of(child) }));
            }
        }
        waiting[first..].sort_by(|(_, a), (_, b)| b.entry.total_cmp(&a.entry));
    }

    fn primitives_of(&self, child: Child) -> Option<Vec<u32>> {
        match child.decode() {
            ChildKind::Interior(_) => None,
            ChildKind::Leaf { kind, first, count } => Some(self.leaves.primitives(kind, first, count).collect()),
        }
    }
}

/// The part of the ray's range that lies in a box, if there is one. A NaN is in no box.
fn within(ray: &Ray, bounds: Aabb) -> Option<(f64, f64)> {
    let mut range = (f64::from(ray.t_min), f64::from(ray.t_max));
    for axis in 0..3 {
        let [origin, direction] = [ray.origin[axis], ray.direction[axis]].map(f64::from);
        let [lo, hi] = [bounds.lo[axis], bounds.hi[axis]].map(f64::from);
        if direction == 0.0 {
            if !(lo <= origin && origin <= hi) {
                return None;
            }
            continue;
        }
        let (a, b) = ((lo - origin) / direction, (hi - origin) / direction);
        if a.is_nan() || b.is_nan() {
            return None;
        }
        range = (range.0.max(a.min(b)), range.1.min(a.max(b)));
    }
    (range.0 <= range.1).then_some(range)
}
