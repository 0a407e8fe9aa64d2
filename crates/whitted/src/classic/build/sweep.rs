//! The surface area heuristic, exactly: every border of every object is tried.
//!
//! MacDonald and Booth 1990: a ray that meets a cell meets a part of it with a chance of about the ratio of their
//! *surface areas* (the paper prints volumes). Empty space is cut off at a discount (Havran 2000, §4.5.1).

use super::{Plane, Reference};
use crate::classic::kd_tree::halves;
use crate::math::Aabb;

/// Cost of a step to a child.
const STEP_COST: f32 = 1.0;

/// Cost of testing an object: a step reads one plane, a test is some forty operations and a square root or a division.
const TEST_COST: f32 = 1.5;

/// Share of the cost that is left where one side is empty.
const EMPTY_DISCOUNT: f32 = 0.8;

/// The cheapest plane; `None` where a leaf is cheaper.
pub(super) fn cheapest(references: &[Reference], bounds: Aabb) -> Option<Plane> {
    let mut best = None;
    let mut least = TEST_COST * references.len() as f32;
    for axis in 0..3 {
        for plane in borders(references, bounds, axis) {
            let cost = cost(&plane, bounds);
            if cost < least {
                (best, least) = (Some(plane), cost);
            }
        }
    }
    best
}

/// Expected cost of a cell with this plane.
fn cost(plane: &Plane, bounds: Aabb) -> f32 {
    let [lower, upper] = halves(bounds, plane.axis, plane.position);
    let [below, above] = plane.counts.map(|count| count as f32);
    let tests = (lower.half_area() * below + upper.half_area() * above) / bounds.half_area();
    let discount = if plane.counts.contains(&0) { EMPTY_DISCOUNT } else { 1.0 };
    STEP_COST + discount * TEST_COST * tests
}

/// Every plane within the cell at which an object begins or ends, ascending.
///
/// References are never flat, so those that begin before a plane and those that end after it are all that count: no
/// rule for objects that lie in a plane is needed.
fn borders(references: &[Reference], bounds: Aabb, axis: usize) -> impl Iterator<Item = Plane> {
    let starts = sorted(references.iter().map(|r| r.bounds.lo[axis]));
    let ends = sorted(references.iter().map(|r| r.bounds.hi[axis]));
    let (lo, hi) = (bounds.lo[axis], bounds.hi[axis]);
    let count = references.len();
    let (mut started, mut ended) = (0, 0);
    std::iter::from_fn(move || {
        let next_start = starts.get(started).copied().unwrap_or(f32::INFINITY);
        let position = next_start.min(*ends.get(ended)?);
        while ended < count && ends[ended] <= position {
            ended += 1;
        }
        let plane = Plane { axis, position, counts: [started, count - ended] };
        while started < count && starts[started] <= position {
            started += 1;
        }
        Some(plane)
    })
    .filter(move |plane| lo < plane.position && plane.position < hi)
}

fn sorted(positions: impl Iterator<Item = f32>) -> Vec<f32> {
    let mut positions: Vec<f32> = positions.collect();
    positions.sort_unstable_by(f32::total_cmp);
    positions
}
