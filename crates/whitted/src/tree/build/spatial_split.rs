//! Spatial splits: by a plane, cutting what straddles it.

use super::{Builder, Reference, cost};
use crate::math::{Aabb, Vec3f};

/// Bins per axis; planes lie on their borders.
const BINS: usize = 32;

/// Cut space by a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpatialSplit {
    /// Expected cost of the node with this split.
    pub cost: f32,
    /// References that it adds.
    pub added: usize,
    axis: usize,
    position: f32,
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    starts: usize,
    ends: usize,
}

const EMPTY_BIN: Bin = Bin { bounds: Aabb::EMPTY, starts: 0, ends: 0 };

/// The cheapest plane; `None` if none leaves something on both sides.
pub(super) fn find(builder: &Builder<'_>, references: &[Reference], bounds: Aabb) -> Option<SpatialSplit> {
    (0..3).filter_map(|axis| find_on_axis(builder, references, bounds, axis)).min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Planes at equal distances along one axis of a box.
#[derive(Clone, Copy)]
struct Planes {
    start: f32,
    step: f32,
}

impl Planes {
    fn border(&self, bin: usize) -> f32 {
        self.start + self.step * bin as f32
    }

    fn bin(&self, value: f32) -> usize {
        (((value - self.start) / self.step) as usize).min(BINS - 1)
    }
}

fn find_on_axis(builder: &Builder<'_>, references: &[Reference], bounds: Aabb, axis: usize) -> Option<SpatialSplit> {
    let planes = Planes { start: bounds.lo[axis], step: bounds.size()[axis] / BINS as f32 };
    // A cell too thin for distinct planes is not cut on this axis.
    if !(planes.border(1) > planes.start && planes.border(BINS - 1) < bounds.hi[axis]) {
        return None;
    }
    let mut bins = [EMPTY_BIN; BINS];
    for reference in references {
        fill(builder, &mut bins, reference, planes, axis);
    }
    sweep(builder, &bins, references.len(), bounds.half_area(), planes, axis)
}

/// Chop a reference at every plane that it straddles and add the pieces to their bins.
fn fill(builder: &Builder<'_>, bins: &mut [Bin; BINS], reference: &Reference, planes: Planes, axis: usize) {
    let first = planes.bin(reference.bounds.lo[axis]);
    let last = planes.bin(reference.bounds.hi[axis]);
    let mut rest = *reference;
    for bin in first..last {
        let (left, right) = builder.split(&rest, axis, planes.border(bin + 1));
        bins[bin].bounds = bins[bin].bounds.union(left);
        rest.bounds = right;
    }
    bins[last].bounds = bins[last].bounds.union(rest.bounds);
    bins[first].starts += 1;
    bins[last].ends += 1;
}

fn sweep(
    builder: &Builder<'_>,
    bins: &[Bin; BINS],
    count: usize,
    area: f32,
    planes: Planes,
    axis: usize,
) -> Option<SpatialSplit> {
    let mut right = [(Aabb::EMPTY, 0); BINS];
    let mut sum = (Aabb::EMPTY, 0);
    for border in (1..BINS).rev() {
        sum = (sum.0.union(bins[border].bounds), sum.1 + bins[border].ends);
        right[border] = sum;
    }
    let mut best: Option<SpatialSplit> = None;
    let mut left = (Aabb::EMPTY, 0);
    for border in 1..BINS {
        left = (left.0.union(bins[border - 1].bounds), left.1 + bins[border - 1].starts);
        let right = right[border];
        // A plane that every reference straddles gains nothing and would be chosen for ever.
        let gains = left.1 > 0 && right.1 > 0 && left.1 < count && right.1 < count;
        let cost = cost::split(builder.options, area, left, right);
        if gains && best.is_none_or(|best| cost < best.cost) {
            let added = left.1 + right.1 - count;
            best = Some(SpatialSplit { cost, added, axis, position: planes.border(border) });
        }
    }
    best
}

/// Apply a split: left parts come to the front (their number is returned), uncut right ones follow, and right parts of
/// cut references are appended to `cut_off`.
pub(super) fn cut(
    builder: &Builder<'_>,
    split: &SpatialSplit,
    references: &mut [Reference],
    cut_off: &mut Vec<Reference>,
) -> usize {
    let (axis, position) = (split.axis, split.position);
    let mut left_count = super::partition(references, |r| r.bounds.lo[axis] < position);
    let mut index = 0;
    while index < left_count {
        let whole = references[index];
        if whole.bounds.hi[axis] <= position {
            index += 1;
            continue;
        }
        let (left, right) = builder.split(&whole, axis, position);
        if left.is_empty() {
            // Clipping found nothing on the left after all: the whole goes right.
            left_count -= 1;
            references.swap(index, left_count);
            continue;
        }
        references[index].bounds = left;
        if !right.is_empty() {
            cut_off.push(Reference { bounds: right, ..whole });
        }
        index += 1;
    }
    left_count
}

impl Builder<'_> {
    /// The boxes of the parts of a reference below and above a plane; a part may be empty, never both.
    fn split(&self, reference: &Reference, axis: usize, position: f32) -> (Aabb, Aabb) {
        let (left, right) = self.clip(reference, axis, position);
        match (left.is_empty(), right.is_empty()) {
            // Rounding lost the sliver: keep the boxes of the plain cut.
            (true, true) => halves(reference.bounds, axis, position),
            _ => (left, right),
        }
    }
}

/// A box cut by a plane.
pub(super) fn halves(bounds: Aabb, axis: usize, position: f32) -> (Aabb, Aabb) {
    let at = |v: Vec3f| Vec3f::from([0, 1, 2].map(|a| if a == axis { position } else { v[a] }));
    let left = Aabb::new(bounds.lo, bounds.hi.min(at(bounds.hi)));
    let right = Aabb::new(bounds.lo.max(at(bounds.lo)), bounds.hi);
    (left, right)
}
