//! Object splits: by the centres of the references' boxes, sorted into bins.

use super::reference::Reference;
use super::{Bounds, BuildOptions, cost};
use simd::{F32Lanes, Kernel, Level, Simd, U32Lanes};

/// Most bins per axis; a power of two.
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
    /// The boxes of both sides.
    pub sides: [Bounds; 2],
    axis: usize,
    start: f32,
    per_unit: f32,
    /// Bins below this one go left.
    border: f32,
}

impl ObjectSplit {
    /// Divide at a doubled centre.
    pub(super) fn at_center(axis: usize, border: f32, sides: [Bounds; 2], cost: f32) -> Self {
        let overlap = sides[0].intersection(sides[1]).half_area();
        Self { cost, overlap, sides, axis, start: 0.0, per_unit: 1.0, border }
    }

    /// The very arithmetic of [`Bins::fill`]: no reference changes sides.
    #[inline(always)]
    pub(super) fn is_left(&self, reference: &Reference) -> bool {
        (reference.bounds().center2(self.axis) - self.start) * self.per_unit < self.border
    }
}

/// The cheapest split by centres; `None` if all centres coincide.
pub(super) fn find(
    level: Level,
    options: &BuildOptions,
    references: &[Reference],
    bounds: Bounds,
) -> Option<ObjectSplit> {
    simd::dispatch(level, Find { options, references, bounds })
}

struct Find<'a> {
    options: &'a BuildOptions,
    references: &'a [Reference],
    bounds: Bounds,
}

impl Kernel for Find<'_> {
    type Output = Option<ObjectSplit>;

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let count = bin_count(self.references.len());
        let (lo, hi) = center_range(token, self.references);
        let mut bins = Bins::new(lo, hi, count);
        bins.fill(token, self.references);
        let mut best: Option<Border> = None;
        for axis in 0..3 {
            if bins.per_unit[axis] > 0.0 {
                bins.sweep(token, self.options, axis, count, &mut best);
            }
        }
        let Border { cost, axis, border } = best?;
        let sides = bins.sides(axis, border, count);
        Some(ObjectSplit {
            cost: cost::relative(self.options, self.bounds.half_area(), cost, self.references.len()),
            overlap: sides[0].intersection(sides[1]).half_area(),
            sides,
            axis,
            start: bins.start[axis],
            per_unit: bins.per_unit[axis],
            border: border as f32,
        })
    }
}

/// The least and the largest doubled centre per axis.
#[inline(always)]
fn center_range<S: Simd>(token: S, references: &[Reference]) -> ([f32; 4], [f32; 4]) {
    let mut lo = S::F32x4::splat(token, f32::INFINITY);
    let mut hi = S::F32x4::splat(token, f32::NEG_INFINITY);
    for reference in references {
        let center = reference.bounds().center2_lanes(token);
        lo = center.min(lo);
        hi = center.max(hi);
    }
    let (mut least, mut largest) = ([0.0; 4], [0.0; 4]);
    lo.store(&mut least);
    hi.store(&mut largest);
    (least, largest)
}

/// References by bin, for each axis.
struct Bins {
    start: [f32; 4],
    /// 0 where all centres coincide.
    per_unit: [f32; 4],
    last: f32,
    bounds: [[Bounds; MAX_BINS]; 3],
    counts: [[u32; MAX_BINS]; 3],
}

/// A candidate: cost is the sum over both sides of half area times the cost of a leaf.
#[derive(Clone, Copy)]
struct Border {
    cost: f32,
    axis: usize,
    border: usize,
}

impl Bins {
    #[inline(always)]
    fn new(lo: [f32; 4], hi: [f32; 4], count: usize) -> Self {
        let mut per_unit = [0.0; 4];
        for axis in 0..3 {
            let scale = count as f32 / (hi[axis] - lo[axis]);
            per_unit[axis] = if hi[axis] > lo[axis] && scale.is_finite() { scale } else { 0.0 };
        }
        Self {
            start: lo,
            per_unit,
            last: (count - 1) as f32,
            bounds: [[Bounds::EMPTY; MAX_BINS]; 3],
            counts: [[0; MAX_BINS]; 3],
        }
    }

    #[inline(always)]
    fn fill<S: Simd>(&mut self, token: S, references: &[Reference]) {
        let start = S::F32x4::load(token, &self.start);
        let per_unit = S::F32x4::load(token, &self.per_unit);
        let last = S::F32x4::splat(token, self.last);
        let mut bins = [0; 4];
        for reference in references {
            let bounds = reference.bounds();
            let position = (bounds.center2_lanes(token) - start) * per_unit;
            position.floor().min(last).round_to_int().store(&mut bins);
            let lanes = bounds.lanes(token);
            for axis in 0..3 {
                let bin = bins[axis] as usize % MAX_BINS;
                self.bounds[axis][bin].set_lanes(self.bounds[axis][bin].lanes(token).min(lanes));
                self.counts[axis][bin] += 1;
            }
        }
    }

    /// Look for a border of one axis that is cheaper than `best`.
    #[inline(always)]
    fn sweep<S: Simd>(&self, token: S, options: &BuildOptions, axis: usize, count: usize, best: &mut Option<Border>) {
        let (bounds, counts) = (&self.bounds[axis], &self.counts[axis]);
        let mut right_costs = [0.0; MAX_BINS];
        let (mut sum, mut number) = (Bounds::EMPTY.lanes(token), 0);
        for border in (1..count.min(MAX_BINS)).rev() {
            sum = sum.min(bounds[border].lanes(token));
            number += counts[border];
            right_costs[border] = Bounds::from_lanes(sum).half_area_lanes(token) * cost::leaf(options, number as usize);
        }
        let (mut sum, mut number) = (Bounds::EMPTY.lanes(token), 0);
        for border in 1..count.min(MAX_BINS) {
            sum = sum.min(bounds[border - 1].lanes(token));
            number += counts[border - 1];
            let left_cost = Bounds::from_lanes(sum).half_area_lanes(token) * cost::leaf(options, number as usize);
            let cost = left_cost + right_costs[border];
            // The first and the last bin are never empty, so no side is.
            if best.is_none_or(|best| cost < best.cost) {
                *best = Some(Border { cost, axis, border });
            }
        }
    }

    /// The boxes on both sides of a border.
    #[inline(always)]
    fn sides(&self, axis: usize, border: usize, count: usize) -> [Bounds; 2] {
        let mut sides = [Bounds::EMPTY; 2];
        for bin in 0..count.min(MAX_BINS) {
            let side = usize::from(bin >= border);
            sides[side] = sides[side].union(self.bounds[axis][bin]);
        }
        sides
    }
}
