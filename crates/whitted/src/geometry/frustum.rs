//! The round side between two circles on one axis: what cylinder and cone have in common.

use super::shape::{disc_reach, perpendicular_frame, round_outward};
use super::{Crossings, ShapePoint};
use crate::math::{Aabb, Vec3d, atan2};
use std::f64::consts::TAU;

/// A frustum of a cone, or a cylinder, prepared for queries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frustum {
    base: Vec3d,
    /// Unit vector from the base to the other end.
    axis: Vec3d,
    height: f64,
    base_radius: f64,
    apex_radius: f64,
    /// Radius gained per length of axis.
    slope: f64,
    capped: bool,
}

/// Frustums flatter than this part of their larger radius have no side that single precision could see.
const FLAT: f64 = 1.0 / (1u64 << 24) as f64;

impl Frustum {
    pub(super) fn new(base: Vec3d, apex: Vec3d, base_radius: f64, apex_radius: f64, capped: bool) -> Self {
        let height = (apex - base).length();
        let (axis, slope) = ((apex - base) / height, (apex_radius - base_radius) / height);
        Self { base, axis, height, base_radius, apex_radius, slope, capped }
    }

    pub(super) fn has_area(&self) -> bool {
        let radius = self.base_radius.max(self.apex_radius);
        let radii = self.base_radius >= 0.0 && self.apex_radius >= 0.0 && radius > 0.0 && radius.is_finite();
        radii && self.height.is_finite() && self.height > FLAT * radius && self.axis.is_finite()
    }

    /// The box of the two end circles: the side is their convex hull.
    pub(super) fn bounds(&self) -> Aabb {
        let apex = self.base + self.axis * self.height;
        let (at_base, at_apex) = (disc_reach(self.axis) * self.base_radius, disc_reach(self.axis) * self.apex_radius);
        round_outward((self.base - at_base).min(apex - at_apex), (self.base + at_base).max(apex + at_apex))
    }

    pub(super) fn crossings(&self, origin: Vec3d, direction: Vec3d) -> Crossings {
        let line = Line::new(self, origin, direction);
        match self.capped {
            true => self.solid_crossings(&line),
            false => self.side_crossings(&line),
        }
    }

    fn side_crossings(&self, line: &Line) -> Crossings {
        let mut crossings = Crossings::NONE;
        for t in line.roots().into_iter().flatten() {
            let height = line.height + line.rise * t;
            if 0.0 <= height && height <= self.height {
                crossings.insert(t);
            }
        }
        crossings
    }

    /// The solid is convex: the line is inside between the later entry and the earlier exit of slab and cone. Pairing
    /// them leaves no crack where side and cap meet.
    fn solid_crossings(&self, line: &Line) -> Crossings {
        match (self.slab_interval(line), line.inside_cone()) {
            (Some((a0, a1)), Some((b0, b1))) => Crossings::interval(a0.max(b0), a1.min(b1)),
            _ => Crossings::NONE,
        }
    }

    /// Where the line lies between the planes of the two ends.
    fn slab_interval(&self, line: &Line) -> Option<(f64, f64)> {
        if line.rise == 0.0 {
            let between = 0.0 <= line.height && line.height <= self.height;
            return between.then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let (at_base, at_apex) = (-line.height / line.rise, (self.height - line.height) / line.rise);
        Some((at_base.min(at_apex), at_base.max(at_apex)))
    }

    /// The nearest point of the side or, if capped, of an end. `uv` of the side: angle about the axis and height; of an
    /// end: the square around it; each from 0 to 1.
    pub(super) fn surface(&self, near: Vec3d) -> ShapePoint {
        let offset = near - self.base;
        let height = offset.dot(self.axis);
        let from_axis = offset - self.axis * height;
        let frame = perpendicular_frame(self.axis);
        let across = frame.map(|axis| axis.dot(from_axis));
        let distance = from_axis.length();
        // Along the normal, which leans towards the narrow end, the side is nearer than across the axis.
        let lean = 1.0 / (1.0 + self.slope * self.slope).sqrt();
        let to_side = (distance - (self.base_radius + self.slope * height)) * lean;
        if let Some(end) = self.nearer_end(height, to_side.abs()) {
            return end.surface(self, near, across);
        }
        let outward = if distance > 0.0 { from_axis / distance } else { frame[0] };
        let normal = (outward - self.axis * self.slope) * lean;
        let turn = atan2(across[1], across[0]) / TAU;
        let uv = [if turn < 0.0 { turn + 1.0 } else { turn }, (height / self.height).clamp(0.0, 1.0)];
        ShapePoint { position: near - normal * to_side, normal, uv }
    }

    /// The end that a point at this height is nearer to than to the side.
    fn nearer_end(&self, height: f64, to_side: f64) -> Option<End> {
        let base = End { height: 0.0, radius: self.base_radius, out: -1.0 };
        let apex = End { height: self.height, radius: self.apex_radius, out: 1.0 };
        let end = if (height - base.height).abs() < (height - apex.height).abs() { base } else { apex };
        (self.capped && end.radius > 0.0 && (height - end.height).abs() < to_side).then_some(end)
    }
}

/// One end of a frustum.
#[derive(Clone, Copy)]
struct End {
    height: f64,
    radius: f64,
    /// 1 if the outward normal is the axis, −1 if it is opposite.
    out: f64,
}

impl End {
    fn surface(&self, frustum: &Frustum, near: Vec3d, across: [f64; 2]) -> ShapePoint {
        let height = (near - frustum.base).dot(frustum.axis);
        ShapePoint {
            position: near + frustum.axis * (self.height - height),
            normal: frustum.axis * self.out,
            uv: across.map(|a| 0.5 + 0.5 * a / self.radius),
        }
    }
}

/// A line and the infinite double cone around a frustum's axis: the terms of the quadratic
/// `a t² + 2 half_b t + c`, which is negative inside.
///
/// With X, Y the parts of direction and origin across the axis and x, y the cone's radius gained per t and at the
/// origin, a = X² − x², half_b = X·Y − xy, c = Y² − y². The discriminant half_b² − ac would lose all digits for a far
/// origin; Lagrange's identity turns it into |yX − xY|² − |X × Y|², the difference of two squared lengths that are the
/// radius and the distance from the axis but for a factor.
struct Line {
    a: f64,
    half_b: f64,
    c: f64,
    discriminant: f64,
    /// Height of the origin above the base, and gained per t.
    height: f64,
    rise: f64,
    /// Radius of the cone gained per t.
    widening: f64,
}

impl Line {
    fn new(frustum: &Frustum, origin: Vec3d, direction: Vec3d) -> Self {
        let from_base = origin - frustum.base;
        let (height, rise) = (from_base.dot(frustum.axis), direction.dot(frustum.axis));
        let (across, from_axis) = (direction - frustum.axis * rise, from_base - frustum.axis * height);
        let (widening, radius) = (frustum.slope * rise, frustum.base_radius + frustum.slope * height);
        let reach = across * radius - from_axis * widening;
        Self {
            a: across.length_squared() - widening * widening,
            half_b: across.dot(from_axis) - widening * radius,
            c: from_axis.length_squared() - radius * radius,
            discriminant: reach.length_squared() - across.cross(from_axis).length_squared(),
            height,
            rise,
            widening,
        }
    }

    /// Both roots in any order. One is infinite if the equation is linear, both are NaN if it has no t in it.
    fn roots(&self) -> Option<[f64; 2]> {
        if self.discriminant >= 0.0 { Some(self.roots_with(self.discriminant)) } else { None }
    }

    /// The roots without cancellation: the sum has terms of one sign, the other root follows from the product c / a.
    fn roots_with(&self, discriminant: f64) -> [f64; 2] {
        let q = -(self.half_b + discriminant.sqrt().copysign(self.half_b));
        let first = q / self.a;
        [first, if q == 0.0 { first } else { self.c / q }]
    }

    /// Where the line is inside the half of the double cone that can have a positive radius between the ends; the
    /// interval may reach into the other half, which lies beyond the ends.
    fn inside_cone(&self) -> Option<(f64, f64)> {
        if self.a < 0.0 {
            return Some(self.inside_one_half());
        }
        let [t0, t1] = self.roots()?;
        if t0.is_nan() {
            // Parallel to a cylinder's side: inside everywhere or nowhere.
            return (self.c <= 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        Some((t0.min(t1), t0.max(t1)))
    }

    /// Where a line that is steeper than the side is inside: one root on each half, to infinity beyond it. Between them
    /// the line passes the tip's plane outside, so real roots exist and a negative discriminant is rounding.
    fn inside_one_half(&self) -> (f64, f64) {
        let [t0, t1] = self.roots_with(self.discriminant.max(0.0));
        match self.widening > 0.0 {
            true => (t0.max(t1), f64::INFINITY),
            false => (f64::NEG_INFINITY, t0.min(t1)),
        }
    }
}
