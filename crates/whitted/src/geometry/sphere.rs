//! The sphere.
//!
//! The line's nearest point to the centre is found first and the discriminant from its distance (Hearn and Baker;
//! Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems 2019, chapter 7): no
//! cancellation, however far away the ray starts. From inside, the far root is the hit. The paper (§2.2.2) calls an
//! origin inside "terminate", which would make refraction impossible, and prints its equation with sign errors.

use super::splat;
use crate::math::{Vec3, Vec3f};
use crate::ray::Ray;
use simd::F32Lanes;

/// A sphere; its surface is hit from outside and from inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The middle.
    pub center: Vec3f,
    /// Radius, > 0.
    pub radius: f32,
}

/// A ray prepared for spheres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct SphereRay {
    /// Origin.
    pub origin: [f32; 3],
    /// Direction.
    pub direction: [f32; 3],
    /// `1 / (direction · direction)`.
    pub inverse_length_squared: f32,
    padding: f32,
}

impl SphereRay {
    /// A ray that was prepared elsewhere by the same formulas.
    #[inline(always)]
    pub(crate) fn from_parts(origin: [f32; 3], direction: [f32; 3], inverse_length_squared: f32) -> Self {
        Self { origin, direction, inverse_length_squared, padding: 0.0 }
    }

    /// Prepare a ray.
    pub(crate) fn new(origin: Vec3f, direction: Vec3f) -> Self {
        Self {
            origin: origin.to_array(),
            direction: direction.to_array(),
            inverse_length_squared: 1.0 / direction.length_squared(),
            padding: 0.0,
        }
    }
}

/// Rays prepared for spheres, one per lane, or one ray in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct SphereRays<F> {
    /// See [`SphereRay::origin`].
    pub origin: [F; 3],
    /// See [`SphereRay::direction`].
    pub direction: [F; 3],
    /// See [`SphereRay::inverse_length_squared`].
    pub inverse_length_squared: F,
}

impl<F: F32Lanes> SphereRays<F> {
    /// The same ray in all lanes.
    #[inline(always)]
    pub(crate) fn splat(token: F::Token, ray: &SphereRay) -> Self {
        Self {
            origin: splat(token, ray.origin),
            direction: splat(token, ray.direction),
            inverse_length_squared: F::splat(token, ray.inverse_length_squared),
        }
    }
}

/// Intersect a line with a sphere in each lane; return the parameters where it enters and leaves.
///
/// Both are NaN where the line passes by, or anything is NaN.
#[inline(always)]
pub(crate) fn roots<F: F32Lanes>(rays: &SphereRays<F>, center: [F; 3], radius_squared: F) -> (F, F) {
    let direction = Vec3::from(rays.direction);
    let inverse = rays.inverse_length_squared;
    let from_center = Vec3::from(rays.origin) - Vec3::from(center);
    // Walk to the point of the line that is nearest to the centre.
    let middle = -(from_center.dot(direction)) * inverse;
    let nearest = from_center + direction * middle;
    // A line that passes by gives the root of a negative number.
    let half_chord = ((radius_squared - nearest.dot(nearest)) * inverse).sqrt();
    (middle - half_chord, middle + half_chord)
}

/// The first of two roots within a range: a mask of the lanes that have one, and which.
///
/// That is the near root, or the far one if the near one lies before `t_min`.
#[inline(always)]
pub(crate) fn first_in_range<F: F32Lanes>((near, far): (F, F), t_min: F, t_max: F) -> (F::Mask, F) {
    let t = F::select(t_min.le(near), near, far);
    (t_min.le(t) & t.le(t_max), t)
}

impl Sphere {
    /// Position and outward unit normal where a ray hits at `t`.
    pub(crate) fn surface(&self, ray: &Ray, t: f32) -> (Vec3f, Vec3f) {
        let center = self.center.to_f64();
        let normal = (ray.origin.to_f64() + ray.direction.to_f64() * f64::from(t) - center).normalize();
        ((center + normal * f64::from(self.radius)).to_f32(), normal.to_f32())
    }

    /// True if it cannot be intersected: not finite, or the radius is not positive.
    pub(crate) fn is_degenerate(&self) -> bool {
        !(self.center.is_finite() && self.radius.is_finite() && self.radius > 0.0)
    }
}
