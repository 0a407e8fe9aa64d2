//! Walks: ways to find the leaves that rays meet.
//!
//! All are generic over the instruction set and over the [`Goal`], and all offer the same candidates.

mod abreast;
mod frustum;
mod prepared;
mod single;
mod slabs;
mod stream;

pub(super) use frustum::PACKET;
pub(super) use prepared::PreparedRays;
pub(crate) use prepared::sound;
use prepared::{Packets, Records};
pub(super) use stream::Lists;

use super::Tree;
use super::goal::Goal;
use super::leaf::LeafKind;
use super::policy::Way;
use super::query::Counts;
use crate::geometry::{Crossings, Primitives};
use crate::ray::Rays;
use simd::{Kernel, Simd};

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
        if self.rays.len() == 1 {
            self.record(token, Packets::default());
            single::alone(token, &mut self, &mut counts);
            return counts;
        }
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
        for packet in 0..self.rays.len() / PACKET {
            if frustum::walk(token, self, &mut stack, packet * PACKET, counts) {
                walked.insert(packet);
            }
        }
        self.lists.stack = stack;
        walked
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
        counts.primitive_tests += (count * super::leaf::BLOCK) as u64;
        let ray = self.rays.node(index);
        let (t_min, mut limit) = (ray.t_min(), ray.limit());
        let blocks = first..first + count;
        match kind {
            LeafKind::Triangles => {
                let ray = self.rays.sheared(index);
                for block in &self.tree.leaves.triangles[blocks] {
                    block.intersect(token, self.goal, index, &ray, t_min, &mut limit);
                }
            }
            LeafKind::Spheres => {
                let ray = self.rays.sphere(index);
                for block in &self.tree.leaves.spheres[blocks] {
                    block.intersect(token, self.goal, index, &ray, t_min, &mut limit);
                }
            }
            LeafKind::Shapes => shapes(self, index, blocks, &mut limit),
        }
        self.rays.shorten(index, limit);
    }
}

/// Test one ray against the primitives of shape blocks, one by one.
#[inline(never)]
fn shapes<G: Goal>(walk: &mut Walk<'_, G>, index: usize, blocks: std::ops::Range<usize>, limit: &mut f32) {
    // A ray from so far away that its offsets overflow enters unused lanes too, whose leaf has no blocks.
    for id in walk.tree.leaves.shapes.get(blocks).unwrap_or_default().iter().flat_map(|block| block.ids()) {
        let ray = walk.rays.ray(index);
        let shape = &walk.primitives.shapes()[(id - walk.primitives.first_shape()) as usize];
        let crossings = shape.crossings(ray.origin.to_f64(), ray.direction.to_f64());
        offer_crossings(walk.goal, index, id, crossings, ray.t_min, limit);
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
    if primitives.planes().is_empty() {
        return counts;
    }
    for index in 0..rays.len() {
        let ray = rays.ray(index);
        for (id, plane) in (primitives.first_plane()..).zip(primitives.planes()) {
            let mut limit = rays.limit(index);
            if limit < ray.t_min {
                break;
            }
            counts.primitive_tests += 1;
            let crossings = plane.crossings(ray.origin.to_f64(), ray.direction.to_f64());
            offer_crossings(goal, index, id, crossings, ray.t_min, &mut limit);
            rays.set_limit(index, limit);
        }
    }
    counts
}
