//! Single rays through the wide tree, in turns: the tail of the stream.

use super::Walk;
use super::slabs::Slabs;
use crate::tree::goal::Goal;
use crate::tree::node::{Child, ChildKind, WIDTH};
use crate::tree::query::Counts;
use simd::Simd;

/// Children that wait to be visited, nearest last, with the parameter where the ray enters them.
#[derive(Debug, Default)]
pub(super) struct Stack {
    pub(super) entry: Vec<f32>,
    pub(super) child: Vec<u32>,
}

impl Stack {
    /// Make room for `ways` walks through a tree of `depth` levels, and say how much each has: each level leaves at most
    /// 15 children behind and the last one stores whole registers.
    #[inline(always)]
    pub(super) fn reserve(&mut self, depth: usize, ways: usize) -> usize {
        let room = depth * (WIDTH - 1) + 2 * WIDTH;
        if self.child.len() < ways * room {
            self.grow(ways * room);
        }
        room
    }

    #[cold]
    fn grow(&mut self, len: usize) {
        self.entry.resize(len, 0.0);
        self.child.resize(len, 0);
    }
}

/// Paths that are followed in turn.
pub(super) const WAYS: usize = 16;

/// One ray on its way down: its waiting children lie at `base..top` of the stack.
#[derive(Clone, Copy, Default)]
struct Path {
    index: usize,
    base: usize,
    top: usize,
}

/// Follow the rays `ids`, at most [`WAYS`], through everything under `start`, a step of each in turn: while one waits for
/// memory, the others work.
#[inline(always)]
pub(super) fn interleaved<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    stack: &mut Stack,
    ids: &[u16],
    start: Child,
    counts: &mut Counts,
) {
    let room = stack.reserve(walk.tree.depth(), WAYS);
    let mut paths = [Path::default(); WAYS];
    for (way, (path, &id)) in paths.iter_mut().zip(ids).enumerate() {
        *path = Path::new(walk, stack, id as usize, start, way * room);
    }
    let mut active = ids.len();
    while active > 0 {
        let mut way = 0;
        while way < active {
            if paths[way].step(token, walk, stack, counts) {
                walk.tree.prefetch(Child(stack.child[paths[way].top - 1]));
                way += 1;
            } else {
                active -= 1;
                paths[way] = paths[active];
            }
        }
    }
}

impl Path {
    #[inline(always)]
    fn new<G: Goal>(walk: &Walk<'_, G>, stack: &mut Stack, index: usize, start: Child, base: usize) -> Self {
        (stack.entry[base], stack.child[base]) = (walk.rays.node(index).t_min(), start.0);
        Self { index, base, top: base + 1 }
    }

    /// Visit the nearest waiting child that the ray still reaches; false if there is none.
    #[inline(always)]
    fn step<S: Simd, G: Goal>(
        &mut self,
        token: S,
        walk: &mut Walk<'_, G>,
        stack: &mut Stack,
        counts: &mut Counts,
    ) -> bool {
        let ray = walk.rays.node(self.index);
        loop {
            if self.top == self.base {
                return false;
            }
            self.top -= 1;
            if stack.entry[self.top] <= ray.limit() {
                break;
            }
        }
        let top = self.top;
        match Child(stack.child[top]).decode() {
            ChildKind::Interior(node) => {
                counts.node_steps += 1;
                let node = &walk.tree.nodes[node];
                let octant = walk.rays.octant[self.index] as usize & 7;
                let (mask, entry) = Slabs::load(token, node, octant).enter(token, ray, walk.rays.far(self.index));
                let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
                self.top += token.compress_in_order(mask, &node.order(octant), entry, node.children(), keys, values);
            }
            ChildKind::Leaf { kind, first, count } => walk.leaf(token, self.index, kind, first, count, counts),
        }
        self.top > self.base
    }
}
