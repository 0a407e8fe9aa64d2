//! The final t and surface coordinates of hits, in double precision.
//!
//! The walks order hits by an `f32` t that is good to a few ulp of the distance in the *sheared* triangle; what is
//! reported is the t of the triangle itself. Done once for each hit, eight at a time, and hits that are neighbours in the
//! batch together, so that rays need not be gathered; [`Triangle::refine`] and [`Sphere::refine`] are the scalar twins.

use super::surfaces::padded;
use super::triangle::Refined;
use super::{Primitives, Sphere, Triangle};
use crate::math::{Vec3, Vec3f};
use crate::ray::{HitsMut, NONE, Ray, Rays, lanes};
use simd::{F32Lanes, F64Lanes, Kernel, Level, MaskLanes, Simd, U32Lanes};
use std::ops::Range;

/// Hits in a step.
const STEP: usize = 8;

/// Give every hit in a range of a batch its t in double precision and its surface coordinates.
pub(crate) fn refine(
    level: Level,
    primitives: &Primitives,
    rays: Rays<'_>,
    hits: &mut HitsMut<'_>,
    range: Range<usize>,
) {
    simd::dispatch(level, Refine { primitives, rays, hits, range });
}

/// As [`refine`], one hit after the other in plain Rust.
pub(crate) fn refine_one_by_one(primitives: &Primitives, rays: Rays<'_>, hits: &mut HitsMut<'_>, range: Range<usize>) {
    for index in range {
        if hits.primitive[index] != NONE {
            let ray = rays.get(index);
            let Refined { t, u, v } = primitives.refine(&ray, hits.t[index], hits.primitive[index]);
            (hits.t[index], hits.u[index], hits.v[index]) = (t, u, v);
        }
    }
}

/// With more primitives than this, those that were hit are not in the nearer caches.
const MANY: usize = 1 << 17;

/// Ask the memory for the primitives of these hits.
#[inline(always)]
fn prefetch(primitives: &Primitives, found: &[u32]) {
    for &id in found {
        primitives.prefetch(id);
    }
}

struct Refine<'a, 'h> {
    primitives: &'a Primitives,
    rays: Rays<'a>,
    hits: &'a mut HitsMut<'h>,
    range: Range<usize>,
}

impl Kernel for Refine<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { primitives, rays, hits, range } = self;
        let triangles = Kind::<S>::new(token, 0, primitives.triangle_count());
        let spheres = Kind::<S>::new(token, primitives.first_sphere(), primitives.spheres().len());
        let are_many = primitives.len() > MANY;
        let mut gathered = Gathered::new(token);
        for start in range.clone().step_by(RUN) {
            let run = start..range.end.min(start + RUN);
            if are_many {
                prefetch(primitives, &hits.primitive[run.end..range.end.min(run.end + RUN)]);
            }
            if primitives.triangle_count() > 0 {
                gathered.triangles(token, primitives, triangles, &hits.primitive[run.clone()]);
                for number in 0..steps(&run) {
                    let step = step(&run, number);
                    let (_, mask) = triangles.among(load_ids(token, &hits.primitive[step.clone()]));
                    if mask.any() {
                        refine_triangles(token, &gathered.corners[number], rays, hits, step, mask);
                    }
                }
            }
            if !primitives.spheres().is_empty() {
                gathered.spheres(token, primitives, spheres, &hits.primitive[run.clone()]);
                for number in 0..steps(&run) {
                    let step = step(&run, number);
                    let (_, mask) = spheres.among(load_ids(token, &hits.primitive[step.clone()]));
                    if mask.any() {
                        refine_spheres(token, &gathered.spheres[number], rays, hits, step, mask);
                    }
                }
            }
        }
    }
}

/// Hits whose primitives are gathered before the first is refined: their reads wait together, and the arithmetic waits
/// for none.
const RUN: usize = 8 * STEP;

/// Number of steps in a run.
#[inline(always)]
fn steps(run: &Range<usize>) -> usize {
    run.len().div_ceil(STEP)
}

/// A step of a run.
#[inline(always)]
fn step(run: &Range<usize>, number: usize) -> Range<usize> {
    let first = run.start + number * STEP;
    first..run.end.min(first + STEP)
}

/// The primitives of a kind: `count` from `first` on.
#[derive(Clone, Copy)]
struct Kind<S: Simd> {
    token: S,
    first: Ids<S>,
    count: Ids<S>,
}

impl<S: Simd> Kind<S> {
    #[inline(always)]
    fn new(token: S, first: u32, count: usize) -> Self {
        Self { token, first: Ids::<S>::splat(token, first), count: Ids::<S>::splat(token, count as u32) }
    }

    /// The numbers among those of this kind, 0 for others, and which are of this kind.
    #[inline(always)]
    fn among(self, found: Ids<S>) -> (Ids<S>, Mask<S>) {
        // Wraps round for those before the first, so that no other kind looks like this one.
        let number = found - self.first;
        let mask = number.lt(self.count);
        (Ids::<S>::select(mask, number, Ids::<S>::splat(self.token, 0)), mask)
    }
}

/// What the hits of a run lie on, step by step.
struct Gathered<S: Simd> {
    numbers: [[Ids<S>; 3]; RUN / STEP],
    corners: [[[S::F32x8; 3]; 3]; RUN / STEP],
    /// Centre and radius.
    spheres: [[S::F32x8; 4]; RUN / STEP],
}

impl<S: Simd> Gathered<S> {
    #[inline(always)]
    fn new(token: S) -> Self {
        let (none, zero) = (Ids::<S>::splat(token, 0), S::F32x8::splat(token, 0.0));
        Self {
            numbers: [[none; 3]; RUN / STEP],
            corners: [[[zero; 3]; 3]; RUN / STEP],
            spheres: [[zero; 4]; RUN / STEP],
        }
    }

    /// Gather the corners of the triangles among `found`: first all their numbers, then all coordinates.
    #[inline(always)]
    fn triangles(&mut self, token: S, primitives: &Primitives, kind: Kind<S>, found: &[u32]) {
        for (numbers, found) in self.numbers.iter_mut().zip(found.chunks(STEP)) {
            let (triangle, mask) = kind.among(load_ids(token, found));
            if mask.any() {
                *numbers = Ids::<S>::gather_x3(primitives.corners(), triangle);
            }
        }
        for (step, found) in found.chunks(STEP).enumerate() {
            let (_, mask) = kind.among(load_ids(token, found));
            if mask.any() {
                let (vertices, [a, b, c]) = (primitives.vertices(), self.numbers[step]);
                let [a, b] = [S::F32x8::gather_x3(vertices, a), S::F32x8::gather_x3(vertices, b)];
                self.corners[step] = [a, b, S::F32x8::gather_x3(vertices, c)];
            }
        }
    }

    /// Gather the spheres among `found`.
    #[inline(always)]
    fn spheres(&mut self, token: S, primitives: &Primitives, kind: Kind<S>, found: &[u32]) {
        for (rows, found) in self.spheres.iter_mut().zip(found.chunks(STEP)) {
            let (sphere, mask) = kind.among(load_ids(token, found));
            if mask.any() {
                let mut numbers = [0; STEP];
                sphere.store(&mut numbers);
                let mut records = [S::F32x4::splat(token, 0.0); STEP];
                for lane in 0..STEP {
                    let sphere = &primitives.spheres()[numbers[lane] as usize];
                    records[lane] = padded(token, sphere.center, sphere.radius);
                }
                *rows = token.columns_x8(records);
            }
        }
    }
}

type Ids<S> = <<S as Simd>::F32x8 as F32Lanes>::U32;
type Mask<S> = <<S as Simd>::F32x8 as F32Lanes>::Mask;

/// The primitives of a step; [`NONE`] beyond its end.
#[inline(always)]
fn load_ids<S: Simd>(token: S, row: &[u32]) -> Ids<S> {
    let mut padded = [NONE; STEP];
    if row.len() == STEP {
        return Ids::<S>::load_slice(token, row);
    }
    padded[..row.len()].copy_from_slice(row);
    Ids::<S>::load(token, &padded)
}

/// The vector twin of [`Triangle::refine`], for the lanes of `mask`.
#[inline(always)]
fn refine_triangles<S: Simd>(
    token: S,
    corners: &[[S::F32x8; 3]; 3],
    rays: Rays<'_>,
    hits: &mut HitsMut<'_>,
    step: Range<usize>,
    mask: Mask<S>,
) {
    let [a, b, c] = [widened::<S>(corners[0]), widened::<S>(corners[1]), widened::<S>(corners[2])];
    let (o, d) = (vector(token, rays.origin, &step), vector(token, rays.direction, &step));
    let (zero, one) = (S::F64x8::splat(token, 0.0), S::F64x8::splat(token, 1.0));
    let (ab, ac, from_a) = (b - a, c - a, o - a);
    let p = d.cross(ac);
    let area = ab.dot(p);
    let (per_area, inverse) = (one / area, one / d.length_squared());
    let u = (from_a.dot(p) * per_area).max(zero).min(one);
    let v = (d.dot(from_a.cross(ab)) * per_area).max(zero).min(one - u);
    let along = (ab * u + ac * v - from_a).dot(d) * inverse;
    let t = in_range(token, along.narrow(), rays, &step);
    let sound = mask & (area.lt(zero) | zero.lt(area));
    blend(token, &mut hits.t[step.clone()], sound, t);
    blend(token, &mut hits.u[step.clone()], sound, u.narrow());
    blend(token, &mut hits.v[step], sound, v.narrow());
}

/// The vector twin of [`Sphere::refine`], for the lanes of `mask`.
#[inline(always)]
fn refine_spheres<S: Simd>(
    token: S,
    &[x, y, z, radius]: &[S::F32x8; 4],
    rays: Rays<'_>,
    hits: &mut HitsMut<'_>,
    step: Range<usize>,
    mask: Mask<S>,
) {
    let (center, radius) = (widened::<S>([x, y, z]), S::F64x8::widen(radius));
    let (origin, d) = (vector(token, rays.origin, &step), vector(token, rays.direction, &step));
    let o = origin - center;
    let zero = S::F64x8::splat(token, 0.0);
    let inverse = S::F64x8::splat(token, 1.0) / d.length_squared();
    let middle = -(o.dot(d)) * inverse;
    let nearest = o + d * middle;
    let half_chord = ((radius * radius - nearest.length_squared()) * inverse).max(zero).sqrt();
    let (near, far) = ((middle - half_chord).narrow(), (middle + half_chord).narrow());
    let before = S::F64x8::widen(lanes(token, hits.t, step.clone())).lt(middle);
    let t = in_range(token, S::F32x8::select(before, near, far), rays, &step);
    blend(token, &mut hits.t[step], mask, t);
}

/// Rows of a vector, in double precision.
#[inline(always)]
fn widened<S: Simd>([x, y, z]: [S::F32x8; 3]) -> Vec3<S::F64x8> {
    Vec3::new(S::F64x8::widen(x), S::F64x8::widen(y), S::F64x8::widen(z))
}

/// A step of three rows, in double precision.
#[inline(always)]
fn vector<S: Simd>(token: S, rows: Vec3<&[f32]>, step: &Range<usize>) -> Vec3<S::F64x8> {
    Vec3::new(
        S::F64x8::widen(lanes(token, rows.x, step.clone())),
        S::F64x8::widen(lanes(token, rows.y, step.clone())),
        S::F64x8::widen(lanes(token, rows.z, step.clone())),
    )
}

/// Replace the lanes of `mask` in a step of a row.
#[inline(always)]
fn blend<S: Simd>(token: S, row: &mut [f32], mask: Mask<S>, new: S::F32x8) {
    let blended = S::F32x8::select(mask, new, lanes(token, row, 0..row.len()));
    if row.len() == STEP {
        return blended.store_slice(row);
    }
    let mut padded = [0.0; STEP];
    blended.store(&mut padded);
    let len = row.len();
    row.copy_from_slice(&padded[..len]);
}

/// Parameters kept within their rays' ranges.
#[inline(always)]
fn in_range<S: Simd>(token: S, t: S::F32x8, rays: Rays<'_>, step: &Range<usize>) -> S::F32x8 {
    t.max(rays.t_min.lanes(token, step.clone())).min(rays.t_max.lanes(token, step.clone()))
}

fn is_flat(area: f64) -> bool {
    area == 0.0 || area.is_nan()
}

/// `if a > b { a } else { b }`, as lanes do it.
fn max<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// `if a < b { a } else { b }`, as lanes do it.
fn min<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

impl Triangle {
    /// Recompute a hit in double precision: the weights of the second and third vertex, and t of the point that they
    /// give.
    ///
    /// `t` is the value found by the walk. The weights are kept within the triangle, hence t within its depth, and
    /// within the ray's range; where even `f64` sees no area the given `t` stays. Error of t: 2⁻²⁴ relative from
    /// rounding, plus 2⁻⁵⁰ times the condition of the plane.
    #[inline(always)]
    pub(super) fn refine(&self, ray: &Ray, t: f32) -> Refined {
        let (o, d) = (ray.origin.to_f64(), ray.direction.to_f64());
        let [a, b, c] = self.vertices.map(Vec3f::to_f64);
        let (ab, ac, from_a) = (b - a, c - a, o - a);
        let p = d.cross(ac);
        let area = ab.dot(p);
        if is_flat(area) {
            return Refined { t, u: 0.0, v: 0.0 };
        }
        let (per_area, inverse) = (1.0 / area, 1.0 / d.length_squared());
        let u = min(max(from_a.dot(p) * per_area, 0.0), 1.0);
        let v = min(max(d.dot(from_a.cross(ab)) * per_area, 0.0), 1.0 - u);
        let along = (ab * u + ac * v - from_a).dot(d) * inverse;
        Refined { t: min(max(along as f32, ray.t_min), ray.t_max), u: u as f32, v: v as f32 }
    }
}

impl Sphere {
    /// Recompute the parameter of a hit in double precision.
    #[inline(always)]
    pub(super) fn refine(&self, ray: &Ray, t: f32) -> f32 {
        let (o, d) = (ray.origin.to_f64() - self.center.to_f64(), ray.direction.to_f64());
        let inverse = 1.0 / d.length_squared();
        let middle = -o.dot(d) * inverse;
        let nearest = o + d * middle;
        let radius = f64::from(self.radius);
        let half_chord = max((radius * radius - nearest.length_squared()) * inverse, 0.0).sqrt();
        let root = if f64::from(t) < middle { middle - half_chord } else { middle + half_chord };
        min(max(root as f32, ray.t_min), ray.t_max)
    }
}
