//! The scene for queries: one ray, many rays, masks, ranges, threads and moves, against asking every primitive.

mod common;

use whitted::geometry::MeshError;
use whitted::math::{SplitMix64, Vec3, Vec3f};
use whitted::query::{MoveError, RayScene, RaySceneBuilder, RaySceneError};
use whitted::ray::{Hit, HitBatch, HitsMut, Ray, RayBatch, Rays};
use whitted::tree::{RefitError, TreeKind};

type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);
type Spheres = Vec<([f32; 3], f32)>;

/// Some meshes and spheres, a part of them degenerate.
fn geometries(rng: &mut SplitMix64) -> (Vec<Mesh>, Spheres) {
    let meshes = (0..3).map(|_| mesh(rng)).collect();
    let radius = |rng: &mut SplitMix64| [0.0, -1.0, f32::NAN, 0.1, 0.3, 0.5][rng.below(6) as usize];
    let spheres = (0..20).map(|_| (common::point(rng, 1.0).to_array(), radius(rng))).collect();
    (meshes, spheres)
}

fn mesh(rng: &mut SplitMix64) -> Mesh {
    let positions: Vec<[f32; 3]> = (0..30).map(|_| common::point(rng, 1.0).to_array()).collect();
    let triangles = (0..40).map(|_| [0; 3].map(|_: u32| rng.below(30))).collect();
    (positions, triangles)
}

/// The geometries 0 mesh, 1 spheres, 2 mesh, 3 nothing, 4 mesh.
fn builder((meshes, spheres): &(Vec<Mesh>, Spheres)) -> RaySceneBuilder {
    let mesh = |builder: RaySceneBuilder, i: usize| builder.mesh(&meshes[i].0, &meshes[i].1);
    let builder = mesh(RayScene::builder(), 0).spheres(spheres);
    mesh(mesh(builder, 1).mesh(&[], &[]), 2)
}

/// Rays of every kind, sound or not.
fn rays(rng: &mut SplitMix64, count: usize) -> Vec<Ray> {
    let nasty = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, 0.0, 1e-45, 1e38, -1e38];
    (0..count)
        .map(|_| {
            let origin = common::point(rng, 2.0);
            let mut ray = Ray::new(origin, common::point(rng, 1.0) - origin * 0.5);
            let odd = nasty[rng.below(8) as usize];
            match rng.below(24) {
                0 => ray.origin.x = odd,
                1 => ray.direction.y = odd,
                2 => ray.t_min = odd,
                3 => ray.t_max = odd,
                4 => (ray.t_min, ray.t_max) = (1.0, 0.5),
                5 => ray.direction = Vec3f::ZERO,
                6 => (ray.t_min, ray.t_max) = (-1.0, 1.0),
                7 => ray.direction = Vec3::new(0.0, 0.0, 1.0),
                _ => {}
            }
            ray
        })
        .collect()
}

fn of_batch(hits: &HitBatch, index: usize) -> Option<Hit> {
    Some(hits.get(index)).filter(Hit::is_hit)
}

#[test]
fn one_ray_many_rays_and_every_primitive_agree() {
    let mut hits = 0;
    for seed in 0..60 {
        let mut rng = SplitMix64::new(seed);
        let geometries = geometries(&mut rng);
        let oracle = builder(&geometries).tree(TreeKind::None).build().expect("sound");
        let scenes = [TreeKind::Best, TreeKind::Fast].map(|kind| builder(&geometries).tree(kind).build().expect("ok"));
        let rays = rays(&mut rng, 300);
        let batch: RayBatch = rays.iter().collect();
        for scene in &scenes {
            let (many, blocked) = (scene.closest_hit_batch(&batch), scene.occluded_batch(&batch));
            let lists = scene.all_hits_batch(&batch);
            for (index, ray) in rays.iter().enumerate() {
                let expected = oracle.closest_hit(ray);
                assert_eq!(scene.closest_hit(ray), expected, "scene {seed}, {ray:?}");
                assert_eq!(of_batch(&many, index), expected, "scene {seed}, {ray:?}");
                assert_eq!((scene.occluded(ray), blocked[index]), (expected.is_some(), expected.is_some()));
                assert_eq!(scene.all_hits(ray), oracle.all_hits(ray), "scene {seed}, {ray:?}");
                assert_eq!(lists.of(index), oracle.all_hits(ray), "scene {seed}, {ray:?}");
                assert_eq!(scene.count_hits(ray), lists.of(index).len());
                if let Some(hit) = expected {
                    hits += 1;
                    assert!((ray.t_min..=ray.t_max).contains(&hit.t));
                    let length = Vec3::from(scene.normal(ray, &hit)).length();
                    assert!((length - 1.0).abs() < 1e-6, "{length}");
                }
            }
            let [x, y, z] = scene.normal_batch(&batch, &many);
            for (index, ray) in rays.iter().enumerate() {
                let expected = of_batch(&many, index).map_or([0.0; 3], |hit| scene.normal(ray, &hit));
                assert_eq!([x[index], y[index], z[index]], expected);
            }
        }
    }
    assert!(hits > 5000, "{hits} hits");
}

#[test]
fn masks_and_filters_hide_primitives() {
    let mut hidden = 0;
    for seed in 100..130 {
        let mut rng = SplitMix64::new(seed);
        let geometries = geometries(&mut rng);
        let mut scene = builder(&geometries).build().expect("sound");
        let masks = [0b0001, 0b0010, 0b0101, u32::MAX, 0];
        (0..5).for_each(|geometry| scene.set_mask(geometry, masks[geometry]));
        let rays = rays(&mut rng, 200);
        let batch: RayBatch = rays.iter().collect();
        let ray_masks: Vec<u32> = rays.iter().map(|_| [0b1, 0b10, 0b110, 0, u32::MAX][rng.below(5) as usize]).collect();
        let view = Rays::from(&batch).with_mask(&ray_masks);
        let (many, blocked) = (scene.closest_hit_batch(view), scene.occluded_batch(view));
        let lists = scene.all_hits_batch(view);
        for (index, ray) in rays.iter().enumerate() {
            let sees = |primitive: u32| masks[scene.locate(primitive).0] & ray_masks[index] != 0;
            let expected = scene.closest_hit_where(ray, sees);
            let masked = ray.with_mask(ray_masks[index]);
            assert_eq!(scene.closest_hit(masked), expected, "scene {seed}, ray {index}");
            assert_eq!(of_batch(&many, index), expected, "scene {seed}, ray {index}");
            assert_eq!(scene.occluded(masked), expected.is_some());
            assert_eq!(scene.occluded_where(ray, sees), expected.is_some());
            assert_eq!(blocked[index], expected.is_some());
            assert_eq!(lists.of(index), scene.all_hits(masked));
            // Brute force over the list of all hits.
            let all = scene.all_hits(ray.with_mask(ray_masks[index]));
            assert!(all.iter().all(|hit| sees(hit.primitive)), "scene {seed}, ray {index}");
            assert!(expected.is_none_or(|hit| sees(hit.primitive)));
            hidden += usize::from(expected != scene.closest_hit_where(ray, |_| true));
        }
    }
    assert!(hidden > 500, "{hidden}");
}

#[test]
fn a_hidden_primitive_is_as_if_it_were_not_there() {
    for seed in 200..220 {
        let mut rng = SplitMix64::new(seed);
        let geometries = geometries(&mut rng);
        let whole = builder(&geometries).build().expect("sound");
        let first_only = RayScene::from_mesh(&geometries.0[0].0, &geometries.0[0].1).expect("sound");
        for ray in rays(&mut rng, 200) {
            let of_first = |primitive: u32| whole.locate(primitive).0 == 0;
            assert_eq!(whole.closest_hit_where(&ray, of_first), first_only.closest_hit(ray), "scene {seed}, {ray:?}");
        }
    }
}

#[test]
fn many_threads_ask_one_scene() {
    let mut rng = SplitMix64::new(7);
    let geometries = geometries(&mut rng);
    let scene = builder(&geometries).build().expect("sound");
    let rays = rays(&mut rng, 20_000);
    let batch: RayBatch = rays.iter().collect();
    let expected: Vec<Option<Hit>> = rays.iter().map(|ray| scene.closest_hit(ray)).collect();
    std::thread::scope(|scope| {
        for thread in 0..8 {
            let (scene, rays, batch, expected) = (&scene, &rays, &batch, &expected);
            scope.spawn(move || {
                for (ray, expected) in rays.iter().zip(expected).skip(thread * 100) {
                    assert_eq!(scene.closest_hit(ray), *expected);
                }
                let hits = scene.closest_hit_batch(batch);
                (0..rays.len()).for_each(|i| assert_eq!(of_batch(&hits, i), expected[i]));
            });
        }
    });
}

#[test]
fn large_batches_are_the_same_by_one_thread_and_by_many() {
    let mut rng = SplitMix64::new(8);
    let scene = builder(&geometries(&mut rng)).build().expect("sound");
    let batch: RayBatch = rays(&mut rng, 70_001).iter().collect();
    let mut alone = HitBatch::default();
    alone.resize(batch.len());
    scene.closest_hit_into(&batch, &mut alone);
    let same = |a: &HitBatch, b: &HitBatch| (0..a.len()).all(|i| of_batch(a, i) == of_batch(b, i));
    assert!(same(&alone, &scene.closest_hit_batch(&batch)));
    let mut blocked = vec![true; batch.len()];
    scene.occluded_into(&batch, &mut blocked);
    assert_eq!(blocked, scene.occluded_batch(&batch));
    let mut lists = Default::default();
    scene.all_hits_into(&batch, &mut lists);
    assert_eq!(lists, scene.all_hits_batch(&batch));
    // Parts of the caller's arrays, by the caller's threads.
    let mut parts = HitBatch::default();
    parts.resize(batch.len());
    let (left, right) = Rays::from(&batch).split_at(12_345);
    let (left_hits, right_hits) = HitsMut::from(&mut parts).split_at(12_345);
    std::thread::scope(|scope| {
        scope.spawn(|| scene.closest_hit_into(left, left_hits));
        scope.spawn(|| scene.closest_hit_into(right, right_hits));
    });
    assert!(same(&alone, &parts));
}

#[test]
fn no_rays_and_no_primitives_are_no_trouble() {
    let empty = RayScene::builder().build().expect("sound");
    let ray = Ray::new([0.0; 3], [1.0, 0.0, 0.0]);
    assert!(empty.is_empty() && empty.bounds().is_empty());
    assert!(empty.closest_hit(ray).is_none() && !empty.occluded(ray) && empty.all_hits(ray).is_empty());
    assert!(!empty.contains([0.0; 3]));
    assert_eq!(empty.occluded_batch(&[ray; 3].iter().collect::<RayBatch>()), [false; 3]);
    let none = RayBatch::new();
    assert!(empty.closest_hit_batch(&none).is_empty() && empty.all_hits_batch(&none).is_empty());
    let degenerate = RayScene::from_mesh(&[[0.0; 3], [1.0; 3]], &[[0, 1, 1]]).expect("sound");
    assert_eq!((degenerate.len(), degenerate.dropped()), (1, 1));
    assert!(degenerate.closest_hit(ray).is_none());
}

#[test]
fn a_query_inside_a_query_is_right() {
    let scene = RayScene::builder().spheres(&[([0.0; 3], 1.0), ([4.0, 0.0, 0.0], 1.0)]).build().expect("sound");
    let ray = Ray::new([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    // Only what has another sphere behind it, which the first has and the second has not.
    let behind = |primitive: u32| scene.count_hits(Ray { t_min: 5.5, ..ray }) == 2 && primitive == 1;
    assert_eq!(scene.closest_hit_where(&ray, behind).map(|hit| hit.t), Some(6.0));
}

#[test]
fn geometries_are_numbered_in_the_order_of_adding() {
    let mut rng = SplitMix64::new(9);
    let scene = builder(&geometries(&mut rng)).build().expect("sound");
    assert_eq!(scene.len(), 140);
    let located = [0, 39, 40, 79, 80, 119, 120, 139].map(|primitive| scene.locate(primitive));
    assert_eq!(located, [(0, 0), (0, 39), (2, 0), (2, 39), (4, 0), (4, 39), (1, 0), (1, 19)]);
    assert!(scene.memory_bytes() > 140 * 12);
}

#[test]
fn a_wrong_mesh_is_named() {
    let corners = [[0.0; 3]; 3];
    let wrong = RayScene::builder().mesh(&corners, &[[0, 1, 2]]).mesh(&corners, &[[0, 1, 2], [2, 3, 0]]).build();
    let error = wrong.expect_err("there is no vertex 3");
    assert_eq!(
        error,
        RaySceneError::Mesh { geometry: 1, error: MeshError::Index { triangle: 1, index: 3, vertices: 3 } }
    );
    assert_eq!(error.to_string(), "geometry 1: triangle 1 names vertex 3, but the mesh has 3 vertices");
}

#[test]
fn moved_scenes_answer_like_new_ones() {
    for seed in 300..320 {
        let mut rng = SplitMix64::new(seed);
        let (mut meshes, mut spheres) = geometries(&mut rng);
        spheres.iter_mut().for_each(|sphere| sphere.1 = 0.2);
        let mut scene = builder(&(meshes.clone(), spheres.clone())).tree(TreeKind::Fast).build().expect("sound");
        for _ in 0..3 {
            let shift = common::point(&mut rng, 1.0).to_array();
            meshes[1].0.iter_mut().for_each(|p| *p = [p[0] * 1.5 + shift[0], p[2], p[1] + shift[2]]);
            spheres
                .iter_mut()
                .for_each(|sphere| *sphere = ([sphere.0[1] + shift[1], sphere.0[0], 0.5], sphere.1 * 0.9));
            scene.set_positions(2, &meshes[1].0).expect("a mesh");
            scene.set_spheres(1, &spheres).expect("spheres");
            scene.refit().expect("a fast tree");
            let geometries = (meshes.clone(), spheres.clone());
            let oracle = builder(&geometries).tree(TreeKind::None).build().expect("sound");
            let anew = builder(&geometries).tree(TreeKind::Fast).build().expect("sound");
            for ray in rays(&mut rng, 200) {
                let expected = oracle.closest_hit(ray);
                assert_eq!(scene.closest_hit(ray), expected, "scene {seed}, {ray:?}");
                assert_eq!(anew.closest_hit(ray), expected, "scene {seed}, {ray:?}");
            }
        }
    }
}

#[test]
fn wrong_moves_are_told() {
    let mut rng = SplitMix64::new(11);
    let geometries = geometries(&mut rng);
    let mut scene = builder(&geometries).build().expect("sound");
    assert_eq!(scene.refit(), Err(RefitError::Kind { kind: TreeKind::Best }));
    scene.rebuild();
    let error = scene.set_positions(1, &[]).expect_err("spheres");
    assert_eq!(error, MoveError::Geometry { geometry: 1, kind: "vertices" });
    assert_eq!(scene.set_spheres(9, &[]), Err(MoveError::Geometry { geometry: 9, kind: "spheres" }));
    let error = scene.set_positions(4, &[[0.0; 3]; 2]).expect_err("too few");
    assert_eq!(error.to_string(), "geometry 4 has 30 vertices, not 2");
}
