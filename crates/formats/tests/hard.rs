//! Legal torture scenes: each must render, in time, to what brute force and one ray after the other give.
//!
//! The scenes are not part of the repository: `WHITTED_SHARED` names the folder that holds `material/broken/made/hard`.

use formats::LoadOptions;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use whitted::math::{Affine, Vec3d, Vec3f};
use whitted::render::{Cancel, Execution, Frame, Method, Silent, render};
use whitted::scene::{LightKind, Prepared, Scene, Settings};
use whitted::tree::{BuildOptions, TreeKind};

/// The folder with the scenes, if there is one.
fn hard() -> Option<PathBuf> {
    let shared = std::env::var_os("WHITTED_SHARED");
    if shared.is_none() {
        eprintln!("SKIPPED: WHITTED_SHARED is not set, the torture scenes were not rendered");
    }
    shared.map(|folder| PathBuf::from(folder).join("material/broken/made/hard"))
}

fn load(file: &Path) -> Scene {
    formats::load(file, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}")).scene
}

fn picture(scene: &Scene, settings: &Settings, kind: TreeKind, method: Method) -> Frame {
    let prepared = Prepared::new(scene, &BuildOptions { kind, ..BuildOptions::default() }).expect("a valid scene");
    let execution = Execution { method, ..Execution::default() };
    render(&prepared, settings, &execution, &Silent, &Cancel::new()).expect("not cancelled")
}

fn best(scene: &Scene) -> Frame {
    picture(scene, &scene.settings, TreeKind::Best, Method::Wavefront)
}

#[test]
fn torture_scenes_equal_brute_force_and_end_in_time() {
    const LONGEST: Duration = Duration::from_secs(2);
    let Some(folder) = hard() else { return };
    let mut rendered = 0;
    for entry in std::fs::read_dir(folder).expect("the folder of torture scenes") {
        let file = entry.expect("an entry").path();
        let scene = load(&file);
        let settings = Settings { depth: 8, ..scene.settings.clone() };
        let start = Instant::now();
        let found = picture(&scene, &settings, TreeKind::Best, Method::Wavefront);
        let time = start.elapsed();
        assert!(time < LONGEST, "{}: {time:?}", file.display());
        assert!(found.image.pixels.iter().all(|p| p.is_finite()), "{}", file.display());
        // Brute force takes its time: a smaller picture.
        let settings = Settings { size: [24, 24], ..settings };
        let found = picture(&scene, &settings, TreeKind::Best, Method::Wavefront);
        let expected = picture(&scene, &settings, TreeKind::None, Method::Recursive);
        assert_eq!(found.image, expected.image, "{}", file.display());
        rendered += 1;
    }
    assert!(rendered >= 16, "only {rendered} scenes");
}

/// The scene with every length multiplied by `scale`, then moved by `by`.
fn elsewhere(mut scene: Scene, scale: f64, by: Vec3d) -> Scene {
    let place = |p: Vec3d| p * scale + by;
    for named in &mut scene.cameras {
        (named.camera.eye, named.camera.look_at) = (place(named.camera.eye), place(named.camera.look_at));
    }
    for light in &mut scene.lights {
        if let LightKind::Point { position } = &mut light.kind {
            *position = place(*position);
        }
    }
    for (center, radius, _) in &mut scene.spheres {
        (*center, *radius) = (place(*center), *radius * scale);
    }
    for mesh in &mut scene.meshes {
        let map = Affine::scale(Vec3d::splat(scale)).then(Affine::translate(by));
        mesh.transform = mesh.transform.then(map);
    }
    scene
}

fn assert_alike(a: &Frame, b: &Frame, what: &str) {
    let differing =
        a.image.pixels.iter().zip(&b.image.pixels).filter(|(a, b)| (**a - **b).abs().max_component() > 0.02);
    let differing = differing.count();
    assert!(differing <= a.image.pixels.len() / 1000, "{what}: {differing} pixels differ");
    // Acne shows as shadow rays and reflections that hit their own surface.
    let (a, b) = (a.statistics, b.statistics);
    assert!(a.camera_hits.abs_diff(b.camera_hits) <= 2, "{what}: {a:?} {b:?}");
    assert!(a.reflected_rays.abs_diff(b.reflected_rays) <= a.reflected_rays / 100 + 4, "{what}: {a:?} {b:?}");
}

#[test]
fn pictures_do_not_depend_on_unit_or_origin() {
    let Some(folder) = hard() else { return };
    let (far, tiny, huge) = ("far_from_origin.nff", "tiny_units.nff", "huge_units.nff");
    for (file, scale, by) in [
        (far, 1.0, Vec3d::splat(-1e4)),
        (tiny, 1e6, Vec3d::ZERO),
        (huge, 1e-6, Vec3d::ZERO),
        (far, 1.0, Vec3d::splat(1e9)),
        (tiny, 1e-20, Vec3d::ZERO),
        (huge, 1e20, Vec3d::ZERO),
        (tiny, 1e6, Vec3d::splat(1e6)),
    ] {
        let scene = load(&folder.join(file));
        let found = best(&scene);
        assert_alike(&found, &best(&elsewhere(scene, scale, by)), &format!("{file} times {scale:e} plus {:e}", by.x));
    }
}

#[test]
fn walls_have_no_holes() {
    let Some(folder) = hard() else { return };
    let scene = load(&folder.join("axis_aligned_rays.nff"));
    for size in [[64, 64], [65, 65], [513, 513]] {
        let settings = Settings { size, ..scene.settings.clone() };
        let frame = picture(&scene, &settings, TreeKind::Best, Method::Wavefront);
        assert!(frame.first.iter().all(|first| first.depth.is_finite()), "{size:?}");
    }
}

#[test]
fn mirror_boxes_hold_every_ray() {
    let Some(folder) = hard() else { return };
    let scene = load(&folder.join("mirror_box.nff"));
    let settings = Settings { depth: 64, min_weight: 0.0, ..scene.settings.clone() };
    let frame = picture(&scene, &settings, TreeKind::Best, Method::Wavefront);
    let counts = frame.statistics;
    // Nothing escapes: every camera ray is reflected as often as the depth allows.
    assert_eq!(counts.reflected_rays, 64 * counts.camera_rays);
    assert_eq!(counts.cut_by_depth, counts.camera_rays);
}

#[test]
fn from_inside_glass_the_world_is_seen() {
    let Some(folder) = hard() else { return };
    let frame = best(&load(&folder.join("camera_inside_glass.nff")));
    // Straight through, 0.9 of the background (0.2, 0.4, 0.8) and what little the inside mirrors.
    let middle = frame.image.pixels[32 * 64 + 32];
    assert!((middle - Vec3f::new(0.2, 0.4, 0.8)).abs().max_component() < 0.03, "{middle:?}");
}

#[test]
fn nested_glass_is_bounded() {
    let Some(folder) = hard() else { return };
    let scene = load(&folder.join("glass_nested.nff"));
    let settings = Settings { depth: 40, min_weight: 0.0, size: [4, 4], ..scene.settings.clone() };
    let frame = picture(&scene, &settings, TreeKind::Best, Method::Wavefront);
    let rays = frame.statistics.reflected_rays + frame.statistics.refracted_rays;
    assert!(rays <= frame.statistics.camera_rays << 16, "{rays} rays");
    assert!(frame.statistics.cut_by_budget > 0);
}
