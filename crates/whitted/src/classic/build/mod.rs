//! Building the paper's kd-tree, top down.
//!
//! Objects grow by the margin for rounding before anything else, so that a ray which finds an object anywhere near a
//! leaf finds it in the leaf ([`Fit::padding`]). A reference keeps the box of what its object has within its cell:
//! clipped by every plane on the way down, not only cut ("perfect splits", Havran 2000, §4.3).

mod layout;
mod median;
mod sweep;

use super::kd_tree::{halves, multiplied};
use super::node::{Line, MAX_INDEX};
use crate::geometry::Primitives;
use crate::math::Aabb;
use crate::tree::{Bounds, Fit, Solid};

/// How planes are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Split {
    /// By the surface area heuristic: the cheapest of all planes at the borders of objects (paper §2.3.1, with surface
    /// areas where the paper writes volumes).
    #[default]
    Sah,
    /// Through the median of the objects' centres, axis after axis: the comparison that the paper makes.
    Median,
}

/// A node before it has its place.
pub(super) enum Branch {
    Interior { axis: usize, plane: f32, children: Box<[Branch; 2]> },
    Leaf(Vec<u32>),
}

/// What of a primitive lies in a cell.
#[derive(Clone, Copy)]
struct Reference {
    bounds: Aabb,
    primitive: u32,
}

/// A plane across an axis, and how many references reach below and above it.
#[derive(Clone, Copy)]
struct Plane {
    axis: usize,
    position: f32,
    counts: [usize; 2],
}

/// A part of space with what is in it.
struct Node {
    bounds: Aabb,
    references: Vec<Reference>,
    depth: usize,
    /// References and empty leaves that splits in here may add: bounds what can be numbered.
    room: usize,
}

/// What all nodes of one build share.
struct Builder<'a> {
    primitives: &'a Primitives,
    fit: Fit,
    split: Split,
    max_depth: usize,
    stop: Stop<'a>,
}

/// Asked before every node: true ends the build, with nothing but leaves from there on.
pub(super) type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// No leaf lies deeper: bounds the stacks of walks and of this builder.
pub(super) const MAX_DEPTH: usize = 64;

/// Nodes with more references than this build their halves in parallel.
const PARALLEL: usize = 2048;

/// References that splits may add for each primitive.
const ADDED: usize = 8;

/// A root with fewer primitives than this may add so many all the same.
const LEAST_ROOM: usize = 256;

/// Build the tree: its nodes, its references, and the box around everything, in coordinates multiplied by the scale.
pub(super) fn build(primitives: &Primitives, fit: Fit, split: Split, stop: Stop) -> (Vec<Line>, Vec<u32>, Aabb) {
    let reference = |primitive: u32| {
        let bounds = primitives.primitive_bounds(primitive)?;
        Some(Reference { bounds: multiplied(bounds, fit.scale()).grown(fit.padding()), primitive })
    };
    let references: Vec<Reference> = (0..primitives.bounded_count() as u32).filter_map(reference).collect();
    let bounds = references.iter().fold(Aabb::EMPTY, |sum, r| sum.union(r.bounds));
    let count = references.len();
    let room = (ADDED * count + LEAST_ROOM).min(MAX_INDEX.saturating_sub(count));
    // More than can be numbered stay in one leaf, which begins at 0.
    let max_depth = if count < MAX_INDEX { max_depth(count) } else { 0 };
    let builder = Builder { primitives, fit, split, max_depth, stop };
    let root = builder.grow(Node { bounds, references, depth: 0, room });
    let (lines, references) = layout::lay_out(root);
    (lines, references, bounds)
}

/// Havran's rule for the depth (2000, §4.5.2), somewhat deeper.
fn max_depth(count: usize) -> usize {
    const LEAST: f32 = 8.0;
    const PER_DOUBLING: f32 = 1.3;
    ((LEAST + PER_DOUBLING * (count.max(1).ilog2() + 1) as f32) as usize).min(MAX_DEPTH)
}

impl Builder<'_> {
    fn grow(&self, node: Node) -> Branch {
        let plane = match self.split {
            _ if node.depth >= self.max_depth || (self.stop)() => None,
            Split::Sah => sweep::cheapest(&node.references, node.bounds),
            Split::Median => median::middle(&node.references, node.bounds, node.depth),
        };
        match plane {
            Some(plane) if node.added(&plane) <= node.room => {
                let (axis, position) = (plane.axis, plane.position);
                let parallel = node.references.len() > PARALLEL;
                let [below, above] = self.divide(node, &plane);
                let children = match parallel {
                    true => rayon::join(|| self.grow(below), || self.grow(above)).into(),
                    false => [self.grow(below), self.grow(above)],
                };
                Branch::Interior { axis, plane: position, children: Box::new(children) }
            }
            _ => Branch::Leaf(node.references.iter().map(|r| r.primitive).collect()),
        }
    }

    /// Give each half what reaches into it.
    fn divide(&self, node: Node, plane: &Plane) -> [Node; 2] {
        let (axis, position) = (plane.axis, plane.position);
        let room = node.room - node.added(plane);
        let total: usize = plane.counts.iter().sum();
        let [below, above] = plane.counts.map(Vec::with_capacity);
        let lower_room = (room as u64 * plane.counts[0] as u64 / total as u64) as usize;
        let [lower, upper] = halves(node.bounds, axis, position);
        let half = |bounds, references, room| Node { bounds, references, depth: node.depth + 1, room };
        let mut sides = [half(lower, below, lower_room), half(upper, above, room - lower_room)];
        for reference in node.references {
            let (reaches_below, reaches_above) = plane.sides(&reference);
            if reaches_below && reaches_above {
                let [lower, upper] = self.cut(&reference, axis, position);
                sides[0].references.extend(lower);
                sides[1].references.extend(upper);
            } else {
                sides[usize::from(reaches_above)].references.push(reference);
            }
        }
        sides
    }

    /// The parts of a reference below and above a plane; clipping may show that one is empty, never both.
    fn cut(&self, reference: &Reference, axis: usize, plane: f32) -> [Option<Reference>; 2] {
        let padding = self.fit.padding();
        let solid = Solid::new(self.primitives, reference.primitive, self.fit.scale());
        let [lower, upper] = halves(reference.bounds, axis, plane);
        // What lies within the padding of a half belongs to it.
        let part = |half: Aabb| {
            let near = Bounds::new(half.grown(padding));
            let clipped = solid.slab(&near, axis, near.lo(axis), near.hi(axis)).to_aabb();
            let bounds = clipped.grown(padding).intersection(half);
            (!clipped.is_empty() && has_volume(bounds)).then_some(Reference { bounds, ..*reference })
        };
        match [part(lower), part(upper)] {
            // Rounding lost the sliver: keep the plain cut.
            [None, None] => [lower, upper].map(|bounds| Some(Reference { bounds, ..*reference })),
            parts => parts,
        }
    }
}

impl Node {
    /// How much room a plane takes: what it adds to the references, or one for a leaf without any.
    fn added(&self, plane: &Plane) -> usize {
        let empty = usize::from(plane.counts.contains(&0));
        plane.counts[0] + plane.counts[1] - self.references.len() + empty
    }
}

/// Whether a box is not flat. What only touches a half is outside it by all of the padding.
fn has_volume(bounds: Aabb) -> bool {
    (0..3).all(|axis| bounds.lo[axis] < bounds.hi[axis])
}

impl Plane {
    /// Whether a reference, which is never flat, reaches below the plane, and whether above.
    fn sides(&self, reference: &Reference) -> (bool, bool) {
        (reference.bounds.lo[self.axis] < self.position, self.position < reference.bounds.hi[self.axis])
    }
}
