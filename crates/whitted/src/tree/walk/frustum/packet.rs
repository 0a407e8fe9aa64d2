//! Rays of one packet, and their tests against the blocks of a leaf.

use super::super::Walk;
use super::group::Group;
use super::pyramid::{Edges, Pyramid};
use super::{GROUPS, LANES, PACKET, PATIENCE};
use crate::geometry::splat;
use crate::geometry::triangle::dominant_axis;
use crate::math::Vec3;
use crate::tree::goal::Goal;
use simd::{F32Lanes, MaskLanes, Simd};
use std::ops::Range;

/// What the rays of a packet have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Where they start, as the caller gave it.
    pub(super) apex: Vec3<f32>,
    /// Along which they mostly run.
    pub(super) axis: usize,
    /// True if they run towards smaller coordinates of that axis.
    pub(super) backward: bool,
    /// Signs of the first direction, by which children are ordered.
    pub(super) octant: usize,
}

impl Frame {
    /// Of the ray `first` of the chunk.
    #[inline(always)]
    fn new<G: Goal>(walk: &Walk<'_, G>, first: usize) -> Self {
        let start = walk.start + first;
        let (o, d) = (walk.batch.origin, walk.batch.direction);
        let along = Vec3::new(d.x[start], d.y[start], d.z[start]);
        let axis = dominant_axis(along);
        let negative = [along.x, along.y, along.z].map(|component| usize::from(component.is_sign_negative()));
        Self {
            apex: Vec3::new(o.x[start], o.y[start], o.z[start]),
            axis,
            backward: negative[axis] != 0,
            octant: negative[0] | negative[1] << 1 | negative[2] << 2,
        }
    }
}

/// Rays with one origin and one dominant axis, in groups; memory that is filled anew for each packet.
#[derive(Debug)]
pub(in crate::tree::walk) struct Packet {
    pub(super) frame: Frame,
    /// In the tree's scale.
    pub(super) origin: Vec3<f32>,
    pub(super) groups: [Group; GROUPS],
    /// How many of them to take next, at most.
    width: usize,
}

impl Default for Packet {
    fn default() -> Self {
        let frame = Frame { apex: Vec3::<f32>::ZERO, axis: 0, backward: false, octant: 0 };
        Self { frame, origin: frame.apex, groups: [Group::EMPTY; GROUPS], width: GROUPS }
    }
}

impl Packet {
    /// Forget how large the last one was.
    pub(in crate::tree::walk) fn begin(&mut self) {
        self.width = GROUPS;
    }

    /// Take as many groups from `first` on as make one packet: full, one origin, one dominant axis and sense, no negative t;
    /// returns how many.
    #[inline(always)]
    pub(super) fn take<S: Simd, G: Goal>(&mut self, token: S, walk: &Walk<'_, G>, first: usize) -> usize {
        self.frame = Frame::new(walk, first);
        self.origin = self.frame.apex * walk.tree.scale();
        let mut taken = 0;
        for group in &mut self.groups[..self.width] {
            let first = first + PACKET * taken;
            if first + PACKET > walk.rays.len() || !Group::fits(token, walk, first, &self.frame) {
                break;
            }
            group.take(token, walk, first, &self.frame);
            taken += 1;
        }
        taken
    }

    /// Take as many next time as had enough in common now: whether this packet was halved, and what its rays tested.
    #[inline(always)]
    pub(super) fn adapt(&mut self, is_halved: bool, tests: u64) {
        if is_halved {
            self.width = (self.width / 2).max(1);
        } else if tests <= PATIENCE.into() {
            self.width = (self.width * 2).min(GROUPS);
        }
    }

    /// Ask the memory for so many rays from `first` on.
    #[inline(always)]
    pub(super) fn prefetch<G: Goal>(walk: &Walk<'_, G>, first: usize, count: usize) {
        let start = walk.start + first;
        let (o, d) = (walk.batch.origin, walk.batch.direction);
        for row in [o.x, o.y, o.z, d.x, d.y, d.z] {
            for ray in (0..count).step_by(LANES) {
                simd::prefetch(row, start + ray);
            }
        }
    }

    /// The greatest distance along the dominant axis at which a ray of `part` may still hit.
    #[inline(always)]
    pub(super) fn reach<S: Simd>(&self, token: S, part: Range<usize>) -> f32 {
        let mut reach = S::F32x16::splat(token, f32::NEG_INFINITY);
        for group in &self.groups[part] {
            reach = group.reach(token, self.frame.axis, reach);
        }
        // One rounding of the product: the next but one number up is no less than the exact one.
        let reach = reach.reduce_max();
        if reach < f32::INFINITY { reach.next_up().next_up() } else { reach }
    }

    /// True if all rays of `part` have ended.
    #[inline(always)]
    pub(super) fn has_ended<S: Simd>(&self, token: S, part: Range<usize>) -> bool {
        let zero = S::F32x16::splat(token, 0.0);
        let mut ended = zero.le(zero);
        for group in &self.groups[part] {
            ended = ended & group.ended(token);
        }
        ended.all()
    }

    /// Test the rays of `part` against the triangles of a block that the pyramid touches; returns how many.
    #[inline(always)]
    pub(super) fn triangles<S: Simd, G: Goal>(
        &mut self,
        token: S,
        walk: &mut Walk<'_, G>,
        (pyramid, part): (&Pyramid, Range<usize>),
        block: usize,
    ) -> u32 {
        let block = &walk.tree.leaves.triangles[block];
        let mut edges = Edges::default();
        let mut survivors = pyramid.touches_triangles(token, block, &mut edges);
        let count = survivors.count_ones();
        let [x, y, z] = pyramid.axes;
        let origin = splat(token, [self.origin[x], self.origin[y], self.origin[z]]);
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % 8;
            survivors &= survivors - 1;
            let planes = edges.planes(token, lane);
            let vertices = [
                splat(token, block.corner(0, lane, pyramid.axes)),
                splat(token, block.corner(1, lane, pyramid.axes)),
                splat(token, block.corner(2, lane, pyramid.axes)),
            ];
            for group in &mut self.groups[part.clone()] {
                group.triangle(token, walk.goal, (origin, vertices), &planes, block.primitive(lane));
            }
        }
        count
    }

    /// Test the rays of `part` against the spheres of a block that the pyramid touches; returns how many.
    #[inline(always)]
    pub(super) fn spheres<S: Simd, G: Goal>(
        &mut self,
        token: S,
        walk: &mut Walk<'_, G>,
        (pyramid, part): (&Pyramid, Range<usize>),
        block: usize,
    ) -> u32 {
        let block = &walk.tree.leaves.spheres[block];
        let mut survivors = pyramid.touches_spheres(token, block);
        let count = survivors.count_ones();
        let origin = splat(token, self.origin.to_array());
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % 8;
            survivors &= survivors - 1;
            let center = splat(token, block.center(lane));
            let radius_squared = S::F32x16::splat(token, block.radius_squared(lane));
            for group in &mut self.groups[part.clone()] {
                group.sphere(token, walk.goal, origin, (center, radius_squared), block.primitive(lane));
            }
        }
        count
    }

    /// Write back what the first `count` groups found.
    #[inline(always)]
    pub(super) fn finish<S: Simd, G: Goal>(&self, token: S, walk: &mut Walk<'_, G>, count: usize) {
        for group in &self.groups[..count] {
            group.finish(token, walk);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_as_large_as_pays() {
        let mut packet = Packet::default();
        let mut widths = Vec::new();
        let (few, many) = (u64::from(PATIENCE), u64::from(PATIENCE) + 1);
        for (is_halved, tests) in
            [(true, many), (true, few), (true, many), (false, many), (false, few), (false, 0), (false, 0)]
        {
            packet.adapt(is_halved, tests);
            widths.push(packet.width);
        }
        assert_eq!(widths, [2, 1, 1, 1, 2, 4, 4]);
        packet.adapt(true, many);
        packet.begin();
        assert_eq!(packet.width, GROUPS);
    }
}
