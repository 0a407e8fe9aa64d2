//! The builder: a binary tree by the surface area heuristic, in which object splits and spatial (kd) splits compete.
//!
//! Object splits divide the references between two boxes that may overlap; spatial splits cut space by a plane and
//! references with it (Havran 2000; as a competitor to object splits: Stich, Friedrich, Dietrich, "Spatial Splits in
//! Bounding Volume Hierarchies", HPG 2009). Both are judged by tight boxes. Cells of the `kd` tree are shrunk to their
//! content, which cuts off empty space without extra nodes.
//!
//! Work happens in one array with room to spare: a node owns a slice of it, hands parts of the room to its children,
//! and may only cut references while there is room left. That bounds references for any input.

mod bounds;
mod clip;
mod cost;
mod object_split;
mod spatial_split;

use super::TreeKind;
use super::leaf::{BLOCK, LeafKind};
use super::wide::MAX_LEAF_BLOCKS;
use crate::geometry::{Kind, Primitives};
use crate::math::Aabb;
pub(super) use bounds::Bounds;
use object_split::ObjectSplit;
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
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { kind: TreeKind::Best, traversal_cost: 1.0, intersection_cost: 3.0 }
    }
}

impl From<TreeKind> for BuildOptions {
    fn from(kind: TreeKind) -> Self {
        Self { kind, ..Self::default() }
    }
}

/// A primitive, or the part of it that lies in one cell: its box, tagged with its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    bounds: Bounds,
}

const _: () = assert!(size_of::<Reference>() == 32, "half a cache line");

impl Reference {
    /// Fills the spare room of the array.
    const NONE: Self = Self { bounds: Bounds::EMPTY };

    fn new(bounds: Aabb, primitive: u32) -> Self {
        Self { bounds: Bounds::new(bounds).tagged(primitive) }
    }

    fn with_bounds(self, bounds: Bounds) -> Self {
        Self { bounds: bounds.tagged(self.primitive()) }
    }

    pub(super) fn primitive(&self) -> u32 {
        self.bounds.tag()
    }
}

/// The box around references.
fn around(references: &[Reference]) -> Bounds {
    let mut bounds = Bounds::EMPTY;
    for reference in references {
        bounds = bounds.union(reference.bounds);
    }
    bounds
}

/// A node of the binary tree with everything under it.
#[derive(Debug)]
pub(super) enum Subtree {
    Leaf { bounds: Aabb, kind: LeafKind, first: usize, count: usize },
    Interior { bounds: Aabb, children: Box<[Subtree; 2]> },
}

impl Subtree {
    pub(super) fn bounds(&self) -> Aabb {
        match self {
            Self::Leaf { bounds, .. } | Self::Interior { bounds, .. } => *bounds,
        }
    }

    fn join(left: Self, right: Self) -> Self {
        Self::Interior { bounds: left.bounds().union(right.bounds()), children: Box::new([left, right]) }
    }
}

/// What the builder makes: leaves name ranges of `references`, which has gaps.
pub(super) struct Binary {
    /// `None` if there is nothing to hit.
    pub root: Option<Subtree>,
    pub references: Vec<Reference>,
    /// Degenerate primitives left out.
    pub dropped: usize,
}

/// Subtrees of `root` for one wide node: keeps opening the interior one of largest area until there are `width`.
pub(super) fn gather(root: &Subtree, width: usize) -> Vec<&Subtree> {
    let mut gathered = vec![root];
    while gathered.len() < width {
        let area = |i: &usize| gathered[*i].bounds().half_area();
        let interior = |i: &usize| matches!(gathered[*i], Subtree::Interior { .. });
        let Some(largest) = (0..gathered.len()).filter(interior).max_by(|a, b| area(a).total_cmp(&area(b))) else {
            break;
        };
        if let Subtree::Interior { children, .. } = gathered[largest] {
            gathered[largest] = &children[0];
            gathered.insert(largest + 1, &children[1]);
        }
    }
    gathered
}

/// Build the binary tree over all sound bounded primitives, in coordinates multiplied by `scale`.
pub(super) fn build(primitives: &Primitives, scale: f32, options: &BuildOptions) -> Binary {
    let mut references: Vec<Reference> = (0..primitives.bounded_count() as u32)
        .filter_map(|primitive| {
            let bounds = primitives.primitive_bounds(primitive)?;
            Some(Reference::new(Aabb::new(bounds.lo * scale, bounds.hi * scale), primitive))
        })
        .collect();
    let count = references.len();
    let dropped = primitives.bounded_count() - count;
    references.resize(count + spare_room(options.kind, count), Reference::NONE);
    let root_area = around(&references[..count]).half_area();
    let builder = Builder { primitives, scale, options, root_area };
    let root = (count > 0).then(|| builder.node(Cell { references: &mut references, count, first: 0, level: 0 }));
    Binary { root, references, dropped }
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
}

/// The references of a node: the first `count` of a slice whose rest is room, starting at `first` of the whole array.
struct Cell<'a> {
    references: &'a mut [Reference],
    count: usize,
    first: usize,
    level: usize,
}

impl Cell<'_> {
    fn used(&self) -> &[Reference] {
        &self.references[..self.count]
    }

    fn room(&self) -> usize {
        self.references.len() - self.count
    }
}

/// Below this level splits halve the references whatever they cost, so that no input makes the tree deep.
const MAX_COSTED_LEVEL: usize = 96;

/// Cells with more references than this build their halves in parallel.
const PARALLEL: usize = 4096;

/// So few references are not divided: half a block costs as much as a whole one.
const MIN_SPLIT: usize = 4;

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
    fn node(&self, cell: Cell<'_>) -> Subtree {
        let bounds = around(cell.used());
        let Some(split) = self.choose(&cell, bounds) else {
            return self.leaf(cell);
        };
        let (left, right) = self.apply(split, cell);
        let (left, right) = if left.count + right.count > PARALLEL {
            rayon::join(|| self.node(left), || self.node(right))
        } else {
            (self.node(left), self.node(right))
        };
        Subtree::join(left, right)
    }

    /// The cheapest split, or `None` where a leaf is cheaper still.
    fn choose(&self, cell: &Cell<'_>, bounds: Bounds) -> Option<Split> {
        let count = cell.count;
        let leaf_cost = cost::leaf(self.options, count);
        let fits_leaf = count <= MAX_LEAF_BLOCKS * BLOCK;
        if count <= MIN_SPLIT || cell.level >= MAX_COSTED_LEVEL {
            return (count > BLOCK).then_some(Split::Middle);
        }
        let object = object_split::find(self.options, cell.used(), bounds);
        let spatial =
            self.wants_spatial(object.as_ref(), bounds.half_area()).then(|| self.find_spatial(cell, bounds)).flatten();
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

    fn wants_spatial(&self, object: Option<&ObjectSplit>, area: f32) -> bool {
        match self.options.kind {
            TreeKind::None | TreeKind::Fast => false,
            TreeKind::Kd => true,
            TreeKind::Best => object.is_none_or(|split| {
                split.overlap > (MIN_OVERLAP_OF_ROOT * self.root_area).max(MIN_OVERLAP_OF_NODE * area)
            }),
        }
    }

    fn find_spatial(&self, cell: &Cell<'_>, bounds: Bounds) -> Option<SpatialSplit> {
        spatial_split::find(self, cell.used(), bounds).filter(|split| split.added <= cell.room())
    }

    /// Divide the references and the room between two children.
    fn apply<'c>(&self, split: Split, cell: Cell<'c>) -> (Cell<'c>, Cell<'c>) {
        let Cell { references, count, first, level } = cell;
        let mut cut_off = Vec::new();
        let left_count = match split {
            Split::Object(split) => partition(&mut references[..count], |r| split.is_left(r)),
            Split::Middle => count / 2,
            Split::Spatial(split) => spatial_split::cut(self, &split, &mut references[..count], &mut cut_off),
        };
        let right_count = count - left_count + cut_off.len();
        debug_assert!(left_count > 0 && right_count > 0, "a split leaves no side empty");
        let room = references.len() - left_count - right_count;
        let left_room = room * left_count / (left_count + right_count);
        let (left_len, whole_right) = (left_count + left_room, count - left_count);
        references.copy_within(left_count..count, left_len);
        let (left, right) = references.split_at_mut(left_len);
        right[whole_right..right_count].copy_from_slice(&cut_off);
        (
            Cell { references: left, count: left_count, first, level: level + 1 },
            Cell { references: right, count: right_count, first: first + left_len, level: level + 1 },
        )
    }

    /// Leaves hold one kind each and a bounded number of blocks: make as many as that takes.
    fn leaf(&self, cell: Cell<'_>) -> Subtree {
        let Cell { references, count, first, .. } = cell;
        let used = &mut references[..count];
        used.sort_unstable_by_key(Reference::primitive);
        let mut leaves = Vec::new();
        let mut start = 0;
        for run in used.chunk_by(|a, b| self.kind(a) == self.kind(b)) {
            for part in run.chunks(MAX_LEAF_BLOCKS * BLOCK) {
                leaves.push(Subtree::Leaf {
                    bounds: around(part).to_aabb(),
                    kind: self.kind(&part[0]),
                    first: first + start,
                    count: part.len(),
                });
                start += part.len();
            }
        }
        leaves.into_iter().reduce(Subtree::join).expect("a cell has at least one reference")
    }

    fn kind(&self, reference: &Reference) -> LeafKind {
        match self.primitives.kind(reference.primitive()) {
            Kind::Triangle(_) => LeafKind::Triangles,
            Kind::Sphere(_) => LeafKind::Spheres,
            Kind::Shape(_) | Kind::Plane(_) => LeafKind::Shapes,
        }
    }
}

/// Bring the references for which `is_left` holds to the front; return how many. Keeps no order.
fn partition(references: &mut [Reference], is_left: impl Fn(&Reference) -> bool) -> usize {
    let (mut front, mut back) = (0, references.len());
    while front < back {
        if is_left(&references[front]) {
            front += 1;
        } else {
            back -= 1;
            references.swap(front, back);
        }
    }
    front
}
