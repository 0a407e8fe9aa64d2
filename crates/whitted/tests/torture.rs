//! Inputs that break builders: references, depth and memory stay bounded and the hits right.

mod common;

use whitted::geometry::{Primitives, Sphere};
use whitted::math::{SplitMix64, Vec3, Vec3f};
use whitted::ray::{HitBatch, RayBatch};
use whitted::tree::{Query, Scratch, Tree, TreeKind, WalkKind};

/// A name and a scene of a given size.
type Case = (&'static str, fn(u32) -> Primitives);

fn triangles(corners: impl IntoIterator<Item = [Vec3f; 3]>) -> Primitives {
    let positions: Vec<Vec3f> = corners.into_iter().flatten().collect();
    let indices: Vec<[u32; 3]> = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut primitives = Primitives::new();
    primitives.push_mesh(&positions, &indices, &[], &[]).expect("a sound mesh");
    primitives
}

fn same_triangle(n: u32) -> Primitives {
    let corners = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.5)];
    triangles((0..n).map(|_| corners))
}

fn same_sphere(n: u32) -> Primitives {
    let mut primitives = Primitives::new();
    (0..n).for_each(|_| primitives.push_sphere(Sphere { center: Vec3::new(1.0, 2.0, 3.0), radius: 0.5 }));
    primitives
}

fn concentric_spheres(n: u32) -> Primitives {
    let mut primitives = Primitives::new();
    (1..=n).for_each(|i| primitives.push_sphere(Sphere { center: Vec3f::ZERO, radius: i as f32 }));
    primitives
}

/// A large sphere and small ones on it: to cut the large one seems cheap.
fn strewn_ball(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(17);
    let mut primitives = Primitives::new();
    primitives.push_sphere(Sphere { center: Vec3f::ZERO, radius: 1.0 });
    for _ in 0..n {
        let center = common::point(&mut rng, 1.0).normalize();
        primitives.push_sphere(Sphere { center, radius: 0.02 });
    }
    primitives
}

/// Every triangle spans the whole box.
fn long_diagonals(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(7);
    let mut corner = |x: f32| Vec3::new(x, rng.uniform(-1.0, 1.0) as f32, rng.uniform(-1.0, 1.0) as f32);
    triangles((0..n).map(|_| {
        let [a, b] = [corner(-1.0), corner(1.0)];
        [a, b, b + Vec3::new(0.0, 1e-3, 0.0)]
    }))
}

/// All triangles meet in one point.
fn fan(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(8);
    triangles((0..n).map(|_| {
        let p = common::point(&mut rng, 1.0);
        [Vec3f::ZERO, p, p + Vec3::new(1e-3, 0.0, 1e-3)]
    }))
}

/// A flat mesh exactly in z = 0.
fn flat(n: u32) -> Primitives {
    let side = (n as f32).sqrt() as u32;
    let at = |x: u32, y: u32| Vec3::new(x as f32, y as f32, 0.0);
    triangles((0..side * side).map(|i| {
        let (x, y) = (i % side, i / side);
        [at(x, y), at(x + 1, y), at(x, y + 1)]
    }))
}

/// A giant floor and tiny things whose sizes fall by halves.
fn teapot_in_stadium(n: u32) -> Primitives {
    let floor = [Vec3::new(-1e6, 0.0, -1e6), Vec3::new(1e6, 0.0, -1e6), Vec3::new(0.0, 0.0, 1e6)];
    let tiny = (1..n).map(|i| {
        let size = 0.5f32.powi((i % 120) as i32);
        let at = Vec3::new(size, size * 0.5, size * (i / 120) as f32);
        [at, at + Vec3::new(size, 0.0, 0.0), at + Vec3::new(0.0, size, 0.0)]
    });
    triangles(std::iter::once(floor).chain(tiny))
}

/// Coordinates that fall geometrically: every split takes off one primitive.
fn geometric_chain(n: u32) -> Primitives {
    triangles((0..n).map(|i| {
        let x = 0.8f32.powi((i % 400) as i32);
        [Vec3::new(x, 0.0, 0.0), Vec3::new(x, x, 0.0), Vec3::new(x * 0.99, 0.0, x)]
    }))
}

/// Points on one line, and so every triangle.
fn collinear(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(9);
    let mut at = || Vec3::new(1.0, 2.0, -3.0) * rng.uniform(-1.0, 1.0) as f32;
    triangles((0..n).map(|_| [at(), at(), at()]))
}

/// Needles a million times longer than wide, in all directions.
fn needles(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(10);
    triangles((0..n).map(|_| {
        let [a, b] = [common::point(&mut rng, 1.0), common::point(&mut rng, 1.0)];
        [a, b, b + Vec3::new(0.0, 1e-6, 1e-6)]
    }))
}

/// Triangles of all sizes and directions around the same point.
fn one_center(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(11);
    triangles((0..n).map(|_| {
        let p = common::point(&mut rng, 1.0);
        [p, -p, Vec3::new(p.y, p.z, p.x) * 0.25]
    }))
}

/// Every other corner is not a number or infinite.
fn broken_corners(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(12);
    triangles((0..n).map(|i| {
        let p = common::point(&mut rng, 1.0);
        let q = match i % 4 {
            0 => Vec3::new(f32::NAN, 0.0, 0.0),
            1 => Vec3::new(0.0, f32::INFINITY, 0.0),
            _ => p + Vec3::new(0.1, 0.0, 0.05),
        };
        [p, q, p + Vec3::new(0.0, 0.1, 0.0)]
    }))
}

/// Coordinates near the smallest and the largest that there are.
fn extreme_coordinates(n: u32) -> Primitives {
    let mut rng = SplitMix64::new(13);
    triangles((0..n).map(|i| {
        let size = if i % 2 == 0 { 1e-40 } else { 1e37 };
        let p = common::point(&mut rng, 1.0) * size;
        [p, p + Vec3::new(size, 0.0, 0.0), p + Vec3::new(0.0, size, size)]
    }))
}

#[test]
fn a_million_equal_centers_are_built_in_bounded_time() {
    let primitives = one_center(1_000_000);
    for kind in [TreeKind::Fast, TreeKind::Best] {
        let report = Tree::build(&primitives, &kind.into()).report();
        println!("{kind:?}: {report:?}");
        assert!(report.references <= 1_500_016 && report.depth <= 64, "{kind:?}: {report:?}");
    }
}

#[test]
fn spheres_by_themselves_are_not_cut() {
    let references = |primitives: &Primitives| Tree::build(primitives, &TreeKind::Best.into()).report().references;
    assert_eq!(references(&strewn_ball(2000)), 2001);
    let mut mixed = long_diagonals(2000);
    mixed.push_sphere(Sphere { center: Vec3f::ZERO, radius: 1.0 });
    assert!(references(&mixed) > 2001, "groups with triangles are");
}

#[test]
fn builds_are_bounded_and_right() {
    let scenes: [Case; 13] = [
        ("collinear", collinear),
        ("needles", needles),
        ("one centre", one_center),
        ("broken corners", broken_corners),
        ("extreme coordinates", extreme_coordinates),
        ("same triangle", same_triangle),
        ("same sphere", same_sphere),
        ("concentric spheres", concentric_spheres),
        ("long diagonals", long_diagonals),
        ("fan", fan),
        ("flat", flat),
        ("teapot in a stadium", teapot_in_stadium),
        ("geometric chain", geometric_chain),
    ];
    let count = 10_000;
    for (name, scene) in scenes {
        let primitives = scene(count);
        let mut rng = SplitMix64::new(1);
        let rays: Vec<_> = (0..40).map(|_| common::ray(&mut rng, &primitives)).collect();
        let expected = hits(&primitives, TreeKind::None, WalkKind::Auto, &rays.iter().collect());
        for kind in [TreeKind::Kd, TreeKind::Fast, TreeKind::Best] {
            let tree = Tree::build(&primitives, &kind.into());
            let report = tree.report();
            println!("{name}, {kind:?}: {report:?}");
            tree.validate(&primitives).unwrap_or_else(|error| panic!("{name}, {kind:?}: {error}"));
            assert!(report.references <= 6 * count as usize + 64, "{name}, {kind:?}: {report:?}");
            assert!(report.depth <= 64, "{name}, {kind:?}: {report:?}");
            for walk in [WalkKind::Stream, WalkKind::Single] {
                let found = hits(&primitives, kind, walk, &rays.iter().collect());
                assert_eq!(found, expected, "{name}, {kind:?}, {walk:?}");
            }
        }
    }
}

fn hits(primitives: &Primitives, kind: TreeKind, walk: WalkKind, rays: &RayBatch) -> Vec<(u32, u32)> {
    let tree = Tree::build(primitives, &kind.into());
    let query = Query { tree: &tree, primitives, level: simd::Level::best(), walk };
    let mut hits = HitBatch::default();
    query.closest_hit(rays, &mut hits, &mut Scratch::default());
    hits.t.iter().map(|t| t.to_bits()).zip(hits.primitive).collect()
}
