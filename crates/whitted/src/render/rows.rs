//! Structures of arrays that grow: what stages hand to each other.

use simd::{F32Lanes, MaskLanes, U32Lanes};

/// Records of `F` floats and `U` integers, one row for each field.
///
/// Lanes are appended without gaps and loaded in blocks. The rows in memory are longer than the records are many, so
/// that whole registers can be stored and loaded at the end; what lies there is no record.
#[derive(Debug)]
pub(super) struct Rows<const F: usize, const U: usize> {
    floats: Vec<f32>,
    integers: Vec<u32>,
    /// Where the first row of each begins: at a cache line.
    first: [usize; 2],
    /// From a row to the next.
    stride: usize,
    len: usize,
}

impl<const F: usize, const U: usize> Default for Rows<F, U> {
    fn default() -> Self {
        Self { floats: Vec::new(), integers: Vec::new(), first: [0; 2], stride: STAGGER, len: 0 }
    }
}

/// The widest lanes.
pub(super) const BLOCK: usize = 16;

/// Bytes of a cache line.
const LINE: usize = 64;

/// Rows are longer than a power of two by this: rows a power of two apart would compete for the same sets of the
/// first-level cache, which has fewer ways than records have fields.
const STAGGER: usize = 5 * LINE / size_of::<f32>();

/// Records for which there is room as soon as there is one: few batches are larger, pages that nobody writes to cost
/// nothing, and growing writes to each twice.
const LEAST: usize = 16384;

impl<const F: usize, const U: usize> Rows<F, U> {
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Keep the first `len` records, of which there are as many.
    pub(super) fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// A row of floats; empty where nothing was ever appended.
    #[inline(always)]
    pub(super) fn floats(&self, row: usize) -> &[f32] {
        self.floats.get(self.float_row(row)..self.float_row(row) + self.len).unwrap_or_default()
    }

    /// A row of integers.
    #[inline(always)]
    pub(super) fn integers(&self, row: usize) -> &[u32] {
        self.integers.get(self.integer_row(row)..self.integer_row(row) + self.len).unwrap_or_default()
    }

    /// Sixteen floats of a row; beyond the last record, anything.
    #[inline(always)]
    pub(super) fn block(&self, row: usize, at: usize) -> &[f32; BLOCK] {
        let start = self.float_row(row) + at;
        self.floats[start..].first_chunk().expect("rows are longer than the records are many")
    }

    /// Append the records of the lanes `mask`, in order.
    #[inline(always)]
    pub(super) fn append<L: F32Lanes>(&mut self, mask: L::Mask, floats: [L; F], integers: [L::U32; U]) {
        if self.stride < self.len + 2 * BLOCK + STAGGER {
            self.grow();
        }
        for i in 0..F {
            let at = self.float_row(i) + self.len;
            floats[i].compress_store(mask, &mut self.floats[at..]);
        }
        for i in 0..U {
            let at = self.integer_row(i) + self.len;
            integers[i].compress_store(mask, &mut self.integers[at..]);
        }
        self.len += mask.bits().count_ones() as usize;
    }

    /// The records `at` and following in lanes; beyond the last record, anything.
    #[inline(always)]
    pub(super) fn load<L: F32Lanes>(&self, token: L::Token, at: usize) -> ([L; F], [L::U32; U]) {
        let mut floats = [L::splat(token, 0.0); F];
        for i in 0..F {
            floats[i] = L::load_slice(token, &self.floats[self.float_row(i) + at..]);
        }
        let mut integers = [L::U32::splat(token, 0); U];
        for i in 0..U {
            integers[i] = L::U32::load_slice(token, &self.integers[self.integer_row(i) + at..]);
        }
        (floats, integers)
    }

    #[inline(always)]
    fn float_row(&self, row: usize) -> usize {
        self.first[0] + row * self.stride
    }

    #[inline(always)]
    fn integer_row(&self, row: usize) -> usize {
        self.first[1] + row * self.stride
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        let stride = (self.len + 2 * BLOCK).next_power_of_two().max(LEAST) + STAGGER;
        let floats = |row| self.floats(row);
        let (new_floats, first_float) = spread::<_, F>(std::array::from_fn(floats), stride);
        let integers = |row| self.integers(row);
        let (new_integers, first_integer) = spread::<_, U>(std::array::from_fn(integers), stride);
        (self.floats, self.integers) = (new_floats, new_integers);
        (self.first, self.stride) = ([first_float, first_integer], stride);
    }
}

/// Memory for rows `stride` apart that begin like these; and where the first begins in it.
fn spread<T: Copy + Default, const N: usize>(rows: [&[T]; N], stride: usize) -> (Vec<T>, usize) {
    let mut all = vec![T::default(); N * stride + BLOCK];
    let first = all.as_ptr().align_offset(LINE).min(BLOCK);
    for (i, row) in rows.into_iter().enumerate() {
        let start = first + i * stride;
        all[start..start + row.len()].copy_from_slice(row);
    }
    (all, first)
}

/// Make `elements` as long as `len`, with zeros at the end; with room for [`LEAST`] if there is not enough, instead of growing.
#[inline(always)]
pub(super) fn lengthen<T: Copy + Default>(elements: &mut Vec<T>, len: usize) {
    elements.reserve(len.max(LEAST).saturating_sub(elements.len()));
    elements.resize(len, T::default());
}

/// The first `count` lanes, or all if there are fewer.
#[inline(always)]
pub(super) fn first_lanes<L: F32Lanes>(token: L::Token, count: usize) -> L::Mask {
    let bits = if count < BLOCK { (1 << count) - 1 } else { u32::MAX };
    L::Mask::from_bits(token, bits)
}

/// The lanes in memory.
#[inline(always)]
pub(super) fn array<L: F32Lanes>(lanes: L::U32) -> <L::U32 as U32Lanes>::Array {
    let mut array = <L::U32 as U32Lanes>::Array::default();
    lanes.store(&mut array);
    array
}

/// The lanes in memory.
#[inline(always)]
pub(super) fn array_f32<L: F32Lanes>(lanes: L) -> L::Array {
    let mut array = L::Array::default();
    lanes.store(&mut array);
    array
}

/// The numbers of the bits that are set, ascending.
#[inline(always)]
pub(super) fn lanes_of(bits: u32) -> LanesOf {
    LanesOf(bits)
}

/// See [`lanes_of`].
pub(super) struct LanesOf(u32);

impl Iterator for LanesOf {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let lane = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (lane < 32).then_some(lane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use simd::{Kernel, Level, Simd};

    struct Append<'a>(&'a mut Rows<1, 1>, u32);

    impl Kernel for Append<'_> {
        type Output = ();

        #[inline(always)]
        fn run<S: Simd>(self, token: S) {
            let numbers: [u32; 16] = simd::lanes_from_fn(|i| i as u32);
            let numbers = <S::F32x16 as F32Lanes>::U32::load(token, &numbers);
            let mask = <S::F32x16 as F32Lanes>::Mask::from_bits(token, self.1);
            self.0.append::<S::F32x16>(mask, [S::F32x16::from_int(numbers)], [numbers]);
        }
    }

    #[test]
    fn records_are_appended_without_gaps() {
        for level in Level::available() {
            let (mut rows, mut expected) = (Rows::default(), Vec::new());
            for step in 0..100u32 {
                let bits = step.wrapping_mul(0x9e37_79b9) >> 16;
                simd::dispatch(level, Append(&mut rows, bits));
                expected.extend(lanes_of(bits).map(|lane| lane as u32));
            }
            assert_eq!(rows.integers(0), expected);
            assert!(rows.floats(0).iter().zip(&expected).all(|(&float, &number)| float == number as f32));
            rows.truncate(7);
            assert_eq!(rows.integers(0), &expected[..7]);
        }
    }

    #[test]
    fn set_bits_are_listed() {
        assert_eq!(lanes_of(0b1001_0110).collect::<Vec<_>>(), [1, 2, 4, 7]);
        assert_eq!(lanes_of(1 << 31).collect::<Vec<_>>(), [31]);
        assert_eq!(lanes_of(0).count(), 0);
    }
}
