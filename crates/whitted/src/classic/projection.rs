//! The paper's triangle test (§2.2.1; Wald, "Realtime Ray Tracing and Interactive Global Illumination", 2004, §7.1).
//!
//! What does not depend on the ray is computed beforehand. The distance to the plane comes first, since most triangles
//! are rejected by it; then the point is tested in the coordinate plane in which the triangle is largest.

use super::ray::CastRay;
use crate::geometry::triangle::{dominant_axis, renamed};
use crate::math::Vec3f;

/// A triangle with its plane solved for one axis and its edges in the other two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projected {
    /// The axis along which the normal is longest; u and v are the others.
    axis: u32,
    /// The plane: `p[axis] + normal[0] · p[u] + normal[1] · p[v] = distance`.
    normal: [f32; 2],
    distance: f32,
    /// Vertex A in the plane of u and v.
    corner: [f32; 2],
    /// Dot products with h, the way from A to the point: its coordinates along the edges from A.
    to_beta: [f32; 2],
    to_gamma: [f32; 2],
}

impl Projected {
    /// `None` for a triangle without area.
    pub(super) fn new([a, b, c]: [Vec3f; 3]) -> Option<Self> {
        let (a, to_c, to_b) = (a.to_f64(), (c - a).to_f64(), (b - a).to_f64());
        let normal = to_b.cross(to_c);
        let axis = dominant_axis(normal.to_f32());
        let [u, v, k] = renamed(axis);
        // Twice the area of the projection. With b = C' − A', c = B' − A', h = H' − A' as in the paper:
        // β = (b_u h_v − b_v h_u) / (b_u c_v − b_v c_u), γ = (h_u c_v − h_v c_u) / (b_u c_v − b_v c_u).
        let area = to_c[u] * to_b[v] - to_c[v] * to_b[u];
        let [n_u, n_v] = [normal[u] / normal[k], normal[v] / normal[k]];
        let triangle = Self {
            axis: axis as u32,
            normal: [n_u as f32, n_v as f32],
            distance: (a[k] + n_u * a[u] + n_v * a[v]) as f32,
            corner: [a[u] as f32, a[v] as f32],
            to_beta: [(-to_c[v] / area) as f32, (to_c[u] / area) as f32],
            to_gamma: [(to_b[v] / area) as f32, (-to_b[u] / area) as f32],
        };
        (area != 0.0 && triangle.is_finite()).then_some(triangle)
    }

    fn is_finite(&self) -> bool {
        let pairs = [self.normal, self.to_beta, self.to_gamma];
        self.distance.is_finite() && pairs.iter().flatten().all(|number| number.is_finite())
    }

    /// Where the ray hits, from its start up to `limit`; NaN anywhere is a miss.
    #[inline(always)]
    pub(super) fn meet(&self, ray: &CastRay, limit: f32) -> Option<f32> {
        let [u, v, k] = renamed(self.axis as usize);
        let (o, d) = (ray.origin, ray.direction);
        let height = self.distance - o[k] - self.normal[0] * o[u] - self.normal[1] * o[v];
        let t = height / (d[k] + self.normal[0] * d[u] + self.normal[1] * d[v]);
        if !(ray.t_min <= t && t <= limit && t < f32::INFINITY) {
            return None;
        }
        let h = [o[u] + t * d[u] - self.corner[0], o[v] + t * d[v] - self.corner[1]];
        let beta = self.to_beta[0] * h[0] + self.to_beta[1] * h[1];
        let gamma = self.to_gamma[0] * h[0] + self.to_gamma[1] * h[1];
        (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0).then_some(t)
    }
}
