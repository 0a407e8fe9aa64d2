//! Vector operations (Tables 3 and 4) by the means that [`whitted::classic::Workload`] does not have: those of 2004, one
//! component after the other, and those of today, a lane for each vector.
//!
//! Operands and results take 24 kB, which stays in the nearest cache: arithmetic is measured, not memory.

use simd::{F32Lanes, Kernel, Simd};
use std::hint::black_box;
use whitted::classic::Operation;
use whitted::math::{SplitMix64, Vec3};

/// Vectors in each array; a multiple of every width.
pub(super) const VECTORS: usize = 512;

/// Numbers in each array.
const NUMBERS: usize = 4 * VECTORS;

/// Operands and results, each a vector of four numbers after the other.
pub(super) struct Data {
    a: Lines,
    b: Lines,
    out: Lines,
}

/// Numbers that begin with a cache line.
#[repr(align(64))]
struct Lines([f32; NUMBERS]);

impl Data {
    /// Numbers from 0.5 to 1.5.
    pub(super) fn new() -> Box<Self> {
        let mut random = SplitMix64::new(NUMBERS as u64);
        let mut lines = || Lines(std::array::from_fn(|_| (0.5 + random.next_f64()) as f32));
        Box::new(Self { a: lines(), b: lines(), out: lines() })
    }
}

/// Passes over the arrays that make `operations` operations.
pub(super) fn passes(operations: u64) -> u64 {
    operations.div_ceil(VECTORS as u64)
}

/// One component at a time, as a compiler of 2004 had it: the barrier keeps today's from joining them.
pub(super) fn one_at_a_time(data: &mut Data, operation: Operation, operations: u64) {
    for _ in 0..passes(operations) {
        // What a barrier may read must be known to it.
        let Data { a, b, out } = black_box(&mut *data);
        let vectors = a.0.chunks_exact(4).zip(b.0.chunks_exact(4)).zip(out.0.chunks_exact_mut(4));
        for ((a, b), out) in vectors {
            let length = match operation {
                Operation::Multiply => 1.0,
                _ => (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt(),
            };
            for axis in 0..4 {
                out[axis] = if operation == Operation::Multiply { a[axis] * b[axis] } else { a[axis] / length };
                black_box(());
            }
        }
    }
}

/// What came after the paper: a register holds one component of several vectors, and none lies idle.
pub(super) struct Rows<'a> {
    pub(super) data: &'a mut Data,
    pub(super) operation: Operation,
    pub(super) operations: u64,
}

impl Kernel for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        for _ in 0..passes(self.operations) {
            let data = black_box(&mut *self.data);
            // Sixteen vectors take four rows of sixteen; the fourth would be the w that nobody needs.
            for at in (0..NUMBERS).step_by(4 * STEP) {
                let a = rows::<S>(token, &data.a, at);
                let result = match self.operation {
                    Operation::Multiply => product(a, rows::<S>(token, &data.b, at)),
                    _ => a / a.length_squared().sqrt(),
                };
                result.x.store(row_mut(&mut data.out, at));
                result.y.store(row_mut(&mut data.out, at + STEP));
                result.z.store(row_mut(&mut data.out, at + 2 * STEP));
            }
        }
    }
}

/// Vectors in a step of [`Rows`].
const STEP: usize = 16;

#[inline(always)]
fn rows<S: Simd>(token: S, lines: &Lines, at: usize) -> Vec3<S::F32x16> {
    let [x, y, z] = [row(lines, at), row(lines, at + STEP), row(lines, at + 2 * STEP)];
    Vec3::new(S::F32x16::load(token, x), S::F32x16::load(token, y), S::F32x16::load(token, z))
}

/// Component by component.
#[inline(always)]
fn product<F: F32Lanes>(a: Vec3<F>, b: Vec3<F>) -> Vec3<F> {
    Vec3::new(a.x * b.x, a.y * b.y, a.z * b.z)
}

#[inline(always)]
fn row(lines: &Lines, at: usize) -> &[f32; STEP] {
    lines.0[at..at + STEP].first_chunk().expect("a row lies within the array")
}

#[inline(always)]
fn row_mut(lines: &mut Lines, at: usize) -> &mut [f32; STEP] {
    lines.0[at..at + STEP].first_chunk_mut().expect("a row lies within the array")
}

#[cfg(test)]
mod tests {
    use super::*;
    use simd::{Level, dispatch};

    #[test]
    fn one_component_at_a_time_is_the_same_operation() {
        let mut data = Data::new();
        one_at_a_time(&mut data, Operation::Multiply, 1);
        assert!((0..NUMBERS).all(|i| data.out.0[i] == data.a.0[i] * data.b.0[i]));
        one_at_a_time(&mut data, Operation::Normalize, 1);
        for vector in data.out.0.chunks_exact(4) {
            assert!((vector[..3].iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_lane_for_each_vector_is_the_same_operation() {
        for level in Level::available() {
            let (mut data, operations) = (Data::new(), 1);
            dispatch(level, Rows { data: &mut data, operation: Operation::Multiply, operations });
            assert!((0..3 * STEP).all(|i| data.out.0[i] == data.a.0[i] * data.b.0[i]), "{level}");
            dispatch(level, Rows { data: &mut data, operation: Operation::Normalize, operations });
            for at in 0..STEP {
                let [x, y, z] = [0, STEP, 2 * STEP].map(|row| data.out.0[row + at]);
                assert!((x * x + y * y + z * z - 1.0).abs() < 1e-6, "{level}");
            }
        }
    }
}
