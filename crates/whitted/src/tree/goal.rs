//! What a walk looks for: the type parameter that makes one algorithm answer every kind of query.

use super::BitSet;
use crate::ray::NONE;
use simd::{F32Lanes, MaskLanes, U32Lanes};

/// Receives every candidate that a walk finds and says how far the ray still has to be followed.
pub(crate) trait Goal {
    /// True if every crossing of a surface must be offered, false if the first one in the ray's range will do.
    const EVERY_CROSSING: bool = false;
    /// True if one candidate may end a ray, so that it pays to ask whether rays have ended.
    const ENDS_RAYS: bool = false;

    /// A primitive is hit at `t`, within the ray's range, `limit` being its upper end so far. Returns the new limit if
    /// the range shrinks; negative infinity ends the ray.
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, limit: f32) -> Option<f32>;

    /// Sixteen consecutive rays from `first` on meet one primitive where `hit` is set; returns their new limits.
    #[inline(always)]
    fn offer_row<F: F32Lanes<Array = [f32; 16], U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        first: usize,
        hit: F::Mask,
        t: F,
        primitive: u32,
        limit: F,
    ) -> F {
        offer_each(self, token, first, hit, t, primitive, limit)
    }
}

/// [`Goal::offer`] for each lane that hit.
#[inline(always)]
fn offer_each<F: F32Lanes<Array = [f32; 16]>, G: Goal + ?Sized>(
    goal: &mut G,
    token: F::Token,
    first: usize,
    hit: F::Mask,
    t: F,
    primitive: u32,
    limit: F,
) -> F {
    let (mut ts, mut limits) = ([0.0; 16], [0.0; 16]);
    t.store(&mut ts);
    limit.store(&mut limits);
    let mut bits = hit.bits();
    while bits != 0 {
        let lane = bits.trailing_zeros() as usize % 16;
        bits &= bits - 1;
        if let Some(shorter) = goal.offer(first + lane, ts[lane], primitive, limits[lane]) {
            limits[lane] = shorter;
        }
    }
    F::load(token, &limits)
}

/// The hit with the smallest (t, primitive).
pub(crate) struct Closest<'a> {
    /// Best primitive of each ray so far; [`NONE`] for none.
    pub primitive: &'a mut [u32],
}

impl Goal for Closest<'_> {
    #[inline(always)]
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, limit: f32) -> Option<f32> {
        let better = t < limit || (t == limit && primitive < self.primitive[ray]);
        better.then(|| {
            self.primitive[ray] = primitive;
            t
        })
    }

    #[inline(always)]
    fn offer_row<F: F32Lanes<Array = [f32; 16], U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        first: usize,
        hit: F::Mask,
        t: F,
        primitive: u32,
        limit: F,
    ) -> F {
        let row = &mut self.primitive[first..first + 16];
        let best = F::U32::load_slice(token, row);
        let primitive = F::U32::splat(token, primitive);
        let better = hit & (t.lt(limit) | (t.eq(limit) & primitive.lt(best)));
        F::U32::select(better, primitive, best).store_slice(row);
        F::select(better, t, limit)
    }
}

/// The smallest (t, primitive) that is greater than a given one: the next of all hits in order.
pub(crate) struct Next<'a> {
    /// Best primitive of each ray so far; [`NONE`] for none.
    pub primitive: &'a mut [u32],
    /// The hit after which to look.
    pub after: &'a [(f32, u32)],
}

impl Goal for Next<'_> {
    const EVERY_CROSSING: bool = true;

    #[inline(always)]
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, limit: f32) -> Option<f32> {
        let (after_t, after_primitive) = self.after[ray];
        let is_after = t > after_t || (t == after_t && primitive > after_primitive);
        if !is_after {
            return None;
        }
        Closest { primitive: self.primitive }.offer(ray, t, primitive, limit)
    }
}

/// What stands between the ends of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Occlusion {
    /// Nothing.
    #[default]
    Clear,
    /// Only primitives that are not opaque.
    Filtered,
    /// Something opaque.
    Blocked,
}

/// Whether anything opaque is hit.
pub(crate) struct Any<'a> {
    /// The answer for each ray so far.
    pub occlusion: &'a mut [Occlusion],
    /// Opaque primitives; `None` if all are.
    pub opaque: Option<&'a BitSet>,
}

impl Goal for Any<'_> {
    const ENDS_RAYS: bool = true;

    #[inline(always)]
    fn offer(&mut self, ray: usize, _: f32, primitive: u32, _: f32) -> Option<f32> {
        if self.opaque.is_none_or(|set| set.contains(primitive)) {
            self.occlusion[ray] = Occlusion::Blocked;
            return Some(f32::NEG_INFINITY);
        }
        self.occlusion[ray] = Occlusion::Filtered;
        None
    }
}

const _: () = assert!(NONE == u32::MAX, "every primitive must come before NONE in the order of ties");
