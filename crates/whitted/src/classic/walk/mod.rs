//! Ways of one ray through a structure.
//!
//! All offer the same candidates: an object is in every cell that comes within the margin for rounding of it, and a
//! walk reaches every parameter of the ray in some cell.

pub(super) mod dda;
pub(super) mod sequential;
pub(super) mod stack;

use super::math::Arithmetic;
use super::objects::Objects;
use super::observer::Observer;
use super::ray::CastRay;
use crate::geometry::Primitives;
use crate::tree::{Goal, offer_crossings};

/// A ray under way.
pub(super) struct Walker<'a, M: Arithmetic, G, O> {
    pub(super) math: M,
    pub(super) taken: M::Ray,
    pub(super) primitives: &'a Primitives,
    pub(super) objects: &'a Objects,
    pub(super) ray: &'a CastRay,
    pub(super) goal: &'a mut G,
    pub(super) observer: &'a mut O,
    /// No candidate beyond this counts any more.
    pub(super) limit: f32,
}

impl<M: Arithmetic, G: Goal, O: Observer> Walker<'_, M, G, O> {
    /// Test one object.
    #[inline(always)]
    pub(super) fn test(&mut self, id: u32) {
        self.observer.test(id);
        let before = self.limit;
        self.objects.offer(self.math, &self.taken, self.primitives, id, self.ray, self.goal, &mut self.limit);
        self.tell(before, id);
    }

    /// Test the objects of a leaf.
    #[inline(always)]
    pub(super) fn leaf(&mut self, ids: &[u32]) {
        for &id in ids {
            if G::ENDS_RAYS && self.has_ended() {
                return;
            }
            self.test(id);
        }
    }

    /// Test every object there is.
    #[inline(always)]
    pub(super) fn all(&mut self) {
        for id in 0..self.objects.len() as u32 {
            if G::ENDS_RAYS && self.has_ended() {
                return;
            }
            self.test(id);
        }
    }

    /// Test the unbounded planes, which are in no structure.
    #[inline(always)]
    pub(super) fn planes(&mut self) {
        for (id, plane) in (self.primitives.first_plane()..).zip(self.primitives.planes()) {
            if self.has_ended() {
                return;
            }
            self.observer.test(id);
            let before = self.limit;
            let crossings = plane.crossings(self.ray.origin_f64, self.ray.direction_f64);
            offer_crossings(self.goal, 0, id, crossings, self.ray.t_min, &mut self.limit);
            self.tell(before, id);
        }
    }

    /// Whether nothing can count any more.
    #[inline(always)]
    pub(super) fn has_ended(&self) -> bool {
        self.limit < self.ray.t_min
    }

    #[inline(always)]
    fn tell(&mut self, before: f32, id: u32) {
        if self.limit < before {
            self.observer.accept(self.limit, id);
        }
    }
}
