//! Regions, batches, the generation loop, edge refinement and the film.
//!
//! The path of a pixel: `frame` divides the picture into regions; a `workspace` makes the camera rays of one;
//! the `wavefront` (or its oracle, `recursive`) traces them and all that descends from them, making a `vertex`
//! of each hit, scattering rays from it and asking for `shadow`s; the `film` sums the light of each sample;
//! `edges` decides which pixels are sampled again. `aov` paints what else is known of a frame, and
//! `explain` tells everything about one pixel.

mod aov;
mod context;
mod edges;
mod execution;
mod explain;
mod film;
mod first_pass;
mod frame;
mod image;
mod jitter;
mod lighting;
mod media;
mod packing;
mod probe;
mod progress;
mod queue;
mod recorder;
mod recursive;
mod region;
mod rows;
mod samples;
mod scatter;
mod shadow;
mod source;
mod statistics;
mod vertex;
mod wavefront;
mod workspace;

pub use aov::{Aov, AovPicture, Clock, Legend, aovs, aovs_classic, heat};
pub use execution::{Execution, Method, Region};
pub use explain::{RayEnd, RayKind, RayTree, SampleTree, SurfaceHit, TracedRay, explain};
pub use first_pass::FirstSample;
pub use frame::{Classic, Frame, Renderer, render, render_classic, render_rect};
pub use image::Image;
pub use probe::{Phase, Probe, Unwatched};
pub use progress::{Cancel, Cancelled, Progress, Silent};
pub use region::PixelRect;
pub use statistics::Statistics;
