//! The scene's primitives as the walks test them: a 64-byte block for each (paper §2.4.2).

use super::math::Arithmetic;
use super::projection::Projected;
use super::ray::CastRay;
use crate::geometry::triangle::{self, ShearedRays, renamed};
use crate::geometry::{Kind, Primitives};
use crate::math::Vec3f;
use crate::shading::one::{One, one, value};
use crate::tree::{Fit, Goal, offer_crossings};
use simd::{MaskLanes, Scalar};

/// How triangles are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TriangleTest {
    /// Watertight: the library's own definition of a hit.
    #[default]
    Watertight,
    /// The paper's (§2.2.1): the distance to the plane first, then a test in two dimensions. May differ from the
    /// watertight one at edges, where a ray can also slip through between two triangles.
    Projection,
}

/// The primitives of a scene, ready to be tested one by one.
#[derive(Clone, Debug)]
pub struct Objects {
    pub(super) blocks: Vec<Object>,
    pub(super) fit: Fit,
    has_triangles: bool,
}

/// One bounded primitive, in scaled coordinates.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) enum Object {
    Triangle([Vec3f; 3]),
    Projected(Projected),
    Sphere {
        center: [f32; 4],
        radius_squared: f32,
    },
    /// Its index among its kind.
    Shape(u32),
    /// Degenerate.
    Never,
}

const _: () = assert!(size_of::<Object>() == 64 && align_of::<Object>() == 64);

impl Objects {
    /// Copy the bounded primitives.
    pub fn new(primitives: &Primitives, test: TriangleTest) -> Self {
        let fit = Fit::new(primitives.bounds());
        let blocks = (0..primitives.bounded_count() as u32).map(|id| Object::new(primitives, id, fit.scale(), test));
        Self { blocks: blocks.collect(), fit, has_triangles: primitives.triangle_count() > 0 }
    }

    /// Bytes of the blocks.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.blocks[..])
    }

    /// Number of bounded primitives.
    pub(super) fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Whether rays need what only the watertight test needs.
    pub(super) fn wants_shear(&self) -> bool {
        self.has_triangles
    }

    /// Offer what one primitive has to offer: see [`Goal`]. `taken` is the ray as `math` has it.
    #[inline(always)]
    pub(super) fn offer<M: Arithmetic, G: Goal>(
        &self,
        math: M,
        taken: &M::Ray,
        primitives: &Primitives,
        id: u32,
        ray: &CastRay,
        goal: &mut G,
        limit: &mut f32,
    ) {
        match &self.blocks[id as usize] {
            Object::Sphere { center, radius_squared } => {
                offer_roots(goal, id, math.roots(taken, center, *radius_squared), ray.t_min, limit);
            }
            Object::Triangle(vertices) => {
                if let Some(t) = watertight(ray, vertices, *limit) {
                    offer_one(goal, id, t, limit);
                }
            }
            Object::Projected(triangle) => {
                if let Some(t) = triangle.meet(ray, *limit) {
                    offer_one(goal, id, t, limit);
                }
            }
            Object::Shape(index) => {
                let crossings = primitives.shapes()[*index as usize].crossings(ray.origin_f64, ray.direction_f64);
                offer_crossings(goal, 0, id, crossings, ray.t_min, limit);
            }
            Object::Never => {}
        }
    }
}

impl Object {
    fn new(primitives: &Primitives, id: u32, scale: f32, test: TriangleTest) -> Self {
        if primitives.primitive_bounds(id).is_none() {
            return Self::Never;
        }
        match primitives.kind(id) {
            Kind::Triangle(i) => {
                let vertices = primitives.triangle(i).vertices.map(|v| v * scale);
                match test {
                    TriangleTest::Watertight => Self::Triangle(vertices),
                    TriangleTest::Projection => Projected::new(vertices).map_or(Self::Never, Self::Projected),
                }
            }
            Kind::Sphere(i) => {
                let sphere = primitives.spheres()[i];
                let [x, y, z] = (sphere.center * scale).to_array();
                let radius = sphere.radius * scale;
                Self::Sphere { center: [x, y, z, 0.0], radius_squared: radius * radius }
            }
            Kind::Shape(i) => Self::Shape(i as u32),
            Kind::Plane(_) => Self::Never,
        }
    }
}

#[inline(always)]
fn watertight(ray: &CastRay, vertices: &[Vec3f; 3], limit: f32) -> Option<f32> {
    let axes = renamed(ray.sheared.axis as usize);
    let lanes = |vertex: Vec3f| -> [One; 3] { [one(vertex[axes[0]]), one(vertex[axes[1]]), one(vertex[axes[2]])] };
    let rays = ShearedRays::splat(Scalar, &ray.sheared);
    let vertices = [lanes(vertices[0]), lanes(vertices[1]), lanes(vertices[2])];
    let (hit, t) = triangle::intersect(Scalar, &rays, vertices, one(ray.t_min), one(limit));
    hit.any().then(|| value(t))
}

/// Offer roots, ascending or NaN, from `t_min` on: the first, or both if the goal wants every crossing.
#[inline(always)]
fn offer_roots<G: Goal>(goal: &mut G, id: u32, roots: [f32; 2], t_min: f32, limit: &mut f32) {
    for t in roots {
        if t_min <= t && t < f32::INFINITY {
            if t <= *limit {
                offer_one(goal, id, t, limit);
            }
            if !G::EVERY_CROSSING {
                return;
            }
        }
    }
}

#[inline(always)]
fn offer_one<G: Goal>(goal: &mut G, id: u32, t: f32, limit: &mut f32) {
    if let Some(shorter) = goal.offer(0, t, id, *limit) {
        *limit = shorter;
    }
}
