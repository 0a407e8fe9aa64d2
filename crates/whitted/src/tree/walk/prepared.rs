//! A chunk of rays in the forms that nodes and leaves want.

mod one;

use super::frustum::PACKET;
use crate::geometry::sphere::{SphereRay, SphereRays};
use crate::geometry::{Primitives, ShearedRay};
use crate::math::Vec3;
use crate::ray::{NONE, Ray, Rays, lanes};
use crate::tree::Tree;
use crate::tree::query::CHUNK;
use simd::{F32Lanes, Kernel, Level, MaskLanes, Simd, U32Lanes};
use std::ops::Range;

/// Eight numbers about a ray: half a cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
struct Record([f32; 8]);

/// What the box test of a node needs of a ray.
///
/// A plane at `p` is met at `p·inverse + offset`.
#[derive(Clone, Copy, Debug, Default)]
#[repr(transparent)]
pub(super) struct NodeRay(Record);

impl NodeRay {
    const LIMIT: usize = 7;

    /// Reciprocal direction, clamped: never infinite.
    #[inline(always)]
    pub(super) fn inverse(&self) -> [f32; 3] {
        let [x, y, z, ..] = self.0.0;
        [x, y, z]
    }

    /// `−origin·inverse`, for the planes where the ray enters made smaller by the slack.
    #[inline(always)]
    pub(super) fn near(&self) -> [f32; 3] {
        let [_, _, _, x, y, z, ..] = self.0.0;
        [x, y, z]
    }

    /// Lower end of the range.
    #[inline(always)]
    pub(super) fn t_min(&self) -> f32 {
        self.0.0[6]
    }

    /// Upper end of the range so far; negative infinity when the ray has ended.
    #[inline(always)]
    pub(super) fn limit(&self) -> f32 {
        self.0.0[Self::LIMIT]
    }
}

/// Components of the direction smaller than this count as this: keeps reciprocals finite and 0·∞ out of the slabs.
const MIN_COMPONENT: f32 = 1.0 / MAX_RECIPROCAL;
const MAX_RECIPROCAL: f32 = (1u128 << 80) as f32;
/// Rays whose direction, in the tree's scale and by the sum of its components' sizes, is not within these bounds hit
/// nothing.
const MAX_DIRECTION: f32 = (1u64 << 62) as f32;
const MIN_DIRECTION: f32 = 1.0 / MAX_DIRECTION;

/// A chunk of rays, prepared: ranges at once, the rest for those rays only that are not walked in packets.
#[derive(Debug, Default)]
pub(in crate::tree) struct PreparedRays {
    len: usize,
    /// Upper ends of the ranges so far, until a ray has its record.
    limit: Vec<f32>,
    /// The packets whose rays have their records.
    recorded: Packets,
    pub(super) nodes: Vec<NodeRay>,
    /// As `NodeRay::near`, for the planes where the ray leaves: made larger by the slack. Only where there is any.
    far: Vec<[f32; 3]>,
    /// Signs of the direction: bit a is set if component a is negative.
    pub(super) octant: Vec<u8>,
    sheared: Vec<Record>,
    spheres: Vec<Record>,
    original: Vec<Ray>,
    /// True if a ray starts so far away that the boxes' padding does not cover its rounding.
    any_slack: bool,
}

/// A set of packets of a chunk.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Packets([u64; Self::WORDS]);

impl Packets {
    const WORDS: usize = CHUNK / PACKET / u64::BITS as usize;

    #[inline(always)]
    pub(super) fn insert(&mut self, packet: usize) {
        let (word, bit) = Self::place(packet);
        self.0[word] |= 1 << bit;
    }

    #[inline(always)]
    pub(super) fn contains(&self, packet: usize) -> bool {
        let (word, bit) = Self::place(packet);
        self.0[word] >> bit & 1 != 0
    }

    #[inline(always)]
    fn place(packet: usize) -> (usize, usize) {
        let bits = u64::BITS as usize;
        (packet / bits % Self::WORDS, packet % bits)
    }
}

impl PreparedRays {
    /// Take the ranges of the rays `range` of `rays`.
    pub(in crate::tree) fn begin(
        &mut self,
        level: Level,
        tree: &Tree,
        primitives: &Primitives,
        rays: Rays<'_>,
        range: Range<usize>,
    ) {
        self.len = range.len();
        self.recorded = Packets::default();
        self.original.clear();
        if !(primitives.shapes().is_empty() && primitives.planes().is_empty()) {
            self.original.extend(range.clone().map(|index| rays.get(index)));
        }
        self.limit.resize(range.len().next_multiple_of(STEP), f32::NEG_INFINITY);
        match range.len() {
            1 => self.begin_one(tree, &rays.get(range.start)),
            _ => simd::dispatch(level, Begin { prepared: self, tree, rays, range }),
        }
    }

    /// Number of rays.
    pub(in crate::tree) fn len(&self) -> usize {
        self.len
    }

    /// True if a ray starts so far away that the boxes' padding does not cover its rounding.
    #[inline(always)]
    pub(super) fn any_slack(&self) -> bool {
        self.any_slack
    }

    /// The rays of packet `packet`.
    pub(super) fn packet(&self, packet: usize) -> Range<usize> {
        packet * PACKET..self.len.min((packet + 1) * PACKET)
    }

    /// Number of packets, the last of which may be short.
    pub(super) fn packets(&self) -> usize {
        self.len.div_ceil(PACKET)
    }

    /// True if the rays of packet `packet` have their records.
    #[inline(always)]
    pub(super) fn is_recorded(&self, packet: usize) -> bool {
        self.recorded.contains(packet)
    }

    /// Upper end so far of the range of a ray without a record.
    #[inline(always)]
    pub(in crate::tree) fn limit(&self, index: usize) -> f32 {
        self.limit[index]
    }

    /// Shorten a ray without a record.
    #[inline(always)]
    pub(in crate::tree) fn set_limit(&mut self, index: usize, limit: f32) {
        self.limit[index] = limit;
    }

    /// Upper ends of the ranges of consecutive rays without records.
    #[inline(always)]
    pub(super) fn limits(&self, first: usize) -> &[f32; PACKET] {
        self.limit[first..].first_chunk().expect("a whole packet")
    }

    /// See [`limits`](Self::limits).
    #[inline(always)]
    pub(super) fn limits_mut(&mut self, first: usize) -> &mut [f32; PACKET] {
        self.limit[first..].first_chunk_mut().expect("a whole packet")
    }

    /// Shorten a ray with a record.
    #[inline(always)]
    pub(super) fn shorten(&mut self, index: usize, limit: f32) {
        self.nodes[index].0.0[NodeRay::LIMIT] = limit;
    }

    /// The offsets of a ray for the planes where it leaves.
    #[inline(always)]
    pub(super) fn far(&self, index: usize) -> [f32; 3] {
        if self.any_slack { self.far[index] } else { self.nodes[index].near() }
    }

    /// A ray in the form for triangles, in the tree's scale; only where there are triangles.
    #[inline(always)]
    pub(super) fn sheared(&self, index: usize) -> ShearedRay {
        let [ox, oy, oz, sx, sy, sz, axis, _] = self.sheared[index].0;
        ShearedRay::from_parts([ox, oy, oz], [sx, sy, sz], axis.to_bits())
    }

    /// A ray in the form for spheres, in the tree's scale; only where there are spheres.
    #[inline(always)]
    pub(super) fn sphere(&self, index: usize) -> SphereRay {
        let [ox, oy, oz, dx, dy, dz, inverse, _] = self.spheres[index].0;
        SphereRay::from_parts([ox, oy, oz], [dx, dy, dz], inverse)
    }

    /// Sixteen rays in the form for spheres, and the ends of their ranges so far.
    #[inline(always)]
    pub(super) fn spheres_x16<S: Simd>(&self, token: S, rays: &[u16; STEP]) -> (SphereRays<S::F32x16>, [S::F32x16; 2]) {
        let zero = S::F32x4::splat(token, 0.0);
        let (mut first, mut second, mut range) = ([zero; STEP], [zero; STEP], [zero; STEP]);
        for lane in 0..STEP {
            let ray = usize::from(rays[lane]);
            let (low, high) = self.spheres[ray].0.split_at(4);
            first[lane] = S::F32x4::load_slice(token, low);
            second[lane] = S::F32x4::load_slice(token, high);
            range[lane] = S::F32x4::load_slice(token, &self.nodes[ray].0.0[4..]);
        }
        let [ox, oy, oz, dx] = token.columns_x16(first);
        let [dy, dz, inverse_length_squared, _] = token.columns_x16(second);
        let [_, _, t_min, limit] = token.columns_x16(range);
        (SphereRays { origin: [ox, oy, oz], direction: [dx, dy, dz], inverse_length_squared }, [t_min, limit])
    }

    /// A ray as the caller gave it; only where there are shapes or planes.
    pub(super) fn ray(&self, index: usize) -> Ray {
        self.original[index]
    }

    /// Write the t of each ray that found a primitive.
    pub(in crate::tree) fn found(&self, primitive: &[u32], t: &mut [f32]) {
        for packet in 0..self.packets() {
            let recorded = self.is_recorded(packet);
            for index in self.packet(packet) {
                let limit = if recorded { self.nodes[index].limit() } else { self.limit[index] };
                t[index] = if primitive[index] == NONE { t[index] } else { limit };
            }
        }
    }
}

/// Rays in a step of the kernels here.
const STEP: usize = 16;

const _: () = assert!(PACKET.is_multiple_of(STEP), "a packet is whole steps");

/// Takes ranges.
struct Begin<'a> {
    prepared: &'a mut PreparedRays,
    tree: &'a Tree,
    rays: Rays<'a>,
    range: Range<usize>,
}

impl Kernel for Begin<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { prepared, tree, rays, range } = self;
        let scale = S::F32x16::splat(token, tree.scale());
        let mut farthest = S::F32x16::splat(token, 0.0);
        for (start, limits) in range.clone().step_by(STEP).zip(prepared.limit.chunks_exact_mut(STEP)) {
            let step = start..range.end.min(start + STEP);
            let origin = load(token, rays.origin, step.clone()) * scale;
            let direction = load(token, rays.direction, step.clone()) * scale;
            let ended = S::F32x16::splat(token, f32::NEG_INFINITY);
            let sound = sound(token, origin, direction);
            S::F32x16::select(sound, rays.t_max.lanes(token, step), ended).store_slice(limits);
            // Takes the distance where it is a number.
            farthest = distance(origin).max(farthest);
        }
        prepared.any_slack = S::F32x16::splat(token, 0.0).lt(tree.slack(token, farthest)).any();
    }
}

/// Makes the records of one packet.
pub(super) struct Records<'a> {
    pub tree: &'a Tree,
    pub primitives: &'a Primitives,
    pub rays: Rays<'a>,
    /// The ray of the batch that is the first of the chunk.
    pub start: usize,
}

impl PreparedRays {
    /// Make room for records.
    pub(super) fn reserve_records(&mut self, primitives: &Primitives) {
        let len = self.len.next_multiple_of(STEP);
        let room_for = |used: bool| if used { len } else { 0 };
        self.nodes.resize(len, NodeRay::default());
        self.octant.resize(len, 0);
        self.far.resize(room_for(self.any_slack), [0.0; 3]);
        self.sheared.resize(room_for(primitives.triangle_count() > 0), Record::default());
        self.spheres.resize(room_for(!primitives.spheres().is_empty()), Record::default());
    }

    /// Make the records of packet `packet`.
    #[inline(always)]
    pub(super) fn record<S: Simd>(&mut self, token: S, from: &Records<'_>, packet: usize) {
        if self.len == 1 {
            return self.record_one(from);
        }
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
            columns[lane].store(&mut nodes[lane].0.0);
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
fn record_sheared<S: Simd>(token: S, origin: Vec3<S::F32x16>, direction: Vec3<S::F32x16>, records: &mut [Record]) {
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
fn record_spheres<S: Simd>(token: S, origin: Vec3<S::F32x16>, direction: Vec3<S::F32x16>, records: &mut [Record]) {
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
fn transposed<S: Simd>(token: S, rows: [S::F32x16; 8]) -> [S::F32x8; STEP] {
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

/// The sign bit as 0 or 1.
#[inline(always)]
fn sign<F: F32Lanes>(component: F) -> F::U32 {
    component.to_bits().shr::<31>()
}

/// The largest absolute coordinate.
#[inline(always)]
fn distance<F: F32Lanes>(origin: Vec3<F>) -> F {
    origin.x.abs().max(origin.y.abs()).max(origin.z.abs())
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
pub(crate) fn sound<F: F32Lanes>(token: F::Token, origin: Vec3<F>, direction: Vec3<F>) -> F::Mask {
    // A sum of sizes is NaN if a component is, and infinite if one is.
    let reach = origin.x.abs() + origin.y.abs() + origin.z.abs();
    let size = direction.x.abs() + direction.y.abs() + direction.z.abs();
    let sound_size = F::splat(token, MIN_DIRECTION).le(size) & size.le(F::splat(token, MAX_DIRECTION));
    sound_size & reach.lt(F::splat(token, f32::INFINITY))
}

#[inline(always)]
fn load<S: Simd>(token: S, rows: Vec3<&[f32]>, range: Range<usize>) -> Vec3<S::F32x16> {
    Vec3::new(lanes(token, rows.x, range.clone()), lanes(token, rows.y, range.clone()), lanes(token, rows.z, range))
}
