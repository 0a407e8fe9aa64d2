//! What a ray is inside of.

use crate::ray::NONE;
use simd::U32Lanes;

/// Materials that a ray has entered and not yet left, innermost first: a small stack, so that glass in water in glass
/// bends light as it should. One for each lane.
///
/// A medium is a material number: bodies of one material that touch or overlap are one body. Entering pushes, leaving
/// removes the innermost entry of that material, wherever it lies, so that overlapping bodies (where one is left before
/// the other that was entered later) do not confuse the rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Media<U> {
    /// [`NONE`] where there are no more.
    stack: [U; CAPACITY],
    /// Entries that did not fit.
    lost: U,
}

/// Nested bodies that are kept; deeper ones are counted and bend nothing.
const CAPACITY: usize = 7;

/// Rows that media fill.
pub(super) const ROWS: usize = CAPACITY + 1;

impl<U: U32Lanes> Media<U> {
    /// Inside nothing.
    #[inline(always)]
    pub(super) fn none(token: U::Token) -> Self {
        Self { stack: [U::splat(token, NONE); CAPACITY], lost: U::splat(token, 0) }
    }

    /// As [`rows`](Self::rows) gave them.
    #[inline(always)]
    pub(super) fn from_rows(rows: [U; ROWS]) -> Self {
        let [stack @ .., lost] = rows;
        Self { stack, lost }
    }

    /// For storage.
    #[inline(always)]
    pub(super) fn rows(self) -> [U; ROWS] {
        let [a, b, c, d, e, f, g] = self.stack;
        [a, b, c, d, e, f, g, self.lost]
    }

    /// The innermost material, or [`NONE`].
    #[inline(always)]
    pub(super) fn innermost(&self) -> U {
        self.stack[0]
    }

    /// Lanes known to be inside `material`.
    #[inline(always)]
    pub(super) fn contains(&self, material: U) -> U::Mask {
        let mut found = self.stack[0].eq(material);
        for i in 1..CAPACITY {
            found = found | self.stack[i].eq(material);
        }
        found
    }

    /// Lanes where some entry did not fit.
    #[inline(always)]
    pub(super) fn overflowed(&self, token: U::Token) -> U::Mask {
        U::splat(token, 0).lt(self.lost)
    }

    /// The media after entering `material`. Beyond the capacity only the number of entries is kept.
    #[inline(always)]
    pub(super) fn entered(&self, token: U::Token, material: U) -> Self {
        let has_room = self.stack[CAPACITY - 1].eq(U::splat(token, NONE));
        let mut stack = self.stack;
        stack[0] = U::select(has_room, material, self.stack[0]);
        for i in 1..CAPACITY {
            stack[i] = U::select(has_room, self.stack[i - 1], self.stack[i]);
        }
        let lost = U::select(has_room, self.lost, self.lost + U::splat(token, 1));
        Self { stack, lost }
    }

    /// The media after leaving `material`; nothing changes if it was never entered.
    #[inline(always)]
    pub(super) fn left(&self, token: U::Token, material: U) -> Self {
        let mut stack = self.stack;
        let mut found = self.stack[0].eq(material);
        for i in 0..CAPACITY - 1 {
            stack[i] = U::select(found, self.stack[i + 1], self.stack[i]);
            found = found | self.stack[i + 1].eq(material);
        }
        let last = CAPACITY - 1;
        stack[last] = U::select(found, U::splat(token, NONE), self.stack[last]);
        let kept = found | self.lost.eq(U::splat(token, 0));
        Self { stack, lost: U::select(kept, self.lost, self.lost - U::splat(token, 1)) }
    }

    /// `set` in the lanes `mask`, else `unset`.
    #[inline(always)]
    pub(super) fn select(mask: U::Mask, set: &Self, unset: &Self) -> Self {
        let mut stack = unset.stack;
        for i in 0..CAPACITY {
            stack[i] = U::select(mask, set.stack[i], unset.stack[i]);
        }
        Self { stack, lost: U::select(mask, set.lost, unset.lost) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use simd::{MaskLanes, Scalar, ScalarU32};

    /// The media of one ray, changed as a path of (material, entered) says.
    fn after(path: &[(u32, bool)]) -> Media<ScalarU32<1>> {
        path.iter().fold(Media::none(Scalar), |media, &(material, enters)| {
            let material = ScalarU32::splat(Scalar, material);
            if enters { media.entered(Scalar, material) } else { media.left(Scalar, material) }
        })
    }

    fn numbers(media: &Media<ScalarU32<1>>) -> [u32; ROWS] {
        media.rows().map(|row| {
            let mut number = [0];
            row.store(&mut number);
            number[0]
        })
    }

    fn innermost(path: &[(u32, bool)]) -> u32 {
        numbers(&after(path))[0]
    }

    const NOTHING: [u32; ROWS] = [NONE, NONE, NONE, NONE, NONE, NONE, NONE, 0];

    #[test]
    fn bodies_are_left_in_any_order() {
        let (three, five) = ((3, true), (5, true));
        assert_eq!(innermost(&[three, five]), 5);
        assert_eq!(innermost(&[three, five, (3, false)]), 5);
        assert_eq!(innermost(&[three, five, (5, false)]), 3);
        assert_eq!(numbers(&after(&[three, five, (3, false), (5, false)])), NOTHING);
    }

    #[test]
    fn one_material_twice_is_left_twice() {
        let once = after(&[(3, true), (3, true), (3, false)]);
        assert!(once.contains(ScalarU32::splat(Scalar, 3)).any());
        assert_eq!(innermost(&[(3, true), (3, true), (3, false), (3, false)]), NONE);
    }

    #[test]
    fn leaving_what_was_never_entered_changes_nothing() {
        assert_eq!(numbers(&after(&[(9, false)])), NOTHING);
        assert_eq!(numbers(&after(&[(3, true), (9, false)])), numbers(&after(&[(3, true)])));
    }

    #[test]
    fn overflow_is_counted_and_undone() {
        let entries: Vec<(u32, bool)> = (0..10).map(|material| (material, true)).collect();
        assert!(after(&entries).overflowed(Scalar).any());
        assert_eq!(innermost(&entries), CAPACITY as u32 - 1);
        let exits = (0..10).rev().map(|material| (material, false));
        let path: Vec<(u32, bool)> = entries.iter().copied().chain(exits).collect();
        assert_eq!(numbers(&after(&path)), NOTHING);
    }
}
