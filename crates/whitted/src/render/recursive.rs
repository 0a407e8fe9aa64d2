//! The paper's renderer: one ray after the other, depth first. The oracle of the wavefront, and what the paper's own
//! structures and walks are measured in ([`classic`](crate::classic)).
//!
//! It calls the same functions for surfaces and lights with a single lane, and none of the queueing: every ray is a
//! batch of one. The recursion is a loop over an explicit stack, so that no depth can exhaust that of the machine.

use super::context::Context;
use super::lighting::Sent;
use super::progress::Cancelled;
use super::queue::TaggedRays;
use super::recorder::{Recorder, Unrecorded};
use super::samples::Samples;
use super::shadow::{filtered, opaque_primitives};
use super::source::{Alone, Production, Source};
use super::vertex::Vertex;
use super::wavefront::camera_tag;
use super::workspace::Places;
use crate::geometry::surfaces::Surfaces;
use crate::math::Vec3f;
use crate::ray::Ray;
use crate::shading::one::{One, one, ones, value, values};
use crate::tree::Occlusion;
use simd::{MaskLanes, Scalar, ScalarU32, U32Lanes};

/// A ray that waits, and its generation.
type Waiting = (TaggedRays<One>, u32);

/// The memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Recursive {
    stack: Vec<Waiting>,
    alone: Alone,
}

/// A batch under way.
struct Run<'a, H, R> {
    context: &'a Context<'a>,
    source: H,
    stack: &'a mut Vec<Waiting>,
    samples: &'a mut Samples,
    recorder: &'a mut R,
}

impl Recursive {
    /// Trace the camera rays through `places`, each with all that descends from it.
    ///
    /// # Errors
    /// If the render was cancelled.
    pub(super) fn run(&mut self, context: &Context, places: &Places, samples: &mut Samples) -> Result<(), Cancelled> {
        self.record(context, places, samples, &mut Unrecorded)
    }

    /// As [`run`](Self::run), and tell `recorder` everything.
    ///
    /// # Errors
    /// If the render was cancelled.
    pub(super) fn record<R: Recorder>(
        &mut self,
        context: &Context,
        places: &Places,
        samples: &mut Samples,
        recorder: &mut R,
    ) -> Result<(), Cancelled> {
        let Self { stack, alone } = self;
        match context.caster {
            Some(source) => Run { context, source, stack, samples, recorder }.all(places),
            None => {
                let source = Production { query: context.query, alone };
                Run { context, source, stack, samples, recorder }.all(places)
            }
        }
    }
}

impl<H: Source, R: Recorder> Run<'_, H, R> {
    fn all(&mut self, places: &Places) -> Result<(), Cancelled> {
        for index in 0..places.len() {
            let ([x, y], sample) = places.load::<One>(Scalar, index);
            let Ray { origin, direction, .. } = self.context.camera.ray(value(x), value(y));
            let tag = camera_tag(Scalar, sample);
            self.recorder.begins([value(x), value(y)]);
            self.stack.clear();
            self.stack.push((TaggedRays { origin: ones(origin), direction: ones(direction), tag }, 0));
            while let Some((ray, generation)) = self.stack.pop() {
                if self.context.cancel.is_cancelled() {
                    return Err(Cancelled);
                }
                self.visit(&ray, generation);
            }
        }
        Ok(())
    }

    fn visit(&mut self, rays: &TaggedRays<One>, generation: u32) {
        self.recorder.visits(rays);
        let context = self.context;
        let (all, sample) = (MaskLanes::from_bits(Scalar, 1), rays.tag.sample);
        let ray = Ray::new(values(rays.origin), values(rays.direction));
        let hit = self.source.closest_hit(&ray, &mut self.samples.statistics);
        if !hit.is_hit() {
            let light = context.look.background(Scalar, rays.direction).times(rays.tag.weight);
            self.samples.add_lanes(Scalar, all, sample, light);
            self.recorder.misses(light);
            return;
        }
        let point = context.geometry.primitives().surface_point(&ray, &hit);
        let (position, n_g, n_s) = (ones(point.position), ones(point.n_g), ones(point.n_s));
        let surface = Surfaces { position, n_g, n_s, error: one(point.error) };
        let hit = (one(hit.t), ScalarU32::splat(Scalar, hit.primitive));
        let vertex = Vertex::new(Scalar, context, all, rays, hit, &surface);
        if generation == 0 {
            vertex.note_first(Scalar, context, self.samples);
        }
        let ambient = vertex.ambient(Scalar, context);
        self.samples.add_lanes(Scalar, all, sample, ambient);
        self.recorder.hits(&vertex, ambient);
        if vertex.answers_to_lights(Scalar).any() {
            self.light(&vertex);
        }
        let scattered = vertex.scatter(Scalar, context, generation, self.samples, self.recorder);
        self.recorder.scatters(scattered.as_ref());
        if let Some(scattered) = scattered {
            // Pushed last, popped first: the mirrored ray before the refracted one.
            for child in [scattered.refracted, scattered.reflected] {
                if child.exists.any() {
                    self.stack.push((child.rays, generation + 1));
                }
            }
        }
    }

    /// Add the light of all lamps that reaches a surface.
    fn light(&mut self, vertex: &Vertex<One>) {
        for (lamp, (light, origin)) in self.context.look.lights().iter().enumerate() {
            let sent = vertex.lit().receive(Scalar, light, *origin);
            if !sent.faces.any() {
                self.recorder.lit(lamp, &sent, None, Vec3f::ZERO);
                continue;
            }
            let (outcome, light) = self.arriving(&sent);
            self.samples.add_lanes(Scalar, vertex.active, vertex.tag.sample, ones(light));
            self.recorder.lit(lamp, &sent, Some(outcome), light);
        }
    }

    /// What is in the way of the light that a lamp sends to a surface, and what of it arrives.
    fn arriving(&mut self, sent: &Sent<One>) -> (Occlusion, Vec3f) {
        let (origin, direction) = (values(sent.origin), values(sent.direction));
        let ray = Ray { origin, direction, t_min: 0.0, t_max: value(sent.t_max) };
        let statistics = &mut self.samples.statistics;
        statistics.shadow_rays += 1;
        let outcome = self.source.occluded(&ray, opaque_primitives(self.context), statistics);
        let light = match outcome {
            Occlusion::Clear => values(sent.light),
            Occlusion::Filtered => filtered(self.context, values(sent.light), |after| {
                self.source.next_hit(&ray, after, &mut self.samples.statistics)
            }),
            Occlusion::Blocked => Vec3f::ZERO,
        };
        (outcome, light)
    }
}
