//! The production tree: wide nodes over leaf blocks.

use super::build::{self, BuildOptions};
use super::fit::Fit;
use super::leaf::{LeafKind, Leaves};
use super::node::{Child, ChildKind, Node};
use super::{Stop, TreeKind, validate};
use crate::geometry::Primitives;
use crate::math::Aabb;
use simd::F32Lanes;

/// The tree over a scene's bounded primitives, with its own copy of their coordinates.
///
/// Inside, everything is multiplied by a power of two so that the largest coordinate lies in [1, 2): products of three
/// coordinates then neither overflow nor lose bits, in whatever units the scene is.
#[derive(Clone, Debug)]
pub struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Leaves,
    kind: TreeKind,
    fit: Fit,
    report: TreeReport,
}

/// What the builder made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TreeReport {
    /// Wide nodes.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// References to primitives: their number, plus one for each time one was cut by a spatial split.
    pub references: usize,
    /// Primitives that cannot be hit and were left out: not finite, or without extent.
    pub dropped: usize,
    /// Levels of wide nodes.
    pub depth: usize,
    /// Bytes of nodes and leaf blocks.
    pub bytes: usize,
}

impl Tree {
    /// Build a tree. Bounded in time, memory and depth for any input; uses the current rayon pool.
    pub fn build(primitives: &Primitives, options: &BuildOptions) -> Self {
        Self::build_until(primitives, options, &|_| false).expect("nothing stops it")
    }

    /// As [`build`](Self::build), until `stop` says so: then there is no tree. It is asked some hundred times for a
    /// million primitives, with the share that is done.
    pub fn build_until(primitives: &Primitives, options: &BuildOptions, stop: Stop<'_>) -> Option<Self> {
        let mut tree = Self {
            nodes: Vec::new(),
            leaves: Leaves::default(),
            kind: options.kind,
            fit: Fit::new(primitives.bounds()),
            report: TreeReport::default(),
        };
        if options.kind != TreeKind::None {
            let flat = build::build(primitives, tree.fit.scale(), tree.fit.padding(), options, stop)?;
            (tree.nodes, tree.leaves, tree.report) = (flat.nodes, flat.leaves, flat.report);
        }
        tree.report.bytes = size_of_val(&tree.nodes[..]) + tree.leaves.bytes();
        (!stop(1.0)).then_some(tree)
    }

    /// Choose the scale for a scene of these bounds.
    pub(super) fn fit_scale(&mut self, bounds: Aabb) {
        self.fit = Fit::new(bounds);
    }

    /// The box of a lane around what lies within `bounds`, in the tree's coordinates.
    pub(super) fn padded(&self, bounds: Aabb) -> Aabb {
        bounds.grown(self.fit.padding())
    }

    /// Which splits were allowed.
    pub fn kind(&self) -> TreeKind {
        self.kind
    }

    /// What was built.
    pub fn report(&self) -> TreeReport {
        self.report
    }

    /// See [`Fit::scale`].
    pub(super) fn scale(&self) -> f32 {
        self.fit.scale()
    }

    /// See [`Fit::slack`].
    #[inline(always)]
    pub(super) fn slack<F: F32Lanes>(&self, token: F::Token, distance: F) -> F {
        self.fit.slack(token, distance)
    }

    /// See [`Fit::packet_slack`].
    pub(super) fn packet_slack(&self, distance: f32) -> f32 {
        self.fit.packet_slack(distance)
    }

    /// See [`Fit::primitive_slack`].
    pub(super) fn primitive_slack(&self, distance: f32) -> f32 {
        self.fit.primitive_slack(distance)
    }

    /// Ask the memory for what a walk will read of `child` first.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: Child) {
        match child.decode() {
            ChildKind::Interior(index) => simd::prefetch(&self.nodes, index),
            ChildKind::Leaf { kind: LeafKind::Triangles, first, count } => {
                prefetch_first(&self.leaves.triangles, first, count);
            }
            ChildKind::Leaf { kind: LeafKind::Spheres, first, count } => {
                prefetch_first(&self.leaves.spheres, first, count);
            }
            ChildKind::Leaf { kind: LeafKind::Shapes, .. } => {}
        }
    }

    /// As [`prefetch`](Self::prefetch), for children of which most will be visited, the last first. Nothing if all of the tree
    /// is near anyway.
    #[inline(always)]
    pub(super) fn prefetch_all(&self, children: impl DoubleEndedIterator<Item = Child>) {
        if self.nodes.len() > NEAR {
            children.rev().for_each(|child| self.prefetch(child));
        }
    }

    /// True if the caches of most machines do not hold the tree.
    pub(super) fn is_far(&self) -> bool {
        self.report.bytes > FAR
    }

    /// Levels of nodes below and including the root: bounds every stack of a walk.
    pub(super) fn depth(&self) -> usize {
        self.report.depth
    }

    /// Check every invariant of the structure; tests call it after every build.
    ///
    /// # Errors
    /// The first violation found.
    pub fn validate(&self, primitives: &Primitives) -> Result<(), String> {
        validate::validate(self, primitives)
    }
}

/// Trees of so many nodes fit the second-level cache with their leaves.
const NEAR: usize = 256;

/// Trees of more bytes than this are far.
const FAR: usize = 16 << 20;

/// Blocks of a leaf that are asked for: a leaf rarely has more, and what reads these brings the next.
const AHEAD: usize = 2;

#[inline(always)]
fn prefetch_first<T>(blocks: &[T], first: usize, count: usize) {
    for block in first..first + count.min(AHEAD) {
        simd::prefetch(blocks, block);
    }
}
