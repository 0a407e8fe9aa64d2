//! Generated scenes against the numbers of the programs that define them.

use whitted::math::Vec3d;
use whitted::scene::generate::{self, CLASSES, GenerateError, GeneratedSphere, PAPER_FILL, PaperFamily};

fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs().max(1.0)
}

/// First, second and last spheres and the sum of classes as a program in another language printed them.
#[test]
fn paper_cubes_are_those_of_the_peers() {
    let cube = |n: u32| generate::sphere_cube(n, n.into(), PAPER_FILL).expect("room");
    let check = |sphere: &GeneratedSphere, [x, y, z, radius]: [f64; 4], class: u32| {
        let found = sphere.center;
        assert!(near(found.x, x) && near(found.y, y) && near(found.z, z), "{sphere:?}");
        assert!(near(sphere.radius, radius) && sphere.class == class, "{sphere:?}");
    };
    let ten = cube(10);
    check(&ten[0], [0.37287254980396134, -0.5871135177399541, 0.5437559325098811, 0.20451192708381777], 10);
    check(&ten[1], [0.3675169369096659, 0.36400269104232497, 0.6051690364529111, 0.3605648321625027], 3);
    check(&ten[9], [-0.6535677187269238, -0.31543653335217237, 0.34146104360842977, 0.2751277443153472], 6);
    let thousand = cube(1000);
    check(&thousand[0], [0.5963864611672898, 0.5186865679423267, -0.36077242156516076, 0.05146063758271689], 8);
    check(&thousand[1], [-0.7828210467943503, 0.27651325308498453, 0.042356406733787266, 0.07360978068218964], 5);
    check(&thousand[999], [0.07673570692977982, -0.3063075356528566, -0.40318130404146224, 0.04787444456398777], 5);
    let many = cube(50_000);
    check(&many[0], [-0.0825020982531437, 0.831858966043152, 0.31667751530452326, 0.018580994760336055], 2);
    check(&many[49_999], [-0.22918717904488994, 0.4581126652712043, 0.5033739552202469, 0.01927833418177181], 7);
    for (spheres, classes) in [(ten, 56), (cube(100), 519), (thousand, 5640), (many, 274_792)] {
        assert_eq!(spheres.iter().map(|sphere| sphere.class).sum::<u32>(), classes);
    }
}

#[test]
fn cubes_have_no_overlaps() {
    for (count, seed, fill) in [(300, 1, 0.12), (300, 2, 0.25), (3, 5, 0.2), (1, 0, 0.3), (0, 0, 0.1)] {
        let spheres = generate::sphere_cube(count, seed, fill).expect("room");
        assert_eq!(spheres.len(), count as usize);
        for (i, a) in spheres.iter().enumerate() {
            assert!(a.class < CLASSES && a.radius > 0.0);
            for b in &spheres[..i] {
                assert!((a.center - b.center).length() > a.radius + b.radius, "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn impossible_scenes_are_refused() {
    for fill in [0.0, -1.0, 0.31, f64::NAN, f64::INFINITY] {
        assert!(matches!(generate::sphere_cube(10, 0, fill), Err(GenerateError::Fill(..))), "{fill}");
    }
    assert!(matches!(generate::sphere_cube(u32::MAX, 0, 0.1), Err(GenerateError::TooMany(_))));
    assert!(matches!(generate::grid(u32::MAX, 0.1), Err(GenerateError::TooMany(_))));
    assert!(matches!(generate::grid(3, 0.6), Err(GenerateError::Fill(..))));
    assert!(matches!(generate::sphereflake(8), Err(GenerateError::TooMany(_))));
    assert!(matches!(generate::sphereflake(u32::MAX), Err(GenerateError::TooMany(_))));
    // Cells are bounded however small the spheres.
    assert_eq!(generate::sphere_cube(10, 0, 1e-300).map(|spheres| spheres.len()), Ok(10));
    // The first of these two spheres leaves no place for the other.
    let full = GenerateError::Full { placed: 1, count: 2 };
    assert_eq!(generate::sphere_cube(2, 0, 0.3), Err(full));
}

#[test]
fn sphereflake_is_haines_balls() {
    let flake = generate::sphereflake(4).expect("small");
    assert_eq!(flake.len(), 7381);
    let Some(shared) = std::env::var_os("WHITTED_SHARED") else {
        eprintln!("SKIPPED: WHITTED_SHARED is not set, so balls.nff was not compared");
        return;
    };
    let path = std::path::Path::new(&shared).join("material/spd/balls.nff");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let numbers = |line: &str| line.split(' ').map(|n| n.parse::<f64>().expect("a number")).collect::<Vec<_>>();
    let balls: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("s ")).map(numbers).collect();
    assert_eq!(balls.len(), flake.len());
    for (ball, sphere) in balls.iter().zip(&flake) {
        // The file has z up and six digits.
        let center = Vec3d::new(sphere.center.x, -sphere.center.z, sphere.center.y);
        let distance = (center - Vec3d::new(ball[0], ball[1], ball[2])).length();
        assert!(distance < 2e-6 && (sphere.radius - ball[3]).abs() < 1e-6, "{sphere:?} {ball:?}");
    }
}

#[test]
fn grids_fill_the_cube_evenly() {
    let spheres = generate::grid(4, 0.12).expect("room");
    let volume: f64 = spheres.iter().map(|s| 4.0 / 3.0 * std::f64::consts::PI * s.radius * s.radius * s.radius).sum();
    assert!(spheres.len() == 64 && near(volume / 8.0, 0.12), "{volume}");
    assert_eq!((spheres[0].center, spheres[63].center), (Vec3d::splat(-0.75), Vec3d::splat(0.75)));
    assert!(generate::grid(0, 0.1).expect("empty").is_empty());
}

#[test]
fn paper_scenes_are_complete() {
    for family in [PaperFamily::Mix, PaperFamily::All4] {
        let scene = generate::paper_scene(family, 100).expect("room");
        assert_eq!((scene.spheres.len(), scene.materials.len(), scene.lights.len()), (100, 12, 2));
        assert!(scene.materials.iter().all(|named| named.material.fault().is_none()));
        assert!(scene.lights.iter().all(|light| light.fault().is_none()));
        assert_eq!(scene.cameras[0].camera.fault(), None);
    }
}
