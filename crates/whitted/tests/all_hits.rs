//! All hits of a ray: in order, each once, edges and vertices that triangles share once, closed surfaces evenly.

mod common;

use std::collections::HashSet;
use std::path::Path;
use whitted::query::RayScene;
use whitted::ray::{HitBatch, HitLists, Ray, RayBatch};
use whitted::tree::{Query, Scratch, Tree, TreeKind, WalkKind};

/// A cube from −1 to 1 whose sides are divided into `n` × `n` squares of two triangles, without shared vertices.
fn cube(n: i32) -> RayScene {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let at = |i: i32| 2.0 * i as f32 / n as f32 - 1.0;
    for (axis, sense) in (0..3).flat_map(|axis| [(axis, -1.0f32), (axis, 1.0)]) {
        let point = |i: i32, j: i32| {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sense, at(i), at(j));
            p
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let first = positions.len() as u32;
            positions.extend([point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| first + k);
            let turned = sense < 0.0;
            triangles.extend([[a, b, c], [a, c, d]].map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }));
        }
    }
    RayScene::from_mesh(&positions, &triangles).expect("a sound mesh")
}

#[test]
fn a_cube_is_entered_and_left_once_through_edges_and_vertices() {
    let cube = cube(4);
    let steps = || -3..=3;
    let directions = steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])));
    let mut exact = 0;
    for direction in directions.filter(|d| *d != [0; 3]) {
        let direction = direction.map(|a| a as f32);
        // From lattice points and others inside: out once.
        for start in [[0.0, 0.0, 0.0], [0.5, -0.5, 0.0], [0.25, 0.5, -0.75], [0.1, 0.2, 0.3]] {
            assert_eq!(cube.count_hits(Ray::new(start, direction)), 1, "{start:?} {direction:?}");
            // The line through the inside from far away: in and out.
            let far = [0, 1, 2].map(|axis| start[axis] - 16.0 * direction[axis]);
            let ray = Ray::new(far, direction);
            let hits = cube.all_hits(ray);
            assert_eq!(hits.len(), 2, "{far:?} {direction:?}: {hits:?}");
            assert_eq!(hits.first().copied(), cube.closest_hit(ray), "{far:?} {direction:?}");
            exact += 1;
        }
    }
    assert_eq!(exact, 4 * 342);
}

#[test]
fn what_touches_a_cube_passes_it_an_even_number_of_times() {
    let cube = cube(2);
    // Along faces, along edges, through corners from outside.
    for (start, direction) in [
        ([-3.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ([-3.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
        ([-3.0, 1.0, 0.5], [1.0, 0.0, 0.0]),
        ([0.0, 2.0, 0.0], [1.0, -1.0, 0.0]),
        ([0.0, 2.0, 1.0], [1.0, -1.0, 0.0]),
        ([0.0, 1.5, 1.5], [2.0, -1.0, -1.0]),
        ([3.0, 0.0, 0.0], [-2.0, 1.0, 1.0]),
    ] {
        let count = cube.count_hits(Ray::new(start, direction));
        assert!(count == 0 || count == 2, "{start:?} {direction:?}: {count}");
    }
}

#[test]
fn points_inside_are_told_from_points_outside() {
    let cube = cube(8);
    // Eighths are lattice planes of the mesh: rays through them meet many edges.
    let coordinates = || (-12..=12).map(|i| i as f32 / 8.0).filter(|a| a.abs() != 1.0);
    for x in coordinates() {
        for y in coordinates() {
            for z in coordinates() {
                let inside = [x, y, z].iter().all(|a| a.abs() < 1.0);
                assert_eq!(cube.contains([x, y, z]), inside, "{x} {y} {z}");
            }
        }
    }
    assert!(!cube.contains([f32::NAN, 0.0, 0.0]) && !cube.contains([f32::INFINITY, 0.0, 0.0]));
}

#[test]
fn spheres_are_entered_and_left() {
    let scene = RayScene::builder().spheres(&[([0.0; 3], 1.0), ([0.0; 3], 2.0)]).build().expect("sound");
    let ts = |ray: Ray| scene.all_hits(ray).iter().map(|hit| hit.t).collect::<Vec<_>>();
    let ray = Ray::new([-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert_eq!(ts(ray), [2.0, 3.0, 5.0, 6.0]);
    assert_eq!(ts(Ray { t_min: 2.5, t_max: 5.0, ..ray }), [3.0, 5.0]);
    // The outline is touched.
    assert_eq!(ts(Ray::new([-4.0, 1.0, 0.0], [1.0, 0.0, 0.0])).len(), 2);
    assert!(scene.closest_hit(Ray::new([-4.0, 2.0, 0.0], [1.0, 0.0, 0.0])).is_some());
}

/// All hits by asking for the next one again and again: with every touch, and edges as often as triangles share them.
fn every_hit(query: &Query<'_>, rays: &RayBatch) -> Vec<Vec<u32>> {
    let mut after = vec![(f32::NEG_INFINITY, 0); rays.len()];
    let mut lists = vec![Vec::new(); rays.len()];
    let (mut hits, mut scratch) = (HitBatch::default(), Scratch::default());
    loop {
        query.next_hit(rays, &mut after, &mut hits, &mut scratch);
        for (list, after) in lists.iter_mut().zip(&after).filter(|(_, after)| after.0 < f32::INFINITY) {
            list.push(after.1);
        }
        if after.iter().all(|after| after.0 == f32::INFINITY) {
            return lists;
        }
    }
}

#[test]
fn random_scenes_give_the_same_lists_by_every_tree_and_walk() {
    let (mut all, mut left_out) = (0, 0);
    for seed in 0..40 {
        let mut rng = whitted::math::SplitMix64::new(5000 + seed);
        let primitives = common::scene(&mut rng, 60);
        let rays: Vec<Ray> = (0..300).map(|_| common::ray(&mut rng, &primitives)).collect();
        let rays: RayBatch = rays.iter().collect();
        let trees = [TreeKind::None, TreeKind::Kd, TreeKind::Best].map(|kind| Tree::build(&primitives, &kind.into()));
        let find = |tree, walk, level| {
            let query = Query { tree, primitives: &primitives, level, walk };
            let mut lists = HitLists::new();
            query.all_hits(&rays, None, &mut lists, &mut Scratch::default());
            (every_hit(&query, &rays), lists)
        };
        let (every, expected) = find(&trees[0], WalkKind::Auto, simd::Level::best());
        assert_eq!(expected.len(), rays.len());
        for tree in &trees[1..] {
            for walk in [WalkKind::Auto, WalkKind::Single] {
                for level in simd::Level::available() {
                    let (_, found) = find(tree, walk, level);
                    assert_eq!(found, expected, "scene {seed}, {:?}, {walk:?}, {level:?}", tree.kind());
                }
            }
        }
        for (every, list) in every.iter().zip(expected.iter()) {
            assert!(list.windows(2).all(|pair| pair[0].t <= pair[1].t), "scene {seed}: {list:?}");
            let known: HashSet<u32> = every.iter().copied().collect();
            assert!(list.iter().all(|hit| known.contains(&hit.primitive)));
            all += every.len();
            left_out += every.len() - list.len();
        }
    }
    println!("{all} hits, {left_out} of them shared or touched");
    assert!(all > 10_000 && left_out > 20 && left_out < all / 2, "{left_out} of {all}");
}

#[test]
fn closed_meshes_are_passed_evenly_by_rays_at_their_vertices() {
    let Some(folder) = std::env::var_os("WHITTED_SHARED") else {
        return eprintln!("SKIPPED: WHITTED_SHARED is not set, so no closed mesh was counted");
    };
    for mesh in ["cow", "homer", "fandisk"] {
        let (positions, triangles) = read_obj(&Path::new(&folder).join(format!("material/mesh/common-3d/{mesh}.obj")));
        let scene = RayScene::from_mesh(&positions, &triangles).expect("a sound mesh");
        let (lo, hi) = (scene.bounds().lo.to_array(), scene.bounds().hi.to_array());
        let mut shared = 0;
        for (step, target) in positions.iter().enumerate() {
            // From corners of a larger box, and along the axes.
            let corner = [0, 1, 2].map(|axis| if step >> axis & 1 == 0 { 3.0 * lo[axis] } else { 2.0 * hi[axis] });
            let mut above = *target;
            above[step % 3] += 64.0;
            for start in [corner, above] {
                let direction = [0, 1, 2].map(|axis| target[axis] - start[axis]);
                let count = scene.count_hits(Ray::new(start, direction));
                assert!(count.is_multiple_of(2), "{mesh}: {count} hits from {start:?} to {target:?}");
                shared += count;
            }
        }
        println!("{mesh}: {} rays at vertices, {shared} passages", 2 * positions.len());
    }
}

/// Positions and fan-triangulated faces of an OBJ file, nothing else.
fn read_obj(path: &Path) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let fields: Vec<&str> = line.split_whitespace().collect();
        match fields.first() {
            Some(&"v") => positions.push([1, 2, 3].map(|i| fields[i].parse().expect("a number"))),
            Some(&"f") => {
                let corner = |f: &&str| f.split('/').next().and_then(|i| i.parse::<u32>().ok()).expect("an index") - 1;
                let corners: Vec<u32> = fields[1..].iter().map(corner).collect();
                triangles.extend((1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]));
            }
            _ => {}
        }
    }
    (positions, triangles)
}
