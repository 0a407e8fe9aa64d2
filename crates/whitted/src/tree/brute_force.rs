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
        let one = OneRay {
            sheared: ShearedRay::new(ray.origin * tree.scale(), ray.direction * tree.scale()),
            sphere: SphereRay::new(ray.origin * tree.scale(), ray.direction * tree.scale()),
            ray,
            scale: tree.scale(),
        };
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

/// A ray in every form.
struct OneRay {
    ray: Ray,
    sheared: ShearedRay,
    sphere: SphereRay,
    scale: f32,
}

impl OneRay {
    /// Offer the crossings with one primitive.
    fn offer<G: Goal>(&self, primitives: &Primitives, id: u32, goal: &mut G, index: usize, limit: &mut f32) {
        let lane = |value: f32| One::splat(Scalar, value);
        let (t_min, t_max) = (lane(self.ray.t_min), lane(*limit));
        let crossings = match primitives.kind(id) {
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
            Kind::Shape(i) => primitives.shapes()[i].crossings(self.ray.origin.to_f64(), self.ray.direction.to_f64()),
            Kind::Plane(_) => unreachable!("planes are not bounded"),
        };
        walk::offer_crossings(goal, index, id, crossings, self.ray.t_min, limit);
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
