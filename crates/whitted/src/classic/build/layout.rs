//! Giving nodes their places: pairs of children in cache lines.
//!
//! A line takes a pair and then the pairs below it, nearest first, as many as fit: a walk reads about two levels from
//! each line. What is left of a line when a subtree ends begins the next subtree.

use super::Branch;
use crate::classic::node::{Line, Node, PAIRS, Pair};
use std::collections::VecDeque;

/// Nodes and references of a tree.
pub(super) fn lay_out(root: Branch) -> (Vec<Line>, Vec<u32>) {
    let mut layout = Layout::default();
    // The root has no sibling: an empty leaf takes the place.
    layout.place_below([root, Branch::Leaf(Vec::new())]);
    (layout.lines, layout.references)
}

/// A pair of children, with the place of the pair.
type Waiting = (usize, [Branch; 2]);

#[derive(Default)]
struct Layout {
    lines: Vec<Line>,
    references: Vec<u32>,
    /// Pairs that have a place.
    pairs: usize,
    /// Pairs that have none yet: each begins a part of the tree that is laid out by itself, the last one next.
    parts: Vec<(PlaceOfParent, [Branch; 2])>,
}

/// The node that must learn where its children are.
#[derive(Clone, Copy)]
struct PlaceOfParent {
    pair: usize,
    side: usize,
    axis: usize,
    plane: f32,
}

impl Layout {
    fn place_below(&mut self, root: [Branch; 2]) {
        let place = self.new_pair();
        self.fill_line((place, root));
        while let Some((parent, children)) = self.parts.pop() {
            let place = self.new_pair();
            self.set(parent.pair, parent.side, Node::interior(parent.axis, parent.plane, place));
            self.fill_line((place, children));
        }
    }

    /// Lay out a pair and those below it, breadth first, until the line is full.
    fn fill_line(&mut self, first: Waiting) {
        let mut waiting = VecDeque::from([first]);
        let mut parts = Vec::new();
        while let Some((pair, children)) = waiting.pop_front() {
            for (side, child) in children.into_iter().enumerate() {
                match child {
                    Branch::Leaf(primitives) => {
                        self.set(pair, side, Node::leaf(self.references.len(), primitives.len()));
                        self.references.extend(primitives);
                    }
                    Branch::Interior { axis, plane, children } if !self.pairs.is_multiple_of(PAIRS) => {
                        let place = self.new_pair();
                        self.set(pair, side, Node::interior(axis, plane, place));
                        waiting.push_back((place, *children));
                    }
                    Branch::Interior { axis, plane, children } => {
                        parts.push((PlaceOfParent { pair, side, axis, plane }, *children));
                    }
                }
            }
        }
        self.parts.extend(parts.into_iter().rev());
    }

    fn new_pair(&mut self) -> usize {
        if self.pairs.is_multiple_of(PAIRS) {
            self.lines.push(Line::default());
        }
        self.pairs += 1;
        self.pairs - 1
    }

    fn set(&mut self, pair: usize, side: usize, node: Node) {
        let Pair(nodes) = &mut self.lines[pair / PAIRS].0[pair % PAIRS];
        nodes[side] = node;
    }
}
