//! What nodes and leaves cost.

use super::super::leaf::BLOCK;
use super::{Bounds, BuildOptions};

/// Expected cost of testing `count` primitives.
///
/// The mean of the exact number of blocks and the fraction: a leaf with one primitive costs less than a full one,
/// since it may yet be merged, but more than an eighth.
#[inline(always)]
pub(super) fn leaf(options: &BuildOptions, count: usize) -> f32 {
    options.intersection_cost * 0.5 * (count.div_ceil(BLOCK) as f32 + count as f32 / BLOCK as f32)
}

/// Expected cost of stepping into a wide node, in tests of a block.
///
/// Flat between 0.5 and 2 for the speed of rays (bunny, Sponza, dragon); 3 loses 5 to 10 % on fine meshes, and less than
/// 2 makes trees larger.
pub(in crate::tree) const WIDE_NODE: f32 = 2.0;

/// Cost of testing a leaf of the finished tree, in tests of a block.
pub(super) fn blocks(count: usize) -> f32 {
    count.div_ceil(BLOCK) as f32
}

/// Expected cost of a node of half area `area` with `count` references, if `sides` is what both sides cost: the sum of half
/// area times cost as a leaf.
#[inline(always)]
pub(super) fn relative(options: &BuildOptions, area: f32, sides: f32, count: usize) -> f32 {
    // In a box without area every ray that enters it enters both halves.
    let chance = if area > 0.0 { sides / area } else { leaf(options, count) };
    options.traversal_cost + chance
}

/// Expected cost of a node with two children, each a box and a number of references.
pub(super) fn split(options: &BuildOptions, bounds: Bounds, sides: [(Bounds, usize); 2]) -> f32 {
    let side = |(bounds, count): (Bounds, usize)| bounds.half_area() * leaf(options, count);
    relative(options, bounds.half_area(), side(sides[0]) + side(sides[1]), sides[0].1 + sides[1].1)
}
