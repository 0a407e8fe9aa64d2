//! The walk with a stack (Havran 2000, TA-B: the recursive one, with the recursion unrolled).

use super::Walker;
use crate::classic::build::MAX_DEPTH;
use crate::classic::kd_tree::KdTree;
use crate::classic::math::Arithmetic;
use crate::classic::node::{Content, NodeId};
use crate::classic::observer::Observer;
use crate::classic::ray::{PlaneRay, earlier, later};
use crate::tree::Goal;

/// Walk the tree, in which the ray is during `interval`.
#[inline(always)]
pub(in crate::classic) fn walk<M: Arithmetic, G: Goal, O: Observer>(
    tree: &KdTree,
    ray: &PlaneRay,
    interval: [f32; 2],
    walker: &mut Walker<'_, M, G, O>,
) {
    // Each plane leaves one half behind.
    let mut stack = [(NodeId::ROOT, [0.0; 2]); MAX_DEPTH];
    let mut waiting = 0;
    let (mut node, [mut start, mut end]) = (NodeId::ROOT, interval);
    loop {
        match tree.content(node) {
            Content::Interior { axis, plane, pair } => {
                walker.observer.step(node, [start, end]);
                let meeting = ray.meet(axis, plane);
                let near = NodeId::child(pair, meeting.from_above);
                let far = NodeId::child(pair, !meeting.from_above);
                // Both, unless one is surely missed: NaN visits both.
                if meeting.leaves_near < start {
                    (node, start) = (far, later(start, meeting.enters_far));
                } else if meeting.enters_far > end {
                    (node, end) = (near, earlier(end, meeting.leaves_near));
                } else {
                    stack[waiting] = (far, [later(start, meeting.enters_far), end]);
                    waiting += 1;
                    (node, end) = (near, earlier(end, meeting.leaves_near));
                }
            }
            Content::Leaf { first, count } => {
                walker.observer.leaf(node, [start, end]);
                walker.leaf(tree.leaf(first, count));
                loop {
                    if waiting == 0 {
                        return;
                    }
                    waiting -= 1;
                    (node, [start, end]) = stack[waiting];
                    if start <= walker.limit {
                        break;
                    }
                }
            }
        }
    }
}
