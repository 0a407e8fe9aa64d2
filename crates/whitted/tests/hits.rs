//! Every tree, walk and instruction set finds the hits of brute force, to the bit.

mod common;

use whitted::geometry::{Primitives, Sphere};
use whitted::math::{SplitMix64, Vec3f};
use whitted::ray::{HitBatch, NONE, Ray, RayBatch};
use whitted::tree::{Occlusion, Query, Scratch, Tree, TreeKind, WalkKind};

/// Walks of each ray: three trees, three walks of batches and each ray by itself, four instruction sets.
const WALKS: u64 = 3 * 4 * 4;

/// Ray walks in all; `WHITTED_RAYS` asks for more.
fn rays_in_all() -> u64 {
    std::env::var("WHITTED_RAYS").map_or(1_000_000 * WALKS, |n| n.parse().expect("WHITTED_RAYS is a whole number"))
}

fn bits(hits: &HitBatch) -> Vec<(u32, u32, u32, u32)> {
    (0..hits.len())
        .map(|i| (hits.t[i].to_bits(), hits.u[i].to_bits(), hits.v[i].to_bits(), hits.primitive[i]))
        .collect()
}

/// Compare one scene; returns the number of hits.
fn compare(primitives: &Primitives, rays: &RayBatch, seed: u64) -> usize {
    let mut scratch = Scratch::default();
    let none = Tree::build(primitives, &TreeKind::None.into());
    let level = simd::Level::best();
    let oracle = Query { tree: &none, primitives, level, walk: WalkKind::Auto };
    let (mut expected, mut found) = (HitBatch::default(), HitBatch::default());
    let (mut expected_any, mut any) = (Vec::new(), Vec::new());
    oracle.closest_hit(rays, &mut expected, &mut scratch);
    oracle.occluded(rays, None, &mut expected_any, &mut scratch);
    for (ray, any) in expected.primitive.iter().zip(&expected_any) {
        assert_eq!(*ray != u32::MAX, *any == Occlusion::Blocked, "scene {seed}: any hit = closest hit");
    }
    for kind in [TreeKind::Kd, TreeKind::Fast, TreeKind::Best] {
        let tree = Tree::build(primitives, &kind.into());
        tree.validate(primitives).unwrap_or_else(|error| panic!("scene {seed}, {kind:?}: {error}"));
        for walk in [WalkKind::Auto, WalkKind::Stream, WalkKind::Single] {
            for level in simd::Level::available() {
                let query = Query { tree: &tree, primitives, level, walk };
                query.closest_hit(rays, &mut found, &mut scratch);
                if bits(&found) != bits(&expected) {
                    let i = (0..rays.len()).find(|&i| found.get(i) != expected.get(i)).expect("a difference");
                    panic!(
                        "scene {seed}, {kind:?}, {walk:?}, {level:?}, ray {i} {:?}: {:?}, brute force {:?}",
                        rays.get(i),
                        found.get(i),
                        expected.get(i)
                    );
                }
                query.occluded(rays, None, &mut any, &mut scratch);
                assert_eq!(any, expected_any, "scene {seed}, {kind:?}, {walk:?}, {level:?}");
            }
        }
        for level in simd::Level::available() {
            let query = Query { tree: &tree, primitives, level, walk: WalkKind::Auto };
            compare_one_by_one(&query, rays, &expected, &expected_any, seed);
        }
    }
    (0..rays.len()).filter(|&i| expected.get(i).is_hit()).count()
}

/// A ray that comes alone has a kernel of its own.
fn compare_one_by_one(query: &Query<'_>, rays: &RayBatch, expected: &HitBatch, expected_any: &[Occlusion], seed: u64) {
    let (mut scratch, mut found, mut any) = (Scratch::default(), HitBatch::default(), Vec::new());
    for (i, expected) in bits(expected).into_iter().enumerate() {
        let (ray, place) = (rays.get(i), format_args!("scene {seed}, {:?}, {:?}", query.tree.kind(), query.level));
        query.closest_hit(&ray, &mut found, &mut scratch);
        assert_eq!(bits(&found), [expected], "{place}, ray {i} by itself: {ray:?}");
        query.occluded(&ray, None, &mut any, &mut scratch);
        assert_eq!(any, [expected_any[i]], "{place}, shadow ray {i} by itself: {ray:?}");
    }
}

/// All hits of a ray in order, by asking for the next one again and again.
fn all_hits(query: &Query<'_>, rays: &RayBatch) -> Vec<Vec<(u32, u32)>> {
    let mut after = vec![(f32::NEG_INFINITY, 0); rays.len()];
    let mut lists = vec![Vec::new(); rays.len()];
    let (mut hits, mut scratch) = (HitBatch::default(), Scratch::default());
    loop {
        query.next_hit(rays, &mut after, &mut hits, &mut scratch);
        for (list, after) in lists.iter_mut().zip(&after).filter(|(_, after)| after.0 < f32::INFINITY) {
            list.push((after.0.to_bits(), after.1));
        }
        if after.iter().all(|after| after.0 == f32::INFINITY) {
            return lists;
        }
    }
}

#[test]
fn all_hits_come_once_and_in_order() {
    for seed in 0..20 {
        let mut rng = SplitMix64::new(1000 + seed);
        let primitives = common::scene(&mut rng, 60);
        let rays: RayBatch = (0..200).map(|_| common::ray(&mut rng, &primitives)).collect::<Vec<_>>().iter().collect();
        let trees = [TreeKind::None, TreeKind::Kd, TreeKind::Best].map(|kind| Tree::build(&primitives, &kind.into()));
        let query = |tree, walk| Query { tree, primitives: &primitives, level: simd::Level::best(), walk };
        let expected = all_hits(&query(&trees[0], WalkKind::Auto), &rays);
        let key = |&(t, id): &(u32, u32)| (f32::from_bits(t), id);
        assert!(expected.iter().all(|list| list.windows(2).all(|w| key(&w[0]) < key(&w[1]))), "scene {seed}: order");
        assert!(expected.iter().map(Vec::len).max() > Some(3), "scene {seed}: rays should hit more than once");
        for (tree, walk) in
            [(&trees[1], WalkKind::Stream), (&trees[2], WalkKind::Stream), (&trees[2], WalkKind::Single)]
        {
            assert_eq!(all_hits(&query(tree, walk), &rays), expected, "scene {seed}, {:?}, {walk:?}", tree.kind());
        }
    }
}

/// Small triangles and spheres all over a cube, so that lists of rays soon become short.
fn strewn(rng: &mut SplitMix64) -> Primitives {
    let mut primitives = Primitives::new();
    let mut point = |size: f64| Vec3f::from([(); 3].map(|()| rng.uniform(-size, size) as f32));
    let corners = |at: Vec3f, b: Vec3f, c: Vec3f| [at, at + b, at + c];
    let vertices: Vec<_> = (0..6000).flat_map(|_| corners(point(1.0), point(0.05), point(0.05))).collect();
    let triangles: Vec<_> = (0..6000).map(|number| [3 * number, 3 * number + 1, 3 * number + 2]).collect();
    primitives.push_mesh(&vertices, &triangles, &[], &[]).expect("a sound mesh");
    for _ in 0..6000 {
        primitives.push_sphere(Sphere { center: point(1.0), radius: point(0.02).x.abs() });
    }
    primitives
}

/// Rays from one point into fine detail: packets begin large and are halved, each half with what waits for it.
#[test]
fn packets_that_are_halved_find_what_lists_find() {
    let mut rng = SplitMix64::new(4);
    let primitives = strewn(&mut rng);
    // Four tiles of 8 by 8 into the scene, then eight away from it, which let packets grow again.
    let rays: RayBatch = (0..3 * 96 * 64)
        .map(|i| {
            let (tile, place) = (i / 64 / 12 * 4 + i / 64 % 4, i % 64);
            let (x, y) = (tile % 12 * 8 + place % 8, tile / 12 * 8 + place / 8);
            let into = [x as f32 / 40.0, y as f32 / 30.0, 3.0];
            let mut ray = Ray::new([-1.5, -1.4, -3.0], if i / 64 % 12 < 4 { into } else { [0.1, -3.0, 0.2] });
            ray.t_max = rng.uniform(0.5, 3.0) as f32;
            ray
        })
        .collect::<Vec<_>>()
        .iter()
        .collect();
    let tree = Tree::build(&primitives, &TreeKind::Best.into());
    let mut scratch = Scratch::default();
    let (mut expected, mut expected_any) = (HitBatch::default(), Vec::new());
    let query = |level, walk| Query { tree: &tree, primitives: &primitives, level, walk };
    let stream = query(simd::Level::best(), WalkKind::Stream);
    let in_lists = stream.closest_hit(&rays, &mut expected, &mut scratch);
    stream.occluded(&rays, None, &mut expected_any, &mut scratch);
    for level in simd::Level::available() {
        let (mut found, mut any) = (HitBatch::default(), Vec::new());
        let auto = query(level, WalkKind::Auto);
        let counts = auto.closest_hit(&rays, &mut found, &mut scratch);
        assert_eq!(bits(&found), bits(&expected), "{level:?}");
        assert!(20 * counts.lists < in_lists.lists, "few need lists: {counts:?}, else {in_lists:?}");
        auto.occluded(&rays, None, &mut any, &mut scratch);
        assert_eq!(any, expected_any, "{level:?}");
    }
    let hits = expected.primitive.iter().filter(|&&id| id != NONE).count();
    assert!((rays.len() / 12..rays.len() / 3).contains(&hits), "some rays hit: {hits} of {}", rays.len());
}

/// A batch so large that the rest of it is put in order when its first chunk had much to do.
#[test]
fn rays_that_were_put_in_order_find_what_they_find_in_theirs() {
    let mut rng = SplitMix64::new(3);
    let primitives = strewn(&mut rng);
    let mut component = |size: f64| rng.uniform(-size, size) as f32;
    let rays: RayBatch = (0..100_003)
        .map(|_| {
            let mut ray = Ray::new([(); 3].map(|()| component(1.2)), [(); 3].map(|()| component(1.0)));
            (ray.t_min, ray.t_max) = (component(0.1), 1.0 + component(1.0));
            ray
        })
        .collect::<Vec<_>>()
        .iter()
        .collect();
    let none = Tree::build(&primitives, &TreeKind::None.into());
    let tree = Tree::build(&primitives, &TreeKind::Best.into());
    let mut scratch = Scratch::default();
    let (mut expected, mut expected_any) = (HitBatch::default(), Vec::new());
    let query = |tree, level, walk| Query { tree, primitives: &primitives, level, walk };
    let best = simd::Level::best();
    let stream = query(&tree, best, WalkKind::Stream);
    let in_turn = stream.closest_hit(&rays, &mut expected, &mut scratch);
    let in_turn_any = stream.occluded(&rays, None, &mut expected_any, &mut scratch);
    for level in simd::Level::available() {
        let (mut found, mut any) = (HitBatch::default(), Vec::new());
        let auto = query(&tree, level, WalkKind::Auto);
        let counts = auto.closest_hit(&rays, &mut found, &mut scratch);
        assert_eq!(bits(&found), bits(&expected), "{level:?}");
        assert!(10 * counts.lists < 9 * in_turn.lists, "rays are put in order: {counts:?}, else {in_turn:?}");
        let counts = auto.occluded(&rays, None, &mut any, &mut scratch);
        assert_eq!(any, expected_any, "{level:?}");
        assert!(10 * counts.lists < 9 * in_turn_any.lists, "rays are put in order: {counts:?}, else {in_turn_any:?}");
    }
    let some: RayBatch = (0..rays.len()).step_by(101).map(|i| rays.get(i)).collect::<Vec<_>>().iter().collect();
    let mut brute = HitBatch::default();
    query(&none, best, WalkKind::Auto).closest_hit(&some, &mut brute, &mut scratch);
    let expected: Vec<_> = bits(&expected).into_iter().step_by(101).collect();
    assert_eq!(expected, bits(&brute));
    let hits = brute.primitive.iter().filter(|&&id| id != NONE).count();
    assert!((brute.len() / 6..brute.len()).contains(&hits), "some rays hit: {hits} of {}", brute.len());
}

#[test]
fn every_walk_finds_the_hits_of_brute_force() {
    let per_scene = 1000;
    let mut hits = 0;
    let scenes = rays_in_all() / per_scene / WALKS + 1;
    for seed in 0..scenes {
        let mut rng = SplitMix64::new(seed);
        let count = 1 + rng.below(if seed % 4 == 0 { 256 } else { 40 });
        let primitives = common::scene(&mut rng, count);
        let rays: Vec<_> = if seed % 2 == 0 {
            (0..per_scene).map(|_| common::ray(&mut rng, &primitives)).collect()
        } else {
            std::iter::repeat_with(|| common::packet(&mut rng, &primitives))
                .flatten()
                .take(per_scene as usize)
                .collect()
        };
        hits += compare(&primitives, &rays.iter().collect(), seed);
    }
    let rays = scenes * per_scene;
    println!(
        "{scenes} scenes, {rays} rays, {hits} hits, each by 3 trees, 3 walks and by itself, every instruction set"
    );
    assert!(hits as u64 > rays / 10, "the rays should hit something: {hits} of {rays}");
}
