//! Queries that see only some primitives.

use super::goal::Goal;
use simd::{F32Lanes, MaskLanes, U32Lanes};

/// Says whether a ray, by its number in the batch, sees a primitive. What it does not see does not exist for it.
pub type Filter<'a> = &'a dyn Fn(usize, u32) -> bool;

/// A goal for what the filter lets through; everything without one.
///
/// The filter is asked at run time about candidates only, so that no walk has to be compiled a second time for it.
pub(super) struct Filtered<'a, G> {
    pub goal: G,
    /// Number in the batch of the ray that the walk calls 0.
    pub first: usize,
    pub filter: Option<Filter<'a>>,
}

impl<G: Goal> Goal for Filtered<'_, G> {
    const EVERY_CROSSING: bool = G::EVERY_CROSSING;
    const ENDS_RAYS: bool = G::ENDS_RAYS;

    #[inline(always)]
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, limit: f32) -> Option<f32> {
        match self.filter {
            Some(filter) if !filter(self.first + ray, primitive) => None,
            _ => self.goal.offer(ray, t, primitive, limit),
        }
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
        if self.filter.is_none() {
            return self.goal.offer_row(token, first, hit, t, primitive, limit);
        }
        let (mut ts, mut limits) = ([0.0; 16], [0.0; 16]);
        t.store(&mut ts);
        limit.store(&mut limits);
        self.offer_filtered(first, hit.bits(), &ts, primitive, &mut limits);
        F::load(token, &limits)
    }
}

impl<G: Goal> Filtered<'_, G> {
    /// [`Goal::offer`] for each lane of `bits`: out of the way of those who have no filter.
    #[cold]
    #[inline(never)]
    fn offer_filtered(&mut self, first: usize, mut bits: u32, t: &[f32; 16], primitive: u32, limits: &mut [f32; 16]) {
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize % 16;
            bits &= bits - 1;
            if let Some(shorter) = self.offer(first + lane, t[lane], primitive, limits[lane]) {
                limits[lane] = shorter;
            }
        }
    }
}
