//! What a ray is inside of.

/// Materials that a ray has entered and not yet left, innermost last: a small stack, so that glass in water in glass
/// bends light as it should.
///
/// A medium is a material number: bodies of one material that touch or overlap are one body. Entering pushes, leaving
/// removes the innermost entry of that material, wherever it lies, so that overlapping bodies (where one is left before
/// the other that was entered later) do not confuse the rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Media {
    materials: [u32; Media::CAPACITY],
    len: u8,
    /// Entries that did not fit.
    lost: u8,
}

impl Media {
    /// Nested bodies that are kept; deeper ones are counted and bend nothing.
    pub(super) const CAPACITY: usize = 7;

    /// The innermost material, if any.
    pub(super) fn innermost(&self) -> Option<u32> {
        self.entries().last().copied()
    }

    /// True if the ray is known to be inside `material`.
    pub(super) fn contains(&self, material: u32) -> bool {
        self.entries().contains(&material)
    }

    /// True if some entry did not fit.
    pub(super) fn overflowed(&self) -> bool {
        self.lost > 0
    }

    /// The media after entering `material`. Beyond the capacity only the number of entries is kept.
    pub(super) fn entered(mut self, material: u32) -> Self {
        match self.materials.get_mut(usize::from(self.len)) {
            Some(slot) => {
                *slot = material;
                self.len += 1;
            }
            None => self.lost = self.lost.saturating_add(1),
        }
        self
    }

    /// The media after leaving `material`; nothing changes if it was never entered.
    pub(super) fn left(mut self, material: u32) -> Self {
        let len = usize::from(self.len);
        match self.entries().iter().rposition(|&entry| entry == material) {
            Some(at) => {
                self.materials.copy_within(at + 1..len, at);
                self.len -= 1;
                self.materials[len - 1] = 0;
            }
            None => self.lost = self.lost.saturating_sub(1),
        }
        self
    }

    fn entries(&self) -> &[u32] {
        &self.materials[..usize::from(self.len)]
    }
}

#[cfg(test)]
mod tests {
    use super::Media;

    #[test]
    fn bodies_are_left_in_any_order() {
        let both = Media::default().entered(3).entered(5);
        assert_eq!(both.innermost(), Some(5));
        assert_eq!(both.left(3).innermost(), Some(5));
        assert_eq!(both.left(5).innermost(), Some(3));
        assert_eq!(both.left(3).left(5), Media::default());
    }

    #[test]
    fn one_material_twice_is_left_twice() {
        let twice = Media::default().entered(3).entered(3);
        assert!(twice.left(3).contains(3));
        assert_eq!(twice.left(3).left(3).innermost(), None);
    }

    #[test]
    fn leaving_what_was_never_entered_changes_nothing() {
        assert_eq!(Media::default().left(9), Media::default());
        let inside = Media::default().entered(3);
        assert_eq!(inside.left(9), inside);
    }

    #[test]
    fn overflow_is_counted_and_undone() {
        let mut media = Media::default();
        for material in 0..10 {
            media = media.entered(material);
        }
        assert!(media.overflowed());
        assert_eq!(media.innermost(), Some(Media::CAPACITY as u32 - 1));
        for material in (0..10).rev() {
            media = media.left(material);
        }
        assert_eq!(media, Media::default());
    }
}
