//! Single rays through the wide tree, in turns: the tail of the stream.

use super::Walk;
use super::slabs::Slabs;
use super::stream::STREAMS;
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

/// Paths that are followed in turn, at most.
pub(super) const WAYS: usize = 64;

/// One ray on its way down: its waiting children lie at `base..top` of the stack.
#[derive(Clone, Copy, Debug, Default)]
struct Path {
    index: usize,
    base: usize,
    top: usize,
    /// The stream that waits for it.
    stream: usize,
}

/// Rays that are followed one by one, a step of each in turn: while one waits for memory, the others work.
#[derive(Debug, Default)]
pub(super) struct Turns {
    /// Those under way first.
    paths: Vec<Path>,
    under_way: usize,
    /// The same for each stream.
    of_stream: [usize; STREAMS],
}

impl Turns {
    /// Give each path its part of the stack.
    pub(super) fn reserve(&mut self, stack: &mut Stack, depth: usize) {
        let room = stack.reserve(depth, WAYS);
        self.paths.resize(WAYS, Path::default());
        for (way, path) in self.paths.iter_mut().enumerate() {
            path.base = way * room;
        }
    }

    /// True if no ray is under way.
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.under_way == 0
    }

    /// True if so many more can be followed.
    #[inline(always)]
    pub(super) fn has_room_for(&self, count: usize) -> bool {
        self.under_way + count <= WAYS
    }

    /// Begin to follow the rays `ids` of a stream through everything under `start`.
    #[inline(always)]
    pub(super) fn follow<G: Goal>(
        &mut self,
        walk: &Walk<'_, G>,
        stack: &mut Stack,
        ids: &[u16],
        start: Child,
        stream: usize,
    ) {
        for (path, &id) in self.paths[self.under_way..].iter_mut().zip(ids) {
            let (index, base) = (usize::from(id), path.base);
            (stack.entry[base], stack.child[base]) = (walk.rays.node(index).t_min(), start.0);
            *path = Path { index, base, top: base + 1, stream };
        }
        self.under_way += ids.len();
        self.of_stream[stream] += ids.len();
    }

    /// A step of each path; returns the streams whose last path has ended, as bits.
    #[inline(always)]
    pub(super) fn step<S: Simd, G: Goal>(
        &mut self,
        token: S,
        walk: &mut Walk<'_, G>,
        stack: &mut Stack,
        counts: &mut Counts,
    ) -> u32 {
        // Places that are asked for again and again stay in registers.
        let (paths, entry, child) = (&mut self.paths[..], &mut stack.entry[..], &mut stack.child[..]);
        let (mut way, mut under_way, mut ended) = (0, self.under_way, 0);
        counts.single_steps += under_way as u64;
        while way < under_way {
            let path = &mut paths[way];
            if path.step(token, walk, entry, child, counts) {
                walk.tree.prefetch(Child(child[path.top - 1]));
                way += 1;
            } else {
                let stream = path.stream % STREAMS;
                under_way -= 1;
                paths.swap(way, under_way);
                self.of_stream[stream] -= 1;
                ended |= u32::from(self.of_stream[stream] == 0) << stream;
            }
        }
        self.under_way = under_way;
        ended
    }
}

impl Path {
    /// Visit the nearest waiting child that the ray still reaches; false if there is none.
    #[inline(always)]
    fn step<S: Simd, G: Goal>(
        &mut self,
        token: S,
        walk: &mut Walk<'_, G>,
        waiting_entry: &mut [f32],
        waiting: &mut [u32],
        counts: &mut Counts,
    ) -> bool {
        let ray = walk.rays.node(self.index);
        loop {
            if self.top == self.base {
                return false;
            }
            self.top -= 1;
            if waiting_entry[self.top] <= ray.limit() {
                break;
            }
        }
        let top = self.top;
        match Child(waiting[top]).decode() {
            ChildKind::Interior(node) => {
                counts.node_steps += 1;
                let node = &walk.tree.nodes[node];
                let octant = walk.rays.octant[self.index] as usize & 7;
                let (mask, entry) = Slabs::load(token, node, octant).enter(token, ray, walk.rays.far(self.index));
                let keys = (&mut waiting_entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut waiting[top..top + WIDTH]).try_into().expect("WIDTH children");
                self.top += token.compress_in_order(mask, &node.order(octant), entry, node.children(), keys, values);
            }
            ChildKind::Leaf { kind, first, count } => walk.leaf(token, self.index, kind, first, count, counts),
        }
        self.top > self.base
    }
}
