//! Regions, batches, the generation loop, edge refinement and the film.

mod execution;
mod film;
mod progress;
mod statistics;

pub use execution::{Execution, Method, Region};
pub use film::Image;
pub use progress::{Cancel, Progress, Silent};
pub use statistics::Statistics;
