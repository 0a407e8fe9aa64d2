//! From the user's coordinates to those in which rays are traced.

use crate::geometry::{Boxed, Cone, Cylinder, Disc, Plane, Shape, Sphere};
use crate::math::{Vec3d, Vec3f};

/// The map `p ↦ (p − center) · scale` from world space to the internal space of a prepared scene.
///
/// Single precision is spent on the extent of the scene, not on its distance from the origin or its unit: a scene far
/// from the origin is moved to it, one in tiny or huge units is scaled by a power of two. Every ordinary scene gets
/// the identity, so that coordinates which `f32` holds exactly stay exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Space {
    center: Vec3d,
    scale: f64,
}

/// A centre farther from the origin than this many extents is moved to the origin: nearer ones cost at most 6 of the
/// 24 bits of single precision.
const FAR: f64 = 64.0;

/// Extents within 2^±`ORDINARY` are not scaled: products of four lengths stay far from the ends of the exponent range.
const ORDINARY: i32 = 16;

impl Space {
    /// Internal space = world space.
    pub const IDENTITY: Self = Self { center: Vec3d::ZERO, scale: 1.0 };

    /// The space for a scene between the corners `lo` and `hi`; the identity if the box is empty or not finite.
    pub fn around(lo: Vec3d, hi: Vec3d) -> Self {
        let extent = (hi - lo).max_component();
        let middle = lo * 0.5 + hi * 0.5;
        if !(extent >= 0.0 && extent.is_finite() && middle.is_finite()) {
            return Self::IDENTITY;
        }
        let moved = middle.abs().max_component() > FAR * extent;
        // A single point has no extent: its distance from the origin is the only length there is.
        let extent = if extent > 0.0 { extent } else { middle.abs().max_component() };
        if extent == 0.0 {
            return Self::IDENTITY;
        }
        let exponent = exponent(extent);
        let unit = power_of_two(exponent);
        // Rounded to multiples of the unit: differences from the centre are then exact, and short decimals stay short.
        let center = if moved { middle.map(|a| (a / unit).round_ties_even() * unit) } else { Vec3d::ZERO };
        let scale = if exponent.abs() > ORDINARY { power_of_two(-exponent) } else { 1.0 };
        Self { center, scale }
    }

    /// Internal lengths per world length: a power of two.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The internal place of the world's origin.
    pub fn origin(&self) -> Vec3d {
        self.point(Vec3d::ZERO)
    }

    /// The internal place of a world point, in double precision.
    pub fn point(&self, p: Vec3d) -> Vec3d {
        (p - self.center) * self.scale
    }

    /// The world point at an internal place.
    pub fn world(&self, p: Vec3d) -> Vec3d {
        p / self.scale + self.center
    }

    /// The internal place of a world point.
    pub fn point_f32(&self, p: Vec3d) -> Vec3f {
        self.point(p).to_f32()
    }

    /// The internal sphere; a negative radius counts by its size.
    pub fn sphere(&self, center: Vec3d, radius: f64) -> Sphere {
        Sphere { center: self.point_f32(center), radius: (radius.abs() * self.scale) as f32 }
    }

    /// The internal plane.
    pub fn plane(&self, plane: &Plane) -> Plane {
        Plane { point: self.point(plane.point), ..*plane }
    }

    /// The internal shape.
    pub fn shape(&self, shape: &Shape) -> Shape {
        let (point, length) = (|p| self.point(p), |a: f64| a * self.scale);
        match *shape {
            Shape::Disc(disc) => Shape::Disc(Disc {
                center: point(disc.center),
                radius: length(disc.radius),
                inner_radius: length(disc.inner_radius),
                ..disc
            }),
            Shape::Boxed(boxed) => Shape::Boxed(Boxed { lo: point(boxed.lo), hi: point(boxed.hi) }),
            Shape::Cylinder(tube) => Shape::Cylinder(Cylinder {
                base: point(tube.base),
                apex: point(tube.apex),
                radius: length(tube.radius),
                ..tube
            }),
            Shape::Cone(cone) => Shape::Cone(Cone {
                base: point(cone.base),
                apex: point(cone.apex),
                base_radius: length(cone.base_radius),
                apex_radius: length(cone.apex_radius),
                ..cone
            }),
        }
    }
}

/// `⌊log₂ a⌋` for a normal positive `a`; subnormal ones count as the smallest normal number.
fn exponent(a: f64) -> i32 {
    const MANTISSA_BITS: u32 = f64::MANTISSA_DIGITS - 1;
    const BIAS: i32 = f64::MAX_EXP - 1;
    ((a.to_bits() >> MANTISSA_BITS) as i32).max(1) - BIAS
}

/// 2 to the power `exponent`, which is kept within the normal range.
fn power_of_two(exponent: i32) -> f64 {
    const BIAS: i32 = f64::MAX_EXP - 1;
    f64::from_bits(((exponent.clamp(1 - BIAS, BIAS) + BIAS) as u64) << (f64::MANTISSA_DIGITS - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_scenes_are_not_touched() {
        for extent in [0.01, 1.0, 17.0, 1000.0] {
            let space = Space::around(Vec3d::splat(-extent), Vec3d::new(extent, 0.0, 40.0 * extent));
            assert_eq!(space, Space::IDENTITY);
        }
    }

    #[test]
    fn far_scenes_are_moved_by_whole_units() {
        let space = Space::around(Vec3d::new(9997.0, 9999.0, 9997.0), Vec3d::new(10003.0, 10001.0, 10005.0));
        assert_eq!(space.scale(), 1.0);
        assert_eq!(space.point(Vec3d::splat(10000.0)).map(f64::fract), Vec3d::ZERO);
        assert!(space.point(Vec3d::splat(10000.0)).abs().max_component() <= 8.0);
    }

    #[test]
    fn any_unit_becomes_an_ordinary_one() {
        for extent in [1e-300, 5e-6, 1e12, 1e300] {
            let space = Space::around(Vec3d::ZERO, Vec3d::splat(extent));
            let inside = extent * space.scale();
            assert!((1.0..2.0).contains(&inside), "{extent} became {inside}");
        }
    }

    #[test]
    fn impossible_boxes_change_nothing() {
        let inf = f64::INFINITY;
        for (lo, hi) in [(inf, -inf), (f64::NAN, 1.0), (-inf, inf), (0.0, 0.0)] {
            assert_eq!(Space::around(Vec3d::splat(lo), Vec3d::splat(hi)), Space::IDENTITY, "{lo} {hi}");
        }
    }
}
