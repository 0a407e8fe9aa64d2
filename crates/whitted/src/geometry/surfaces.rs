//! Surface points of sixteen hits at once.
//!
//! Every number has the bits that [`Primitives::surface_point`] gives, the scalar twin: triangles and spheres, which
//! make up all of most pictures, in lanes; other shapes through the twin.

use super::primitives::{COORDINATE_UNITS, EXTENT_UNITS, ROUNDING_UNIT};
use super::{Primitives, SurfacePoint};
use crate::math::{Vec3, Vec3f, select};
use crate::ray::{Hit, HitBatch, NONE, Ray};
use simd::{F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};

/// Hits in a block.
pub(crate) const BLOCK: usize = 16;

/// Doubles in a vector.
const HALF: usize = BLOCK / 2;

/// A number for each hit.
pub(crate) type Row = [f32; BLOCK];

/// Rays and what they hit, row by row.
pub(crate) struct HitRows<'a> {
    pub(crate) origin: Vec3<&'a Row>,
    pub(crate) direction: Vec3<&'a Row>,
    pub(crate) t: Row,
    u: Row,
    v: Row,
    /// [`NONE`] where nothing was hit and beyond the end of the batch.
    pub(crate) primitive: [u32; BLOCK],
}

impl<'a> HitRows<'a> {
    /// The hits `at` and following, as far as there are any, of rays with these origins and directions.
    #[inline(always)]
    pub(crate) fn new(origin: Vec3<&'a Row>, direction: Vec3<&'a Row>, hits: &HitBatch, at: usize) -> Self {
        Self {
            origin,
            direction,
            t: part(&hits.t, at, 0.0),
            u: part(&hits.u, at, 0.0),
            v: part(&hits.v, at, 0.0),
            primitive: part(&hits.primitive, at, NONE),
        }
    }

    fn ray(&self, lane: usize) -> Ray {
        let at = |rows: Vec3<&Row>| rows.map(|row| row[lane]);
        Ray::new(at(self.origin), at(self.direction))
    }

    fn hit(&self, lane: usize) -> Hit {
        let (t, u, v, primitive) = (self.t[lane], self.u[lane], self.v[lane], self.primitive[lane]);
        Hit { t, u, v, primitive, instance: NONE }
    }
}

/// Sixteen elements from `at` on; `none` beyond the end.
#[inline(always)]
fn part<T: Copy>(row: &[T], at: usize, none: T) -> [T; BLOCK] {
    if let Some(whole) = row[at..].first_chunk() {
        return *whole;
    }
    let (mut padded, rest) = ([none; BLOCK], &row[at..]);
    padded[..rest.len()].copy_from_slice(rest);
    padded
}

/// Surface points, row by row; see [`SurfacePoint`]. Zero where nothing was hit.
pub(crate) struct SurfaceRows {
    position: [Row; 3],
    n_g: [Row; 3],
    n_s: [Row; 3],
    error: Row,
}

/// Surface points in lanes; see [`SurfacePoint`].
#[derive(Clone, Copy)]
pub(crate) struct Surfaces<L> {
    pub(crate) position: Vec3<L>,
    pub(crate) n_g: Vec3<L>,
    pub(crate) n_s: Vec3<L>,
    pub(crate) error: L,
}

impl Primitives {
    /// The surfaces where rays hit; zero in lanes that miss.
    #[inline(always)]
    pub(crate) fn surfaces<S: Simd>(&self, token: S, hits: &HitRows) -> Surfaces<S::F32x16> {
        const NOTHING: [Row; 3] = [[0.0; BLOCK]; 3];
        let mut rows = SurfaceRows { position: NOTHING, n_g: NOTHING, n_s: NOTHING, error: [0.0; BLOCK] };
        let id = <S::F32x16 as F32Lanes>::U32::load(token, &hits.primitive);
        let below = |limit: u32| id.lt(<S::F32x16 as F32Lanes>::U32::splat(token, limit)).bits();
        let (triangles, bounded) = (below(self.first_sphere()), below(self.first_shape()));
        let others = below(NONE) & !bounded;
        if triangles != 0 {
            self.triangle_rows(token, hits, triangles, &mut rows);
        }
        if bounded & !triangles != 0 {
            self.sphere_rows(token, hits, bounded & !triangles, &mut rows);
        }
        if others != 0 {
            self.other_rows(hits, others, &mut rows);
        }
        rows.load(token)
    }

    /// The vector twin of [`Sphere::surface`](super::Sphere::surface).
    #[inline(always)]
    fn sphere_rows<S: Simd>(&self, token: S, hits: &HitRows, set: u32, out: &mut SurfaceRows) {
        let (first, spheres) = (self.first_sphere(), self.spheres());
        let mut records = [S::F32x4::splat(token, 0.0); BLOCK];
        for lane in 0..BLOCK {
            // Lanes that hit something else may get any sphere.
            let sphere = spheres.get((hits.primitive[lane].wrapping_sub(first)) as usize).unwrap_or(&spheres[0]);
            records[lane] = padded(token, sphere.center, sphere.radius);
        }
        let (center, radius) = columns::<S>(token, records);
        let (mut position, mut normal) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; 3]);
        for at in [0, HALF] {
            let c = vector::<S>(token, [&center[0], &center[1], &center[2]], at);
            let o = vector::<S>(token, hits.origin.to_array(), at);
            let d = vector::<S>(token, hits.direction.to_array(), at);
            let from_center = o + d * wide::<S>(token, &hits.t, at) - c;
            let n = from_center / from_center.length_squared().sqrt();
            store::<S>(n, &mut normal, at);
            store::<S>(c + n * wide::<S>(token, &radius, at), &mut position, at);
        }
        let row = |row: &Row| S::F32x16::load(token, row);
        let radius = row(&radius);
        // A root is off by twice as much as a vertex: it takes a product of distances.
        let reach = largest::<S::F32x16>(token, &center) + radius;
        let error = error_bound(token, reach, S::F32x16::splat(token, 2.0) * radius);
        out.set(token, set, &position, &normal, &normal, error);
    }

    /// The vector twin of [`Triangle::surface`](super::Triangle::surface) and of the interpolation of normals.
    #[inline(always)]
    fn triangle_rows<S: Simd>(&self, token: S, hits: &HitRows, set: u32, out: &mut SurfaceRows) {
        let numbers = self.corner_numbers(token, hits);
        let [a, b, c] = gathered::<S>(self.vertices(), numbers);
        let corners = [stored(a), stored(b), stored(c)];
        let (mut position, mut normal) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; 3]);
        for at in [0, HALF] {
            let [a, b, c] = &corners;
            let a = vector::<S>(token, [&a[0], &a[1], &a[2]], at);
            let ab = vector::<S>(token, [&b[0], &b[1], &b[2]], at) - a;
            let ac = vector::<S>(token, [&c[0], &c[1], &c[2]], at) - a;
            let (u, v) = (wide::<S>(token, &hits.u, at), wide::<S>(token, &hits.v, at));
            store::<S>(a + ab * u + ac * v, &mut position, at);
            let across = ab.cross(ac);
            store::<S>(across / across.length_squared().sqrt(), &mut normal, at);
        }
        upright_where_flat(token, &mut normal);
        let shading = self.shading_normals(token, hits, numbers, &normal);
        let error = error_bound::<S::F32x16>(token, largest(token, &position), extent(token, &corners));
        out.set(token, set, &position, &normal, &shading, error);
    }

    /// The numbers of the corners of the triangles that were hit; of the first one in lanes that hit something else.
    #[inline(always)]
    fn corner_numbers<S: Simd>(&self, token: S, hits: &HitRows) -> [Numbers<S>; 3] {
        let id = Numbers::<S>::load(token, &hits.primitive);
        let is_triangle = id.lt(Numbers::<S>::splat(token, self.first_sphere()));
        Numbers::<S>::gather_x3(self.corners(), Numbers::<S>::select(is_triangle, id, Numbers::<S>::splat(token, 0)))
    }

    /// Interpolated normals, turned to the side of `n_g`; `n_g` itself where there is none.
    #[inline(always)]
    fn shading_normals<S: Simd>(&self, token: S, hits: &HitRows, numbers: [Numbers<S>; 3], n_g: &[Row; 3]) -> [Row; 3] {
        if !self.has_normals() {
            return *n_g;
        }
        let [a, b, c] = gathered::<S>(self.normals(), numbers);
        let row = |row: &Row| S::F32x16::load(token, row);
        let n_g = Vec3::new(row(&n_g[0]), row(&n_g[1]), row(&n_g[2]));
        let (u, v, zero) = (row(&hits.u), row(&hits.v), S::F32x16::splat(token, 0.0));
        let sum = a * (S::F32x16::splat(token, 1.0) - u - v) + b * u + c * v;
        let unit = sum / sum.length_squared().sqrt();
        let missing = is_zero(token, a) | is_zero(token, b) | is_zero(token, c) | !is_finite(token, unit);
        let backwards = unit.dot(n_g).lt(zero);
        let turned = select(backwards, -unit, unit);
        stored(select(missing, n_g, turned))
    }

    /// Shapes and planes, one after the other.
    #[inline(never)]
    fn other_rows(&self, hits: &HitRows, mut set: u32, out: &mut SurfaceRows) {
        while set != 0 {
            let lane = set.trailing_zeros() as usize % BLOCK;
            set &= set - 1;
            let SurfacePoint { position, n_g, n_s, error, .. } = self.surface_point(&hits.ray(lane), &hits.hit(lane));
            put(&mut out.position, lane, position);
            put(&mut out.n_g, lane, n_g);
            put(&mut out.n_s, lane, n_s);
            out.error[lane] = error;
        }
    }
}

impl SurfaceRows {
    /// Replace the lanes `set`.
    #[inline(always)]
    fn set<L: F32Lanes<Array = Row>>(
        &mut self,
        token: L::Token,
        set: u32,
        position: &[Row; 3],
        n_g: &[Row; 3],
        n_s: &[Row; 3],
        error: L,
    ) {
        let mask = L::Mask::from_bits(token, set);
        for axis in 0..3 {
            replace::<L>(token, mask, &mut self.position[axis], L::load(token, &position[axis]));
            replace::<L>(token, mask, &mut self.n_g[axis], L::load(token, &n_g[axis]));
            replace::<L>(token, mask, &mut self.n_s[axis], L::load(token, &n_s[axis]));
        }
        replace(token, mask, &mut self.error, error);
    }

    #[inline(always)]
    fn load<L: F32Lanes<Array = Row>>(&self, token: L::Token) -> Surfaces<L> {
        let rows =
            |rows: &[Row; 3]| Vec3::new(L::load(token, &rows[0]), L::load(token, &rows[1]), L::load(token, &rows[2]));
        let (position, n_g, n_s) = (rows(&self.position), rows(&self.n_g), rows(&self.n_s));
        Surfaces { position, n_g, n_s, error: L::load(token, &self.error) }
    }
}

#[inline(always)]
fn replace<L: F32Lanes<Array = Row>>(token: L::Token, mask: L::Mask, row: &mut Row, new: L) {
    L::select(mask, new, L::load(token, row)).store(row);
}

#[inline(always)]
fn put(rows: &mut [Row; 3], lane: usize, value: Vec3f) {
    (rows[0][lane], rows[1][lane], rows[2][lane]) = (value.x, value.y, value.z);
}

type Numbers<S> = <<S as Simd>::F32x16 as F32Lanes>::U32;

/// The vectors of each corner.
#[inline(always)]
fn gathered<S: Simd>(table: &[[f32; 3]], [a, b, c]: [Numbers<S>; 3]) -> [Vec3<S::F32x16>; 3] {
    [
        Vec3::from(S::F32x16::gather_x3(table, a)),
        Vec3::from(S::F32x16::gather_x3(table, b)),
        Vec3::from(S::F32x16::gather_x3(table, c)),
    ]
}

/// A point and one more number.
#[inline(always)]
pub(super) fn padded<S: Simd>(token: S, point: Vec3f, last: f32) -> S::F32x4 {
    S::F32x4::load(token, &[point.x, point.y, point.z, last])
}

/// Sixteen records of four as rows: three coordinates, and the rest.
#[inline(always)]
fn columns<S: Simd>(token: S, records: [S::F32x4; BLOCK]) -> ([Row; 3], Row) {
    let [x, y, z, last] = token.columns_x16(records);
    let mut rest = [0.0; BLOCK];
    last.store(&mut rest);
    (stored(Vec3::new(x, y, z)), rest)
}

/// Eight numbers from `at` on in double precision.
#[inline(always)]
fn wide<S: Simd>(token: S, row: &Row, at: usize) -> S::F64x8 {
    S::F64x8::widen(S::F32x8::load_slice(token, &row[at..]))
}

#[inline(always)]
fn vector<S: Simd>(token: S, [x, y, z]: [&Row; 3], at: usize) -> Vec3<S::F64x8> {
    Vec3::new(wide::<S>(token, x, at), wide::<S>(token, y, at), wide::<S>(token, z, at))
}

#[inline(always)]
fn store<S: Simd>(vector: Vec3<S::F64x8>, rows: &mut [Row; 3], at: usize) {
    let [x, y, z] = rows;
    vector.x.narrow().store_slice(&mut x[at..]);
    vector.y.narrow().store_slice(&mut y[at..]);
    vector.z.narrow().store_slice(&mut z[at..]);
}

#[inline(always)]
fn stored<L: F32Lanes<Array = Row>>(vector: Vec3<L>) -> [Row; 3] {
    let mut rows = [[0.0; BLOCK]; 3];
    vector.x.store(&mut rows[0]);
    vector.y.store(&mut rows[1]);
    vector.z.store(&mut rows[2]);
    rows
}

#[inline(always)]
fn is_zero<L: F32Lanes>(token: L::Token, v: Vec3<L>) -> L::Mask {
    let zero = L::splat(token, 0.0);
    v.x.eq(zero) & v.y.eq(zero) & v.z.eq(zero)
}

/// For vectors whose length does not overflow.
#[inline(always)]
fn is_finite<L: F32Lanes>(token: L::Token, v: Vec3<L>) -> L::Mask {
    (v.x.abs() + v.y.abs() + v.z.abs()).lt(L::splat(token, f32::INFINITY))
}

/// The normal of a triangle without area is +y.
#[inline(always)]
fn upright_where_flat<S: Simd>(token: S, normal: &mut [Row; 3]) {
    let row = |row: &Row| S::F32x16::load(token, row);
    let n = Vec3::new(row(&normal[0]), row(&normal[1]), row(&normal[2]));
    let (zero, one) = (S::F32x16::splat(token, 0.0), S::F32x16::splat(token, 1.0));
    *normal = stored(select(is_finite(token, n), n, Vec3::new(zero, one, zero)));
}

/// The largest absolute coordinate.
#[inline(always)]
fn largest<L: F32Lanes<Array = Row>>(token: L::Token, rows: &[Row; 3]) -> L {
    let [x, y, z] = rows;
    L::load(token, x).abs().max(L::load(token, y).abs()).max(L::load(token, z).abs())
}

/// The vector twin of [`Triangle::extent`](super::Triangle::extent).
#[inline(always)]
fn extent<L: F32Lanes<Array = Row>>(token: L::Token, corners: &[[Row; 3]; 3]) -> L {
    let along = |axis: usize| {
        let [a, b, c] = [&corners[0][axis], &corners[1][axis], &corners[2][axis]];
        let (a, b, c) = (L::load(token, a), L::load(token, b), L::load(token, c));
        a.max(b).max(c) - a.min(b).min(c)
    };
    along(0).max(along(1)).max(along(2))
}

/// The vector twin of [`error_bound`](super::primitives::error_bound).
#[inline(always)]
fn error_bound<L: F32Lanes>(token: L::Token, max_coordinate: L, extent: L) -> L {
    let splat = |value| L::splat(token, value);
    splat(ROUNDING_UNIT) * (splat(EXTENT_UNITS) * extent + splat(COORDINATE_UNITS) * max_coordinate)
}
