//! Object splits: by the centres of the references' boxes, sorted into bins.

use super::{Bounds, BuildOptions, Reference, cost};

/// Most bins per axis.
const MAX_BINS: usize = 32;

/// Bins for a number of references: a few references in many bins only cost time.
fn bin_count(references: usize) -> usize {
    (references / 2 + 4).min(MAX_BINS)
}

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
        self.bins.of(reference.bounds.center2(self.axis)) < self.border
    }
}

/// The map from a coordinate to a bin.
#[derive(Clone, Copy, Debug, Default)]
struct Bins {
    start: f32,
    per_unit: f32,
    last: usize,
}

impl Bins {
    fn new(lo: f32, hi: f32, count: usize) -> Option<Self> {
        let per_unit = count as f32 / (hi - lo);
        (hi > lo && per_unit.is_finite()).then_some(Self { start: lo, per_unit, last: count - 1 })
    }

    #[inline(always)]
    fn of(&self, value: f32) -> usize {
        (((value - self.start) * self.per_unit) as usize).min(self.last)
    }
}

/// References by bin of one axis.
type Filled = [(Bounds, u32); MAX_BINS];

/// The cheapest split by centres; `None` if all centres coincide.
pub(super) fn find(options: &BuildOptions, references: &[Reference], bounds: Bounds) -> Option<ObjectSplit> {
    let count = bin_count(references.len());
    let mut centers = Bounds::EMPTY;
    for reference in references {
        centers.include([0, 1, 2].map(|axis| reference.bounds.center2(axis)));
    }
    let maps = [0, 1, 2].map(|axis| Bins::new(centers.lo(axis), centers.hi(axis), count));
    let [x, y, z] = maps.map(Option::unwrap_or_default);
    let mut filled: [Filled; 3] = [[(Bounds::EMPTY, 0); MAX_BINS]; 3];
    for reference in references {
        for (axis, map) in [x, y, z].into_iter().enumerate() {
            let (bin_bounds, count) = &mut filled[axis][map.of(reference.bounds.center2(axis)) % MAX_BINS];
            *bin_bounds = bin_bounds.union(reference.bounds);
            *count += 1;
        }
    }
    let area = bounds.half_area();
    (0..3)
        .filter_map(|axis| Some(sweep(options, &filled[axis][..count], area, axis, maps[axis]?)))
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The cheapest border between the bins of one axis.
fn sweep(options: &BuildOptions, bins: &[(Bounds, u32)], area: f32, axis: usize, map: Bins) -> ObjectSplit {
    let join = |a: (Bounds, u32), b: (Bounds, u32)| (a.0.union(b.0), a.1 + b.1);
    let mut right = [(Bounds::EMPTY, 0); MAX_BINS];
    let mut sum = (Bounds::EMPTY, 0);
    for border in (1..bins.len()).rev() {
        sum = join(sum, bins[border]);
        right[border] = sum;
    }
    let mut best = ObjectSplit { cost: f32::INFINITY, overlap: 0.0, axis, bins: map, border: 1 };
    let mut left = (Bounds::EMPTY, 0);
    for border in 1..bins.len() {
        left = join(left, bins[border - 1]);
        let right = right[border];
        let cost = cost::split(options, area, (left.0, left.1 as usize), (right.0, right.1 as usize));
        // The first and the last bin are never empty, so no side is.
        if cost < best.cost {
            best = ObjectSplit { cost, overlap: left.0.intersection(right.0).half_area(), border, ..best };
        }
    }
    best
}
