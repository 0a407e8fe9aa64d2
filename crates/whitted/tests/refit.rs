//! Trees that are fitted to moved primitives find the hits of brute force, to the bit.

mod common;

use whitted::geometry::{Primitives, Sphere};
use whitted::math::{SplitMix64, Vec3, Vec3f};
use whitted::ray::{HitBatch, RayBatch};
use whitted::tree::{Query, RefitError, Scratch, Tree, TreeKind, WalkKind};

fn bits(tree: &Tree, primitives: &Primitives, rays: &RayBatch) -> Vec<(u32, u32)> {
    let query = Query { tree, primitives, level: simd::Level::best(), walk: WalkKind::Auto };
    let mut hits = HitBatch::default();
    query.closest_hit(rays, &mut hits, &mut Scratch::default());
    (0..hits.len()).map(|i| (hits.t[i].to_bits(), hits.primitive[i])).collect()
}

/// Ways to move a point; equal points stay equal, so that what is degenerate stays so.
const MOVES: [fn(Vec3f) -> Vec3f; 5] = [
    |p| p,
    |p| Vec3::new(p.x + 0.3 * p.y, p.y - 0.2 * p.z * p.z, p.z + 0.5),
    |p| p * 3e5,
    |p| p * 1e-7,
    |p| Vec3::new(p.x, p.y, 0.0),
];

#[test]
fn moved_primitives_are_hit_where_they_are() {
    let mut hits = 0;
    for seed in 0..150 {
        let mut rng = SplitMix64::new(seed);
        let count = 1 + rng.below(300);
        let mut primitives = common::scene(&mut rng, count);
        let mut tree = Tree::build(&primitives, &TreeKind::Fast.into());
        for step in 0..3 {
            let step = MOVES[(seed as usize + step) % MOVES.len()];
            primitives.vertices_mut().iter_mut().for_each(|p| *p = step((*p).into()).to_array());
            primitives.spheres_mut().iter_mut().for_each(|s| s.center = step(s.center));
            tree.refit(&primitives).unwrap_or_else(|error| panic!("scene {seed}: {error}"));
            tree.validate(&primitives).unwrap_or_else(|error| panic!("scene {seed}: {error}"));
            let rays: Vec<_> = (0..200).map(|_| common::ray(&mut rng, &primitives)).collect();
            let rays: RayBatch = rays.iter().collect();
            let oracle = Tree::build(&primitives, &TreeKind::None.into());
            let expected = bits(&oracle, &primitives, &rays);
            assert_eq!(bits(&tree, &primitives, &rays), expected, "scene {seed}");
            hits += expected.iter().filter(|hit| hit.1 != u32::MAX).count();
        }
    }
    assert!(hits > 10_000, "{hits} hits");
}

fn quads(n: u32) -> Primitives {
    let mut primitives = Primitives::new();
    let vertices: Vec<Vec3f> = (0..n)
        .flat_map(|i| [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Vec3::new(x + 2.0 * i as f32, y, 0.0)))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    primitives.push_mesh(&vertices, &triangles, &[], &[]).expect("a sound mesh");
    primitives
}

#[test]
fn what_vanishes_may_come_back() {
    let mut primitives = quads(100);
    let mut tree = Tree::build(&primitives, &TreeKind::Fast.into());
    let whole = primitives.vertices_mut().to_vec();
    let ray = |i: u32| whitted::ray::Ray::new(Vec3::new(2.0 * i as f32 + 0.25, 0.25, 1.0), Vec3::new(0.0, 0.0, -1.0));
    let rays: RayBatch = (0..100).map(ray).collect::<Vec<_>>().iter().collect();
    let found = |tree: &Tree, primitives: &Primitives| {
        bits(tree, primitives, &rays).iter().filter(|hit| hit.1 != u32::MAX).count()
    };
    assert_eq!(found(&tree, &primitives), 100);
    for gone in [0..150, 0..300] {
        primitives.vertices_mut()[gone.clone()].fill([f32::NAN; 3]);
        tree.refit(&primitives).expect("fast trees can be fitted");
        tree.validate(&primitives).expect("sound");
        assert_eq!(found(&tree, &primitives), 100 - gone.len() / 3);
        primitives.vertices_mut().copy_from_slice(&whole);
        tree.refit(&primitives).expect("fast trees can be fitted");
        assert_eq!(found(&tree, &primitives), 100);
    }
}

#[test]
fn what_cannot_be_fitted_is_told_and_left() {
    let mut primitives = quads(10);
    for kind in [TreeKind::Kd, TreeKind::Best] {
        let mut tree = Tree::build(&primitives, &kind.into());
        assert_eq!(tree.refit(&primitives), Err(RefitError::Kind { kind }));
    }
    let vertex = primitives.vertices_mut()[4];
    primitives.vertices_mut()[4] = primitives.vertices_mut()[3];
    let mut tree = Tree::build(&primitives, &TreeKind::Fast.into());
    primitives.vertices_mut()[4] = vertex;
    assert_eq!(tree.refit(&primitives), Err(RefitError::Missing { primitive: 1 }));
    primitives.push_sphere(Sphere { center: Vec3f::ZERO, radius: 1.0 });
    assert_eq!(tree.refit(&primitives), Err(RefitError::Count { expected: 10, found: 11 }));
    Tree::build(&primitives, &TreeKind::None.into()).refit(&primitives).expect("nothing to fit");
}
