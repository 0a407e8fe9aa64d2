//! A vertex of the ray tree: where a ray met a surface, what light it finds there, which rays leave.
//!
//! Both renderers use this; neither queueing nor traversal is known here.

use super::context::Context;
use super::lighting::LitPoint;
use super::queue::Tag;
use super::samples::Samples;
use crate::math::Vec3f;
use crate::ray::{Hit, Ray};
use crate::shading::LocalSurface;

/// Where a ray met a surface, seen from the side from which it came.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// What the ray carried, its weight reduced by what the medium on the way absorbed, its media as they really are
    /// (a ray that leaves a body was inside it, whether or not it was seen to enter).
    pub(super) tag: Tag,
    /// Material of the surface.
    pub(super) material: u32,
    /// Primitive that was hit.
    pub(super) primitive: u32,
    /// Shading unit normal on the side of the viewer.
    pub(super) n_s: Vec3f,
    /// Distance from the origin of the ray, in internal units.
    pub(super) distance: f32,
    /// Geometric unit normal on the side of the viewer.
    pub(super) n_g: Vec3f,
    position: Vec3f,
    /// Unit direction to where the ray came from.
    pub(super) view: Vec3f,
    /// Base colour here.
    color: Vec3f,
    /// How far from the surface secondary rays must start.
    pub(super) error: f32,
    /// The ray goes against the surface's own normal: into the body.
    pub(super) entering: bool,
}

impl Vertex {
    /// The vertex where `ray` has `hit`.
    pub(super) fn new(context: &Context, ray: &Ray, hit: &Hit, tag: &Tag) -> Self {
        let point = context.geometry.primitives().surface_point(ray, hit);
        let material = context.material_of(hit.primitive);
        let surface = context.look.material(material);
        let length = ray.direction.length();
        let view = -ray.direction / length;
        let entering = point.n_g.dot(view) >= 0.0;
        let side = if entering { 1.0 } else { -1.0 };
        let (n_g, n_s) = (point.n_g * side, point.n_s * side);
        let mut vertex = Self {
            tag: *tag,
            material,
            primitive: hit.primitive,
            // An interpolated normal may turn away from the viewer near silhouettes: the true one never does.
            n_s: if n_s.dot(view) > 0.0 { n_s } else { n_g },
            distance: hit.t * length,
            n_g,
            position: point.position,
            view,
            color: surface.color(point.position),
            error: point.error,
            entering,
        };
        if surface.is_transparent() && !entering && !tag.media.contains(material) {
            vertex.tag.media = tag.media.entered(material);
        }
        vertex.absorb(context);
        vertex
    }

    /// Reduce the weight by the medium between the ray's origin and here.
    fn absorb(&mut self, context: &Context) {
        if let Some(medium) = self.tag.media.innermost() {
            self.tag.weight = self.tag.weight.times(context.look.material(medium).transmittance(self.distance));
        }
    }

    /// Note this as what the camera ray of its sample saw.
    pub(super) fn note_first(&self, context: &Context, samples: &mut Samples) {
        samples.statistics.camera_hits += 1;
        let depth = f64::from(self.distance) / context.geometry.space().scale();
        samples.see(self.tag.sample, context.geometry.object(self.primitive), self.n_s, depth as f32);
    }

    /// Light that is there whatever the lights do.
    pub(super) fn ambient(&self, context: &Context) -> Vec3f {
        let material = context.look.material(self.material);
        self.tag.weight.times(self.color.times(context.look.ambient()) * material.ambient())
    }

    /// The vertex as lamps see it; `None` if it does not answer to light.
    pub(super) fn lit(&self, context: &Context) -> Option<LitPoint<f32>> {
        let material = context.look.material(self.material);
        let weighted = |color: Vec3f| color.times(self.tag.weight);
        material.answers_to_lights().then(|| {
            let surface = material.local().surface(self.color);
            LitPoint {
                position: self.position,
                n_g: self.n_g,
                n_s: self.n_s,
                view: self.view,
                error: self.error,
                surface: LocalSurface {
                    diffuse: weighted(surface.diffuse),
                    specular: weighted(surface.specular),
                    ..surface
                },
            }
        })
    }

    /// The point `by` above the surface, on the side of the viewer; beneath it if negative.
    pub(super) fn off_surface(&self, by: f32) -> Vec3f {
        self.position + self.n_g * by
    }
}
