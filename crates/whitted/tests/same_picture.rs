//! A picture depends on the scene and its settings only: not on how it is computed.

mod random_scene;

use random_scene::random_scene;
use std::sync::Mutex;
use whitted::classic::{Caster, Grid, KdTree, Math, Objects, Split, Structure, TriangleTest, Walk};
use whitted::geometry::Plane;
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{
    Cancel, Classic, Execution, Frame, Method, PixelRect, Progress, Region, Renderer, Silent, Unwatched, render,
    render_classic, render_rect,
};
use whitted::scene::{
    Antialias, Camera, Light, LightKind, NamedCamera, NamedMaterial, Prepared, Scene, Settings, Shadows,
};
use whitted::shading::Material;
use whitted::tree::{BuildOptions, TreeKind, WalkKind};

fn settings(seed: u64) -> Settings {
    Settings {
        size: [61, 47],
        depth: 1 + (seed % 6) as u32,
        min_weight: if seed.is_multiple_of(3) { 0.0 } else { 1.0 / 255.0 },
        antialias: match seed % 4 {
            0 => Antialias::Off,
            1 => Antialias::Paper,
            2 => Antialias::Edge,
            _ => Antialias::Uniform(3),
        },
        antialias_max: 5,
        shadows: if seed.is_multiple_of(5) { Shadows::Opaque } else { Shadows::Filter },
        seed: seed as u32,
        ..Settings::default()
    }
}

fn prepare(scene: &Scene, kind: TreeKind) -> Prepared {
    Prepared::new(scene, &BuildOptions { kind, ..BuildOptions::default() }).expect("a valid scene")
}

fn picture(prepared: &Prepared, settings: &Settings, execution: &Execution) -> Frame {
    render(prepared, settings, execution, &Silent, &Cancel::new()).expect("not cancelled")
}

/// The bits of all pixels: equality of floats would let −0 pass for 0.
fn bits(frame: &Frame) -> Vec<[u32; 3]> {
    frame.image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}

fn assert_same(expected: &Frame, found: &Frame, what: &str) {
    let differing = bits(expected).iter().zip(bits(found)).filter(|(a, b)| **a != *b).count();
    assert_eq!(differing, 0, "{differing} pixels differ: {what}");
    assert_eq!(expected.supersampled, found.supersampled, "{what}");
    assert_eq!(expected.first, found.first, "{what}");
    let counts = |frame: &Frame| {
        // How much work the tree does is exempt, and wavefronts test in blocks.
        whitted::render::Statistics { primitive_tests: 0, node_steps: 0, ..frame.statistics }
    };
    assert_eq!(counts(expected), counts(found), "{what}");
}

#[test]
fn wavefront_equals_recursion() {
    for seed in 0..40 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::Best);
        let expected = picture(&prepared, &settings, &Execution { method: Method::Recursive, ..Execution::default() });
        assert!(expected.image.pixels.iter().all(|p| p.is_finite() && p.min_component() >= 0.0), "scene {seed}");
        let found = picture(&prepared, &settings, &Execution::default());
        assert_same(&expected, &found, &format!("scene {seed}"));
    }
}

/// A floor, a lamp above it, and between them `count` glass spheres within each other.
fn shells(count: u32) -> Scene {
    let named = |name: &str, material| NamedMaterial { name: name.into(), material };
    let white = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
    let glass = Material { transmit: Vec3f::splat(0.99), ior: 1.0, diffuse: 0.0, ambient: 0.0, ..Material::default() };
    let radius = |shell: u32| 0.05 + 1.5 * f64::from(shell) / f64::from(count);
    let floor = Plane { point: Vec3d::new(0.0, 0.0, 0.0), normal: Vec3d::new(0.0, 1.0, 0.0) };
    Scene {
        cameras: vec![NamedCamera {
            name: String::new(),
            camera: Camera { eye: Vec3d::new(0.0, 4.0, 0.5), look_at: Vec3d::ZERO, vfov: 60.0, ..Camera::default() },
        }],
        lights: vec![Light {
            kind: LightKind::Point { position: Vec3d::new(0.0, 30.0, 0.0) },
            color: Vec3f::splat(1.0),
            inverse_square: false,
        }],
        ambient: Vec3f::ZERO,
        materials: vec![named("white", white), named("glass", glass)],
        spheres: (0..count).map(|shell| (Vec3d::new(0.0, 10.0, 0.0), radius(shell), 1)).collect(),
        planes: vec![(floor, 0)],
        ..Scene::default()
    }
}

#[test]
fn shadow_rays_through_more_surfaces_than_lists_hold_are_walked_one_by_one() {
    let settings =
        Settings { size: [64, 64], shadows: Shadows::Filter, antialias: Antialias::Off, ..Settings::default() };
    let prepared = prepare(&shells(600), TreeKind::Best);
    let expected = picture(&prepared, &settings, &Execution { method: Method::Recursive, ..Execution::default() });
    let found = picture(&prepared, &settings, &Execution::default());
    assert_same(&expected, &found, "600 shells");
    let dark = expected.image.pixels.iter().filter(|pixel| pixel.x == 0.0).count();
    let through_glass = expected.image.pixels.iter().filter(|pixel| pixel.x > 0.0 && pixel.x < 0.9).count();
    assert!(dark > 100 && through_glass > 100, "{dark} dark pixels, {through_glass} lit through glass");
}

#[test]
fn regions_do_not_matter() {
    for seed in 40..48 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::Best);
        let expected = picture(&prepared, &settings, &Execution::default());
        let squares = [1, 2, 7, 16, 33, 128].map(|side| Region::Rectangle(side, side));
        for region in squares.into_iter().chain([Region::Rectangle(61, 3), Region::Scanline, Region::Frame]) {
            let found = picture(&prepared, &settings, &Execution { region, ..Execution::default() });
            assert_same(&expected, &found, &format!("scene {seed}, {region:?}"));
        }
    }
}

#[test]
fn threads_do_not_matter() {
    for seed in 50..54 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::Best);
        let execution = Execution { region: Region::Rectangle(8, 8), ..Execution::default() };
        let mut frames = (1..=8).map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| picture(&prepared, &settings, &execution))
        });
        let expected = frames.next().expect("eight frames");
        frames.for_each(|found| assert_same(&expected, &found, &format!("scene {seed}")));
    }
}

#[test]
fn instruction_sets_walks_and_trees_do_not_matter() {
    for seed in 60..80 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::None);
        let expected = picture(&prepared, &settings, &Execution::default());
        for kind in [TreeKind::Kd, TreeKind::Fast, TreeKind::Best] {
            let prepared = prepare(&scene, kind);
            for level in simd::Level::available() {
                for walk in [WalkKind::Auto, WalkKind::Stream, WalkKind::Single] {
                    let found = picture(&prepared, &settings, &Execution { level, walk, ..Execution::default() });
                    assert_same(&expected, &found, &format!("scene {seed}, {kind:?}, {}, {walk:?}", level.name()));
                }
            }
        }
    }
}

#[test]
fn the_papers_structures_walks_and_arithmetic_do_not_matter() {
    for seed in 90..100 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::None);
        let expected = picture(&prepared, &settings, &Execution::default());
        let primitives = prepared.geometry().primitives();
        let objects = Objects::new(primitives, TriangleTest::Watertight);
        let kd = |split| Structure::Kd(KdTree::build(primitives, split));
        for (structure, walk) in [
            (Structure::Naive, Walk::Stack),
            (kd(Split::Sah), Walk::Sequential),
            (kd(Split::Sah), Walk::Stack),
            (kd(Split::Median), Walk::Sequential),
            (Structure::Grid(Grid::build(primitives)), Walk::Stack),
        ] {
            for math in [Math::Scalar, Math::sse()] {
                let caster = Caster { primitives, objects: &objects, structure: &structure, walk, math };
                let (classic, execution) = (Classic { prepared: &prepared, caster }, Execution::default());
                let (rect, cancel) = (PixelRect::whole(settings.size), Cancel::new());
                let found = render_classic(&classic, &settings, &execution, &rect, &Silent, &cancel, &Unwatched);
                assert_same(&expected, &found.expect("not cancelled"), &format!("scene {seed}, {walk:?}, {math:?}"));
            }
        }
    }
}

#[test]
fn a_part_is_cut_from_the_whole() {
    for seed in 80..90 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::Best);
        let whole = picture(&prepared, &settings, &Execution::default());
        let rect = PixelRect { x: 13, y: 9, width: 30, height: 22 };
        let execution = Execution { region: Region::Rectangle(11, 11), ..Execution::default() };
        let part = render_rect(&prepared, &settings, &execution, &rect, &Silent, &Cancel::new(), &Unwatched)
            .expect("not cancelled");
        for pixel in rect.pixels() {
            let (there, here) = (whole.rect.index(pixel), rect.index(pixel));
            assert_eq!(whole.image.pixels[there], part.image.pixels[here], "scene {seed}, pixel {pixel:?}");
            assert_eq!(whole.supersampled[there], part.supersampled[here], "scene {seed}, pixel {pixel:?}");
        }
        let needs_apron = matches!(settings.antialias, Antialias::Paper | Antialias::Edge);
        assert_eq!(part.apron.camera_rays, if needs_apron { 2 * (30 + 22) + 4 } else { 0 });
    }
}

#[test]
fn a_part_beside_the_picture_is_empty() {
    let prepared = prepare(&random_scene(1), TreeKind::Best);
    for rect in [PixelRect { x: 61, y: 3, width: 5, height: 5 }, PixelRect { x: 9, y: 9, width: 0, height: 4 }] {
        let part =
            render_rect(&prepared, &settings(2), &Execution::default(), &rect, &Silent, &Cancel::new(), &Unwatched);
        assert!(part.expect("not cancelled").image.pixels.is_empty());
    }
}

#[test]
fn a_cancelled_render_stops() {
    let cancel = Cancel::new();
    cancel.cancel();
    let prepared = prepare(&random_scene(1), TreeKind::Best);
    assert!(render(&prepared, &settings(1), &Execution::default(), &Silent, &cancel).is_err());
}

/// A picture put together from what a render tells, which cancels it when so many regions are done.
struct Told<'a> {
    rect: PixelRect,
    pixels: Mutex<Vec<Vec3f>>,
    cancel: &'a Cancel,
    cancel_after: usize,
}

impl Progress for Told<'_> {
    fn regions_done(&self, _: u32, done: usize, _: usize) {
        if done >= self.cancel_after {
            self.cancel.cancel();
        }
    }

    fn painted(&self, rect: &PixelRect, colors: &mut dyn Iterator<Item = Vec3f>) {
        let mut pixels = self.pixels.lock().unwrap();
        rect.pixels().zip(colors).for_each(|(pixel, color)| pixels[self.rect.index(pixel)] = color);
    }

    fn refined(&self, pixels: &mut dyn Iterator<Item = ([u32; 2], Vec3f)>) {
        let mut all = self.pixels.lock().unwrap();
        pixels.for_each(|(pixel, color)| all[self.rect.index(pixel)] = color);
    }
}

#[test]
fn memory_that_was_used_before_changes_nothing_and_the_sink_hears_of_every_pixel() {
    let renderer = Renderer::default();
    let execution = Execution { region: Region::Rectangle(16, 16), ..Execution::default() };
    for seed in 90..98 {
        let (scene, settings) = (random_scene(seed), settings(seed));
        let prepared = prepare(&scene, TreeKind::Best);
        let rect = PixelRect { x: 3, y: 5, width: 50, height: 40 };
        for cancel_after in [3, usize::MAX] {
            let cancel = Cancel::new();
            let pixels = Mutex::new(vec![Vec3f::splat(-1.0); rect.len()]);
            let told = Told { rect, pixels, cancel: &cancel, cancel_after };
            let frame = renderer.render(&prepared, &settings, &execution, &rect, &told, &cancel, &Unwatched);
            let Ok(frame) = frame else { continue };
            let fresh = render_rect(&prepared, &settings, &execution, &rect, &Silent, &Cancel::new(), &Unwatched);
            assert_same(&fresh.expect("not cancelled"), &frame, &format!("scene {seed}"));
            assert_eq!(told.pixels.into_inner().unwrap(), frame.image.pixels, "scene {seed}");
            renderer.recycle(frame);
        }
    }
}

#[test]
fn first_samples_that_nobody_wants_are_missed_by_nobody() {
    let renderer = Renderer::default();
    let whole = PixelRect::whole(settings(0).size);
    for (seed, antialias) in (60..).zip([Antialias::Off, Antialias::Uniform(3), Antialias::Paper, Antialias::Edge]) {
        let (scene, settings) = (random_scene(seed), Settings { antialias, ..settings(seed) });
        let prepared = prepare(&scene, TreeKind::Best);
        let wanted = picture(&prepared, &settings, &Execution::default());
        for method in [Method::Wavefront, Method::Recursive] {
            let execution = Execution { first_samples: false, method, ..Execution::default() };
            let frame =
                renderer.render(&prepared, &settings, &execution, &whole, &Silent, &Cancel::new(), &Unwatched).unwrap();
            let needs_them = matches!(antialias, Antialias::Paper | Antialias::Edge);
            assert_eq!(frame.first.len(), if needs_them { whole.len() } else { 0 });
            let first = wanted.first.clone();
            let given_back = Frame { first, ..frame };
            assert_same(&wanted, &given_back, &format!("{antialias:?} {method:?}"));
            renderer.recycle(given_back);
        }
    }
}
