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

    /// The primitive that a ray has found so far, where the goal keeps one; [`NONE`] for none.
    #[inline(always)]
    fn found(&self, _ray: usize) -> u32 {
        NONE
    }

    /// Sixteen rays with these numbers, which pass by one primitive after the other, meet one where `hit` is set; returns
    /// their new limits. What they find may stay in `found`, at first [`NONE`], until it is settled.
    #[inline(always)]
    fn offer_lanes<F: F32Lanes<Array = [f32; 16], U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        rays: &[u16; 16],
        hit: F::Mask,
        t: F,
        primitive: u32,
        limit: F,
        _: &mut F::U32,
    ) -> F {
        if hit.any() { offer_each(self, token, rays, hit, t, primitive, limit) } else { limit }
    }

    /// Take what a ray has found, which is not [`NONE`].
    #[inline(always)]
    fn settle(&mut self, _ray: usize, _found: u32) {}

    /// Take what sixteen consecutive rays from `first` on have found.
    #[inline(always)]
    fn settle_row<F: F32Lanes<U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        first: usize,
        found: F::U32,
    ) {
        let mut ids = [NONE; 16];
        found.store(&mut ids);
        let mut bits = (!found.eq(F::U32::splat(token, NONE))).bits();
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize % 16;
            bits &= bits - 1;
            self.settle(first + lane, ids[lane]);
        }
    }
}

/// [`Goal::offer`] for each lane that hit.
#[inline(always)]
fn offer_each<F: F32Lanes<Array = [f32; 16]>, G: Goal + ?Sized>(
    goal: &mut G,
    token: F::Token,
    rays: &[u16; 16],
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
        if let Some(shorter) = goal.offer(usize::from(rays[lane]), ts[lane], primitive, limits[lane]) {
            limits[lane] = shorter;
        }
    }
    F::load(token, &limits)
}

/// [`Goal::settle`] for each lane that found something.
#[inline(always)]
pub(super) fn settle_all<F: F32Lanes<U32: U32Lanes<Array = [u32; 16]>>, G: Goal + ?Sized>(
    goal: &mut G,
    rays: &[u16; 16],
    found: F::U32,
) {
    let mut stored = [NONE; 16];
    found.store(&mut stored);
    for (&ray, found) in rays.iter().zip(stored) {
        if found != NONE {
            goal.settle(usize::from(ray), found);
        }
    }
}

/// The hit with the smallest (t, primitive).
pub(crate) struct Closest<'a> {
    /// Best primitive of each ray so far; [`NONE`] for none.
    pub primitive: &'a mut [u32],
}

impl Goal for Closest<'_> {
    #[inline(always)]
    fn found(&self, ray: usize) -> u32 {
        self.primitive[ray]
    }

    #[inline(always)]
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, limit: f32) -> Option<f32> {
        let better = t < limit || (t == limit && primitive < self.primitive[ray]);
        better.then(|| {
            self.primitive[ray] = primitive;
            t
        })
    }

    #[inline(always)]
    fn offer_lanes<F: F32Lanes<Array = [f32; 16], U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        rays: &[u16; 16],
        hit: F::Mask,
        t: F,
        primitive: u32,
        limit: F,
        found: &mut F::U32,
    ) -> F {
        if (hit & t.eq(limit)).any() {
            settle_all::<F, _>(self, rays, *found);
            *found = F::U32::splat(token, NONE);
            return offer_each(self, token, rays, hit, t, primitive, limit);
        }
        let closer = hit & t.lt(limit);
        *found = F::U32::select(closer, F::U32::splat(token, primitive), *found);
        F::select(closer, t, limit)
    }

    #[inline(always)]
    fn settle(&mut self, ray: usize, found: u32) {
        self.primitive[ray] = found;
    }

    #[inline(always)]
    fn settle_row<F: F32Lanes<U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        first: usize,
        found: F::U32,
    ) {
        let row = &mut self.primitive[first..first + 16];
        let nothing = found.eq(F::U32::splat(token, NONE));
        F::U32::select(nothing, F::U32::load_slice(token, row), found).store_slice(row);
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

    #[inline(always)]
    fn offer_lanes<F: F32Lanes<Array = [f32; 16], U32: U32Lanes<Array = [u32; 16]>>>(
        &mut self,
        token: F::Token,
        _: &[u16; 16],
        hit: F::Mask,
        _: F,
        primitive: u32,
        limit: F,
        found: &mut F::U32,
    ) -> F {
        if self.opaque.is_none_or(|set| set.contains(primitive)) {
            *found = F::U32::select(hit, F::U32::splat(token, BLOCKED), *found);
            return F::select(hit, F::splat(token, f32::NEG_INFINITY), limit);
        }
        // A ray that was blocked is not hit any more.
        *found = F::U32::select(hit, F::U32::splat(token, FILTERED), *found);
        limit
    }

    #[inline(always)]
    fn settle(&mut self, ray: usize, found: u32) {
        self.occlusion[ray] = if found == BLOCKED { Occlusion::Blocked } else { Occlusion::Filtered };
    }
}

/// What [`Any`] finds, as lanes hold it.
const FILTERED: u32 = Occlusion::Filtered as u32;
const BLOCKED: u32 = Occlusion::Blocked as u32;

const _: () = assert!(NONE == u32::MAX, "every primitive must come before NONE in the order of ties");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SplitMix64;
    use simd::{Kernel, Level, Simd};

    /// Sixteen rays pass by a few primitives at distances of which many are equal.
    struct Pass<'a>(&'a [(u16, [f32; 16], u32)]);

    const RAYS: [u16; 16] = [3, 1, 4, 15, 9, 2, 6, 5, 0, 8, 7, 10, 13, 12, 11, 14];

    impl Kernel for Pass<'_> {
        type Output = ([u32; 16], [f32; 16]);

        #[inline(always)]
        fn run<S: Simd>(self, token: S) -> Self::Output {
            let mut primitive = [NONE; 16];
            let mut goal = Closest { primitive: &mut primitive };
            let mut limit = S::F32x16::splat(token, 2.0);
            let mut found = <S::F32x16 as F32Lanes>::U32::splat(token, NONE);
            for (hit, t, id) in self.0 {
                let hit = <S::F32x16 as F32Lanes>::Mask::from_bits(token, u32::from(*hit));
                let t = S::F32x16::load(token, t);
                limit = goal.offer_lanes(token, &RAYS, hit & t.le(limit), t, *id, limit, &mut found);
            }
            settle_all::<S::F32x16, _>(&mut goal, &RAYS, found);
            let mut limits = [0.0; 16];
            limit.store(&mut limits);
            (primitive, limits)
        }
    }

    #[test]
    fn rays_abreast_find_what_each_finds_alone() {
        let mut random = SplitMix64::new(5);
        for _ in 0..200 {
            let offers: [(u16, [f32; 16], u32); 6] = std::array::from_fn(|_| {
                let t = std::array::from_fn(|_| random.below(3) as f32);
                (random.below(1 << 16) as u16, t, random.below(100))
            });
            let (mut primitive, mut limits) = ([NONE; 16], [2.0; 16]);
            let mut goal = Closest { primitive: &mut primitive };
            for (hit, t, id) in offers {
                for lane in 0..16 {
                    let (ray, limit) = (usize::from(RAYS[lane]), limits[lane]);
                    if hit >> lane & 1 != 0 && t[lane] <= limit {
                        limits[lane] = goal.offer(ray, t[lane], id, limit).unwrap_or(limit);
                    }
                }
            }
            for level in Level::available() {
                assert_eq!(simd::dispatch(level, Pass(&offers)), (primitive, limits), "{level:?}");
            }
        }
    }
}
