//! A chunk of rays in the forms that nodes and leaves want.

use crate::geometry::sphere::SphereRay;
use crate::geometry::{Primitives, ShearedRay};
use crate::math::Vec3f;
use crate::ray::{NONE, Ray, RayBatch};
use crate::tree::Tree;
use simd::Level;
use std::ops::Range;

/// What the box test of a node needs of a ray: half a cache line.
///
/// A plane at `p` is met at `p·inverse + offset`.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct NodeRay {
    /// Reciprocal direction, clamped: never infinite.
    pub inverse: [f32; 3],
    /// `−origin·inverse`, for the planes where the ray enters made smaller by the slack.
    pub near: [f32; 3],
    /// Lower end of the range.
    pub t_min: f32,
    /// Upper end of the range so far; negative infinity when the ray has ended.
    pub limit: f32,
}

const _: () = assert!(size_of::<NodeRay>() == 32, "half a cache line");

/// Components of the direction smaller than this count as this: keeps reciprocals finite and 0·∞ out of the slabs.
const MIN_COMPONENT: f32 = 1.0 / MAX_RECIPROCAL;
const MAX_RECIPROCAL: f32 = (1u128 << 80) as f32;
/// Rays whose largest direction component, in the tree's scale, lies outside these bounds hit nothing.
const MAX_DIRECTION: f32 = (1u64 << 62) as f32;
const MIN_DIRECTION: f32 = 1.0 / MAX_DIRECTION;

/// A chunk of rays, prepared.
#[derive(Debug, Default)]
pub(in crate::tree) struct PreparedRays {
    pub(super) nodes: Vec<NodeRay>,
    /// As `near`, for the planes where the ray leaves: made larger by the slack.
    pub(super) far: Vec<[f32; 3]>,
    pub(super) octant: Vec<u8>,
    sheared: Vec<ShearedRay>,
    spheres: Vec<SphereRay>,
    original: Vec<Ray>,
    any_slack: bool,
}

impl PreparedRays {
    /// Prepare the rays `range` of `rays` for `tree`.
    pub(in crate::tree) fn fill(
        &mut self,
        _level: Level,
        tree: &Tree,
        primitives: &Primitives,
        rays: &RayBatch,
        range: Range<usize>,
    ) {
        self.clear();
        let (triangles, spheres) = (primitives.triangle_count() > 0, !primitives.spheres().is_empty());
        let original = !(primitives.shapes().is_empty() && primitives.planes().is_empty());
        for index in range {
            let ray = rays.get(index);
            let (origin, direction) = (ray.origin * tree.scale(), ray.direction * tree.scale());
            self.push_node(tree, origin, direction, &ray);
            if triangles {
                self.sheared.push(ShearedRay::new(origin, direction));
            }
            if spheres {
                self.spheres.push(SphereRay::new(origin, direction));
            }
            if original {
                self.original.push(ray);
            }
        }
    }

    fn clear(&mut self) {
        self.nodes.clear();
        self.far.clear();
        self.octant.clear();
        self.sheared.clear();
        self.spheres.clear();
        self.original.clear();
        self.any_slack = false;
    }

    fn push_node(&mut self, tree: &Tree, origin: Vec3f, direction: Vec3f, ray: &Ray) {
        let inverse = direction.map(reciprocal);
        let slack = tree.slack(origin.abs().max_component());
        let offset = origin.zip(inverse, |o, i| -(o * i));
        let reach = inverse.map(|i| i.abs() * slack);
        self.any_slack |= slack > 0.0;
        self.nodes.push(NodeRay {
            inverse: inverse.to_array(),
            near: (offset - reach).to_array(),
            t_min: ray.t_min,
            limit: if is_sound(origin, direction) { ray.t_max } else { f32::NEG_INFINITY },
        });
        self.far.push((offset + reach).to_array());
        let negative = |component: f32, bit: u8| u8::from(component.is_sign_negative()) << bit;
        self.octant.push(negative(inverse.x, 0) | negative(inverse.y, 1) | negative(inverse.z, 2));
    }

    /// Number of rays.
    pub(in crate::tree) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True if a ray starts so far away that the boxes' padding does not cover its rounding.
    pub(super) fn any_slack(&self) -> bool {
        self.any_slack
    }

    /// Lower end of a ray's range.
    #[inline(always)]
    pub(in crate::tree) fn t_min(&self, index: usize) -> f32 {
        self.nodes[index].t_min
    }

    /// Upper end of a ray's range so far.
    #[inline(always)]
    pub(in crate::tree) fn limit(&self, index: usize) -> f32 {
        self.nodes[index].limit
    }

    /// Shorten a ray.
    #[inline(always)]
    pub(in crate::tree) fn set_limit(&mut self, index: usize, limit: f32) {
        self.nodes[index].limit = limit;
    }

    /// A ray in the form for triangles, in the tree's scale; a zero ray if there are no triangles.
    #[inline(always)]
    pub(in crate::tree) fn sheared(&self, index: usize) -> ShearedRay {
        self.sheared.get(index).copied().unwrap_or_default()
    }

    /// A ray in the form for spheres, in the tree's scale; a zero ray if there are no spheres.
    #[inline(always)]
    pub(in crate::tree) fn sphere(&self, index: usize) -> SphereRay {
        self.spheres.get(index).copied().unwrap_or_default()
    }

    /// A ray as the caller gave it; only where there are shapes or planes.
    pub(in crate::tree) fn ray(&self, index: usize) -> Ray {
        self.original[index]
    }

    /// Write the t of each ray that found a primitive.
    pub(in crate::tree) fn found(&self, primitive: &[u32], t: &mut [f32]) {
        for ((ray, &primitive), t) in self.nodes.iter().zip(primitive).zip(t) {
            if primitive != NONE {
                *t = ray.limit;
            }
        }
    }
}

/// `1 / component`, clamped to ±2⁸⁰ with the component's sign.
#[inline(always)]
fn reciprocal(component: f32) -> f32 {
    if component.abs() < MIN_COMPONENT { MAX_RECIPROCAL.copysign(component) } else { 1.0 / component }
}

/// False for rays that hit nothing: NaN, infinite origins, directions that are zero or extreme.
#[inline(always)]
fn is_sound(origin: Vec3f, direction: Vec3f) -> bool {
    let size = direction.abs().max_component();
    let no_nan = direction.x + direction.y + direction.z;
    origin.is_finite() && !no_nan.is_nan() && (MIN_DIRECTION..=MAX_DIRECTION).contains(&size)
}
