//! Walks: ways to find the leaves that rays meet.
//!
//! All are generic over the instruction set and over the [`Goal`], and all offer the same candidates.

mod abreast;
mod alone;
mod frustum;
mod prepared;
mod slabs;
mod stream;
mod turns;

pub(super) use alone::{Alone, HitAlone, refined};
pub(super) use frustum::PACKET;
pub(super) use prepared::PreparedRays;
pub(crate) use prepared::sound;
use prepared::{Packets, Records};
pub(super) use prepared::{load, sign, transposed};
pub(super) use stream::Lists;

use super::Tree;
use super::goal::Goal;
use super::leaf::{LeafKind, ShapeBlock};
use super::policy::Way;
use super::query::Counts;
use crate::geometry::sphere::SphereRay;
use crate::geometry::{Crossings, Primitives, ShearedRay};
use crate::ray::{Ray, Rays};
use simd::{Kernel, Simd};
use std::ops::Range;

/// One chunk of rays on its way through a tree: the kernel that is dispatched.
pub(super) struct Walk<'a, G> {
    pub tree: &'a Tree,
    pub primitives: &'a Primitives,
    pub way: Way,
    /// The rays as the caller gave them: those of this chunk begin at `start`.
    pub batch: Rays<'a>,
    pub start: usize,
    pub rays: &'a mut PreparedRays,
    pub lists: &'a mut Lists,
    pub goal: &'a mut G,
}

impl<G: Goal> Kernel for Walk<'_, G> {
    type Output = Counts;

    #[inline(always)]
    fn run<S: Simd>(mut self, token: S) -> Counts {
        let mut counts = Counts::default();
        let walked = self.packets(token, &mut counts);
        self.record(token, walked);
        let together = if self.way == Way::OneByOne { 1 } else { usize::MAX };
        stream::walk(token, &mut self, together, &mut counts);
        counts
    }
}

impl<G: Goal> Walk<'_, G> {
    /// Walk what makes packets; returns them as bits. The rest needs records.
    #[inline(always)]
    fn packets<S: Simd>(&mut self, token: S, counts: &mut Counts) -> Packets {
        if self.way != Way::Packets {
            return Packets::default();
        }
        let mut walked = Packets::default();
        let mut stack = std::mem::take(&mut self.lists.stack);
        let mut packet = self.lists.packet.take().unwrap_or_default();
        packet.begin();
        let mut first = 0;
        while first + PACKET <= self.rays.len() {
            first += frustum::walk(token, self, &mut stack, &mut packet, first, &mut walked, counts);
        }
        self.lists.packet = Some(packet);
        self.lists.stack = stack;
        walked
    }

    /// Whether the first and the last ray start at one point; then so do most, likely.
    fn has_one_origin(&self) -> bool {
        let (first, last) = (self.batch.get(self.start), self.batch.get(self.start + self.rays.len() - 1));
        first.origin == last.origin
    }

    /// Make the records of all rays but those in the packets `walked`.
    #[inline(always)]
    fn record<S: Simd>(&mut self, token: S, walked: Packets) {
        self.rays.reserve_records(self.primitives);
        let from = Records { tree: self.tree, primitives: self.primitives, rays: self.batch, start: self.start };
        for packet in 0..self.rays.packets() {
            if !walked.contains(packet) {
                self.rays.record(token, &from, packet);
            }
        }
    }

    /// Test up to sixteen rays of a list, given by their numbers, against the blocks of a leaf.
    #[inline(always)]
    fn leaf_of_list<S: Simd>(
        &mut self,
        token: S,
        ids: &[u16],
        kind: LeafKind,
        first: usize,
        count: usize,
        counts: &mut Counts,
    ) {
        if ids.len() >= abreast::MIN_RAYS && kind != LeafKind::Shapes {
            counts.primitive_tests += (ids.len() * count * super::leaf::BLOCK) as u64;
            let (leaves, blocks) = (&self.tree.leaves, first..first + count);
            return match kind {
                LeafKind::Triangles => abreast::triangles(token, self, ids, &leaves.triangles[blocks]),
                _ => abreast::spheres(token, self, ids, &leaves.spheres[blocks]),
            };
        }
        for &id in ids {
            self.leaf(token, usize::from(id), kind, first, count, counts);
        }
    }

    /// Test one ray against the blocks of a leaf.
    #[inline(always)]
    fn leaf<S: Simd>(
        &mut self,
        token: S,
        index: usize,
        kind: LeafKind,
        first: usize,
        count: usize,
        counts: &mut Counts,
    ) {
        let mut limit = self.rays.node(index).limit();
        let ray = OfMany { rays: self.rays, index };
        let blocks = first..first + count;
        let query = LeafQuery { tree: self.tree, primitives: self.primitives, goal: self.goal, index };
        intersect_leaf(token, query, kind, blocks, &ray, &mut limit, counts);
        self.rays.shorten(index, limit);
    }
}

/// A ray in the forms that leaves want.
trait LeafRay {
    /// Lower end of the range.
    fn t_min(&self) -> f32;
    /// In the tree's scale; only where there are triangles.
    fn sheared(&self) -> ShearedRay;
    /// In the tree's scale; only where there are spheres.
    fn sphere(&self) -> SphereRay;
    /// As the caller gave it; only where there are shapes.
    fn original(&self) -> Ray;
}

/// A ray of a chunk.
struct OfMany<'a> {
    rays: &'a PreparedRays,
    index: usize,
}

impl LeafRay for OfMany<'_> {
    #[inline(always)]
    fn t_min(&self) -> f32 {
        self.rays.node(self.index).t_min()
    }

    #[inline(always)]
    fn sheared(&self) -> ShearedRay {
        self.rays.sheared(self.index)
    }

    #[inline(always)]
    fn sphere(&self) -> SphereRay {
        self.rays.sphere(self.index)
    }

    fn original(&self) -> Ray {
        self.rays.ray(self.index)
    }
}

/// Where the leaves and what is in them are, and who asks.
struct LeafQuery<'a, G> {
    tree: &'a Tree,
    primitives: &'a Primitives,
    goal: &'a mut G,
    /// The number by which the goal knows the ray.
    index: usize,
}

/// Test one ray against the blocks of a leaf.
#[inline(always)]
fn intersect_leaf<S: Simd, G: Goal>(
    token: S,
    query: LeafQuery<'_, G>,
    kind: LeafKind,
    blocks: Range<usize>,
    ray: &impl LeafRay,
    limit: &mut f32,
    counts: &mut Counts,
) {
    counts.primitive_tests += (blocks.len() * super::leaf::BLOCK) as u64;
    let LeafQuery { tree, primitives, goal, index } = query;
    match kind {
        LeafKind::Triangles => {
            let (t_min, ray) = (ray.t_min(), ray.sheared());
            for block in &tree.leaves.triangles[blocks] {
                block.intersect(token, goal, index, &ray, t_min, limit);
            }
        }
        LeafKind::Spheres => {
            let (t_min, ray) = (ray.t_min(), ray.sphere());
            for block in &tree.leaves.spheres[blocks] {
                block.intersect(token, goal, index, &ray, t_min, limit);
            }
        }
        // A ray from so far away that its offsets overflow enters unused lanes too, whose leaf has no blocks.
        LeafKind::Shapes => {
            let blocks = tree.leaves.shapes.get(blocks).unwrap_or_default();
            shapes(primitives, goal, index, blocks, &ray.original(), limit);
        }
    }
}

/// Test one ray against the primitives of shape blocks, one by one.
#[inline(never)]
fn shapes<G: Goal>(
    primitives: &Primitives,
    goal: &mut G,
    index: usize,
    blocks: &[ShapeBlock],
    ray: &Ray,
    limit: &mut f32,
) {
    for id in blocks.iter().flat_map(|block| block.ids()) {
        let shape = &primitives.shapes()[(id - primitives.first_shape()) as usize];
        let crossings = shape.crossings(ray.origin.to_f64(), ray.direction.to_f64());
        offer_crossings(goal, index, id, crossings, ray.t_min, limit);
    }
}

/// Offer crossings, rounded to `f32`, from `t_min` on: the first, or all if the goal wants every one.
pub(crate) fn offer_crossings<G: Goal>(
    goal: &mut G,
    index: usize,
    id: u32,
    crossings: Crossings,
    t_min: f32,
    limit: &mut f32,
) {
    let in_range = crossings.as_slice().iter().map(|&t| t as f32).filter(|&t| t_min <= t);
    for t in in_range.take(if G::EVERY_CROSSING { usize::MAX } else { 1 }) {
        if t <= *limit
            && let Some(shorter) = goal.offer(index, t, id, *limit)
        {
            *limit = shorter;
        }
    }
}

/// Offer the unbounded planes, which are in no tree.
pub(super) fn planes<G: Goal>(primitives: &Primitives, rays: &mut PreparedRays, goal: &mut G) -> Counts {
    let mut counts = Counts::default();
    if !primitives.planes().is_empty() {
        for index in 0..rays.len() {
            let mut limit = rays.limit(index);
            planes_of_one(primitives, goal, index, &rays.ray(index), &mut limit, &mut counts);
            rays.set_limit(index, limit);
        }
    }
    counts
}

/// Offer the planes to one ray.
#[inline(never)]
fn planes_of_one<G: Goal>(
    primitives: &Primitives,
    goal: &mut G,
    index: usize,
    ray: &Ray,
    limit: &mut f32,
    counts: &mut Counts,
) {
    for (id, plane) in (primitives.first_plane()..).zip(primitives.planes()) {
        if *limit < ray.t_min {
            break;
        }
        counts.primitive_tests += 1;
        let crossings = plane.crossings(ray.origin.to_f64(), ray.direction.to_f64());
        offer_crossings(goal, index, id, crossings, ray.t_min, limit);
    }
}
