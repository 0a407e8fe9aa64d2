//! The oracle: every ray against every primitive, one at a time, in plain Rust.

use super::goal::Goal;
use super::query::Counts;
use super::walk::PreparedRays;
use super::{Tree, walk};
use crate::geometry::sphere::{self, SphereRay, SphereRays};
use crate::geometry::triangle::{self, ShearedRays, renamed};
use crate::geometry::{Crossings, Kind, Primitives, ShearedRay};
use crate::ray::{Ray, Rays};
use simd::{F32Lanes, Scalar, ScalarF32};

type One = ScalarF32<1>;

/// Offer every hit of every ray: those of `batch` from `first` on, whose ranges are kept in `ranges`.
///
/// Rays are prepared here anew, one by one, so that the vector code which prepares them for the walks is tested too.
pub(super) fn walk<G: Goal>(
    tree: &Tree,
    primitives: &Primitives,
    batch: Rays<'_>,
    first: usize,
    ranges: &mut PreparedRays,
    goal: &mut G,
) -> Counts {
    let mut counts = Counts::default();
    let bounded = 0..primitives.bounded_count() as u32;
    let sound: Vec<u32> = bounded.filter(|&id| primitives.primitive_bounds(id).is_some()).collect();
    for index in 0..ranges.len() {
        let ray = batch.get(first + index);
        let one = OneRay::new(tree, ray);
        for &id in &sound {
            let mut limit = ranges.limit(index);
            if limit < ray.t_min {
                break;
            }
            counts.primitive_tests += 1;
            one.offer(primitives, id, goal, index, &mut limit);
            ranges.set_limit(index, limit);
        }
    }
    counts
}

/// All points at which the line of `ray` meets a primitive, or for a triangle the one in the range of `ray`.
pub(super) fn crossings_of(tree: &Tree, primitives: &Primitives, ray: &Ray, id: u32) -> Crossings {
    OneRay::new(tree, *ray).crossings(primitives, id, ray.t_max)
}

/// A ray in every form.
struct OneRay {
    ray: Ray,
    sheared: ShearedRay,
    sphere: SphereRay,
    scale: f32,
}

impl OneRay {
    fn new(tree: &Tree, ray: Ray) -> Self {
        let scale = tree.scale();
        Self {
            sheared: ShearedRay::new(ray.origin * scale, ray.direction * scale),
            sphere: SphereRay::new(ray.origin * scale, ray.direction * scale),
            ray,
            scale,
        }
    }

    /// Offer the crossings with one primitive.
    fn offer<G: Goal>(&self, primitives: &Primitives, id: u32, goal: &mut G, index: usize, limit: &mut f32) {
        let crossings = self.crossings(primitives, id, *limit);
        walk::offer_crossings(goal, index, id, crossings, self.ray.t_min, limit);
    }

    fn crossings(&self, primitives: &Primitives, id: u32, limit: f32) -> Crossings {
        let lane = |value: f32| One::splat(Scalar, value);
        let (t_min, t_max) = (lane(self.ray.t_min), lane(limit));
        let (origin, direction) = (self.ray.origin.to_f64(), self.ray.direction.to_f64());
        match primitives.kind(id) {
            Kind::Triangle(i) => {
                let axes = renamed(self.sheared.axis as usize);
                let vertices = primitives.triangle(i).vertices.map(|p| axes.map(|axis| lane(p[axis] * self.scale)));
                let (hit, t) =
                    triangle::intersect(Scalar, &ShearedRays::splat(Scalar, &self.sheared), vertices, t_min, t_max);
                crossings(&[One::select(hit, t, lane(f32::NAN))])
            }
            Kind::Sphere(i) => {
                let sphere = primitives.spheres()[i];
                let center = sphere.center.to_array().map(|c| lane(c * self.scale));
                let radius = lane(sphere.radius * self.scale);
                let (near, far) = sphere::roots(&SphereRays::splat(Scalar, &self.sphere), center, radius * radius);
                crossings(&[near, far])
            }
            Kind::Shape(i) => primitives.shapes()[i].crossings(origin, direction),
            Kind::Plane(i) => primitives.planes()[i].crossings(origin, direction),
        }
    }
}

/// The parameters as crossings; NaN is none.
fn crossings(parameters: &[One]) -> Crossings {
    let mut crossings = Crossings::NONE;
    for parameter in parameters {
        let mut t = [0.0];
        parameter.store(&mut t);
        crossings.insert(f64::from(t[0]));
    }
    crossings
}
