//! Fitting a tree to primitives that have moved: the same nodes, new boxes.

use super::node::{Child, ChildKind, Node, WIDTH};
use super::wide::Tree;
use super::{BitSet, TreeKind};
use crate::geometry::Primitives;
use crate::math::Aabb;

/// Why a tree cannot be fitted to moved primitives; then it must be built anew.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefitError {
    /// Spatial splits cut primitives where they were: their parts cannot move.
    #[error(
        "a tree of kind {kind:?} cuts primitives where they were when it was built: build it with TreeKind::Fast, or anew"
    )]
    Kind {
        /// How the tree was built.
        kind: TreeKind,
    },
    /// The tree was built over another number of primitives.
    #[error("the tree was built over {expected} primitives, not {found}: build it anew")]
    Count {
        /// Bounded primitives when it was built.
        expected: usize,
        /// Bounded primitives now.
        found: usize,
    },
    /// A primitive that could not be hit when the tree was built, and was left out of it, can be hit now.
    #[error("primitive {primitive} was degenerate when the tree was built and is not in it: build it anew")]
    Missing {
        /// The first of them.
        primitive: u32,
    },
}

impl Tree {
    /// Fit the boxes to `primitives`, those over which the tree was built, moved. Answers are those of a tree built
    /// anew; the farther primitives have moved apart that were neighbours, the longer the answers take.
    ///
    /// # Errors
    /// [`RefitError`]; then the tree is as it was.
    pub fn refit(&mut self, primitives: &Primitives) -> Result<(), RefitError> {
        self.check_refit(primitives)?;
        self.fit_scale(primitives.bounds());
        if self.kind() != TreeKind::None {
            self.leaves.update(primitives, self.scale());
            self.fit_boxes(primitives);
        }
        Ok(())
    }

    fn check_refit(&self, primitives: &Primitives) -> Result<(), RefitError> {
        match self.kind() {
            TreeKind::None => return Ok(()),
            TreeKind::Fast => {}
            kind => return Err(RefitError::Kind { kind }),
        }
        // Object splits refer to each primitive once.
        let (expected, found) = (self.report().references + self.report().dropped, primitives.bounded_count());
        if expected != found {
            return Err(RefitError::Count { expected, found });
        }
        if self.report().dropped == 0 {
            return Ok(());
        }
        let present = self.present(found);
        let missing = |id: &u32| !present.contains(*id) && primitives.primitive_bounds(*id).is_some();
        match (0..found as u32).find(missing) {
            Some(primitive) => Err(RefitError::Missing { primitive }),
            None => Ok(()),
        }
    }

    /// The primitives in the tree, of `count`.
    fn present(&self, count: usize) -> BitSet {
        let mut present = BitSet::new(count);
        for node in &self.nodes {
            for (kind, first, blocks) in leaves(node) {
                self.leaves.primitives(kind, first, blocks).for_each(|id| present.insert(id));
            }
        }
        present
    }

    /// Compute all boxes anew, those of children before those of parents.
    fn fit_boxes(&mut self, primitives: &Primitives) {
        let mut order = vec![0];
        let mut next = 0;
        while let Some(&index) = order.get(next) {
            order.extend(interiors(&self.nodes[index]));
            next += 1;
        }
        let mut bounds = vec![Aabb::EMPTY; self.nodes.len()];
        for &index in order.iter().rev() {
            let node = &self.nodes[index];
            let children = node.children().map(Child);
            let mut boxes = [Aabb::EMPTY; WIDTH];
            for (fitted, child) in boxes.iter_mut().zip(children) {
                if child == Child::UNUSED {
                    continue;
                }
                *fitted = match child.decode() {
                    ChildKind::Interior(child) => bounds[child],
                    ChildKind::Leaf { kind, first, count } => {
                        self.leaf_bounds(primitives, self.leaves.primitives(kind, first, count))
                    }
                };
                bounds[index] = bounds[index].union(*fitted);
            }
            self.nodes[index] = Node::new(&boxes, &children);
        }
    }

    /// The padded box around `ids`; empty if none of them can be hit any more.
    fn leaf_bounds(&self, primitives: &Primitives, ids: impl Iterator<Item = u32>) -> Aabb {
        let bounds = ids.filter_map(|id| primitives.primitive_bounds(id)).fold(Aabb::EMPTY, Aabb::union);
        if bounds.is_empty() {
            return Aabb::EMPTY;
        }
        self.padded(Aabb::new(bounds.lo * self.scale(), bounds.hi * self.scale()))
    }
}

/// The nodes under a node.
fn interiors(node: &Node) -> impl Iterator<Item = usize> {
    let children = (0..WIDTH).map(|lane| node.child(lane)).filter(|&child| child != Child::UNUSED);
    children.filter_map(|child| match child.decode() {
        ChildKind::Interior(index) => Some(index),
        ChildKind::Leaf { .. } => None,
    })
}

/// The leaves under a node: kind, first block, number of blocks.
fn leaves(node: &Node) -> impl Iterator<Item = (super::leaf::LeafKind, usize, usize)> {
    let children = (0..WIDTH).map(|lane| node.child(lane)).filter(|&child| child != Child::UNUSED);
    children.filter_map(|child| match child.decode() {
        ChildKind::Interior(_) => None,
        ChildKind::Leaf { kind, first, count } => Some((kind, first, count)),
    })
}
