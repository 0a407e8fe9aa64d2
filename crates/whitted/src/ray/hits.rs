//! Hits in the caller's own arrays, and lists of them.

use super::{Hit, HitBatch};
use std::ops::Range;

/// Room for many hits in somebody's arrays, one array for each component.
///
/// It can be divided, so that threads write to parts of the same arrays.
#[derive(Debug)]
pub struct HitsMut<'a> {
    pub(crate) t: &'a mut [f32],
    pub(crate) u: &'a mut [f32],
    pub(crate) v: &'a mut [f32],
    pub(crate) primitive: &'a mut [u32],
}

impl<'a> HitsMut<'a> {
    /// Room in these slices; what they hold will be overwritten.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn new(t: &'a mut [f32], u: &'a mut [f32], v: &'a mut [f32], primitive: &'a mut [u32]) -> Self {
        let len = t.len();
        assert!(u.len() == len && v.len() == len && primitive.len() == len, "slices of one length");
        Self { t, u, v, primitive }
    }

    /// Number of hits.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// True if there is room for none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// The same room, borrowed for a while.
    pub fn reborrow(&mut self) -> HitsMut<'_> {
        HitsMut { t: self.t, u: self.u, v: self.v, primitive: self.primitive }
    }

    /// Room for the first `middle` hits and for the others.
    ///
    /// # Panics
    /// If there is no room for so many.
    pub fn split_at(self, middle: usize) -> (Self, Self) {
        let (t, u) = (self.t.split_at_mut(middle), self.u.split_at_mut(middle));
        let (v, primitive) = (self.v.split_at_mut(middle), self.primitive.split_at_mut(middle));
        let left = Self { t: t.0, u: u.0, v: v.0, primitive: primitive.0 };
        (left, Self { t: t.1, u: u.1, v: v.1, primitive: primitive.1 })
    }

    /// Make hits of a range misses.
    pub(crate) fn clear(&mut self, range: Range<usize>) {
        self.t[range.clone()].fill(Hit::MISS.t);
        self.u[range.clone()].fill(Hit::MISS.u);
        self.v[range.clone()].fill(Hit::MISS.v);
        self.primitive[range].fill(Hit::MISS.primitive);
    }
}

impl<'a> From<&'a mut HitBatch> for HitsMut<'a> {
    fn from(hits: &'a mut HitBatch) -> Self {
        Self::new(&mut hits.t, &mut hits.u, &mut hits.v, &mut hits.primitive)
    }
}

/// For each of many rays a list of hits: what `all_hits` finds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HitLists {
    hits: Vec<Hit>,
    /// Where each ray's hits end in `hits`; they begin where those of the ray before it end.
    ends: Vec<usize>,
}

impl HitLists {
    /// No lists.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of lists: one for each ray.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// True if there are no lists.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The hits of ray `index`, in order.
    ///
    /// # Panics
    /// If there is no such ray.
    pub fn of(&self, index: usize) -> &[Hit] {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.hits[start..self.ends[index]]
    }

    /// The lists, ray by ray.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[Hit]> {
        (0..self.len()).map(|index| self.of(index))
    }

    /// All hits, one list after the other.
    pub fn hits(&self) -> &[Hit] {
        &self.hits
    }

    /// Remove all lists, keep the memory.
    pub fn clear(&mut self) {
        self.hits.clear();
        self.ends.clear();
    }

    /// Append the lists of more rays.
    pub fn append(&mut self, other: &Self) {
        let before = self.hits.len();
        self.hits.extend_from_slice(&other.hits);
        self.ends.extend(other.ends.iter().map(|end| before + end));
    }

    /// Append a hit to the list that is not ended yet.
    pub(crate) fn push(&mut self, hit: Hit) {
        self.hits.push(hit);
    }

    /// The last hit of the list that is not ended yet.
    pub(crate) fn last(&self) -> Option<&Hit> {
        self.hits[self.ends.last().copied().unwrap_or(0)..].last()
    }

    /// End the list of one more ray.
    pub(crate) fn end(&mut self) {
        self.ends.push(self.hits.len());
    }
}
