//! The triangle: watertight against its neighbours, for any ray.
//!
//! # The test
//! Shear-space edge functions after Woop, Benthin and Wald ("Watertight Ray/Triangle Intersection", JCGT 2013): the
//! vertices are moved so that the ray starts at the origin, axes are renamed so that the ray runs mostly along z, and
//! space is sheared so that it runs exactly along z. Then the ray hits the triangle where the origin lies inside the
//! triangle's projection.
//!
//! # Where it differs from the paper
//! The paper decides in `f32` and turns to `f64` where an edge function rounds to zero. Here every edge function has
//! the *exact sign*: `a·b − c·d` is computed with two fused multiply-adds (Kahan; Jeannerod, Louvet, Muller 2013 bound
//! its error by two units of roundoff, so a wrong sign is impossible short of underflow). That costs one operation per
//! edge more than the plain form, needs no second precision and no branch, and makes the three weights, hence t, good
//! to a few ulp however thin the triangle: t cannot leave the box of the triangle by more than the tree's padding.
//!
//! # Contract
//! * The sheared position of a vertex depends on ray and vertex only, so two triangles that share an edge see the same
//!   edge, and a ray passes one of them or both (edges belong to both), never none.
//! * A hit needs `t_min ≤ t ≤ t_max`. A triangle whose projection has no area is missed.
//! * NaN anywhere is a miss.

use super::splat;
use crate::math::{Vec3d, Vec3f};
use simd::F32Lanes;

/// A bound on the relative error of the sheared coordinates and of t, in units of 2⁻²⁴.
///
/// Shear: subtraction, product and fused subtraction, twice the divided shear: 4. Distance: weights 2 each, three
/// fused sums 3, area 4, scale and quotient 3: 12. Slabs of the enclosing boxes: 3.
pub(crate) const ERROR_ULPS: f32 = 19.0;

/// Three vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The vertices in order.
    pub vertices: [Vec3f; 3],
}

/// A ray prepared for triangles: axes renamed so that `|direction|` is largest along the last, and the shear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct ShearedRay {
    /// Origin in renamed axes.
    pub origin: [f32; 3],
    /// `d.x / d.z`, `d.y / d.z` and `1 / d.z` in renamed axes.
    pub shear: [f32; 3],
    /// The axis that became z: 0, 1 or 2; z took its place.
    pub axis: u32,
    padding: u32,
}

impl ShearedRay {
    /// A ray that was prepared elsewhere by the same formulas.
    #[inline(always)]
    pub(crate) fn from_parts(origin: [f32; 3], shear: [f32; 3], axis: u32) -> Self {
        Self { origin, shear, axis, padding: 0 }
    }

    /// Prepare a ray.
    #[inline(always)]
    pub fn new(origin: Vec3f, direction: Vec3f) -> Self {
        let axis = dominant_axis(direction);
        let [x, y, z] = renamed(axis);
        let dz = direction[z];
        Self {
            origin: [origin[x], origin[y], origin[z]],
            shear: [direction[x] / dz, direction[y] / dz, 1.0 / dz],
            axis: axis as u32,
            padding: 0,
        }
    }
}

/// The axis of the largest absolute component; ties go to x, then y.
#[inline(always)]
pub(crate) fn dominant_axis(direction: Vec3f) -> usize {
    let a = direction.abs();
    let y_over_x = usize::from(a.y > a.x);
    if a.z > a.x.max(a.y) { 2 } else { y_over_x }
}

/// The axes that become x, y and z when `axis` becomes z: it changes places with z, so that lanes that differ in it have
/// less to choose from than if all three moved on. Left becomes right, which no test here asks about.
#[inline(always)]
pub(crate) const fn renamed(axis: usize) -> [usize; 3] {
    match axis {
        0 => [2, 1, 0],
        1 => [0, 2, 1],
        _ => [0, 1, 2],
    }
}

/// `a·b − c·d` with the exact sign.
#[inline(always)]
fn difference_of_products<F: F32Lanes>(a: F, b: F, c: F, d: F) -> F {
    let cd = c * d;
    let error = (-c).fma(d, cd);
    a.fma(b, -cd) + error
}

/// A vertex as seen from the ray: moved to the origin and sheared along its direction.
#[inline(always)]
pub(super) fn sheared<F: F32Lanes>(vertex: [F; 3], origin: [F; 3], shear: [F; 3]) -> [F; 3] {
    let z = vertex[2] - origin[2];
    [(-shear[0]).fma(z, vertex[0] - origin[0]), (-shear[1]).fma(z, vertex[1] - origin[1]), z]
}

/// Rays prepared for triangles, one per lane, or one ray in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct ShearedRays<F> {
    /// See [`ShearedRay::origin`].
    pub origin: [F; 3],
    /// See [`ShearedRay::shear`].
    pub shear: [F; 3],
}

impl<F: F32Lanes> ShearedRays<F> {
    /// The same ray in all lanes.
    #[inline(always)]
    pub(crate) fn splat(token: F::Token, ray: &ShearedRay) -> Self {
        Self { origin: splat(token, ray.origin), shear: splat(token, ray.shear) }
    }
}

/// Intersect a ray with a triangle in each lane; return the hit lanes' mask and t.
///
/// `vertices[i][axis]` are the renamed coordinates of vertex `i`. Lanes hit where `t_min ≤ t ≤ t_max`.
#[inline(always)]
pub(crate) fn intersect<F: F32Lanes>(
    token: F::Token,
    rays: &ShearedRays<F>,
    vertices: [[F; 3]; 3],
    t_min: F,
    t_max: F,
) -> (F::Mask, F) {
    let ShearedRays { origin, shear } = *rays;
    // Move and shear the vertices.
    let a = sheared(vertices[0], origin, shear);
    let b = sheared(vertices[1], origin, shear);
    let c = sheared(vertices[2], origin, shear);
    // Weigh each vertex by the area opposite to it.
    let u = difference_of_products(c[0], b[1], c[1], b[0]);
    let v = difference_of_products(a[0], c[1], a[1], c[0]);
    let w = difference_of_products(b[0], a[1], b[1], a[0]);
    let zero = F::splat(token, 0.0);
    let inside = zero.le(u.min(v).min(w)) | u.max(v).max(w).le(zero);
    // Interpolate the distance. Without area this is 0/0, a NaN, and fails both comparisons.
    let area = u + v + w;
    let t = w.fma(c[2], v.fma(b[2], u * a[2])) * shear[2] / area;
    (inside & t_min.le(t) & t.le(t_max), t)
}

/// What the final hit reports: parameter and barycentric coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Refined {
    pub t: f32,
    pub u: f32,
    pub v: f32,
}

impl Triangle {
    /// Position and geometric unit normal at barycentric `u`, `v`; the normal of a triangle without area is +y.
    pub(crate) fn surface(&self, u: f32, v: f32) -> (Vec3f, Vec3f) {
        let [a, b, c] = self.vertices.map(Vec3f::to_f64);
        let (ab, ac) = (b - a, c - a);
        let position = a + ab * f64::from(u) + ac * f64::from(v);
        let normal = ab.cross(ac).normalize();
        let normal = if normal.is_finite() { normal } else { Vec3d::new(0.0, 1.0, 0.0) };
        (position.to_f32(), normal.to_f32())
    }

    /// The largest absolute coordinate difference between the vertices.
    pub(crate) fn extent(&self) -> f32 {
        let [a, b, c] = self.vertices;
        (a.max(b).max(c) - a.min(b).min(c)).max_component()
    }

    /// True if it cannot be intersected: a coordinate is not finite, or two vertices coincide.
    ///
    /// Thin and even zero-area triangles with three distinct vertices are kept: they close T-junctions.
    pub(crate) fn is_degenerate(&self) -> bool {
        let [a, b, c] = self.vertices;
        !(a.is_finite() && b.is_finite() && c.is_finite()) || a == b || b == c || c == a
    }
}
