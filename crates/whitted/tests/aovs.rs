//! Pictures of something other than light: what they show, and that they depend on scene and settings only.

mod random_scene;

use random_scene::random_scene;
use whitted::math::Vec3d;
use whitted::render::{Aov, AovPicture, Cancel, Execution, Frame, Method, Region, Silent, aovs, render};
use whitted::scene::{Antialias, Camera, NamedCamera, NamedMaterial, Prepared, Scene, Settings};
use whitted::shading::Material;
use whitted::tree::{BuildOptions, TreeKind, WalkKind};

/// Those that depend on scene and settings only.
const EXACT: [Aov; 6] = [Aov::Normal, Aov::Depth, Aov::Id, Aov::Primitive, Aov::Importance, Aov::Supersampled];

fn no_clock() -> u64 {
    panic!("the clock is asked for times only")
}

fn pictures(wanted: &[Aov], prepared: &Prepared, settings: &Settings, execution: &Execution) -> Vec<AovPicture> {
    let frame = frame(prepared, settings, execution);
    aovs(wanted, &frame, prepared, settings, execution, &no_clock, &Cancel::new()).expect("not cancelled")
}

fn frame(prepared: &Prepared, settings: &Settings, execution: &Execution) -> Frame {
    render(prepared, settings, execution, &Silent, &Cancel::new()).expect("not cancelled")
}

fn prepare(scene: &Scene, kind: TreeKind) -> Prepared {
    Prepared::new(scene, &BuildOptions { kind, ..BuildOptions::default() }).expect("a valid scene")
}

/// A sphere of radius 1 at the origin, seen from (0, 0, 5), before a smaller one that it hides from most pixels.
fn two_spheres() -> Scene {
    let camera = Camera { eye: Vec3d::new(0.0, 0.0, 5.0), look_at: Vec3d::ZERO, ..Camera::default() };
    Scene {
        cameras: vec![NamedCamera { name: "front".into(), camera }],
        materials: vec![NamedMaterial { name: "matte".into(), material: Material::default() }],
        spheres: vec![(Vec3d::ZERO, 1.0, 0), (Vec3d::new(1.5, 0.0, -5.0), 1.0, 0)],
        settings: Settings { size: [33, 33], antialias: Antialias::Off, ..Settings::default() },
        ..Scene::default()
    }
}

fn pixel(picture: &AovPicture, x: usize, y: usize) -> [u8; 3] {
    let at = 3 * (y * picture.width as usize + x);
    picture.rgb8[at..at + 3].try_into().expect("three bytes")
}

#[test]
fn all_but_costs_depend_on_scene_and_settings_only() {
    for seed in 0..12 {
        let settings = Settings { size: [41, 37], antialias_max: 3, ..Settings::default() };
        let scene = random_scene(seed);
        let way = |level, walk, method| Execution { level, walk, method, ..Execution::default() };
        let first = way(simd::Level::Scalar(simd::Scalar), WalkKind::Single, Method::Recursive);
        let expected = pictures(&EXACT, &prepare(&scene, TreeKind::Fast), &settings, &first);
        let prepared = prepare(&scene, TreeKind::Best);
        for level in simd::Level::available() {
            let way = way(level, WalkKind::Auto, Method::Wavefront);
            let other = Execution { region: Region::Rectangle(16, 16), ..way };
            assert_eq!(pictures(&EXACT, &prepared, &settings, &other), expected, "scene {seed}, {}", level.name());
        }
    }
}

#[test]
fn what_a_sphere_shows() {
    let scene = two_spheres();
    let prepared = prepare(&scene, TreeKind::Best);
    let found = pictures(&EXACT, &prepared, &scene.settings, &Execution::default());
    let [normal, depth, id, primitive, importance, supersampled] = &found[..] else { panic!("six pictures") };
    assert_eq!(pixel(normal, 16, 16), [128, 128, 255], "the normal points to the viewer");
    assert_eq!((pixel(normal, 0, 0), pixel(depth, 0, 0), pixel(id, 0, 0)), ([0; 3], [0; 3], [0; 3]));
    assert_eq!(pixel(depth, 16, 16), [255; 3], "the nearest point");
    let range = depth.legend.expect("something was hit");
    assert!((range.first - 4.0).abs() < 1e-6 && (9.0..11.0).contains(&range.last), "{range:?}");
    assert_eq!(id.rgb8, primitive.rgb8, "an object has one primitive");
    let mut colors: Vec<&[u8]> = id.rgb8.chunks(3).collect();
    colors.sort_unstable();
    colors.dedup();
    assert_eq!(colors.len(), 3, "nothing and two spheres");
    assert!(importance.rgb8.iter().chain(&supersampled.rgb8).all(|&byte| byte == 0));
}

#[test]
fn masks_are_those_of_the_frame() {
    let settings = Settings { size: [41, 37], min_weight: 0.3, ..Settings::default() };
    let mut white = [0; 2];
    for seed in 0..8 {
        let prepared = prepare(&random_scene(seed), TreeKind::Best);
        let frame = frame(&prepared, &settings, &Execution::default());
        let masks = [Aov::Importance, Aov::Supersampled];
        let found = pictures(&masks, &prepared, &settings, &Execution::default());
        for (index, first) in frame.first.iter().enumerate() {
            for (picture, is_white) in found.iter().zip([first.cut, frame.supersampled[index]]) {
                assert_eq!(picture.rgb8[3 * index], if is_white { 255 } else { 0 });
            }
            white[0] += usize::from(first.cut);
            white[1] += usize::from(frame.supersampled[index]);
        }
    }
    assert!(white[0] > 0 && white[1] > 0, "{white:?}");
}

/// Amounts from colours: the place of each colour on the scale.
fn amounts(picture: &AovPicture) -> Vec<usize> {
    let scale: Vec<[u8; 3]> = (0..=255).map(|i| whitted::render::heat(i as f32 / 255.0)).collect();
    let distance = |a: &[u8], b: &[u8; 3]| (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum::<u32>();
    let nearest = |color: &[u8]| (0..scale.len()).min_by_key(|&i| distance(color, &scale[i])).expect("a scale");
    picture.rgb8.chunks(3).map(nearest).collect()
}

#[test]
fn costs_are_where_the_work_is() {
    let scene = two_spheres();
    let prepared = prepare(&scene, TreeKind::Best);
    let wanted = [Aov::Nodes, Aov::Tests];
    let found = pictures(&wanted, &prepared, &scene.settings, &Execution::default());
    for level in simd::Level::available() {
        let execution = Execution { level, ..Execution::default() };
        assert_eq!(pictures(&wanted, &prepared, &scene.settings, &execution), found, "{}", level.name());
    }
    let tests = amounts(&found[1]);
    assert!(tests[16 * 33 + 16] > 0, "the sphere must be tested to be seen");
    assert_eq!(tests[0], 0, "the corner sees no box");
    assert!(found.iter().all(|picture| picture.legend.expect("amounts").last >= 1.0));
}

#[test]
fn supersampled_pixels_cost_all_their_samples() {
    let mut scene = two_spheres();
    let cost = |scene: &Scene| {
        let prepared = prepare(scene, TreeKind::None);
        pictures(&[Aov::Tests], &prepared, &scene.settings, &Execution::default())[0].legend.expect("amounts").last
    };
    let once = cost(&scene);
    scene.settings.antialias = Antialias::Uniform(7);
    assert_eq!(cost(&scene), 7.0 * once);
}

#[test]
fn times_are_the_least_of_several() {
    let scene = two_spheres();
    let prepared = prepare(&scene, TreeKind::Best);
    let execution = Execution { region: Region::Frame, ..Execution::default() };
    let frame = frame(&prepared, &scene.settings, &execution);
    let ticks = std::sync::atomic::AtomicU64::new(0);
    // Every second of the questions comes after a longer time: 1, 3, 5, … and starts over for each pixel.
    let clock = || {
        let count = ticks.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        count * 10 + if count % 6 == 1 { 5 } else { 0 }
    };
    let found = aovs(&[Aov::Time], &frame, &prepared, &scene.settings, &execution, &clock, &Cancel::new());
    let found = found.expect("not cancelled");
    assert_eq!(found[0].legend.expect("times").last, 10.0);
    assert!(found[0].to_string().ends_with(", 0 (dark) to 10 and more (bright)"), "{}", found[0]);
}

#[test]
fn a_cancelled_pass_stops() {
    let scene = two_spheres();
    let prepared = prepare(&scene, TreeKind::Best);
    let frame = frame(&prepared, &scene.settings, &Execution::default());
    let cancel = Cancel::new();
    cancel.cancel();
    for aov in [Aov::Primitive, Aov::Nodes] {
        let execution = Execution::default();
        assert!(aovs(&[aov], &frame, &prepared, &scene.settings, &execution, &no_clock, &cancel).is_err());
    }
}
