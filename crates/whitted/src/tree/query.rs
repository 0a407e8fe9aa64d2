//! Asking a tree: batches in, answers out.

use super::all_hits::Sieve;
use super::crossings::CrossingLists;
use super::filter::Filtered;
use super::goal::{Any, Closest, Goal, Next};
use super::policy::{self, Origins, RaySort, Way};
use super::reorder::{self, Reorder};
use super::walk::{self, Lists, PreparedRays};
use super::{BitSet, Filter, Occlusion, Tree, TreeKind, WalkKind, brute_force};
use crate::geometry::{self, Primitives};
use crate::ray::{Hit, HitBatch, HitsMut, NONE, Ray, Rays};
use simd::Level;
use std::ops::{AddAssign, Range};

/// A tree, the primitives that it was built over, and how to walk it.
#[derive(Clone, Copy, Debug)]
pub struct Query<'a> {
    /// The tree.
    pub tree: &'a Tree,
    /// The primitives over which the tree was built, unchanged.
    pub primitives: &'a Primitives,
    /// The instruction set; no answer depends on it.
    pub level: Level,
    /// The walk; no answer depends on it.
    pub walk: WalkKind,
}

/// What the walks did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Primitives tested against a ray.
    pub primitive_tests: u64,
    /// Nodes visited by a ray.
    pub node_steps: u64,
    /// Lists of rays that visited a node together.
    pub lists: u64,
    /// Nodes and leaves that a ray visited by itself, since the list that it was in had become short.
    pub single_steps: u64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.primitive_tests += other.primitive_tests;
        self.node_steps += other.node_steps;
        self.lists += other.lists;
        self.single_steps += other.single_steps;
    }
}

/// Memory of the walks, kept between calls: one for each thread.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(super) rays: PreparedRays,
    pub(super) lists: Lists,
    pub(super) crossings: CrossingLists,
    pub(super) sieve: Sieve,
    reorder: Reorder,
}

/// Rays that are walked together; ray numbers within such a chunk fit 16 bits.
///
/// The more there are, the longer do lists stay long: 16 384 instead of 4096 are worth 2–10 % for mirror and diffuse rays
/// and 10–30 % for random ones, while their records still fit a cache. 32 768 gain nothing more, 65 536 lose.
pub(super) const CHUNK: usize = 16384;

impl Query<'_> {
    /// The first hit of each ray; `hits` becomes as long as `rays`.
    ///
    /// Of several primitives at the same t the one with the lowest number is reported.
    pub fn closest_hit<'r>(&self, rays: impl Into<Rays<'r>>, hits: &mut HitBatch, scratch: &mut Scratch) -> Counts {
        let rays = rays.into();
        hits.resize(rays.len());
        hits.instance.fill(NONE);
        self.closest_hit_into(rays, None, hits.into(), scratch)
    }

    /// As [`closest_hit`](Self::closest_hit), of what the filter lets through, into the caller's own arrays.
    ///
    /// # Panics
    /// If `hits` has not room for exactly as many as there are `rays`.
    pub fn closest_hit_into(
        &self,
        rays: Rays<'_>,
        filter: Option<Filter<'_>>,
        mut hits: HitsMut<'_>,
        scratch: &mut Scratch,
    ) -> Counts {
        assert_eq!(hits.len(), rays.len(), "room for one hit of each ray");
        let mut counts = Counts::default();
        let mut done = 0;
        while done < rays.len() {
            let chunk = self.next_chunk(&counts, done, rays, filter.is_some());
            done = chunk.end;
            if chunk.len() <= CHUNK {
                counts += self.closest_hits(rays, chunk, filter, &mut hits, scratch);
            } else {
                let (_, rest) = hits.reborrow().split_at(chunk.start);
                let (hits, _) = rest.split_at(chunk.len());
                counts += self.closest_hits_in_order(rays.slice(chunk), hits, scratch);
            }
        }
        counts
    }

    /// The rays to be walked next, when the first `done` took `counts`: a chunk as it comes, or more, to be put in order. A
    /// filter knows rays by their numbers, so those that pass one are left in their order.
    fn next_chunk(&self, counts: &Counts, done: usize, rays: Rays<'_>, is_filtered: bool) -> Range<usize> {
        let left = rays.slice(done..rays.len());
        let reorders = self.walk == WalkKind::Auto && !is_filtered && policy::pays_to_reorder(counts, done, left);
        done..done + left.len().min(if reorders { reorder::MOST } else { CHUNK })
    }

    /// The first hits of a chunk.
    fn closest_hits(
        &self,
        rays: Rays<'_>,
        chunk: Range<usize>,
        filter: Option<Filter<'_>>,
        hits: &mut HitsMut<'_>,
        scratch: &mut Scratch,
    ) -> Counts {
        hits.clear(chunk.clone());
        let goal = Closest { primitive: &mut hits.primitive[chunk.clone()] };
        let counts = self.walk_filtered(rays, chunk.clone(), goal, filter, scratch);
        scratch.rays.found(self.level, &hits.primitive[chunk.clone()], &mut hits.t[chunk.clone()]);
        self.refine(rays, hits, chunk);
        counts
    }

    /// The first hits of many chunks whose rays are put in order before.
    fn closest_hits_in_order(&self, rays: Rays<'_>, hits: HitsMut<'_>, scratch: &mut Scratch) -> Counts {
        let mut counts = Counts::default();
        let mut reorder = std::mem::take(&mut scratch.reorder);
        reorder.sort(self.level, rays);
        reorder.hits(self.level, hits, |rays, mut hits| {
            counts += self.closest_hits(rays, 0..rays.len(), None, &mut hits, scratch);
        });
        scratch.reorder = reorder;
        counts
    }

    /// The first hit of one ray that the filter lets through.
    #[inline]
    pub(crate) fn closest_hit_of(&self, ray: &Ray, filter: Option<Filter<'_>>, scratch: &mut Scratch) -> Hit {
        let mut primitive = [NONE];
        let goal = Closest { primitive: &mut primitive };
        match filter {
            None => self.hit_of(ray, goal, scratch),
            Some(filter) => self.hit_of(ray, Filtered { goal, first: 0, filter }, scratch),
        }
    }

    #[inline(always)]
    fn hit_of<G: Goal>(&self, ray: &Ray, mut goal: G, scratch: &mut Scratch) -> Hit {
        let (tree, primitives, goal) = (self.tree, self.primitives, &mut goal);
        if tree.kind() == TreeKind::None {
            let (_, t) = self.try_each(ray, goal, scratch);
            return walk::refined(primitives, ray, t, goal.found(0));
        }
        simd::dispatch(
            self.level,
            walk::HitAlone(walk::Alone { tree, primitives, ray, lists: &mut scratch.lists, goal }),
        )
    }

    /// Whether anything that the filter lets through lies within the range of one ray.
    #[inline]
    pub(crate) fn is_occluded(&self, ray: &Ray, filter: Option<Filter<'_>>, scratch: &mut Scratch) -> bool {
        let mut occlusion = [Occlusion::Clear];
        let mut goal = Any { occlusion: &mut occlusion, opaque: None };
        match filter {
            None => self.walk_one(ray, &mut goal, scratch),
            Some(filter) => self.walk_one(ray, &mut Filtered { goal, first: 0, filter }, scratch),
        };
        occlusion[0] == Occlusion::Blocked
    }

    /// The first hit of each ray that comes after `after`, in the order of (t, primitive); advances `after` to it.
    ///
    /// Start with `(f32::NEG_INFINITY, 0)` and call again with the same slice: each hit of each ray is found once, in
    /// order. The t in `after` is the one by which hits are ordered; `hits` has the refined one.
    ///
    /// # Panics
    /// If `after` is not as long as `rays`.
    pub fn next_hit<'r>(
        &self,
        rays: impl Into<Rays<'r>>,
        after: &mut [(f32, u32)],
        hits: &mut HitBatch,
        scratch: &mut Scratch,
    ) -> Counts {
        let rays = rays.into();
        assert_eq!(after.len(), rays.len(), "one starting point for each ray");
        hits.resize(rays.len());
        let mut counts = Counts::default();
        for chunk in chunks(rays.len()) {
            hits.reset(chunk.clone());
            let primitive = &mut hits.primitive[chunk.clone()];
            let mut goal = Next { primitive, after: &after[chunk.clone()] };
            counts += self.walk(rays, chunk.clone(), &mut goal, scratch);
            scratch.rays.found(self.level, &hits.primitive[chunk.clone()], &mut hits.t[chunk.clone()]);
            for index in chunk.clone() {
                after[index] = (hits.t[index], hits.primitive[index]);
            }
            self.refine(rays, &mut hits.into(), chunk);
        }
        counts
    }

    /// Whether anything lies within the range of each ray; `out` becomes as long as `rays`.
    ///
    /// With `opaque`, primitives outside that set do not block: a ray that touches only such is `Filtered`. Rays are
    /// never reversed.
    pub fn occluded<'r>(
        &self,
        rays: impl Into<Rays<'r>>,
        opaque: Option<&BitSet>,
        out: &mut Vec<Occlusion>,
        scratch: &mut Scratch,
    ) -> Counts {
        let rays = rays.into();
        out.clear();
        out.resize(rays.len(), Occlusion::Clear);
        self.occluded_into(rays, opaque, None, out, scratch)
    }

    /// As [`occluded`](Self::occluded), by what the filter lets through, into the caller's own array.
    ///
    /// # Panics
    /// If `out` has not room for exactly as many as there are `rays`.
    pub fn occluded_into(
        &self,
        rays: Rays<'_>,
        opaque: Option<&BitSet>,
        filter: Option<Filter<'_>>,
        out: &mut [Occlusion],
        scratch: &mut Scratch,
    ) -> Counts {
        assert_eq!(out.len(), rays.len(), "room for one answer to each ray");
        out.fill(Occlusion::Clear);
        let mut counts = Counts::default();
        let mut done = 0;
        while done < rays.len() {
            let chunk = self.next_chunk(&counts, done, rays, filter.is_some());
            done = chunk.end;
            let occlusion = &mut out[chunk.clone()];
            counts += if chunk.len() <= CHUNK {
                self.walk_filtered(rays, chunk, Any { occlusion, opaque }, filter, scratch)
            } else {
                self.occluded_in_order(rays.slice(chunk), opaque, occlusion, scratch)
            };
        }
        counts
    }

    /// Whether anything lies within the ranges of many chunks of rays, which are put in order before.
    fn occluded_in_order(
        &self,
        rays: Rays<'_>,
        opaque: Option<&BitSet>,
        out: &mut [Occlusion],
        scratch: &mut Scratch,
    ) -> Counts {
        let mut counts = Counts::default();
        let mut reorder = std::mem::take(&mut scratch.reorder);
        reorder.sort(self.level, rays);
        reorder.occlusion(self.level, out, |rays, occlusion| {
            occlusion.fill(Occlusion::Clear);
            counts += self.walk(rays, 0..rays.len(), &mut Any { occlusion, opaque }, scratch);
        });
        scratch.reorder = reorder;
        counts
    }

    fn walk_filtered<G: Goal>(
        &self,
        rays: Rays<'_>,
        chunk: Range<usize>,
        mut goal: G,
        filter: Option<Filter<'_>>,
        scratch: &mut Scratch,
    ) -> Counts {
        match filter {
            None => self.walk(rays, chunk, &mut goal, scratch),
            Some(filter) => {
                let mut goal = Filtered { goal, first: chunk.start, filter };
                self.walk(rays, chunk, &mut goal, scratch)
            }
        }
    }

    /// Walk one ray; returns the upper end of its range that is left: the t of what was found.
    #[inline(always)]
    fn walk_one<G: Goal>(&self, ray: &Ray, goal: &mut G, scratch: &mut Scratch) -> (Counts, f32) {
        let (tree, primitives) = (self.tree, self.primitives);
        if tree.kind() == TreeKind::None {
            return self.try_each(ray, goal, scratch);
        }
        simd::dispatch(self.level, walk::Alone { tree, primitives, ray, lists: &mut scratch.lists, goal })
    }

    /// As [`walk_one`](Self::walk_one), where there is no tree.
    #[inline(never)]
    fn try_each<G: Goal>(&self, ray: &Ray, goal: &mut G, scratch: &mut Scratch) -> (Counts, f32) {
        let counts = self.walk(ray.into(), 0..1, goal, scratch);
        (counts, scratch.rays.limit(0))
    }

    /// Walk one chunk: planes first, since they lie outside the tree and shorten the rays, then the tree.
    pub(super) fn walk<G: Goal>(
        &self,
        rays: Rays<'_>,
        chunk: Range<usize>,
        goal: &mut G,
        scratch: &mut Scratch,
    ) -> Counts {
        let first = chunk.start;
        if chunk.len() == 1 && self.tree.kind() != TreeKind::None {
            let (counts, limit) = self.walk_one(&rays.get(first), goal, scratch);
            scratch.rays.walked_alone(limit);
            return counts;
        }
        let Scratch { rays: prepared, lists, .. } = scratch;
        let sort = RaySort { count: chunk.len(), origins: Origins::Unknown };
        prepared.begin(self.level, self.tree, self.primitives, rays, chunk);
        let (tree, primitives) = (self.tree, self.primitives);
        let mut counts = walk::planes(primitives, prepared, goal);
        counts += match policy::choose(self.walk, tree, primitives, &sort).way {
            Way::BruteForce => brute_force::walk(tree, primitives, rays, first, prepared, goal),
            way => {
                let kernel =
                    walk::Walk { tree, primitives, way, batch: rays, start: first, rays: prepared, lists, goal };
                simd::dispatch(self.level, kernel)
            }
        };
        counts
    }

    /// Give every hit of a chunk its t in double precision and its surface coordinates.
    fn refine(&self, rays: Rays<'_>, hits: &mut HitsMut<'_>, chunk: Range<usize>) {
        match self.tree.kind() {
            TreeKind::None => geometry::refine_one_by_one(self.primitives, rays, hits, chunk),
            _ => geometry::refine(self.level, self.primitives, rays, hits, chunk),
        }
    }
}

/// Cut `0..len` into chunks.
pub(super) fn chunks(len: usize) -> impl Iterator<Item = Range<usize>> {
    (0..len).step_by(CHUNK).map(move |start| start..len.min(start + CHUNK))
}
