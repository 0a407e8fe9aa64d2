//! Doubles at every level against plain Rust.

use crate::common::{SplitMix64, levels};
use simd::{F32Lanes, F64Lanes, Kernel, MaskLanes, Simd, dispatch, lanes_from_fn};

const OPERATIONS: usize = 10;

struct All {
    a: [f32; 8],
    b: [f32; 8],
}

impl Kernel for All {
    type Output = [[u64; 8]; OPERATIONS];

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        let a = S::F64x8::widen(S::F32x8::load(token, &self.a));
        let b = S::F64x8::widen(S::F32x8::load(token, &self.b));
        let third = S::F64x8::splat(token, 1.0 / 3.0);
        let narrowed = S::F64x8::widen((a * third).narrow());
        let mask = a.lt(b).bits();
        let less = S::F64x8::widen(S::F32x8::load(token, &lanes_from_fn(|i| (mask >> i & 1) as f32)));
        let results = [a + b, a - b, a * b * third, a / b, -a, a.min(b), a.max(b), a.sqrt(), narrowed, less];
        let mut bits = [[0; 8]; OPERATIONS];
        for (bits, result) in bits.iter_mut().zip(results) {
            let mut lanes = [0.0; 8];
            result.store(&mut lanes);
            // Which NaN comes out is not promised.
            *bits = lanes.map(|lane: f64| if lane.is_nan() { u64::MAX } else { lane.to_bits() });
        }
        bits
    }
}

#[test]
fn doubles_have_the_same_bits_at_every_level() {
    let mut rng = SplitMix64(11);
    for _ in 0..20_000 {
        let (a, b) = ([(); 8].map(|()| rng.nasty_f32()), [(); 8].map(|()| rng.nasty_f32()));
        let expected = |f: fn(f64, f64) -> f64| -> [u64; 8] {
            std::array::from_fn(|i| {
                let lane = f(a[i].into(), b[i].into());
                if lane.is_nan() { u64::MAX } else { lane.to_bits() }
            })
        };
        let expected = [
            expected(|a, b| a + b),
            expected(|a, b| a - b),
            expected(|a, b| a * b * (1.0 / 3.0)),
            expected(|a, b| a / b),
            expected(|a, _| -a),
            expected(|a, b| if a < b { a } else { b }),
            expected(|a, b| if a > b { a } else { b }),
            expected(|a, _| a.sqrt()),
            expected(|a, _| f64::from((a * (1.0 / 3.0)) as f32)),
            expected(|a, b| f64::from(u8::from(a < b))),
        ];

        for level in levels() {
            assert_eq!(dispatch(level, All { a, b }), expected, "{level}: {a:?} {b:?}");
        }
    }
}
