//! References: what the builder divides.

use super::Bounds;
use crate::math::Aabb;

/// A primitive, or the part of it that lies in one cell: its box, tagged with its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    bounds: Bounds,
}

const _: () = assert!(size_of::<Reference>() == 32, "half a cache line");

impl Reference {
    /// Fills the spare room of the array, and stands for primitives that are left out.
    pub(super) const NONE: Self = Self { bounds: Bounds::EMPTY };

    pub(super) fn new(bounds: Aabb, primitive: u32) -> Self {
        Self { bounds: Bounds::new(bounds).tagged(primitive) }
    }

    #[inline(always)]
    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    pub(super) fn with_bounds(self, bounds: Bounds) -> Self {
        Self { bounds: bounds.tagged(self.primitive()) }
    }

    /// The same in coordinates multiplied by a power of two.
    pub(super) fn scaled(self, scale: f32) -> Self {
        let bounds = self.bounds.to_aabb();
        Self::new(Aabb::new(bounds.lo * scale, bounds.hi * scale), self.primitive())
    }

    pub(super) fn is_none(&self) -> bool {
        self.bounds.is_empty()
    }

    pub(super) fn primitive(&self) -> u32 {
        self.bounds.tag()
    }
}

/// The box around references.
pub(super) fn around(references: &[Reference]) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for reference in references {
        bounds = bounds.union(reference.bounds);
    }
    bounds
}

/// Bring the references for which `is_left` holds to the front; return how many. Keeps no order.
///
/// Without a branch: which side a reference takes cannot be predicted.
#[inline(always)]
pub(super) fn partition(references: &mut [Reference], is_left: impl Fn(&Reference) -> bool) -> usize {
    let mut front = 0;
    for index in 0..references.len() {
        let (here, first) = (references[index], references[front]);
        references[index] = first;
        references[front] = here;
        front += usize::from(is_left(&here));
    }
    front
}
