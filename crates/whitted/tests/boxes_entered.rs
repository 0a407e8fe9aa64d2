//! The boxes of the tree that a ray enters are those on its way to what it hits.

mod random_scene;

use random_scene::random_scene;
use whitted::math::Vec3d;
use whitted::render::{Cancel, RayEnd, TracedRay, explain};
use whitted::scene::{EnteredBox, Prepared, Scene};
use whitted::tree::{BuildOptions, TreeKind};

fn prepare(scene: &Scene, kind: TreeKind) -> Prepared {
    Prepared::new(scene, &BuildOptions { kind, ..BuildOptions::default() }).expect("a valid scene")
}

fn rays(prepared: &Prepared, scene: &Scene) -> Vec<TracedRay> {
    let pixels = (0..5).flat_map(|y| (0..5).map(move |x| [x * 12 + 3, y * 9 + 3]));
    let of_pixel = |pixel| explain(prepared, &scene.settings, pixel, 0..1, &Cancel::new()).expect("not cancelled");
    let rays = pixels.flat_map(|pixel| of_pixel(pixel).samples).flat_map(|sample| sample.rays);
    rays.filter(|ray| ray.end.is_traced()).collect()
}

fn entered(prepared: &Prepared, ray: &TracedRay) -> Vec<EnteredBox> {
    prepared.geometry().boxes_entered(ray.origin, ray.direction, ray.length)
}

/// What a point may lie outside of a box by rounding, and a box outside of another by the grid of their nodes, as a
/// share of its distance from the world's origin.
const ROUNDING: f64 = 1e-5;
const GRID: f64 = 1e-3;

fn holds(cell: &EnteredBox, point: Vec3d, slack: f64) -> bool {
    let slack = slack * (1.0 + point.abs().max_component());
    (0..3).all(|axis| cell.lo[axis] - slack <= point[axis] && point[axis] <= cell.hi[axis] + slack)
}

#[test]
fn the_way_to_a_hit_leads_through_its_leaf() {
    let (mut hits, mut boxes) = (0, 0);
    for seed in 0..12 {
        let mut scene = random_scene(seed);
        scene.settings.size = [61, 47];
        for kind in [TreeKind::Best, TreeKind::Kd, TreeKind::Fast] {
            let prepared = prepare(&scene, kind);
            for ray in rays(&prepared, &scene) {
                let cells = entered(&prepared, &ray);
                for cell in &cells {
                    assert!(cell.entry <= cell.exit && cell.exit <= ray.length * (1.0 + 1e-6), "{cell:?}");
                    assert!(holds(cell, ray.origin + ray.direction * cell.entry, ROUNDING), "{cell:?} {ray:?}");
                }
                boxes += cells.len();
                let RayEnd::Hit(hit) = ray.end else { continue };
                let is_plane = scene.object_name(hit.object).starts_with("plane");
                let leaf = cells.iter().find(|cell| {
                    cell.primitives.as_ref().is_some_and(|ids| ids.contains(&hit.primitive))
                        && holds(cell, hit.position, ROUNDING)
                });
                assert_eq!(leaf.is_none(), is_plane, "scene {seed}, {kind:?}: {ray:?}\n{cells:#?}");
                hits += 1;
            }
        }
    }
    assert!(hits > 300 && boxes > 1000, "{hits} hits, {boxes} boxes");
}

#[test]
fn boxes_come_from_the_outside_in_and_from_near_to_far() {
    let mut scene = random_scene(3);
    scene.spheres =
        (0..500).map(|i| (Vec3d::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)), 0.2, 0)).collect();
    let prepared = prepare(&scene, TreeKind::Best);
    let cells = prepared.geometry().boxes_entered(Vec3d::new(-5.0, -4.0, -3.0), Vec3d::new(0.6, 0.64, 0.48), 100.0);
    let deepest = cells.iter().map(|cell| cell.level).max().expect("boxes");
    assert!(deepest >= 1, "500 spheres do not fit one node");
    let mut around: Vec<&EnteredBox> = Vec::new();
    for cell in &cells {
        around.truncate(cell.level as usize + 1);
        if let Some(before) = around.get(cell.level as usize) {
            assert!(before.entry <= cell.entry, "{before:?} {cell:?}");
        }
        around.truncate(cell.level as usize);
        assert_eq!(around.len(), cell.level as usize, "each box comes after the one around it");
        let inside = |outer: &&EnteredBox| {
            holds(outer, cell.lo, GRID) && holds(outer, cell.hi, GRID) && outer.primitives.is_none()
        };
        assert!(around.last().is_none_or(inside), "{around:?} {cell:?}");
        around.push(cell);
    }
    assert!(prepare(&scene, TreeKind::None).geometry().boxes_entered(Vec3d::ZERO, Vec3d::ONE, 9.0).is_empty());
    let nowhere = Vec3d::splat(f64::NAN);
    assert!(prepared.geometry().boxes_entered(nowhere, Vec3d::ONE, 9.0).is_empty());
}
