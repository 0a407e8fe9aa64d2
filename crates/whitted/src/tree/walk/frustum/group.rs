//! Sixty-four rays of a packet, as rows of sixteen: what they are, and their tests against primitives.

use super::super::Walk;
use super::packet::Frame;
use super::pyramid::Planes;
use super::{LANES, PACKET};
use crate::geometry::sphere::{self, SphereRays};
use crate::geometry::triangle::{self, ShearedRays, renamed};
use crate::math::Vec3;
use crate::ray::{self, NONE};
use crate::tree::goal::Goal;
use simd::{F32Lanes, MaskLanes, Simd, U32Lanes};

const ROWS: usize = PACKET / LANES;

type Mask<S> = <<S as Simd>::F32x16 as F32Lanes>::Mask;

/// One value of each ray.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Rows([[f32; LANES]; ROWS]);

impl Rows {
    const ZERO: Self = Self([[0.0; LANES]; ROWS]);

    #[inline(always)]
    fn load<S: Simd>(&self, token: S, row: usize) -> S::F32x16 {
        S::F32x16::load(token, &self.0[row])
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, row: usize, lanes: S::F32x16) {
        lanes.store(&mut self.0[row]);
    }
}

/// Rays in the frame of their packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// In the tree's scale.
    direction: [Rows; 3],
    /// See [`ShearedRays::shear`].
    shear: [Rows; 3],
    /// See [`SphereRays::inverse_length_squared`]; only where there are spheres.
    inverse_length_squared: Rows,
    t_min: Rows,
    limit: Rows,
    /// What is not settled yet, see [`Goal::offer_lanes`].
    found: [[u32; LANES]; ROWS],
    /// Number of the first ray in the chunk.
    first: usize,
}

impl Group {
    /// No rays yet.
    pub(super) const EMPTY: Self = Self {
        direction: [Rows::ZERO; 3],
        shear: [Rows::ZERO; 3],
        inverse_length_squared: Rows::ZERO,
        t_min: Rows::ZERO,
        limit: Rows::ZERO,
        found: [[NONE; LANES]; ROWS],
        first: 0,
    };

    /// Whether the rays from `first` on fit the frame, and none has a range that begins before its origin. Asked before
    /// anything is divided: the shadow rays of a picture took a twelfth longer when groups were taken first.
    #[inline(always)]
    pub(super) fn fits<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, first: usize, frame: &Frame) -> bool {
        let start = walk.start + first;
        let o = walk.batch.origin;
        if !(same(token, &o.x[start..], frame.apex.x)
            && same(token, &o.y[start..], frame.apex.y)
            && same(token, &o.z[start..], frame.apex.z))
        {
            return false;
        }
        let [.., z] = renamed(frame.axis);
        let zero = S::F32x16::splat(token, 0.0);
        let mut sound = zero.le(zero);
        for row in 0..ROWS {
            let start = start + LANES * row;
            let d = scaled(token, walk, start);
            let ahead = if frame.backward { d[z].lt(zero) } else { zero.lt(d[z]) };
            sound = sound & ahead & is_dominant(d, frame.axis) & zero.le(t_min(token, walk, start));
        }
        sound.all()
    }

    /// Take the rays from `first` on, which fit the frame.
    #[inline(always)]
    pub(super) fn take<S: Simd, G: Goal>(&mut self, token: S, walk: &Walk<'_, G>, first: usize, frame: &Frame) {
        self.first = first;
        let start = walk.start + first;
        let [x, y, z] = renamed(frame.axis);
        let one = S::F32x16::splat(token, 1.0);
        let has_spheres = !walk.tree.leaves.spheres.is_empty();
        let limits = walk.rays.limits(first);
        for row in 0..ROWS {
            let start = start + LANES * row;
            let d = scaled(token, walk, start);
            self.direction[0].store::<S>(row, d[0]);
            self.direction[1].store::<S>(row, d[1]);
            self.direction[2].store::<S>(row, d[2]);
            self.shear[0].store::<S>(row, d[x] / d[z]);
            self.shear[1].store::<S>(row, d[y] / d[z]);
            self.shear[2].store::<S>(row, one / d[z]);
            if has_spheres {
                self.inverse_length_squared.store::<S>(row, one / Vec3::from(d).length_squared());
            }
            self.t_min.store::<S>(row, t_min(token, walk, start));
            self.limit.store::<S>(row, S::F32x16::load_slice(token, &limits[LANES * row..]));
            self.found[row] = [NONE; LANES];
        }
    }

    /// The least and the greatest of some lanes and of the shears along an axis, times a sign.
    #[inline(always)]
    pub(super) fn span<F: F32Lanes<Array = [f32; LANES]>>(
        &self,
        token: F::Token,
        axis: usize,
        sign: F,
        [mut least, mut greatest]: [F; 2],
    ) -> [F; 2] {
        for row in 0..ROWS {
            let shear = F::load(token, &self.shear[axis].0[row]) * sign;
            (least, greatest) = (least.min(shear), greatest.max(shear));
        }
        [least, greatest]
    }

    /// The greatest of some lanes and of the distances along the dominant axis at which a ray may still hit.
    #[inline(always)]
    pub(super) fn reach<S: Simd>(&self, token: S, axis: usize, so_far: S::F32x16) -> S::F32x16 {
        let mut reach = so_far;
        for row in 0..ROWS {
            let distance = self.limit.load(token, row) * self.direction[axis].load(token, row).abs();
            reach = distance.max(reach);
        }
        reach
    }

    /// The lanes whose rays have all ended.
    #[inline(always)]
    pub(super) fn ended<S: Simd>(&self, token: S) -> Mask<S> {
        let zero = S::F32x16::splat(token, 0.0);
        let mut ended = self.limit.load(token, 0).lt(zero);
        for row in 1..ROWS {
            ended = ended & self.limit.load(token, row).lt(zero);
        }
        ended
    }

    /// Test a triangle, its vertices renamed, of which `planes` are the planes through the origin and the edges.
    #[inline(always)]
    pub(super) fn triangle<S: Simd, G: Goal>(
        &mut self,
        token: S,
        goal: &mut G,
        (origin, vertices): ([S::F32x16; 3], [[S::F32x16; 3]; 3]),
        planes: &Planes<S::F32x16>,
        primitive: u32,
    ) {
        let zero = S::F32x16::splat(token, 0.0);
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
            self.offer(token, goal, row, found, primitive);
        }
    }

    /// Test a sphere.
    #[inline(always)]
    pub(super) fn sphere<S: Simd, G: Goal>(
        &mut self,
        token: S,
        goal: &mut G,
        origin: [S::F32x16; 3],
        (center, radius_squared): ([S::F32x16; 3], S::F32x16),
        primitive: u32,
    ) {
        let zero = S::F32x16::splat(token, 0.0);
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
            let inverse_length_squared = self.inverse_length_squared.load(token, row);
            let rays = SphereRays { origin, direction, inverse_length_squared };
            let roots = sphere::roots(&rays, center, radius_squared);
            self.offer(token, goal, row, sphere::first_in_range(roots, t_min, limit), primitive);
            if G::EVERY_CROSSING {
                let (far, limit) = (roots.1, self.limit.load(token, row));
                self.offer(token, goal, row, (t_min.le(far) & far.le(limit), far), primitive);
            }
        }
    }

    /// Offer what the rays of a row hit at `t`. No jump asks whether any does: it could not be guessed.
    #[inline(always)]
    fn offer<S: Simd, G: Goal>(
        &mut self,
        token: S,
        goal: &mut G,
        row: usize,
        (hit, t): (Mask<S>, S::F32x16),
        primitive: u32,
    ) {
        let limit = self.limit.load(token, row);
        let mut found = <S::F32x16 as F32Lanes>::U32::load(token, &self.found[row]);
        let ids = numbers(self.first + LANES * row);
        let limit = goal.offer_lanes(token, &ids, hit, t, primitive, limit, &mut found);
        self.limit.store::<S>(row, limit);
        found.store(&mut self.found[row]);
    }

    /// Write the rays' limits back, and settle what they found.
    #[inline(always)]
    pub(super) fn finish<S: Simd, G: Goal>(&self, token: S, walk: &mut Walk<'_, G>) {
        walk.rays.limits_mut(self.first).copy_from_slice(self.limit.0.as_flattened());
        for row in 0..ROWS {
            let found = <S::F32x16 as F32Lanes>::U32::load(token, &self.found[row]);
            walk.goal.settle_row::<S::F32x16>(token, self.first + LANES * row, found);
        }
    }
}

/// Directions of a row from `start` of the batch on, in the tree's scale: in which tiny ones may vanish.
#[inline(always)]
fn scaled<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, start: usize) -> [S::F32x16; 3] {
    let (d, scale) = (walk.batch.direction, S::F32x16::splat(token, walk.tree.scale()));
    [
        S::F32x16::load_slice(token, &d.x[start..]) * scale,
        S::F32x16::load_slice(token, &d.y[start..]) * scale,
        S::F32x16::load_slice(token, &d.z[start..]) * scale,
    ]
}

/// Lower ends of the ranges of a row from `start` of the batch on.
#[inline(always)]
fn t_min<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, start: usize) -> S::F32x16 {
    match walk.batch.t_min {
        ray::Row::Each(t_min) => S::F32x16::load_slice(token, &t_min[start..]),
        ray::Row::All(t_min) => S::F32x16::splat(token, t_min),
    }
}

/// The numbers of a row from `first` on.
#[inline(always)]
fn numbers(first: usize) -> [u16; LANES] {
    let mut numbers = [first as u16; LANES];
    for (offset, number) in (0..).zip(&mut numbers) {
        *number += offset;
    }
    numbers
}

/// The lanes whose dominant axis is `axis`, by the rule of [`dominant_axis`](triangle::dominant_axis): of equals the first.
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

/// True if the first [`PACKET`] values equal `value`.
#[inline(always)]
fn same<S: Simd>(token: S, values: &[f32], value: f32) -> bool {
    let value = S::F32x16::splat(token, value);
    let mut equal = value.eq(value);
    for start in (0..PACKET).step_by(LANES) {
        equal = equal & S::F32x16::load_slice(token, &values[start..]).eq(value);
    }
    equal.all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle::dominant_axis;
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
