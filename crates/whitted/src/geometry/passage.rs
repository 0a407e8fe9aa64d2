//! Whether a ray passes through a surface or only touches it.
//!
//! Edges belong to both of the triangles that share them, so that no ray slips between them: a ray exactly through an
//! edge hits both, and one through a vertex hits all around it. Who counts surfaces wants the edge once. The rule here
//! is *simulation of simplicity* (Edelsbrunner, Mücke 1990): the ray is moved aside by (ε, ε²) in sheared space, where ε
//! is smaller than any number. Then it goes through no edge and no vertex of anything, and crosses a closed surface as
//! often inward as outward. Edge functions have the exact sign, so the rule needs to be asked only where one is 0.

use super::triangle::{ShearedRay, ShearedRays, Triangle, renamed, sheared};
use crate::math::Vec3f;
use simd::{F32Lanes, Scalar, ScalarF32};

type One = ScalarF32<1>;

/// How a ray meets a triangle that it hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Passage {
    /// The ray moved aside by an infinitesimal amount hits the triangle too.
    pub passes: bool,
    /// The edge or vertex through which the ray goes; `None` where it goes through the inside.
    pub seam: Option<Seam>,
}

/// An edge or vertex, by the places of its ends, and the side from which the ray comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Seam {
    /// Bit patterns of the ends' coordinates in order; a vertex is an edge with equal ends.
    ends: [[u32; 3]; 2],
    is_front: bool,
}

impl Triangle {
    /// How `ray`, which hits the triangle, meets it; coordinates of the ray are those of the triangle times `scale`.
    pub(crate) fn passage(&self, ray: &ShearedRay, scale: f32) -> Passage {
        let [a, b, c] = self.vertices.map(|vertex| project(vertex, ray, scale));
        // Each edge lies opposite to the vertex of the same number.
        let edges = [(c, b), (a, c), (b, a)];
        let sides = edges.map(|(p, q)| edge_function(p, q));
        let moved = edges.map(|(p, q)| moved_edge_function(p, q));
        let passes = moved.iter().all(|&side| side > 0.0) || moved.iter().all(|&side| side < 0.0);
        let is_front = sides.iter().any(|&side| side > 0.0);
        Passage { passes, seam: self.seam(sides.map(|side| side == 0.0), is_front) }
    }

    fn seam(&self, on: [bool; 3], is_front: bool) -> Option<Seam> {
        let [a, b, c] = self.vertices;
        let ends = match on {
            [false, false, false] => return None,
            [true, false, false] => [b, c],
            [false, true, false] => [c, a],
            [false, false, true] => [a, b],
            [false, true, true] => [a, a],
            [true, false, true] => [b, b],
            [true, true, _] => [c, c],
        };
        let mut ends = ends.map(place);
        ends.sort_unstable();
        Some(Seam { ends, is_front })
    }
}

/// The coordinates' bits; both zeros are the same place.
fn place(vertex: Vec3f) -> [u32; 3] {
    vertex.to_array().map(|coordinate| (coordinate + 0.0).to_bits())
}

/// Where a vertex lies in the plane across the sheared ray, by the formula of the walks.
fn project(vertex: Vec3f, ray: &ShearedRay, scale: f32) -> [f32; 2] {
    let axes = renamed((ray.axis % 3) as usize);
    let vertex = axes.map(|axis| One::splat(Scalar, vertex[axis] * scale));
    let rays = ShearedRays::splat(Scalar, ray);
    let [x, y, _] = sheared(vertex, rays.origin, rays.shear);
    [value(x), value(y)]
}

/// On which side of the edge from `p` to `q` the origin lies: as in the walks, with the exact sign.
fn edge_function([px, py]: [f32; 2], [qx, qy]: [f32; 2]) -> f64 {
    // Products of two f32 are exact in f64.
    let [px, py, qx, qy] = [px, py, qx, qy].map(f64::from);
    px * qy - qx * py
}

/// On which side of the edge the point (ε, ε²) lies: never on it, unless its ends coincide.
fn moved_edge_function(p: [f32; 2], q: [f32; 2]) -> f64 {
    let side = edge_function(p, q);
    // The terms with ε and ε² of (p − (ε, ε²)) × (q − (ε, ε²)).
    let (first, second) = (f64::from(p[1]) - f64::from(q[1]), f64::from(q[0]) - f64::from(p[0]));
    if side != 0.0 {
        side
    } else if first != 0.0 {
        first
    } else {
        second
    }
}

fn value(lane: One) -> f32 {
    let mut out = [0.0];
    lane.store(&mut out);
    out[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    /// The number of triangles of a fan around the origin's vertical line that a vertical ray passes.
    fn passes(rim: &[[f32; 3]], center: [f32; 3], closed: bool) -> usize {
        let ray = ShearedRay::new(Vec3::new(0.0, 0.0, 9.0), Vec3::new(0.0, 0.0, -1.0));
        let count = if closed { rim.len() } else { rim.len() - 1 };
        let fan = (0..count).map(|i| [center, rim[i], rim[(i + 1) % rim.len()]]);
        let triangles = fan.map(|corners| Triangle { vertices: corners.map(Into::into) });
        triangles.filter(|triangle| triangle.passage(&ray, 1.0).passes).count()
    }

    #[test]
    fn a_vertex_inside_a_fan_is_passed_once() {
        for sides in [3, 4, 8, 31] {
            let angle = |i: usize| i as f64 * std::f64::consts::TAU / sides as f64;
            let rim: Vec<[f32; 3]> = (0..sides).map(|i| [angle(i).cos() as f32, angle(i).sin() as f32, 0.0]).collect();
            assert_eq!(passes(&rim, [0.0, 0.0, 1.0], true), 1, "{sides} triangles");
        }
    }

    #[test]
    fn an_apex_at_the_rim_is_passed_twice_or_not_at_all() {
        // All triangles lie on one side of the ray, and the fan closes: the ray touches its apex.
        for turn in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
            let rim = [[1.0, 1.0, 0.0], [2.0, 3.0, 1.0], [3.0, 1.0, 0.0], [2.0, 0.5, 0.0]];
            let rim = rim.map(|[x, y, z]: [f32; 3]| [x * turn[0], y * turn[1], z]);
            let found = passes(&rim, [0.0; 3], true);
            assert!(found == 0 || found == 2, "{found}");
        }
    }

    #[test]
    fn an_edge_between_two_triangles_is_passed_once() {
        let ray = ShearedRay::new(Vec3::new(0.0, 0.0, 9.0), Vec3::new(0.0, 0.0, -1.0));
        for (p, q) in [([1.0, 1.0], [-1.0, -1.0]), ([1.0, 0.0], [-3.0, 0.0]), ([0.0, 2.0], [0.0, -0.5])] {
            let side = [q[1] - p[1], p[0] - q[0]];
            let at = |[x, y]: [f32; 2], z: f32| Vec3::new(x, y, z);
            let left = Triangle { vertices: [at(p, 0.0), at(q, 1.0), at(side, 0.3)] };
            let right = Triangle { vertices: [at(q, 1.0), at(p, 0.0), at([-side[0], -side[1]], -0.3)] };
            let found = [left, right].map(|triangle| triangle.passage(&ray, 1.0));
            assert_eq!(found.iter().filter(|passage| passage.passes).count(), 1, "{p:?} {q:?}");
            assert_eq!(found[0].seam, found[1].seam);
            assert!(found[0].seam.is_some());
        }
    }
}
