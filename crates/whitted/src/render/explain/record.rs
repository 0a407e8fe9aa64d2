//! Writing down what happens to rays.

use super::tree::{RayEnd, RayKind, SurfaceHit, TracedRay};
use crate::math::{Vec3, Vec3d, Vec3f};
use crate::ray::Ray;
use crate::render::context::Context;
use crate::render::lighting::Sent;
use crate::render::queue::TaggedRays;
use crate::render::recorder::{Branch, Cuts, Recorder, Untraced};
use crate::render::scatter::Scattered;
use crate::render::shadow::opaque_primitives;
use crate::render::vertex::Vertex;
use crate::shading::one::{One, value, values};
use crate::tree::{Occlusion, Scratch};
use simd::{F32Lanes, MaskLanes, ScalarU32, U32Lanes};

/// The place of a sample and its rays.
type Sample = ([f32; 2], Vec<TracedRay>);

/// A list of what happened to the rays of samples.
pub(super) struct Recording<'a> {
    context: &'a Context<'a>,
    samples: Vec<Sample>,
    /// In step with the renderer's own stack: what it will trace, and between them what it will not.
    waiting: Vec<Waiting>,
    /// Why the rays that leave the surface at hand are not traced.
    untraced: Vec<(Branch, TracedRay)>,
    /// The ray at hand.
    current: usize,
    scratch: Scratch,
}

enum Waiting {
    Traced { kind: RayKind, parent: Option<usize>, generation: u32 },
    Untraced(TracedRay),
}

impl<'a> Recording<'a> {
    pub(super) fn new(context: &'a Context<'a>) -> Self {
        Self {
            context,
            samples: Vec::new(),
            waiting: Vec::new(),
            untraced: Vec::new(),
            current: 0,
            scratch: Scratch::default(),
        }
    }

    /// All samples in the order in which they were traced.
    pub(super) fn finish(mut self) -> Vec<Sample> {
        self.take_untraced();
        self.samples
    }

    /// The rays of the sample at hand: there is one from the first [`Recorder::begins`] on.
    fn rays(&mut self) -> &mut Vec<TracedRay> {
        if self.samples.is_empty() {
            self.samples.push(Sample::default());
        }
        let last = self.samples.len() - 1;
        &mut self.samples[last].1
    }

    fn now(&mut self) -> Option<&mut TracedRay> {
        let current = self.current;
        self.rays().get_mut(current)
    }

    fn generation(&mut self) -> u32 {
        self.now().map_or(0, |ray| ray.generation)
    }

    /// Move what waits in vain to the list, up to what is traced.
    fn take_untraced(&mut self) {
        while let Some(Waiting::Untraced(ray)) = self.waiting.pop_if(|waiting| matches!(waiting, Waiting::Untraced(_)))
        {
            self.rays().push(ray);
        }
    }

    fn world(&self, point: Vec3f) -> Vec3d {
        self.context.geometry.space().world(point.to_f64())
    }

    /// A length in internal space as one in world space.
    fn world_length(&self, length: f32) -> f64 {
        f64::from(length) / self.context.geometry.space().scale()
    }

    /// A ray that has not ended.
    fn ray(&self, kind: RayKind, parent: Option<usize>, generation: u32, rays: &TaggedRays<One>) -> TracedRay {
        TracedRay {
            kind,
            parent,
            generation,
            origin: self.world(values(rays.origin)),
            direction: values(rays.direction).to_f64().direction(),
            length: f64::INFINITY,
            weight: values(rays.tag.weight),
            end: RayEnd::Missed,
            light: Vec3f::ZERO,
        }
    }

    /// A ray that would leave the surface at hand.
    fn child(&mut self, branch: Branch, rays: &TaggedRays<One>, end: RayEnd) -> TracedRay {
        let generation = self.generation() + 1;
        TracedRay { end, length: 0.0, ..self.ray(kind(branch), Some(self.current), generation, rays) }
    }

    /// What stands in the way of a shadow ray that something blocks, and where on the segment.
    fn blocker(&mut self, ray: &Ray) -> (RayEnd, f32) {
        let opaque = opaque_primitives(self.context);
        let blocks = |_, primitive: u32| opaque.is_none_or(|opaque| opaque.contains(primitive));
        let hit = self.context.query.closest_hit_of(ray, Some(&blocks), &mut self.scratch);
        let object = self.context.geometry.object(hit.primitive);
        (RayEnd::Blocked { object, primitive: hit.primitive }, hit.t)
    }
}

fn kind(branch: Branch) -> RayKind {
    match branch {
        Branch::Reflected => RayKind::Reflected,
        Branch::Refracted => RayKind::Refracted,
    }
}

fn integer(one: ScalarU32<1>) -> u32 {
    let mut value = [0];
    one.store(&mut value);
    value[0]
}

impl Cuts<One> for Recording<'_> {
    fn untraced(&mut self, branch: Branch, lanes: <One as F32Lanes>::Mask, rays: &TaggedRays<One>, why: Untraced) {
        let end = match why {
            Untraced::Weight => RayEnd::WeightLimit,
            Untraced::Depth => RayEnd::DepthLimit,
            Untraced::Budget => RayEnd::BudgetSpent,
            Untraced::TotalReflection => RayEnd::TotalReflection,
        };
        if lanes.any() {
            let mut ray = self.child(branch, rays, end);
            if end == RayEnd::TotalReflection {
                ray.direction = Vec3d::ZERO;
            }
            self.untraced.push((branch, ray));
        }
    }
}

impl Recorder for Recording<'_> {
    fn begins(&mut self, place: [f32; 2]) {
        self.take_untraced();
        self.samples.push((place, Vec::new()));
        self.waiting.push(Waiting::Traced { kind: RayKind::Camera, parent: None, generation: 0 });
    }

    fn visits(&mut self, rays: &TaggedRays<One>) {
        self.take_untraced();
        if let Some(Waiting::Traced { kind, parent, generation }) = self.waiting.pop() {
            let ray = self.ray(kind, parent, generation, rays);
            self.current = self.rays().len();
            self.rays().push(ray);
        }
    }

    fn misses(&mut self, light: Vec3<One>) {
        if let Some(ray) = self.now() {
            ray.light = values(light);
        }
    }

    fn hits(&mut self, vertex: &Vertex<One>, light: Vec3<One>) {
        let primitive = integer(vertex.primitive);
        let hit = SurfaceHit {
            object: self.context.geometry.object(primitive),
            primitive,
            material: integer(vertex.material),
            position: self.world(values(vertex.position)),
            n_s: values(vertex.n_s),
            n_g: values(vertex.n_g),
            enters: vertex.entering.any(),
            weight: values(vertex.tag.weight),
        };
        let length = self.world_length(value(vertex.distance));
        if let Some(ray) = self.now() {
            (ray.end, ray.length, ray.light) = (RayEnd::Hit(hit), length, values(light));
        }
    }

    fn lit(&mut self, lamp: usize, sent: &Sent<One>, outcome: Option<Occlusion>, light: Vec3f) {
        let segment = values(sent.direction);
        let ray = Ray { origin: values(sent.origin), direction: segment, t_min: 0.0, t_max: value(sent.t_max) };
        let (end, t) = match outcome {
            None => (RayEnd::FacesAway, ray.t_max),
            Some(Occlusion::Clear) => (RayEnd::Clear, ray.t_max),
            Some(Occlusion::Filtered) => (RayEnd::Filtered, ray.t_max),
            Some(Occlusion::Blocked) => self.blocker(&ray),
        };
        let shadow = TracedRay {
            kind: RayKind::Shadow(lamp),
            parent: Some(self.current),
            generation: self.generation(),
            origin: self.world(ray.origin),
            direction: segment.to_f64().direction(),
            length: self.world_length(t * segment.length()),
            weight: values(sent.light),
            end,
            light,
        };
        self.rays().push(shadow);
    }

    fn scatters(&mut self, scattered: Option<&Scattered<One>>) {
        // Taken from the end: the mirrored ray before the refracted one.
        for branch in [Branch::Refracted, Branch::Reflected] {
            let untraced = self.untraced.iter().position(|(of, _)| *of == branch);
            if scattered.is_some_and(|scattered| scattered.branch(branch).exists.any()) {
                let generation = self.generation() + 1;
                self.waiting.push(Waiting::Traced { kind: kind(branch), parent: Some(self.current), generation });
            } else if let Some(index) = untraced {
                let (_, ray) = self.untraced.swap_remove(index);
                self.waiting.push(Waiting::Untraced(ray));
            }
        }
    }
}
