//! Lists of rays through the wide tree.
//!
//! A list of ray numbers goes down the tree together. At a node, the planes stay in registers while the rays pass by:
//! each ray gives a mask of the children that it enters, without a branch or a dependency on the ray before it. Then,
//! child by child from far to near, the numbers of the rays that enter it are appended to a buffer that works as a
//! stack: the nearest child lies on top (the farthest, for shadow rays from a light). At a leaf, the rays pass by the
//! primitives, sixteen abreast where that pays. Measured in a prototype, this is worth 1.3–3× over the best single-ray
//! walk, because nothing is mispredicted and nothing waits.
//!
//! Rays are first sorted by octant, so that all rays of a list enter a box through the same three planes.

use super::abreast;
use super::single::{self, Stack};
use super::slabs::Slabs;
use super::{PreparedRays, Walk};
use crate::tree::goal::Goal;
use crate::tree::node::{Child, ChildKind, Node, WIDTH};
use crate::tree::query::{CHUNK, Counts};
use simd::Simd;

/// Lists shorter than this are walked ray by ray, in turns: a node costs more to load than it saves.
const MIN_LIST: usize = 8;

/// The same in trees that no cache holds: rays in turns hide the waiting.
const MIN_LIST_FAR: usize = 14;

const _: () = assert!(MIN_LIST_FAR <= single::WAYS + 1, "a short list is walked at once");

/// What `append_matching` may overwrite beyond a list.
const SPARE: usize = 32;

/// Memory of the walk.
#[derive(Debug, Default)]
pub(in crate::tree) struct Lists {
    /// Ray numbers of all waiting lists, the one to be worked off next on top.
    ids: Vec<u16>,
    /// The rays of each octant.
    octants: [Vec<u16>; 8],
    /// The list at hand.
    current: Vec<u16>,
    /// The children that each ray of the list at hand enters.
    masks: Vec<u16>,
    /// Waiting lists: child and length.
    waiting: Vec<(Child, usize)>,
    pub(super) stack: Stack,
}

/// Walk all rays that have records, at most `together` in a list.
#[inline(always)]
pub(super) fn walk<S: Simd, G: Goal>(token: S, walk: &mut Walk<'_, G>, together: usize, counts: &mut Counts) {
    assert!(walk.rays.len() <= CHUNK, "ray numbers fit 16 bits");
    let mut lists = std::mem::take(walk.lists);
    // Every level leaves at most 15 lists behind, each no longer than the chunk.
    let room = (walk.tree.depth() * WIDTH + 2) * walk.rays.len() + SPARE;
    if lists.ids.len() < room {
        // New memory that is zero: most of it is never used, and then costs nothing.
        lists.ids = vec![0; room];
    }
    for bucket in &mut lists.octants {
        bucket.clear();
    }
    for packet in 0..walk.rays.packets() {
        if !walk.rays.is_recorded(packet) {
            continue;
        }
        for index in walk.rays.packet(packet) {
            let ray = walk.rays.node(index);
            if ray.limit() >= ray.t_min() {
                lists.octants[walk.rays.octant[index] as usize & 7].push(index as u16);
            }
        }
    }
    for octant in 0..8 {
        let count = lists.octants[octant].len();
        let mut start = 0;
        while start < count {
            let len = together.min(count - start);
            lists.ids[..len].copy_from_slice(&lists.octants[octant][start..start + len]);
            lists.waiting.push((Child::interior(0), len));
            work_off(token, walk, &mut lists, len, octant, counts);
            start += len;
        }
    }
    *walk.lists = lists;
}

/// Work off the waiting lists, whose ray numbers fill `ids[..top]`.
#[inline(always)]
fn work_off<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    lists: &mut Lists,
    mut top: usize,
    octant: usize,
    counts: &mut Counts,
) {
    // From a light, what blocks neighbours is most of all what lies near them: the far end of the rays is visited first.
    let order = if G::ENDS_RAYS && walk.has_one_origin() { octant ^ 7 } else { octant };
    let min_list = if walk.tree.is_far() { MIN_LIST_FAR } else { MIN_LIST };
    while let Some((child, len)) = lists.waiting.pop() {
        top -= len;
        match child.decode() {
            ChildKind::Interior(_) if len < min_list => {
                single::interleaved(token, walk, &mut lists.stack, &lists.ids[top..top + len], child, counts);
            }
            ChildKind::Interior(node) => {
                counts.node_steps += len as u64;
                let node = &walk.tree.nodes[node];
                lists.current.clear();
                lists.current.extend_from_slice(&lists.ids[top..top + len]);
                lists.masks.resize(len, 0);
                let any = enter(token, node, walk.rays, &lists.current, octant, &mut lists.masks);
                let before = lists.waiting.len();
                top = distribute(token, node, order, any, lists, top);
                // While the nearest list is worked off, what the others need comes from memory.
                walk.tree.prefetch_all(lists.waiting[before..].iter().map(|&(child, _)| child));
            }
            ChildKind::Leaf { kind, first, count } => {
                for ids in lists.ids[top..top + len].chunks(abreast::LANES) {
                    walk.leaf_of_list(token, ids, kind, first, count, counts);
                }
            }
        }
    }
}

/// Compute for each ray of a list which children it enters; return the children that any enters.
#[inline(always)]
fn enter<S: Simd>(token: S, node: &Node, rays: &PreparedRays, ids: &[u16], octant: usize, masks: &mut [u16]) -> u16 {
    // The question is asked here, not for each ray.
    match rays.any_slack() {
        true => enter_each::<S, true>(token, node, rays, ids, octant, masks),
        false => enter_each::<S, false>(token, node, rays, ids, octant, masks),
    }
}

/// `SLACK`: near and far planes need different offsets.
#[inline(always)]
fn enter_each<S: Simd, const SLACK: bool>(
    token: S,
    node: &Node,
    rays: &PreparedRays,
    ids: &[u16],
    octant: usize,
    masks: &mut [u16],
) -> u16 {
    let slabs = Slabs::load(token, node, octant);
    let mut any = 0;
    for (mask, &id) in masks.iter_mut().zip(ids) {
        let ray = rays.node(id as usize);
        let far = if SLACK { rays.far(id as usize) } else { ray.near() };
        *mask = slabs.enter(token, ray, far).0;
        any |= *mask;
    }
    any
}

/// Push a list for each child in `any`, the nearest of rays of an octant last; return the new top of the ray numbers.
#[inline(always)]
fn distribute<S: Simd>(token: S, node: &Node, octant: usize, any: u16, lists: &mut Lists, mut top: usize) -> usize {
    for lane in node.order(octant) {
        let bit = 1u16 << (lane & 15);
        if any & bit == 0 {
            continue;
        }
        let len = token.append_matching(&lists.masks, &lists.current, bit, &mut lists.ids[top..]);
        lists.waiting.push((node.child((lane & 15) as usize), len));
        top += len;
    }
    top
}
