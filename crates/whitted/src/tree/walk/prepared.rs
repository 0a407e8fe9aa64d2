//! A chunk of rays in the forms that nodes and leaves want.

mod one;
mod records;

pub(super) use one::OneRay;
pub(super) use records::Records;
pub(in crate::tree) use records::{sign, transposed};

use super::frustum::PACKET;
use crate::geometry::sphere::{SphereRay, SphereRays};
use crate::geometry::triangle::ShearedRays;
use crate::geometry::{Primitives, ShearedRay};
use crate::math::Vec3;
use crate::ray::{NONE, Ray, Rays, lanes};
use crate::tree::Tree;
use crate::tree::query::CHUNK;
use simd::{F32Lanes, Kernel, Level, MaskLanes, Octet, Simd, U32Lanes};
use std::ops::Range;

/// What the box test of a node needs of a ray.
///
/// A plane at `p` is met at `p·inverse + offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeRay<'a>(&'a Octet);

impl NodeRay<'_> {
    const LIMIT: usize = 7;

    /// Reciprocal direction, clamped: never infinite.
    #[inline(always)]
    pub(super) fn inverse(self) -> [f32; 3] {
        let [x, y, z, ..] = self.0.0;
        [x, y, z]
    }

    /// `−origin·inverse`, for the planes where the ray enters made smaller by the slack.
    #[inline(always)]
    pub(super) fn near(self) -> [f32; 3] {
        let [_, _, _, x, y, z, ..] = self.0.0;
        [x, y, z]
    }

    /// Lower end of the range.
    #[inline(always)]
    pub(super) fn t_min(self) -> f32 {
        self.0.0[6]
    }

    /// Upper end of the range so far; negative infinity when the ray has ended.
    #[inline(always)]
    pub(super) fn limit(self) -> f32 {
        self.0.0[Self::LIMIT]
    }
}

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
    /// See [`NodeRay`].
    nodes: Vec<Octet>,
    /// As `NodeRay::near`, for the planes where the ray leaves: made larger by the slack. Only where there is any.
    far: Vec<[f32; 3]>,
    /// Signs of the direction: bit a is set if component a is negative.
    pub(super) octant: Vec<u8>,
    sheared: Vec<Octet>,
    spheres: Vec<Octet>,
    original: Vec<Ray>,
    /// True if a ray starts so far away that the boxes' padding does not cover its rounding.
    any_slack: bool,
}

/// A set of the smallest packets of a chunk.
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
        simd::dispatch(level, Begin { prepared: self, tree, rays, range });
    }

    /// Take the only ray of a chunk when it has been walked by itself, up to `limit`.
    pub(in crate::tree) fn walked_alone(&mut self, limit: f32) {
        self.len = 1;
        self.recorded = Packets::default();
        self.limit.clear();
        self.limit.push(limit);
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
        self.nodes[index].0[NodeRay::LIMIT] = limit;
    }

    /// A ray in the form for nodes.
    #[inline(always)]
    pub(super) fn node(&self, index: usize) -> NodeRay<'_> {
        NodeRay(&self.nodes[index])
    }

    /// The offsets of a ray for the planes where it leaves.
    #[inline(always)]
    pub(super) fn far(&self, index: usize) -> [f32; 3] {
        if self.any_slack { self.far[index] } else { self.node(index).near() }
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
        let low = first_halves(token, rays);
        let high = low + U32::<S>::splat(token, 1);
        let [ox, oy, oz, dx] = S::F32x16::gather_x4(Octet::halves(&self.spheres), low);
        let [dy, dz, inverse_length_squared, _] = S::F32x16::gather_x4(Octet::halves(&self.spheres), high);
        let [_, _, t_min, limit] = S::F32x16::gather_x4(Octet::halves(&self.nodes), high);
        (SphereRays { origin: [ox, oy, oz], direction: [dx, dy, dz], inverse_length_squared }, [t_min, limit])
    }

    /// Sixteen rays in the form for triangles, their dominant axes, and the ends of their ranges so far.
    #[inline(always)]
    pub(super) fn sheared_x16<S: Simd>(
        &self,
        token: S,
        rays: &[u16; STEP],
    ) -> (ShearedRays<S::F32x16>, U32<S>, [S::F32x16; 2]) {
        let low = first_halves(token, rays);
        let high = low + U32::<S>::splat(token, 1);
        let [ox, oy, oz, sx] = S::F32x16::gather_x4(Octet::halves(&self.sheared), low);
        let [sy, sz, axis, _] = S::F32x16::gather_x4(Octet::halves(&self.sheared), high);
        let [_, _, t_min, limit] = S::F32x16::gather_x4(Octet::halves(&self.nodes), high);
        (ShearedRays { origin: [ox, oy, oz], shear: [sx, sy, sz] }, axis.to_bits(), [t_min, limit])
    }

    /// Upper ends of the ranges of sixteen rays of one packet.
    #[inline(always)]
    fn limits_x16<S: Simd>(&self, token: S, first: usize) -> S::F32x16 {
        if !self.is_recorded(first / PACKET) {
            return S::F32x16::load_slice(token, &self.limit[first..]);
        }
        let mut rays = [first as u16; STEP];
        for lane in 0..STEP {
            rays[lane] += lane as u16;
        }
        let high = first_halves(token, &rays) + U32::<S>::splat(token, 1);
        let [.., limit] = S::F32x16::gather_x4(Octet::halves(&self.nodes), high);
        limit
    }

    /// A ray as the caller gave it; only where there are shapes or planes.
    pub(super) fn ray(&self, index: usize) -> Ray {
        self.original[index]
    }

    /// Write the t of each ray that found a primitive.
    pub(in crate::tree) fn found(&self, level: Level, primitive: &[u32], t: &mut [f32]) {
        match self.len {
            1 => self.found_one(0, primitive, t),
            _ => simd::dispatch(level, Found { prepared: self, primitive, t }),
        }
    }

    fn found_one(&self, index: usize, primitive: &[u32], t: &mut [f32]) {
        if primitive[index] != NONE {
            let recorded = self.is_recorded(index / PACKET);
            t[index] = if recorded { self.node(index).limit() } else { self.limit[index] };
        }
    }
}

/// Rays in a step of the kernels here.
const STEP: usize = 16;

type U32<S> = <<S as Simd>::F32x16 as F32Lanes>::U32;

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

/// Writes the t of rays that found a primitive.
struct Found<'a> {
    prepared: &'a PreparedRays,
    primitive: &'a [u32],
    t: &'a mut [f32],
}

impl Kernel for Found<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { prepared, primitive, t } = self;
        let none = U32::<S>::splat(token, NONE);
        let whole = prepared.len / STEP * STEP;
        for first in (0..whole).step_by(STEP) {
            let found = !U32::<S>::load_slice(token, &primitive[first..]).eq(none);
            if found.any() {
                let t = &mut t[first..first + STEP];
                let limit = prepared.limits_x16(token, first);
                S::F32x16::select(found, limit, S::F32x16::load_slice(token, t)).store_slice(t);
            }
        }
        for index in whole..prepared.len {
            prepared.found_one(index, primitive, t);
        }
    }
}

/// Where the records of rays begin among the halves of all.
#[inline(always)]
fn first_halves<S: Simd>(token: S, rays: &[u16; STEP]) -> U32<S> {
    let mut wide = [0; STEP];
    for lane in 0..STEP {
        wide[lane] = u32::from(rays[lane]);
    }
    U32::<S>::load(token, &wide).shl::<1>()
}

/// The largest absolute coordinate.
#[inline(always)]
fn distance<F: F32Lanes>(origin: Vec3<F>) -> F {
    origin.x.abs().max(origin.y.abs()).max(origin.z.abs())
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

/// The vectors of a step of rows; 0 beyond its end.
#[inline(always)]
pub(in crate::tree) fn load<S: Simd>(token: S, rows: Vec3<&[f32]>, range: Range<usize>) -> Vec3<S::F32x16> {
    Vec3::new(lanes(token, rows.x, range.clone()), lanes(token, rows.y, range.clone()), lanes(token, rows.z, range))
}
