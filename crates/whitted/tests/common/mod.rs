//! Random scenes and rays for the tests of queries.

#![allow(dead_code, reason = "each test file uses its part")]

use whitted::geometry::{Boxed, Cone, Cylinder, Disc, Plane, Primitives, Shape, Sphere};
use whitted::math::{SplitMix64, Vec3, Vec3d, Vec3f};
use whitted::ray::Ray;

/// A point with coordinates in ±`size`, sometimes on a coarse lattice so that coordinates coincide.
pub(crate) fn point(rng: &mut SplitMix64, size: f64) -> Vec3f {
    let lattice = rng.below(4) == 0;
    Vec3::new((), (), ()).map(|()| {
        let x = rng.uniform(-size, size);
        (if lattice { (x * 4.0 / size).round() * size / 4.0 } else { x }) as f32
    })
}

/// A scene of `count` triangles and spheres, a quarter of them degenerate, huge, flat or duplicates.
pub(crate) fn scene(rng: &mut SplitMix64, count: u32) -> Primitives {
    let mut primitives = Primitives::new();
    let mut previous: Option<[Vec3f; 3]> = None;
    let mut vertices = Vec::new();
    let mut spheres: Vec<Sphere> = Vec::new();
    let mut shapes = Vec::new();
    for _ in 0..count {
        let center = point(rng, 1.0);
        let size = [0.05, 0.2, 1.0, 3.0][rng.below(4) as usize];
        if rng.below(6) == 0 {
            shapes.push(shape(rng, center.to_f64(), size));
            continue;
        }
        if rng.below(3) == 0 {
            let odd = rng.below(8);
            let radius = match odd {
                0 => 0.0,
                1 => f32::NAN,
                _ => rng.uniform(0.01, size) as f32,
            };
            let sphere = Sphere { center, radius };
            spheres.push(if odd == 2 { spheres.last().copied().unwrap_or(sphere) } else { sphere });
            continue;
        }
        let mut corners = [(); 3].map(|()| center + point(rng, size));
        match rng.below(16) {
            0 => corners[1] = corners[0],
            1 => corners[2] = corners[0] + (corners[1] - corners[0]) * 0.25,
            2 => corners[rng.below(3) as usize].x = f32::NAN,
            3 => corners = previous.unwrap_or(corners),
            4 => corners.iter_mut().for_each(|c| c.z = 0.25),
            5 => corners[0] = previous.map_or(corners[0], |p| p[1]),
            _ => {}
        }
        previous = Some(corners);
        vertices.extend(corners);
    }
    let triangles: Vec<[u32; 3]> = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    primitives.push_mesh(&vertices, &triangles, &[], &[]).expect("a sound mesh");
    spheres.into_iter().for_each(|sphere| primitives.push_sphere(sphere));
    shapes.into_iter().for_each(|shape| primitives.push_shape(shape));
    if rng.below(4) == 0 {
        primitives.push_plane(Plane { point: point(rng, 2.0).to_f64(), normal: point(rng, 1.0).to_f64() });
    }
    primitives
}

/// A disc, box, cylinder or cone near `center`; some are degenerate.
fn shape(rng: &mut SplitMix64, center: Vec3d, size: f64) -> Shape {
    let other = center + point(rng, size).to_f64();
    let radius = if rng.below(8) == 0 { 0.0 } else { rng.uniform(0.01, size) };
    let capped = rng.below(2) == 0;
    match rng.below(4) {
        0 => Shape::Disc(Disc { center, normal: other - center, radius, inner_radius: radius * rng.uniform(0.0, 0.9) }),
        1 => Shape::Boxed(Boxed { lo: center.min(other), hi: center.max(other) }),
        2 => Shape::Cylinder(Cylinder { base: center, apex: other, radius, capped }),
        _ => {
            let apex_radius = radius * rng.uniform(0.0, 1.0);
            Shape::Cone(Cone { base: center, apex: other, base_radius: radius, apex_radius, capped })
        }
    }
}

/// A ray: random, along an axis, at a vertex, from far away, or with a range; a few are unsound.
pub(crate) fn ray(rng: &mut SplitMix64, primitives: &Primitives) -> Ray {
    let distance = [1.0, 3.0, 40.0, 1000.0][rng.below(4) as usize];
    let origin = point(rng, distance);
    let mut direction = point(rng, 1.0);
    let target = match primitives.triangle_count() {
        0 => point(rng, 1.0),
        count => {
            let corners = primitives.triangle(rng.below(count as u32) as usize).vertices;
            match rng.below(3) {
                0 => corners[0],
                1 => corners[0] * 0.5 + corners[1] * 0.5,
                _ => (corners[0] + corners[1] + corners[2]) / 3.0,
            }
        }
    };
    match rng.below(8) {
        0..4 => direction = target - origin,
        4 => direction = Vec3::new(0.0, 0.0, if rng.below(2) == 0 { 1.0 } else { -1.0 }),
        5 => direction.x = if rng.below(2) == 0 { 0.0 } else { -0.0 },
        _ => {}
    }
    let mut ray = Ray::new(origin, direction);
    match rng.below(32) {
        0 => ray.t_max = rng.uniform(0.0, 2.0) as f32,
        1 => ray.t_min = rng.uniform(0.0, 1.0) as f32,
        2 => ray.direction = Vec3f::ZERO,
        3 => ray.origin.y = [f32::NAN, f32::INFINITY][rng.below(2) as usize],
        4 => ray.direction.z = [f32::NAN, f32::INFINITY, 1e-40][rng.below(3) as usize],
        5 => ray.t_min = -1.0,
        _ => {}
    }
    ray
}

/// Sixty-four to 320 rays from one origin towards neighbouring points, as from a camera or a light; some packets are wide,
/// some have odd rays among them, or rays between two dominant axes.
pub(crate) fn packet(rng: &mut SplitMix64, primitives: &Primitives) -> Vec<Ray> {
    let lead = ray(rng, primitives);
    let width = [0.001, 0.05, 1.0][rng.below(3) as usize] * f64::from(lead.direction.abs().max_component());
    let count = 64 * (1 + rng.below(5));
    let mut rays: Vec<Ray> = (0..count)
        .map(|_| {
            let spread = Vec3::new((), (), ()).map(|()| rng.uniform(-width, width) as f32);
            Ray { direction: lead.direction + spread, ..lead }
        })
        .collect();
    match rng.below(6) {
        0 => rays[rng.below(count) as usize] = ray(rng, primitives),
        2 => rays.iter_mut().for_each(|ray| ray.direction.y = ray.direction.x),
        3 => rays.iter_mut().step_by(3).for_each(|ray| ray.direction.z = -ray.direction.x),
        1 => rays.iter_mut().for_each(|ray| ray.t_max = rng.uniform(0.0, 2.0) as f32),
        _ => {}
    }
    rays
}
