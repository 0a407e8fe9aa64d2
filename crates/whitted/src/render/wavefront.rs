//! The renderer: batches of rays, generation by generation, without recursion.
//!
//! Rays wait in one queue for each generation. The deepest queue that is not empty is worked off first, a chunk at a
//! time, so that at most two chunks for each generation and one more wait at any moment, however many rays a sample
//! has. Shadow rays wait for those of other generations: the more there are of one light, the better they pack.

use super::context::Context;
use super::lighting::LitPoints;
use super::media::Media;
use super::probe::{Phase, Probe, watched};
use super::progress::Cancelled;
use super::queue::{RayQueue, Tag, TaggedRays};
use super::recorder::Unrecorded;
use super::rows::{BLOCK, first_lanes};
use super::samples::Samples;
use super::scatter::{RAYS_PER_SAMPLE, Scattered};
use super::shadow::ShadowBatch;
use super::vertex::Vertex;
use super::workspace::Places;
use crate::math::Vec3;
use crate::ray::{HitBatch, NONE};
use crate::tree::Scratch;
use simd::{F32Lanes, Kernel, MaskLanes, Simd, U32Lanes};

/// Rays that are traced and shaded together: enough to keep the walks' lists long. Fewer fit the second-level cache
/// better and gain nothing (docs/decisions/0002).
pub(super) const CHUNK: usize = 4096;

/// Shadow rays of all lights that wait before any is traced: the more there are, the narrower are their packets.
const SHADOWS: usize = 65536;

/// The memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Wavefront {
    queues: Vec<RayQueue>,
    hits: HitBatch,
    lit: LitPoints,
    /// One for each light.
    shadows: Vec<ShadowBatch>,
    scratch: Scratch,
}

impl Wavefront {
    /// Trace the camera rays through `places`, and all that descends from them.
    ///
    /// # Errors
    /// If the render was cancelled.
    pub(super) fn run<P: Probe>(
        &mut self,
        context: &Context,
        places: &Places,
        samples: &mut Samples,
        probe: &P,
    ) -> Result<(), Cancelled> {
        watched(probe, Phase::Queue, || self.begin(context, places));
        while let Some(generation) = self.queues.iter().rposition(|queue| !queue.is_empty()) {
            if context.cancel.is_cancelled() {
                return Err(Cancelled);
            }
            self.step(context, generation, samples, probe);
        }
        let Self { shadows, scratch, .. } = self;
        watched(probe, Phase::Shadow, || {
            shadows.iter_mut().for_each(|shadows| shadows.resolve(context, scratch, samples));
        });
        Ok(())
    }

    /// Start over with the camera rays.
    fn begin(&mut self, context: &Context, places: &Places) {
        if self.queues.is_empty() {
            self.queues.push(RayQueue::default());
        }
        let has_media = context.look.table().has_transparent();
        self.queues.iter_mut().for_each(|queue| queue.reset(has_media));
        self.shadows.resize_with(context.look.lights().len(), ShadowBatch::default);
        self.shadows.iter_mut().for_each(ShadowBatch::clear);
        simd::dispatch(context.execution.level, Begin { context, places, queue: &mut self.queues[0] });
    }

    /// Trace and shade the last chunk of a generation.
    fn step<P: Probe>(&mut self, context: &Context, generation: usize, samples: &mut Samples, probe: &P) {
        if self.queues.len() == generation + 1 {
            let mut next = RayQueue::default();
            next.reset(context.look.table().has_transparent());
            self.queues.push(next);
        }
        let Self { queues, hits, lit, shadows, scratch } = self;
        let [queue, next] = &mut queues[generation..generation + 2] else { unreachable!("two queues") };
        let first = queue.len().saturating_sub(CHUNK);
        watched(probe, Phase::Trace, || {
            samples.statistics += context.query.closest_hit(queue.rays(first..queue.len()), hits, scratch);
        });
        watched(probe, Phase::Shade, || {
            lit.clear();
            let generation = generation as u32;
            simd::dispatch(
                context.execution.level,
                Shade { context, generation, queue, first, hits, next, lit, samples },
            );
            queue.truncate(first);
        });
        for ((light, origin), shadows) in context.look.lights().iter().zip(shadows) {
            watched(probe, Phase::Shade, || lit.light(context.execution.level, light, *origin, shadows));
            if shadows.len() * context.look.lights().len() >= SHADOWS {
                watched(probe, Phase::Shadow, || shadows.resolve(context, scratch, samples));
            }
        }
    }
}

/// What the camera rays of some samples carry.
#[inline(always)]
pub(super) fn camera_tag<L: F32Lanes>(token: L::Token, sample: L::U32) -> Tag<L> {
    Tag {
        sample,
        weight: Vec3::splat(L::splat(token, 1.0)),
        media: Media::none(token),
        budget: L::U32::splat(token, RAYS_PER_SAMPLE),
    }
}

/// Makes camera rays.
struct Begin<'a, 'c> {
    context: &'a Context<'c>,
    places: &'a Places,
    queue: &'a mut RayQueue,
}

impl Kernel for Begin<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { context, places, queue } = self;
        let origin = Vec3::lanes(token, context.camera.eye());
        for at in (0..places.len()).step_by(BLOCK) {
            let ([x, y], sample) = places.load::<S::F32x16>(token, at);
            let direction = context.camera.directions(token, x, y);
            let rays = TaggedRays { origin, direction, tag: camera_tag(token, sample) };
            queue.append(first_lanes::<S::F32x16>(token, places.len() - at), &rays);
        }
    }
}

/// Makes vertices of hits: adds the light that needs no shadow ray, queues the next generation.
struct Shade<'a, 'c> {
    context: &'a Context<'c>,
    generation: u32,
    queue: &'a RayQueue,
    /// The ray to which the first hit belongs.
    first: usize,
    hits: &'a HitBatch,
    next: &'a mut RayQueue,
    lit: &'a mut LitPoints,
    samples: &'a mut Samples,
}

impl Kernel for Shade<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(mut self, token: S) {
        for at in (self.first..self.queue.len()).step_by(BLOCK) {
            self.block(token, at);
        }
    }
}

impl Shade<'_, '_> {
    #[inline(always)]
    fn block<S: Simd>(&mut self, token: S, at: usize) {
        let rays = self.queue.load::<S::F32x16>(token, at);
        let rows = self.queue.hit_rows(at, self.hits, self.first);
        let primitive = <S::F32x16 as F32Lanes>::U32::load(token, &rows.primitive);
        let active = first_lanes::<S::F32x16>(token, self.queue.len() - at);
        let misses = primitive.eq(<S::F32x16 as F32Lanes>::U32::splat(token, NONE));
        let (missed, hit) = (active & misses, active & !misses);
        if missed.any() {
            let light = self.context.look.background(token, rays.direction).times(rays.tag.weight);
            self.samples.add_lanes(token, missed, rays.tag.sample, light);
        }
        if !hit.any() {
            return;
        }
        let surfaces = self.context.geometry.primitives().surfaces(token, &rows);
        let t = S::F32x16::load(token, &rows.t);
        let vertex = Vertex::new(token, self.context, hit, &rays, (t, primitive), &surfaces);
        self.vertex(token, &vertex);
    }

    #[inline(always)]
    fn vertex<L: F32Lanes>(&mut self, token: L::Token, vertex: &Vertex<L>) {
        if self.generation == 0 {
            vertex.note_first(token, self.context, self.samples);
        }
        self.samples.add_lanes(token, vertex.active, vertex.tag.sample, vertex.ambient(token, self.context));
        let lit = vertex.answers_to_lights(token);
        if lit.any() {
            self.lit.append(lit, vertex.tag.sample, &vertex.lit());
        }
        if let Some(scattered) = vertex.scatter(token, self.context, self.generation, self.samples, &mut Unrecorded) {
            let Scattered { reflected, refracted } = scattered;
            if reflected.exists.any() {
                self.next.append(reflected.exists, &reflected.rays);
            }
            if refracted.exists.any() {
                self.next.append(refracted.exists, &refracted.rays);
            }
        }
    }
}
