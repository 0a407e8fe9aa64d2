//! What lamps send to surfaces, before anything stands in the way: once for any number of points.

use super::rows::{BLOCK, Rows, first_lanes};
use super::shadow::ShadowBatch;
use crate::geometry::triangle::ERROR_ULPS;
use crate::math::Vec3;
use crate::scene::ShadowOrigin;
use crate::shading::{LocalSurface, PreparedLight, lanes};
use simd::{F32Lanes, Kernel, Level, MaskLanes, Simd};

/// Points of surfaces as lamps see them, in lanes.
#[derive(Clone, Copy)]
pub(super) struct LitPoint<L> {
    pub(super) position: Vec3<L>,
    /// Geometric unit normal on the side of the viewer.
    pub(super) n_g: Vec3<L>,
    /// Shading unit normal on the side of the viewer.
    pub(super) n_s: Vec3<L>,
    /// Unit direction to the viewer.
    pub(super) view: Vec3<L>,
    /// How far from the surface secondary rays must start.
    pub(super) error: L,
    /// The local model, multiplied by the weight of the ray that came here.
    pub(super) surface: LocalSurface<L>,
}

/// What a lamp sends to points, and the segments that must be free for it.
pub(super) struct Sent<L: F32Lanes> {
    /// Lanes whose surface faces the lamp, by either normal.
    pub(super) faces: L::Mask,
    /// Light that the sample gains.
    pub(super) light: Vec3<L>,
    pub(super) origin: Vec3<L>,
    pub(super) direction: Vec3<L>,
    pub(super) t_max: L,
}

impl<L: F32Lanes> LitPoint<L> {
    /// What `light` sends here.
    #[inline(always)]
    pub(super) fn receive(&self, token: L::Token, light: &PreparedLight, origin: ShadowOrigin) -> Sent<L> {
        let splat = |value| L::splat(token, value);
        let arriving = light.at_lanes(token, self.position);
        let faces = |normal: Vec3<L>| normal.dot(arriving.direction).gt(splat(0.0));
        let answer = lanes::answer(token, &self.surface, self.n_s, arriving.direction, self.view);
        // Intersection is exact to a few ulp of distances from the ray's origin, so a ray that comes from the light
        // needs an end that lies farther off the surface than one that starts here.
        let (from, direction, t_max) = match origin {
            ShadowOrigin::Light(from) => {
                let from = from.map(splat);
                let error = self.error + splat(f32::EPSILON * ERROR_ULPS) * arriving.distance;
                (from, self.off_surface(error) - from, splat(1.0f32.next_down()))
            }
            ShadowOrigin::Surface => (self.off_surface(self.error), arriving.direction, arriving.distance),
        };
        Sent {
            faces: faces(self.n_g) & faces(self.n_s),
            light: answer.times(arriving.light),
            origin: from,
            direction,
            t_max,
        }
    }

    /// The point `by` above the surface, on the side of the viewer.
    #[inline(always)]
    fn off_surface(&self, by: L) -> Vec3<L> {
        self.position + self.n_g * by
    }
}

/// Points that wait for light.
#[derive(Debug, Default)]
pub(super) struct LitPoints {
    /// The fields of [`LitPoint`] in order; sample.
    rows: Rows<21, 1>,
}

impl LitPoints {
    pub(super) fn clear(&mut self) {
        self.rows.clear();
    }

    /// Append the points of the lanes `mask`.
    #[inline(always)]
    pub(super) fn append<L: F32Lanes>(&mut self, mask: L::Mask, sample: L::U32, point: &LitPoint<L>) {
        let LitPoint { position: p, n_g: g, n_s: n, view: v, error, surface } = point;
        let LocalSurface { diffuse: d, specular: s, exponent, is_blinn } = surface;
        let floats = [
            p.x, p.y, p.z, g.x, g.y, g.z, n.x, n.y, n.z, v.x, v.y, v.z, *error, d.x, d.y, d.z, s.x, s.y, s.z,
            *exponent, *is_blinn,
        ];
        self.rows.append::<L>(mask, floats, [sample]);
    }

    #[inline(always)]
    fn load<L: F32Lanes>(&self, token: L::Token, at: usize) -> (LitPoint<L>, L::U32) {
        let (floats, [sample]) = self.rows.load::<L>(token, at);
        let [px, py, pz, gx, gy, gz, nx, ny, nz, vx, vy, vz, error, dx, dy, dz, sx, sy, sz, exponent, is_blinn] =
            floats;
        let surface =
            LocalSurface { diffuse: Vec3::new(dx, dy, dz), specular: Vec3::new(sx, sy, sz), exponent, is_blinn };
        let (position, n_g) = (Vec3::new(px, py, pz), Vec3::new(gx, gy, gz));
        let (n_s, view) = (Vec3::new(nx, ny, nz), Vec3::new(vx, vy, vz));
        (LitPoint { position, n_g, n_s, view, error, surface }, sample)
    }

    /// Queue the shadow rays of all points that face `light`.
    pub(super) fn light(&self, level: Level, light: &PreparedLight, origin: ShadowOrigin, shadows: &mut ShadowBatch) {
        simd::dispatch(level, LightAll { points: self, light, origin, shadows });
    }
}

/// The kernel of [`LitPoints::light`].
struct LightAll<'a> {
    points: &'a LitPoints,
    light: &'a PreparedLight,
    origin: ShadowOrigin,
    shadows: &'a mut ShadowBatch,
}

impl Kernel for LightAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let len = self.points.rows.len();
        for at in (0..len).step_by(BLOCK) {
            let (point, sample) = self.points.load::<S::F32x16>(token, at);
            let sent = point.receive(token, self.light, self.origin);
            let faces = sent.faces & first_lanes::<S::F32x16>(token, len - at);
            if faces.any() {
                self.shadows.append(faces, sample, &sent);
            }
        }
    }
}
