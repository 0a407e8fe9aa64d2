//! The paper's four-wide vector.

use crate::common::{SplitMix64, levels};
use simd::{Kernel, Level, Scalar, Simd, Vec4, dispatch};

/// Every operation on two vectors: the exact ones, then the lengths of the estimated unit vectors.
struct All([f32; 4], [f32; 4]);

impl Kernel for All {
    type Output = ([[f32; 4]; 7], [f32; 3]);
    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        assert_eq!((size_of::<Vec4<S>>(), align_of::<Vec4<S>>()), (16, 16));
        let (a, b) = (Vec4::new(token, self.0), Vec4::new(token, self.1));
        let exact = [
            (a + b).components(),
            (a - b).components(),
            (a * b).components(),
            a.cross(b).components(),
            a.normalize().components(),
            [a.dot(b); 4],
            (a * 3.5).components(),
        ];
        let [newton, raw] = [a.normalize_approx(), a.normalize_rsqrt()];
        let root = (a * a).sqrt_approx().components()[0] / self.0[0].abs();
        (exact, [newton.dot(newton).sqrt(), raw.dot(raw).sqrt(), root])
    }
}

fn check(level: Level, a: [f32; 4], b: [f32; 4]) {
    let (found, [newton, raw, root]) = dispatch(level, All(a, b));
    let (expected, _) = All(a, b).run(Scalar);
    let [[x, y, z, _], [p, q, r, _]] = [a, b];
    assert_eq!(found[5][0], x * p + y * q + z * r, "{level} {a:?} {b:?}");
    assert_eq!(found, expected, "{level} {a:?} {b:?}");
    assert!((newton - 1.0).abs() <= 1.0 / 1_048_576.0, "{level} {a:?}: {newton}");
    assert!((root - 1.0).abs() <= 1.0 / 1_048_576.0, "{level} {a:?}: {root}");
    assert!((raw - 1.0).abs() <= 1.5 / 4096.0, "{level} {a:?}: {raw}");
}

#[test]
fn vectors_are_those_of_plain_arithmetic() {
    let mut random = SplitMix64(4);
    for level in levels() {
        for _ in 0..20_000 {
            let [a, b] = [0; 2].map(|_| [0; 3].map(|_| random.next_f32() * 8.0 - 4.0)).map(|[x, y, z]| [x, y, z, 0.0]);
            check(level, a, b);
        }
    }
}

#[test]
fn known_products() {
    let v = |components| Vec4::new(Scalar, components);
    let (a, b) = (v([1.0, 2.0, 3.0, 0.0]), v([4.0, -5.0, 6.0, 0.0]));
    assert_eq!(a.cross(b).components(), [27.0, 6.0, -13.0, 0.0]);
    assert_eq!(a.dot(b), 12.0);
    assert_eq!(v([3.0, 0.0, -4.0, 0.0]).normalize().components(), [0.6, 0.0, -0.8, 0.0]);
    assert!(v([0.0; 4]).normalize().components()[0].is_nan());
}
