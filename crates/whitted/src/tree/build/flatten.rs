//! From the planned binary tree to wide nodes and leaf blocks.
//!
//! Nodes lie depth first, the children of each side by side; the blocks of leaves in the same order. How many nodes and
//! blocks a subtree has is counted before they are written, so that large subtrees are written in parallel, each into its
//! own part of the arrays.

use super::binary::{BinaryNode, Content, Subtree};
use super::reference::Reference;
use crate::geometry::Primitives;
use crate::math::Aabb;
use crate::tree::leaf::{BLOCK, LeafKind, Leaves, ShapeBlock, SphereBlock, TriangleBlock};
use crate::tree::node::{Child, Node, WIDTH};
use crate::tree::wide::TreeReport;
use rayon::prelude::*;
use std::ops::AddAssign;

/// The finished tree.
pub(in crate::tree) struct Flat {
    pub nodes: Vec<Node>,
    pub leaves: Leaves,
    /// Without the bytes.
    pub report: TreeReport,
}

impl Flat {
    /// Nothing but a root without children.
    pub(super) fn empty(dropped: usize) -> Self {
        let report = TreeReport { nodes: 1, depth: 1, dropped, ..TreeReport::default() };
        Self { nodes: vec![Node::EMPTY], leaves: Leaves::default(), report }
    }
}

/// Subtrees with more binary nodes than this are written by a task of their own.
const PARALLEL: usize = 4096;

/// Write the tree whose root is the last of `nodes`.
pub(super) fn flatten(
    primitives: &Primitives,
    scale: f32,
    padding: f32,
    nodes: &[BinaryNode],
    references: &[Reference],
    dropped: usize,
) -> Flat {
    let source = Source { primitives, scale, padding, nodes, references };
    let root = Subtree { index: nodes.len() - 1, len: nodes.len() };
    let sizes = source.count_under(root);
    let mut out = Vec::new();
    fill(&mut out, sizes.nodes + 1, Node::EMPTY);
    let mut leaves = Leaves::default();
    fill(&mut leaves.triangles, sizes.blocks[0], TriangleBlock::EMPTY);
    fill(&mut leaves.spheres, sizes.blocks[1], SphereBlock::EMPTY);
    fill(&mut leaves.shapes, sizes.blocks[2], ShapeBlock::EMPTY);
    let (first, rest) = out.split_first_mut().expect("there is a root");
    let room = Room {
        nodes: Run::new(rest, 1),
        triangles: Run::new(&mut leaves.triangles, 0),
        spheres: Run::new(&mut leaves.spheres, 0),
        shapes: Run::new(&mut leaves.shapes, 0),
    };
    source.write_parallel(root, first, room);
    let report = TreeReport {
        nodes: sizes.nodes + 1,
        leaves: sizes.leaves,
        references: sizes.references,
        dropped,
        depth: sizes.depth + 1,
        bytes: 0,
    };
    Flat { nodes: out, leaves, report }
}

/// Fill with `count` copies of `value`, on huge pages if large.
fn fill<T: Copy + Send + Sync>(out: &mut Vec<T>, count: usize, value: T) {
    out.reserve_exact(count);
    simd::advise_huge_pages(out.spare_capacity_mut());
    (0..count).into_par_iter().with_min_len(PARALLEL).map(|_| value).collect_into_vec(out);
}

/// What a subtree needs.
#[derive(Clone, Copy, Debug, Default)]
struct Sizes {
    nodes: usize,
    /// By [`LeafKind`].
    blocks: [usize; 3],
    leaves: usize,
    references: usize,
    depth: usize,
}

impl AddAssign for Sizes {
    fn add_assign(&mut self, other: Self) {
        self.nodes += other.nodes;
        for kind in 0..3 {
            self.blocks[kind] += other.blocks[kind];
        }
        self.leaves += other.leaves;
        self.references += other.references;
        self.depth = self.depth.max(other.depth);
    }
}

/// Parts of all arrays that are not written yet.
struct Room<'a> {
    nodes: Run<'a, Node>,
    triangles: Run<'a, TriangleBlock>,
    spheres: Run<'a, SphereBlock>,
    shapes: Run<'a, ShapeBlock>,
}

impl<'a> Room<'a> {
    fn take(&mut self, sizes: &Sizes) -> Self {
        Self {
            nodes: self.nodes.take(sizes.nodes),
            triangles: self.triangles.take(sizes.blocks[LeafKind::Triangles as usize]),
            spheres: self.spheres.take(sizes.blocks[LeafKind::Spheres as usize]),
            shapes: self.shapes.take(sizes.blocks[LeafKind::Shapes as usize]),
        }
    }
}

/// A part of an array that begins at number `first`.
struct Run<'a, T> {
    items: &'a mut [T],
    first: usize,
}

impl<'a, T> Run<'a, T> {
    fn new(items: &'a mut [T], first: usize) -> Self {
        Self { items, first }
    }

    /// Cut off the first `count`.
    fn take(&mut self, count: usize) -> Self {
        let (items, rest) = std::mem::take(&mut self.items).split_at_mut(count);
        let first = self.first;
        *self = Self::new(rest, first + count);
        Self::new(items, first)
    }
}

/// The children of a wide node.
#[derive(Default)]
struct Lanes {
    subtrees: [Option<Lane>; WIDTH],
    len: usize,
}

#[derive(Clone, Copy)]
struct Lane {
    subtree: Subtree,
    /// The kind of a leaf; `None` for a wide node.
    leaf: Option<LeafKind>,
}

impl Lanes {
    fn push(&mut self, lane: Lane) {
        self.subtrees[self.len] = Some(lane);
        self.len += 1;
    }

    fn iter(&self) -> impl Iterator<Item = Lane> {
        self.subtrees.into_iter().flatten()
    }

    fn interiors(&self) -> impl Iterator<Item = Subtree> {
        self.iter().filter(|lane| lane.leaf.is_none()).map(|lane| lane.subtree)
    }
}

/// What is written from.
struct Source<'a> {
    primitives: &'a Primitives,
    scale: f32,
    padding: f32,
    nodes: &'a [BinaryNode],
    references: &'a [Reference],
}

impl Source<'_> {
    /// The children of the wide node that `subtree` becomes.
    fn lanes(&self, subtree: Subtree) -> Lanes {
        let mut lanes = Lanes::default();
        self.open(subtree, WIDTH, &mut lanes);
        lanes
    }

    /// Let a subtree stand as at most `children` lanes, as planned.
    fn open(&self, subtree: Subtree, children: usize, lanes: &mut Lanes) {
        match self.nodes[subtree.index].content {
            Content::Leaf { kind, .. } => lanes.push(Lane { subtree, leaf: Some(kind) }),
            Content::Interior { plan, .. } if children == 1 => {
                lanes.push(Lane { subtree, leaf: plan.is_leaf().then(|| self.kind(subtree)) });
            }
            Content::Interior { right, plan } => match plan.left_share(children) {
                Some(share) => {
                    let [left, right] = subtree.children(right);
                    self.open(left, share, lanes);
                    self.open(right, children - share, lanes);
                }
                None => self.open(subtree, children - 1, lanes),
            },
        }
    }

    /// The kind of the first leaf under `subtree`.
    fn kind(&self, subtree: Subtree) -> LeafKind {
        match self.nodes[subtree.index + 1 - subtree.len].content {
            Content::Leaf { kind, .. } => kind,
            Content::Interior { .. } => unreachable!("the first node of a subtree is a leaf"),
        }
    }

    /// The primitives of the leaf that `subtree` becomes, in order.
    fn primitives_of(&self, subtree: Subtree, ids: &mut Vec<u32>) {
        ids.clear();
        for node in &self.nodes[subtree.index + 1 - subtree.len..=subtree.index] {
            if let Content::Leaf { first, count, .. } = node.content {
                let references = &self.references[first as usize..(first + count) as usize];
                ids.extend(references.iter().map(Reference::primitive));
            }
        }
        if subtree.len > 1 {
            // Parts of one primitive meet again.
            ids.sort_unstable();
            ids.dedup();
        }
    }

    /// Sizes of everything under the wide node of `subtree`, without the node itself.
    fn count_under(&self, subtree: Subtree) -> Sizes {
        let lanes = self.lanes(subtree);
        let mut sizes = Sizes::default();
        if subtree.len > PARALLEL {
            let interiors: Vec<Subtree> = lanes.interiors().collect();
            let counted: Vec<Sizes> = interiors.into_par_iter().map(|child| self.count_under(child)).collect();
            counted.into_iter().for_each(|child| sizes += child);
        } else {
            lanes.interiors().for_each(|child| sizes += self.count_under(child));
        }
        let interiors = lanes.interiors().count();
        sizes.nodes += interiors;
        sizes.depth += usize::from(interiors > 0);
        let mut ids = Vec::new();
        for Lane { subtree, leaf } in lanes.iter() {
            if let Some(kind) = leaf {
                self.primitives_of(subtree, &mut ids);
                sizes.leaves += 1;
                sizes.references += ids.len();
                sizes.blocks[kind as usize] += ids.len().div_ceil(BLOCK);
            }
        }
        sizes
    }

    /// Write the wide node of `subtree` into `slot`, its leaves and the subtrees of its children.
    fn write_parallel(&self, subtree: Subtree, slot: &mut Node, mut room: Room<'_>) {
        if subtree.len <= PARALLEL {
            return self.write(subtree, slot, &mut room, &mut Vec::new());
        }
        let (interiors, slots) = self.write_node(subtree, slot, &mut room, &mut Vec::new());
        let sizes: Vec<Sizes> = interiors.par_iter().map(|&child| self.count_under(child)).collect();
        let rooms: Vec<Room<'_>> = sizes.iter().map(|sizes| room.take(sizes)).collect();
        let jobs = interiors.into_par_iter().zip(slots).zip(rooms);
        jobs.for_each(|((child, slot), room)| self.write_parallel(child, slot, room));
    }

    fn write(&self, subtree: Subtree, slot: &mut Node, room: &mut Room<'_>, ids: &mut Vec<u32>) {
        let (interiors, slots) = self.write_node(subtree, slot, room, ids);
        for (child, slot) in interiors.into_iter().zip(slots) {
            self.write(child, slot, room, ids);
        }
    }

    /// Write one node and its leaves; return the subtrees under it with the places of their nodes.
    fn write_node<'r>(
        &self,
        subtree: Subtree,
        slot: &mut Node,
        room: &mut Room<'r>,
        ids: &mut Vec<u32>,
    ) -> (Vec<Subtree>, &'r mut [Node]) {
        let lanes = self.lanes(subtree);
        let interiors: Vec<Subtree> = lanes.interiors().collect();
        let Run { items: slots, first } = room.nodes.take(interiors.len());
        let mut next = first;
        let (mut boxes, mut children) = ([Aabb::EMPTY; WIDTH], [Child::UNUSED; WIDTH]);
        for (lane, Lane { subtree, leaf }) in lanes.iter().enumerate() {
            boxes[lane] = self.nodes[subtree.index].bounds.grown(self.padding);
            children[lane] = match leaf {
                Some(kind) => {
                    self.primitives_of(subtree, ids);
                    self.write_leaf(kind, ids, room)
                }
                None => {
                    next += 1;
                    Child::interior(next - 1)
                }
            };
        }
        *slot = Node::new(&boxes, &children);
        (interiors, slots)
    }

    fn write_leaf(&self, kind: LeafKind, ids: &[u32], room: &mut Room<'_>) -> Child {
        let count = ids.len().div_ceil(BLOCK);
        let (primitives, scale) = (self.primitives, self.scale);
        let first = match kind {
            LeafKind::Triangles => {
                write_blocks(room.triangles.take(count), ids, |ids| TriangleBlock::new(primitives, scale, ids))
            }
            LeafKind::Spheres => {
                write_blocks(room.spheres.take(count), ids, |ids| SphereBlock::new(primitives, scale, ids))
            }
            LeafKind::Shapes => write_blocks(room.shapes.take(count), ids, ShapeBlock::new),
        };
        Child::leaf(kind, first, count)
    }
}

/// Make a block of every eight primitives; returns the number of the first block.
fn write_blocks<B>(run: Run<'_, B>, ids: &[u32], block: impl Fn(&[u32]) -> B) -> usize {
    for (slot, ids) in run.items.iter_mut().zip(ids.chunks(BLOCK)) {
        *slot = block(ids);
    }
    run.first
}
