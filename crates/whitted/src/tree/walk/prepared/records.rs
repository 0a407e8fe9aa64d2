//! Records of rays: what nodes and leaves want of one ray, together.

use super::{Octet, PreparedRays, STEP, distance, load};
use crate::geometry::Primitives;
use crate::math::Vec3;
use crate::ray::Rays;
use crate::tree::Tree;
use crate::tree::query::CHUNK;
use simd::{F32Lanes, Simd, U32Lanes};

/// Components of the direction smaller than this count as this: keeps reciprocals finite and 0·∞ out of the slabs.
const MIN_COMPONENT: f32 = 1.0 / MAX_RECIPROCAL;
const MAX_RECIPROCAL: f32 = (1u128 << 80) as f32;
/// Makes the records of one packet.
pub(in crate::tree::walk) struct Records<'a> {
    pub tree: &'a Tree,
    pub primitives: &'a Primitives,
    pub rays: Rays<'a>,
    /// The ray of the batch that is the first of the chunk.
    pub start: usize,
}

impl PreparedRays {
    /// Make room for records.
    pub(in crate::tree::walk) fn reserve_records(&mut self, primitives: &Primitives) {
        let len = self.len.next_multiple_of(STEP);
        grow(&mut self.nodes, len);
        grow(&mut self.octant, len);
        if self.any_slack {
            grow(&mut self.far, len);
        }
        if primitives.triangle_count() > 0 {
            grow(&mut self.sheared, len);
        }
        if !primitives.spheres().is_empty() {
            grow(&mut self.spheres, len);
        }
    }

    /// Make the records of packet `packet`.
    #[inline(always)]
    pub(in crate::tree::walk) fn record<S: Simd>(&mut self, token: S, from: &Records<'_>, packet: usize) {
        let scale = S::F32x16::splat(token, from.tree.scale());
        let range = self.packet(packet);
        for first in range.clone().step_by(STEP) {
            let step = from.start + first..from.start + range.end.min(first + STEP);
            let origin = load(token, from.rays.origin, step.clone()) * scale;
            let direction = load(token, from.rays.direction, step.clone()) * scale;
            self.record_nodes(token, from.tree, origin, direction, from.rays.t_min.lanes(token, step), first);
            if from.primitives.triangle_count() > 0 {
                record_sheared(token, origin, direction, &mut self.sheared[first..first + STEP]);
            }
            if !from.primitives.spheres().is_empty() {
                record_spheres(token, origin, direction, &mut self.spheres[first..first + STEP]);
            }
        }
        self.recorded.insert(packet);
    }

    #[inline(always)]
    fn record_nodes<S: Simd>(
        &mut self,
        token: S,
        tree: &Tree,
        origin: Vec3<S::F32x16>,
        direction: Vec3<S::F32x16>,
        t_min: S::F32x16,
        first: usize,
    ) {
        let inverse =
            Vec3::new(reciprocal(token, direction.x), reciprocal(token, direction.y), reciprocal(token, direction.z));
        let slack = tree.slack(token, distance(origin));
        let x = offsets(origin.x, inverse.x, slack);
        let y = offsets(origin.y, inverse.y, slack);
        let z = offsets(origin.z, inverse.z, slack);
        let limit = S::F32x16::load_slice(token, &self.limit[first..]);
        let rows = [inverse.x, inverse.y, inverse.z, x.0, y.0, z.0, t_min, limit];
        let nodes = &mut self.nodes[first..first + STEP];
        let columns = transposed(token, rows);
        for lane in 0..STEP {
            columns[lane].store(&mut nodes[lane].0);
        }
        if self.any_slack {
            let zero = S::F32x16::splat(token, 0.0);
            let columns = transposed(token, [x.1, y.1, z.1, zero, zero, zero, zero, zero]);
            for lane in 0..STEP {
                let mut column = [0.0; 8];
                columns[lane].store(&mut column);
                self.far[first + lane] = [column[0], column[1], column[2]];
            }
        }
        let octant = sign(inverse.x) | sign(inverse.y).shl::<1>() | sign(inverse.z).shl::<2>();
        let mut lanes = [0; STEP];
        octant.store(&mut lanes);
        for (to, lane) in self.octant[first..first + STEP].iter_mut().zip(lanes) {
            *to = lane as u8;
        }
    }
}

/// The vector twin of [`ShearedRay::new`].
#[inline(always)]
fn record_sheared<S: Simd>(token: S, origin: Vec3<S::F32x16>, direction: Vec3<S::F32x16>, records: &mut [Octet]) {
    type Ids<S> = <<S as Simd>::F32x16 as F32Lanes>::U32;
    let (ax, ay, az) = (direction.x.abs(), direction.y.abs(), direction.z.abs());
    let is_z = ax.max(ay).lt(az);
    let is_y = ax.lt(ay);
    let [ox, oy, oz] = renamed_lanes(is_y, is_z, origin);
    let [dx, dy, dz] = renamed_lanes(is_y, is_z, direction);
    let (zero, one, two) = (Ids::<S>::splat(token, 0), Ids::<S>::splat(token, 1), Ids::<S>::splat(token, 2));
    let axis = Ids::<S>::select(is_z, two, Ids::<S>::select(is_y, one, zero));
    let one = S::F32x16::splat(token, 1.0);
    let rows = [ox, oy, oz, dx / dz, dy / dz, one / dz, S::F32x16::from_bits(axis), S::F32x16::from_bits(zero)];
    let columns = transposed(token, rows);
    for lane in 0..STEP {
        columns[lane].store(&mut records[lane].0);
    }
}

/// The vector twin of [`SphereRay::new`].
#[inline(always)]
fn record_spheres<S: Simd>(token: S, origin: Vec3<S::F32x16>, direction: Vec3<S::F32x16>, records: &mut [Octet]) {
    let inverse = S::F32x16::splat(token, 1.0) / direction.length_squared();
    let (o, d) = (origin, direction);
    let rows = [o.x, o.y, o.z, d.x, d.y, d.z, inverse, S::F32x16::splat(token, 0.0)];
    let columns = transposed(token, rows);
    for lane in 0..STEP {
        columns[lane].store(&mut records[lane].0);
    }
}

/// One record for each lane of eight rows.
#[inline(always)]
pub(in crate::tree) fn transposed<S: Simd>(token: S, rows: [S::F32x16; 8]) -> [S::F32x8; STEP] {
    const HALF: usize = STEP / 2;
    let mut stored = [[0.0; STEP]; 8];
    let mut halves = [[S::F32x8::splat(token, 0.0); 8]; 2];
    for row in 0..8 {
        rows[row].store(&mut stored[row]);
        halves[0][row] = S::F32x8::load_slice(token, &stored[row]);
        halves[1][row] = S::F32x8::load_slice(token, &stored[row][HALF..]);
    }
    let (low, high) = (token.transpose(halves[0]), token.transpose(halves[1]));
    let mut columns = [low[0]; STEP];
    columns[..HALF].copy_from_slice(&low);
    columns[HALF..].copy_from_slice(&high);
    columns
}

/// Chunks with more rays get room for the largest: growing aligned memory copies it, and fresh pages cost a picture 3 %.
const SMALL: usize = 1024;

/// Make room for `len` elements. Those of the chunk before mean nothing.
fn grow<T: Clone + Default>(elements: &mut Vec<T>, len: usize) {
    if elements.capacity() < len {
        *elements = Vec::with_capacity(if len > SMALL { CHUNK } else { len });
    }
    if elements.len() < len {
        elements.resize(len, T::default());
    }
}

/// The sign bit as 0 or 1.
#[inline(always)]
pub(in crate::tree) fn sign<F: F32Lanes>(component: F) -> F::U32 {
    component.to_bits().shr::<31>()
}

/// The components as [`renamed`](crate::geometry::triangle::renamed) has them: z y x where x dominates, x z y where y does.
#[inline(always)]
fn renamed_lanes<F: F32Lanes>(is_y: F::Mask, is_z: F::Mask, v: Vec3<F>) -> [F; 3] {
    [
        F::select(is_y | is_z, v.x, v.z),
        F::select(is_y & !is_z, v.z, v.y),
        F::select(is_z, v.z, F::select(is_y, v.y, v.x)),
    ]
}

/// The offsets of a ray for the planes where it enters and where it leaves.
#[inline(always)]
pub(super) fn offsets<F: F32Lanes>(origin: F, inverse: F, slack: F) -> (F, F) {
    let offset = -(origin * inverse);
    let reach = inverse.abs() * slack;
    (offset - reach, offset + reach)
}

/// `1 / component`, clamped to ±2⁸⁰ with the component's sign.
#[inline(always)]
pub(super) fn reciprocal<F: F32Lanes>(token: F::Token, component: F) -> F {
    let sign = component.to_bits() & F::U32::splat(token, 1 << 31);
    let clamped = F::from_bits(F::splat(token, MAX_RECIPROCAL).to_bits() | sign);
    let small = component.abs().lt(F::splat(token, MIN_COMPONENT));
    F::select(small, clamped, F::splat(token, 1.0) / component)
}
