//! The bounded primitives that are neither triangle nor sphere, in one closed list.

use super::{Boxed, Cone, Cylinder, Disc};

/// A bounded primitive that is intersected in double precision, one ray at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A flat round plate, possibly with a hole.
    Disc(Disc),
    /// An axis-aligned box.
    Boxed(Boxed),
    /// A round tube, open or capped.
    Cylinder(Cylinder),
    /// A cone or a frustum of one, open or capped.
    Cone(Cone),
}

/// The parameters at which a line meets a surface, ascending; at most four are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crossings {
    t: [f64; 4],
    len: usize,
}

impl Crossings {
    /// No crossing.
    pub const NONE: Self = Self { t: [0.0; 4], len: 0 };

    /// Insert `t` in order. NaN and anything beyond four crossings (no shape has more) are dropped.
    pub fn insert(&mut self, t: f64) {
        if t.is_nan() || self.len == self.t.len() {
            return;
        }
        let at = self.as_slice().partition_point(|&other| other <= t);
        self.t.copy_within(at..self.len, at + 1);
        self.t[at] = t;
        self.len += 1;
    }

    /// The parameters, ascending.
    pub fn as_slice(&self) -> &[f64] {
        &self.t[..self.len]
    }
}
