//! The paper's renderer: one ray after the other, depth first. The oracle of the wavefront.
//!
//! It calls the same functions for surfaces and lights, and none of the queueing: every ray is a batch of one. The
//! recursion is a loop over an explicit stack, so that no depth can exhaust that of the machine.

use super::context::Context;
use super::progress::Cancelled;
use super::queue::Tag;
use super::samples::Samples;
use super::shadow::{BEFORE_ALL, MAX_FILTERS, opaque_primitives};
use super::vertex::Vertex;
use crate::math::Vec3f;
use crate::ray::{Hit, HitBatch, Ray, RayBatch};
use crate::tree::{Occlusion, Scratch};

/// The memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Recursive {
    stack: Vec<(Ray, Tag, u32)>,
    ray: RayBatch,
    hit: HitBatch,
    occlusion: Vec<Occlusion>,
    scratch: Scratch,
}

impl Recursive {
    /// Trace a camera ray and all that descends from it.
    ///
    /// # Errors
    /// If the render was cancelled.
    pub(super) fn run(
        &mut self,
        context: &Context,
        ray: &Ray,
        tag: Tag,
        samples: &mut Samples,
    ) -> Result<(), Cancelled> {
        self.stack.clear();
        self.stack.push((*ray, tag, 0));
        while let Some((ray, tag, generation)) = self.stack.pop() {
            if context.cancel.is_cancelled() {
                return Err(Cancelled);
            }
            self.visit(context, &ray, &tag, generation, samples);
        }
        Ok(())
    }

    fn visit(&mut self, context: &Context, ray: &Ray, tag: &Tag, generation: u32, samples: &mut Samples) {
        let hit = self.closest_hit(context, ray, samples);
        if !hit.is_hit() {
            samples.add(tag.sample, context.look.background(ray.direction).times(tag.weight));
            return;
        }
        let vertex = Vertex::new(context, ray, &hit, tag);
        if generation == 0 {
            vertex.note_first(context, samples);
        }
        samples.add(tag.sample, vertex.ambient(context));
        if let Some(point) = vertex.lit(context) {
            for (light, origin) in context.look.lights() {
                if let Some((ray, light)) = point.toward(light, *origin) {
                    let light = self.arriving(context, &ray, light, samples);
                    samples.add(tag.sample, light);
                }
            }
        }
        let scattered = vertex.scatter(context, generation, samples);
        // Pushed last, popped first: the mirrored ray before the refracted one.
        for (ray, tag) in scattered.refracted.into_iter().chain(scattered.reflected) {
            self.stack.push((ray, tag, generation + 1));
        }
    }

    fn closest_hit(&mut self, context: &Context, ray: &Ray, samples: &mut Samples) -> Hit {
        self.ray.clear();
        self.ray.push(ray);
        samples.statistics += context.query.closest_hit(&self.ray, &mut self.hit, &mut self.scratch);
        self.hit.get(0)
    }

    /// What reaches a surface of `light` that comes along a shadow ray.
    fn arriving(&mut self, context: &Context, ray: &Ray, light: Vec3f, samples: &mut Samples) -> Vec3f {
        self.ray.clear();
        self.ray.push(ray);
        samples.statistics.shadow_rays += 1;
        let (opaque, out) = (opaque_primitives(context), &mut self.occlusion);
        samples.statistics += context.query.occluded(&self.ray, opaque, out, &mut self.scratch);
        match self.occlusion[0] {
            Occlusion::Clear => light,
            Occlusion::Filtered => self.filtered(context, light, samples),
            Occlusion::Blocked => Vec3f::ZERO,
        }
    }

    /// `light` after all surfaces on the way of the ray that [`arriving`](Self::arriving) left in place.
    fn filtered(&mut self, context: &Context, mut light: Vec3f, samples: &mut Samples) -> Vec3f {
        let mut after = [BEFORE_ALL];
        for _ in 0..MAX_FILTERS {
            samples.statistics += context.query.next_hit(&self.ray, &mut after, &mut self.hit, &mut self.scratch);
            let hit = self.hit.get(0);
            if !hit.is_hit() {
                return light;
            }
            light = light.times(context.filter(hit.primitive));
        }
        Vec3f::ZERO
    }
}
