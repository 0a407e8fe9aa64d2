//! Sections: what planes across an axis cut out of primitives, many planes at a time.
//!
//! The part of a triangle between two planes is the convex hull of its vertices between them and of its sections with
//! both. So one pass over the triangles gives the boxes of all parts between all neighbouring planes.

use super::Bounds;
use super::clip::Solid;
use super::reference::Reference;
use simd::{F32Lanes, Simd};

/// Planes that are cut at a time.
pub(super) const PLANES: usize = 16;

/// For each plane the box of a section in the two axes that follow the planes' own cyclically: lower corner, negated upper
/// corner; +∞ where there is none.
#[derive(Clone, Copy)]
pub(super) struct Sections<F>(pub [F; 4]);

impl<F: F32Lanes<Array = [f32; PLANES]>> Sections<F> {
    #[inline(always)]
    pub(super) fn empty(token: F::Token) -> Self {
        Self([F::splat(token, f32::INFINITY); 4])
    }

    #[inline(always)]
    pub(super) fn union(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a.min(e), b.min(f), c.min(g), d.min(h)])
    }

    #[inline(always)]
    fn intersection(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a.max(e), b.max(f), c.max(g), d.max(h)])
    }

    #[inline(always)]
    fn around_box(token: F::Token, bounds: &Bounds, [u, v]: [usize; 2]) -> Self {
        let row = |value| F::splat(token, value);
        Self([row(bounds.lo(u)), row(bounds.lo(v)), row(-bounds.hi(u)), row(-bounds.hi(v))])
    }

    /// Grow by a point per plane where `mask` is set.
    #[inline(always)]
    fn include(&mut self, token: F::Token, mask: F::Mask, [u, v]: [F; 2]) {
        let none = F::splat(token, f32::INFINITY);
        let points = [u, v, -u, -v];
        for row in 0..4 {
            self.0[row] = F::select(mask, points[row], none).min(self.0[row]);
        }
    }
}

/// The axes that follow `axis`.
#[inline(always)]
pub(super) fn following(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

/// The sections of the part of a primitive that is in `reference` with `planes` across `axis`; those outside the reference
/// are empty.
#[inline(always)]
pub(super) fn sections<S: Simd>(
    token: S,
    solid: &Solid,
    reference: &Reference,
    axis: usize,
    planes: S::F32x16,
) -> Sections<S::F32x16> {
    let bounds = reference.bounds();
    let (lo, hi) = (S::F32x16::splat(token, bounds.lo(axis)), S::F32x16::splat(token, bounds.hi(axis)));
    let inside = lo.lt(planes) & planes.lt(hi);
    let whole = Sections::<S::F32x16>::around_box(token, bounds, following(axis));
    let found = match solid {
        Solid::Triangle(vertices) => {
            // Comparisons with NaN are false: such a plane crosses no edge.
            let planes = S::F32x16::select(inside, planes, S::F32x16::splat(token, f32::NAN));
            triangle(token, vertices, axis, planes)
        }
        Solid::Sphere { center, radius } => sphere(token, *center, *radius, axis, planes, inside),
        Solid::Boxed => {
            let mut found = Sections::empty(token);
            found.include(token, inside, [whole.0[0], whole.0[1]]);
            found.include(token, inside, [-whole.0[2], -whole.0[3]]);
            found
        }
    };
    found.intersection(whole)
}

/// Where each plane crosses the edges.
#[inline(always)]
fn triangle<S: Simd>(token: S, vertices: &[[f32; 3]; 3], axis: usize, planes: S::F32x16) -> Sections<S::F32x16> {
    let [u, v] = following(axis);
    let mut found = Sections::empty(token);
    for corner in 0..3 {
        let (from, to) = (&vertices[corner], &vertices[(corner + 1) % 3]);
        let (start, end) = (S::F32x16::splat(token, from[axis]), S::F32x16::splat(token, to[axis]));
        let crossed = start.lt(planes) ^ end.lt(planes);
        // Infinite or NaN for edges along the planes, which no plane crosses.
        let share = (planes - start) * S::F32x16::splat(token, 1.0 / (to[axis] - from[axis]));
        let along_u = S::F32x16::splat(token, from[u]) + S::F32x16::splat(token, to[u] - from[u]) * share;
        let along_v = S::F32x16::splat(token, from[v]) + S::F32x16::splat(token, to[v] - from[v]) * share;
        found.include(token, crossed, [along_u, along_v]);
    }
    found
}

/// The box of the circle in each plane.
#[inline(always)]
fn sphere<S: Simd>(
    token: S,
    center: [f32; 3],
    radius: f32,
    axis: usize,
    planes: S::F32x16,
    inside: <S::F32x16 as F32Lanes>::Mask,
) -> Sections<S::F32x16> {
    let [u, v] = following(axis);
    let away = planes - S::F32x16::splat(token, center[axis]);
    let zero = S::F32x16::splat(token, 0.0);
    let circle = (S::F32x16::splat(token, radius * radius) - away * away).max(zero).sqrt();
    let (u, v) = (S::F32x16::splat(token, center[u]), S::F32x16::splat(token, center[v]));
    let mut found = Sections::empty(token);
    found.include(token, inside, [u + circle, v + circle]);
    found.include(token, inside, [u - circle, v - circle]);
    found
}
