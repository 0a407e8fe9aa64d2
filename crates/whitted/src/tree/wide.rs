//! The production tree: wide nodes over leaf blocks.

use super::build::{self, BuildOptions};
use super::leaf::{LeafKind, Leaves};
use super::node::{Child, ChildKind, Node};
use super::{TreeKind, validate};
use crate::geometry::Primitives;
use crate::math::Aabb;
use simd::F32Lanes;

/// Boxes grow by this times the largest coordinate of the scene.
///
/// A candidate's t and its place in sheared space are wrong by at most 32·2⁻²⁴ of (largest coordinate of the scene +
/// that of the ray's origin): [`ERROR_ULPS`](crate::geometry::triangle::ERROR_ULPS) for triangles, and for spheres a
/// sum of the same kind with Euclidean instead of largest distances. This padding covers origins up to three times
/// the largest coordinate; rays from farther away carry the rest as a slack of their own ([`slack`]).
const PADDING: f32 = 128.0 / (1 << 24) as f32;

/// See [`PADDING`].
const ERROR: f32 = 32.0 / (1 << 24) as f32;

/// [`ERROR`], and the rounding of slopes and plane distances: eight operations of half an ulp on either side.
const PACKET_ERROR: f32 = 40.0 / (1 << 24) as f32;

/// The tree over a scene's bounded primitives, with its own copy of their coordinates.
///
/// Inside, everything is multiplied by a power of two so that the largest coordinate lies in [1, 2): products of three
/// coordinates then neither overflow nor lose bits, in whatever units the scene is.
#[derive(Clone, Debug)]
pub struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Leaves,
    kind: TreeKind,
    scale: f32,
    max_coordinate: f32,
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
        let mut tree = Self {
            nodes: Vec::new(),
            leaves: Leaves::default(),
            kind: options.kind,
            scale: 1.0,
            max_coordinate: 0.0,
            report: TreeReport::default(),
        };
        tree.fit_scale(primitives.bounds());
        if options.kind != TreeKind::None {
            let flat = build::build(primitives, tree.scale, tree.padding(), options);
            (tree.nodes, tree.leaves, tree.report) = (flat.nodes, flat.leaves, flat.report);
        }
        tree.report.bytes = size_of_val(&tree.nodes[..]) + tree.leaves.bytes();
        tree
    }

    /// Choose the scale for a scene of these bounds.
    pub(super) fn fit_scale(&mut self, bounds: Aabb) {
        self.scale = power_of_two_scale(bounds.max_abs());
        self.max_coordinate = bounds.max_abs() * self.scale;
    }

    /// By how much boxes grow.
    fn padding(&self) -> f32 {
        PADDING * self.max_coordinate
    }

    /// The box of a lane around what lies within `bounds`, in the tree's coordinates.
    pub(super) fn padded(&self, bounds: Aabb) -> Aabb {
        bounds.grown(self.padding())
    }

    /// Which splits were allowed.
    pub fn kind(&self) -> TreeKind {
        self.kind
    }

    /// What was built.
    pub fn report(&self) -> TreeReport {
        self.report
    }

    /// The factor from the caller's coordinates to the tree's.
    pub(super) fn scale(&self) -> f32 {
        self.scale
    }

    /// How far outside its padded boxes a ray may find what they hold, if the largest coordinate of its origin is
    /// `distance` (in the tree's coordinates).
    #[inline(always)]
    pub(super) fn slack<F: F32Lanes>(&self, token: F::Token, distance: F) -> F {
        let splat_error = F::splat(token, ERROR);
        let covered = F::splat(token, (PADDING - ERROR) * self.max_coordinate);
        (splat_error * distance - covered).max(F::splat(token, 0.0))
    }

    /// As [`slack`](Self::slack) for the planes around a packet, whose own slopes are rounded.
    pub(super) fn packet_slack(&self, distance: f32) -> f32 {
        (self.primitive_slack(distance) - PADDING * self.max_coordinate).max(0.0)
    }

    /// How far outside a primitive a packet's ray from `distance` away may find it.
    pub(super) fn primitive_slack(&self, distance: f32) -> f32 {
        PACKET_ERROR * (distance + self.max_coordinate)
    }

    /// Ask the memory for what a walk will read of `child`.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: Child) {
        match child.decode() {
            ChildKind::Interior(index) => simd::prefetch(&self.nodes, index),
            ChildKind::Leaf { kind: LeafKind::Triangles, first, .. } => simd::prefetch(&self.leaves.triangles, first),
            ChildKind::Leaf { kind: LeafKind::Spheres, first, .. } => simd::prefetch(&self.leaves.spheres, first),
            ChildKind::Leaf { kind: LeafKind::Shapes, .. } => {}
        }
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

/// The power of two that brings `max` into [1, 2), kept far from the ends of the exponent range.
fn power_of_two_scale(max: f32) -> f32 {
    const EXPONENT_BIAS: i32 = 127;
    const MAX_SHIFT: i32 = 120;
    if !(max > 0.0 && max.is_finite()) {
        return 1.0;
    }
    let exponent = (max.max(f32::MIN_POSITIVE).to_bits() >> 23) as i32 - EXPONENT_BIAS;
    f32::from_bits(((EXPONENT_BIAS - exponent.clamp(-MAX_SHIFT, MAX_SHIFT)) as u32) << 23)
}
