//! The paper's kd-tree (§2.3): planes across the axes, anywhere; leaves that refer to objects.

use super::build::{self, Split};
use super::node::{Content, Line, NodeId, PAIRS};
use crate::geometry::Primitives;
use crate::math::Aabb;
use crate::tree::Fit;

/// A kd-tree of 8-byte nodes over a scene's bounded primitives.
#[derive(Clone, Debug)]
pub struct KdTree {
    pub(super) lines: Vec<Line>,
    /// Primitives of all leaves, leaf by leaf.
    pub(super) references: Vec<u32>,
    /// Around everything, with the margin for rounding; in scaled coordinates, as all planes.
    pub(super) bounds: Aabb,
    pub(super) fit: Fit,
    report: KdReport,
}

/// What the builder made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KdReport {
    /// Nodes, leaves included.
    pub nodes: usize,
    /// Leaves.
    pub leaves: usize,
    /// Leaves without objects.
    pub empty_leaves: usize,
    /// References to objects from all leaves.
    pub references: usize,
    /// Planes between the root and the deepest leaf.
    pub depth: usize,
    /// Bytes of nodes and references.
    pub bytes: usize,
    /// Expected number of planes that a random line through the bounds meets.
    pub expected_steps: f32,
    /// Expected number of objects tested against a random line through the bounds, if nothing ends it.
    pub expected_tests: f32,
}

/// A node with its box: what Figures 1 and 2 of the paper draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell<'a> {
    /// Its place in the tree.
    pub node: NodeId,
    /// Planes between it and the root.
    pub depth: usize,
    /// What it covers, in the coordinates of the primitives.
    pub bounds: Aabb,
    /// What it is.
    pub content: CellContent<'a>,
}

/// Plane or leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellContent<'a> {
    /// Cut by a plane.
    Interior {
        /// 0, 1 or 2: the plane lies across x, y or z.
        axis: usize,
        /// Where, in the coordinates of the primitives.
        plane: f32,
    },
    /// Not cut.
    Leaf {
        /// Primitives that reach into it.
        primitives: &'a [u32],
    },
}

impl KdTree {
    /// Build the tree. Bounded in time, memory and depth for any input; uses the current rayon pool.
    pub fn build(primitives: &Primitives, split: Split) -> Self {
        Self::build_until(primitives, split, &|| false)
    }

    /// As [`build`](Self::build), until `stop` says so: what was not divided by then stays in large leaves. Such a tree
    /// finds the same hits, slowly. `stop` is asked before each node, from any thread; the first node of a million
    /// primitives takes about a second.
    pub fn build_until(primitives: &Primitives, split: Split, stop: &(dyn Fn() -> bool + Sync)) -> Self {
        let fit = Fit::new(primitives.bounds());
        let (lines, references, bounds) = build::build(primitives, fit, split, stop);
        let mut tree = Self { lines, references, bounds, fit, report: KdReport::default() };
        tree.report = tree.count();
        tree
    }

    /// What was built.
    pub fn report(&self) -> KdReport {
        self.report
    }

    /// The box of the root, in the coordinates of the primitives.
    pub fn bounds(&self) -> Aabb {
        divided(self.bounds, self.fit.scale())
    }

    /// Every node, parents before children, lower before upper.
    pub fn cells(&self) -> impl Iterator<Item = Cell<'_>> {
        self.scaled_cells().map(|cell| cell.divided_by(self.fit.scale()))
    }

    /// As [`cells`](Self::cells), in the coordinates of the tree.
    fn scaled_cells(&self) -> Cells<'_> {
        Cells { tree: self, waiting: vec![(NodeId::ROOT, 0, self.bounds)] }
    }

    #[inline(always)]
    pub(super) fn content(&self, node: NodeId) -> Content {
        let (line, pair, side) = node.place();
        self.lines[line].0[pair].0[side].content()
    }

    #[inline(always)]
    pub(super) fn leaf(&self, first: usize, count: usize) -> &[u32] {
        &self.references[first..first + count]
    }

    fn count(&self) -> KdReport {
        let mut report = KdReport { bytes: size_of_val(&self.lines[..]), ..KdReport::default() };
        report.bytes += size_of_val(&self.references[..]);
        let whole = self.bounds.half_area().max(f32::MIN_POSITIVE);
        for cell in self.scaled_cells() {
            let share = cell.bounds.half_area() / whole;
            report.nodes += 1;
            report.depth = report.depth.max(cell.depth);
            match cell.content {
                CellContent::Interior { .. } => report.expected_steps += share,
                CellContent::Leaf { primitives } => {
                    report.leaves += 1;
                    report.empty_leaves += usize::from(primitives.is_empty());
                    report.references += primitives.len();
                    report.expected_tests += share * primitives.len() as f32;
                }
            }
        }
        report
    }

    /// Check every invariant of the structure; tests call it after every build.
    ///
    /// # Errors
    /// The first violation found.
    pub fn validate(&self, primitives: &Primitives) -> Result<(), String> {
        if self.lines.as_ptr().align_offset(align_of::<Line>()) != 0 || size_of::<Line>() != 8 * 2 * PAIRS {
            return Err("lines are not cache lines".to_owned());
        }
        let mut seen = vec![false; primitives.bounded_count()];
        for cell in self.scaled_cells() {
            match cell.content {
                CellContent::Interior { axis, plane }
                    if cell.bounds.lo[axis] < plane && plane < cell.bounds.hi[axis] => {}
                CellContent::Interior { plane, .. } => {
                    return Err(format!("{:?}: plane {plane} outside {:?}", cell.node, cell.bounds));
                }
                CellContent::Leaf { primitives: found } => {
                    for &id in found {
                        let bounds = primitives.primitive_bounds(id).ok_or(format!("{id} can never be hit"))?;
                        let room = multiplied(bounds, self.fit.scale()).grown(self.fit.padding());
                        if room.intersection(cell.bounds).is_empty() {
                            return Err(format!("{:?}: {id} at {room:?} is not in {:?}", cell.node, cell.bounds));
                        }
                        seen[id as usize] = true;
                    }
                }
            }
        }
        let lost = (0..seen.len()).find(|&id| !seen[id] && primitives.primitive_bounds(id as u32).is_some());
        lost.map_or(Ok(()), |id| Err(format!("primitive {id} is in no leaf")))
    }
}

/// Visits the nodes of a tree; those that wait, nearest last.
struct Cells<'a> {
    tree: &'a KdTree,
    waiting: Vec<(NodeId, usize, Aabb)>,
}

impl<'a> Iterator for Cells<'a> {
    type Item = Cell<'a>;

    fn next(&mut self) -> Option<Cell<'a>> {
        let (node, depth, bounds) = self.waiting.pop()?;
        let content = match self.tree.content(node) {
            Content::Leaf { first, count } => CellContent::Leaf { primitives: self.tree.leaf(first, count) },
            Content::Interior { axis, plane, pair } => {
                let [below, above] = halves(bounds, axis, plane);
                self.waiting.push((NodeId::child(pair, true), depth + 1, above));
                self.waiting.push((NodeId::child(pair, false), depth + 1, below));
                CellContent::Interior { axis, plane }
            }
        };
        Some(Cell { node, depth, bounds, content })
    }
}

impl Cell<'_> {
    fn divided_by(self, scale: f32) -> Self {
        let content = match self.content {
            CellContent::Interior { axis, plane } => CellContent::Interior { axis, plane: plane / scale },
            leaf => leaf,
        };
        Self { bounds: divided(self.bounds, scale), content, ..self }
    }
}

/// From the tree's coordinates to the caller's.
fn divided(bounds: Aabb, scale: f32) -> Aabb {
    Aabb::new(bounds.lo / scale, bounds.hi / scale)
}

/// From the caller's coordinates to the tree's.
pub(super) fn multiplied(bounds: Aabb, scale: f32) -> Aabb {
    Aabb::new(bounds.lo * scale, bounds.hi * scale)
}

/// The parts of a box below and above a plane.
pub(super) fn halves(bounds: Aabb, axis: usize, plane: f32) -> [Aabb; 2] {
    let (mut hi, mut lo) = (bounds.hi.to_array(), bounds.lo.to_array());
    (hi[axis], lo[axis]) = (plane, plane);
    [Aabb::new(bounds.lo, hi.into()), Aabb::new(lo.into(), bounds.hi)]
}
