//! Axis-aligned boxes.

use super::Vec3f;

/// A closed axis-aligned box; empty where `lo > hi` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb {
    /// Lower corner.
    pub lo: Vec3f,
    /// Upper corner.
    pub hi: Vec3f,
}

impl Aabb {
    /// The box that contains nothing and is neutral for [`union`](Self::union).
    pub const EMPTY: Self = Self {
        lo: Vec3f::new(f32::INFINITY, f32::INFINITY, f32::INFINITY),
        hi: Vec3f::new(f32::NEG_INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY),
    };

    /// The box with these corners.
    #[inline(always)]
    pub const fn new(lo: Vec3f, hi: Vec3f) -> Self {
        Self { lo, hi }
    }

    /// The smallest box around `points`; empty for none.
    pub fn around(points: impl IntoIterator<Item = Vec3f>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| bounds.union(Self::new(p, p)))
    }

    /// The smallest box that contains both.
    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    /// The common part; empty if there is none.
    #[inline(always)]
    pub fn intersection(self, other: Self) -> Self {
        Self::new(self.lo.max(other.lo), self.hi.min(other.hi))
    }

    /// True if the box contains no point (or a corner is NaN).
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        !(self.lo.x <= self.hi.x && self.lo.y <= self.hi.y && self.lo.z <= self.hi.z)
    }

    /// Edge lengths; negative or NaN components for an empty box.
    #[inline(always)]
    pub fn size(self) -> Vec3f {
        self.hi - self.lo
    }

    /// Half the surface area, the measure of the surface area heuristic; 0 for an empty box.
    #[inline(always)]
    pub fn half_area(self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let s = self.size();
        s.x * s.y + s.y * s.z + s.z * s.x
    }

    /// The centre.
    #[inline(always)]
    pub fn center(self) -> Vec3f {
        self.lo * 0.5 + self.hi * 0.5
    }

    /// True if `other` lies within this box; an empty `other` lies within any.
    pub fn contains(self, other: Self) -> bool {
        other.is_empty() || self.union(other) == self
    }

    /// The largest absolute coordinate of a corner; 0 for an empty box.
    pub fn max_abs(self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        self.lo.abs().max(self.hi.abs()).max_component()
    }

    /// The box grown by `by` on every side, rounded outward.
    pub fn grown(self, by: f32) -> Self {
        Self::new(self.lo.map(|a| (a - by).next_down()), self.hi.map(|a| (a + by).next_up()))
    }
}
