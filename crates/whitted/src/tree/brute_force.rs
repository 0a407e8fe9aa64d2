//! The oracle: every ray against every primitive, one at a time, in plain Rust.

use super::goal::Goal;
use super::query::Counts;
use super::walk::PreparedRays;
use super::{Tree, walk};
use crate::geometry::sphere::{self, SphereRay};
use crate::geometry::triangle::{self, renamed};
use crate::geometry::{Kind, Primitives, ShearedRay};
use simd::{F32Lanes, MaskLanes, Scalar, ScalarF32};

type One = ScalarF32<1>;

/// Offer every hit of every ray.
pub(super) fn walk<G: Goal>(tree: &Tree, primitives: &Primitives, rays: &mut PreparedRays, goal: &mut G) -> Counts {
    let mut counts = Counts::default();
    let bounded = 0..primitives.bounded_count() as u32;
    let sound: Vec<u32> = bounded.filter(|&id| primitives.primitive_bounds(id).is_some()).collect();
    for index in 0..rays.len() {
        let (sheared, sphere_ray) = (rays.sheared(index), rays.sphere(index));
        for &id in &sound {
            if rays.limit(index) < rays.t_min(index) {
                break;
            }
            counts.primitive_tests += 1;
            let (t_min, limit) = (rays.t_min(index), rays.limit(index));
            let t = intersect(tree.scale(), primitives, id, &sheared, &sphere_ray, t_min, limit, rays, index);
            if let Some(t) = t
                && let Some(shorter) = goal.offer(index, t, id, limit)
            {
                rays.set_limit(index, shorter);
            }
        }
    }
    counts
}

/// The parameter at which one prepared ray meets one primitive within `t_min ≤ t ≤ t_max`.
fn intersect(
    scale: f32,
    primitives: &Primitives,
    id: u32,
    sheared: &ShearedRay,
    sphere_ray: &SphereRay,
    t_min: f32,
    t_max: f32,
    rays: &PreparedRays,
    index: usize,
) -> Option<f32> {
    let lane = |value: f32| One::splat(Scalar, value);
    let (hit, t) = match primitives.kind(id) {
        Kind::Triangle(i) => {
            let axes = renamed(sheared.axis as usize);
            let vertices = primitives.triangle(i).vertices.map(|p| axes.map(|axis| lane(p[axis] * scale)));
            triangle::intersect(Scalar, sheared, vertices, lane(t_min), lane(t_max))
        }
        Kind::Sphere(i) => {
            let sphere = primitives.spheres()[i];
            let center = sphere.center.to_array().map(|c| lane(c * scale));
            let radius = lane(sphere.radius * scale);
            sphere::intersect(Scalar, sphere_ray, center, radius * radius, lane(t_min), lane(t_max))
        }
        Kind::Shape(i) => return walk::first_crossing(&primitives.shapes()[i], &rays.ray(index), t_min, t_max),
        Kind::Plane(_) => unreachable!("planes are not bounded"),
    };
    let mut stored = [0.0];
    t.store(&mut stored);
    hit.any().then_some(stored[0])
}
