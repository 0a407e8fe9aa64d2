//! How a scene is fitted into the numbers of `f32`: by which factor, and how wrong they are then.

use crate::math::Aabb;
use simd::F32Lanes;

/// Boxes grow by this times the largest coordinate of the scene.
///
/// A candidate's t and its place in sheared space are wrong by at most 32·2⁻²⁴ of (largest coordinate of the scene +
/// that of the ray's origin): [`ERROR_ULPS`](crate::geometry::triangle::ERROR_ULPS) for triangles, and for spheres a
/// sum of the same kind with Euclidean instead of largest distances. This padding covers origins up to three times
/// the largest coordinate; rays from farther away carry the rest as a slack of their own ([`Fit::slack`]).
const PADDING: f32 = 128.0 / (1 << 24) as f32;

/// See [`PADDING`].
const ERROR: f32 = 32.0 / (1 << 24) as f32;

/// [`ERROR`], and the rounding of slopes and plane distances: eight operations of half an ulp on either side.
const PACKET_ERROR: f32 = 40.0 / (1 << 24) as f32;

/// The factor between the caller's coordinates and a tree's, and the margins that rounding makes necessary there.
///
/// It is a power of two so that the largest coordinate lies in [1, 2): products of three coordinates then neither
/// overflow nor lose bits, in whatever units the scene is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fit {
    scale: f32,
    max_coordinate: f32,
}

impl Fit {
    /// For a scene of these bounds.
    pub(crate) fn new(bounds: Aabb) -> Self {
        let scale = power_of_two_scale(bounds.max_abs());
        Self { scale, max_coordinate: bounds.max_abs() * scale }
    }

    /// The factor from the caller's coordinates to the tree's.
    #[inline(always)]
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// The largest coordinate, in the tree's coordinates.
    #[inline(always)]
    pub(crate) fn max_coordinate(&self) -> f32 {
        self.max_coordinate
    }

    /// How far outside a primitive a ray may find it, if the largest coordinate of its origin is `distance`.
    #[inline(always)]
    pub(crate) fn error(&self, distance: f32) -> f32 {
        ERROR * (distance + self.max_coordinate)
    }

    /// By how much boxes grow.
    pub(crate) fn padding(&self) -> f32 {
        PADDING * self.max_coordinate
    }

    /// How far outside its padded boxes a ray may find what they hold, if the largest coordinate of its origin is
    /// `distance` (in the tree's coordinates).
    #[inline(always)]
    pub(crate) fn slack<F: F32Lanes>(&self, token: F::Token, distance: F) -> F {
        let splat_error = F::splat(token, ERROR);
        let covered = F::splat(token, (PADDING - ERROR) * self.max_coordinate);
        (splat_error * distance - covered).max(F::splat(token, 0.0))
    }

    /// As [`slack`](Self::slack) for the planes around a packet, whose own slopes are rounded.
    pub(super) fn packet_slack(&self, distance: f32) -> f32 {
        (self.primitive_slack(distance) - PADDING * self.max_coordinate).max(0.0)
    }

    /// How far outside a primitive a packet's ray from `distance` away may find it.
    pub(super) fn primitive_slack(&self, distance: f32) -> f32 {
        PACKET_ERROR * (distance + self.max_coordinate)
    }
}

/// The power of two that brings `max` into [1, 2), kept far from the ends of the exponent range.
fn power_of_two_scale(max: f32) -> f32 {
    const EXPONENT_BIAS: i32 = 127;
    const MAX_SHIFT: i32 = 120;
    if !(max > 0.0 && max.is_finite()) {
        return 1.0;
    }
    let exponent = (max.max(f32::MIN_POSITIVE).to_bits() >> 23) as i32 - EXPONENT_BIAS;
    f32::from_bits(((EXPONENT_BIAS - exponent.clamp(-MAX_SHIFT, MAX_SHIFT)) as u32) << 23)
}
