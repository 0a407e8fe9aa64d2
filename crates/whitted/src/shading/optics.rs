//! Mirrors and transparent surfaces: directions and shares of light.
//!
//! Conventions: directions and normals are unit vectors, `incident` travels towards the surface, `normal` is on the
//! side from which it comes, `cos_i` = −incident · normal ≥ 0, and `eta` is the index of refraction on that side
//! divided by the one beyond. Results for other input are unspecified; NaN in gives NaN out or total reflection.

use crate::math::Vec3;
use simd::F32Lanes;

/// The mirrored direction; a unit vector to a few ulp.
#[inline(always)]
pub fn mirrored<L: F32Lanes>(token: L::Token, incident: Vec3<L>, normal: Vec3<L>) -> Vec3<L> {
    incident - normal * (L::splat(token, 2.0) * incident.dot(normal))
}

/// The refracted direction by Snell's law, a unit vector to a few ulp, and the lanes where there is one: elsewhere
/// light is totally reflected and the direction is unspecified.
#[inline(always)]
pub fn refracted<L: F32Lanes>(token: L::Token, incident: Vec3<L>, normal: Vec3<L>, eta: L) -> (Vec3<L>, L::Mask) {
    let cos_i = -incident.dot(normal);
    let cos_t_squared = cos_t_squared(token, cos_i, eta);
    let refracts = cos_t_squared.ge(L::splat(token, 0.0));
    (incident * eta + normal * (eta * cos_i - cos_t_squared.sqrt()), refracts)
}

/// The fraction of unpolarised light that a smooth boundary of two dielectrics reflects (Fresnel 1823), 0 to 1; 1
/// where reflection is total.
#[inline(always)]
pub fn fresnel<L: F32Lanes>(token: L::Token, cos_i: L, eta: L) -> L {
    let splat = |value| L::splat(token, value);
    let squared = cos_t_squared(token, cos_i, eta);
    let cos_t = squared.sqrt();
    // Equal media at exactly 90° would divide zero by zero; the least positive divisor makes it zero.
    let ratio = |a: L, b: L| (a - b) / (a + b).max(splat(f32::MIN_POSITIVE));
    let (s, p) = (ratio(eta * cos_i, cos_t), ratio(cos_i, eta * cos_t));
    L::select(squared.ge(splat(0.0)), splat(0.5) * (s * s + p * p), splat(1.0))
}

/// Schlick's approximation (1994) of [`fresnel`], with the cosine on the thinner side, so that it meets total
/// reflection without a jump; 1 where reflection is total.
#[inline(always)]
pub fn schlick<L: F32Lanes>(token: L::Token, cos_i: L, eta: L) -> L {
    let one = L::splat(token, 1.0);
    let squared = cos_t_squared(token, cos_i, eta);
    let thinner = L::select(eta.gt(one), squared.sqrt(), cos_i);
    let r = (one - eta) / (one + eta);
    let (r0, a) = (r * r, one - thinner);
    let a_squared = a * a;
    L::select(squared.ge(L::splat(token, 0.0)), r0 + (one - r0) * (a_squared * a_squared * a), one)
}

/// What is left of light after `distance` ≥ 0 in a medium that halves it so many times per length (Beer, Lambert); 1
/// where nothing is absorbed, even at infinity.
#[inline(always)]
pub(super) fn transmittance<L: F32Lanes>(token: L::Token, halvings: Vec3<L>, distance: L) -> Vec3<L> {
    Vec3::new(
        left_of_light(token, halvings.x, distance),
        left_of_light(token, halvings.y, distance),
        left_of_light(token, halvings.z, distance),
    )
}

#[inline(always)]
fn left_of_light<L: F32Lanes>(token: L::Token, halvings: L, distance: L) -> L {
    let left = simd::math::lanes::exp2(token, -halvings * distance);
    L::select(halvings.eq(L::splat(token, 0.0)), L::splat(token, 1.0), left)
}

/// The square of the cosine beyond the surface; negative where reflection is total.
#[inline(always)]
fn cos_t_squared<L: F32Lanes>(token: L::Token, cos_i: L, eta: L) -> L {
    let one = L::splat(token, 1.0);
    // (1 − cos)(1 + cos) keeps the digits of the sine near the normal, where 1 − cos² loses them.
    one - eta * eta * ((one - cos_i) * (one + cos_i))
}
