//! Pictures whose pixels are known from formulas.
//!
//! Numbers from `material/numbers/analytic.json` are found through `WHITTED_SHARED`.

use serde_json::Value;
use whitted::geometry::{Boxed, Plane, Shape};
use whitted::math::{SplitMix64, Vec3d, Vec3f};
use whitted::render::{Cancel, Execution, Frame, Silent, render};
use whitted::scene::{
    Antialias, Background, Camera, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Prepared, Scene, Settings,
    Shadows,
};
use whitted::shading::{Material, Texture};
use whitted::tree::BuildOptions;

/// The rows of a table of `analytic.json`, if the environment says where it is.
fn table(name: &str) -> Vec<Value> {
    let Some(shared) = std::env::var_os("WHITTED_SHARED") else {
        eprintln!("SKIPPED: WHITTED_SHARED is not set, so {name} was not checked");
        return Vec::new();
    };
    let path = std::path::Path::new(&shared).join("material/numbers/analytic.json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let all: Value = serde_json::from_str(&text).expect("JSON");
    all[name].as_array().unwrap_or_else(|| panic!("no table {name}")).clone()
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| panic!("no {key} in {row}"))
}

/// A material that neither shines nor answers to light.
fn black() -> Material {
    Material { color: Texture::Color(Vec3f::ONE), ambient: 0.0, diffuse: 0.0, ..Material::default() }
}

/// Lets light pass, bends it by `ior`, and absorbs `absorb` per unit of length.
fn clear(ior: f32, absorb: f32) -> Material {
    Material { transmit: Vec3f::ONE, ior, absorb: Vec3f::splat(absorb), ..black() }
}

fn white(diffuse: f32) -> Material {
    Material { diffuse, ..black() }
}

/// A scene seen from `eye` towards `look_at` with `materials` to refer to.
fn scene(eye: [f64; 3], look_at: [f64; 3], vfov: f64, materials: &[Material]) -> Scene {
    let up = if eye[0] == look_at[0] && eye[2] == look_at[2] {
        Vec3d::new(0.0, 0.0, -1.0)
    } else {
        Vec3d::new(0.0, 1.0, 0.0)
    };
    let camera = Camera { eye: eye.into(), look_at: look_at.into(), up, vfov };
    let named = |material: &Material| NamedMaterial { name: String::new(), material: material.clone() };
    Scene {
        cameras: vec![NamedCamera { name: String::new(), camera }],
        materials: materials.iter().map(named).collect(),
        ..Scene::default()
    }
}

fn point_light(position: [f64; 3]) -> Light {
    Light { kind: LightKind::Point { position: position.into() }, color: Vec3f::ONE, inverse_square: false }
}

fn settings(side: u32) -> Settings {
    Settings { size: [side, side], antialias: Antialias::Off, ..Settings::default() }
}

fn picture(scene: &Scene, settings: &Settings) -> Frame {
    let prepared = Prepared::new(scene, &BuildOptions::default()).expect("a valid scene");
    render(&prepared, settings, &Execution::default(), &Silent, &Cancel::new()).expect("not cancelled")
}

/// The only pixel of a picture of one pixel.
fn pixel(scene: &Scene, depth: u32) -> Vec3f {
    picture(scene, &Settings { depth, min_weight: 0.0, ..settings(1) }).image.pixels[0]
}

#[track_caller]
fn assert_near(found: f32, expected: f64, tolerance: f64) {
    assert!((f64::from(found) - expected).abs() <= tolerance, "{found} instead of {expected}");
}

/// The plane y = 0.
fn floor() -> Plane {
    Plane { point: Vec3d::ZERO, normal: Vec3d::new(0.0, 1.0, 0.0) }
}

#[test]
fn outlines_of_spheres_have_the_right_area() {
    for row in table("sphere_outline_area") {
        let (radius, distance, angle) =
            (number(&row, "sphere_radius"), number(&row, "distance"), number(&row, "angle_off_axis_rad"));
        // The table's pictures have area 4 at distance 1. Ours hold all of the outline and little more.
        let half = 1.02 * (angle + (radius / distance).asin()).tan();
        let (vfov, area) = (2.0 * half.atan().to_degrees(), 4.0 * half * half);
        let mut scene = scene([0.0; 3], [0.0, 0.0, -1.0], vfov, &[black()]);
        scene.spheres.push((Vec3d::new(angle.sin(), 0.0, -angle.cos()) * distance, radius, 0));
        let side = 2048;
        let hits = picture(&scene, &settings(side)).statistics.camera_hits as f64;
        let expected = number(&row, "fraction_of_picture") * 4.0 / area * f64::from(side * side);
        assert!((hits / expected - 1.0).abs() < 1e-3, "{hits} pixels instead of {expected}");
    }
}

#[test]
fn shadows_of_spheres_have_the_right_radius() {
    for row in table("sphere_shadow_on_plane") {
        // From below the sphere, straight down.
        let (height, vfov) = (0.4, 160.0_f64);
        let mut scene = scene([0.0, height, 0.0], [0.0; 3], vfov, &[white(1.0)]);
        scene.spheres.push((
            Vec3d::new(0.0, number(&row, "sphere_centre_height"), 0.0),
            number(&row, "sphere_radius"),
            0,
        ));
        scene.planes.push((floor(), 0));
        scene.lights.push(point_light([0.0, number(&row, "light_height"), 0.0]));
        let side = 1024;
        let frame = picture(&scene, &settings(side));
        let dark = frame.image.pixels.iter().filter(|p| **p == Vec3f::ZERO).count() as f64;
        let pixel = 2.0 * height * (0.5 * vfov).to_radians().tan() / f64::from(side);
        let radius = (dark / std::f64::consts::PI).sqrt() * pixel;
        let expected = number(&row, "shadow_radius_at_z0");
        assert!((radius / expected - 1.0).abs() < 1e-3, "radius {radius} instead of {expected}");
    }
}

#[test]
fn balls_of_glass_bend_and_absorb() {
    const ABSORB: f32 = 0.25;
    for row in table("ray_through_glass_sphere") {
        let offset = number(&row, "impact_parameter_over_R");
        let glass = clear(number(&row, "n") as f32, ABSORB);
        let mut scene = scene([-5.0, offset, 0.0], [0.0, offset, 0.0], 1.0, &[glass]);
        scene.spheres.push((Vec3d::ZERO, 1.0, 0));
        scene.background = Background::Gradient { down: Vec3f::ZERO, up: Vec3f::ONE };
        let y = -number(&row, "deviation_two_refractions").to_radians().sin();
        let left = (-f64::from(ABSORB) * number(&row, "path_length_inside_over_R")).exp();
        assert_near(pixel(&scene, 4).x, (0.5 + 0.5 * y) * left, 2e-6);
    }
}

#[test]
fn matte_planes_follow_lambert() {
    for row in table("lambert_point_light") {
        let mut scene = scene([0.0, 3.0, 0.0], [0.0; 3], 1.0, &[white(number(&row, "kd") as f32)]);
        let angle = number(&row, "incidence").to_radians();
        scene.lights.push(point_light([4.0 * angle.sin(), 4.0 * angle.cos(), 0.0]));
        scene.planes.push((floor(), 0));
        assert_near(pixel(&scene, 0).x, number(&row, "expected"), 1e-6);
    }
}

#[test]
fn mirrors_facing_each_other_show_each_other() {
    for row in table("parallel_mirrors") {
        let mirror = Material {
            color: Texture::Color(Vec3f::splat(number(&row, "own_colour") as f32)),
            ambient: 1.0,
            reflect: Vec3f::splat(number(&row, "reflectivity") as f32),
            ..black()
        };
        let mut scene = scene([0.0; 3], [0.0, 0.0, -1.0], 1.0, &[mirror]);
        scene.ambient = Vec3f::ONE;
        for z in [-1.0, 1.0] {
            scene.planes.push((Plane { point: Vec3d::new(0.0, 0.0, z), normal: Vec3d::new(0.0, 0.0, 1.0) }, 0));
        }
        // The table counts surfaces, the renderer generations after the camera ray.
        let depth = number(&row, "depth") as u32 - 1;
        assert_near(pixel(&scene, depth).x, number(&row, "colour"), 1e-6);
    }
}

#[test]
fn supersampled_edges_cover_the_right_part_of_a_pixel() {
    for row in table("edge_coverage") {
        let coverage = edge(number(&row, "slope"), number(&row, "offset"), 16);
        assert_near(coverage, number(&row, "pixel_coverage"), 1.0 / 16.0_f64.sqrt());
    }
}

#[test]
fn mean_error_of_coverage_falls_with_the_samples() {
    let mut random = SplitMix64::new(1);
    for samples in [4, 9, 16, 64] {
        let errors: Vec<f64> = (0..40)
            .map(|_| {
                let (slope, offset) = (random.uniform(-1.0, 1.0), random.uniform(0.2, 0.8));
                // The exact area below the line, by the middle rule on many columns.
                let columns = (0..1000).map(|i| (slope * ((f64::from(i) + 0.5) / 1000.0) + offset).clamp(0.0, 1.0));
                let exact = columns.sum::<f64>() / 1000.0;
                (f64::from(edge(slope, offset, samples)) - exact).abs()
            })
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        // Stratified samples are much better than the 1/√n of independent ones.
        assert!(mean < 0.5 / f64::from(samples).sqrt(), "{samples} samples: mean error {mean}");
    }
}

/// The brightness of a pixel whose part y < slope·x + offset is white, in a picture of 9×9 pixels.
fn edge(slope: f64, offset: f64, samples: u32) -> f32 {
    // Seen from distance 4.5 with 90°, pixels have side 1 on the plane z = 0. The middle one begins at (−0.5, −0.5).
    let glowing = Material { ambient: 1.0, ..black() };
    let mut scene = scene([0.0, 0.0, 4.5], [0.0; 3], 90.0, &[glowing]);
    scene.ambient = Vec3f::ONE;
    let line = |x: f64| (slope * (x + 0.5) + offset - 0.5) as f32;
    let far = 8.0_f32;
    let corners = [[-far, -99.0, 0.0], [far, -99.0, 0.0], [far, line(8.0), 0.0], [-far, line(-8.0), 0.0]];
    scene.meshes.push(Mesh { positions: corners.into(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() });
    let settings = Settings { antialias: Antialias::Edge, antialias_max: samples, ..settings(9) };
    let frame = picture(&scene, &settings);
    assert!(frame.supersampled[4 * 9 + 4], "the edge was not seen");
    frame.image.pixels[4 * 9 + 4].x
}

#[test]
fn light_is_filtered_by_every_surface_on_its_way() {
    let tinted = |transmit: [f32; 3]| Material { transmit: transmit.into(), ior: 1.5, ..black() };
    let materials = [white(1.0), tinted([0.5, 0.25, 1.0]), tinted([0.9, 0.5, 0.0])];
    let mut scene = scene([0.0, 0.5, 3.0], [0.0; 3], 1.0, &materials);
    scene.planes.push((floor(), 0));
    scene.lights.push(point_light([0.0, 9.0, 0.0]));
    // A pane, twice the surface of a ball, and twice that of a box.
    scene.planes.push((Plane { point: Vec3d::new(0.0, 6.0, 0.0), normal: Vec3d::new(0.0, 1.0, 0.0) }, 1));
    scene.spheres.push((Vec3d::new(0.0, 4.0, 0.0), 0.5, 1));
    let boxed = Boxed { lo: Vec3d::new(-1.0, 2.0, -1.0), hi: Vec3d::new(1.0, 2.5, 1.0) };
    scene.shapes.push((Shape::Boxed(boxed), 2));
    let found = pixel(&scene, 0);
    for (found, expected) in found.to_array().into_iter().zip([0.125 * 0.81, 0.015625 * 0.25, 0.0]) {
        assert_near(found, expected, 1e-6);
    }
    let opaque = Settings { shadows: Shadows::Opaque, ..settings(1) };
    assert_eq!(picture(&scene, &opaque).image.pixels[0], Vec3f::ZERO);
}

#[test]
fn steep_light_in_glass_is_totally_reflected() {
    // From inside a block of glass, 60° from the normal of its upper face.
    let glass = Material { reflect: Vec3f::splat(0.25), transmit: Vec3f::splat(0.5), ..clear(1.5, 0.0) };
    let mut scene = scene([0.0; 3], [60.0_f64.to_radians().sin(), 0.5, 0.0], 1.0, &[glass]);
    scene.shapes.push((Shape::Boxed(Boxed { lo: Vec3d::splat(-10.0), hi: Vec3d::new(100.0, 1.0, 10.0) }), 0));
    scene.background = Background::Gradient { down: Vec3f::new(1.0, 0.0, 0.0), up: Vec3f::new(0.0, 1.0, 0.0) };
    let frame = picture(&scene, &Settings { depth: 1, min_weight: 0.0, ..settings(1) });
    // All that would have left is reflected, and that ray is still inside at the depth limit.
    assert_eq!(frame.statistics.refracted_rays, 0);
    assert_eq!(frame.statistics.reflected_rays, 1);
}

#[test]
fn glass_in_water_in_glass_bends_by_the_ratio() {
    // Straight through nested balls of one index nothing bends, however they are nested.
    let glass = clear(1.5, 0.0);
    let mut scene = scene([-5.0, 0.4, 0.0], [0.0, 0.4, 0.0], 1.0, &[glass.clone(), glass]);
    scene.background = Background::Gradient { down: Vec3f::ZERO, up: Vec3f::ONE };
    scene.spheres.push((Vec3d::ZERO, 1.0, 0));
    let alone = pixel(&scene, 20);
    scene.spheres.push((Vec3d::new(0.0, 0.3, 0.0), 0.5, 1));
    scene.spheres.push((Vec3d::new(0.3, 0.3, 0.0), 0.5, 1));
    assert_near(pixel(&scene, 20).x, f64::from(alone.x), 1e-6);
}

#[test]
fn large_and_distant_lights_cast_no_acne() {
    // A lit floor and ball from lights near and far: away from the ball's shadow and terminator nothing is dark.
    for distance in [1.0, 10.0, 1e3, 1e6, 1e12, 1e18] {
        let mut scene = scene([0.0, 2.0, 4.0], [0.0; 3], 60.0, &[white(1.0)]);
        let corners = [[-9.0, 0.0, -9.0], [-9.0, 0.0, 9.0], [9.0, 0.0, 9.0], [9.0, 0.0, -9.0]];
        scene.meshes.push(Mesh { positions: corners.into(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() });
        scene.lights.push(point_light([0.3 * distance, distance, 0.2 * distance]));
        let frame = picture(&scene, &settings(128));
        let lit = |index: usize| frame.first[index].depth.is_infinite() || frame.image.pixels[index].x > 0.0;
        assert!((0..frame.first.len()).all(lit), "acne with the light at {distance:e}");
    }
}
