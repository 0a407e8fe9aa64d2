//! Why a pixel looks as it does: every ray of its samples.
//!
//! The recursive renderer traces the pixel once more and is listened to: nothing is computed twice in two ways, and the
//! light of all rays of a sample adds up to its colour, to the bit.

mod record;
mod tree;

pub use tree::{RayEnd, RayKind, RayTree, SampleTree, SurfaceHit, TracedRay};

use super::context::Context;
use super::execution::{Execution, Method};
use super::frame::render_rect;
use super::jitter::Jitter;
use super::probe::Unwatched;
use super::progress::{Cancel, Cancelled, Silent};
use super::region::PixelRect;
use super::workspace::Workspace;
use crate::scene::{Prepared, Settings};
use record::Recording;
use std::ops::Range;

/// Trace the pixel (`x`, `y`) of the picture once more, and tell everything about the rays of those of its samples that
/// lie in `samples`.
///
/// Sample 0 is in the middle; a pixel that is not supersampled has no other. Outside the picture there are none. A
/// sample may have up to 65536 rays that are not shadow rays.
///
/// # Errors
/// If `cancel` was set.
pub fn explain(
    prepared: &Prepared,
    settings: &Settings,
    [x, y]: [u32; 2],
    samples: Range<u32>,
    cancel: &Cancel,
) -> Result<RayTree, Cancelled> {
    let rect = PixelRect { x, y, width: 1, height: 1 };
    let execution = Execution { method: Method::Recursive, ..Execution::default() };
    let frame = render_rect(prepared, settings, &execution, &rect, &Silent, cancel, &Unwatched)?;
    let (Some(&color), Some(&supersampled)) = (frame.image.pixels.first(), frame.supersampled.first()) else {
        return Ok(RayTree::outside([x, y]));
    };
    let jitter = Jitter::new(settings);
    let sample_count = if supersampled { jitter.samples() } else { 1 };
    let context = Context::new(prepared, settings, &execution, cancel);
    let mut recording = Recording::new(&context);
    let samples = samples.start..samples.end.min(sample_count);
    let colors = Workspace::default().record(&context, &jitter, [x, y], samples.clone(), &mut recording)?;
    let samples = samples.zip(colors).zip(recording.finish());
    let samples = samples.map(|((number, color), (place, rays))| SampleTree { number, place, color, rays });
    Ok(RayTree { pixel: [x, y], sample_count, color, samples: samples.collect() })
}
