//! The paper's experiments, repeated: each table, each figure and each claim, measured in one run on the reader's
//! machine, beside what the paper prints and what twenty years of ideas add.
//!
//! # What this crate knows
//! Which variants each experiment compares and in which scenes; how to measure fairly; the report and its files.
//!
//! # Invariants
//! * Nothing is shown as measured that was not measured in this run; the paper's numbers are in `published.rs`, and shown
//!   as the paper's.
//! * Every pixel that a variant computes is compared with the default's; a variant that computes something else makes the
//!   report [`Ending::Wrong`](report::Ending::Wrong).
//! * A run that is stopped leaves a valid report of what it did.
//! * It reads no arguments, writes no file and prints nothing; the clock and the machine's name are all it asks for.

#![forbid(unsafe_code)]

mod draw;
mod experiment;
mod experiments;
pub mod machine;
mod measure;
mod plan;
mod published;
pub mod report;
mod session;

pub use experiment::Experiment;
pub use measure::{Check, Measured};
pub use plan::{Effort, Plan};
pub use session::{NoThreads, Watch, run};
