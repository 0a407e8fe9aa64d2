//! Vertices of the ray tree, in lanes: where rays met surfaces, what light they find there, which rays leave.
//!
//! Both renderers use this, one with a single lane; neither queueing nor traversal is known here.

use super::context::Context;
use super::lighting::LitPoint;
use super::queue::{Tag, TaggedRays};
use super::samples::Samples;
use crate::geometry::surfaces::Surfaces;
use crate::math::{Vec3, select};
use crate::ray::NONE;
use crate::shading::Finish;
use simd::{F32Lanes, MaskLanes, U32Lanes};

/// Where rays met surfaces, seen from the side from which they came.
#[derive(Clone, Copy)]
pub(super) struct Vertex<L: F32Lanes> {
    /// Lanes that mean anything.
    pub(super) active: L::Mask,
    /// What the rays carried, their weights reduced by what the medium on the way absorbed, their media as they really
    /// are (a ray that leaves a body was inside it, whether or not it was seen to enter).
    pub(super) tag: Tag<L>,
    /// Material of the surface.
    pub(super) material: L::U32,
    /// Primitive that was hit.
    pub(super) primitive: L::U32,
    /// Shading unit normal on the side of the viewer.
    pub(super) n_s: Vec3<L>,
    /// Distance from the origin of the ray, in internal units.
    pub(super) distance: L,
    /// Geometric unit normal on the side of the viewer.
    pub(super) n_g: Vec3<L>,
    pub(super) position: Vec3<L>,
    /// Unit direction to where the ray came from.
    pub(super) view: Vec3<L>,
    /// How far from the surface secondary rays must start.
    pub(super) error: L,
    /// Lanes whose ray goes against the surface's own normal: into the body.
    pub(super) entering: L::Mask,
    /// The parameters of the local model here.
    pub(super) finish: Finish<L>,
}

impl<L: F32Lanes> Vertex<L> {
    /// The vertices where `rays` meet `surface` at `t`, in the lanes `active`, of which there is at least one.
    #[inline(always)]
    pub(super) fn new(
        token: L::Token,
        context: &Context,
        active: L::Mask,
        rays: &TaggedRays<L>,
        (t, primitive): (L, L::U32),
        surface: &Surfaces<L>,
    ) -> Self {
        let zero = L::splat(token, 0.0);
        let primitive = L::U32::select(active, primitive, L::U32::splat(token, 0));
        let material = L::U32::gather(context.look.primitive_materials(), primitive);
        let finish = context.look.table().finish(token, active, material, surface.position);
        let length = rays.direction.length_squared().sqrt();
        let view = -rays.direction / length;
        let entering = surface.n_g.dot(view).ge(zero);
        let n_g = select(entering, surface.n_g, -surface.n_g);
        let n_s = select(entering, surface.n_s, -surface.n_s);
        // An interpolated normal may turn away from the viewer near silhouettes: the true one never does.
        let n_s = select(n_s.dot(view).gt(zero), n_s, n_g);
        let tag = rays.tag;
        let mut vertex = Self {
            active,
            tag,
            material,
            primitive,
            n_s,
            distance: t * length,
            n_g,
            position: surface.position,
            view,
            error: surface.error,
            entering,
            finish,
        };
        if context.look.table().has_transparent() {
            vertex.pass_medium(token, context);
        }
        vertex
    }

    /// Correct the media of rays that leave a body, and reduce the weights by the medium between the rays' origins and
    /// here.
    #[inline(always)]
    fn pass_medium(&mut self, token: L::Token, context: &Context) {
        let tag = &mut self.tag;
        let leaves = self.finish.is_transparent(token) & !self.entering & !tag.media.contains(self.material);
        if (leaves & self.active).any() {
            let inside = tag.media.entered(token, self.material);
            tag.media = super::media::Media::select(leaves, &inside, &tag.media);
        }
        let medium = tag.media.innermost();
        let inside = self.active & !medium.eq(L::U32::splat(token, NONE));
        let left = context.look.table().transmittance(token, inside, medium, self.distance);
        tag.weight = tag.weight.times(left);
    }

    /// Note this as what the camera rays of its samples saw.
    #[inline(always)]
    pub(super) fn note_first(&self, token: L::Token, context: &Context, samples: &mut Samples) {
        samples.statistics.camera_hits += u64::from(self.active.bits().count_ones());
        // A power of two: exact. Depths that no single number holds become 0 or infinite.
        let depth = self.distance / L::splat(token, context.geometry.space().scale() as f32);
        samples.see::<L>(context, self.active, self.tag.sample, self.primitive, self.n_s, depth);
    }

    /// Light that is there whatever the lights do.
    #[inline(always)]
    pub(super) fn ambient(&self, token: L::Token, context: &Context) -> Vec3<L> {
        let ambient = Vec3::lanes(token, context.look.ambient());
        self.tag.weight.times(self.finish.color.times(ambient) * self.finish.ambient)
    }

    /// The lanes that answer to light.
    #[inline(always)]
    pub(super) fn answers_to_lights(&self, token: L::Token) -> L::Mask {
        self.active & self.finish.answers_to_lights(token)
    }

    /// The vertices as lamps see them.
    #[inline(always)]
    pub(super) fn lit(&self) -> LitPoint<L> {
        LitPoint {
            position: self.position,
            n_g: self.n_g,
            n_s: self.n_s,
            view: self.view,
            error: self.error,
            surface: self.finish.local(self.tag.weight),
        }
    }

    /// The points `by` above the surface, on the side of the viewer; beneath it if negative.
    #[inline(always)]
    pub(super) fn off_surface(&self, by: L) -> Vec3<L> {
        self.position + self.n_g * by
    }
}
