//! The light that a surface sends to the viewer when a light shines on it.

use super::SpecularModel;
use crate::math::{Vec3, Vec3f};
use simd::F32Lanes;

/// The parameters of the local model: the same for all lanes.
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

/// The factor by which light arriving from `to_light` reaches `view`: diffuse · `color` · cosine + highlight.
///
/// All directions are unit vectors that point away from the surface; `normal` is on the side of the viewer. 0 where the
/// light is behind the surface or a direction is NaN.
#[inline(always)]
pub fn answer<L: F32Lanes>(
    token: L::Token,
    model: &LocalModel,
    color: Vec3<L>,
    normal: Vec3<L>,
    to_light: Vec3<L>,
    view: Vec3<L>,
) -> Vec3<L> {
    let splat = |value| L::splat(token, value);
    let cos_light = normal.dot(to_light);
    let mut answer = color * (splat(model.diffuse) * cos_light);
    if model.specular != Vec3f::ZERO {
        let cosine = match model.specular_model {
            SpecularModel::Phong => (normal * (splat(2.0) * cos_light) - to_light).dot(view),
            SpecularModel::Blinn => {
                let half = to_light + view;
                normal.dot(half) / half.length_squared().sqrt()
            }
        };
        answer += model.specular.map(splat) * highlight(token, cosine, model.exponent);
    }
    let zero = splat(0.0);
    answer.map(|a| L::select(cos_light.gt(zero), a, zero))
}

/// `cosine` to the power `exponent`; 0 for cosines that are not positive or NaN, and never above 1.
#[inline(always)]
fn highlight<L: F32Lanes>(token: L::Token, cosine: L, exponent: f32) -> L {
    let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
    let power = simd::math::lanes::pow(token, cosine.max(zero).min(one), L::splat(token, exponent));
    L::select(cosine.gt(zero), power, zero)
}
