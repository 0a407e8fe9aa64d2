//! The light that a surface sends to the viewer when a light shines on it.

use super::SpecularModel;
use crate::math::{Vec3, Vec3f};
use simd::{F32Lanes, MaskLanes};

/// The parameters of the local model of one material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalModel {
    /// Strength of Lambert's reflection.
    pub diffuse: f32,
    /// Strength of the highlight.
    pub specular: Vec3f,
    /// Exponent of the highlight, ≥ 0.
    pub exponent: f32,
    /// Form of the highlight.
    pub specular_model: SpecularModel,
}

/// What [`answer`] needs to know of a surface, lane by lane; as single numbers with `T = f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalSurface<T> {
    /// Factor of Lambert's reflection: strength times colour.
    pub diffuse: Vec3<T>,
    /// Factor of the highlight.
    pub specular: Vec3<T>,
    /// Exponent of the highlight, ≥ 0.
    pub exponent: T,
    /// Form of the highlight: 1 for Blinn's, 0 for Phong's.
    pub is_blinn: T,
}

impl LocalModel {
    /// The surface of this material where its base colour is `color`.
    pub fn surface(&self, color: Vec3f) -> LocalSurface<f32> {
        LocalSurface {
            diffuse: color * self.diffuse,
            specular: self.specular,
            exponent: self.exponent,
            is_blinn: f32::from(self.specular_model == SpecularModel::Blinn),
        }
    }
}

impl<T: Copy> LocalSurface<T> {
    /// `f` of every number.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> LocalSurface<U> {
        LocalSurface {
            diffuse: self.diffuse.map(&mut f),
            specular: self.specular.map(&mut f),
            exponent: f(self.exponent),
            is_blinn: f(self.is_blinn),
        }
    }
}

/// The factor by which light arriving from `to_light` reaches `view`: diffuse · cosine + highlight.
///
/// All directions are unit vectors that point away from the surface; `normal` is on the side of the viewer. 0 where the
/// light is behind the surface or a direction is NaN.
#[inline(always)]
pub fn answer<L: F32Lanes>(
    token: L::Token,
    surface: &LocalSurface<L>,
    normal: Vec3<L>,
    to_light: Vec3<L>,
    view: Vec3<L>,
) -> Vec3<L> {
    let zero = L::splat(token, 0.0);
    let cos_light = normal.dot(to_light);
    let mut answer = surface.diffuse * cos_light;
    let brightest = surface.specular.x.max(surface.specular.y).max(surface.specular.z);
    // Most surfaces are matte, and a power costs more than all the rest.
    if brightest.gt(zero).any() {
        let cosine = highlight_cosine(token, surface.is_blinn, normal, cos_light, to_light, view);
        answer += surface.specular * power(token, cosine, surface.exponent);
    }
    answer.map(|a| L::select(cos_light.gt(zero), a, zero))
}

/// The cosine of which the highlight is a power.
#[inline(always)]
fn highlight_cosine<L: F32Lanes>(
    token: L::Token,
    is_blinn: L,
    normal: Vec3<L>,
    cos_light: L,
    to_light: Vec3<L>,
    view: Vec3<L>,
) -> L {
    let phong = (normal * (L::splat(token, 2.0) * cos_light) - to_light).dot(view);
    let is_blinn = is_blinn.gt(L::splat(token, 0.0));
    if !is_blinn.any() {
        return phong;
    }
    let half = to_light + view;
    L::select(is_blinn, normal.dot(half) / half.length_squared().sqrt(), phong)
}

/// `cosine` to the power `exponent`; 0 for cosines that are not positive or NaN, and never above 1.
#[inline(always)]
fn power<L: F32Lanes>(token: L::Token, cosine: L, exponent: L) -> L {
    let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
    let fraction = cosine.max(L::splat(token, f32::MIN_POSITIVE)).min(one);
    let power = simd::math::lanes::pow_of_fraction(token, fraction, exponent);
    L::select(cosine.gt(zero), power, zero)
}
