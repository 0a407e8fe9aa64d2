//! The naive choice of planes: half of the objects on either side, whatever that costs.

use super::{Plane, Reference};
use crate::math::Aabb;

/// So few objects make a leaf.
const LEAF: usize = 2;

/// The plane through the median of the centres along the axis that is due, or the next one that separates anything.
pub(super) fn middle(references: &[Reference], bounds: Aabb, depth: usize) -> Option<Plane> {
    if references.len() <= LEAF {
        return None;
    }
    (depth..depth + 3).map(|axis| through_median(references, axis % 3)).find(|plane| {
        let inside = bounds.lo[plane.axis] < plane.position && plane.position < bounds.hi[plane.axis];
        inside && plane.counts.iter().all(|&count| count < references.len())
    })
}

fn through_median(references: &[Reference], axis: usize) -> Plane {
    let mut centers: Vec<f32> = references.iter().map(|r| r.bounds.center()[axis]).collect();
    let middle = centers.len() / 2;
    let (_, &mut position, _) = centers.select_nth_unstable_by(middle, f32::total_cmp);
    let mut plane = Plane { axis, position, counts: [0; 2] };
    for reference in references {
        let (below, above) = plane.sides(reference);
        plane.counts[0] += usize::from(below);
        plane.counts[1] += usize::from(above);
    }
    plane
}
