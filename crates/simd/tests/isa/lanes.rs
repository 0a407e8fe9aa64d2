//! Every lane operation at every level of this CPU, against plain Rust on one lane.

use crate::common::{ForLanes, NASTY, SplitMix64, bits_of, for_widths, levels, nasty, same_float};
use simd::{F32Lanes, Kernel, Level, MaskLanes, Scalar, ScalarF32, Simd, U32Lanes, dispatch, lanes_from_fn};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What an operation does to three floats and three integers, as bits; a mask counts as 1 or 0.
trait Operation {
    const NAME: &'static str;
    /// If a result may be a computed NaN, whose payload is free.
    const FLOAT: bool;
    fn apply<F: F32Lanes>(token: F::Token, f: [F; 3], u: [F::U32; 3]) -> F::U32;
}

macro_rules! operations {
    ($run:ident: $($name:ident $float:literal |$token:ident, $f:pat_param, $u:pat_param| $body:expr;)*) => {
        $(
            #[expect(non_camel_case_types, reason = "named like the operation")]
            struct $name;
            impl Operation for $name {
                const NAME: &'static str = stringify!($name);
                const FLOAT: bool = $float;
                #[inline(always)]
                fn apply<F: F32Lanes>($token: F::Token, $f: [F; 3], $u: [F::U32; 3]) -> F::U32 {
                    $body
                }
            }
        )*
        fn $run(level: Level, inputs: &[Vec<u32>; 3]) {
            $(for_widths(level, &Compare::<$name>::new(level, inputs));)*
        }
    };
}

#[inline(always)]
fn one<F: F32Lanes>(token: F::Token, mask: F::Mask) -> F::U32 {
    F::U32::select(mask, F::U32::splat(token, 1), F::U32::splat(token, 0))
}

operations! { run_all:
    add true |_t, [a, b, _], _| (a + b).to_bits();
    sub true |_t, [a, b, _], _| (a - b).to_bits();
    mul true |_t, [a, b, _], _| (a * b).to_bits();
    div true |_t, [a, b, _], _| (a / b).to_bits();
    sqrt true |_t, [a, _, _], _| a.sqrt().to_bits();
    fma true |_t, [a, b, c], _| a.fma(b, c).to_bits();
    floor true |_t, [a, _, _], _| a.floor().to_bits();
    neg false |_t, [a, _, _], _| (-a).to_bits();
    abs false |_t, [a, _, _], _| a.abs().to_bits();
    min false |_t, [a, b, _], _| a.min(b).to_bits();
    max false |_t, [a, b, _], _| a.max(b).to_bits();
    lt false |t, [a, b, _], _| one::<F>(t, a.lt(b));
    le false |t, [a, b, _], _| one::<F>(t, a.le(b));
    eq false |t, [a, b, _], _| one::<F>(t, a.eq(b));
    gt false |t, [a, b, _], _| one::<F>(t, a.gt(b));
    ge false |t, [a, b, _], _| one::<F>(t, a.ge(b));
    select_float false |_t, [a, b, c], _| F::select(a.lt(b), b, c).to_bits();
    round_trip false |_t, [a, _, _], _| F::from_bits(a.to_bits()).to_bits();
    round_to_int false |t, [a, _, _], _| {
        let limit = F::splat(t, (1 << 30) as f32);
        F::select(a.abs().le(limit), a, limit).round_to_int()
    };
    from_int false |_t, _, [a, _, _]| F::from_int(a).to_bits();
    add_u32 false |_t, _, [a, b, _]| a + b;
    sub_u32 false |_t, _, [a, b, _]| a - b;
    mul_u32 false |_t, _, [a, b, _]| a * b;
    and_u32 false |_t, _, [a, b, _]| a & b;
    or_u32 false |_t, _, [a, b, _]| a | b;
    xor_u32 false |_t, _, [a, b, _]| a ^ b;
    not_u32 false |_t, _, [a, _, _]| !a;
    shl_0 false |_t, _, [a, _, _]| a.shl::<0>();
    shl_7 false |_t, _, [a, _, _]| a.shl::<7>();
    shr_23 false |_t, _, [a, _, _]| a.shr::<23>();
    sar_23 false |_t, _, [a, _, _]| a.sar::<23>();
    sar_31 false |_t, _, [a, _, _]| a.sar::<31>();
    eq_u32 false |t, _, [a, b, _]| one::<F>(t, a.eq(b));
    lt_u32 false |t, _, [a, b, _]| one::<F>(t, a.lt(b));
    select_u32 false |_t, _, [a, b, c]| F::U32::select(a.lt(b), b, c);
    mask_and false |t, [a, b, c], _| one::<F>(t, a.lt(b) & b.lt(c));
    mask_or false |t, [a, b, c], _| one::<F>(t, a.lt(b) | b.lt(c));
    mask_xor false |t, [a, b, c], _| one::<F>(t, a.lt(b) ^ b.lt(c));
    mask_not false |t, [a, b, _], _| one::<F>(t, !a.lt(b));
    mask_bits false |t, [a, b, _], _| one::<F>(t, MaskLanes::from_bits(t, a.lt(b).bits()));
}

struct Compare<'a, O> {
    level: Level,
    inputs: &'a [Vec<u32>; 3],
    expected: Vec<u32>,
    operation: std::marker::PhantomData<O>,
}

impl<'a, O: Operation> Compare<'a, O> {
    fn new(level: Level, inputs: &'a [Vec<u32>; 3]) -> Self {
        let expected = apply_to_all::<O, ScalarF32<1>>(Scalar, inputs);
        Self { level, inputs, expected, operation: std::marker::PhantomData }
    }
}

impl<O: Operation> ForLanes for Compare<'_, O> {
    #[inline(always)]
    fn run<F: F32Lanes>(&self, token: F::Token) {
        let found = apply_to_all::<O, F>(token, self.inputs);
        compare(&format!("{} x{} {}", self.level, F::WIDTH, O::NAME), O::FLOAT, self.inputs, &found, &self.expected);
    }
}

#[inline(always)]
fn apply_to_all<O: Operation, F: F32Lanes>(token: F::Token, inputs: &[Vec<u32>; 3]) -> Vec<u32> {
    let mut found = vec![0; inputs[0].len()];
    for at in (0..found.len()).step_by(F::WIDTH) {
        let u = lanes_from_fn(|of| F::U32::load_slice(token, &inputs[of][at..]));
        O::apply::<F>(token, lanes_from_fn(|of| F::from_bits(u[of])), u).store_slice(&mut found[at..]);
    }
    found
}

fn compare(what: &str, float: bool, inputs: &[Vec<u32>; 3], found: &[u32], expected: &[u32]) {
    for (i, (&found, &expected)) in found.iter().zip(expected).enumerate() {
        let same = if float { same_float(found, expected) } else { found == expected };
        let bits = [0, 1, 2].map(|of| inputs[of][i]);
        let floats = bits.map(f32::from_bits);
        assert!(same, "{what}: {found:#x} but scalar {expected:#x} for {bits:x?} = {floats:?}");
    }
}

/// Three columns: all triples of few nasty numbers, all pairs of all of them, then random ones; a multiple of 16.
fn inputs() -> [Vec<u32>; 3] {
    let mut columns: [Vec<u32>; 3] = Default::default();
    let mut push = |a: f32, b: f32, c: f32| {
        for (column, value) in columns.iter_mut().zip([a, b, c]) {
            column.push(value.to_bits());
        }
    };
    for a in NASTY {
        for b in NASTY {
            push(a, b, -a);
            push(a, b, NASTY[11]);
            push(b, 1.0000001, a);
        }
    }
    let mut random = SplitMix64(1);
    for _ in 0..20_000 {
        push(random.nasty_f32(), random.nasty_f32(), random.nasty_f32());
    }
    let whole = columns[0].len() / 16 * 16;
    columns.map(|mut column| {
        column.truncate(whole);
        column
    })
}

#[test]
fn every_operation_equals_scalar() {
    let inputs = inputs();
    for level in levels() {
        run_all(level, &inputs);
    }
}

/// Loads, stores, splats, gathers, reductions, estimates: what is not lane by lane.
struct Across(Level);

impl ForLanes for Across {
    #[inline(always)]
    fn run<F: F32Lanes>(&self, token: F::Token) {
        let values = nasty(4096, 7);
        let mut random = SplitMix64(3);
        for _ in 0..2000 {
            let start = random.next_u32() as usize % (values.len() - F::WIDTH);
            let lanes = F::load_slice(token, &values[start..]);
            let expected = &values[start..start + F::WIDTH];
            self.check_memory(token, lanes, expected);
            self.check_reductions(lanes, expected);
            self.check_gather::<F>(token, &values, &mut random);
            self.check_accumulate::<F>(token, &mut random);
            self.check_mask::<F>(token, random.next_u32());
        }
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

impl Across {
    fn check_memory<F: F32Lanes>(&self, token: F::Token, lanes: F, expected: &[f32]) {
        let mut array = F::Array::default();
        lanes.store(&mut array);
        assert_eq!(bits(array.as_ref()), bits(expected), "{} x{}", self.0, F::WIDTH);
        assert_eq!(bits_of(F::load(token, &array).to_bits()), bits(expected));
        let mut longer = [0.25; 20];
        lanes.store_slice(&mut longer[1..]);
        assert_eq!(bits(&longer[1..=F::WIDTH]), bits(expected));
        assert!(longer[0] == 0.25 && longer[F::WIDTH + 1] == 0.25, "a store wrote beside its lanes");
        let first = expected[0];
        assert_eq!(bits_of(F::splat(token, first).to_bits()), vec![first.to_bits(); F::WIDTH]);
        assert_eq!(bits_of(F::U32::splat(token, first.to_bits())), vec![first.to_bits(); F::WIDTH]);
    }

    fn check_reductions<F: F32Lanes>(&self, lanes: F, expected: &[f32]) {
        let mut sum = expected.to_vec();
        let mut low = expected.to_vec();
        let mut high = expected.to_vec();
        while low.len() > 1 {
            let half = low.len() / 2;
            let fold = |v: &[f32], f: fn(f32, f32) -> f32| (0..half).map(|i| f(v[i], v[i + half])).collect::<Vec<_>>();
            sum = fold(&sum, |a, b| a + b);
            low = fold(&low, |a, b| if a < b { a } else { b });
            high = fold(&high, |a, b| if a > b { a } else { b });
        }
        assert!(same_float(lanes.reduce_add().to_bits(), sum[0].to_bits()), "{} x{}", self.0, F::WIDTH);
        assert_eq!(lanes.reduce_min().to_bits(), low[0].to_bits(), "{} x{}", self.0, F::WIDTH);
        assert_eq!(lanes.reduce_max().to_bits(), high[0].to_bits(), "{} x{}", self.0, F::WIDTH);
    }

    fn check_gather<F: F32Lanes>(&self, token: F::Token, table: &[f32], random: &mut SplitMix64) {
        let at: Vec<u32> = (0..F::WIDTH).map(|_| random.next_u32() % table.len() as u32).collect();
        let expected: Vec<u32> = at.iter().map(|&i| table[i as usize].to_bits()).collect();
        let index = F::U32::load_slice(token, &at);
        assert_eq!(bits_of(F::gather(table, index).to_bits()), expected, "{} x{}", self.0, F::WIDTH);
        self.check_columns::<F, 3>(token, table, &at, F::gather_x3);
        self.check_columns::<F, 4>(token, table, &at, F::gather_x4);
        let table: Vec<u32> = bits(table);
        assert_eq!(bits_of(F::U32::gather(&table, index)), expected, "{} x{}", self.0, F::WIDTH);
        let (rows, _) = table.as_chunks::<3>();
        let last = rows.len() as u32 - 1;
        for (k, column) in F::U32::gather_x3(rows, F::U32::splat(token, last)).into_iter().enumerate() {
            assert_eq!(bits_of(column), vec![rows[last as usize][k]; F::WIDTH], "{} x{}", self.0, F::WIDTH);
        }
    }

    fn check_columns<F: F32Lanes, const K: usize>(
        &self,
        token: F::Token,
        table: &[f32],
        at: &[u32],
        gather: fn(&[[f32; K]], F::U32) -> [F; K],
    ) {
        let (rows, _) = table.as_chunks::<K>();
        let places: Vec<u32> = at.iter().map(|i| i % rows.len() as u32).collect();
        for (k, column) in gather(rows, F::U32::load_slice(token, &places)).into_iter().enumerate() {
            let expected: Vec<u32> = places.iter().map(|&i| rows[i as usize][k].to_bits()).collect();
            assert_eq!(bits_of(column.to_bits()), expected, "{} x{}, column {k} of {K}", self.0, F::WIDTH);
        }
    }

    /// Rows are met more than once, and sums reach the end of their range.
    fn check_accumulate<F: F32Lanes>(&self, token: F::Token, random: &mut SplitMix64) {
        const LARGEST: f32 = (1u64 << 62) as f32;
        let mut table: [[i64; 4]; 5] = std::array::from_fn(|_| {
            std::array::from_fn(|_| {
                if random.next_u32().is_multiple_of(3) { i64::MAX - 5 } else { random.next_u32().into() }
            })
        });
        let at: Vec<u32> = (0..F::WIDTH).map(|_| random.next_u32() % 5).collect();
        let number = |random: &mut SplitMix64| [0.0, 0.99, 3.7, 1e9, 1e18, LARGEST][random.next_u32() as usize % 6];
        let rows: [Vec<f32>; 4] = std::array::from_fn(|_| (0..F::WIDTH).map(|_| number(random)).collect());
        let bits = random.next_u32();
        let mut expected = table;
        for lane in (0..F::WIDTH).filter(|lane| bits >> lane & 1 != 0) {
            for (k, sum) in expected[at[lane] as usize].iter_mut().enumerate() {
                *sum = sum.saturating_add(rows[k][lane] as i64);
            }
        }
        let mut addends = [F::splat(token, 0.0); 4];
        for (addend, row) in addends.iter_mut().zip(&rows) {
            *addend = F::load_slice(token, row);
        }
        let mask = F::Mask::from_bits(token, bits);
        F::accumulate(addends, mask, F::U32::load_slice(token, &at), &mut table);
        assert_eq!(table, expected, "{} x{}", self.0, F::WIDTH);
    }

    fn check_mask<F: F32Lanes>(&self, token: F::Token, bits: u32) {
        let all = u32::MAX >> (32 - F::WIDTH);
        for bits in [bits, 0, all, all << 1, bits | bits >> 8 | bits >> 16] {
            let mask = F::Mask::from_bits(token, bits);
            assert_eq!(mask.bits(), bits & all, "{} x{}", self.0, F::WIDTH);
            assert_eq!((!mask).bits(), !bits & all);
            assert_eq!((mask.any(), mask.all()), (bits & all != 0, bits & all == all));
        }
    }
}

#[test]
fn memory_reductions_gathers_and_masks() {
    for level in levels() {
        for_widths(level, &Across(level));
    }
}

#[test]
fn gather_panics_out_of_range() {
    struct Outside(usize, u32);
    impl ForLanes for Outside {
        fn run<F: F32Lanes>(&self, token: F::Token) {
            let table = [0.5; 7];
            let mut at = vec![6; F::WIDTH];
            at[self.0 % F::WIDTH] = self.1;
            let index = F::U32::load_slice(token, &at);
            let float = catch_unwind(AssertUnwindSafe(|| bits_of(F::gather(&table, index).to_bits())));
            let int = catch_unwind(AssertUnwindSafe(|| bits_of(F::U32::gather(&[5; 7], index))));
            let three = catch_unwind(AssertUnwindSafe(|| bits_of(F::gather_x3(&[[0.5; 3]; 7], index)[2].to_bits())));
            let four = catch_unwind(AssertUnwindSafe(|| bits_of(F::gather_x4(&[[0.5; 4]; 7], index)[3].to_bits())));
            assert_eq!((float.is_err(), int.is_err()), (self.1 > 6, self.1 > 6), "x{} index {}", F::WIDTH, self.1);
            assert_eq!((three.is_err(), four.is_err()), (self.1 > 6, self.1 > 6), "x{} index {}", F::WIDTH, self.1);
        }
    }
    let silent = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let result = catch_unwind(|| {
        for level in levels() {
            for lane in 0..16 {
                for index in [6, 7, 8, 1 << 31, u32::MAX] {
                    for_widths(level, &Outside(lane, index));
                }
            }
        }
    });
    std::panic::set_hook(silent);
    result.unwrap();
}

/// Estimates and the free fused multiply-add: within what they promise.
struct Estimates(Level);

impl ForLanes for Estimates {
    fn run<F: F32Lanes>(&self, token: F::Token) {
        let mut random = SplitMix64(11);
        let bound = 1.5 / 4096.0;
        for _ in 0..20_000 {
            let x = (1.0 + random.next_f32()) * 2f32.powi(random.next_u32() as i32 % 60);
            let y = random.next_f32();
            let lanes = F::splat(token, x);
            let close = |found: F, expected: f64| {
                let error = (f64::from(found.reduce_min()) / expected - 1.0).abs();
                assert!(error <= bound, "{} x{}: {x} has error {error}", self.0, F::WIDTH);
            };
            close(lanes.recip_approx(), 1.0 / f64::from(x));
            close(lanes.rsqrt_approx(), 1.0 / f64::from(x).sqrt());
            let free = lanes.mul_add_fast(lanes, F::splat(token, y)).reduce_max();
            assert!(free == x * x + y || free == x.mul_add(x, y), "{} x{}", self.0, F::WIDTH);
        }
    }
}

#[test]
fn estimates_keep_their_bounds() {
    for level in levels() {
        for_widths(level, &Estimates(level));
    }
}

/// The name of the instruction set that a kernel is compiled for.
struct Name;

impl Kernel for Name {
    type Output = &'static str;
    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> &'static str {
        S::NAME
    }
}

#[test]
fn dispatch_enters_the_level_asked_for() {
    for level in levels() {
        assert_eq!(dispatch(level, Name), level.name());
        assert_eq!(level.to_string(), level.name());
        assert_eq!(Level::by_name(level.name()), Some(level));
        assert!(Level::names().contains(&level.name()));
    }
    assert_eq!(Level::best(), *levels().last().unwrap());
    assert_eq!(Level::by_name("mmx"), None);
}
