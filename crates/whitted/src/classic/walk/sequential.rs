//! The paper's walk (§2.3.3): find the leaf in which the ray is, test its objects, go on behind it from the root.
//!
//! The paper finds a leaf by a *point*, which it moves "slightly forward" out of the last one. However far that is, it
//! is too far for a thin leaf and not far enough where rounding swallows it; at planes through vertices such walks miss
//! what they should hit. Here the place is the *parameter* at which the ray left the last leaf, compared with the same
//! parameters of planes by which it was left: the descent from the root takes the far half of exactly that plane.
//! Every round ends at a later parameter, so the walk ends.

use super::Walker;
use crate::classic::kd_tree::KdTree;
use crate::classic::math::Arithmetic;
use crate::classic::node::{Content, NodeId};
use crate::classic::observer::Observer;
use crate::classic::ray::{PlaneRay, earlier};
use crate::tree::Goal;

/// Walk the tree, in which the ray is during `interval`. The ray is [exact](PlaneRay::is_exact): where cells overlap,
/// one parameter does not say where it is.
#[inline(always)]
pub(in crate::classic) fn walk<M: Arithmetic, G: Goal, O: Observer>(
    tree: &KdTree,
    ray: &PlaneRay,
    [mut start, end]: [f32; 2],
    walker: &mut Walker<'_, M, G, O>,
) {
    loop {
        let exit = leaf_at(tree, ray, [start, end], walker);
        if !(exit < end && exit < walker.limit) {
            return;
        }
        start = exit;
    }
}

/// Test the leaf in which the ray is right after `start`; returns where it leaves it.
#[inline(always)]
fn leaf_at<M: Arithmetic, G: Goal, O: Observer>(
    tree: &KdTree,
    ray: &PlaneRay,
    [start, mut end]: [f32; 2],
    walker: &mut Walker<'_, M, G, O>,
) -> f32 {
    let mut node = NodeId::ROOT;
    loop {
        match tree.content(node) {
            Content::Interior { axis, plane, pair } => {
                walker.observer.step(node, [start, end]);
                let meeting = ray.meet(axis, plane);
                // A ray that starts in a plane, and runs along it, is in the far half; objects at the plane are in both.
                let is_near = start < meeting.leaves_near;
                if is_near {
                    end = earlier(end, meeting.leaves_near);
                }
                node = NodeId::child(pair, meeting.from_above == is_near);
            }
            Content::Leaf { first, count } => {
                walker.observer.leaf(node, [start, end]);
                walker.leaf(tree.leaf(first, count));
                return end;
            }
        }
    }
}
