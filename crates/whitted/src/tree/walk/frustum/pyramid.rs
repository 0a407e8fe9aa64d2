//! The four planes around a packet, and what lies outside of them.

use super::super::Walk;
use super::LANES;
use super::group::Group;
use super::packet::{Frame, Packet};
use crate::geometry::triangle::renamed;
use crate::tree::goal::Goal;
use crate::tree::leaf::{SphereBlock, TriangleBlock};
use crate::tree::node::Node;
use simd::{F32Lanes, MaskLanes, Simd, U32Lanes};
use std::ops::Range;

/// The pyramid around a packet, in renamed axes: planes `x − slope·z = offset`, the apex being the origin.
pub(super) struct Pyramid {
    pub(super) axes: [usize; 3],
    backward: bool,
    apex: [f32; 3],
    /// Slopes of the planes below and above along x, then y, to the distance along the dominant axis.
    slope: [[f32; 2]; 2],
    /// How long their normals are, for spheres.
    length: [[f32; 2]; 2],
    /// How far outside its box a primitive may be found (padding included), and outside of itself.
    slack: f32,
    primitive_slack: f32,
    /// Distance along the dominant axis beyond which no ray goes.
    pub(super) reach: f32,
}

impl Pyramid {
    #[inline(always)]
    pub(super) fn around<S: Simd, G: Goal>(token: S, walk: &Walk<'_, G>, packet: &Packet, part: Range<usize>) -> Self {
        let Frame { axis, backward, .. } = packet.frame;
        let axes = renamed(axis);
        let distance = packet.origin.abs().max_component();
        // Slopes are taken to the distance along the axis, which is positive, not to the coordinate.
        let sign = S::F32x16::splat(token, if backward { -1.0 } else { 1.0 });
        let slope =
            [range(token, &packet.groups[part.clone()], 0, sign), range(token, &packet.groups[part.clone()], 1, sign)];
        Self {
            axes,
            backward,
            apex: [packet.origin[axes[0]], packet.origin[axes[1]], packet.origin[axes[2]]],
            slope,
            length: [[length(slope[0][0]), length(slope[0][1])], [length(slope[1][0]), length(slope[1][1])]],
            slack: walk.tree.packet_slack(distance),
            primitive_slack: walk.tree.primitive_slack(distance),
            reach: packet.reach(token, part),
        }
    }

    /// The boxes that the pyramid touches, and how far along the dominant axis they begin.
    #[inline(always)]
    pub(super) fn enter<S: Simd>(&self, token: S, node: &Node) -> (u16, S::F32x16) {
        let [x, y, z] = self.axes;
        let (lo_z, hi_z) = (node.planes(token, z), node.planes(token, 3 + z));
        let apex_z = S::F32x16::splat(token, self.apex[2]);
        // Distances along the axis at which a box begins and ends.
        let (begin, end) = if self.backward { (apex_z - hi_z, apex_z - lo_z) } else { (lo_z - apex_z, hi_z - apex_z) };
        let slack = S::F32x16::splat(token, self.slack);
        let begin = begin - slack;
        let end = end + slack;
        let mut touched = S::F32x16::splat(token, 0.0).le(end) & begin.le(S::F32x16::splat(token, self.reach));
        touched = touched & self.beside(token, 0, node.planes(token, x), node.planes(token, 3 + x), begin, end, slack);
        touched = touched & self.beside(token, 1, node.planes(token, y), node.planes(token, 3 + y), begin, end, slack);
        (touched.bits() as u16 & node.boxes(), begin)
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

    /// The triangles of a block that rays of the packet may hit: those that lie neither outside one of the four planes,
    /// nor with all of the pyramid outside one of their edges. Fills `edges` if there are any.
    #[inline(always)]
    pub(super) fn touches_triangles<S: Simd>(&self, token: S, block: &TriangleBlock, edges: &mut Edges) -> u32 {
        let a = self.seen::<S>(token, block.vertex(token, 0, self.axes));
        let b = self.seen::<S>(token, block.vertex(token, 1, self.axes));
        let c = self.seen::<S>(token, block.vertex(token, 2, self.axes));
        let slack = S::F32x8::splat(token, self.primitive_slack);
        let zero = S::F32x8::splat(token, 0.0);
        let farthest = a[2].max(b[2]).max(c[2]);
        let nearest = a[2].min(b[2]).min(c[2]);
        let mut touched = zero.le(farthest + slack) & (nearest - slack).le(S::F32x8::splat(token, self.reach));
        // How far the vertices lie at most from any ray, across.
        let mut spread = zero;
        for axis in 0..2 {
            let [low, high] = self.slope[axis];
            let (low, high) = (S::F32x8::splat(token, low), S::F32x8::splat(token, high));
            let below_high = [a[axis] - high * a[2], b[axis] - high * b[2], c[axis] - high * c[2]];
            let above_low = [a[axis] - low * a[2], b[axis] - low * b[2], c[axis] - low * c[2]];
            // Distance outside the upper plane, least of the three, and inside the lower one, greatest of the three.
            let outside = below_high[0].min(below_high[1]).min(below_high[2]);
            let inside = above_low[0].max(above_low[1]).max(above_low[2]);
            touched = touched & outside.le(slack) & (-slack).le(inside);
            spread = largest(spread, largest(largest_of(below_high), largest_of(above_low)));
        }
        if touched.bits().count_ones() < MIN_EDGES {
            edges.margin = [f32::INFINITY; 8];
            return touched.bits();
        }
        let depth = farthest.max(-nearest);
        let outside = self.edges(token, [a, b, c], spread + slack, depth, edges);
        (touched & !outside).bits()
    }

    /// Compute the planes through the apex and the edges; return the triangles that lie behind one of them for all rays.
    ///
    /// With the apex as origin, an edge function is linear in the slopes of a ray: its coefficients are the cross
    /// product of the edge's ends, the same for all rays. They are computed from one end and the edge itself, so that
    /// little cancels. The exact test, whose sheared coordinates are at most `spread`, is wrong by 4 ulp of `spread²`
    /// before its sign is taken; the linear form by 24 ulp of depth times the size of the triangle. Twice that is the
    /// margin. All three functions have the sign of the volume between apex and triangle where a ray that runs forward
    /// hits; triangles whose plane contains the apex, within rounding, are excluded by nothing.
    #[inline(always)]
    fn edges<F: F32Lanes<Array = [f32; 8]>>(
        &self,
        token: F::Token,
        [a, b, c]: [[F; 3]; 3],
        spread: F,
        depth: F,
        edges: &mut Edges,
    ) -> F::Mask {
        let (bc, ca, ab) = (minus(b, c), minus(c, a), minus(a, b));
        let normals = [cross(c, bc), cross(a, ca), cross(b, ab)];
        let distance = spread + depth;
        let size = largest(largest_of(bc), largest(largest_of(ca), largest_of(ab)));
        let spans = distance * size;
        let margin = F::splat(token, SPREAD_ERROR) * spread * spread + F::splat(token, SPAN_ERROR) * spans;
        let volume = a[0] * normals[0][0] + a[1] * normals[0][1] + a[2] * normals[0][2];
        let is_sure = (F::splat(token, VOLUME_ERROR) * distance * spans).lt(volume.abs());
        let margin = F::select(is_sure, margin, F::splat(token, f32::INFINITY));
        let sign = volume.to_bits() & F::U32::splat(token, 1 << 31);
        let along = F::splat(token, if self.backward { -1.0 } else { 1.0 });
        let mut outside = (-margin).lt(-margin);
        for edge in 0..3 {
            let [x, y, z] =
                [signed(normals[edge][0], sign), signed(normals[edge][1], sign), signed(normals[edge][2], sign)];
            let most = z + self.most(token, 0, x) + self.most(token, 1, y);
            outside = outside | most.lt(-margin);
            // The rays' shear is to the coordinate, not to the distance.
            (x * along).store(&mut edges.planes[edge][0]);
            (y * along).store(&mut edges.planes[edge][1]);
            z.store(&mut edges.planes[edge][2]);
        }
        margin.store(&mut edges.margin);
        outside
    }

    /// The largest product of a slope along an axis with `factor`.
    #[inline(always)]
    fn most<F: F32Lanes>(&self, token: F::Token, axis: usize, factor: F) -> F {
        let [low, high] = self.slope[axis];
        (F::splat(token, low) * factor).max(F::splat(token, high) * factor)
    }

    /// The spheres of a block that do not lie outside one plane.
    #[inline(always)]
    pub(super) fn touches_spheres<S: Simd>(&self, token: S, block: &SphereBlock) -> u32 {
        let (center, radius_squared) = block.rows(token);
        let [x, y, z] = self.axes;
        let center = self.seen::<S>(token, [center[x], center[y], center[z]]);
        let slack = S::F32x8::splat(token, self.primitive_slack);
        let radius = radius_squared.sqrt() + slack;
        let mut touched = S::F32x8::splat(token, 0.0).le(center[2] + radius)
            & (center[2] - radius).le(S::F32x8::splat(token, self.reach));
        for axis in 0..2 {
            for side in 0..2 {
                let distance = center[axis] - S::F32x8::splat(token, self.slope[axis][side]) * center[2];
                let margin = radius * S::F32x8::splat(token, self.length[axis][side]) + slack;
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

/// The least and the greatest shear of some groups along an axis, times a sign.
#[inline(always)]
fn range<F: F32Lanes<Array = [f32; LANES]>>(token: F::Token, groups: &[Group], axis: usize, sign: F) -> [f32; 2] {
    let mut span = [F::splat(token, f32::INFINITY), F::splat(token, f32::NEG_INFINITY)];
    for group in groups {
        span = group.span(token, axis, sign, span);
    }
    [span[0].reduce_min(), span[1].reduce_max()]
}

/// Of the normal of a plane with this slope.
#[inline(always)]
fn length(slope: f32) -> f32 {
    (slope * slope + 1.0).sqrt()
}

/// Fewer triangles of a block than this are not worth the planes through their edges.
const MIN_EDGES: u32 = 2;

/// Half a unit in the last place of 1.
const ULP: f32 = 1.0 / (1 << 24) as f32;

/// Twice what the exact test's sheared coordinates cost an edge function, per square of their size: see
/// [`Pyramid::edges`].
const SPREAD_ERROR: f32 = 8.0 * ULP;

/// Twice what the linear form loses, per product of distance and size of the triangle.
const SPAN_ERROR: f32 = 48.0 * ULP;

/// More than twice what the volume between apex and triangle loses, per product of squared distance and size, so that
/// beyond it the volume has the sign of the areas of all hits.
const VOLUME_ERROR: f32 = 256.0 * ULP;

/// The planes through a packet's origin and the edges of eight triangles.
#[derive(Default)]
pub(super) struct Edges {
    /// For each edge the factors of the slopes and the constant; not negative for rays inside.
    planes: [[[f32; 8]; 3]; 3],
    /// How far below 0 a ray may come out that the exact test lets through.
    margin: [f32; 8],
}

impl Edges {
    /// The planes of one triangle.
    #[inline(always)]
    pub(super) fn planes<S: Simd>(&self, token: S, lane: usize) -> Planes<S::F32x16> {
        let [bc, ca, ab] = &self.planes;
        let planes = [
            crate::geometry::splat(token, [bc[0][lane], bc[1][lane], bc[2][lane]]),
            crate::geometry::splat(token, [ca[0][lane], ca[1][lane], ca[2][lane]]),
            crate::geometry::splat(token, [ab[0][lane], ab[1][lane], ab[2][lane]]),
        ];
        Planes { planes, least: S::F32x16::splat(token, -self.margin[lane]) }
    }
}

/// The planes of one triangle in all lanes.
pub(super) struct Planes<F> {
    planes: [[F; 3]; 3],
    least: F,
}

impl<F: F32Lanes> Planes<F> {
    /// The rays with these shears that surely pass by. What is NaN is not sure.
    #[inline(always)]
    pub(super) fn exclude(&self, x: F, y: F) -> F::Mask {
        let u = self.height(0, x, y);
        let v = self.height(1, x, y);
        let w = self.height(2, x, y);
        u.min(v).min(w).lt(self.least)
    }

    #[inline(always)]
    fn height(&self, edge: usize, x: F, y: F) -> F {
        let [along_x, along_y, constant] = self.planes[edge];
        x.mul_add_fast(along_x, y.mul_add_fast(along_y, constant))
    }
}

#[inline(always)]
fn minus<F: F32Lanes>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross<F: F32Lanes>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `value` with its sign changed where the sign bit in `sign` is set.
#[inline(always)]
fn signed<F: F32Lanes>(value: F, sign: F::U32) -> F {
    F::from_bits(value.to_bits() ^ sign)
}

/// The larger of two absolute values.
#[inline(always)]
fn largest<F: F32Lanes>(a: F, b: F) -> F {
    a.abs().max(b.abs())
}

#[inline(always)]
fn largest_of<F: F32Lanes>([x, y, z]: [F; 3]) -> F {
    largest(x, largest(y, z))
}
