//! Leaf blocks: primitives of one kind, eight at a time, as rows.

use super::goal::Goal;
use crate::geometry::sphere::{self, SphereRay, SphereRays};
use crate::geometry::triangle::{self, ShearedRays, renamed};
use crate::geometry::{Primitives, ShearedRay};
use crate::ray::NONE;
use simd::{F32Lanes, MaskLanes, Simd};

/// Primitives in a block.
pub(super) const BLOCK: usize = 8;

/// Eight triangles, unused lanes NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// Row `3·vertex + axis`: a ray's renaming of axes is a choice of rows.
    rows: [[f32; BLOCK]; 9],
    primitive: [u32; BLOCK],
}

/// Eight spheres, unused lanes NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct SphereBlock {
    center: [[f32; BLOCK]; 3],
    radius_squared: [f32; BLOCK],
    primitive: [u32; BLOCK],
}

/// Eight primitives that are intersected one by one; unused ones are [`NONE`].
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeBlock {
    primitive: [u32; BLOCK],
}

const _: () = assert!(size_of::<TriangleBlock>() == 320, "five cache lines");
const _: () = assert!(size_of::<SphereBlock>() == 160, "two and a half cache lines");

/// What a leaf's blocks hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LeafKind {
    Triangles,
    Spheres,
    Shapes,
}

/// Blocks that one thread copies anew at least: fewer are not worth a second one.
const MIN_UPDATE: usize = 512;

/// All leaf blocks of a tree.
#[derive(Clone, Debug, Default)]
pub(super) struct Leaves {
    pub triangles: Vec<TriangleBlock>,
    pub spheres: Vec<SphereBlock>,
    pub shapes: Vec<ShapeBlock>,
}

impl Leaves {
    /// Copy the coordinates of all primitives anew, as they are now; those that became degenerate are never hit.
    pub(super) fn update(&mut self, primitives: &Primitives, scale: f32) {
        use rayon::prelude::*;
        self.triangles.par_iter_mut().with_min_len(MIN_UPDATE).for_each(|block| {
            *block = TriangleBlock::new(primitives, scale, used(&block.primitive));
            let lost = lost(primitives, &block.primitive);
            block.rows.iter_mut().for_each(|row| blot_out(row, lost));
        });
        self.spheres.par_iter_mut().with_min_len(MIN_UPDATE).for_each(|block| {
            *block = SphereBlock::new(primitives, scale, used(&block.primitive));
            blot_out(&mut block.radius_squared, lost(primitives, &block.primitive));
        });
    }

    /// The primitives of `count` blocks from `first` on.
    pub(super) fn primitives(&self, kind: LeafKind, first: usize, count: usize) -> impl Iterator<Item = u32> {
        (first..first + count)
            .flat_map(move |block| match kind {
                LeafKind::Triangles => self.triangles[block].primitive,
                LeafKind::Spheres => self.spheres[block].primitive,
                LeafKind::Shapes => self.shapes[block].primitive,
            })
            .filter(|&id| id != NONE)
    }

    /// Bytes of all blocks.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.triangles[..]) + size_of_val(&self.spheres[..]) + size_of_val(&self.shapes[..])
    }
}

/// The numbers before the unused lanes.
fn used(ids: &[u32; BLOCK]) -> &[u32] {
    &ids[..ids.iter().position(|&id| id == NONE).unwrap_or(BLOCK)]
}

/// The lanes whose primitives cannot be hit any more.
fn lost(primitives: &Primitives, ids: &[u32; BLOCK]) -> [bool; BLOCK] {
    ids.map(|id| id != NONE && primitives.primitive_bounds(id).is_none())
}

/// Make NaN what cannot be hit.
fn blot_out(row: &mut [f32; BLOCK], lost: [bool; BLOCK]) {
    for (value, lost) in row.iter_mut().zip(lost) {
        if lost {
            *value = f32::NAN;
        }
    }
}

fn padded_ids(ids: &[u32]) -> [u32; BLOCK] {
    std::array::from_fn(|lane| ids.get(lane).copied().unwrap_or(NONE))
}

impl TriangleBlock {
    /// No triangles.
    pub(super) const EMPTY: Self = Self { rows: [[f32::NAN; BLOCK]; 9], primitive: [NONE; BLOCK] };

    pub(super) fn new(primitives: &Primitives, scale: f32, ids: &[u32]) -> Self {
        let mut rows = [[f32::NAN; BLOCK]; 9];
        for (lane, &id) in ids.iter().enumerate() {
            for (vertex, position) in primitives.triangle(id as usize).vertices.into_iter().enumerate() {
                for axis in 0..3 {
                    rows[3 * vertex + axis][lane] = position[axis] * scale;
                }
            }
        }
        Self { rows, primitive: padded_ids(ids) }
    }

    /// Renamed coordinates of one vertex of one triangle.
    #[inline(always)]
    pub(super) fn corner(&self, vertex: usize, lane: usize, [x, y, z]: [usize; 3]) -> [f32; 3] {
        let rows = &self.rows[3 * vertex..3 * vertex + 3];
        [rows[x][lane], rows[y][lane], rows[z][lane]]
    }

    /// The triangle in a lane.
    #[inline(always)]
    pub(super) fn primitive(&self, lane: usize) -> u32 {
        self.primitive[lane]
    }

    /// Renamed coordinates of one vertex of all triangles.
    #[inline(always)]
    pub(super) fn vertex<S: Simd>(&self, token: S, vertex: usize, [x, y, z]: [usize; 3]) -> [S::F32x8; 3] {
        let rows = &self.rows[3 * vertex..3 * vertex + 3];
        [S::F32x8::load(token, &rows[x]), S::F32x8::load(token, &rows[y]), S::F32x8::load(token, &rows[z])]
    }

    /// Offer the triangles that `ray` hits.
    #[inline(always)]
    pub(super) fn intersect<S: Simd, G: Goal>(
        &self,
        token: S,
        goal: &mut G,
        index: usize,
        ray: &ShearedRay,
        t_min: f32,
        limit: &mut f32,
    ) {
        let axes = renamed((ray.axis % 3) as usize);
        let vertices = [self.vertex(token, 0, axes), self.vertex(token, 1, axes), self.vertex(token, 2, axes)];
        let (t_min, t_max) = (S::F32x8::splat(token, t_min), S::F32x8::splat(token, *limit));
        let (hit, t) = triangle::intersect(token, &ShearedRays::splat(token, ray), vertices, t_min, t_max);
        offer_lanes(goal, index, hit.bits(), t, &self.primitive, limit);
    }
}

impl SphereBlock {
    /// No spheres.
    pub(super) const EMPTY: Self =
        Self { center: [[f32::NAN; BLOCK]; 3], radius_squared: [f32::NAN; BLOCK], primitive: [NONE; BLOCK] };

    pub(super) fn new(primitives: &Primitives, scale: f32, ids: &[u32]) -> Self {
        let mut block =
            Self { center: [[f32::NAN; BLOCK]; 3], radius_squared: [f32::NAN; BLOCK], primitive: padded_ids(ids) };
        for (lane, &id) in ids.iter().enumerate() {
            let sphere = &primitives.spheres()[(id - primitives.first_sphere()) as usize];
            for axis in 0..3 {
                block.center[axis][lane] = sphere.center[axis] * scale;
            }
            let radius = sphere.radius * scale;
            block.radius_squared[lane] = radius * radius;
        }
        block
    }

    /// Centre of the sphere in a lane.
    #[inline(always)]
    pub(super) fn center(&self, lane: usize) -> [f32; 3] {
        [self.center[0][lane], self.center[1][lane], self.center[2][lane]]
    }

    /// Squared radius of the sphere in a lane.
    #[inline(always)]
    pub(super) fn radius_squared(&self, lane: usize) -> f32 {
        self.radius_squared[lane]
    }

    /// The sphere in a lane.
    #[inline(always)]
    pub(super) fn primitive(&self, lane: usize) -> u32 {
        self.primitive[lane]
    }

    /// Centres and squared radii of all spheres.
    #[inline(always)]
    pub(super) fn rows<S: Simd>(&self, token: S) -> ([S::F32x8; 3], S::F32x8) {
        let [x, y, z] = &self.center;
        let center = [S::F32x8::load(token, x), S::F32x8::load(token, y), S::F32x8::load(token, z)];
        (center, S::F32x8::load(token, &self.radius_squared))
    }

    /// Offer the spheres that `ray` hits.
    #[inline(always)]
    pub(super) fn intersect<S: Simd, G: Goal>(
        &self,
        token: S,
        goal: &mut G,
        index: usize,
        ray: &SphereRay,
        t_min: f32,
        limit: &mut f32,
    ) {
        let (center, radius_squared) = self.rows(token);
        let (t_min, t_max) = (S::F32x8::splat(token, t_min), S::F32x8::splat(token, *limit));
        let roots = sphere::roots(&SphereRays::splat(token, ray), center, radius_squared);
        let (hit, t) = sphere::first_in_range(roots, t_min, t_max);
        offer_lanes(goal, index, hit.bits(), t, &self.primitive, limit);
        if G::EVERY_CROSSING {
            let far = roots.1;
            let hit = t_min.le(far) & far.le(t_max);
            offer_lanes(goal, index, hit.bits(), far, &self.primitive, limit);
        }
    }
}

impl ShapeBlock {
    /// No primitives.
    pub(super) const EMPTY: Self = Self { primitive: [NONE; BLOCK] };

    pub(super) fn new(ids: &[u32]) -> Self {
        Self { primitive: padded_ids(ids) }
    }

    /// The primitives, without the unused lanes.
    pub(super) fn ids(&self) -> impl Iterator<Item = u32> {
        self.primitive.into_iter().filter(|&id| id != NONE)
    }
}

/// Offer every lane of `bits` to the goal; the limit shrinks as it accepts.
#[inline(always)]
fn offer_lanes<F: F32Lanes<Array = [f32; BLOCK]>, G: Goal>(
    goal: &mut G,
    index: usize,
    mut bits: u32,
    t: F,
    primitive: &[u32; BLOCK],
    limit: &mut f32,
) {
    if bits == 0 {
        return;
    }
    let mut stored = [0.0; BLOCK];
    t.store(&mut stored);
    while bits != 0 {
        let lane = bits.trailing_zeros() as usize % BLOCK;
        bits &= bits - 1;
        // A lane was measured against the limit before the lanes ahead of it shortened the ray.
        if stored[lane] <= *limit
            && let Some(shorter) = goal.offer(index, stored[lane], primitive[lane], *limit)
        {
            *limit = shorter;
        }
    }
}
