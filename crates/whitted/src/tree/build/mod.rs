//! The builder: a binary tree by the surface area heuristic, in which object splits and spatial (kd) splits compete, made
//! wide in the cheapest way.
//!
//! Object splits divide the references between two boxes that may overlap; spatial splits cut space by a plane and
//! references with it (Havran 2000; as a competitor to object splits: Stich, Friedrich, Dietrich, "Spatial Splits in
//! Bounding Volume Hierarchies", HPG 2009). Both are judged by tight boxes. Cells of the `kd` tree are shrunk to their
//! content, which cuts off empty space without extra nodes.
//!
//! Work happens in one array with room to spare: a node owns a slice of it, hands parts of the room to its children,
//! and may only cut references while there is room left. That bounds references for any input.

mod binary;
mod bounds;
mod clip;
mod cost;
mod exact_sweep;
mod flatten;
mod growth;
mod object_split;
mod plan;
mod reference;
mod section;
mod spatial_split;

use super::leaf::{BLOCK, LeafKind};
use super::node::MAX_LEAF_BLOCKS;
use super::{Stop, TreeKind};
use crate::geometry::{Kind, Primitives};
use binary::{BinaryNode, Content};
pub(crate) use bounds::Bounds;
pub(crate) use clip::Solid;
pub(super) use cost::WIDE_NODE as WIDE_NODE_COST;
pub(super) use flatten::Flat;
use growth::Growth;
use object_split::ObjectSplit;
use plan::Costs;
use rayon::prelude::*;
use reference::{Reference, around, partition};
use simd::Level;
use spatial_split::SpatialSplit;

/// How to build a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// Which splits are allowed.
    pub kind: TreeKind,
    /// Cost of stepping into a node; default 1.
    pub traversal_cost: f32,
    /// Cost of testing a block of eight primitives, relative to `traversal_cost`; default 3.
    pub intersection_cost: f32,
    /// Try every object split instead of some: ten times slower, to compare with; default false.
    pub exact: bool,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { kind: TreeKind::Best, traversal_cost: 1.0, intersection_cost: 3.0, exact: false }
    }
}

impl From<TreeKind> for BuildOptions {
    fn from(kind: TreeKind) -> Self {
        Self { kind, ..Self::default() }
    }
}

/// Build the wide tree over all sound bounded primitives, in coordinates multiplied by `scale`; every box of the tree
/// grows by `padding`. `None` if `stop` said so.
pub(super) fn build(
    primitives: &Primitives,
    scale: f32,
    padding: f32,
    options: &BuildOptions,
    stop: Stop<'_>,
) -> Option<Flat> {
    let mut references = sound_references(primitives, scale);
    let count = references.len();
    let dropped = primitives.bounded_count() - count;
    if count == 0 {
        return Some(Flat::empty(dropped));
    }
    let bounds = around_all(&references);
    references.resize(count + spare_room(options.kind, count), Reference::NONE);
    let (root_area, growth) = (bounds.half_area(), Growth::new(references.len(), stop));
    let builder = Builder { primitives, scale, options, root_area, level: Level::best(), growth };
    let mut pieces = Vec::new();
    builder.grow(Cell { references: &mut references, count, first: 0, level: 0, bounds }, &mut pieces)?;
    let nodes = pieces.concat();
    drop(pieces);
    Some(flatten::flatten(primitives, scale, padding, &nodes, &references, dropped))
}

/// References to all primitives that can be hit, in their order.
fn sound_references(primitives: &Primitives, scale: f32) -> Vec<Reference> {
    let reference = |primitive: u32| {
        primitives.primitive_bounds(primitive).map_or(Reference::NONE, |b| Reference::new(b, primitive).scaled(scale))
    };
    let count = primitives.bounded_count() as u32;
    let mut references: Vec<Reference> = Vec::new();
    (0..count).into_par_iter().with_min_len(PARALLEL).map(reference).collect_into_vec(&mut references);
    references.retain(|r| !r.is_none());
    references
}

fn around_all(references: &[Reference]) -> Bounds {
    references.par_chunks(PARALLEL).map(around).reduce(|| Bounds::EMPTY, Bounds::union)
}

/// How many references spatial splits may add in all.
fn spare_room(kind: TreeKind, count: usize) -> usize {
    match kind {
        TreeKind::None | TreeKind::Fast => 0,
        TreeKind::Kd => 2 * count + 64,
        TreeKind::Best => count / 2 + 16,
    }
}

/// What all nodes of one build share.
struct Builder<'a> {
    primitives: &'a Primitives,
    scale: f32,
    options: &'a BuildOptions,
    root_area: f32,
    level: Level,
    growth: Growth<'a>,
}

/// The references of a node: the first `count` of a slice whose rest is room, starting at `first` of the whole array.
struct Cell<'a> {
    references: &'a mut [Reference],
    count: usize,
    first: usize,
    level: usize,
    bounds: Bounds,
}

impl Cell<'_> {
    fn used(&self) -> &[Reference] {
        &self.references[..self.count]
    }

    fn room(&self) -> usize {
        self.references.len() - self.count
    }
}

/// What a parent needs to know of a finished subtree.
struct Grown {
    bounds: Bounds,
    costs: Costs,
    /// Leaves of the binary tree.
    leaves: usize,
    references: usize,
    /// `None` for several.
    kind: Option<LeafKind>,
    /// Nodes of the binary tree.
    nodes: usize,
}

/// Below this level splits halve the references whatever they cost, so that no input makes the tree deep.
const MAX_COSTED_LEVEL: usize = 96;

/// Cells with more references than this build their halves in parallel.
const PARALLEL: usize = 4096;

/// So few references are not divided: half a block costs as much as a whole one.
const MIN_SPLIT: usize = 4;

/// Larger leaves are never made from smaller ones.
const MAX_MERGED: usize = 4 * BLOCK;

/// Spatial splits are tried where the boxes of the best object split overlap by more than this share of the root's
/// area (Stich et al. 2009, §4.5) ...
const MIN_OVERLAP_OF_ROOT: f32 = 1e-5;

/// ... and by more than this share of the node's own: halves the time of builds of fine meshes. Nodes and blocks per
/// ray rise by at most 1 % on bunny and dragon; 0.4 costs 10 % of the blocks on Sponza.
const MIN_OVERLAP_OF_NODE: f32 = 0.2;

/// The split that was chosen.
enum Split {
    Object(ObjectSplit),
    Spatial(SpatialSplit),
    /// First half, second half.
    Middle,
}

impl Builder<'_> {
    /// Build the subtree of a cell, in parallel if that is worth it, as pieces of the array of nodes. `None`: stopped.
    fn grow(&self, cell: Cell<'_>, pieces: &mut Vec<Vec<BinaryNode>>) -> Option<Grown> {
        if cell.count <= PARALLEL {
            let (mut nodes, len) = (Vec::new(), cell.references.len());
            let grown = self.node(cell, &mut nodes);
            pieces.push(nodes);
            return self.growth.goes_on_after(len).then_some(grown);
        }
        let split = self.choose(&cell).unwrap_or(Split::Middle);
        let (left, right) = self.apply(split, cell);
        let mut right_pieces = Vec::new();
        let (left, right) = rayon::join(|| self.grow(left, pieces), || self.grow(right, &mut right_pieces));
        pieces.append(&mut right_pieces);
        let mut parent = Vec::new();
        let grown = self.join(left?, right?, &mut parent);
        pieces.push(parent);
        Some(grown)
    }

    /// Build the subtree of a cell.
    fn node(&self, cell: Cell<'_>, nodes: &mut Vec<BinaryNode>) -> Grown {
        let Some(split) = self.choose(&cell) else {
            return self.leaf(cell, nodes);
        };
        let (left, right) = self.apply(split, cell);
        let left = self.node(left, nodes);
        let right = self.node(right, nodes);
        self.join(left, right, nodes)
    }

    /// Append the parent of the two subtrees that end `nodes`.
    fn join(&self, left: Grown, right: Grown, nodes: &mut Vec<BinaryNode>) -> Grown {
        let bounds = left.bounds.union(right.bounds);
        let references = left.references + right.references;
        let kind = left.kind.filter(|_| left.kind == right.kind);
        let may_merge = kind.is_some() && references <= MAX_MERGED;
        let area = bounds.half_area();
        let leaf_cost = if may_merge { area * cost::blocks(references) } else { f32::INFINITY };
        let (costs, plan) = plan::join(self.level, area, [&left.costs, &right.costs], left.leaves, leaf_cost);
        let content = Content::Interior { right: right.nodes as u32, plan };
        nodes.push(BinaryNode { bounds: bounds.to_aabb(), content });
        let leaves = left.leaves + right.leaves;
        Grown { bounds, costs, leaves, references, kind, nodes: left.nodes + right.nodes + 1 }
    }

    /// The cheapest split, or `None` where there should be a leaf.
    fn choose(&self, cell: &Cell<'_>) -> Option<Split> {
        let Cell { count, bounds, .. } = *cell;
        if count <= MIN_SPLIT || cell.level >= MAX_COSTED_LEVEL {
            return (count > BLOCK).then_some(Split::Middle);
        }
        let leaf_cost = cost::leaf(self.options, count);
        let fits_leaf = count <= MAX_LEAF_BLOCKS * BLOCK;
        let object = match self.options.exact {
            false => object_split::find(self.level, self.options, cell.used(), bounds),
            true => exact_sweep::find(self.options, cell.used(), bounds),
        };
        let spatial = self.wants_spatial(object.as_ref(), cell).then(|| self.find_spatial(cell)).flatten();
        let spatial_cost = spatial.as_ref().map_or(f32::INFINITY, |s| s.cost);
        // The kd tree takes object splits only where no plane helps and the leaf would be too large.
        let prefer_spatial = self.options.kind == TreeKind::Kd && spatial_cost < leaf_cost;
        let object_cost = match &object {
            Some(split) if !(prefer_spatial || self.options.kind == TreeKind::Kd && fits_leaf) => split.cost,
            _ => f32::INFINITY,
        };
        if fits_leaf && leaf_cost <= object_cost.min(spatial_cost) {
            return None;
        }
        match (object, spatial) {
            (_, Some(spatial)) if spatial_cost < object_cost => Some(Split::Spatial(spatial)),
            (Some(object), _) => Some(Split::Object(object)),
            // Everything lies in the same place: no split separates it.
            (None, _) => (!fits_leaf).then_some(Split::Middle),
        }
    }

    fn wants_spatial(&self, object: Option<&ObjectSplit>, cell: &Cell<'_>) -> bool {
        match self.options.kind {
            TreeKind::None | TreeKind::Fast => false,
            TreeKind::Kd => true,
            TreeKind::Best => object.is_none_or(|split| self.overlaps_much(split, cell)) && self.gains_by_cuts(cell),
        }
    }

    fn overlaps_much(&self, split: &ObjectSplit, cell: &Cell<'_>) -> bool {
        split.overlap > (MIN_OVERLAP_OF_ROOT * self.root_area).max(MIN_OVERLAP_OF_NODE * cell.bounds.half_area())
    }

    /// Whether a cell holds anything but spheres, whose parts have boxes that are hardly smaller than the whole (decision 3).
    fn gains_by_cuts(&self, cell: &Cell<'_>) -> bool {
        cell.used().iter().any(|reference| self.kind(reference) != LeafKind::Spheres)
    }

    fn find_spatial(&self, cell: &Cell<'_>) -> Option<SpatialSplit> {
        spatial_split::find(self, cell.used(), cell.bounds).filter(|split| split.added <= cell.room())
    }

    /// Divide the references and the room between two children.
    fn apply<'c>(&self, split: Split, cell: Cell<'c>) -> (Cell<'c>, Cell<'c>) {
        let Cell { references, count, first, level, .. } = cell;
        let mut cut_off = Vec::new();
        let mut left_count = match &split {
            Split::Object(split) => partition(&mut references[..count], |r| split.is_left(r)),
            Split::Middle => count / 2,
            Split::Spatial(split) => spatial_split::cut(self, split, &mut references[..count], &mut cut_off),
        };
        let total = count + cut_off.len();
        references[count..total].copy_from_slice(&cut_off);
        if left_count == 0 || left_count == total {
            // What the plane was to cut off turned out to be empty.
            left_count = total / 2;
        }
        let right_count = total - left_count;
        let room = references.len() - total;
        let left_room = (room as u64 * left_count as u64 / total as u64) as usize;
        let left_len = left_count + left_room;
        if left_room > 0 {
            references.copy_within(left_count..total, left_len);
        }
        let (left, right) = references.split_at_mut(left_len);
        let [left_bounds, right_bounds] = match split {
            Split::Object(split) => split.sides,
            _ => [around(&left[..left_count]), around(&right[..right_count])],
        };
        let level = level + 1;
        (
            Cell { references: left, count: left_count, first, level, bounds: left_bounds },
            Cell { references: right, count: right_count, first: first + left_len, level, bounds: right_bounds },
        )
    }

    /// Leaves hold one kind each and a bounded number of blocks: make as many as that takes.
    fn leaf(&self, cell: Cell<'_>, nodes: &mut Vec<BinaryNode>) -> Grown {
        let Cell { references, count, first, .. } = cell;
        let used = &mut references[..count];
        used.sort_unstable_by_key(Reference::primitive);
        let mut joined: Option<Grown> = None;
        let mut start = first;
        for run in used.chunk_by(|a, b| self.kind(a) == self.kind(b)) {
            for part in run.chunks(MAX_LEAF_BLOCKS * BLOCK) {
                let leaf = self.one_leaf(part, start, nodes);
                start += part.len();
                joined = Some(match joined {
                    Some(left) => self.join(left, leaf, nodes),
                    None => leaf,
                });
            }
        }
        joined.expect("a cell has at least one reference")
    }

    fn one_leaf(&self, references: &[Reference], first: usize, nodes: &mut Vec<BinaryNode>) -> Grown {
        let (bounds, kind, count) = (around(references), self.kind(&references[0]), references.len());
        let content = Content::Leaf { first: first as u32, count: count as u32, kind };
        nodes.push(BinaryNode { bounds: bounds.to_aabb(), content });
        let costs = [bounds.half_area() * cost::blocks(count); _];
        Grown { bounds, costs, leaves: 1, references: count, kind: Some(kind), nodes: 1 }
    }

    #[inline(always)]
    fn solid(&self, reference: &Reference) -> Solid {
        Solid::new(self.primitives, reference.primitive(), self.scale)
    }

    fn kind(&self, reference: &Reference) -> LeafKind {
        match self.primitives.kind(reference.primitive()) {
            Kind::Triangle(_) => LeafKind::Triangles,
            Kind::Sphere(_) => LeafKind::Spheres,
            Kind::Shape(_) | Kind::Plane(_) => LeafKind::Shapes,
        }
    }
}
