//! The emulated fused multiply-add against the one of the standard library, where it is hardest.

use crate::common::{ForLanes, SplitMix64, for_widths, levels, same_float};
use simd::{F32Lanes, Level};

/// Triples per level and width; a quarter of each kind of [`triple`].
const TRIPLES: usize = 3_400_000;

/// One input, of a kind that changes with `kind`.
fn triple(random: &mut SplitMix64, kind: usize) -> [f32; 3] {
    let few_bits = |random: &mut SplitMix64| {
        // A short mantissa, so that products end in long runs of zeros and sums tie.
        let exponent = random.next_u32() % 80 + 87;
        f32::from_bits((random.next_u32() & 0x807f_f000) | exponent << 23)
    };
    match kind % 4 {
        0 => [0; 3].map(|_| f32::from_bits(random.next_u32())),
        1 => [0; 3].map(|_| random.nasty_f32()),
        2 => {
            // The addend nearly cancels the product, or is just at the edge of its rounding.
            let (a, b) = (few_bits(random), few_bits(random));
            let near = (-a * b).to_bits().wrapping_add(random.next_u32() % 5).wrapping_sub(2);
            let shift = (random.next_u32() % 60) as i32 - 30;
            [a, b, f32::from_bits(near) * 2f32.powi(shift)]
        }
        _ => {
            // The result is subnormal or about to be.
            let tiny = |random: &mut SplitMix64| f32::from_bits(random.next_u32() & 0x80ff_ffff);
            let scale = f32::from_bits((random.next_u32() & 0x807f_ffff) | (random.next_u32() % 40 + 100) << 23);
            [tiny(random), scale, tiny(random)]
        }
    }
}

struct Fused(Level);

impl ForLanes for Fused {
    #[inline(always)]
    fn run<F: F32Lanes>(&self, token: F::Token) {
        let mut random = SplitMix64(F::WIDTH as u64);
        let [mut a, mut b, mut c] = [F::Array::default(); 3];
        for step in 0..TRIPLES / F::WIDTH {
            for i in 0..F::WIDTH {
                [a.as_mut()[i], b.as_mut()[i], c.as_mut()[i]] = triple(&mut random, step);
            }
            let mut found = F::Array::default();
            F::load(token, &a).fma(F::load(token, &b), F::load(token, &c)).store(&mut found);
            for i in 0..F::WIDTH {
                let (a, b, c) = (a.as_ref()[i], b.as_ref()[i], c.as_ref()[i]);
                let (found, expected) = (found.as_ref()[i], a.mul_add(b, c));
                assert!(
                    same_float(found.to_bits(), expected.to_bits()),
                    "{} x{}: {a:?} * {b:?} + {c:?} = {expected:?}, not {found:?}",
                    self.0,
                    F::WIDTH
                );
            }
        }
    }
}

#[test]
fn fma_rounds_once() {
    for level in levels() {
        for_widths(level, &Fused(level));
    }
}
