//! A chunk of rays in the forms that nodes and leaves want.

use crate::geometry::sphere::SphereRay;
use crate::geometry::{Primitives, ShearedRay};
use crate::math::Vec3;
use crate::ray::{NONE, Ray, Rays, Row};
use crate::tree::Tree;
use simd::{F32Lanes, Kernel, Level, MaskLanes, Simd, U32Lanes};
use std::ops::Range;

/// What the box test of a node needs of a ray: half a cache line.
///
/// A plane at `p` is met at `p·inverse + offset`.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct NodeRay {
    /// Reciprocal direction, clamped: never infinite.
    pub inverse: [f32; 3],
    /// `−origin·inverse`, for the planes where the ray enters made smaller by the slack.
    pub near: [f32; 3],
    /// Lower end of the range.
    pub t_min: f32,
    /// Upper end of the range so far; negative infinity when the ray has ended.
    pub limit: f32,
}

const _: () = assert!(size_of::<NodeRay>() == 32, "half a cache line");

/// Components of the direction smaller than this count as this: keeps reciprocals finite and 0·∞ out of the slabs.
const MIN_COMPONENT: f32 = 1.0 / MAX_RECIPROCAL;
const MAX_RECIPROCAL: f32 = (1u128 << 80) as f32;
/// Rays whose direction, in the tree's scale and by the sum of its components' sizes, is not within these bounds hit
/// nothing.
const MAX_DIRECTION: f32 = (1u64 << 62) as f32;
const MIN_DIRECTION: f32 = 1.0 / MAX_DIRECTION;

/// A chunk of rays, prepared.
#[derive(Debug, Default)]
pub(in crate::tree) struct PreparedRays {
    pub(super) nodes: Vec<NodeRay>,
    /// As `near`, for the planes where the ray leaves: made larger by the slack.
    pub(super) far: Vec<[f32; 3]>,
    /// Signs of the direction: bit a is set if component a is negative.
    pub(super) octant: Vec<u8>,
    sheared: Vec<ShearedRay>,
    spheres: Vec<SphereRay>,
    original: Vec<Ray>,
    any_slack: bool,
}

impl PreparedRays {
    /// Prepare the rays `range` of `rays` for `tree`.
    pub(in crate::tree) fn fill(
        &mut self,
        level: Level,
        tree: &Tree,
        primitives: &Primitives,
        rays: Rays<'_>,
        range: Range<usize>,
    ) {
        self.any_slack = false;
        self.nodes.clear();
        self.far.clear();
        self.octant.clear();
        self.sheared.clear();
        self.spheres.clear();
        self.original.clear();
        if !(primitives.shapes().is_empty() && primitives.planes().is_empty()) {
            self.original.extend(range.clone().map(|index| rays.get(index)));
        }
        let (triangles, spheres) = (primitives.triangle_count() > 0, !primitives.spheres().is_empty());
        simd::dispatch(level, Fill { prepared: self, tree, rays, range, triangles, spheres });
    }

    /// Number of rays.
    pub(in crate::tree) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True if a ray starts so far away that the boxes' padding does not cover its rounding.
    pub(super) fn any_slack(&self) -> bool {
        self.any_slack
    }

    /// Lower end of a ray's range.
    #[inline(always)]
    pub(in crate::tree) fn t_min(&self, index: usize) -> f32 {
        self.nodes[index].t_min
    }

    /// Upper end of a ray's range so far.
    #[inline(always)]
    pub(in crate::tree) fn limit(&self, index: usize) -> f32 {
        self.nodes[index].limit
    }

    /// Shorten a ray.
    #[inline(always)]
    pub(in crate::tree) fn set_limit(&mut self, index: usize, limit: f32) {
        self.nodes[index].limit = limit;
    }

    /// A ray in the form for triangles, in the tree's scale; only where there are triangles.
    #[inline(always)]
    pub(super) fn sheared(&self, index: usize) -> ShearedRay {
        self.sheared[index]
    }

    /// A ray in the form for spheres, in the tree's scale; only where there are spheres.
    #[inline(always)]
    pub(super) fn sphere(&self, index: usize) -> SphereRay {
        self.spheres[index]
    }

    /// A ray as the caller gave it; only where there are shapes or planes.
    pub(super) fn ray(&self, index: usize) -> Ray {
        self.original[index]
    }

    /// Write the t of each ray that found a primitive.
    pub(in crate::tree) fn found(&self, primitive: &[u32], t: &mut [f32]) {
        for ((ray, &primitive), t) in self.nodes.iter().zip(primitive).zip(t) {
            if primitive != NONE {
                *t = ray.limit;
            }
        }
    }
}

/// Prepares sixteen rays at a time.
struct Fill<'a> {
    prepared: &'a mut PreparedRays,
    tree: &'a Tree,
    rays: Rays<'a>,
    range: Range<usize>,
    triangles: bool,
    spheres: bool,
}

/// Rays in a step of [`Fill`].
const STEP: usize = 16;

impl Kernel for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { prepared, tree, rays, range, triangles, spheres } = self;
        for start in range.clone().step_by(STEP) {
            let end = range.end.min(start + STEP);
            let scale = S::F32x16::splat(token, tree.scale());
            let origin = load(token, rays.origin, start..end) * scale;
            let direction = load(token, rays.direction, start..end) * scale;
            let t_min = load_bound(token, rays.t_min, start..end);
            let t_max = load_bound(token, rays.t_max, start..end);
            let count = end - start;
            prepared.push_nodes(token, tree, origin, direction, t_min, t_max, count);
            if triangles {
                prepared.push_sheared(token, origin, direction, count);
            }
            if spheres {
                prepared.push_spheres(token, origin, direction, count);
            }
        }
    }
}

impl PreparedRays {
    #[inline(always)]
    fn push_nodes<F: F32Lanes<Array = [f32; STEP]>>(
        &mut self,
        token: F::Token,
        tree: &Tree,
        origin: Vec3<F>,
        direction: Vec3<F>,
        t_min: F,
        t_max: F,
        count: usize,
    ) where
        F::U32: U32Lanes<Array = [u32; STEP]>,
    {
        let inverse =
            Vec3::new(reciprocal(token, direction.x), reciprocal(token, direction.y), reciprocal(token, direction.z));
        let distance = origin.x.abs().max(origin.y.abs()).max(origin.z.abs());
        let slack = tree.slack(token, distance);
        let x = offsets(origin.x, inverse.x, slack);
        let y = offsets(origin.y, inverse.y, slack);
        let z = offsets(origin.z, inverse.z, slack);
        let ended = F::splat(token, f32::NEG_INFINITY);
        let limit = F::select(sound(token, origin, direction), t_max, ended);
        self.any_slack |= F::splat(token, 0.0).lt(slack).any();
        let rows = [inverse.x, inverse.y, inverse.z, x.0, y.0, z.0, t_min, limit];
        let rows = stored(rows);
        let far = stored([x.1, y.1, z.1]);
        for lane in 0..count {
            let [ix, iy, iz, nx, ny, nz, t_min, limit] = column(&rows, lane);
            self.nodes.push(NodeRay { inverse: [ix, iy, iz], near: [nx, ny, nz], t_min, limit });
            self.far.push(column(&far, lane));
        }
        let signs = |component: F| component.to_bits().shr::<31>();
        let octant = signs(inverse.x) | signs(inverse.y).shl::<1>() | signs(inverse.z).shl::<2>();
        let mut lanes = [0; STEP];
        octant.store(&mut lanes);
        self.octant.extend(lanes[..count].iter().map(|&octant| octant as u8));
    }

    /// The vector twin of [`ShearedRay::new`].
    #[inline(always)]
    fn push_sheared<F: F32Lanes<Array = [f32; STEP]>>(
        &mut self,
        token: F::Token,
        origin: Vec3<F>,
        direction: Vec3<F>,
        count: usize,
    ) {
        let (ax, ay, az) = (direction.x.abs(), direction.y.abs(), direction.z.abs());
        let is_z = ax.max(ay).lt(az);
        let is_y = ax.lt(ay);
        let [ox, oy, oz] = renamed_lanes(is_y, is_z, origin);
        let [dx, dy, dz] = renamed_lanes(is_y, is_z, direction);
        let rows = stored([ox, oy, oz, dx / dz, dy / dz, F::splat(token, 1.0) / dz]);
        let (is_y, is_z) = (is_y.bits(), is_z.bits());
        for lane in 0..count {
            let [ox, oy, oz, sx, sy, sz] = column(&rows, lane);
            let axis = if is_z >> lane & 1 != 0 { 2 } else { is_y >> lane & 1 };
            self.sheared.push(ShearedRay::from_parts([ox, oy, oz], [sx, sy, sz], axis));
        }
    }

    /// The vector twin of [`SphereRay::new`].
    #[inline(always)]
    fn push_spheres<F: F32Lanes<Array = [f32; STEP]>>(
        &mut self,
        token: F::Token,
        origin: Vec3<F>,
        direction: Vec3<F>,
        count: usize,
    ) {
        let inverse = F::splat(token, 1.0) / direction.length_squared();
        let (o, d) = (origin, direction);
        let rows = stored([o.x, o.y, o.z, d.x, d.y, d.z, inverse]);
        for lane in 0..count {
            let [ox, oy, oz, dx, dy, dz, inverse] = column(&rows, lane);
            self.spheres.push(SphereRay::from_parts([ox, oy, oz], [dx, dy, dz], inverse));
        }
    }
}

/// The components in the order y z x where x dominates, z x y where y does, x y z where z does.
#[inline(always)]
fn renamed_lanes<F: F32Lanes>(is_y: F::Mask, is_z: F::Mask, v: Vec3<F>) -> [F; 3] {
    [
        F::select(is_z, v.x, F::select(is_y, v.z, v.y)),
        F::select(is_z, v.y, F::select(is_y, v.x, v.z)),
        F::select(is_z, v.z, F::select(is_y, v.y, v.x)),
    ]
}

/// The offsets of a ray for the planes where it enters and where it leaves.
#[inline(always)]
fn offsets<F: F32Lanes>(origin: F, inverse: F, slack: F) -> (F, F) {
    let offset = -(origin * inverse);
    let reach = inverse.abs() * slack;
    (offset - reach, offset + reach)
}

/// `1 / component`, clamped to ±2⁸⁰ with the component's sign.
#[inline(always)]
fn reciprocal<F: F32Lanes>(token: F::Token, component: F) -> F {
    let sign = component.to_bits() & F::U32::splat(token, 1 << 31);
    let clamped = F::from_bits(F::splat(token, MAX_RECIPROCAL).to_bits() | sign);
    let small = component.abs().lt(F::splat(token, MIN_COMPONENT));
    F::select(small, clamped, F::splat(token, 1.0) / component)
}

/// Unset for rays that hit nothing: NaN, infinite origins, directions that are zero or extreme.
#[inline(always)]
fn sound<F: F32Lanes>(token: F::Token, origin: Vec3<F>, direction: Vec3<F>) -> F::Mask {
    // A sum of sizes is NaN if a component is, and infinite if one is.
    let reach = origin.x.abs() + origin.y.abs() + origin.z.abs();
    let size = direction.x.abs() + direction.y.abs() + direction.z.abs();
    let sound_size = F::splat(token, MIN_DIRECTION).le(size) & size.le(F::splat(token, MAX_DIRECTION));
    sound_size & reach.lt(F::splat(token, f32::INFINITY))
}

#[inline(always)]
fn load<S: Simd>(token: S, rows: Vec3<&[f32]>, range: Range<usize>) -> Vec3<S::F32x16> {
    Vec3::new(
        load_row(token, rows.x, range.clone()),
        load_row(token, rows.y, range.clone()),
        load_row(token, rows.z, range),
    )
}

/// A step of the ends of ranges.
#[inline(always)]
fn load_bound<S: Simd>(token: S, row: Row<'_, f32>, range: Range<usize>) -> S::F32x16 {
    match row {
        Row::Each(values) => load_row(token, values, range),
        Row::All(value) => S::F32x16::splat(token, value),
    }
}

/// A step of a row; lanes beyond the range are 0.
#[inline(always)]
fn load_row<S: Simd>(token: S, row: &[f32], range: Range<usize>) -> S::F32x16 {
    let row = &row[range];
    if row.len() == STEP {
        return S::F32x16::load_slice(token, row);
    }
    let mut padded = [0.0; STEP];
    padded[..row.len()].copy_from_slice(row);
    S::F32x16::load(token, &padded)
}

#[inline(always)]
fn stored<F: F32Lanes<Array = [f32; STEP]>, const N: usize>(rows: [F; N]) -> [[f32; STEP]; N] {
    let mut out = [[0.0; STEP]; N];
    for i in 0..N {
        rows[i].store(&mut out[i]);
    }
    out
}

#[inline(always)]
fn column<const N: usize>(rows: &[[f32; STEP]; N], lane: usize) -> [f32; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = rows[i][lane % STEP];
    }
    out
}
