//! The renderer: batches of rays, generation by generation, without recursion.
//!
//! Rays wait in one queue for each generation. The deepest queue that is not empty is worked off first, a chunk at a
//! time, so that at most two chunks for each generation and one more wait at any moment, however many rays a sample
//! has.

use super::context::Context;
use super::lighting::LitPoints;
use super::probe::{Phase, Probe, watched};
use super::progress::Cancelled;
use super::queue::RayQueue;
use super::samples::Samples;
use super::shadow::ShadowBatch;
use super::vertex::Vertex;
use super::workspace::camera_tag;
use crate::ray::{HitBatch, RayBatch};
use crate::tree::Scratch;

/// Rays that are traced and shaded together: enough to keep the walks' lists long, few enough for the second-level
/// cache.
pub(super) const CHUNK: usize = 4096;

/// The memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Wavefront {
    queues: Vec<RayQueue>,
    chunk: RayQueue,
    hits: HitBatch,
    lit: LitPoints,
    shadows: ShadowBatch,
    scratch: Scratch,
}

impl Wavefront {
    /// Trace the camera rays, of the samples `numbers`, and all that descends from them. The rays are consumed.
    ///
    /// # Errors
    /// If the render was cancelled; the queues are then empty.
    pub(super) fn run<P: Probe>(
        &mut self,
        context: &Context,
        camera_rays: &mut RayBatch,
        numbers: &[u32],
        samples: &mut Samples,
        probe: &P,
    ) -> Result<(), Cancelled> {
        self.begin(camera_rays, numbers);
        while let Some(generation) = self.queues.iter().rposition(|queue| !queue.is_empty()) {
            if context.cancel.is_cancelled() {
                self.queues.iter_mut().for_each(RayQueue::clear);
                return Err(Cancelled);
            }
            watched(probe, Phase::Queue, || self.queues[generation].take(CHUNK, &mut self.chunk));
            watched(probe, Phase::Trace, || self.trace(context, samples));
            watched(probe, Phase::Shade, || self.shade(context, generation, samples));
            self.light(context, samples, probe);
        }
        Ok(())
    }

    fn begin(&mut self, camera_rays: &mut RayBatch, numbers: &[u32]) {
        if self.queues.is_empty() {
            self.queues.push(RayQueue::default());
        }
        let queue = &mut self.queues[0];
        queue.tags.extend(numbers.iter().copied().map(camera_tag));
        std::mem::swap(&mut queue.rays, camera_rays);
        camera_rays.clear();
    }

    fn trace(&mut self, context: &Context, samples: &mut Samples) {
        let counts = context.query.closest_hit(&self.chunk.rays, &mut self.hits, &mut self.scratch);
        samples.statistics += counts;
    }

    /// Make a vertex of each hit; add the light that needs no shadow ray; queue the next generation.
    fn shade(&mut self, context: &Context, generation: usize, samples: &mut Samples) {
        if self.queues.len() == generation + 1 {
            self.queues.push(RayQueue::default());
        }
        let next = &mut self.queues[generation + 1];
        self.lit.clear();
        for (index, tag) in self.chunk.tags.iter().enumerate() {
            let (ray, hit) = (self.chunk.rays.get(index), self.hits.get(index));
            if !hit.is_hit() {
                samples.add(tag.sample, context.look.background(ray.direction).times(tag.weight));
                continue;
            }
            let vertex = Vertex::new(context, &ray, &hit, tag);
            if generation == 0 {
                vertex.note_first(context, samples);
            }
            samples.add(tag.sample, vertex.ambient(context));
            let scattered = vertex.scatter(context, generation as u32, samples);
            for (ray, tag) in scattered.reflected.into_iter().chain(scattered.refracted) {
                next.push(&ray, tag);
            }
            if let Some(point) = vertex.lit(context) {
                self.lit.push(tag.sample, &point);
            }
        }
    }

    /// Add the light of every lamp to every vertex, lamp by lamp.
    fn light<P: Probe>(&mut self, context: &Context, samples: &mut Samples, probe: &P) {
        for (light, origin) in context.look.lights() {
            watched(probe, Phase::Shade, || {
                self.lit.light(context.execution.level, light, *origin, &mut self.shadows);
            });
            watched(probe, Phase::Shadow, || self.shadows.resolve(context, &mut self.scratch, samples));
        }
    }
}
