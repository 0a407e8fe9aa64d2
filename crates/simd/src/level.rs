//! Which instruction set to use: detected once, passed as a value.

use crate::scalar::Scalar;

/// An instruction set that this CPU has. Made once, passed as a value, consumed by [`dispatch`](crate::dispatch).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Level {
    /// Plain Rust, one lane after the other; present everywhere.
    Scalar(Scalar),
}

impl Level {
    /// The widest instruction set of this CPU.
    pub fn best() -> Self {
        *Self::available().last().expect("scalar is always available")
    }

    /// Every instruction set of this CPU, narrowest first. Never empty.
    pub fn available() -> Vec<Self> {
        vec![Self::Scalar(Scalar)]
    }

    /// The level called `name` (`scalar`, `sse4.2`, `avx2`, `avx512`), if this CPU has it.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::available().into_iter().find(|level| level.name() == name)
    }

    /// Short lower-case name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar(_) => "scalar",
        }
    }
}

impl PartialEq for Level {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Level {}
