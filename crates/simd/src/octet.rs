//! Records of eight numbers, which lanes gather half by half.

/// Eight numbers that are read together: half a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Octet(pub [f32; 8]);

impl Octet {
    /// The records as rows of four: record `i` fills rows `2i` and `2i + 1`.
    #[inline(always)]
    pub fn halves(records: &[Self]) -> &[[f32; 4]] {
        // SAFETY: by its representation a record is eight numbers without padding, and so two rows; what aligns records
        // aligns rows, and the length in bytes stays the same.
        unsafe { std::slice::from_raw_parts(records.as_ptr().cast(), 2 * records.len()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_in_order() {
        let records: [Octet; 3] = std::array::from_fn(|i| Octet(std::array::from_fn(|j| (8 * i + j) as f32)));
        let halves = Octet::halves(&records);
        assert!((0..24).all(|i| halves[i / 4][i % 4] == i as f32) && halves.len() == 6);
        assert!(Octet::halves(&[]).is_empty());
    }
}
