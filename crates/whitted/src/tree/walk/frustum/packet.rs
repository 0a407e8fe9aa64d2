//! Sixty-four rays as rows: what they are, and their tests against primitives.

use super::super::Walk;
use super::pyramid::{Edges, Pyramid};
use super::{LANES, PACKET, ROWS};
use crate::geometry::sphere::{self, SphereRays};
use crate::geometry::triangle::{self, ShearedRays, dominant_axis, renamed};
use crate::math::Vec3;
use crate::ray::{self, NONE};
use crate::tree::goal::Goal;
use simd::{F32Lanes, MaskLanes, Simd, U32Lanes};

/// A row of one value per ray.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Row([f32; PACKET]);

impl Row {
    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, token: S, row: usize) -> S::F32x16 {
        S::F32x16::load_slice(token, &self.0[LANES * row..])
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, row: usize, lanes: S::F32x16) {
        lanes.store_slice(&mut self.0[LANES * row..]);
    }
}

/// Rays with one origin and one dominant axis.
pub(super) struct Packet {
    /// In the tree's scale.
    pub(super) origin: Vec3<f32>,
    direction: [Row; 3],
    /// See [`ShearedRays::shear`].
    pub(super) shear: [Row; 3],
    t_min: Row,
    limit: Row,
    /// What is not settled yet, see [`Goal::offer_lanes`].
    found: [[u32; LANES]; ROWS],
    /// Their numbers in the chunk.
    ids: [[u16; LANES]; ROWS],
    pub(super) axis: usize,
    /// True if the rays run towards smaller coordinates of the dominant axis.
    pub(super) backward: bool,
    /// Signs of the first direction, by which children are ordered.
    pub(super) octant: usize,
}

impl Packet {
    /// The rays from `first` on, if they make a packet: full, one origin, one dominant axis and sense, no negative t.
    #[inline(always)]
    pub(super) fn new<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, first: usize) -> Option<Self> {
        let start = walk.start + first;
        let rows = |row: &[f32]| Row(*row[start..].first_chunk().expect("a whole packet"));
        let (o, d) = (walk.batch.origin, walk.batch.direction);
        let apex = Vec3::new(o.x[start], o.y[start], o.z[start]);
        if !(same(token, &o.x[start..], apex.x)
            && same(token, &o.y[start..], apex.y)
            && same(token, &o.z[start..], apex.z))
        {
            return None;
        }
        let along = Vec3::new(d.x[start], d.y[start], d.z[start]);
        let axis = dominant_axis(along);
        let octant = [along.x, along.y, along.z].map(|component| usize::from(component.is_sign_negative()));
        let mut packet = Self {
            origin: apex * walk.tree.scale(),
            direction: [rows(d.x), rows(d.y), rows(d.z)],
            shear: [Row([0.0; PACKET]); 3],
            t_min: match walk.batch.t_min {
                ray::Row::Each(t_min) => rows(t_min),
                ray::Row::All(t_min) => Row([t_min; PACKET]),
            },
            limit: Row(*walk.rays.limits(first)),
            found: [[NONE; LANES]; ROWS],
            ids: numbers(first),
            axis,
            backward: octant[axis] != 0,
            octant: octant[0] | octant[1] << 1 | octant[2] << 2,
        };
        packet.prepare(token, walk.tree.scale()).then_some(packet)
    }

    /// Ask the memory for the packet's worth of rays from `first` on.
    #[inline(always)]
    pub(super) fn prefetch<G: Goal>(walk: &Walk<'_, G>, first: usize) {
        let start = walk.start + first;
        let (o, d) = (walk.batch.origin, walk.batch.direction);
        for row in [o.x, o.y, o.z, d.x, d.y, d.z] {
            for step in 0..ROWS {
                simd::prefetch(row, start + step * LANES);
            }
        }
    }

    /// Scale and shear the directions; false if a ray has another dominant axis or sense, or a range that begins before
    /// its origin.
    #[inline(always)]
    fn prepare<S: Simd>(&mut self, token: S, scale: f32) -> bool {
        let [x, y, z] = renamed(self.axis);
        let zero = S::F32x16::splat(token, 0.0);
        let mut sound = zero.le(zero);
        for row in 0..ROWS {
            let scale = S::F32x16::splat(token, scale);
            let d = [
                self.direction[0].load(token, row) * scale,
                self.direction[1].load(token, row) * scale,
                self.direction[2].load(token, row) * scale,
            ];
            let (dx, dy, dz) = (d[x], d[y], d[z]);
            let ahead = if self.backward { dz.lt(zero) } else { zero.lt(dz) };
            sound = sound & ahead & is_dominant(d, self.axis);
            sound = sound & zero.le(self.t_min.load(token, row));
            self.shear[0].store::<S>(row, dx / dz);
            self.shear[1].store::<S>(row, dy / dz);
            self.shear[2].store::<S>(row, S::F32x16::splat(token, 1.0) / dz);
            self.direction[0].store::<S>(row, d[0]);
            self.direction[1].store::<S>(row, d[1]);
            self.direction[2].store::<S>(row, d[2]);
        }
        sound.all()
    }

    /// The greatest distance along the dominant axis at which a ray may still hit.
    #[inline(always)]
    pub(super) fn reach<S: Simd>(&self, token: S) -> f32 {
        let mut reach = S::F32x16::splat(token, f32::NEG_INFINITY);
        for row in 0..ROWS {
            let distance = self.limit.load(token, row) * self.direction[self.axis].load(token, row).abs();
            reach = distance.max(reach);
        }
        // One rounding of the product: the next but one number up is no less than the exact one.
        let reach = reach.reduce_max();
        if reach < f32::INFINITY { reach.next_up().next_up() } else { reach }
    }

    /// True if all rays have ended.
    #[inline(always)]
    pub(super) fn has_ended<S: Simd>(&self, token: S) -> bool {
        let zero = S::F32x16::splat(token, 0.0);
        let mut ended = self.limit.load(token, 0).lt(zero);
        for row in 1..ROWS {
            ended = ended & self.limit.load(token, row).lt(zero);
        }
        ended.all()
    }

    /// Write the rays' limits back, and settle what they found.
    #[inline(always)]
    pub(super) fn finish<S: Simd, G: Goal>(&self, token: S, walk: &mut Walk<'_, G>, first: usize) {
        *walk.rays.limits_mut(first) = self.limit.0;
        for row in 0..ROWS {
            let found = <S::F32x16 as F32Lanes>::U32::load(token, &self.found[row]);
            walk.goal.settle_row::<S::F32x16>(token, first + LANES * row, found);
        }
    }

    /// Test the triangles of a block that the pyramid touches; returns how many.
    #[inline(always)]
    pub(super) fn triangles<S: Simd, G: Goal>(
        &mut self,
        token: S,
        pyramid: &Pyramid,
        walk: &mut Walk<'_, G>,
        block: usize,
    ) -> u32 {
        let block = &walk.tree.leaves.triangles[block];
        let mut edges = Edges::default();
        let mut survivors = pyramid.touches_triangles(token, block, &mut edges);
        let count = survivors.count_ones();
        let [x, y, z] = pyramid.axes;
        let origin = crate::geometry::splat(token, [self.origin[x], self.origin[y], self.origin[z]]);
        let zero = S::F32x16::splat(token, 0.0);
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % 8;
            survivors &= survivors - 1;
            let planes = edges.planes(token, lane);
            let vertices = [
                crate::geometry::splat(token, block.corner(0, lane, pyramid.axes)),
                crate::geometry::splat(token, block.corner(1, lane, pyramid.axes)),
                crate::geometry::splat(token, block.corner(2, lane, pyramid.axes)),
            ];
            for row in 0..ROWS {
                let [x, y] = [self.shear[0].load(token, row), self.shear[1].load(token, row)];
                let limit = self.limit.load(token, row);
                let mut excluded = planes.exclude(x, y);
                if G::ENDS_RAYS {
                    excluded = excluded | limit.lt(zero);
                }
                if excluded.all() {
                    continue;
                }
                let rays = ShearedRays { origin, shear: [x, y, self.shear[2].load(token, row)] };
                let found = triangle::intersect(token, &rays, vertices, self.t_min.load(token, row), limit);
                self.offer(token, walk.goal, row, found, block.primitive(lane));
            }
        }
        count
    }

    /// Test the spheres of a block that the pyramid touches; returns how many.
    #[inline(always)]
    pub(super) fn spheres<S: Simd, G: Goal>(
        &mut self,
        token: S,
        pyramid: &Pyramid,
        walk: &mut Walk<'_, G>,
        block: usize,
    ) -> u32 {
        let block = &walk.tree.leaves.spheres[block];
        let mut survivors = pyramid.touches_spheres(token, block);
        let count = survivors.count_ones();
        let origin = crate::geometry::splat(token, self.origin.to_array());
        let (zero, one) = (S::F32x16::splat(token, 0.0), S::F32x16::splat(token, 1.0));
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % 8;
            survivors &= survivors - 1;
            let center = crate::geometry::splat(token, block.center(lane));
            let radius_squared = S::F32x16::splat(token, block.radius_squared(lane));
            for row in 0..ROWS {
                let (t_min, limit) = (self.t_min.load(token, row), self.limit.load(token, row));
                if G::ENDS_RAYS && limit.lt(zero).all() {
                    continue;
                }
                let direction = [
                    self.direction[0].load(token, row),
                    self.direction[1].load(token, row),
                    self.direction[2].load(token, row),
                ];
                let inverse_length_squared = one / Vec3::from(direction).length_squared();
                let rays = SphereRays { origin, direction, inverse_length_squared };
                let roots = sphere::roots(&rays, center, radius_squared);
                let (hit, t) = sphere::first_in_range(roots, t_min, limit);
                let id = block.primitive(lane);
                self.offer(token, walk.goal, row, (hit, t), id);
                if G::EVERY_CROSSING {
                    let (far, limit) = (roots.1, self.limit.load(token, row));
                    self.offer(token, walk.goal, row, (t_min.le(far) & far.le(limit), far), id);
                }
            }
        }
        count
    }

    /// Offer what the rays of a row hit at `t`. No jump asks whether any does: it could not be guessed.
    #[inline(always)]
    fn offer<S: Simd, G: Goal>(
        &mut self,
        token: S,
        goal: &mut G,
        row: usize,
        (hit, t): (<S::F32x16 as F32Lanes>::Mask, S::F32x16),
        primitive: u32,
    ) {
        let limit = self.limit.load(token, row);
        let mut found = <S::F32x16 as F32Lanes>::U32::load(token, &self.found[row]);
        let limit = goal.offer_lanes(token, &self.ids[row], hit, t, primitive, limit, &mut found);
        self.limit.store::<S>(row, limit);
        found.store(&mut self.found[row]);
    }
}

/// The numbers from `first` on.
#[inline(always)]
fn numbers(first: usize) -> [[u16; LANES]; ROWS] {
    let mut numbers = [[first as u16; LANES]; ROWS];
    for (offset, number) in (0..).zip(numbers.as_flattened_mut()) {
        *number += offset;
    }
    numbers
}

/// The lanes whose dominant axis is `axis`, by the rule of [`dominant_axis`]: of equals the first.
#[inline(always)]
fn is_dominant<F: F32Lanes>(direction: [F; 3], axis: usize) -> F::Mask {
    let [x, y, z] = renamed(axis);
    dominated(direction[x], direction[z], x < z) & dominated(direction[y], direction[z], y < z)
}

/// True where `component` does not take the place of `dominant`; `is_first` says who wins a tie.
#[inline(always)]
fn dominated<F: F32Lanes>(component: F, dominant: F, is_first: bool) -> F::Mask {
    if is_first { component.abs().lt(dominant.abs()) } else { component.abs().le(dominant.abs()) }
}

/// True if the first [`PACKET`] values of a row equal `value`.
#[inline(always)]
fn same<S: Simd>(token: S, row: &[f32], value: f32) -> bool {
    let value = S::F32x16::splat(token, value);
    let mut equal = value.eq(value);
    for start in (0..PACKET).step_by(LANES) {
        equal = equal & S::F32x16::load_slice(token, &row[start..]).eq(value);
    }
    equal.all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use simd::{Scalar, ScalarF32};

    #[test]
    fn a_tie_of_axes_is_settled_as_for_single_rays() {
        let components = [-2.0, -1.0, -0.0, 1.0, 2.0];
        let lane = |value: f32| ScalarF32::<1>::splat(Scalar, value);
        for (x, y, z) in
            components.iter().flat_map(|x| components.iter().flat_map(move |y| components.map(|z| (*x, *y, z))))
        {
            for axis in 0..3 {
                let expected = dominant_axis(Vec3::new(x, y, z)) == axis;
                assert_eq!(is_dominant([lane(x), lane(y), lane(z)], axis).any(), expected, "{x} {y} {z}, axis {axis}");
            }
        }
    }
}
