//! What all tests share: the levels to test, nasty numbers, and the names of the lane types.

use simd::{F32Lanes, Kernel, Level, Simd, U32Lanes, dispatch};

/// Every level of this CPU; fails if the one that `WHITTED_REQUIRE_ISA` names is not among them.
pub(crate) fn levels() -> Vec<Level> {
    let levels = Level::available();
    if let Ok(name) = std::env::var("WHITTED_REQUIRE_ISA") {
        assert!(Level::names().contains(&name.as_str()), "WHITTED_REQUIRE_ISA names no instruction set: {name}");
        assert!(Level::by_name(&name).is_some(), "WHITTED_REQUIRE_ISA: this CPU lacks {name}");
    }
    levels
}

/// Small, fast, good enough: Steele, Lea, Flood 2014.
pub(crate) struct SplitMix64(pub(crate) u64);

impl SplitMix64 {
    pub(crate) fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub(crate) fn next_u32(&mut self) -> u32 {
        (self.next_u64() >> 32) as u32
    }
    /// Uniform in 0..1.
    pub(crate) fn next_f32(&mut self) -> f32 {
        (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }
    /// Nasty numbers, any bits, and ordinary magnitudes, a third each.
    pub(crate) fn nasty_f32(&mut self) -> f32 {
        match self.next_u32() % 3 {
            0 => NASTY[self.next_u32() as usize % NASTY.len()],
            1 => f32::from_bits(self.next_u32()),
            _ => (self.next_f32() - 0.5) * 2f32.powi(self.next_u32() as i32 % 24),
        }
    }
}

/// Where float code goes wrong.
pub(crate) const NASTY: [f32; 36] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    -1.5,
    2.5,
    -2.5,
    0.1,
    -0.3,
    3.0,
    255.5,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1.1754942e-38,
    8388607.5,
    8388608.0,
    -8388608.5,
    16777216.0,
    16777217.0,
    1e9,
    -1e9,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    f32::EPSILON,
    0.99999994,
    1.0000001,
    -0.99999994,
    1e20,
];

/// `count` nasty numbers.
pub(crate) fn nasty(count: usize, seed: u64) -> Vec<f32> {
    let mut random = SplitMix64(seed);
    (0..count).map(|_| random.nasty_f32()).collect()
}

/// A test body that runs for one lane type.
pub(crate) trait ForLanes {
    fn run<F: F32Lanes>(&self, token: F::Token);
}

/// Run `body` with 4, 8 and 16 lanes of `level`.
pub(crate) fn for_widths(level: Level, body: &impl ForLanes) {
    struct Widths<'a, B>(&'a B);
    impl<B: ForLanes> Kernel for Widths<'_, B> {
        type Output = ();
        #[inline(always)]
        fn run<S: Simd>(self, token: S) {
            self.0.run::<S::F32x4>(token);
            self.0.run::<S::F32x8>(token);
            self.0.run::<S::F32x16>(token);
        }
    }
    dispatch(level, Widths(body));
}

/// The lanes as a list of bits.
pub(crate) fn bits_of<U: U32Lanes>(lanes: U) -> Vec<u32> {
    let mut array = U::Array::default();
    lanes.store(&mut array);
    array.as_ref().to_vec()
}

/// Same bits, or both NaN: the payload of a computed NaN is nobody's promise.
pub(crate) fn same_float(a: u32, b: u32) -> bool {
    a == b || f32::from_bits(a).is_nan() && f32::from_bits(b).is_nan()
}
