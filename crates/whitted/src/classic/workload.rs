//! The paper's measurements of vector operations alone (Tables 3 and 4): many of one kind on operands in the cache.

use simd::{Kernel, Level, Simd, Vec4};

/// What is done to each vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Component by component with another vector (Table 3).
    Multiply,
    /// To unit length by square root and division (Table 4).
    Normalize,
    /// To unit length by the estimate of `1/√x` and one Newton step: about as good as a division (Table 4, as the paper's
    /// SSE rows). There is no estimate in plain arithmetic, which uses the division.
    NormalizeRefined,
    /// To unit length by the estimate alone: 12 bits.
    NormalizeEstimated,
}

/// Where the operands lie (paper §2.4.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// At boundaries of their own size, none across two cache lines.
    Aligned,
    /// One number off: every fourth lies across two cache lines.
    Misaligned,
}

/// Operands, and room for results.
#[derive(Clone, Debug)]
pub struct Workload {
    count: usize,
    left: Vec<f32>,
    right: Vec<f32>,
    out: Vec<f32>,
}

/// Numbers in a vector, and in a cache line.
const WIDTH: usize = 4;
const LINE: usize = 16;

/// Different operands.
const VALUES: usize = 64;

impl Workload {
    /// `count` pairs of vectors; 512 of them lie in the first-level cache with their results.
    pub fn new(count: usize) -> Self {
        let room = WIDTH * count + LINE + 1;
        // From 1 to 2: nothing overflows or takes the slow path of subnormal numbers.
        let numbers = |step: usize| (0..room).map(|i| 1.0 + (i * step % VALUES) as f32 / VALUES as f32).collect();
        Self { count, left: numbers(5), right: numbers(11), out: vec![0.0; room] }
    }

    /// Do the operation once for each pair, with the instruction set of `level`; returns the number of operations.
    ///
    /// With [`Level::Scalar`] it is a plain loop of which compilers of today make vector instructions by themselves,
    /// where the language of the paper's time did not.
    pub fn run(&mut self, operation: Operation, level: Level, alignment: Alignment) -> usize {
        let offset = usize::from(alignment == Alignment::Misaligned);
        let Self { count, left, right, out } = self;
        let range = |numbers: &[f32]| {
            let first = numbers.as_ptr().align_offset(LINE * size_of::<f32>()).min(LINE - 1) + offset;
            first..first + WIDTH * *count
        };
        let (left, right) = (&left[range(left)], &right[range(right)]);
        let place = range(out);
        simd::dispatch(level, Pass { operation, left, right, out: &mut out[place] });
        *count
    }

    /// The sum of the results, so that nobody can leave them out, and tests can compare.
    pub fn sum(&self) -> f64 {
        self.out.iter().map(|&number| f64::from(number)).sum()
    }

    /// Make all results zero.
    pub fn clear(&mut self) {
        self.out.fill(0.0);
    }
}

/// One pass over the operands.
struct Pass<'a> {
    operation: Operation,
    left: &'a [f32],
    right: &'a [f32],
    out: &'a mut [f32],
}

impl Kernel for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let (left, right) = (self.left.as_chunks::<WIDTH>().0, self.right.as_chunks::<WIDTH>().0);
        let out = self.out.as_chunks_mut::<WIDTH>().0;
        match self.operation {
            Operation::Multiply => {
                for ((a, b), out) in left.iter().zip(right).zip(out) {
                    *out = (Vec4::new(token, *a) * Vec4::new(token, *b)).components();
                }
            }
            Operation::Normalize => {
                for (a, out) in left.iter().zip(out) {
                    *out = Vec4::new(token, *a).normalize().components();
                }
            }
            Operation::NormalizeRefined => {
                for (a, out) in left.iter().zip(out) {
                    *out = Vec4::new(token, *a).normalize_approx().components();
                }
            }
            Operation::NormalizeEstimated => {
                for (a, out) in left.iter().zip(out) {
                    *out = Vec4::new(token, *a).normalize_rsqrt().components();
                }
            }
        }
    }
}
