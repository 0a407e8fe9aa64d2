//! The repetitive part of a register type, written once.
//!
//! Each macro that takes intrinsics holds the one `unsafe` block for all of them.

/// A token, `detect`, and `enter`, from one list of features: what is detected is what is enabled.
macro_rules! token {
    ($(#[$doc:meta])* $name:ident: $($feature:tt)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name(());

        impl $name {
            /// The token, if this CPU (and operating system) has every feature of the instruction set.
            pub fn detect() -> Option<Self> {
                ($(std::arch::is_x86_feature_detected!($feature))&&*).then_some(Self(()))
            }

            /// Run `kernel` compiled for this instruction set.
            #[inline]
            pub(crate) fn enter<K: $crate::Kernel>(self, kernel: K) -> K::Output {
                $(#[target_feature(enable = $feature)])*
                fn entered<K: $crate::Kernel>(token: $name, kernel: K) -> K::Output {
                    kernel.run(token)
                }
                // SAFETY: `self` exists, so `detect` has seen every feature in the list.
                unsafe { entered(self, kernel) }
            }
        }
    };
}

/// A register type: a raw register and the token that proves that it may be used.
macro_rules! register {
    ($(#[$doc:meta])* $name:ident $(<$generic:ident>)? ($raw:ty, $token:ty)) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name $(<$generic>)? (pub(super) $raw, pub(super) $token);

        impl $(<$generic>)? $name $(<$generic>)? {
            #[inline(always)]
            pub(super) fn wrap(raw: $raw, token: $token) -> Self {
                Self(raw, token)
            }
        }
    };
}

/// Operators of a register type: `Add add(a, b) = intrinsic(a, b);`, with raw registers in the body.
macro_rules! operators {
    (impl $generics:tt $type:ty; $($trait:ident $name:ident $parameters:tt = $body:expr;)*) => {
        $(operator!(impl $generics $type; $trait $name $parameters = $body);)*
    };
}

macro_rules! operator {
    (impl [$($generics:tt)*] $type:ty; $trait:ident $name:ident($a:ident $(, $b:ident)?) = $body:expr) => {
        impl<$($generics)*> std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $name(self $(, $b: Self)?) -> Self {
                let $a = self.0;
                $(let $b = $b.0;)?
                // SAFETY: `self` exists, so the CPU has the token's features.
                Self::wrap(unsafe { $body }, self.1)
            }
        }
    };
}

/// Methods of a register type: `name(a, b: Type) -> Type = intrinsic(a, b);`, with raw registers in the body.
macro_rules! methods {
    ($($name:ident($a:ident $(, $b:ident)*) -> $out:ty = $body:expr;)*) => {$(
        #[inline(always)]
        fn $name(self $(, $b: Self)*) -> $out {
            let $a = self.0;
            $(let $b = $b.0;)*
            // SAFETY: `self` exists, so the CPU has the token's features.
            <$out>::wrap(unsafe { $body }, self.1)
        }
    )*};
}

/// Functions from one raw register to another: `from_bits(bits: U32) = cast(bits);`.
macro_rules! conversions {
    ($($name:ident($a:ident: $type:ty) = $body:expr;)*) => {$(
        #[inline(always)]
        fn $name($a: $type) -> Self {
            let ($a, token) = ($a.0, $a.1);
            // SAFETY: `token` exists, so the CPU has its features.
            Self::wrap(unsafe { $body }, token)
        }
    )*};
}

/// `select` from raw registers.
macro_rules! select {
    (|$mask:ident, $set:ident, $unset:ident| $body:expr) => {
        #[inline(always)]
        fn select(mask: Self::Mask, set: Self, unset: Self) -> Self {
            let ($mask, $set, $unset, token) = (mask.0, set.0, unset.0, set.1);
            // SAFETY: `token` exists, so the CPU has its features.
            Self::wrap(unsafe { $body }, token)
        }
    };
}

/// `compress_store` by a shuffle of a whole register.
macro_rules! compress_store {
    ($element:ident; |$mask:ident, $lanes:ident| $body:expr) => {
        #[inline(always)]
        fn compress_store(self, mask: Self::Mask, to: &mut [$element]) {
            let ($mask, $lanes) = (mask.0, self.0);
            // SAFETY: `self` exists, so the CPU has the token's features.
            Self::wrap(unsafe { $body }, self.1).store_slice(to);
        }
    };
}

/// Shifts by a constant, given the constant count as `$n`.
macro_rules! shifts {
    ($($name:ident<$n:ident>($a:ident) = $body:expr;)*) => {$(
        #[inline(always)]
        fn $name<const $n: u32>(self) -> Self {
            const { assert!($n < 32) };
            let $a = self.0;
            // SAFETY: `self` exists, so the CPU has the token's features.
            Self::wrap(unsafe { $body }, self.1)
        }
    )*};
}

/// Broadcast, loads and stores of `$n` elements.
macro_rules! memory {
    ($element:ident $n:literal; splat($value:ident) = $splat:expr; load($from:ident) = $load:expr;
     store($to:ident, $a:ident) = $store:expr;) => {
        const WIDTH: usize = $n;

        #[inline(always)]
        fn splat(token: Self::Token, $value: $element) -> Self {
            // SAFETY: `token` exists, so the CPU has its features.
            Self::wrap(unsafe { $splat }, token)
        }
        #[inline(always)]
        fn load(token: Self::Token, from: &[$element; $n]) -> Self {
            let $from = from.as_ptr();
            // SAFETY: `token` exists; the pointer is good for reading the whole array, and no alignment is needed.
            Self::wrap(unsafe { $load }, token)
        }
        #[inline(always)]
        fn store(self, to: &mut [$element; $n]) {
            let ($to, $a) = (to.as_mut_ptr(), self.0);
            // SAFETY: `self` exists; the pointer is good for writing the whole array, and no alignment is needed.
            unsafe { $store }
        }
        #[inline(always)]
        fn load_slice(token: Self::Token, from: &[$element]) -> Self {
            Self::load(token, from.first_chunk().expect("slice shorter than the lanes"))
        }
        #[inline(always)]
        fn store_slice(self, to: &mut [$element]) {
            self.store(to.first_chunk_mut().expect("slice shorter than the lanes"));
        }
    };
}

/// A gather by hardware: all lanes are compared with the length first.
///
/// The hardware takes signed indices, so a lane of 2³¹ or more also goes the slow way, which indexes the table safely
/// (and panics if that fails).
macro_rules! hardware_gather {
    ($element:ident, $index:ty; |$from:ident, $at:ident| $body:expr) => {
        #[inline(always)]
        fn gather(table: &[$element], index: $index) -> Self {
            let limit = table.len().min(1 << 31) as u32;
            let ($from, $at, token) = (table.as_ptr(), index.0, index.1);
            if index.lt(<$index>::splat(token, limit)).all() {
                // SAFETY: `token` exists; every lane is below the length of the table, and positive as an `i32`.
                Self::wrap(unsafe { $body }, token)
            } else {
                let mut lanes = [0; Self::WIDTH];
                index.store(&mut lanes);
                Self::load(token, &super::gather_safely(table, lanes))
            }
        }
    };
}

/// Gathers of three and of four neighbours: one read for each lane, turned in registers by `columns` of the token.
macro_rules! gather_rows {
    ($columns:ident) => {
        gather_rows!($columns, gather_x4, 4, F32x4::load);
        gather_rows!($columns, gather_x3, 3, F32x4::load_three);
    };
    ($columns:ident, $name:ident, $count:literal, $load:path) => {
        #[inline(always)]
        fn $name(table: &[[f32; $count]], index: Self::U32) -> [Self; $count] {
            let token = index.1;
            let limit = table.len().min(u32::MAX as usize) as u32;
            assert!(index.lt(Self::U32::splat(token, limit)).all(), "an index is beyond the table");
            let mut numbers = [0; Self::WIDTH];
            index.store(&mut numbers);
            let mut rows = [F32x4::splat(token, 0.0); Self::WIDTH];
            for lane in 0..Self::WIDTH {
                // SAFETY: every lane is below the length of the table (asserted above). Checked one by one, the loop would
                // not be unrolled, and the rows would go through memory.
                rows[lane] = $load(token, unsafe { table.get_unchecked(numbers[lane] as usize) });
            }
            *crate::Simd::$columns(token, rows).first_chunk().expect("no more than four")
        }
    };
}

/// The transpositions of [`Simd`](crate::Simd), for tokens whose `F32x8` is one register.
macro_rules! transposes {
    () => {
        #[inline(always)]
        fn transpose(self, rows: [F32x8; 8]) -> [F32x8; 8] {
            let [a, b, c, d, e, f, g, h] = rows;
            let rows = [a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0];
            // SAFETY: the token exists, so the CPU has its features.
            let [a, b, c, d, e, f, g, h] = unsafe { super::transpose::transpose_8x8(rows) };
            let wrap = F32x8::wrap;
            [
                wrap(a, self),
                wrap(b, self),
                wrap(c, self),
                wrap(d, self),
                wrap(e, self),
                wrap(f, self),
                wrap(g, self),
                wrap(h, self),
            ]
        }
        #[inline(always)]
        fn columns_x8(self, rows: [F32x4<Self>; 8]) -> [F32x8; 4] {
            let [a, b, c, d, e, f, g, h] = rows;
            let rows = [a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0];
            // SAFETY: the token exists, so the CPU has its features.
            let [x, y, z, w] = unsafe { super::transpose::transpose_8x4(rows) };
            [F32x8::wrap(x, self), F32x8::wrap(y, self), F32x8::wrap(z, self), F32x8::wrap(w, self)]
        }
    };
}

/// Implements [`Sse`](super::x4::Sse) for a token that has fused multiply-add.
macro_rules! sse_with_fma {
    ($token:ty) => {
        impl Sse for $token {
            #[inline(always)]
            fn fma(self, a: __m128, b: __m128, c: __m128) -> __m128 {
                // SAFETY: the token exists, so the CPU has its features.
                unsafe { _mm_fmadd_ps(a, b, c) }
            }
            #[inline(always)]
            fn mul_add_fast(self, a: __m128, b: __m128, c: __m128) -> __m128 {
                self.fma(a, b, c)
            }
            #[inline(always)]
            fn load_three(self, from: &[f32; 3]) -> __m128 {
                // SAFETY: the token exists; what the mask leaves out is not read.
                unsafe { _mm_maskload_ps(from.as_ptr(), _mm_setr_epi32(-1, -1, -1, 0)) }
            }
        }
    };
}
