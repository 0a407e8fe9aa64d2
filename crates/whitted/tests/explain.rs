//! The rays of a pixel are those that make its colour.

mod random_scene;

use random_scene::random_scene;
use std::collections::HashSet;
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{
    Cancel, Execution, Frame, RayEnd, RayKind, RayTree, SampleTree, Silent, TracedRay, explain, render,
};
use whitted::scene::{
    Antialias, Camera, Light, LightKind, NamedCamera, NamedMaterial, Prepared, Scene, Settings, Shadows,
};
use whitted::shading::Material;
use whitted::tree::BuildOptions;

const ALL: std::ops::Range<u32> = 0..u32::MAX;

fn prepare(scene: &Scene) -> Prepared {
    Prepared::new(scene, &BuildOptions::default()).expect("a valid scene")
}

fn picture(prepared: &Prepared, settings: &Settings) -> Frame {
    render(prepared, settings, &Execution::default(), &Silent, &Cancel::new()).expect("not cancelled")
}

fn rays_of(prepared: &Prepared, settings: &Settings, pixel: [u32; 2]) -> RayTree {
    explain(prepared, settings, pixel, ALL, &Cancel::new()).expect("not cancelled")
}

/// The light of all rays together, in fixed point of 2⁻³².
fn sum(sample: &SampleTree) -> Vec3f {
    let fixed = |light: f32| if light > 0.0 { (light.min(1073741824.0) * 4294967296.0) as i64 } else { 0 };
    let mut sum = [0i64; 3];
    for ray in &sample.rays {
        for (sum, light) in sum.iter_mut().zip(ray.light.to_array()) {
            *sum += fixed(light);
        }
    }
    sum.map(|sum| (sum as f64 / 4294967296.0) as f32).into()
}

#[test]
fn the_light_of_all_rays_is_the_colour_of_the_pixel() {
    let mut seen = HashSet::new();
    for seed in 0..24 {
        let scene = random_scene(seed);
        let settings = Settings {
            size: [24, 18],
            depth: 1 + (seed % 5) as u32,
            min_weight: if seed.is_multiple_of(2) { 0.2 } else { 0.0 },
            antialias: if seed.is_multiple_of(3) { Antialias::Uniform(3) } else { Antialias::Edge },
            antialias_max: 4,
            shadows: if seed.is_multiple_of(5) { Shadows::Opaque } else { Shadows::Filter },
            seed: seed as u32,
            ..Settings::default()
        };
        let prepared = prepare(&scene);
        let frame = picture(&prepared, &settings);
        for pixel in frame.rect.pixels().filter(|[x, y]| (x + 5 * y + seed as u32).is_multiple_of(7)) {
            let tree = rays_of(&prepared, &settings, pixel);
            let index = frame.rect.index(pixel);
            assert_eq!(tree.sample_count > 1, frame.supersampled[index], "scene {seed}, pixel {pixel:?}");
            assert_eq!(tree.samples.len(), tree.sample_count as usize);
            let sums = tree.samples.iter().map(sum);
            let total = sums.fold(Vec3d::ZERO, |total, sum| total + sum.to_f64());
            let mean = (total / f64::from(tree.sample_count)).to_f32();
            let bits = |color: Vec3f| color.to_array().map(f32::to_bits);
            assert_eq!(bits(mean), bits(frame.image.pixels[index]), "scene {seed}, pixel {pixel:?}");
            assert_eq!(bits(tree.color), bits(mean), "scene {seed}, pixel {pixel:?}");
            for sample in &tree.samples {
                assert_eq!(bits(sample.color), bits(sum(sample)), "scene {seed}, pixel {pixel:?}");
                check_shape(sample, &settings);
                seen.extend(sample.rays.iter().map(|ray| name(&ray.end)));
            }
        }
    }
    let expected = ["missed", "hit", "clear", "filtered", "blocked", "away", "weight", "depth", "total"];
    expected.iter().for_each(|end| assert!(seen.contains(end), "no ray ended by {end}"));
}

fn name(end: &RayEnd) -> &'static str {
    match end {
        RayEnd::Missed => "missed",
        RayEnd::Hit(_) => "hit",
        RayEnd::Clear => "clear",
        RayEnd::Filtered => "filtered",
        RayEnd::Blocked { .. } => "blocked",
        RayEnd::FacesAway => "away",
        RayEnd::WeightLimit => "weight",
        RayEnd::DepthLimit => "depth",
        RayEnd::BudgetSpent => "budget",
        RayEnd::TotalReflection => "total",
    }
}

/// Every ray comes from a surface that was hit before, and what was not traced adds nothing.
fn check_shape(sample: &SampleTree, settings: &Settings) {
    for (index, ray) in sample.rays.iter().enumerate() {
        assert!(ray.end.is_traced() || ray.light == Vec3f::ZERO, "{ray:?}");
        let Some(parent) = ray.parent else {
            assert_eq!((index, ray.kind), (0, RayKind::Camera));
            continue;
        };
        assert!(parent < index);
        let RayEnd::Hit(hit) = &sample.rays[parent].end else { panic!("a parent that hit nothing") };
        let parent = &sample.rays[parent];
        let is_shadow = matches!(ray.kind, RayKind::Shadow(_));
        assert_eq!(ray.generation, parent.generation + u32::from(!is_shadow));
        assert!(is_shadow || ray.generation <= settings.depth || !ray.end.is_traced(), "{ray:?}");
        let near = |point: Vec3d| (point - hit.position).length() <= 1e-3 * (1.0 + parent.length);
        assert!(is_shadow || near(ray.origin), "{ray:?} leaves {hit:?}");
        let ends = [ray.origin, ray.origin + ray.direction * ray.length];
        let touches = !ends[1].is_finite() || ends.into_iter().any(near) || matches!(ray.end, RayEnd::Blocked { .. });
        assert!(touches, "{ray:?} lights {hit:?}");
        match ray.end {
            RayEnd::WeightLimit => assert!(ray.weight.max_component() < settings.min_weight),
            RayEnd::DepthLimit => assert_eq!(ray.generation, settings.depth + 1),
            RayEnd::TotalReflection => assert_eq!((ray.kind, ray.direction), (RayKind::Refracted, Vec3d::ZERO)),
            RayEnd::Hit(hit) => {
                let gap = (ray.origin + ray.direction * ray.length - hit.position).length();
                assert!(gap <= 1e-4 * (1.0 + ray.length), "{gap}: {ray:?}");
            }
            _ => {}
        }
    }
}

/// A mirror in the middle of the picture, below a lamp; a ball hides the floor behind it from a second one.
fn staged() -> Scene {
    let camera = Camera { eye: Vec3d::new(0.0, 0.0, 10.0), look_at: Vec3d::ZERO, ..Camera::default() };
    let lamp = |y| Light {
        kind: LightKind::Point { position: Vec3d::new(0.0, y, 8.0) },
        color: Vec3f::splat(1.0),
        inverse_square: false,
    };
    let material = |name: &str, reflect| NamedMaterial {
        name: name.into(),
        material: Material { reflect: Vec3f::splat(reflect), ..Material::default() },
    };
    Scene {
        cameras: vec![NamedCamera { name: "front".into(), camera }],
        lights: vec![lamp(5.0), lamp(-5.0)],
        materials: vec![material("mirror", 0.5), material("matte", 0.0)],
        // Twice the size and distances of metres: the space of the scene is not that of the world.
        spheres: vec![(Vec3d::ZERO, 1.0, 0), (Vec3d::new(0.0, -2.6, 4.5), 0.4, 1)],
        settings: Settings { size: [31, 31], antialias: Antialias::Off, ..Settings::default() },
        ..Scene::default()
    }
}

#[test]
fn every_ray_says_why_it_ended() {
    let scene = staged();
    let tree = rays_of(&prepare(&scene), &scene.settings, [15, 15]);
    let [sample] = &tree.samples[..] else { panic!("one sample") };
    assert_eq!(sample.place, [15.5, 15.5]);
    let [camera, first, second, mirrored] = &sample.rays[..] else { panic!("four rays: {:#?}", sample.rays) };
    let RayEnd::Hit(hit) = &camera.end else { panic!("{camera:?}") };
    assert_eq!((hit.object, hit.primitive, hit.material, hit.enters), (0, 0, 0, true));
    assert!((hit.position - Vec3d::new(0.0, 0.0, 1.0)).length() < 1e-6, "{hit:?}");
    assert_eq!((camera.length, hit.n_s), (9.0, Vec3f::new(0.0, 0.0, 1.0)));
    assert_eq!((first.kind, first.end), (RayKind::Shadow(0), RayEnd::Clear));
    assert_eq!(first.light, first.weight);
    assert_eq!(second.kind, RayKind::Shadow(1));
    assert_eq!(second.end, RayEnd::Blocked { object: 1, primitive: 1 });
    let blocked = second.end_point().expect("it ends");
    assert!(((blocked - Vec3d::new(0.0, -2.6, 4.5)).length() - 0.4).abs() < 1e-5, "{blocked:?} lies on the ball");
    assert_eq!((mirrored.kind, mirrored.end, mirrored.weight), (RayKind::Reflected, RayEnd::Missed, Vec3f::splat(0.5)));
    assert_eq!(scene.object_name(hit.object), "sphere 1");
}

#[test]
fn places_are_in_world_space() {
    let mut scene = staged();
    let near = rays_of(&prepare(&scene), &scene.settings, [15, 15]);
    // So far away and so large that the scene is traced elsewhere and smaller.
    let (scale, far) = (1e6, Vec3d::splat(1e9));
    let moved = |point: Vec3d| point * scale + far;
    for (center, radius, _) in &mut scene.spheres {
        (*center, *radius) = (moved(*center), *radius * scale);
    }
    let camera = &mut scene.cameras[0].camera;
    (camera.eye, camera.look_at) = (moved(camera.eye), moved(camera.look_at));
    for light in &mut scene.lights {
        let LightKind::Point { position } = &mut light.kind else { panic!("a point light") };
        *position = moved(*position);
    }
    let far = rays_of(&prepare(&scene), &scene.settings, [15, 15]);
    assert_eq!(near.samples[0].rays.len(), far.samples[0].rays.len());
    let same = |a: &TracedRay, b: &TracedRay| {
        let moved_origin = (moved(a.origin) - b.origin).length() < 1e-5 * scale;
        moved_origin && (a.length == b.length || (a.length * scale - b.length).abs() < 1e-5 * scale)
    };
    for (a, b) in near.samples[0].rays.iter().zip(&far.samples[0].rays) {
        assert!(same(a, b), "{a:?} and {b:?}");
    }
}

#[test]
fn samples_may_be_chosen_and_pixels_outside_have_none() {
    let mut scene = staged();
    scene.settings.antialias = Antialias::Uniform(5);
    let prepared = prepare(&scene);
    let all = rays_of(&prepared, &scene.settings, [3, 4]);
    let some = explain(&prepared, &scene.settings, [3, 4], 2..4, &Cancel::new()).expect("not cancelled");
    assert_eq!((some.sample_count, some.color), (5, all.color));
    assert_eq!(some.samples, all.samples[2..4]);
    let outside = rays_of(&prepared, &scene.settings, [31, 0]);
    assert_eq!((outside.sample_count, outside.samples.len()), (0, 0));
    let nothing = explain(&prepared, &scene.settings, [3, 4], 7..9, &Cancel::new()).expect("not cancelled");
    assert!(nothing.samples.is_empty());
}
