//! Which primitives camera rays hit.

use crate::ray::{HitBatch, RayBatch, Rays};
use crate::render::context::Context;
use crate::render::frame::Frame;
use crate::render::jitter::MIDDLE;
use crate::render::progress::Cancelled;
use crate::tree::Scratch;

/// The primitive that the first sample of each pixel of `frame` hits, row by row.
pub(super) fn primitives(context: &Context, frame: &Frame) -> Result<Vec<u32>, Cancelled> {
    let (mut rays, mut hits, mut scratch) = (RayBatch::default(), HitBatch::default(), Scratch::default());
    let mut primitives = Vec::with_capacity(frame.rect.len());
    for y in frame.rect.y..frame.rect.y + frame.rect.height {
        if context.cancel.is_cancelled() {
            return Err(Cancelled);
        }
        let columns = frame.rect.x..frame.rect.x + frame.rect.width;
        let x: Vec<f32> = columns.map(|x| x as f32 + MIDDLE[0]).collect();
        context.camera.fill(context.execution.level, &x, &vec![y as f32 + MIDDLE[1]; x.len()], &mut rays);
        context.query.closest_hit(Rays::from(&rays), &mut hits, &mut scratch);
        primitives.extend_from_slice(&hits.primitive);
    }
    Ok(primitives)
}
