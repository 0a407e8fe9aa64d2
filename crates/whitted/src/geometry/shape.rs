//! The bounded primitives that are neither triangle nor sphere, in one closed list.

use super::{Boxed, Cone, Cylinder, Disc, ShapePoint, SurfacePoint};
use crate::math::{Aabb, Vec3d};
use crate::ray::Ray;

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

/// `$body` with `$shape` bound to the shape inside `$self`.
macro_rules! each_shape {
    ($self:expr, $shape:ident => $body:expr) => {
        match $self {
            Shape::Disc($shape) => $body,
            Shape::Boxed($shape) => $body,
            Shape::Cylinder($shape) => $body,
            Shape::Cone($shape) => $body,
        }
    };
}

impl Shape {
    /// The word for its kind.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Disc(_) => "disc",
            Self::Boxed(_) => "box",
            Self::Cylinder(_) => "cylinder",
            Self::Cone(_) => "cone",
        }
    }

    /// The parameters of all points at which the infinite line `origin + t · direction` crosses the surface.
    ///
    /// The direction need not be normalised. A degenerate shape, a zero direction or a NaN gives no crossing.
    pub fn crossings(&self, origin: Vec3d, direction: Vec3d) -> Crossings {
        each_shape!(self, shape => shape.crossings(origin, direction))
    }

    /// The tightest box, rounded outward to `f32`; meaningless for a degenerate shape.
    pub fn bounds(&self) -> Aabb {
        each_shape!(self, shape => shape.bounds())
    }

    /// A box around the part of the surface that lies in `clip`; empty if that is known to be none.
    pub fn clipped_bounds(&self, clip: &Aabb) -> Aabb {
        match self {
            Self::Boxed(shape) if shape.surrounds(clip) => Aabb::EMPTY,
            _ => self.bounds().intersection(*clip),
        }
    }

    /// The point of the surface nearest to `near`, which must lie on it but for rounding.
    pub fn surface(&self, near: Vec3d) -> ShapePoint {
        each_shape!(self, shape => shape.surface(near))
    }

    /// The surface where `ray` crosses it at `t`.
    ///
    /// The rounding of `t` moves points along the ray by 2⁻²⁴ of their distance; they are put back onto the surface.
    pub fn surface_point(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let extent = f64::from(self.bounds().size().max_component());
        self.surface(point_at(ray, t)).rounded(extent)
    }

    /// True if the shape has no area, a number in it is not finite, or it does not fit into `f32`: such a shape is
    /// never hit, and its other methods return nothing useful.
    pub fn is_degenerate(&self) -> bool {
        let bounds = self.bounds();
        let fits = bounds.lo.is_finite() && bounds.hi.is_finite();
        !fits || !each_shape!(self, shape => shape.has_area())
    }
}

/// The point of `ray` at `t` in double precision.
pub(super) fn point_at(ray: &Ray, t: f32) -> Vec3d {
    ray.origin.to_f64() + ray.direction.to_f64() * f64::from(t)
}

/// The smallest box of `f32` around the box from `lo` to `hi`; with an infinite or NaN corner if it does not fit.
pub(super) fn round_outward(lo: Vec3d, hi: Vec3d) -> Aabb {
    let down = |a: f64| if f64::from(a as f32) > a { (a as f32).next_down() } else { a as f32 };
    Aabb::new(lo.map(down), hi.map(|a| -down(-a)))
}

/// How far a disc of radius 1 with this unit normal reaches along each axis.
pub(super) fn disc_reach(normal: Vec3d) -> Vec3d {
    let n = normal.times(normal);
    Vec3d::new(n.y + n.z, n.z + n.x, n.x + n.y).map(f64::sqrt)
}

/// Two unit vectors perpendicular to the unit vector `axis` and to each other; with it they are right-handed.
pub(super) fn perpendicular_frame(axis: Vec3d) -> [Vec3d; 2] {
    let a = axis.abs();
    let least = if a.x <= a.y && a.x <= a.z {
        Vec3d::new(1.0, 0.0, 0.0)
    } else if a.y <= a.z {
        Vec3d::new(0.0, 1.0, 0.0)
    } else {
        Vec3d::new(0.0, 0.0, 1.0)
    };
    let first = least.cross(axis).normalize();
    [first, axis.cross(first)]
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

    /// The two ends of an interval; nothing if it is empty, NaN or reaches to infinity.
    pub fn interval(enter: f64, exit: f64) -> Self {
        match enter <= exit && enter.is_finite() && exit.is_finite() {
            true => Self { t: [enter, exit, 0.0, 0.0], len: 2 },
            false => Self::NONE,
        }
    }

    /// Insert `t` in order. NaN, infinities and anything beyond four crossings (no shape has more) are dropped.
    pub fn insert(&mut self, t: f64) {
        if !t.is_finite() || self.len == self.t.len() {
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
