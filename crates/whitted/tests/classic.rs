//! The paper's structures and walks find the hits of brute force, to the bit.

mod common;

use simd::Level;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use whitted::classic::{
    Alignment, Caster, Cell, CellContent, Event, Grid, KdTree, Math, NodeId, Objects, Operation, Split, Steps,
    Structure, Trace, TriangleTest, Walk, Workload,
};
use whitted::geometry::{Primitives, Sphere};
use whitted::math::{Aabb, SplitMix64, Vec3, Vec3f};
use whitted::ray::{Hit, HitBatch, Ray, RayBatch};
use whitted::tree::{Occlusion, Query, Scratch, Tree, TreeKind, WalkKind};

fn bits(hit: Hit) -> [u32; 4] {
    [hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.primitive]
}

/// Every structure, by name, with every walk that it has; the arithmetic takes turns.
fn variants(primitives: &Primitives) -> Vec<(&'static str, Structure, Walk, Math)> {
    let kd = |split| {
        let tree = KdTree::build(primitives, split);
        tree.validate(primitives).unwrap_or_else(|error| panic!("{split:?}: {error}"));
        Structure::Kd(tree)
    };
    vec![
        ("naive", Structure::Naive, Walk::Stack, Math::sse()),
        ("surface areas, stack", kd(Split::Sah), Walk::Stack, Math::Scalar),
        ("surface areas, sequential", kd(Split::Sah), Walk::Sequential, Math::sse()),
        ("median, stack", kd(Split::Median), Walk::Stack, Math::sse()),
        ("median, sequential", kd(Split::Median), Walk::Sequential, Math::Scalar),
        ("grid", Structure::Grid(Grid::build(primitives)), Walk::Stack, Math::Scalar),
    ]
}

/// What brute force says: first hit, second hit, occlusion.
fn oracle(primitives: &Primitives, rays: &[Ray]) -> Vec<([Hit; 2], Occlusion)> {
    let tree = Tree::build(primitives, &TreeKind::None.into());
    let query = Query { tree: &tree, primitives, level: Level::best(), walk: WalkKind::Auto };
    let (batch, mut scratch): (RayBatch, _) = (rays.iter().collect(), Scratch::default());
    let (mut hits, mut second, mut any) = (HitBatch::default(), HitBatch::default(), Vec::new());
    let mut after = vec![(f32::NEG_INFINITY, 0); rays.len()];
    query.next_hit(&batch, &mut after, &mut hits, &mut scratch);
    query.next_hit(&batch, &mut after, &mut second, &mut scratch);
    query.closest_hit(&batch, &mut hits, &mut scratch);
    query.occluded(&batch, None, &mut any, &mut scratch);
    (0..rays.len()).map(|i| ([hits.get(i), second.get(i)], any[i])).collect()
}

fn compare(primitives: &Primitives, rays: &[Ray], seed: u64) -> usize {
    let expected = oracle(primitives, rays);
    let objects = Objects::new(primitives, TriangleTest::Watertight);
    for (name, structure, walk, math) in variants(primitives) {
        let caster = Caster { primitives, objects: &objects, structure: &structure, walk, math };
        for (ray, ([first, second], occlusion)) in rays.iter().zip(&expected) {
            let found = caster.closest_hit(ray, &mut ());
            assert_eq!(bits(found), bits(*first), "scene {seed}, {name}, {ray:?}: {found:?}, brute force {first:?}");
            let mut after = (f32::NEG_INFINITY, 0);
            caster.next_hit(ray, &mut after, &mut ());
            let found = caster.next_hit(ray, &mut after, &mut ());
            assert_eq!(bits(found), bits(*second), "scene {seed}, {name}, {ray:?}, second: {found:?}, {second:?}");
            assert_eq!(caster.occluded(ray, None, &mut ()), *occlusion, "scene {seed}, {name}, {ray:?}");
        }
    }
    expected.iter().filter(|([first, _], _)| first.is_hit()).count()
}

/// Ray walks in all, 6 for each ray; `WHITTED_RAYS` asks for more.
fn rays_in_all() -> u64 {
    std::env::var("WHITTED_RAYS").map_or(1_200_000, |n| n.parse().expect("WHITTED_RAYS is a whole number"))
}

#[test]
fn every_variant_finds_the_hits_of_brute_force() {
    let per_scene = 500;
    let scenes = rays_in_all() / per_scene / 6 + 1;
    let mut hits = 0;
    for seed in 0..scenes {
        let mut rng = SplitMix64::new(77_000 + seed);
        let count = 1 + rng.below(if seed % 4 == 0 { 256 } else { 40 });
        let primitives = common::scene(&mut rng, count);
        let rays: Vec<Ray> = (0..per_scene).map(|_| common::ray(&mut rng, &primitives)).collect();
        hits += compare(&primitives, &rays, seed);
    }
    let rays = scenes * per_scene;
    println!("{scenes} scenes, {rays} rays, {hits} hits, each by 6 variants");
    assert!(hits as u64 > rays / 10, "the rays should hit something: {hits} of {rays}");
}

/// Spheres of one size at random places of a cube.
fn cloud(count: u32, radius: f32) -> Primitives {
    let mut rng = SplitMix64::new(u64::from(count));
    let mut primitives = Primitives::new();
    for _ in 0..count {
        let center = Vec3::new((), (), ()).map(|()| rng.uniform(-1.0, 1.0) as f32);
        primitives.push_sphere(Sphere { center, radius });
    }
    primitives
}

fn rays_through(count: usize) -> Vec<Ray> {
    let mut rng = SplitMix64::new(9);
    let mut point = |size: f64| Vec3::new((), (), ()).map(|()| rng.uniform(-size, size) as f32);
    (0..count).map(|_| Ray::between(point(2.0), point(1.0))).map(|ray| Ray::new(ray.origin, ray.direction)).collect()
}

/// What `structure` does for `rays` on average: steps and tests.
fn effort(primitives: &Primitives, structure: &Structure, walk: Walk, rays: &[Ray]) -> [f64; 2] {
    let objects = Objects::new(primitives, TriangleTest::Watertight);
    let caster = Caster { primitives, objects: &objects, structure, walk, math: Math::Scalar };
    let mut steps = Steps::default();
    for ray in rays {
        caster.closest_hit(ray, &mut steps);
    }
    [steps.steps, steps.tests].map(|count| count as f64 / rays.len() as f64)
}

#[test]
fn surface_areas_beat_medians_and_both_beat_nothing() {
    let (primitives, rays) = (cloud(2000, 0.03), rays_through(2000));
    let kd = |split| Structure::Kd(KdTree::build(&primitives, split));
    let (sah, median) = (kd(Split::Sah), kd(Split::Median));
    let [sah_steps, sah_tests] = effort(&primitives, &sah, Walk::Stack, &rays);
    let [median_steps, median_tests] = effort(&primitives, &median, Walk::Stack, &rays);
    let [_, grid_tests] = effort(&primitives, &Structure::Grid(Grid::build(&primitives)), Walk::Stack, &rays);
    let [restarts, same_tests] = effort(&primitives, &sah, Walk::Sequential, &rays);
    println!("steps {sah_steps} {median_steps}, restarting {restarts}; tests {sah_tests} {median_tests} {grid_tests}");
    assert!(sah_tests < 8.0 && sah_tests < median_tests && median_tests < 100.0, "{sah_tests} {median_tests}");
    assert!(sah_steps + sah_tests < median_steps + median_tests, "{sah_steps} {median_steps}");
    assert!(grid_tests < 30.0, "{grid_tests}");
    assert!(restarts > sah_steps, "starting at the root again takes steps: {restarts} {sah_steps}");
    assert!((same_tests - sah_tests).abs() < 0.2 * sah_tests, "the leaves are the same: {same_tests} {sah_tests}");
}

#[test]
fn empty_space_is_cut_off() {
    let mut primitives = cloud(100, 0.01);
    primitives.push_sphere(Sphere { center: Vec3::new(50.0, 0.0, 0.0), radius: 0.01 });
    let tree = KdTree::build(&primitives, Split::Sah);
    let total = tree.bounds().half_area();
    let is_empty = |cell: &CellContent<'_>| matches!(cell, CellContent::Leaf { primitives } if primitives.is_empty());
    let largest = tree.cells().filter(|cell| is_empty(&cell.content)).map(|cell| cell.bounds.half_area());
    let largest = largest.fold(0.0, f32::max);
    assert!(largest > 0.8 * total, "the gap is one leaf: {largest} of {total}");
}

#[test]
fn a_build_that_is_stopped_leaves_a_small_tree_that_finds_the_same() {
    let (primitives, rays) = (cloud(3000, 0.03), rays_through(200));
    for split in [Split::Sah, Split::Median] {
        let asked = AtomicUsize::new(0);
        let stopped = KdTree::build_until(&primitives, split, &|| asked.fetch_add(1, Ordering::Relaxed) >= 10);
        stopped.validate(&primitives).unwrap();
        let whole = KdTree::build(&primitives, split);
        assert!(stopped.report().nodes <= 21 && whole.report().nodes > 1000, "{:?}", stopped.report());
        let objects = Objects::new(&primitives, TriangleTest::Watertight);
        let [stopped, whole] = [stopped, whole].map(Structure::Kd);
        for ray in &rays {
            let hit = |structure| {
                let (walk, math) = (Walk::Sequential, Math::Scalar);
                Caster { primitives: &primitives, objects: &objects, structure, walk, math }.closest_hit(ray, &mut ())
            };
            assert_eq!(bits(hit(&stopped)), bits(hit(&whole)));
        }
    }
}

#[test]
fn cells_divide_the_bounds_and_traces_go_through_them() {
    let primitives = cloud(300, 0.05);
    let tree = KdTree::build(&primitives, Split::Sah);
    let cells: HashMap<NodeId, _> = tree.cells().map(|cell| (cell.node, cell)).collect();
    let leaves = |cell: &&Cell<'_>| matches!(cell.content, CellContent::Leaf { .. });
    let volume = |size: Vec3f| f64::from(size.x) * f64::from(size.y) * f64::from(size.z);
    let sum: f64 = cells.values().filter(leaves).map(|cell| volume(cell.bounds.size())).sum();
    let whole = volume(tree.bounds().size());
    assert!((sum / whole - 1.0).abs() < 1e-6, "{sum} of {whole}");
    assert_eq!(cells.len(), tree.report().nodes);

    let objects = Objects::new(&primitives, TriangleTest::Watertight);
    let structure = Structure::Kd(tree.clone());
    for ray in rays_through(200) {
        for walk in [Walk::Sequential, Walk::Stack] {
            let caster =
                Caster { primitives: &primitives, objects: &objects, structure: &structure, walk, math: Math::Scalar };
            let mut trace = Trace::default();
            let hit = caster.closest_hit(&ray, &mut trace);
            let mut accepted = Hit::MISS.primitive;
            let mut leaf: &[u32] = &[];
            for event in &trace.events {
                match *event {
                    Event::Step { node, interval: [start, end] } | Event::Leaf { node, interval: [start, end] } => {
                        let cell = &cells[&node];
                        let middle = ray.at(0.5 * (start + end));
                        assert!(
                            start <= end && cell.bounds.grown(1e-4).contains(Aabb::new(middle, middle)),
                            "{cell:?}"
                        );
                        leaf = if let CellContent::Leaf { primitives } = cell.content { primitives } else { &[] };
                    }
                    Event::Test { primitive } => assert!(leaf.contains(&primitive)),
                    Event::Accept { primitive, .. } => accepted = primitive,
                }
            }
            assert_eq!(accepted, hit.primitive);
        }
    }
}

#[test]
fn nothing_and_everything_in_one_place_build_and_are_walked() {
    let same = |count| {
        let mut primitives = Primitives::new();
        (0..count).for_each(|_| primitives.push_sphere(Sphere { center: Vec3f::ONE, radius: 0.5 }));
        primitives
    };
    for count in [0, 1, 3, 5000] {
        let primitives = same(count);
        let expected = if count == 0 { Hit::MISS.primitive } else { 0 };
        let objects = Objects::new(&primitives, TriangleTest::Watertight);
        for (name, structure, walk, math) in variants(&primitives) {
            let caster = Caster { primitives: &primitives, objects: &objects, structure: &structure, walk, math };
            let hit = caster.closest_hit(&Ray::new([0.9, 1.1, 5.0], [0.0, 0.0, -1.0]), &mut ());
            assert_eq!(hit.primitive, expected, "{count}, {name}");
        }
        let references = KdTree::build(&primitives, Split::Median).report().references;
        assert!(references <= 9 * count + 256, "{count}: {references}");
    }
}

/// Rays at the inside of triangles find the same with the paper's test; those at edges may not.
#[test]
fn projection_agrees_inside_triangles() {
    let (mut differing, mut total) = (0, 0);
    for seed in 0..40 {
        let mut rng = SplitMix64::new(seed);
        let primitives = common::scene(&mut rng, 40);
        let tree = Structure::Kd(KdTree::build(&primitives, Split::Sah));
        let [watertight, projection] =
            [TriangleTest::Watertight, TriangleTest::Projection].map(|test| Objects::new(&primitives, test));
        for ray in rays_through(500) {
            let hit = |objects| {
                let (structure, walk, math) = (&tree, Walk::Stack, Math::Scalar);
                Caster { primitives: &primitives, objects, structure, walk, math }.closest_hit(&ray, &mut ())
            };
            total += 1;
            differing += usize::from(bits(hit(&watertight)) != bits(hit(&projection)));
        }
    }
    println!("{differing} of {total} differ");
    assert!(differing * 1000 <= total, "{differing} of {total}");
}

#[test]
fn operations_alone_give_the_same_results_wherever_they_lie() {
    let mut workload = Workload::new(100);
    for operation in [Operation::Multiply, Operation::Normalize] {
        let mut sums = Vec::new();
        for level in Level::available() {
            for alignment in [Alignment::Aligned, Alignment::Misaligned] {
                workload.clear();
                assert_eq!(workload.run(operation, level, alignment), 100);
                sums.push((alignment, workload.sum()));
            }
        }
        for (alignment, sum) in &sums {
            let first = sums.iter().find(|(other, _)| other == alignment).expect("the same alignment");
            assert_eq!(*sum, first.1, "{operation:?}, {alignment:?}");
            assert!(*sum > 1.0);
        }
    }
}
