//! Rays that wait to be traced, each with what it carries.

use super::media::{self, Media};
use super::rows::Rows;
use crate::geometry::surfaces::{HitRows, Row};
use crate::math::Vec3;
use crate::ray::{HitBatch, Rays};
use simd::F32Lanes;
use std::ops::Range;

/// What rays carry beside their geometry, in lanes.
///
/// Whitted's shading is linear: light found at the end of a ray counts in its sample with the product of all
/// coefficients on the way, so that the ray needs to remember nothing else.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tag<L: F32Lanes> {
    /// Sample to which its light goes.
    pub(super) sample: L::U32,
    /// Share of its light, per colour component.
    pub(super) weight: Vec3<L>,
    /// What the ray is inside of.
    pub(super) media: Media<L::U32>,
    /// Rays that may still descend from it, itself included.
    pub(super) budget: L::U32,
}

/// Half-lines with what they carry, in lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct TaggedRays<L: F32Lanes> {
    pub(super) origin: Vec3<L>,
    pub(super) direction: Vec3<L>,
    pub(super) tag: Tag<L>,
}

/// A queue of rays of one generation.
#[derive(Debug, Default)]
pub(super) struct RayQueue {
    /// Origin, direction, weight; sample, budget.
    rows: Rows<9, 2>,
    /// Empty where nothing in the scene can be entered.
    media: Rows<0, { media::ROWS }>,
    /// Whether something can be.
    has_media: bool,
}

impl RayQueue {
    /// Start over. `has_media`: rays may be inside of something.
    pub(super) fn reset(&mut self, has_media: bool) {
        self.truncate(0);
        self.has_media = has_media;
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Keep the first `len` rays.
    pub(super) fn truncate(&mut self, len: usize) {
        self.rows.truncate(len);
        self.media.truncate(len);
    }

    /// Append the rays of the lanes `mask`, in order.
    #[inline(always)]
    pub(super) fn append<L: F32Lanes>(&mut self, mask: L::Mask, rays: &TaggedRays<L>) {
        let TaggedRays { origin: o, direction: d, tag } = rays;
        let w = tag.weight;
        let floats = [o.x, o.y, o.z, d.x, d.y, d.z, w.x, w.y, w.z];
        self.rows.append::<L>(mask, floats, [tag.sample, tag.budget]);
        if self.has_media {
            self.media.append::<L>(mask, [], tag.media.rows());
        }
    }

    /// The rays `at` and following in lanes; beyond the last ray, anything.
    #[inline(always)]
    pub(super) fn load<L: F32Lanes>(&self, token: L::Token, at: usize) -> TaggedRays<L> {
        let ([ox, oy, oz, dx, dy, dz, wx, wy, wz], [sample, budget]) = self.rows.load::<L>(token, at);
        let media = match self.has_media {
            true => Media::from_rows(self.media.load::<L>(token, at).1),
            false => Media::none(token),
        };
        let tag = Tag { sample, weight: Vec3::new(wx, wy, wz), media, budget };
        TaggedRays { origin: Vec3::new(ox, oy, oz), direction: Vec3::new(dx, dy, dz), tag }
    }

    /// Some of the rays, for tracing.
    pub(super) fn rays(&self, range: Range<usize>) -> Rays<'_> {
        let row = |row| &self.rows.floats(row)[range.clone()];
        Rays::new([row(0), row(1), row(2)], [row(3), row(4), row(5)])
    }

    /// The rays `at` and following with their hits, of which `hits` has those from `first` on.
    #[inline(always)]
    pub(super) fn hit_rows<'a>(&'a self, at: usize, hits: &HitBatch, first: usize) -> HitRows<'a> {
        let row = |row| -> &'a Row { self.rows.block(row, at) };
        let (origin, direction) = (Vec3::new(row(0), row(1), row(2)), Vec3::new(row(3), row(4), row(5)));
        HitRows::new(origin, direction, hits, at - first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::one::{One, one, ones};
    use simd::{Scalar, ScalarU32, U32Lanes};

    #[test]
    fn what_is_appended_is_loaded() {
        for has_media in [false, true] {
            let mut queue = RayQueue::default();
            queue.reset(has_media);
            let all = one(0.0).eq(one(0.0));
            for number in 0..40 {
                let integer = |value| ScalarU32::splat(Scalar, value);
                let media = Media::none(Scalar).entered(Scalar, integer(number));
                let tag = Tag { sample: integer(number), weight: ones(Vec3::splat(0.5)), media, budget: integer(7) };
                let origin = ones(Vec3::splat(number as f32));
                queue.append::<One>(all, &TaggedRays { origin, direction: ones(Vec3::splat(1.0)), tag });
            }
            queue.truncate(30);
            assert_eq!(queue.rays(20..30).get(3).origin.y, 23.0);
            let loaded = queue.load::<One>(Scalar, 29);
            assert!(simd::MaskLanes::any(loaded.tag.sample.eq(ScalarU32::splat(Scalar, 29))));
        }
    }
}
