//! Object splits: by the centres of the references' boxes.

use super::{BuildOptions, Reference, cost};
use crate::math::{Aabb, Vec3f};

/// Bins per axis.
const BINS: usize = 32;

/// Divide at a bin border.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObjectSplit {
    /// Expected cost of the node with this split.
    pub cost: f32,
    /// Half area of the common part of the two boxes.
    pub overlap: f32,
    axis: usize,
    bins: Bins,
    /// Bins below this one go left.
    border: usize,
}

impl ObjectSplit {
    pub(super) fn is_left(&self, reference: &Reference) -> bool {
        self.bins.of(center(reference)[self.axis]) < self.border
    }
}

/// Twice the centre.
#[inline(always)]
fn center(reference: &Reference) -> Vec3f {
    reference.bounds.lo + reference.bounds.hi
}

/// The map from a coordinate to a bin.
#[derive(Clone, Copy, Debug, Default)]
struct Bins {
    start: f32,
    per_unit: f32,
}

impl Bins {
    fn new(lo: f32, hi: f32) -> Option<Self> {
        let per_unit = BINS as f32 / (hi - lo);
        (hi > lo && per_unit.is_finite()).then_some(Self { start: lo, per_unit })
    }

    #[inline(always)]
    fn of(&self, value: f32) -> usize {
        (((value - self.start) * self.per_unit) as usize).min(BINS - 1)
    }
}

/// The cheapest split by centres; `None` if all centres coincide.
pub(super) fn find(options: &BuildOptions, references: &[Reference], bounds: Aabb) -> Option<ObjectSplit> {
    let centers = references.iter().fold(Aabb::EMPTY, |b, r| b.union(Aabb::new(center(r), center(r))));
    let maps = [0, 1, 2].map(|axis| Bins::new(centers.lo[axis], centers.hi[axis]));
    let mut filled = [[(Aabb::EMPTY, 0usize); BINS]; 3];
    for reference in references {
        let center = center(reference);
        for axis in 0..3 {
            let (bin_bounds, count) = &mut filled[axis][maps[axis].unwrap_or_default().of(center[axis])];
            *bin_bounds = bin_bounds.union(reference.bounds);
            *count += 1;
        }
    }
    (0..3)
        .filter_map(|axis| Some(sweep(options, &filled[axis], bounds.half_area(), axis, maps[axis]?)))
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The cheapest border between the bins of one axis.
fn sweep(options: &BuildOptions, bins: &[(Aabb, usize); BINS], area: f32, axis: usize, map: Bins) -> ObjectSplit {
    let join = |a: (Aabb, usize), b: (Aabb, usize)| (a.0.union(b.0), a.1 + b.1);
    let mut right = [(Aabb::EMPTY, 0); BINS];
    let mut sum = (Aabb::EMPTY, 0);
    for border in (1..BINS).rev() {
        sum = join(sum, bins[border]);
        right[border] = sum;
    }
    let mut best = ObjectSplit { cost: f32::INFINITY, overlap: 0.0, axis, bins: map, border: 1 };
    let mut left = (Aabb::EMPTY, 0);
    for border in 1..BINS {
        left = join(left, bins[border - 1]);
        let cost = cost::split(options, area, left, right[border]);
        // The first and the last bin are never empty, so no side is.
        if cost < best.cost {
            best = ObjectSplit { cost, overlap: left.0.intersection(right[border].0).half_area(), border, ..best };
        }
    }
    best
}
