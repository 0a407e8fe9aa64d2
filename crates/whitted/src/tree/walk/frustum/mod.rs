//! Packets of rays with one origin through the wide tree, each bounded by a pyramid.
//!
//! Camera rays of a tile, or the segments from a light to neighbouring points, start at one point and run mostly along
//! one axis. The slopes of the other two axes span four planes; a box that lies outside one of them, or beyond every
//! ray's limit, is passed over by one fused multiply-add and one comparison per plane for all sixteen children, whatever
//! the number of rays. Slopes to the dominant axis never degenerate, unlike intervals of reciprocal directions, which
//! collapse where a component is near zero. Primitives of a leaf are culled by the same planes, eight at a time; each
//! survivor is tested against the rays sixteen at a time.
//!
//! The more rays a packet has, the fewer steps a ray takes, as long as they meet the same primitives. So packets begin
//! large; one that tests many primitives is halved, and each half goes on, in a pyramid of its own, with what waits to
//! be visited. The next packet begins as large as this one ended. One of the smallest, which straddles a silhouette or
//! whose primitives are smaller than itself, would still visit far too much: it has a budget, and goes on as a list of
//! the stream when it exceeds that, with what its rays have found so far.

mod group;
mod packet;
mod pyramid;

pub(super) use packet::Packet;

use super::Walk;
use super::prepared::Packets;
use super::turns::Stack;
use crate::tree::goal::Goal;
use crate::tree::leaf::LeafKind;
use crate::tree::node::{Child, ChildKind, WIDTH};
use crate::tree::query::Counts;
use pyramid::Pyramid;
use simd::Simd;
use std::ops::Range;

/// Rays of a group: the smallest packet.
pub(in crate::tree) const PACKET: usize = 64;
const LANES: usize = 16;

/// Groups of the largest packet. Eight gain nothing more in meshes and lose 7 to 12 % of 1000 spheres.
const GROUPS: usize = 4;

/// Primitives that a packet of several groups may test before it is halved.
const PATIENCE: u32 = 16;

/// Primitives that a group may test before it goes to the stream: more than this and its rays have little in common. Less
/// where rays end, since what a list asks of the rays of a packet that ended early is little.
const BUDGET: u32 = 256;
const BUDGET_OF_ENDING: u32 = 32;

/// Part of a packet.
#[derive(Clone, Default)]
struct Part {
    groups: Range<usize>,
    /// What it still has to visit: places of the stack.
    waiting: Range<usize>,
}

/// Parts of a packet that there are at a time: a quarter, a quarter and a half.
const PARTS: usize = 3;

/// How following a part ended.
enum End {
    /// All that it meets has been tested.
    Complete,
    /// It tested more than it may; the stack is left with so many entries.
    Exceeded { top: usize },
    /// It met shapes, which packets do not test.
    Shapes,
}

/// Follow the packet of rays from `first` on, and add those of its groups to `walked` that need no other walk: not those that
/// exceeded their budget. Returns how many rays have been looked at.
#[inline(always)]
pub(super) fn walk<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    stack: &mut Stack,
    packet: &mut Packet,
    first: usize,
    walked: &mut Packets,
    counts: &mut Counts,
) -> usize {
    let taken = packet.take(token, walk, first);
    if taken == 0 {
        return PACKET;
    }
    let rays = taken * PACKET;
    Packet::prefetch(walk, first + rays, rays);
    stack.reserve(walk.tree.depth(), PARTS);
    (stack.entry[0], stack.child[0]) = (f32::NEG_INFINITY, Child::interior(0).0);
    let tests_before = counts.primitive_tests;
    let mut parts: [Part; PARTS] = Default::default();
    parts[0] = Part { groups: 0..taken, waiting: 0..1 };
    let (mut left, mut is_halved) = (1, false);
    while left > 0 {
        left -= 1;
        let part = parts[left].clone();
        match follow(token, walk, stack, packet, &part, counts) {
            End::Complete => part.groups.for_each(|group| walked.insert(first / PACKET + group)),
            End::Exceeded { top } if part.groups.len() > 1 => {
                let [near, far] = part.halves(stack, top);
                (parts[left], parts[left + 1]) = (far, near);
                left += 2;
                is_halved = true;
            }
            End::Exceeded { .. } | End::Shapes => {}
        }
    }
    packet.finish(token, walk, taken);
    packet.adapt(is_halved, (counts.primitive_tests - tests_before) / rays as u64);
    rays
}

impl Part {
    /// Divide the groups; each half gets what waits on the stack below `top`, the first one on top.
    #[inline(always)]
    fn halves(&self, stack: &mut Stack, top: usize) -> [Self; 2] {
        let (groups, waiting) = (self.groups.clone(), self.waiting.start..top);
        stack.entry.copy_within(waiting.clone(), top);
        stack.child.copy_within(waiting.clone(), top);
        let middle = groups.start + groups.len() / 2;
        [
            Self { groups: groups.start..middle, waiting: top..top + waiting.len() },
            Self { groups: middle..groups.end, waiting },
        ]
    }
}

/// Follow a part of a packet through what waits for it, until it is done or exceeds what it may test.
#[inline(always)]
fn follow<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    stack: &mut Stack,
    packet: &mut Packet,
    part: &Part,
    counts: &mut Counts,
) -> End {
    let groups = part.groups.clone();
    let rays = (groups.len() * PACKET) as u64;
    let mut pyramid = Pyramid::around(token, walk, packet, groups.clone());
    let octant = packet.frame.octant;
    let mut budget = match groups.len() {
        1 if G::ENDS_RAYS => BUDGET_OF_ENDING,
        1 => BUDGET,
        _ => PATIENCE,
    };
    let Range { start: bottom, end: mut top } = part.waiting.clone();
    while top > bottom {
        top -= 1;
        if stack.entry[top] > pyramid.reach {
            continue;
        }
        match Child(stack.child[top]).decode() {
            ChildKind::Interior(node) => {
                counts.node_steps += rays;
                let (node, before) = (&walk.tree.nodes[node], top);
                let (mask, entry) = pyramid.enter(token, node);
                let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
                top += token.compress_in_order(mask, &node.order(octant), entry, node.children(), keys, values);
                // Most of them will be visited: while the nearest is, the others come from memory.
                walk.tree.prefetch_all(stack.child[before..top].iter().map(|&child| Child(child)));
            }
            ChildKind::Leaf { kind: LeafKind::Shapes, .. } => return End::Shapes,
            ChildKind::Leaf { kind, first, count } => {
                let mut tested = 0;
                for block in first..first + count {
                    tested += match kind {
                        LeafKind::Triangles => packet.triangles(token, walk, (&pyramid, groups.clone()), block),
                        _ => packet.spheres(token, walk, (&pyramid, groups.clone()), block),
                    };
                }
                counts.primitive_tests += u64::from(tested) * rays;
                if tested > budget && top > bottom {
                    return End::Exceeded { top };
                }
                budget = budget.saturating_sub(tested);
                if tested > 0 {
                    match G::ENDS_RAYS {
                        true if packet.has_ended(token, groups.clone()) => return End::Complete,
                        true => {}
                        false => pyramid.reach = packet.reach(token, groups.clone()),
                    }
                }
            }
        }
    }
    End::Complete
}
