//! Our side: a tree, and the contestant that queries it in batches.

use crate::contest::Contestant;
use std::time::Instant;
use whitted::geometry::Primitives;
use whitted::ray::{HitBatch, RayBatch};
use whitted::tree::{Counts, Occlusion, Query, Scratch, Tree, TreeKind};

/// Rays in batches, with room for their answers.
pub(crate) struct Ours<'a> {
    query: Query<'a>,
    batches: Vec<RayBatch>,
    answers: Vec<Answers>,
    scratch: Scratch,
    note: &'static str,
}

enum Answers {
    Hits(HitBatch),
    Occlusion(Vec<Occlusion>),
}

impl<'a> Ours<'a> {
    /// Cut `rays` into batches of `size`; `note` tells apart contestants with the same size.
    pub(crate) fn new(query: Query<'a>, rays: &RayBatch, size: usize, is_occlusion: bool, note: &'static str) -> Self {
        let batches: Vec<RayBatch> = (0..rays.len())
            .step_by(size)
            .map(|start| {
                (start..rays.len().min(start + size)).map(|i| rays.get(i)).collect::<Vec<_>>().iter().collect()
            })
            .collect();
        let room = |_: &RayBatch| match is_occlusion {
            true => Answers::Occlusion(Vec::new()),
            false => Answers::Hits(HitBatch::default()),
        };
        let answers = batches.iter().map(room).collect();
        Self { query, batches, answers, scratch: Scratch::default(), note }
    }

    /// Answer all rays and count what that took.
    pub(crate) fn count(&mut self) -> Counts {
        let mut counts = Counts::default();
        for (rays, answers) in self.batches.iter().zip(&mut self.answers) {
            counts += match answers {
                Answers::Hits(hits) => self.query.closest_hit(rays, hits, &mut self.scratch),
                Answers::Occlusion(out) => self.query.occluded(rays, None, out, &mut self.scratch),
            };
        }
        counts
    }
}

impl Contestant for Ours<'_> {
    fn name(&self) -> String {
        self.note.into()
    }

    fn is_peer(&self) -> bool {
        false
    }

    fn run(&mut self) {
        self.count();
    }

    fn answers(&self) -> Vec<f32> {
        let blocked = |&occlusion: &Occlusion| if occlusion == Occlusion::Clear { f32::INFINITY } else { 0.0 };
        let batch = |answers: &Answers| match answers {
            Answers::Hits(hits) => hits.t.clone(),
            Answers::Occlusion(out) => out.iter().map(blocked).collect(),
        };
        self.answers.iter().flat_map(batch).collect()
    }
}

/// The brute-force oracle, for a few rays.
pub(crate) struct Judge<'a> {
    query: Query<'a>,
    /// How many rays can be judged in about a second.
    budget: usize,
}

/// The tree that tests every primitive.
pub(crate) fn no_tree(primitives: &Primitives) -> Tree {
    Tree::build(primitives, &TreeKind::None.into())
}

impl<'a> Judge<'a> {
    /// Judge the answers of `query`; `no_tree` is [`no_tree`] of its primitives.
    pub(crate) fn new(query: Query<'a>, no_tree: &'a Tree) -> Self {
        const TESTS_PER_SECOND: usize = 20_000_000;
        let budget = (TESTS_PER_SECOND / query.primitives.len().max(1)).clamp(8, 2048);
        Self { query: Query { tree: no_tree, ..query }, budget }
    }

    /// How many of these rays (of as many as can be afforded, evenly spread) have another answer than the truth; and
    /// how many were judged.
    pub(crate) fn wrong(
        &self,
        rays: &RayBatch,
        answers: &[f32],
        indices: &[usize],
        is_occlusion: bool,
    ) -> (usize, usize) {
        let step = indices.len().div_ceil(self.budget).max(1);
        let chosen: Vec<usize> = indices.iter().copied().step_by(step).collect();
        let batch: RayBatch = chosen.iter().map(|&index| rays.get(index)).collect::<Vec<_>>().iter().collect();
        let mut truth = Ours::new(self.query, &batch, usize::MAX, is_occlusion, "");
        truth.run();
        let differs = |&(&index, &t): &(&usize, &f32)| answers[index].to_bits() != t.to_bits();
        (chosen.iter().zip(&truth.answers()).filter(differs).count(), chosen.len())
    }
}

/// A tree with the seconds that its build took: wall clock, and CPU of all threads of the process.
pub(crate) struct TimedBuild {
    /// The tree.
    pub tree: Tree,
    /// Wall-clock seconds.
    pub wall: f64,
    /// CPU seconds.
    pub cpu: f64,
}

impl TimedBuild {
    /// Build a tree in the current thread pool.
    pub(crate) fn new(primitives: &Primitives, kind: TreeKind) -> Self {
        let (start, cpu) = (Instant::now(), cpu_time::ProcessTime::now());
        let tree = Tree::build(primitives, &kind.into());
        Self { tree, wall: start.elapsed().as_secs_f64(), cpu: cpu.elapsed().as_secs_f64() }
    }
}
