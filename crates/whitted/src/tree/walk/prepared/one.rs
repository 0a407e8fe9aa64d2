//! A single ray, prepared by itself: sixteen lanes and their transposition cost several times as much as one needs.
//!
//! The same formulas as for sixteen: the functions of lanes, with the axes as lanes where that pays.

use super::super::slabs::SlabRay;
use super::records::{offsets, reciprocal};
use super::{distance, sound};
use crate::geometry::sphere::SphereRay;
use crate::geometry::triangle::dominant_axis;
use crate::geometry::{Primitives, ShearedRay, splat};
use crate::math::{Vec3, Vec3f};
use crate::ray::Ray;
use crate::tree::Tree;
use simd::{F32Lanes, MaskLanes, Scalar, ScalarF32, Simd};

type One = ScalarF32<1>;

/// A ray in the forms that nodes and leaves want, by value.
pub(in crate::tree::walk) struct OneRay<S: Simd> {
    pub(in crate::tree::walk) slabs: SlabRay<S::F32x16>,
    /// Signs of the direction: bit a is set if component a is negative.
    pub(in crate::tree::walk) octant: usize,
    /// Only where there are triangles.
    pub(in crate::tree::walk) sheared: ShearedRay,
    /// Only where there are spheres.
    pub(in crate::tree::walk) sphere: SphereRay,
}

impl<S: Simd> OneRay<S> {
    /// Prepare a ray; none if it hits nothing.
    #[inline(always)]
    pub(in crate::tree::walk) fn new(token: S, tree: &Tree, primitives: &Primitives, ray: &Ray) -> Option<Self> {
        // Lanes first, then scaled: scaled by number, the ray is read in pieces that reach from one of the caller's stores
        // into the next, and have to wait for both (docs/decisions/0009).
        let scale = S::F32x4::splat(token, tree.scale());
        let (origin, direction) = (axes(token, ray.origin) * scale, axes(token, ray.direction) * scale);
        let (o, d) = (parts::<S>(origin), parts::<S>(direction));
        if !sound(Scalar, scalars(o), scalars(d)).any() {
            return None;
        }
        let inverse = reciprocal(token, direction);
        let slack = S::F32x4::splat(token, value(tree.slack(Scalar, distance(scalars(o)))));
        let (near, far) = offsets(origin, inverse, slack);
        let (mut sheared, mut sphere) = (ShearedRay::default(), SphereRay::default());
        if primitives.triangle_count() > 0 {
            sheared = sheared_ray(token, origin, direction, dominant_axis(d.into()));
        }
        if !primitives.spheres().is_empty() {
            sphere = SphereRay::new(o.into(), d.into());
        }
        Some(Self {
            slabs: SlabRay {
                inverse: splat(token, parts::<S>(inverse)),
                near: splat(token, parts::<S>(near)),
                far: splat(token, parts::<S>(far)),
                t_min: S::F32x16::splat(token, ray.t_min),
            },
            octant: (inverse.lt(S::F32x4::splat(token, 0.0)).bits() & 7) as usize,
            sheared,
            sphere,
        })
    }
}

/// The twin of [`ShearedRay::new`], without a branch.
#[inline(always)]
fn sheared_ray<S: Simd>(token: S, origin: S::F32x4, direction: S::F32x4, axis: usize) -> ShearedRay {
    let (o, d) = (renamed(token, axis, origin), renamed(token, axis, direction));
    let [.., dz] = parts::<S>(d);
    let only_z = <S::F32x4 as F32Lanes>::Mask::from_bits(token, 1 << 2);
    let numerator = S::F32x4::select(only_z, S::F32x4::splat(token, 1.0), d);
    ShearedRay::from_parts(parts::<S>(o), parts::<S>(numerator / S::F32x4::splat(token, dz)), axis as u32)
}

/// The components with that of `axis` and the last in each other's place, as [`renamed`](crate::geometry::triangle::renamed).
#[inline(always)]
fn renamed<S: Simd>(token: S, axis: usize, v: S::F32x4) -> S::F32x4 {
    // The lanes that take their component from yzx, and from zxy.
    const ONCE: [u32; 3] = [0b100, 0b010, 0];
    const TWICE: [u32; 3] = [0b001, 0b100, 0];
    let turned = token.yzx(v);
    let [once, twice] = [ONCE, TWICE].map(|lanes| <S::F32x4 as F32Lanes>::Mask::from_bits(token, lanes[axis % 3]));
    S::F32x4::select(once, turned, S::F32x4::select(twice, token.yzx(turned), v))
}

#[inline(always)]
fn axes<S: Simd>(token: S, v: Vec3f) -> S::F32x4 {
    S::F32x4::load(token, &[v.x, v.y, v.z, 1.0])
}

#[inline(always)]
fn parts<S: Simd>(v: S::F32x4) -> [f32; 3] {
    let mut lanes = [0.0; 4];
    v.store(&mut lanes);
    [lanes[0], lanes[1], lanes[2]]
}

#[inline(always)]
fn scalars([x, y, z]: [f32; 3]) -> Vec3<One> {
    Vec3::new(One::splat(Scalar, x), One::splat(Scalar, y), One::splat(Scalar, z))
}

#[inline(always)]
fn value(lane: One) -> f32 {
    let mut out = [0.0];
    lane.store(&mut out);
    out[0]
}
