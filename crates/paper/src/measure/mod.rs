//! How measurements are taken: in turn, by CPU time, with a check of what was computed.

mod check;
mod clock;
mod contest;
mod rounds;
mod sample;

pub use check::Check;
pub(crate) use check::{Bound, Reference};
pub(crate) use clock::{Threads, thread_seconds};
pub(crate) use contest::{Contestant, Rendered, Spread, Stage, contest};
pub use rounds::Measured;
pub(crate) use rounds::{Rounds, interleaved};
pub(crate) use sample::Sample;
