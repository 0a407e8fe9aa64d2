//! Sixty-four rays with one origin through the wide tree, bounded by a pyramid.
//!
//! Camera rays of a tile, or the segments from a light to neighbouring points, start at one point and run mostly along
//! one axis. The slopes of the other two axes span four planes; a box that lies outside one of them, or beyond every
//! ray's limit, is passed over by one fused multiply-add and one comparison per plane for all sixteen children, whatever
//! the number of rays. Slopes to the dominant axis never degenerate, unlike intervals of reciprocal directions, which
//! collapse where a component is near zero. Primitives of a leaf are culled by the same planes, eight at a time; each
//! survivor is tested against the rays sixteen at a time.
//!
//! A packet that straddles a silhouette would visit far too much: each has a budget, and one that exceeds it goes on as
//! a list of the stream, with what its rays have found so far.

use super::Walk;
use super::single::Stack;
use crate::geometry::sphere::{self, SphereRays};
use crate::geometry::triangle::{self, ShearedRays, dominant_axis, renamed};
use crate::math::Vec3;
use crate::ray;
use crate::tree::goal::Goal;
use crate::tree::leaf::{LeafKind, SphereBlock, TriangleBlock};
use crate::tree::query::Counts;
use crate::tree::wide::{Child, ChildKind, Node, WIDTH};
use simd::{F32Lanes, MaskLanes, Simd};

/// Rays of a packet.
pub(super) const PACKET: usize = 64;
const LANES: usize = 16;
const ROWS: usize = PACKET / LANES;

/// Primitives that a packet may test before it goes to the stream: more than this and its rays have little in common.
const BUDGET: u32 = 96;

/// A row of one value per ray.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Row([f32; PACKET]);

impl Row {
    #[inline(always)]
    fn load<S: Simd>(&self, token: S, row: usize) -> S::F32x16 {
        S::F32x16::load_slice(token, &self.0[LANES * row..])
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, row: usize, lanes: S::F32x16) {
        lanes.store_slice(&mut self.0[LANES * row..]);
    }
}

/// Rays with one origin and one dominant axis.
struct Packet {
    /// In the tree's scale.
    origin: Vec3<f32>,
    direction: [Row; 3],
    /// See [`ShearedRays::shear`].
    shear: [Row; 3],
    t_min: Row,
    limit: Row,
    axis: usize,
    /// True if the rays run towards smaller coordinates of the dominant axis.
    backward: bool,
    /// Signs of the first direction, by which children are ordered.
    octant: usize,
}

/// The pyramid around a packet, in renamed axes: planes `x − slope·z = offset`, the apex being the origin.
struct Pyramid {
    axes: [usize; 3],
    backward: bool,
    apex: [f32; 3],
    /// Slopes of the planes below and above along x, then y, to the distance along the dominant axis.
    slope: [[f32; 2]; 2],
    /// How far outside its box a primitive may be found (padding included), and outside of itself.
    slack: f32,
    primitive_slack: f32,
    /// Distance along the dominant axis beyond which no ray goes.
    reach: f32,
}

/// Follow the packet of rays from `first` on; false if it is none, or exceeded its budget: then its rays still have to
/// be walked.
#[inline(always)]
pub(super) fn walk<S: Simd, G: Goal>(
    token: S,
    walk: &mut Walk<'_, G>,
    stack: &mut Stack,
    first: usize,
    counts: &mut Counts,
) -> bool {
    let Some(mut packet) = Packet::new(token, walk, first) else { return false };
    let mut pyramid = Pyramid::around(token, walk, &packet);
    let octant = packet.octant;
    let mut budget = BUDGET;
    stack.reserve(walk.tree.depth(), 1);
    (stack.entry[0], stack.child[0]) = (f32::NEG_INFINITY, Child::interior(0).0);
    let mut top = 1;
    while top > 0 {
        top -= 1;
        if stack.entry[top] > pyramid.reach {
            continue;
        }
        match Child(stack.child[top]).decode() {
            ChildKind::Interior(node) => {
                counts.node_steps += PACKET as u64;
                let node = &walk.tree.nodes[node];
                let (mask, entry) = pyramid.enter(token, node);
                let keys = (&mut stack.entry[top..top + WIDTH]).try_into().expect("WIDTH entries");
                let values = (&mut stack.child[top..top + WIDTH]).try_into().expect("WIDTH children");
                top += token.compress_in_order(mask, &node.order[octant], entry, node.children(), keys, values);
            }
            ChildKind::Leaf { kind: LeafKind::Shapes, .. } => {
                packet.finish(walk, first);
                return false;
            }
            ChildKind::Leaf { kind, first: block, count } => {
                let mut tested = 0;
                for block in block..block + count {
                    tested += match kind {
                        LeafKind::Triangles => packet.triangles(token, &pyramid, walk, first, block),
                        _ => packet.spheres(token, &pyramid, walk, first, block),
                    };
                }
                counts.primitive_tests += u64::from(tested) * PACKET as u64;
                if tested > budget {
                    packet.finish(walk, first);
                    return false;
                }
                budget -= tested;
                if tested > 0 {
                    pyramid.reach = packet.reach(token);
                }
            }
        }
    }
    packet.finish(walk, first);
    true
}

impl Packet {
    /// The rays from `first` on, if they make a packet: full, one origin, one dominant axis and sense, no negative t.
    #[inline(always)]
    fn new<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, first: usize) -> Option<Self> {
        let start = walk.start + first;
        let rows = |row: &[f32]| Row(*row[start..].first_chunk().expect("a whole packet"));
        let (o, d) = (walk.batch.origin, walk.batch.direction);
        let apex = Vec3::new(o.x[start], o.y[start], o.z[start]);
        if !(same(token, &o.x[start..], apex.x)
            && same(token, &o.y[start..], apex.y)
            && same(token, &o.z[start..], apex.z))
        {
            return None;
        }
        let along = Vec3::new(d.x[start], d.y[start], d.z[start]);
        let axis = dominant_axis(along);
        let octant = [along.x, along.y, along.z].map(|component| usize::from(component.is_sign_negative()));
        let mut packet = Self {
            origin: apex * walk.tree.scale(),
            direction: [rows(d.x), rows(d.y), rows(d.z)],
            shear: [Row([0.0; PACKET]); 3],
            t_min: match walk.batch.t_min {
                ray::Row::Each(t_min) => rows(t_min),
                ray::Row::All(t_min) => Row([t_min; PACKET]),
            },
            limit: Row(*walk.rays.limits(first)),
            axis,
            backward: octant[axis] != 0,
            octant: octant[0] | octant[1] << 1 | octant[2] << 2,
        };
        packet.prepare(token, walk.tree.scale()).then_some(packet)
    }

    /// Scale and shear the directions; false if a ray has another dominant axis or sense, or a range that begins before
    /// its origin.
    #[inline(always)]
    fn prepare<S: Simd>(&mut self, token: S, scale: f32) -> bool {
        let [x, y, z] = renamed(self.axis);
        let zero = S::F32x16::splat(token, 0.0);
        let mut sound = zero.le(zero);
        for row in 0..ROWS {
            let scale = S::F32x16::splat(token, scale);
            let d = [
                self.direction[0].load(token, row) * scale,
                self.direction[1].load(token, row) * scale,
                self.direction[2].load(token, row) * scale,
            ];
            let (dx, dy, dz) = (d[x], d[y], d[z]);
            let ahead = if self.backward { dz.lt(zero) } else { zero.lt(dz) };
            sound = sound & ahead & dominated(dx, dz, x < z) & dominated(dy, dz, y < z);
            sound = sound & zero.le(self.t_min.load(token, row));
            self.shear[0].store::<S>(row, dx / dz);
            self.shear[1].store::<S>(row, dy / dz);
            self.shear[2].store::<S>(row, S::F32x16::splat(token, 1.0) / dz);
            self.direction[0].store::<S>(row, d[0]);
            self.direction[1].store::<S>(row, d[1]);
            self.direction[2].store::<S>(row, d[2]);
        }
        sound.all()
    }

    /// The greatest distance along the dominant axis at which a ray may still hit.
    #[inline(always)]
    fn reach<S: Simd>(&self, token: S) -> f32 {
        let mut reach = S::F32x16::splat(token, f32::NEG_INFINITY);
        for row in 0..ROWS {
            let distance = self.limit.load(token, row) * self.direction[self.axis].load(token, row).abs();
            reach = distance.max(reach);
        }
        // One rounding of the product: the next but one number up is no less than the exact one.
        let reach = reach.reduce_max();
        if reach < f32::INFINITY { reach.next_up().next_up() } else { reach }
    }

    /// Write the rays' limits back.
    #[inline(always)]
    fn finish<G: Goal>(&self, walk: &mut Walk<'_, G>, first: usize) {
        *walk.rays.limits_mut(first) = self.limit.0;
    }

    /// Test the triangles of a block that the pyramid touches; returns how many.
    #[inline(always)]
    fn triangles<S: Simd, G: Goal>(
        &mut self,
        token: S,
        pyramid: &Pyramid,
        walk: &mut Walk<'_, G>,
        first: usize,
        block: usize,
    ) -> u32 {
        let block = &walk.tree.leaves.triangles[block];
        let mut survivors = pyramid.touches_triangles(token, block);
        let count = survivors.count_ones();
        let [x, y, z] = pyramid.axes;
        let origin = [self.origin[x], self.origin[y], self.origin[z]];
        let origin = crate::geometry::splat(token, origin);
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % 8;
            survivors &= survivors - 1;
            let vertices = [
                crate::geometry::splat(token, block.corner(0, lane, pyramid.axes)),
                crate::geometry::splat(token, block.corner(1, lane, pyramid.axes)),
                crate::geometry::splat(token, block.corner(2, lane, pyramid.axes)),
            ];
            for row in 0..ROWS {
                let shear =
                    [self.shear[0].load(token, row), self.shear[1].load(token, row), self.shear[2].load(token, row)];
                let rays = ShearedRays { origin, shear };
                let limit = self.limit.load(token, row);
                let (hit, t) = triangle::intersect(token, &rays, vertices, self.t_min.load(token, row), limit);
                if hit.any() {
                    let limit = walk.goal.offer_row(token, first + LANES * row, hit, t, block.primitive(lane), limit);
                    self.limit.store::<S>(row, limit);
                }
            }
        }
        count
    }

    /// Test the spheres of a block that the pyramid touches; returns how many.
    #[inline(always)]
    fn spheres<S: Simd, G: Goal>(
        &mut self,
        token: S,
        pyramid: &Pyramid,
        walk: &mut Walk<'_, G>,
        first: usize,
        block: usize,
    ) -> u32 {
        let block = &walk.tree.leaves.spheres[block];
        let mut survivors = pyramid.touches_spheres(token, block);
        let count = survivors.count_ones();
        let origin = crate::geometry::splat(token, self.origin.to_array());
        let one = S::F32x16::splat(token, 1.0);
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % 8;
            survivors &= survivors - 1;
            let center = crate::geometry::splat(token, block.center(lane));
            let radius_squared = S::F32x16::splat(token, block.radius_squared(lane));
            for row in 0..ROWS {
                let direction = [
                    self.direction[0].load(token, row),
                    self.direction[1].load(token, row),
                    self.direction[2].load(token, row),
                ];
                let inverse_length_squared = one / Vec3::from(direction).length_squared();
                let rays = SphereRays { origin, direction, inverse_length_squared };
                let (t_min, mut limit) = (self.t_min.load(token, row), self.limit.load(token, row));
                let roots = sphere::roots(&rays, center, radius_squared);
                let (hit, t) = sphere::first_in_range(roots, t_min, limit);
                if hit.any() {
                    let id = block.primitive(lane);
                    limit = walk.goal.offer_row(token, first + LANES * row, hit, t, id, limit);
                    self.limit.store::<S>(row, limit);
                }
            }
        }
        count
    }
}

/// True where `component` does not take the place of `dominant` as the dominant one; of two equals the first does.
#[inline(always)]
fn dominated<F: F32Lanes>(component: F, dominant: F, is_first: bool) -> F::Mask {
    if is_first { component.abs().lt(dominant.abs()) } else { component.abs().le(dominant.abs()) }
}

/// True if the first [`PACKET`] values of a row equal `value`.
#[inline(always)]
fn same<S: Simd>(token: S, row: &[f32], value: f32) -> bool {
    let value = S::F32x16::splat(token, value);
    let mut equal = value.eq(value);
    for start in (0..PACKET).step_by(LANES) {
        equal = equal & S::F32x16::load_slice(token, &row[start..]).eq(value);
    }
    equal.all()
}

impl Pyramid {
    #[inline(always)]
    fn around<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, packet: &Packet) -> Self {
        let axes = renamed(packet.axis);
        let distance = packet.origin.abs().max_component();
        // Slopes are taken to the distance along the axis, which is positive, not to the coordinate.
        let sign = if packet.backward { -1.0 } else { 1.0 };
        let [x, y, _] = &packet.shear;
        Self {
            axes,
            backward: packet.backward,
            apex: axes.map(|axis| packet.origin[axis]),
            slope: [range(token, x, sign), range(token, y, sign)],
            slack: walk.tree.packet_slack(distance),
            primitive_slack: walk.tree.primitive_slack(distance),
            reach: packet.reach(token),
        }
    }

    /// The boxes that the pyramid touches, and how far along the dominant axis they begin.
    #[inline(always)]
    fn enter<S: Simd>(&self, token: S, node: &Node) -> (u16, S::F32x16) {
        let [x, y, z] = self.axes;
        let load = |row: usize| S::F32x16::load(token, &node.planes[row]);
        let (lo_z, hi_z) = (load(z), load(3 + z));
        let apex_z = S::F32x16::splat(token, self.apex[2]);
        // Distances along the axis at which a box begins and ends.
        let (begin, end) = if self.backward { (apex_z - hi_z, apex_z - lo_z) } else { (lo_z - apex_z, hi_z - apex_z) };
        let slack = S::F32x16::splat(token, self.slack);
        let begin = begin - slack;
        let end = end + slack;
        let mut touched = S::F32x16::splat(token, 0.0).le(end) & begin.le(S::F32x16::splat(token, self.reach));
        touched = touched & self.beside(token, 0, load(x), load(3 + x), begin, end, slack);
        touched = touched & self.beside(token, 1, load(y), load(3 + y), begin, end, slack);
        (touched.bits() as u16, begin)
    }

    /// The boxes of which some part lies between the two planes of one axis.
    #[inline(always)]
    fn beside<F: F32Lanes>(&self, token: F::Token, axis: usize, lo: F, hi: F, begin: F, end: F, slack: F) -> F::Mask {
        let apex = F::splat(token, self.apex[axis]);
        let [low, high] = self.slope[axis];
        // The corner of the box that lies deepest inside each plane.
        let at_high = if high >= 0.0 { end } else { begin };
        let at_low = if low >= 0.0 { begin } else { end };
        let above = F::splat(token, high).mul_add_fast(at_high, slack - (lo - apex));
        let below = F::splat(token, low).mul_add_fast(at_low, apex - hi - slack);
        let zero = F::splat(token, 0.0);
        zero.le(above) & below.le(zero)
    }

    /// The triangles of a block that do not lie outside one plane.
    #[inline(always)]
    fn touches_triangles<S: Simd>(&self, token: S, block: &TriangleBlock) -> u32 {
        let a = self.seen::<S>(token, block.vertex(token, 0, self.axes));
        let b = self.seen::<S>(token, block.vertex(token, 1, self.axes));
        let c = self.seen::<S>(token, block.vertex(token, 2, self.axes));
        let slack = S::F32x8::splat(token, self.primitive_slack);
        let zero = S::F32x8::splat(token, 0.0);
        let farthest = a[2].max(b[2]).max(c[2]);
        let nearest = a[2].min(b[2]).min(c[2]);
        let mut touched = zero.le(farthest + slack) & (nearest - slack).le(S::F32x8::splat(token, self.reach));
        for axis in 0..2 {
            let [low, high] = self.slope[axis];
            let (low, high) = (S::F32x8::splat(token, low), S::F32x8::splat(token, high));
            // Distance outside the upper plane, least of the three, and inside the lower one, greatest of the three.
            let outside = (a[axis] - high * a[2]).min(b[axis] - high * b[2]).min(c[axis] - high * c[2]);
            let inside = (a[axis] - low * a[2]).max(b[axis] - low * b[2]).max(c[axis] - low * c[2]);
            touched = touched & outside.le(slack) & (-slack).le(inside);
        }
        touched.bits()
    }

    /// The spheres of a block that do not lie outside one plane.
    #[inline(always)]
    fn touches_spheres<S: Simd>(&self, token: S, block: &SphereBlock) -> u32 {
        let (center, radius_squared) = block.rows(token);
        let [x, y, z] = self.axes;
        let center = self.seen::<S>(token, [center[x], center[y], center[z]]);
        let slack = S::F32x8::splat(token, self.primitive_slack);
        let radius = radius_squared.sqrt() + slack;
        let mut touched = S::F32x8::splat(token, 0.0).le(center[2] + radius)
            & (center[2] - radius).le(S::F32x8::splat(token, self.reach));
        for axis in 0..2 {
            for (side, slope) in self.slope[axis].into_iter().enumerate() {
                let slope = S::F32x8::splat(token, slope);
                let distance = center[axis] - slope * center[2];
                // The planes' normals are longer than one.
                let length = (slope * slope + S::F32x8::splat(token, 1.0)).sqrt();
                let margin = radius * length + slack;
                touched = touched & if side == 0 { (-margin).le(distance) } else { distance.le(margin) };
            }
        }
        touched.bits()
    }

    /// Points relative to the apex, the last coordinate as distance along the rays.
    #[inline(always)]
    fn seen<S: Simd>(&self, token: S, [x, y, z]: [S::F32x8; 3]) -> [S::F32x8; 3] {
        let [ax, ay, az] = crate::geometry::splat(token, self.apex);
        [x - ax, y - ay, if self.backward { az - z } else { z - az }]
    }
}

/// The least and the greatest value of a row times a sign.
#[inline(always)]
fn range<S: Simd>(token: S, row: &Row, sign: f32) -> [f32; 2] {
    let sign = S::F32x16::splat(token, sign);
    let (mut least, mut greatest) = (row.load(token, 0) * sign, row.load(token, 0) * sign);
    for i in 1..ROWS {
        least = least.min(row.load(token, i) * sign);
        greatest = greatest.max(row.load(token, i) * sign);
    }
    [least.reduce_min(), greatest.reduce_max()]
}
