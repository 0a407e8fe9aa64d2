//! The elementary functions: their errors against `f64`, their edges, and the same bits at every level.

use crate::common::{ForLanes, SplitMix64, for_widths, levels, nasty, same_float};
use simd::{F32Lanes, Level, U32Lanes, math};

/// Distance of `found` from `expected` in units of the last place of `expected`.
fn ulps(found: f32, expected: f64) -> f64 {
    let rounded = expected as f32;
    if found == rounded || found.is_nan() && rounded.is_nan() {
        // What remains is the half ulp that rounding costs, or less.
        return if rounded.is_finite() { (f64::from(found) - expected).abs() / spacing(expected) } else { 0.0 };
    }
    if found.is_finite() { (f64::from(found) - expected).abs() / spacing(expected) } else { f64::INFINITY }
}

/// Distance of the `f32` next to `x`.
fn spacing(x: f64) -> f64 {
    let exponent = (x.abs().to_bits() >> 52) as i32 - 1023;
    2f64.powi(exponent.clamp(-126, 127) - 23)
}

/// One function of one number: name, own version, `f64` version, range by bits of |x|, bound in ulp.
type Unary = (&'static str, fn(f32) -> f32, fn(f64) -> f64, std::ops::RangeInclusive<f32>, f64);

const UNARY: [Unary; 9] = [
    ("exp2", math::exp2, f64::exp2, 0.0..=f32::INFINITY, 1.1),
    ("exp", math::exp, f64::exp, 0.0..=f32::INFINITY, 1.0),
    ("log2", math::log2, f64::log2, 0.0..=f32::INFINITY, 0.6),
    ("ln", math::ln, f64::ln, 0.0..=f32::INFINITY, 0.6),
    ("sin", math::sin, f64::sin, 0.0..=1e5, 1.6),
    ("cos", math::cos, f64::cos, 0.0..=1e5, 1.6),
    ("tan", math::tan, f64::tan, 0.0..=1e5, 3.5),
    ("acos", math::acos, f64::acos, 0.0..=f32::INFINITY, 2.7),
    ("asin", math::asin, f64::asin, 0.0..=f32::INFINITY, 2.7),
];

/// Every how manieth `f32` is tried; odd, so that all low bits occur.
const STRIDE: usize = 1009;

#[test]
fn unary_errors_are_bounded() {
    for (name, own, exact, range, bound) in UNARY {
        let mut worst = (0.0, 0.0);
        for bits in (range.start().to_bits()..=range.end().to_bits()).step_by(STRIDE) {
            for x in [f32::from_bits(bits), -f32::from_bits(bits)] {
                let error = ulps(own(x), exact(f64::from(x)));
                if error > worst.0 {
                    worst = (error, x);
                }
            }
        }
        println!("{name}: {:.3} ulp at {:e}", worst.0, worst.1);
        assert!(worst.0 <= bound, "{name}: {worst:?}");
    }
}

/// The greatest error of `pow` in results within `2^±span`, with the arguments.
fn worst_pow(span: f32) -> (f64, f32, f32) {
    let mut random = SplitMix64(8);
    let mut worst = (0.0, 0.0, 0.0);
    for i in 0..2_000_000 {
        // Bases of any size, or near one, or colours.
        let x = match i % 3 {
            0 => f32::from_bits(random.next_u32() >> 1),
            1 => 1.0 + (random.next_f32() - 0.5) * 0.01,
            _ => random.next_f32(),
        };
        let y = (random.next_f32() - 0.5) * 2.0 * span / x.log2().abs().max(1e-6);
        let error = ulps(math::pow(x, y), f64::from(x).powf(f64::from(y)));
        if error > worst.0 {
            worst = (error, x, y);
        }
    }
    println!("pow within 2^±{span}: {worst:?}");
    worst
}

#[test]
fn powers_of_fractions_are_near_enough_for_shading() {
    let mut random = SplitMix64(9);
    let mut worst = (0.0, 0.0, 0.0);
    for i in 0..2_000_000 {
        let x = match i % 3 {
            0 => f32::from_bits(random.next_u32() % (1.0f32.to_bits() + 1)).max(f32::MIN_POSITIVE),
            1 => 1.0 - random.next_f32() * 0.01,
            _ => random.next_f32().max(f32::MIN_POSITIVE),
        };
        let y = random.next_f32() * 32.0 / x.log2().abs().max(1e-6);
        let (power, exact) = (math::pow_of_fraction(x, y), f64::from(x).powf(f64::from(y)));
        assert!((0.0..=1.0).contains(&power), "{x}^{y} = {power}");
        let error = (f64::from(power) / exact - 1.0).abs();
        if error > worst.0 {
            worst = (error, x, y);
        }
    }
    println!("powers of fractions: 2^{:.2}, {worst:?}", worst.0.log2());
    assert!(worst.0 <= 2f64.powi(-17), "{worst:?}");
}

#[test]
fn powers_of_fractions_have_exact_ends() {
    for x in [f32::MIN_POSITIVE, 1e-20, 0.1, 0.5, 0.999_999_9, 1.0] {
        assert_eq!(math::pow_of_fraction(x, 0.0), 1.0, "{x}^0");
        assert_eq!(math::pow_of_fraction(1.0, 1e6 * x), 1.0, "1^{x}");
    }
    assert_eq!(math::pow_of_fraction(0.5, 127.0), 0.0);
    assert_eq!(math::pow_of_fraction(0.9, f32::MAX), 0.0);
}

#[test]
fn pow_error_is_bounded() {
    for (span, bound) in [(16.0, 1.5), (152.0, 4.0)] {
        let worst = worst_pow(span);
        assert!(worst.0 <= bound, "pow within 2^±{span}: {worst:?}");
    }
}

#[test]
fn atan2_error_is_bounded() {
    let mut random = SplitMix64(9);
    let mut worst = (0.0, 0.0, 0.0);
    for i in 0..3_000_000 {
        let [y, x] = match i % 3 {
            0 => [0; 2].map(|_| f32::from_bits(random.next_u32())),
            1 => [0; 2].map(|_| f32::from_bits(random.next_u32() & 0x8000_00ff)),
            _ => [0; 2].map(|_| random.next_f32() - 0.5),
        };
        let error = ulps(math::atan2(y, x), f64::from(y).atan2(f64::from(x)));
        if error > worst.0 {
            worst = (error, y, x);
        }
    }
    println!("atan2: {worst:?}");
    assert!(worst.0 <= 2.0, "atan2: {worst:?}");
}

const INF: f32 = f32::INFINITY;
const NAN: f32 = f32::NAN;

#[test]
fn pow_edges_are_exact() {
    let cases = [
        [1.0, NAN, 1.0],
        [1.0, INF, 1.0],
        [NAN, 0.0, 1.0],
        [-3.0, -0.0, 1.0],
        [INF, 0.0, 1.0],
        [0.0, 0.0, 1.0],
        [0.0, 2.5, 0.0],
        [-0.0, 2.5, 0.0],
        [0.0, -0.5, INF],
        [0.0, INF, 0.0],
        [INF, 0.5, INF],
        [INF, -1e-9, 0.0],
        [0.5, INF, 0.0],
        [0.5, -INF, INF],
        [2.0, INF, INF],
        [2.0, -INF, 0.0],
        [2.0, 127.0, 1.701_411_8e38],
        [2.0, 128.0, INF],
        [2.0, -149.0, 1e-45],
        [2.0, 1e30, INF],
        [2.0, -1e30, 0.0],
        [9.0, 0.5, 3.0],
        [10.0, 2.0, 100.0],
        [-2.0, 2.0, NAN],
        [NAN, 1.0, NAN],
        [2.0, NAN, NAN],
        [-INF, 1.0, NAN],
    ];
    for [x, y, expected] in cases {
        assert!(same_float(math::pow(x, y).to_bits(), expected.to_bits()), "pow({x}, {y}) = {}", math::pow(x, y));
    }
    // NaN with its payload in the low bits alone.
    assert!(math::pow(2.0, f32::from_bits(0x7f80_0001)).is_nan());
}

#[test]
fn other_edges_are_exact() {
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    for n in -149..128 {
        assert_eq!(f64::from(math::exp2(n as f32)), 2f64.powi(n));
        assert_eq!(math::log2(2f64.powi(n) as f32), n as f32);
    }
    let same = |found: f32, expected: f32| {
        assert!(same_float(found.to_bits(), expected.to_bits()), "{found:?} instead of {expected:?}");
    };
    for (y, x, expected) in [
        (0.0, 1.0, 0.0),
        (-0.0, 1.0, -0.0),
        (0.0, 0.0, 0.0),
        (0.0, -0.0, PI),
        (-0.0, -1.0, -PI),
        (1.0, 0.0, FRAC_PI_2),
        (-1.0, -0.0, -FRAC_PI_2),
        (INF, INF, FRAC_PI_4),
        (-INF, 3.0, -FRAC_PI_2),
        (2.0, -INF, PI),
        (2.0, INF, 0.0),
        (f32::MAX, f32::MAX, FRAC_PI_4),
        (NAN, 1.0, NAN),
        (1.0, NAN, NAN),
    ] {
        same(math::atan2(y, x), expected);
    }
    for (x, expected) in [(-0.0, -0.0), (0.0, 0.0), (INF, NAN), (-INF, NAN), (NAN, NAN), (1e6, 0.0)] {
        same(math::sin(x), expected);
    }
    for (x, expected) in [(-0.0, 1.0), (INF, NAN), (NAN, NAN), (-1e9, 1.0)] {
        same(math::cos(x), expected);
    }
    for (x, expected) in [(1.0, 0.0), (-1.0, PI), (0.0, FRAC_PI_2), (1.5, NAN), (NAN, NAN)] {
        same(math::acos(x), expected);
    }
    for (x, expected) in [(1.0, FRAC_PI_2), (-0.0, -0.0), (-1.5, NAN)] {
        same(math::asin(x), expected);
    }
    same(math::exp(0.0), 1.0);
    same(math::exp(NAN), NAN);
}

/// Every function at a level and width, against the plain one, to the bit (or both NaN).
struct Same(Level);

impl ForLanes for Same {
    #[inline(always)]
    fn run<F: F32Lanes>(&self, token: F::Token) {
        let [xs, ys] = [12, 13].map(|seed| nasty(1 << 14, seed));
        macro_rules! check {
            ($($name:ident($($argument:ident),*))*) => {$({
                let mut found = vec![0; xs.len()];
                for at in (0..xs.len()).step_by(F::WIDTH) {
                    let result = math::lanes::$name(token, $(F::load_slice(token, &$argument[at..])),*);
                    result.to_bits().store_slice(&mut found[at..]);
                }
                let plain = |i: usize| math::$name($($argument[i]),*).to_bits();
                let what = format!("{} x{} {}", self.0, F::WIDTH, stringify!($name));
                compare(&what, &found, &(0..xs.len()).map(plain).collect::<Vec<_>>());
            })*};
        }
        check! { exp2(xs) exp(xs) log2(xs) ln(xs) sin(xs) cos(xs) tan(xs) acos(xs) asin(xs) atan2(ys, xs) pow(xs, ys)
        pow_of_fraction(xs, ys) }
    }
}

fn compare(what: &str, found: &[u32], plain: &[u32]) {
    for (i, (&found, &plain)) in found.iter().zip(plain).enumerate() {
        assert!(same_float(found, plain), "{what} of input {i}: {found:#x}, plain {plain:#x}");
    }
}

#[test]
fn same_bits_at_every_level() {
    for level in levels() {
        for_widths(level, &Same(level));
    }
}
