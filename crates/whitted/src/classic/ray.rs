//! One ray, prepared for the tests and for planes.

use crate::geometry::ShearedRay;
use crate::geometry::sphere::SphereRay;
use crate::math::{Aabb, Vec3d, Vec3f};
use crate::ray::Ray;
use crate::shading::one::{one, ones, value};
use crate::tree::{Fit, sound};
use simd::{MaskLanes, Scalar};

/// A ray in the scaled coordinates of objects and trees.
pub(super) struct CastRay {
    pub(super) origin: Vec3f,
    pub(super) direction: Vec3f,
    pub(super) t_min: f32,
    pub(super) t_max: f32,
    pub(super) sheared: ShearedRay,
    pub(super) sphere: SphereRay,
    /// As the caller gave it: shapes and planes are not scaled.
    pub(super) origin_f64: Vec3d,
    pub(super) direction_f64: Vec3d,
}

impl CastRay {
    #[inline(always)]
    pub(super) fn new(ray: &Ray, scale: f32, wants_shear: bool) -> Self {
        let (origin, direction) = (ray.origin * scale, ray.direction * scale);
        Self {
            origin,
            direction,
            t_min: ray.t_min,
            t_max: ray.t_max,
            sheared: if wants_shear { ShearedRay::new(origin, direction) } else { ShearedRay::default() },
            sphere: SphereRay::new(origin, direction),
            origin_f64: ray.origin.to_f64(),
            direction_f64: ray.direction.to_f64(),
        }
    }

    /// Whether it can hit anything at all: the same rays as in production.
    #[inline(always)]
    pub(super) fn is_sound(&self) -> bool {
        sound(Scalar, ones(self.origin), ones(self.direction)).any()
    }

    /// The largest coordinate of the origin.
    pub(super) fn distance(&self) -> f32 {
        self.origin.abs().max_component()
    }
}

/// A ray prepared for planes across the axes.
///
/// A reciprocal is infinite for a component that is zero or too small. Then a plane is met at ±∞, which puts the ray
/// wholly on one side, or, starting in the plane itself, at NaN: every comparison below is written so that a NaN keeps
/// both sides.
pub(super) struct PlaneRay {
    pub(super) origin: Vec3f,
    pub(super) inverse: Vec3f,
    /// How far each cell reaches beyond its planes for this ray, with the sign of the direction; see [`Fit::slack`].
    slack: Vec3f,
}

/// How a ray meets a plane.
pub(super) struct Meeting {
    /// Whether the ray comes from above: the half above the plane is the near one.
    pub(super) from_above: bool,
    /// Where it leaves the near half.
    pub(super) leaves_near: f32,
    /// Where it enters the far half.
    pub(super) enters_far: f32,
}

impl PlaneRay {
    #[inline(always)]
    pub(super) fn new(ray: &CastRay, fit: &Fit) -> Self {
        let slack = value(fit.slack(Scalar, one(ray.distance())));
        let inverse = ray.direction.map(|d| 1.0 / d);
        let signed = |d: f32, inverse: f32| {
            // So slow that the reciprocal overflows, yet not still: it may cross any plane.
            let slack = if d != 0.0 && inverse.is_infinite() { f32::INFINITY } else { slack };
            slack.copysign(inverse)
        };
        Self { origin: ray.origin, inverse, slack: ray.direction.zip(inverse, signed) }
    }

    /// Whether cells are just their planes, so that the ray is in one at a time.
    #[inline(always)]
    pub(super) fn is_exact(&self) -> bool {
        self.slack == Vec3f::ZERO
    }

    #[inline(always)]
    pub(super) fn meet(&self, axis: usize, plane: f32) -> Meeting {
        let (away, slack, inverse) = (plane - self.origin[axis], self.slack[axis], self.inverse[axis]);
        Meeting {
            from_above: inverse.is_sign_negative(),
            leaves_near: (away + slack) * inverse,
            enters_far: (away - slack) * inverse,
        }
    }

    /// The part of the range in which the ray is in a box; `None` if there is none.
    #[inline(always)]
    pub(super) fn clip(&self, bounds: &Aabb, [mut start, mut end]: [f32; 2]) -> Option<[f32; 2]> {
        for axis in 0..3 {
            let (lo, hi) = (self.meet(axis, bounds.lo[axis]), self.meet(axis, bounds.hi[axis]));
            let (first, last) = if lo.from_above { (hi, lo) } else { (lo, hi) };
            start = later(start, first.enters_far);
            end = earlier(end, last.leaves_near);
        }
        (start <= end).then_some([start, end])
    }
}

/// The larger one; `a` if `b` is NaN.
#[inline(always)]
pub(super) fn later(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// The smaller one; `a` if `b` is NaN.
#[inline(always)]
pub(super) fn earlier(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}
