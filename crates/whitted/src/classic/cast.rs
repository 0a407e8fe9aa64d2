//! Asking for hits, one ray at a time.

use super::math::{Arithmetic, Packed, Plain};
use super::observer::Observer;
use super::ray::{CastRay, PlaneRay};
use super::walk::{Walker, dda, sequential, stack};
use super::{Grid, KdTree, Math, Objects};
use crate::geometry::Primitives;
use crate::ray::{Hit, NONE, Ray};
use crate::tree::{Any, BitSet, Closest, Goal, Next, Occlusion};
use simd::{Kernel, Simd};

/// What is between a ray and the objects.
#[derive(Clone, Debug)]
pub enum Structure {
    /// Nothing: every ray against every object.
    Naive,
    /// A kd-tree of 8-byte nodes.
    Kd(KdTree),
    /// A uniform grid.
    Grid(Grid),
}

/// How a ray goes through a kd-tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Walk {
    /// From the root to each leaf anew, as the paper does (§2.3.3).
    Sequential,
    /// With a stack of what was left behind.
    #[default]
    Stack,
}

/// Casts rays at a scene, one at a time. All answers are those of [`Query`](crate::tree::Query), bit by bit, unless
/// triangles are tested by projection or roots are estimated.
#[derive(Clone, Copy, Debug)]
pub struct Caster<'a> {
    /// The primitives.
    pub primitives: &'a Primitives,
    /// Copies of them to test.
    pub objects: &'a Objects,
    /// Built over them.
    pub structure: &'a Structure,
    /// How to walk a kd-tree.
    pub walk: Walk,
    /// How the vector operations of the tests are done.
    pub math: Math,
}

impl Caster<'_> {
    /// The first hit of a ray; of several primitives at the same t the one with the lowest number.
    pub fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Hit {
        let mut primitive = [NONE];
        let t = self.cast(ray, &mut Closest { primitive: &mut primitive }, observer);
        self.hit(ray, t, primitive[0])
    }

    /// The first hit after `after` in the order of (t, primitive); advances `after` to it. See
    /// [`Query::next_hit`](crate::tree::Query::next_hit).
    pub fn next_hit<O: Observer>(&self, ray: &Ray, after: &mut (f32, u32), observer: &mut O) -> Hit {
        let mut primitive = [NONE];
        let mut goal = Next { primitive: &mut primitive, after: std::slice::from_ref(after) };
        let t = self.cast(ray, &mut goal, observer);
        *after = if primitive[0] == NONE { (Hit::MISS.t, NONE) } else { (t, primitive[0]) };
        self.hit(ray, t, primitive[0])
    }

    /// What lies within the range of a ray; primitives outside `opaque` do not block.
    pub fn occluded<O: Observer>(&self, ray: &Ray, opaque: Option<&BitSet>, observer: &mut O) -> Occlusion {
        let mut occlusion = [Occlusion::Clear];
        self.cast(ray, &mut Any { occlusion: &mut occlusion, opaque }, observer);
        occlusion[0]
    }

    /// The hit at `t`, refined in double precision.
    fn hit(&self, ray: &Ray, t: f32, primitive: u32) -> Hit {
        if primitive == NONE {
            return Hit::MISS;
        }
        let refined = self.primitives.refine(ray, t, primitive);
        Hit { t: refined.t, u: refined.u, v: refined.v, primitive, instance: NONE }
    }

    /// Offer everything on the ray's way; returns the limit that is left of its range.
    fn cast<G: Goal, O: Observer>(&self, ray: &Ray, goal: &mut G, observer: &mut O) -> f32 {
        let ray = CastRay::new(ray, self.objects.fit.scale(), self.objects.wants_shear());
        if !ray.is_sound() {
            return ray.t_max;
        }
        let cast = Cast { caster: self, ray: &ray, goal, observer };
        match self.math {
            Math::Scalar => cast.with(Plain),
            Math::Vector(level) | Math::Estimated(level) => simd::dispatch(level, cast),
        }
    }
}

/// One ray to be cast. By reference: a copy for the kernel is read before the ray has reached the cache (mix-10, naive by
/// SSE: 0.081 s, by reference 0.069 s).
struct Cast<'a, G, O> {
    caster: &'a Caster<'a>,
    ray: &'a CastRay,
    goal: &'a mut G,
    observer: &'a mut O,
}

impl<G: Goal, O: Observer> Kernel for Cast<'_, G, O> {
    type Output = f32;

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> f32 {
        match self.caster.math {
            Math::Estimated(_) => self.with(Packed::<S, true>(token)),
            _ => self.with(Packed::<S, false>(token)),
        }
    }
}

impl<G: Goal, O: Observer> Cast<'_, G, O> {
    #[inline(always)]
    fn with<M: Arithmetic>(self, math: M) -> f32 {
        let Self { caster, ray, goal, observer } = self;
        let Caster { primitives, objects, structure, walk, .. } = *caster;
        let (taken, limit) = (math.ray(ray), ray.t_max);
        let mut walker = Walker { math, taken, primitives, objects, ray, goal, observer, limit };
        walker.planes();
        if walker.has_ended() {
            return walker.limit;
        }
        let range = [ray.t_min, walker.limit];
        match structure {
            Structure::Naive => walker.all(),
            Structure::Kd(tree) => {
                let planes = PlaneRay::new(ray, &tree.fit);
                let Some(interval) = planes.clip(&tree.bounds, range) else { return walker.limit };
                match walk {
                    Walk::Sequential if planes.is_exact() => sequential::walk(tree, &planes, interval, &mut walker),
                    // Cells that reach beyond their planes overlap: only the stack finds them all.
                    _ => stack::walk(tree, &planes, interval, &mut walker),
                }
            }
            Structure::Grid(grid) if !grid.covers(ray.distance()) => walker.all(),
            Structure::Grid(grid) => {
                let planes = PlaneRay::new(ray, &grid.fit);
                let Some(interval) = planes.clip(&grid.bounds, range) else { return walker.limit };
                dda::walk(grid, &planes, interval, &mut walker);
            }
        }
        walker.limit
    }
}
