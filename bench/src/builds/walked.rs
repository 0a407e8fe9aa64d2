//! What walking a tree costs: the same diffuse and random rays through each kind of tree.

use super::Options;
use crate::contest::{Contestant, median, thread_seconds};
use crate::options::TreeName;
use crate::ours::Ours;
use crate::ray_sets::{Origins, RayKind, RaySet};
use crate::scenes::Scene;
use clap::ValueEnum;
use whitted::geometry::Primitives;
use whitted::ray::HitBatch;
use whitted::tree::{BuildOptions, Query, Scratch, Tree, TreeKind, TreeReport};

/// A tree of ours and what walking it costs, per ray.
pub(super) struct Walked {
    pub report: TreeReport,
    /// Expected cost of a ray, of that in the tree by the exact sweep.
    pub cost: f64,
    /// Primitives tested.
    pub tests: f64,
    /// Nodes visited.
    pub steps: f64,
    /// Millions of rays per second.
    pub mrays: f64,
}

/// Walk each kind of tree with the same rays.
pub(super) fn walk_each(options: &Options, scene: &Scene, primitives: &Primitives) -> Vec<Walked> {
    let exact = BuildOptions { exact: true, ..TreeKind::Fast.into() };
    let sweep_cost = Tree::build(primitives, &exact).expected_cost();
    let mut sets = Vec::new();
    let walk = |&kind: &TreeName| {
        let tree = Tree::build(primitives, &TreeKind::from(kind).into());
        let query = Query { tree: &tree, primitives, level: options.ours.level(), walk: options.ours.walk.into() };
        if sets.is_empty() {
            sets = ray_sets(scene, primitives, query);
        }
        walk_one(query, &sets, sweep_cost)
    };
    TreeName::value_variants().iter().map(walk).collect()
}

/// Diffuse and random rays, an eighth of a million each.
fn ray_sets(scene: &Scene, primitives: &Primitives, query: Query<'_>) -> Vec<RaySet> {
    const RAYS: usize = 1 << 17;
    let origins = Origins::new(scene, primitives, |rays| {
        let mut hits = HitBatch::default();
        query.closest_hit(rays, &mut hits, &mut Scratch::default());
        hits
    });
    let thinned = |kind| {
        let mut set = origins.set(kind);
        set.thin(RAYS);
        set
    };
    [RayKind::Diffuse, RayKind::Random].map(thinned).into()
}

fn walk_one(query: Query<'_>, sets: &[RaySet], sweep_cost: f64) -> Walked {
    const PASSES: usize = 5;
    let mut ours: Vec<Ours<'_>> =
        sets.iter().map(|set| Ours::new(query, &set.rays, usize::MAX, set.kind.is_occlusion(), "")).collect();
    let rays: f64 = sets.iter().map(|set| set.rays.len() as f64).sum();
    let (mut tests, mut steps) = (0, 0);
    for one in &mut ours {
        let counts = one.count();
        tests += counts.primitive_tests;
        steps += counts.node_steps;
    }
    let mut pass = || thread_seconds(|| ours.iter_mut().for_each(|one| one.run()));
    let seconds = median((0..PASSES).map(|_| pass()).collect());
    let (report, cost) = (query.tree.report(), query.tree.expected_cost() / sweep_cost);
    Walked { report, cost, tests: tests as f64 / rays, steps: steps as f64 / rays, mrays: rays / seconds / 1e6 }
}
