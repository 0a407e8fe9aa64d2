//! One ray by itself: all that the walk needs of it stays in registers from the root to the last leaf.

use super::prepared::OneRay;
use super::slabs::{SlabRay, Slabs};
use super::turns::Stack;
use super::{LeafQuery, LeafRay, Lists, intersect_leaf, planes_of_one};
use crate::geometry::sphere::SphereRay;
use crate::geometry::triangle::Refined;
use crate::geometry::{Primitives, ShearedRay};
use crate::ray::{Hit, NONE, Ray};
use crate::tree::Tree;
use crate::tree::goal::Goal;
use crate::tree::node::{Child, ChildKind, Node, WIDTH};
use crate::tree::query::Counts;
use simd::{F32Lanes, Kernel, Simd};

/// The number by which the goal knows the ray.
const INDEX: usize = 0;

/// One ray on its way through a tree: the kernel that is dispatched.
///
/// Returns what it did and the upper end of the range that is left.
pub(in crate::tree) struct Alone<'a, G> {
    pub tree: &'a Tree,
    pub primitives: &'a Primitives,
    pub ray: &'a Ray,
    pub lists: &'a mut Lists,
    pub goal: &'a mut G,
}

impl<G: Goal> Kernel for Alone<'_, G> {
    type Output = (Counts, f32);

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> (Counts, f32) {
        let Self { tree, primitives, ray, lists: Lists { stack, .. }, goal } = self;
        let mut counts = Counts::default();
        let Some(one) = OneRay::new(token, tree, primitives, ray) else {
            return (counts, f32::NEG_INFINITY);
        };
        let mut limit = ray.t_max;
        if !primitives.planes().is_empty() {
            planes_of_one(primitives, goal, INDEX, ray, &mut limit, &mut counts);
        }
        if limit >= ray.t_min {
            stack.reserve(tree.depth(), 1);
            let forms = Forms { original: ray, sheared: one.sheared, sphere: one.sphere };
            let way = Descent { tree, primitives, goal, ray: one.slabs, octant: one.octant, forms };
            limit = way.walk(token, stack, limit, &mut counts);
        }
        (counts, limit)
    }
}

/// As [`Alone`], for the hit that the goal finds.
pub(in crate::tree) struct HitAlone<'a, G>(pub Alone<'a, G>);

impl<G: Goal> Kernel for HitAlone<'_, G> {
    type Output = Hit;

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Hit {
        let Alone { tree, primitives, ray, lists, goal } = self.0;
        let (_, t) = Alone { tree, primitives, ray, lists, goal: &mut *goal }.run(token);
        refined(primitives, ray, t, goal.found(INDEX))
    }
}

/// The hit of `ray` on a primitive that a walk found at `t`; a miss of [`NONE`].
#[inline(always)]
pub(in crate::tree) fn refined(primitives: &Primitives, ray: &Ray, t: f32, primitive: u32) -> Hit {
    if primitive == NONE {
        return Hit::MISS;
    }
    let Refined { t, u, v } = primitives.refine(ray, t, primitive);
    Hit { t, u, v, primitive, instance: NONE }
}

/// The ray in the forms for leaves.
struct Forms<'a> {
    original: &'a Ray,
    sheared: ShearedRay,
    sphere: SphereRay,
}

impl LeafRay for Forms<'_> {
    #[inline(always)]
    fn t_min(&self) -> f32 {
        self.original.t_min
    }

    #[inline(always)]
    fn sheared(&self) -> ShearedRay {
        self.sheared
    }

    #[inline(always)]
    fn sphere(&self) -> SphereRay {
        self.sphere
    }

    fn original(&self) -> Ray {
        *self.original
    }
}

/// A ray within the tree.
struct Descent<'a, S: Simd, G> {
    tree: &'a Tree,
    primitives: &'a Primitives,
    goal: &'a mut G,
    ray: SlabRay<S::F32x16>,
    octant: usize,
    forms: Forms<'a>,
}

impl<S: Simd, G: Goal> Descent<'_, S, G> {
    /// Visit everything that the ray reaches, near before far; returns the limit that is left.
    #[inline(always)]
    fn walk(self, token: S, stack: &mut Stack, mut limit: f32, counts: &mut Counts) -> f32 {
        let Self { tree, primitives, goal, ray, octant, forms } = self;
        let mut waiting = 0;
        let mut next = Some(Child::interior(0));
        while let Some(child) = next {
            next = None;
            match child.decode() {
                ChildKind::Interior(node) => {
                    counts.node_steps += 1;
                    let node = &tree.nodes[node];
                    let splat_limit = S::F32x16::splat(token, limit);
                    let (mask, entry) = Slabs::load(token, node, octant).entered_by(&ray, splat_limit);
                    next = nearest::<S, G>(token, node, octant, mask, entry, stack, &mut waiting);
                }
                ChildKind::Leaf { kind, first, count } => {
                    let query = LeafQuery { tree, primitives, goal, index: INDEX };
                    intersect_leaf(token, query, kind, first..first + count, &forms, &mut limit, counts);
                }
            }
            while next.is_none() && waiting > 0 {
                waiting -= 1;
                next = (stack.entry[waiting] <= limit).then_some(Child(stack.child[waiting]));
            }
        }
        limit
    }
}

/// The nearest of the children of `mask`; the others wait.
#[inline(always)]
fn nearest<S: Simd, G: Goal>(
    token: S,
    node: &Node,
    octant: usize,
    mask: u16,
    entry: S::F32x16,
    stack: &mut Stack,
    waiting: &mut usize,
) -> Option<Child> {
    if without_lowest(mask) == 0 {
        // One or none, as most often: nothing is put in order.
        return (mask != 0).then(|| node.child(lowest(mask)));
    }
    if G::ENDS_RAYS || mask.count_ones() == 2 {
        return Some(nearest_of_few(node, mask, entry, stack, waiting));
    }
    let top = *waiting;
    let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
    let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
    *waiting += token.compress_in_order(mask, &node.order(octant), entry, node.children(), keys, values) - 1;
    Some(Child(stack.child[*waiting]))
}

/// The child of `mask` that the ray enters first; the others wait in no order, which two need not and any hit does not.
#[inline(always)]
fn nearest_of_few<F: F32Lanes<Array = [f32; WIDTH]>>(
    node: &Node,
    mask: u16,
    entry: F,
    stack: &mut Stack,
    waiting: &mut usize,
) -> Child {
    let mut entries = [0.0; WIDTH];
    entry.store(&mut entries);
    let (mut near, mut others) = (lowest(mask), without_lowest(mask));
    while others != 0 {
        let other = lowest(others);
        let is_nearer = entries[other] < entries[near];
        let far = if is_nearer { near } else { other };
        near = if is_nearer { other } else { near };
        (stack.entry[*waiting], stack.child[*waiting]) = (entries[far], node.child(far).0);
        *waiting += 1;
        others = without_lowest(others);
    }
    node.child(near)
}

/// The lowest lane of a mask.
#[inline(always)]
fn lowest(mask: u16) -> usize {
    mask.trailing_zeros() as usize % WIDTH
}

#[inline(always)]
fn without_lowest(mask: u16) -> u16 {
    mask & mask.wrapping_sub(1)
}
