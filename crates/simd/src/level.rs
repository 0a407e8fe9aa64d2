//! Which instruction set to use: detected once, passed as a value.

#[cfg(target_arch = "x86_64")]
use crate::{Avx2, Avx512, Sse42};
use crate::{Scalar, Simd};
use std::fmt;

/// An instruction set that this CPU has. Made once, passed as a value, consumed by [`dispatch`](crate::dispatch).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Level {
    /// Plain Rust, one lane after the other; present everywhere.
    Scalar(Scalar),
    /// Four lanes.
    #[cfg(target_arch = "x86_64")]
    Sse42(Sse42),
    /// Eight lanes and fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    /// Sixteen lanes and mask registers.
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Level {
    /// The widest instruction set of this CPU.
    pub fn best() -> Self {
        *Self::available().last().expect("scalar is always available")
    }

    /// Every instruction set of this CPU, narrowest first. Never empty.
    pub fn available() -> Vec<Self> {
        let levels = [
            Some(Self::Scalar(Scalar)),
            #[cfg(target_arch = "x86_64")]
            Sse42::detect().map(Self::Sse42),
            #[cfg(target_arch = "x86_64")]
            Avx2::detect().map(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            Avx512::detect().map(Self::Avx512),
        ];
        levels.into_iter().flatten().collect()
    }

    /// Every name that [`by_name`](Self::by_name) can know on some CPU, narrowest first.
    pub const fn names() -> &'static [&'static str] {
        &["scalar", "sse4.2", "avx2", "avx512"]
    }

    /// The level called `name` (see [`names`](Self::names)), if this CPU has it.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::available().into_iter().find(|level| level.name() == name)
    }

    /// Short lower-case name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scalar(_) => Scalar::NAME,
            #[cfg(target_arch = "x86_64")]
            Self::Sse42(_) => Sse42::NAME,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => Avx2::NAME,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => Avx512::NAME,
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl PartialEq for Level {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Level {}
