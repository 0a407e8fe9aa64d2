//! Lights: which way, how far and how bright a light is at a point.

use super::one::{One, ones, value, values};
use crate::math::{Vec3, Vec3d, Vec3f, sin_cos_degrees};
use simd::{F32Lanes, Scalar};

/// A light, ready for points of internal space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreparedLight {
    place: Place,
    cone: Option<Cone>,
    color: Vec3f,
    inverse_square: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// At this point.
    At(Vec3f),
    /// Infinitely far in this direction, a unit vector.
    Towards(Vec3f),
}

/// The cone of a spot light.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cone {
    /// Unit vector from the light along the middle.
    axis: Vec3f,
    /// Cosine of the angle beyond which there is no light.
    cos_outer: f32,
    /// One divided by how much larger the cosine is where the light is full.
    slope: f32,
}

/// What arrives from a light at a point if nothing is in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arriving<T = f32> {
    /// Unit direction to the light; zero at the light itself.
    pub direction: Vec3<T>,
    /// Distance of the light; infinite for directional lights.
    pub distance: T,
    /// Colour times intensity; zero outside a cone and at the light itself.
    pub light: Vec3<T>,
}

impl PreparedLight {
    /// A light at `position`. If `inverse_square`, `color` is what arrives at distance 1, else everywhere.
    pub fn point(position: Vec3f, color: Vec3f, inverse_square: bool) -> Self {
        Self { place: Place::At(position), cone: None, color, inverse_square }
    }

    /// A light that travels along `direction`, which need not be normalised, from infinitely far.
    pub fn directional(direction: Vec3d, color: Vec3f) -> Self {
        Self { place: Place::Towards((-direction).normalize().to_f32()), cone: None, color, inverse_square: false }
    }

    /// This light within a cone around `axis`, which need not be normalised: full within the half angle `inner`, none
    /// beyond `outer` (degrees, 0 to 180, `inner` ≤ `outer`), between them smooth in the cosine.
    pub fn within_cone(self, axis: Vec3d, inner: f64, outer: f64) -> Self {
        let (cos_inner, cos_outer) = (sin_cos_degrees(inner).1, sin_cos_degrees(outer).1);
        // A sharp edge is a very steep one: no infinity, whose product with zero would be NaN.
        let slope = (1.0 / (cos_inner - cos_outer)).min(f64::from(f32::MAX)) as f32;
        let cone = Cone { axis: axis.normalize().to_f32(), cos_outer: cos_outer as f32, slope };
        Self { cone: Some(cone), ..self }
    }

    /// Where the light is; `None` if it is infinitely far.
    pub fn position(&self) -> Option<Vec3f> {
        match self.place {
            Place::At(position) => Some(position),
            Place::Towards(_) => None,
        }
    }

    /// What arrives at `position`.
    pub fn at(&self, position: Vec3f) -> Arriving {
        let Arriving { direction, distance, light } = self.at_lanes::<One>(Scalar, ones(position));
        Arriving { direction: values(direction), distance: value(distance), light: values(light) }
    }

    /// What arrives at many points.
    #[inline(always)]
    pub fn at_lanes<L: F32Lanes>(&self, token: L::Token, position: Vec3<L>) -> Arriving<L> {
        let splat = |value| L::splat(token, value);
        let color = self.color.map(splat);
        let from = match self.place {
            Place::At(from) => from,
            Place::Towards(direction) => {
                return Arriving { direction: direction.map(splat), distance: splat(f32::INFINITY), light: color };
            }
        };
        let to_light = from.map(splat) - position;
        let distance_squared = to_light.length_squared();
        let distance = distance_squared.sqrt();
        let apart = distance.gt(splat(0.0));
        let or_zero = |a: L| L::select(apart, a, splat(0.0));
        let direction = (to_light / distance).map(or_zero);
        let mut light = color.map(or_zero);
        if self.inverse_square {
            light = (light / distance_squared).map(or_zero);
        }
        if let Some(cone) = &self.cone {
            light *= cone.share(token, direction);
        }
        Arriving { direction, distance, light }
    }
}

impl Cone {
    /// The part of the light that goes towards points from which the light lies in `to_light`: Hermite's cubic between
    /// the two cosines, without a kink at either end.
    #[inline(always)]
    fn share<L: F32Lanes>(&self, token: L::Token, to_light: Vec3<L>) -> L {
        let splat = |value| L::splat(token, value);
        let cosine = -to_light.dot(self.axis.map(splat));
        let s = ((cosine - splat(self.cos_outer)) * splat(self.slope)).max(splat(0.0)).min(splat(1.0));
        s * s * (splat(3.0) - splat(2.0) * s)
    }
}
