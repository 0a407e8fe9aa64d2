//! Spatial splits: by a plane, cutting what straddles it.

use super::reference::Reference;
use super::{Bounds, Builder, cost};

/// Most bins per axis; planes lie on their borders.
const MAX_BINS: usize = 16;

/// Bins for a number of references.
fn bin_count(references: usize) -> usize {
    (references / 4 + 8).min(MAX_BINS)
}

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
    bounds: Bounds,
    starts: usize,
    ends: usize,
}

const EMPTY_BIN: Bin = Bin { bounds: Bounds::EMPTY, starts: 0, ends: 0 };

/// The cheapest plane; `None` if none leaves something on both sides.
pub(super) fn find(builder: &Builder<'_>, references: &[Reference], bounds: Bounds) -> Option<SpatialSplit> {
    let count = bin_count(references.len());
    let planes = [0, 1, 2].map(|axis| Planes::new(bounds.lo(axis), bounds.hi(axis), count));
    let mut bins = [[EMPTY_BIN; MAX_BINS]; 3];
    for reference in references {
        for axis in 0..3 {
            if let Some(planes) = &planes[axis] {
                fill(builder, &mut bins[axis], reference, planes, axis);
            }
        }
    }
    (0..3)
        .filter_map(|axis| {
            sweep(builder, &bins[axis][..count], references.len(), bounds.half_area(), &planes[axis]?, axis)
        })
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Planes at equal distances along one axis of a box.
#[derive(Clone, Copy)]
struct Planes {
    start: f32,
    step: f32,
    per_unit: f32,
    last: usize,
}

impl Planes {
    /// `None` for a cell too thin for distinct planes.
    fn new(lo: f32, hi: f32, count: usize) -> Option<Self> {
        let step = (hi - lo) / count as f32;
        let planes = Self { start: lo, step, per_unit: 1.0 / step, last: count - 1 };
        (planes.border(1) > lo && planes.border(count - 1) < hi && planes.per_unit.is_finite()).then_some(planes)
    }

    fn border(&self, bin: usize) -> f32 {
        self.start + self.step * bin as f32
    }

    fn bin(&self, value: f32) -> usize {
        (((value - self.start) * self.per_unit) as usize).min(self.last)
    }
}

/// Chop a reference at every plane that it straddles and add the pieces to their bins.
fn fill(builder: &Builder<'_>, bins: &mut [Bin; MAX_BINS], reference: &Reference, planes: &Planes, axis: usize) {
    let first = planes.bin(reference.bounds().lo(axis)) % MAX_BINS;
    let last = planes.bin(reference.bounds().hi(axis)) % MAX_BINS;
    bins[first].starts += 1;
    bins[last].ends += 1;
    if first == last {
        bins[first].bounds = bins[first].bounds.union(*reference.bounds());
        return;
    }
    let solid = builder.solid(reference);
    for bin in first..=last {
        let lo = if bin == first { f32::NEG_INFINITY } else { planes.border(bin) };
        let hi = if bin == last { f32::INFINITY } else { planes.border(bin + 1) };
        bins[bin].bounds = bins[bin].bounds.union(solid.slab(reference, axis, lo, hi));
    }
}

fn sweep(
    builder: &Builder<'_>,
    bins: &[Bin],
    count: usize,
    area: f32,
    planes: &Planes,
    axis: usize,
) -> Option<SpatialSplit> {
    let mut right = [(Bounds::EMPTY, 0); MAX_BINS];
    let mut sum = (Bounds::EMPTY, 0);
    for border in (1..bins.len()).rev() {
        sum = (sum.0.union(bins[border].bounds), sum.1 + bins[border].ends);
        right[border] = sum;
    }
    let mut best: Option<SpatialSplit> = None;
    let mut left = (Bounds::EMPTY, 0);
    for border in 1..bins.len() {
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
    let mut left_count = super::partition(references, |r| r.bounds().lo(axis) < position);
    let mut index = 0;
    while index < left_count {
        let whole = references[index];
        if whole.bounds().hi(axis) <= position {
            index += 1;
            continue;
        }
        let (left, right) = halves(builder, &whole, axis, position);
        if left.is_empty() {
            // Clipping found nothing on the left after all: the whole goes right.
            left_count -= 1;
            references.swap(index, left_count);
            continue;
        }
        references[index] = whole.with_bounds(left);
        if !right.is_empty() {
            cut_off.push(whole.with_bounds(right));
        }
        index += 1;
    }
    left_count
}

/// The boxes of the parts of a reference below and above a plane; a part may be empty, never both.
fn halves(builder: &Builder<'_>, reference: &Reference, axis: usize, position: f32) -> (Bounds, Bounds) {
    let solid = builder.solid(reference);
    let left = solid.slab(reference, axis, f32::NEG_INFINITY, position);
    let right = solid.slab(reference, axis, position, f32::INFINITY);
    if !(left.is_empty() && right.is_empty()) {
        return (left, right);
    }
    // Rounding lost the sliver: keep the boxes of the plain cut.
    let (mut left, mut right) = (*reference.bounds(), *reference.bounds());
    left.set_hi(axis, position);
    right.set_lo(axis, position);
    (left, right)
}
