//! The builder's own form of a box, in which a union is eight minima: two instructions.

use crate::math::Aabb;
use simd::{F32Lanes, Simd};

/// A box: lower corner, tag, negated upper corner, unused.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Bounds([f32; 8]);

impl Bounds {
    /// The box that contains nothing.
    pub(super) const EMPTY: Self = Self([f32::INFINITY; 8]);

    pub(crate) fn new(bounds: Aabb) -> Self {
        let (lo, hi) = (bounds.lo, bounds.hi);
        Self([lo.x, lo.y, lo.z, 0.0, -hi.x, -hi.y, -hi.z, 0.0])
    }

    /// The same box with 32 bits kept beside it; they survive copies, not unions.
    pub(super) fn tagged(mut self, tag: u32) -> Self {
        self.0[3] = f32::from_bits(tag);
        self
    }

    pub(super) fn tag(&self) -> u32 {
        self.0[3].to_bits()
    }

    pub(crate) fn to_aabb(self) -> Aabb {
        let [lx, ly, lz, _, hx, hy, hz, _] = self.0;
        Aabb::new([lx, ly, lz].into(), [-hx, -hy, -hz].into())
    }

    #[inline(always)]
    pub(super) fn union(self, other: Self) -> Self {
        let mut out = self;
        for i in 0..8 {
            out.0[i] = if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] };
        }
        out
    }

    #[inline(always)]
    pub(super) fn intersection(self, other: Self) -> Self {
        let mut out = self;
        for i in 0..8 {
            out.0[i] = if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] };
        }
        out
    }

    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, token: S) -> S::F32x8 {
        S::F32x8::load(token, &self.0)
    }

    #[inline(always)]
    pub(super) fn from_lanes<F: F32Lanes<Array = [f32; 8]>>(lanes: F) -> Self {
        let mut bounds = Self::EMPTY;
        bounds.set_lanes(lanes);
        bounds
    }

    #[inline(always)]
    pub(super) fn set_lanes<F: F32Lanes<Array = [f32; 8]>>(&mut self, lanes: F) {
        lanes.store(&mut self.0);
    }

    /// Lower corner, tag.
    #[inline(always)]
    fn lower<S: Simd>(&self, token: S) -> S::F32x4 {
        S::F32x4::load_slice(token, &self.0[..4])
    }

    /// Negated upper corner, unused.
    #[inline(always)]
    fn negated_upper<S: Simd>(&self, token: S) -> S::F32x4 {
        S::F32x4::load_slice(token, &self.0[4..])
    }

    /// Twice the centre; the last lane is anything.
    #[inline(always)]
    pub(super) fn center2_lanes<S: Simd>(&self, token: S) -> S::F32x4 {
        self.lower(token) - self.negated_upper(token)
    }

    /// [`half_area`](Self::half_area) of a box that is empty on all axes or none.
    #[inline(always)]
    pub(super) fn half_area_lanes<S: Simd>(&self, token: S) -> f32 {
        let size = (-self.negated_upper(token) - self.lower(token)).max(S::F32x4::splat(token, 0.0));
        let mut sides = [0.0; 4];
        (size * token.yzx(size)).store(&mut sides);
        sides[0] + sides[1] + sides[2]
    }

    /// The box of one point.
    #[inline(always)]
    pub(super) fn point([x, y, z]: [f32; 3]) -> Self {
        Self([x, y, z, 0.0, -x, -y, -z, 0.0])
    }

    /// Grow by a point.
    #[inline(always)]
    pub(super) fn include(&mut self, point: [f32; 3]) {
        *self = self.union(Self::point(point));
    }

    #[inline(always)]
    pub(crate) fn lo(&self, axis: usize) -> f32 {
        self.0[axis]
    }

    #[inline(always)]
    pub(crate) fn hi(&self, axis: usize) -> f32 {
        -self.0[4 + axis]
    }

    /// Twice the centre along an axis.
    #[inline(always)]
    pub(super) fn center2(&self, axis: usize) -> f32 {
        self.0[axis] - self.0[4 + axis]
    }

    #[inline(always)]
    pub(super) fn set_lo(&mut self, axis: usize, value: f32) {
        self.0[axis] = value;
    }

    #[inline(always)]
    pub(super) fn set_hi(&mut self, axis: usize, value: f32) {
        self.0[4 + axis] = -value;
    }

    /// The slice at a place of an axis.
    #[inline(always)]
    pub(super) fn slice(mut self, axis: usize, at: f32) -> Self {
        self.set_lo(axis, at);
        self.set_hi(axis, at);
        self
    }

    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        !(0..3).all(|axis| self.lo(axis) <= self.hi(axis))
    }

    /// Half the surface area; 0 for an empty box.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let size = self.hi(axis) - self.lo(axis);
            if size > 0.0 { size } else { 0.0 }
        });
        if self.is_empty() { 0.0 } else { x * y + y * z + z * x }
    }
}
