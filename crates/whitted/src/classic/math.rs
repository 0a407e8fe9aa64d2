//! The arithmetic of the tests: one component at a time, or the four of the paper's vector at once (§2.4).
//!
//! Only the sphere's test is made of vector operations. The watertight triangle test works on three vertices in two
//! dimensions, the projected one on two components: there is nothing for a vector of four to do.

use super::ray::CastRay;
use crate::geometry::sphere::{self, SphereRay, SphereRays};
use crate::shading::one::{One, one, value};
use simd::{Level, Scalar, Simd, Vec4};

/// How the vector operations of the tests are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Math {
    /// One component at a time.
    #[default]
    Scalar,
    /// Four at once. The operations are the same, in the same order: so are the bits.
    Vector(Level),
    /// As `Vector`, with square roots by the hardware's estimate of `1/√x`, refined by one Newton step: the parameter by
    /// which hits are ordered is off by some 2⁻²⁰ of the sphere's radius. What is reported is refined in double
    /// precision as ever, so only surfaces that near to each other can change places.
    Estimated(Level),
}

impl Math {
    /// The paper's: four components at once by SSE; one at a time where there is none.
    pub fn sse() -> Self {
        Level::by_name("sse4.2").map_or(Self::Scalar, Self::Vector)
    }

    /// As [`sse`](Self::sse), with estimated roots.
    pub fn rsqrt() -> Self {
        Level::by_name("sse4.2").map_or(Self::Scalar, Self::Estimated)
    }
}

/// Where lines meet spheres.
pub(super) trait Arithmetic: Copy {
    /// A ray in the registers of this arithmetic.
    type Ray;

    /// Take the ray into registers, once for all tests.
    fn ray(self, ray: &CastRay) -> Self::Ray;

    /// Where the line of the ray enters and leaves a sphere; NaN where it passes by.
    fn roots(self, ray: &Self::Ray, center: &[f32; 4], radius_squared: f32) -> [f32; 2];
}

/// One component at a time.
#[derive(Clone, Copy)]
pub(super) struct Plain;

impl Arithmetic for Plain {
    type Ray = SphereRays<One>;

    #[inline(always)]
    fn ray(self, ray: &CastRay) -> Self::Ray {
        SphereRays::splat(Scalar, &ray.sphere)
    }

    #[inline(always)]
    fn roots(self, ray: &Self::Ray, center: &[f32; 4], radius_squared: f32) -> [f32; 2] {
        let center = [one(center[0]), one(center[1]), one(center[2])];
        let (near, far) = sphere::roots(ray, center, one(radius_squared));
        [value(near), value(far)]
    }
}

/// Four components at once; `ESTIMATES` square roots or takes them.
#[derive(Clone, Copy)]
pub(super) struct Packed<S, const ESTIMATES: bool>(pub(super) S);

/// A ray in two vectors and a number.
pub(super) struct PackedRay<S: Simd> {
    origin: Vec4<S>,
    direction: Vec4<S>,
    inverse_length_squared: f32,
}

impl<S: Simd, const ESTIMATES: bool> Arithmetic for Packed<S, ESTIMATES> {
    type Ray = PackedRay<S>;

    /// From its numbers one by one: a load of four that were just written one by one waits until all have reached the
    /// cache (mix-10, naive by SSE: 0.072 s, without the wait 0.066 s).
    #[inline(always)]
    fn ray(self, ray: &CastRay) -> Self::Ray {
        let SphereRay { origin: [ox, oy, oz], direction: [dx, dy, dz], inverse_length_squared, .. } = ray.sphere;
        let (origin, direction) = (Vec4::new(self.0, [ox, oy, oz, 0.0]), Vec4::new(self.0, [dx, dy, dz, 0.0]));
        PackedRay { origin, direction, inverse_length_squared }
    }

    /// The steps of [`sphere::roots`].
    #[inline(always)]
    fn roots(self, ray: &Self::Ray, center: &[f32; 4], radius_squared: f32) -> [f32; 2] {
        let token = self.0;
        let &PackedRay { origin, direction, inverse_length_squared: inverse } = ray;
        let from_center = origin - Vec4::new(token, *center);
        let middle = -from_center.dot(direction) * inverse;
        let nearest = from_center + direction * middle;
        let square = (radius_squared - nearest.dot(nearest)) * inverse;
        let half_chord =
            if ESTIMATES { Vec4::new(token, [square; 4]).sqrt_approx().components()[0] } else { square.sqrt() };
        [middle - half_chord, middle + half_chord]
    }
}
