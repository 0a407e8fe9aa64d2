//! Spatial splits: by a plane, cutting what straddles it.

use super::clip::Solid;
use super::reference::{Reference, partition};
use super::section::{PLANES, Sections, following, sections};
use super::{Bounds, Builder, cost};
use simd::{F32Lanes, Kernel, Simd};

/// Bins per axis; planes lie on their borders.
const BINS: usize = PLANES;

/// Cut space by a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpatialSplit {
    /// Expected cost of the node with this split.
    pub cost: f32,
    /// References that it adds at most.
    pub added: usize,
    axis: usize,
    planes: Planes,
    border: usize,
}

/// Planes at equal distances along one axis of a box.
#[derive(Clone, Copy, Debug)]
struct Planes {
    start: f32,
    step: f32,
    per_unit: f32,
}

impl Planes {
    /// `None` for a cell too thin for distinct planes.
    #[inline(always)]
    fn new(lo: f32, hi: f32) -> Option<Self> {
        let step = (hi - lo) / BINS as f32;
        let planes = Self { start: lo, step, per_unit: 1.0 / step };
        let distinct = planes.border(1) > lo && planes.border(BINS - 1) < hi && planes.per_unit.is_finite();
        distinct.then_some(planes)
    }

    #[inline(always)]
    fn border(&self, bin: usize) -> f32 {
        self.start + self.step * bin as f32
    }

    /// Not a number for the first bin, whose lower border cuts nothing.
    #[inline(always)]
    fn borders(&self) -> [f32; PLANES] {
        let mut borders = [f32::NAN; PLANES];
        for bin in 1..BINS {
            borders[bin] = self.border(bin);
        }
        borders
    }

    #[inline(always)]
    fn bin(&self, value: f32) -> usize {
        (((value - self.start) * self.per_unit) as usize).min(BINS - 1)
    }
}

/// The cheapest plane; `None` if none leaves something on both sides.
pub(super) fn find(builder: &Builder<'_>, references: &[Reference], bounds: Bounds) -> Option<SpatialSplit> {
    simd::dispatch(builder.level, Find { builder, references, bounds })
}

struct Find<'a> {
    builder: &'a Builder<'a>,
    references: &'a [Reference],
    bounds: Bounds,
}

impl Kernel for Find<'_> {
    type Output = Option<SpatialSplit>;

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let mut best = None;
        for axis in 0..3 {
            if let Some(planes) = Planes::new(self.bounds.lo(axis), self.bounds.hi(axis)) {
                let mut bins = Bins::fill(token, &self, axis, planes);
                bins.add_sections(token, axis, planes);
                bins.sweep(token, &self, axis, planes, &mut best);
            }
        }
        best
    }
}

/// Parts of references by bin of one axis.
struct Bins<S: Simd> {
    bounds: [Bounds; BINS],
    starts: [u32; BINS],
    ends: [u32; BINS],
    sections: Sections<S::F32x16>,
}

impl<S: Simd> Bins<S> {
    #[inline(always)]
    fn fill(token: S, cell: &Find<'_>, axis: usize, planes: Planes) -> Self {
        let borders = S::F32x16::load(token, &planes.borders());
        let mut bins = Self {
            bounds: [Bounds::EMPTY; BINS],
            starts: [0; BINS],
            ends: [0; BINS],
            sections: Sections::empty(token),
        };
        for reference in cell.references {
            let bounds = reference.bounds();
            let (first, last) = (planes.bin(bounds.lo(axis)), planes.bin(bounds.hi(axis)));
            bins.starts[first] += 1;
            bins.ends[last] += 1;
            if first == last {
                bins.include(token, first, bounds);
                continue;
            }
            let solid = cell.builder.solid(reference);
            bins.sections = bins.sections.union(sections(token, &solid, reference, axis, borders));
            bins.add_ends(token, &solid, reference, axis, planes);
        }
        bins
    }

    #[inline(always)]
    fn include(&mut self, token: S, bin: usize, bounds: &Bounds) {
        let bin = &mut self.bounds[bin % BINS];
        bin.set_lanes(bin.lanes(token).min(bounds.lanes(token)));
    }

    /// Add what lies between planes: vertices, and the ends of a reference that was cut before.
    #[inline(always)]
    fn add_ends(&mut self, token: S, solid: &Solid, reference: &Reference, axis: usize, planes: Planes) {
        let bounds = reference.bounds();
        let (lo, hi) = (bounds.lo(axis), bounds.hi(axis));
        let (mut is_cut_below, mut is_cut_above) = (true, true);
        match solid {
            Solid::Triangle(vertices) => {
                (is_cut_below, is_cut_above) = (false, false);
                for &vertex in vertices {
                    is_cut_below |= vertex[axis] < lo;
                    is_cut_above |= vertex[axis] > hi;
                    if lo <= vertex[axis] && vertex[axis] <= hi {
                        self.include(token, planes.bin(vertex[axis]), &Bounds::point(vertex).intersection(*bounds));
                    }
                }
            }
            Solid::Sphere { center, radius } => {
                let middle = center[axis];
                if lo <= middle && middle <= hi {
                    self.include(token, planes.bin(middle), &bounds.slice(axis, middle));
                }
                (is_cut_below, is_cut_above) = (middle - radius < lo.next_down(), middle + radius > hi.next_up());
                for (is_cut, end) in [(is_cut_below, lo), (is_cut_above, hi)] {
                    if !is_cut {
                        let pole = Bounds::point(*center).slice(axis, end);
                        self.include(token, planes.bin(end), &pole.intersection(*bounds));
                    }
                }
            }
            Solid::Boxed => {}
        }
        if is_cut_below {
            self.include(token, planes.bin(lo), &solid.slab(reference.bounds(), axis, lo, lo));
        }
        if is_cut_above {
            self.include(token, planes.bin(hi), &solid.slab(reference.bounds(), axis, hi, hi));
        }
    }

    /// Add the sections with each plane to the bins on its two sides.
    #[inline(always)]
    fn add_sections(&mut self, token: S, axis: usize, planes: Planes) {
        let [u, v] = following(axis);
        let mut rows = [[0.0; PLANES]; 4];
        for row in 0..4 {
            self.sections.0[row].store(&mut rows[row]);
        }
        for border in 1..BINS {
            let mut section = Bounds::EMPTY;
            section.set_lo(axis, planes.border(border));
            section.set_hi(axis, planes.border(border));
            section.set_lo(u, rows[0][border]);
            section.set_lo(v, rows[1][border]);
            section.set_hi(u, -rows[2][border]);
            section.set_hi(v, -rows[3][border]);
            if rows[0][border] < f32::INFINITY {
                self.include(token, border - 1, &section);
                self.include(token, border, &section);
            }
        }
    }

    /// Look for a plane that is cheaper than `best`.
    #[inline(always)]
    fn sweep(&self, token: S, cell: &Find<'_>, axis: usize, planes: Planes, best: &mut Option<SpatialSplit>) {
        let (options, area, count) = (cell.builder.options, cell.bounds.half_area(), cell.references.len() as u32);
        let mut right = [(0.0, 0); BINS];
        let (mut sum, mut number) = (Bounds::EMPTY.lanes(token), 0);
        for border in (1..BINS).rev() {
            sum = sum.min(self.bounds[border].lanes(token));
            number += self.ends[border];
            let side = Bounds::from_lanes(sum).half_area_lanes(token) * cost::leaf(options, number as usize);
            right[border] = (side, number);
        }
        let (mut sum, mut number) = (Bounds::EMPTY.lanes(token), 0);
        for border in 1..BINS {
            sum = sum.min(self.bounds[border - 1].lanes(token));
            number += self.starts[border - 1];
            let (right_side, right_number) = right[border];
            // A plane that every reference straddles gains nothing and would be chosen for ever.
            let gains = number > 0 && right_number > 0 && number < count && right_number < count;
            let left_side = Bounds::from_lanes(sum).half_area_lanes(token) * cost::leaf(options, number as usize);
            let sides = left_side + right_side;
            let cost = cost::relative(options, area, sides, (number + right_number) as usize);
            if gains && best.is_none_or(|best| cost < best.cost) {
                let added = (number + right_number - count) as usize;
                *best = Some(SpatialSplit { cost, added, axis, planes, border });
            }
        }
    }
}

/// Apply a split: left parts come to the front (their number is returned), uncut right ones follow, and right parts of
/// cut references are appended to `cut_off`.
pub(super) fn cut(
    builder: &Builder<'_>,
    split: &SpatialSplit,
    references: &mut [Reference],
    cut_off: &mut Vec<Reference>,
) -> usize {
    let (axis, planes) = (split.axis, split.planes);
    let position = planes.border(split.border);
    // By bins, not by position: no more are cut than were counted.
    let mut left_count = partition(references, |r| planes.bin(r.bounds().lo(axis)) < split.border);
    let mut index = 0;
    while index < left_count {
        let whole = references[index];
        if planes.bin(whole.bounds().hi(axis)) < split.border {
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
    let left = solid.slab(reference.bounds(), axis, f32::NEG_INFINITY, position);
    let right = solid.slab(reference.bounds(), axis, position, f32::INFINITY);
    if !(left.is_empty() && right.is_empty()) {
        return (left, right);
    }
    // Rounding lost the sliver: keep the boxes of the plain cut.
    let (mut left, mut right) = (*reference.bounds(), *reference.bounds());
    left.set_hi(axis, position);
    right.set_lo(axis, position);
    (left, right)
}
