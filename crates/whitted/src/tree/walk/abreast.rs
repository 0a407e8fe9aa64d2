//! Sixteen rays of a list abreast, against one primitive of a leaf after the other.
//!
//! One ray against a block of eight has to ask whether it hit anything, and of two rays one usually did: half of these
//! jumps are guessed wrong. Rays abreast only choose, lane by lane, and are asked once, when the leaf is done. Sixteen
//! lanes also do twice the work of a block's eight.

use super::Walk;
use crate::geometry::triangle::{self, ShearedRays};
use crate::geometry::{sphere, splat};
use crate::ray::NONE;
use crate::tree::goal::Goal;
use crate::tree::leaf::{BLOCK, SphereBlock, TriangleBlock};
use simd::{F32Lanes, MaskLanes, Simd, U32Lanes};

/// Rays abreast.
pub(super) const LANES: usize = 16;

/// Fewer rays than this are faster one by one: measured are 2, 3, 4, 6 and 8 against spheres, 6 to 16 against triangles;
/// 6, 8 and 10 are alike.
pub(super) const MIN_RAYS: usize = 8;

type U32<S> = <<S as Simd>::F32x16 as F32Lanes>::U32;

/// Some rays of a list and what they have found in the leaf at hand.
struct Abreast<S: Simd> {
    /// Their numbers; lanes beyond the last ray repeat the first and hit nothing.
    ids: [u16; LANES],
    /// Ends of their ranges, before the leaf and now.
    before: S::F32x16,
    limit: S::F32x16,
    /// What is not settled yet, see [`Goal::offer_lanes`].
    found: U32<S>,
}

/// Test up to sixteen rays, given by their numbers, against blocks of spheres.
#[inline(always)]
pub(super) fn spheres<S: Simd, G: Goal>(token: S, walk: &mut Walk<'_, G>, ids: &[u16], blocks: &[SphereBlock]) {
    let padded = padded(ids);
    let (rays, [t_min, limit]) = walk.rays.spheres_x16(token, &padded);
    let mut abreast = Abreast::<S>::new(token, padded, ids.len(), limit);
    for block in blocks {
        for lane in 0..BLOCK {
            let primitive = block.primitive(lane);
            if primitive == NONE {
                break;
            }
            let center = splat(token, block.center(lane));
            let roots = sphere::roots(&rays, center, S::F32x16::splat(token, block.radius_squared(lane)));
            let hit = sphere::first_in_range(roots, t_min, abreast.limit);
            abreast.offer(token, walk.goal, hit, primitive);
            if G::EVERY_CROSSING {
                let far = roots.1;
                abreast.offer(token, walk.goal, (t_min.le(far) & far.le(abreast.limit), far), primitive);
            }
        }
    }
    abreast.finish(token, walk);
}

/// Test up to sixteen rays, given by their numbers, against blocks of triangles.
#[inline(always)]
pub(super) fn triangles<S: Simd, G: Goal>(token: S, walk: &mut Walk<'_, G>, ids: &[u16], blocks: &[TriangleBlock]) {
    let padded = padded(ids);
    let (rays, axis, [t_min, limit]) = walk.rays.sheared_x16(token, &padded);
    let mut abreast = Abreast::<S>::new(token, padded, ids.len(), limit);
    let first = walk.rays.sheared(usize::from(ids[0])).axis;
    if axis.eq(U32::<S>::splat(token, first)).all() {
        let axes = OneAxis(triangle::renamed((first % 3) as usize));
        abreast.against(token, walk.goal, (&rays, t_min), blocks, axes);
    } else {
        let axes = OwnAxes { is_x: axis.eq(U32::<S>::splat(token, 0)), is_y: axis.eq(U32::<S>::splat(token, 1)) };
        abreast.against(token, walk.goal, (&rays, t_min), blocks, axes);
    }
    abreast.finish(token, walk);
}

/// How the rays rename the axes, see [`triangle::renamed`].
trait Axes<S: Simd>: Copy {
    /// The renamed coordinates of a vertex of one triangle, for each ray.
    fn corner(self, token: S, block: &TriangleBlock, vertex: usize, lane: usize) -> [S::F32x16; 3];
}

/// All alike, as often after a flat mirror: nothing is chosen.
#[derive(Clone, Copy)]
struct OneAxis([usize; 3]);

impl<S: Simd> Axes<S> for OneAxis {
    #[inline(always)]
    fn corner(self, token: S, block: &TriangleBlock, vertex: usize, lane: usize) -> [S::F32x16; 3] {
        splat(token, block.corner(vertex, lane, self.0))
    }
}

/// Each its own way, so that each lane chooses among the coordinates: the rays that run mostly along x, along y, the rest.
#[derive(Clone, Copy)]
struct OwnAxes<M> {
    is_x: M,
    is_y: M,
}

impl<S: Simd> Axes<S> for OwnAxes<<S::F32x16 as F32Lanes>::Mask> {
    #[inline(always)]
    fn corner(self, token: S, block: &TriangleBlock, vertex: usize, lane: usize) -> [S::F32x16; 3] {
        let Self { is_x, is_y } = self;
        let [x, y, z]: [S::F32x16; 3] = splat(token, block.corner(vertex, lane, [0, 1, 2]));
        let select = S::F32x16::select;
        [select(is_x, z, x), select(is_y, z, y), select(is_x, x, select(is_y, y, z))]
    }
}

/// The first id for lanes without one.
#[inline(always)]
fn padded(ids: &[u16]) -> [u16; LANES] {
    let mut padded = [ids[0]; LANES];
    padded[..ids.len()].copy_from_slice(ids);
    padded
}

impl<S: Simd> Abreast<S> {
    #[inline(always)]
    fn new(token: S, ids: [u16; LANES], count: usize, limit: S::F32x16) -> Self {
        let used = <S::F32x16 as F32Lanes>::Mask::from_bits(token, (1 << count) - 1);
        let limit = S::F32x16::select(used, limit, S::F32x16::splat(token, f32::NEG_INFINITY));
        Self { ids, before: limit, limit, found: U32::<S>::splat(token, NONE) }
    }

    /// Test the rays against blocks of triangles, one after the other.
    #[inline(always)]
    fn against<G: Goal>(
        &mut self,
        token: S,
        goal: &mut G,
        (rays, t_min): (&ShearedRays<S::F32x16>, S::F32x16),
        blocks: &[TriangleBlock],
        axes: impl Axes<S>,
    ) {
        for block in blocks {
            for lane in 0..BLOCK {
                let primitive = block.primitive(lane);
                if primitive == NONE {
                    break;
                }
                let vertices = [
                    axes.corner(token, block, 0, lane),
                    axes.corner(token, block, 1, lane),
                    axes.corner(token, block, 2, lane),
                ];
                let found = triangle::intersect(token, rays, vertices, t_min, self.limit);
                self.offer(token, goal, found, primitive);
            }
        }
    }

    /// Offer what the rays hit at `t`.
    #[inline(always)]
    fn offer<G: Goal>(
        &mut self,
        token: S,
        goal: &mut G,
        (hit, t): (<S::F32x16 as F32Lanes>::Mask, S::F32x16),
        primitive: u32,
    ) {
        self.limit = goal.offer_lanes(token, &self.ids, hit, t, primitive, self.limit, &mut self.found);
    }

    /// Shorten the rays, and settle what they found.
    #[inline(always)]
    fn finish<G: Goal>(self, token: S, walk: &mut Walk<'_, G>) {
        let (mut limits, mut found) = ([0.0; LANES], [NONE; LANES]);
        self.limit.store(&mut limits);
        self.found.store(&mut found);
        let nothing = self.found.eq(U32::<S>::splat(token, NONE));
        let mut changed = (!nothing | self.limit.lt(self.before)).bits();
        while changed != 0 {
            let lane = changed.trailing_zeros() as usize % LANES;
            changed &= changed - 1;
            let ray = usize::from(self.ids[lane]);
            walk.rays.shorten(ray, limits[lane]);
            if found[lane] != NONE {
                walk.goal.settle(ray, found[lane]);
            }
        }
    }
}
