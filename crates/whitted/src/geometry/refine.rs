//! The final t and surface coordinates of hits, in double precision.
//!
//! The walks order hits by an `f32` t that is good to a few ulp of the distance in the *sheared* triangle; what is
//! reported is the t of the triangle itself. Done once for each hit, eight at a time; [`Triangle::refine`] and
//! [`Sphere::refine`] are the scalar twins.

use super::triangle::Refined;
use super::{Kind, Primitives, Sphere, Triangle};
use crate::math::{Vec3, Vec3f};
use crate::ray::{HitBatch, NONE, Ray, Rays};
use simd::{F32Lanes, F64Lanes, Kernel, Level, Simd};

/// Hits in a step.
const STEP: usize = 8;

/// Give every hit of a batch its t in double precision and its surface coordinates.
pub(crate) fn refine(level: Level, primitives: &Primitives, rays: Rays<'_>, hits: &mut HitBatch) {
    simd::dispatch(level, Refine { primitives, rays, hits });
}

/// As [`refine`], one hit after the other in plain Rust.
pub(crate) fn refine_one_by_one(primitives: &Primitives, rays: Rays<'_>, hits: &mut HitBatch) {
    for index in 0..hits.len() {
        if hits.primitive[index] != NONE {
            let ray = rays.get(index);
            set(hits, index, primitives.refine(&ray, hits.t[index], hits.primitive[index]));
        }
    }
}

struct Refine<'a> {
    primitives: &'a Primitives,
    rays: Rays<'a>,
    hits: &'a mut HitBatch,
}

impl Kernel for Refine<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { primitives, rays, hits } = self;
        let mut triangles = Waiting::new();
        let mut spheres = Waiting::new();
        for index in 0..hits.len() {
            let primitive = hits.primitive[index];
            if primitive == NONE {
                continue;
            }
            match primitives.kind(primitive) {
                Kind::Triangle(i) => {
                    let [a, b, c] = primitives.triangle(i).vertices;
                    triangles.push(index, rays, [a, b, c]);
                    if triangles.len == STEP {
                        triangles.refine_triangles(token, rays, hits);
                    }
                }
                Kind::Sphere(i) => {
                    let sphere = &primitives.spheres()[i];
                    spheres.push(index, rays, [sphere.center, Vec3f::splat(sphere.radius), Vec3f::ZERO]);
                    if spheres.len == STEP {
                        spheres.refine_spheres(token, rays, hits);
                    }
                }
                Kind::Shape(_) | Kind::Plane(_) => {}
            }
        }
        triangles.refine_triangles(token, rays, hits);
        spheres.refine_spheres(token, rays, hits);
    }
}

/// Hits on their way into lanes: origin, direction and three points of each.
struct Waiting {
    index: [usize; STEP],
    rows: [[f32; STEP]; 15],
    len: usize,
}

impl Waiting {
    fn new() -> Self {
        Self { index: [0; STEP], rows: [[0.0; STEP]; 15], len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, index: usize, rays: Rays<'_>, points: [Vec3f; 3]) {
        let lane = self.len % STEP;
        self.index[lane] = index;
        let (o, d) = (rays.origin, rays.direction);
        let ray = [o.x[index], o.y[index], o.z[index], d.x[index], d.y[index], d.z[index]];
        for row in 0..6 {
            self.rows[row][lane] = ray[row];
        }
        for (point, rows) in points.into_iter().zip(self.rows[6..].chunks_exact_mut(3)) {
            (rows[0][lane], rows[1][lane], rows[2][lane]) = (point.x, point.y, point.z);
        }
        self.len += 1;
    }

    #[inline(always)]
    fn vector<S: Simd>(&self, token: S, first: usize) -> Vec3<S::F64x8> {
        Vec3::new(self.row(token, first), self.row(token, first + 1), self.row(token, first + 2))
    }

    #[inline(always)]
    fn row<S: Simd>(&self, token: S, row: usize) -> S::F64x8 {
        S::F64x8::widen(S::F32x8::load(token, &self.rows[row]))
    }

    /// The vector twin of [`Triangle::refine`].
    #[inline(always)]
    fn refine_triangles<S: Simd>(&mut self, token: S, rays: Rays<'_>, hits: &mut HitBatch) {
        let (o, d) = (self.vector(token, 0), self.vector(token, 3));
        let (a, b, c) = (self.vector(token, 6), self.vector(token, 9), self.vector(token, 12));
        let (zero, one) = (S::F64x8::splat(token, 0.0), S::F64x8::splat(token, 1.0));
        let (ab, ac, from_a) = (b - a, c - a, o - a);
        let p = d.cross(ac);
        let area = ab.dot(p);
        let per_area = one / area;
        let u = (from_a.dot(p) * per_area).max(zero).min(one);
        let v = (d.dot(from_a.cross(ab)) * per_area).max(zero).min(one - u);
        let along = (ab * u + ac * v - from_a).dot(d) / d.length_squared();
        let mut areas = [0.0; STEP];
        area.store(&mut areas);
        let (t, u, v) = (stored::<S>(along), stored::<S>(u), stored::<S>(v));
        for lane in 0..self.len {
            let index = self.index[lane];
            let refined = if is_flat(areas[lane]) {
                Refined { t: hits.t[index], u: 0.0, v: 0.0 }
            } else {
                Refined { t: t[lane].max(rays.t_min[index]).min(rays.t_max[index]), u: u[lane], v: v[lane] }
            };
            set(hits, index, refined);
        }
        self.len = 0;
    }

    /// The vector twin of [`Sphere::refine`].
    #[inline(always)]
    fn refine_spheres<S: Simd>(&mut self, token: S, rays: Rays<'_>, hits: &mut HitBatch) {
        let (d, center, radius) = (self.vector(token, 3), self.vector(token, 6), self.row(token, 9));
        let o = self.vector(token, 0) - center;
        let zero = S::F64x8::splat(token, 0.0);
        let inverse = S::F64x8::splat(token, 1.0) / d.length_squared();
        let middle = -(o.dot(d)) * inverse;
        let nearest = o + d * middle;
        let half_chord = ((radius * radius - nearest.length_squared()) * inverse).max(zero).sqrt();
        let mut middles = [0.0; STEP];
        middle.store(&mut middles);
        let (near, far) = (stored::<S>(middle - half_chord), stored::<S>(middle + half_chord));
        for lane in 0..self.len {
            let index = self.index[lane];
            let root = if f64::from(hits.t[index]) < middles[lane] { near[lane] } else { far[lane] };
            hits.t[index] = root.max(rays.t_min[index]).min(rays.t_max[index]);
        }
        self.len = 0;
    }
}

/// Lanes rounded to `f32`.
#[inline(always)]
fn stored<S: Simd>(lanes: S::F64x8) -> [f32; STEP] {
    let mut out = [0.0; STEP];
    lanes.narrow().store(&mut out);
    out
}

fn is_flat(area: f64) -> bool {
    area == 0.0 || area.is_nan()
}

fn set(hits: &mut HitBatch, index: usize, refined: Refined) {
    (hits.t[index], hits.u[index], hits.v[index]) = (refined.t, refined.u, refined.v);
}

/// `if a > b { a } else { b }`, as lanes do it.
fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// `if a < b { a } else { b }`, as lanes do it.
fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Triangle {
    /// Recompute a hit in double precision: the weights of the second and third vertex, and t of the point that they
    /// give.
    ///
    /// `t` is the value found by the walk. The weights are kept within the triangle, hence t within its depth, and
    /// within the ray's range; where even `f64` sees no area the given `t` stays. Error of t: 2⁻²⁴ relative from
    /// rounding, plus 2⁻⁵⁰ times the condition of the plane.
    pub(super) fn refine(&self, ray: &Ray, t: f32) -> Refined {
        let (o, d) = (ray.origin.to_f64(), ray.direction.to_f64());
        let [a, b, c] = self.vertices.map(Vec3f::to_f64);
        let (ab, ac, from_a) = (b - a, c - a, o - a);
        let p = d.cross(ac);
        let area = ab.dot(p);
        if is_flat(area) {
            return Refined { t, u: 0.0, v: 0.0 };
        }
        let per_area = 1.0 / area;
        let u = min(max(from_a.dot(p) * per_area, 0.0), 1.0);
        let v = min(max(d.dot(from_a.cross(ab)) * per_area, 0.0), 1.0 - u);
        let along = (ab * u + ac * v - from_a).dot(d) / d.length_squared();
        Refined { t: (along as f32).max(ray.t_min).min(ray.t_max), u: u as f32, v: v as f32 }
    }
}

impl Sphere {
    /// Recompute the parameter of a hit in double precision.
    pub(super) fn refine(&self, ray: &Ray, t: f32) -> f32 {
        let (o, d) = (ray.origin.to_f64() - self.center.to_f64(), ray.direction.to_f64());
        let inverse = 1.0 / d.length_squared();
        let middle = -o.dot(d) * inverse;
        let nearest = o + d * middle;
        let radius = f64::from(self.radius);
        let half_chord = max((radius * radius - nearest.length_squared()) * inverse, 0.0).sqrt();
        let root = if f64::from(t) < middle { middle - half_chord } else { middle + half_chord };
        (root as f32).max(ray.t_min).min(ray.t_max)
    }
}
