//! One ray through the wide tree: the one-ray API and the tail of the stream.

use super::Walk;
use super::prepared::NodeRay;
use crate::tree::goal::Goal;
use crate::tree::query::Counts;
use crate::tree::wide::{Child, ChildKind, Node, WIDTH};
use simd::{F32Lanes, MaskLanes, Simd};

/// Children that wait to be visited, nearest last, with the parameter where the ray enters them.
#[derive(Debug, Default)]
pub(super) struct Stack {
    entry: Vec<f32>,
    child: Vec<u32>,
}

impl Stack {
    /// Make room for any walk through a tree of `depth` levels: each level leaves at most 15 children behind and the
    /// last one stores whole registers.
    fn reserve(&mut self, depth: usize) {
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
                let (mask, entry) = enter(token, node, &ray, &far, octant, limit);
                let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
                let children = node.child.map(|child| child.0);
                top += token.compress_in_order(mask, &node.order[octant], entry, &children, keys, values);
            }
            ChildKind::Leaf { kind, first, count } => {
                walk.leaf(token, index, kind, first, count, counts);
                limit = walk.rays.limit(index);
            }
        }
    }
}

/// Which children of `node` the ray enters, and where.
#[inline(always)]
fn enter<S: Simd>(token: S, node: &Node, ray: &NodeRay, far: &[f32; 3], octant: usize, limit: f32) -> (u16, S::F32x16) {
    let splat = |value| S::F32x16::splat(token, value);
    let slab = |axis: usize, upper: bool, offset: f32| {
        let row = axis + if upper == (octant >> axis & 1 == 0) { 3 } else { 0 };
        S::F32x16::load(token, &node.planes[row]).mul_add_fast(splat(ray.inverse[axis]), splat(offset))
    };
    let near = |axis| slab(axis, false, ray.near[axis]);
    let leave = |axis| slab(axis, true, far[axis]);
    let entry = near(0).max(near(1)).max(near(2).max(splat(ray.t_min)));
    let exit = leave(0).min(leave(1)).min(leave(2).min(splat(limit)));
    (entry.le(exit).bits() as u16, entry)
}
