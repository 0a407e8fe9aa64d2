//! One ray through the wide tree: the one-ray API and the tail of the stream.

use super::Walk;
use super::prepared::NodeRay;
use super::slabs::Slabs;
use crate::tree::goal::Goal;
use crate::tree::query::Counts;
use crate::tree::wide::{Child, ChildKind, WIDTH};
use simd::Simd;

/// Children that wait to be visited, nearest last, with the parameter where the ray enters them.
#[derive(Debug, Default)]
pub(super) struct Stack {
    pub(super) entry: Vec<f32>,
    pub(super) child: Vec<u32>,
}

impl Stack {
    /// Make room for any walk through a tree of `depth` levels: each level leaves at most 15 children behind and the
    /// last one stores whole registers.
    pub(super) fn reserve(&mut self, depth: usize) {
        let len = depth * (WIDTH - 1) + 2 * WIDTH;
        if self.entry.len() < len {
            self.entry.resize(len, 0.0);
            self.child.resize(len, 0);
        }
    }
}

/// Follow ray `index` through everything under `start`.
#[inline(always)]
pub(super) fn walk<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    stack: &mut Stack,
    index: usize,
    start: Child,
    counts: &mut Counts,
) {
    stack.reserve(walk.tree.depth());
    let (ray, far, octant) = (walk.rays.nodes[index], walk.rays.far[index], walk.rays.octant[index] as usize & 7);
    let mut limit = ray.limit;
    (stack.entry[0], stack.child[0]) = (ray.t_min, start.0);
    let mut top = 1;
    while top > 0 {
        top -= 1;
        let enters = stack.entry[top] <= limit;
        if !enters {
            continue;
        }
        match Child(stack.child[top]).decode() {
            ChildKind::Interior(node) => {
                counts.node_steps += 1;
                let node = &walk.tree.nodes[node];
                let ray = NodeRay { limit, ..ray };
                let (mask, entry) = Slabs::load(token, node, octant).enter(token, &ray, &far);
                let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
                top += token.compress_in_order(mask, &node.order[octant], entry, node.children(), keys, values);
            }
            ChildKind::Leaf { kind, first, count } => {
                walk.leaf(token, index, kind, first, count, counts);
                limit = walk.rays.limit(index);
            }
        }
    }
}
