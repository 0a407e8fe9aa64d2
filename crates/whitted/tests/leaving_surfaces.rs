//! Rays that leave a surface do not meet it again: no acne, at any place and size, without an epsilon.

use whitted::geometry::{Boxed, Cone, Cylinder, Shape};
use whitted::math::{SplitMix64, Vec3, Vec3d, Vec3f};
use whitted::render::{Cancel, Execution, Frame, Silent, render};
use whitted::scene::{
    Antialias, Camera, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Prepared, Scene, Settings,
};
use whitted::shading::{Material, Texture};
use whitted::tree::BuildOptions;

/// A convex body of about the given size around the given point, one of several kinds.
fn add_body(scene: &mut Scene, kind: u32, center: Vec3d, size: f64) {
    let at = |x: f64, y: f64, z: f64| center + Vec3d::new(x, y, z) * size;
    let shape = match kind {
        0 => return scene.spheres.push((center, size, 0)),
        1 => return scene.meshes.push(octahedron(center, size)),
        2 => Shape::Boxed(Boxed { lo: at(-0.7, -0.5, -0.9), hi: at(0.6, 0.8, 0.4) }),
        3 => {
            let (base, apex) = (at(-0.2, -0.8, 0.1), at(0.3, 0.7, 0.2));
            Shape::Cylinder(Cylinder { base, apex, radius: 0.5 * size, capped: true })
        }
        _ => {
            let (base, apex) = (at(0.2, -0.6, 0.3), at(-0.1, 0.9, -0.2));
            Shape::Cone(Cone { base, apex, base_radius: 0.6 * size, apex_radius: 0.1 * size, capped: true })
        }
    };
    scene.shapes.push((shape, 0));
}

const KINDS: u32 = 5;

fn octahedron(center: Vec3d, size: f64) -> Mesh {
    let corners = [[1.0, 0.1, 0.0], [0.1, 1.0, 0.2], [0.0, -0.1, 1.0]].map(|c| Vec3::from(c) * size);
    let corners = corners.into_iter().flat_map(|c| [center + c, center - c]);
    // Opposite corners have numbers that differ in the last bit.
    let face = |i: u32| [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2)];
    let outward = |[a, b, c]: [u32; 3]| if (a + b + c) % 2 == 0 { [a, b, c] } else { [a, c, b] };
    Mesh {
        positions: corners.map(|c| c.to_f32().to_array()).collect(),
        triangles: (0..8).map(face).map(outward).collect(),
        ..Mesh::default()
    }
}

/// A picture of a single body from a random side, at a random place, in a random size.
fn picture(seed: u64, material: &Material, depth: u32) -> (Scene, Frame) {
    let mut random = SplitMix64::new(seed);
    let direction = |random: &mut SplitMix64| {
        Vec3d::new(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)).direction()
    };
    let size = 10f64.powf(random.uniform(-8.0, 8.0));
    let center = direction(&mut random) * (size * 10f64.powf(random.uniform(-2.0, 4.0)));
    let eye = center + direction(&mut random) * (size * 10f64.powf(random.uniform(0.4, 1.5)));
    let position = center + direction(&mut random) * (size * 10f64.powf(random.uniform(0.4, 3.0)));
    let distance = (eye - center).length();
    let camera =
        Camera { eye, look_at: center, vfov: 2.2 * (size / distance).atan().to_degrees(), ..Camera::default() };
    let mut scene = Scene {
        cameras: vec![NamedCamera { name: String::new(), camera }],
        lights: vec![Light { kind: LightKind::Point { position }, color: Vec3f::ONE, inverse_square: false }],
        materials: vec![NamedMaterial { name: String::new(), material: material.clone() }],
        ..Scene::default()
    };
    add_body(&mut scene, seed as u32 % KINDS, center, size);
    let prepared = Prepared::new(&scene, &BuildOptions::default()).expect("a valid scene");
    let settings =
        Settings { size: [128, 128], depth, min_weight: 0.0, antialias: Antialias::Off, ..Settings::default() };
    let frame = render(&prepared, &settings, &Execution::default(), &Silent, &Cancel::new()).expect("not cancelled");
    (scene, frame)
}

fn matte() -> Material {
    Material { color: Texture::Color(Vec3f::ONE), ambient: 0.0, diffuse: 1.0, ..Material::default() }
}

const PICTURES: u64 = 250;

#[test]
fn convex_bodies_cast_no_shadow_on_themselves() {
    let mut hits = 0;
    for seed in 0..PICTURES {
        let (scene, frame) = picture(seed, &matte(), 0);
        hits += frame.statistics.camera_hits;
        // Every shadow ray arrives: whatever faces the light is lit.
        let lit = frame.image.pixels.iter().filter(|p| p.x > 0.0).count() as u64;
        assert_eq!(frame.statistics.shadow_rays, lit, "{seed}: {scene:?}");
    }
    assert!(hits > PICTURES * 3000, "only {hits} hits");
}

#[test]
fn convex_bodies_do_not_mirror_themselves() {
    let mirror = Material { reflect: Vec3f::ONE, ..matte() };
    for seed in 0..PICTURES {
        let (scene, frame) = picture(seed, &mirror, 1);
        assert_eq!(frame.statistics.reflected_rays, frame.statistics.camera_hits);
        // A mirrored ray that hit the body would have been reflected again, had the depth allowed it.
        assert_eq!(frame.statistics.cut_by_depth, 0, "{seed}: {scene:?}");
    }
}

#[test]
fn rays_that_enter_a_convex_body_leave_it_once() {
    let clear = Material { transmit: Vec3f::ONE, ior: 1.0, ..matte() };
    let (mut entered, mut lost) = (0, 0);
    for seed in 0..PICTURES {
        let (scene, frame) = picture(seed, &clear, 2);
        let counts = frame.statistics;
        assert_eq!(counts.cut_by_depth, 0, "{seed}: {scene:?}");
        entered += counts.camera_hits;
        // Rays that cut off less than the offset begin on the other side of the body.
        lost += 2 * counts.camera_hits - counts.refracted_rays;
    }
    assert!(lost * 10_000 < entered, "{lost} of {entered} rays did not leave");
}
