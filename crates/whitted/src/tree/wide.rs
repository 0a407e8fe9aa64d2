//! The production tree: nodes of 16 children with tight boxes.

use super::build::{self, BuildOptions};
use super::leaf::{LeafKind, Leaves};
use super::{TreeKind, validate};
use crate::geometry::Primitives;
use crate::math::Aabb;
use simd::F32Lanes;

/// Children of a node.
pub(super) const WIDTH: usize = 16;

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

/// A node: the boxes of 16 children as rows, nine cache lines.
///
/// The first six lines and the children are read by every step, one row of `order` by steps that sort.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Lower x, y, z, then upper x, y, z. Unused lanes are the empty box: lower planes at +∞, upper ones at −∞, which
    /// no ray enters since reciprocals are neither 0 nor infinite.
    pub planes: [[f32; WIDTH]; 6],
    /// What the boxes hold.
    child: [u32; WIDTH],
    /// For each octant of ray directions (bit a set: component a negative) the lanes from far to near.
    pub order: [[u8; WIDTH]; 8],
}

const _: () = assert!(size_of::<Node>() == 576 && align_of::<Node>() == 64, "nine whole cache lines");

/// An interior node or a run of leaf blocks, in 32 bits.
///
/// Interior: the node's index, below 2³¹. Leaf: bit 31, kind in bits 29–30, blocks less one in bits 25–28, first block
/// in bits 0–24.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(pub u32);

/// What a [`Child`] stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChildKind {
    Interior(usize),
    Leaf { kind: LeafKind, first: usize, count: usize },
}

/// Most blocks that one leaf can hold; larger ones become several.
pub(super) const MAX_LEAF_BLOCKS: usize = 16;
const MAX_BLOCK: usize = 1 << 25;

impl Child {
    /// What a lane without a box holds.
    pub(super) const UNUSED: Self = Self(u32::MAX);

    pub(super) const fn interior(index: usize) -> Self {
        assert!(index < 1 << 31, "node index fits 31 bits");
        Self(index as u32)
    }

    pub(super) fn leaf(kind: LeafKind, first: usize, count: usize) -> Self {
        assert!(first < MAX_BLOCK && (1..=MAX_LEAF_BLOCKS).contains(&count), "leaf fits its fields");
        Self(1 << 31 | (kind as u32) << 29 | (count as u32 - 1) << 25 | first as u32)
    }

    #[inline(always)]
    pub(super) fn decode(self) -> ChildKind {
        if self.0 >> 31 == 0 {
            return ChildKind::Interior(self.0 as usize);
        }
        let kind = match self.0 >> 29 & 3 {
            0 => LeafKind::Triangles,
            1 => LeafKind::Spheres,
            _ => LeafKind::Shapes,
        };
        let count = (self.0 >> 25 & 15) as usize + 1;
        ChildKind::Leaf { kind, first: self.0 as usize & (MAX_BLOCK - 1), count }
    }
}

impl Node {
    /// No children.
    pub(super) const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        child: [Child::UNUSED.0; WIDTH],
        order: [[0; WIDTH]; 8],
    };

    pub(super) fn set(&mut self, lane: usize, bounds: Aabb, child: Child) {
        for axis in 0..3 {
            self.planes[axis][lane] = bounds.lo[axis];
            self.planes[3 + axis][lane] = bounds.hi[axis];
        }
        self.child[lane] = child.0;
    }

    /// The children as bits.
    #[inline(always)]
    pub(super) fn children(&self) -> &[u32; WIDTH] {
        &self.child
    }

    /// What the box of a lane holds.
    #[inline(always)]
    pub(super) fn child(&self, lane: usize) -> Child {
        Child(self.child[lane])
    }

    /// The box of a lane as stored, padding included.
    pub(super) fn bounds(&self, lane: usize) -> Aabb {
        let corner = |first: usize| [0, 1, 2].map(|axis| self.planes[first + axis][lane]).into();
        Aabb::new(corner(0), corner(3))
    }

    /// Sort the lanes by the distance of their centres along each octant's diagonal, far to near, unused lanes last.
    pub(super) fn sort(&mut self) {
        for octant in 0..8 {
            let key = |lane: usize| -> f32 {
                let center = self.bounds(lane).center();
                (0..3).map(|axis| if octant >> axis & 1 == 0 { center[axis] } else { -center[axis] }).sum()
            };
            let mut lanes: [u8; WIDTH] = std::array::from_fn(|lane| lane as u8);
            // The centre of the empty box is NaN: it counts as the nearest.
            let far_first = |lane: u8| Some(key(lane.into())).filter(|k| !k.is_nan()).unwrap_or(f32::NEG_INFINITY);
            lanes.sort_by(|&a, &b| far_first(b).total_cmp(&far_first(a)));
            self.order[octant] = lanes;
        }
    }
}

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
