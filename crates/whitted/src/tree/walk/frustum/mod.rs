//! Sixty-four rays with one origin through the wide tree, bounded by a pyramid.
//!
//! Camera rays of a tile, or the segments from a light to neighbouring points, start at one point and run mostly along
//! one axis. The slopes of the other two axes span four planes; a box that lies outside one of them, or beyond every
//! ray's limit, is passed over by one fused multiply-add and one comparison per plane for all sixteen children, whatever
//! the number of rays. Slopes to the dominant axis never degenerate, unlike intervals of reciprocal directions, which
//! collapse where a component is near zero. Primitives of a leaf are culled by the same planes, eight at a time; each
//! survivor is tested against the rays sixteen at a time.
//!
//! A packet that straddles a silhouette would visit far too much: each has a budget, and one that exceeds it goes on as
//! a list of the stream, with what its rays have found so far.

mod packet;
mod pyramid;

use super::Walk;
use super::turns::Stack;
use crate::tree::goal::Goal;
use crate::tree::leaf::LeafKind;
use crate::tree::node::{Child, ChildKind, WIDTH};
use crate::tree::query::Counts;
use packet::Packet;
use pyramid::Pyramid;
use simd::Simd;

/// Rays of a packet.
pub(in crate::tree) const PACKET: usize = 64;
const LANES: usize = 16;
const ROWS: usize = PACKET / LANES;

/// Primitives that a packet may test before it goes to the stream: more than this and its rays have little in common. Less
/// where rays end, since what a list asks of the rays of a packet that ended early is little.
const BUDGET: u32 = 256;
const BUDGET_OF_ENDING: u32 = 32;

/// Follow the packet of rays from `first` on; false if it is none, or exceeded its budget: then its rays still have to
/// be walked.
#[inline(always)]
pub(super) fn walk<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    stack: &mut Stack,
    first: usize,
    counts: &mut Counts,
) -> bool {
    Packet::prefetch(walk, first + PACKET);
    let Some(mut packet) = Packet::new(token, walk, first) else { return false };
    let mut pyramid = Pyramid::around(token, walk, &packet);
    let octant = packet.octant;
    let mut budget = if G::ENDS_RAYS { BUDGET_OF_ENDING } else { BUDGET };
    stack.reserve(walk.tree.depth(), 1);
    (stack.entry[0], stack.child[0]) = (f32::NEG_INFINITY, Child::interior(0).0);
    let mut top = 1;
    while top > 0 {
        top -= 1;
        if stack.entry[top] > pyramid.reach {
            continue;
        }
        match Child(stack.child[top]).decode() {
            ChildKind::Interior(node) => {
                counts.node_steps += PACKET as u64;
                let (node, bottom) = (&walk.tree.nodes[node], top);
                let (mask, entry) = pyramid.enter(token, node);
                let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
                top += token.compress_in_order(mask, &node.order(octant), entry, node.children(), keys, values);
                // Most of them will be visited: while the nearest is, the others come from memory.
                walk.tree.prefetch_all(stack.child[bottom..top].iter().map(|&child| Child(child)));
            }
            ChildKind::Leaf { kind: LeafKind::Shapes, .. } => {
                packet.finish(token, walk, first);
                return false;
            }
            ChildKind::Leaf { kind, first: block, count } => {
                let mut tested = 0;
                for block in block..block + count {
                    tested += match kind {
                        LeafKind::Triangles => packet.triangles(token, &pyramid, walk, block),
                        _ => packet.spheres(token, &pyramid, walk, block),
                    };
                }
                counts.primitive_tests += u64::from(tested) * PACKET as u64;
                if tested > budget {
                    packet.finish(token, walk, first);
                    return false;
                }
                budget -= tested;
                if tested > 0 {
                    match G::ENDS_RAYS {
                        true if packet.has_ended(token) => break,
                        true => {}
                        false => pyramid.reach = packet.reach(token),
                    }
                }
            }
        }
    }
    packet.finish(token, walk, first);
    true
}
