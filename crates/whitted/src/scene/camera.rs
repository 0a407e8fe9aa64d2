//! The pinhole camera.

use super::Sampling;
use crate::math::{Vec3, Vec3d, Vec3f, sin_cos_degrees};
use crate::ray::{Ray, RayBatch};
use crate::shading::one::{One, one, values};
use simd::{F32Lanes, Kernel, Level, Scalar, Simd};

/// A pinhole camera in a right-handed world, y up by custom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole.
    pub eye: Vec3d,
    /// The point in the middle of the picture.
    pub look_at: Vec3d,
    /// The direction that is up in the picture; need not be perpendicular to the view.
    pub up: Vec3d,
    /// Vertical field of view in degrees, 0 to 180, both exclusive.
    pub vfov: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { eye: Vec3d::new(0.0, 0.0, 5.0), look_at: Vec3d::ZERO, up: Vec3d::new(0.0, 1.0, 0.0), vfov: 40.0 }
    }
}

/// The least sine of the angle between view and up: below it, their cross product is mostly rounding error.
const LEAST_ANGLE: f64 = 1e-9;

impl Camera {
    /// What makes the camera impossible, if anything.
    pub fn fault(&self) -> Option<&'static str> {
        let view = (self.look_at - self.eye).direction();
        let across = view.cross(self.up.direction()).length();
        let is_angle = self.vfov > 0.0 && self.vfov < 180.0;
        [
            (![self.eye, self.look_at, self.up].into_iter().all(Vec3d::is_finite), "a coordinate is not finite"),
            (!is_angle, "the field of view must lie between 0 and 180 degrees"),
            (!view.is_finite(), "it looks at the point where it stands"),
            (!self.up.direction().is_finite(), "'up' has no direction"),
            (across.is_nan() || across < LEAST_ANGLE, "'up' points along the view"),
        ]
        .into_iter()
        .find_map(|(is_wrong, fault)| is_wrong.then_some(fault))
    }

    /// Unit vectors to the right, up and forward. The camera has no [`fault`](Self::fault).
    pub fn axes(&self) -> [Vec3d; 3] {
        let forward = (self.look_at - self.eye).direction();
        let right = forward.cross(self.up.direction()).direction();
        [right, right.cross(forward), forward]
    }

    /// Half the height of the picture at distance 1.
    pub fn half_height(&self) -> f64 {
        let (sin, cos) = sin_cos_degrees(0.5 * self.vfov);
        sin / cos
    }
}

/// The rays of one camera and one size of picture.
///
/// Places in the picture are in pixels from its upper left corner, so that (0.5, 0.5) is the middle of the first pixel.
/// With [`Sampling::Centers`] the vertical field of view spans the picture from edge to edge; with
/// [`Sampling::Corners`] it spans the *middles* of the first and last row, and so do the columns if the picture is
/// square. Pixels are square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRays {
    eye: Vec3f,
    forward: Vec3f,
    /// Step from a pixel to the next one to the right, at distance 1.
    right: Vec3f,
    /// Step from a pixel to the next one down.
    down: Vec3f,
    /// The middle of the picture in pixels.
    middle: [f32; 2],
}

impl CameraRays {
    /// The rays of `camera`, which has no [`fault`](Camera::fault), in the coordinates in which it is given.
    pub fn new(camera: &Camera, size: [u32; 2], sampling: Sampling) -> Self {
        let [width, height] = size.map(f64::from);
        let steps = match sampling {
            Sampling::Centers => height,
            // A picture of one row has its samples in the middle, wherever the next row would be.
            Sampling::Corners => (height - 1.0).max(1.0),
        };
        let step = 2.0 * camera.half_height() / steps;
        let [right, up, forward] = camera.axes();
        Self {
            eye: camera.eye.to_f32(),
            forward: forward.to_f32(),
            right: (right * step).to_f32(),
            down: (up * -step).to_f32(),
            middle: [(0.5 * width) as f32, (0.5 * height) as f32],
        }
    }

    /// The ray through the place (`x`, `y`), with a unit direction.
    pub fn ray(&self, x: f32, y: f32) -> Ray {
        Ray::new(self.eye, values(self.directions::<One>(Scalar, one(x), one(y))))
    }

    /// Replace `rays` by the rays through the places (`x[i]`, `y[i]`), bit by bit those of [`ray`](Self::ray).
    ///
    /// # Panics
    /// If `x` and `y` differ in length.
    pub fn fill(&self, level: Level, x: &[f32], y: &[f32], rays: &mut RayBatch) {
        simd::dispatch(level, Fill { camera: self, x, y, rays });
    }

    /// Where all rays start.
    pub(crate) fn eye(&self) -> Vec3f {
        self.eye
    }

    /// Unit directions through many places.
    #[inline(always)]
    pub(crate) fn directions<L: F32Lanes>(&self, token: L::Token, x: L, y: L) -> Vec3<L> {
        let splat = |value| L::splat(token, value);
        // Measured from the middle, steps are small and their errors symmetric.
        let (x, y) = (x - splat(self.middle[0]), y - splat(self.middle[1]));
        let along = self.forward.map(splat) + self.right.map(splat) * x + self.down.map(splat) * y;
        along / along.length_squared().sqrt()
    }
}

/// The kernel of [`CameraRays::fill`].
struct Fill<'a> {
    camera: &'a CameraRays,
    x: &'a [f32],
    y: &'a [f32],
    rays: &'a mut RayBatch,
}

/// Rays made at once.
const BLOCK: usize = 16;

impl Kernel for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { camera, x, y, rays } = self;
        assert_eq!(x.len(), y.len(), "one y for each x");
        rays.resize(x.len());
        let (origin, direction) = (&mut rays.origin, &mut rays.direction);
        for (row, value) in [
            (&mut origin.x, camera.eye.x),
            (&mut origin.y, camera.eye.y),
            (&mut origin.z, camera.eye.z),
            (&mut rays.t_min, 0.0),
            (&mut rays.t_max, f32::INFINITY),
        ] {
            row.fill(value);
        }
        for start in (0..x.len()).step_by(BLOCK) {
            let block = start..x.len().min(start + BLOCK);
            let (x, y) = (load_part::<S>(token, &x[block.clone()]), load_part::<S>(token, &y[block.clone()]));
            let along = camera.directions(token, x, y);
            store_part::<S>(along.x, &mut direction.x[block.clone()]);
            store_part::<S>(along.y, &mut direction.y[block.clone()]);
            store_part::<S>(along.z, &mut direction.z[block]);
        }
    }
}

/// Up to sixteen numbers; the lanes beyond them are zero.
#[inline(always)]
fn load_part<S: Simd>(token: S, from: &[f32]) -> S::F32x16 {
    if from.len() == BLOCK {
        return S::F32x16::load_slice(token, from);
    }
    let mut padded = [0.0; BLOCK];
    padded[..from.len()].copy_from_slice(from);
    S::F32x16::load(token, &padded)
}

/// As many of the sixteen lanes as `to` has room for.
#[inline(always)]
fn store_part<S: Simd>(lanes: S::F32x16, to: &mut [f32]) {
    if to.len() == BLOCK {
        return lanes.store_slice(to);
    }
    let mut all = [0.0; BLOCK];
    lanes.store(&mut all);
    to.copy_from_slice(&all[..to.len()]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SplitMix64;

    fn camera() -> Camera {
        Camera { eye: Vec3d::new(2.2, 1.5, 3.4), look_at: Vec3d::ZERO, vfov: 36.0, ..Camera::default() }
    }

    /// At the origin, looking along −z.
    fn straight(vfov: f64) -> Camera {
        Camera { eye: Vec3d::ZERO, look_at: Vec3d::new(0.0, 0.0, -1.0), vfov, ..Camera::default() }
    }

    fn near(a: Vec3f, b: Vec3d) -> bool {
        (a.to_f64() - b).abs().max_component() < 2e-7
    }

    #[test]
    fn up_is_up_and_right_is_right() {
        let rays = CameraRays::new(&straight(90.0), [4, 2], Sampling::Centers);
        let upper_left = rays.ray(0.0, 0.0).direction;
        assert!(near(upper_left, Vec3d::new(-2.0, 1.0, -1.0).normalize()), "{upper_left:?}");
        assert_eq!(rays.ray(2.0, 1.0), Ray::new(Vec3f::ZERO, Vec3f::new(0.0, 0.0, -1.0)));
    }

    #[test]
    fn the_field_of_view_spans_the_edges_or_the_middles_of_rows() {
        for n in [2_u32, 3, 513] {
            let last = n as f32 - 0.5;
            let corners = CameraRays::new(&straight(60.0), [n, n], Sampling::Corners);
            let centers = CameraRays::new(&straight(60.0), [n, n], Sampling::Centers);
            let reach = 30.0_f64.to_radians().tan();
            let expected = Vec3d::new(reach, -reach, -1.0).normalize();
            assert!(near(corners.ray(last, last).direction, expected), "{n}");
            assert!(near(centers.ray(n as f32, n as f32).direction, expected), "{n}");
        }
        let one = CameraRays::new(&straight(60.0), [1, 1], Sampling::Corners);
        assert_eq!(one.ray(0.5, 0.5).direction, Vec3f::new(0.0, 0.0, -1.0));
    }

    /// `worked_examples.json`: a field of view of 90° across the wider side. The publication's x axis points left.
    #[test]
    fn published_examples() {
        let across_width = |width: f64, height: f64| 2.0 * (height / width).atan().to_degrees();
        let rays = CameraRays::new(&straight(across_width(200.0, 125.0)), [200, 125], Sampling::Centers);
        assert!((f64::from(rays.right.x) - 0.009999999999999998).abs() < 1e-9);
        let rays = CameraRays::new(&straight(across_width(201.0, 101.0)), [201, 101], Sampling::Centers);
        let first = rays.ray(0.5, 0.5).direction;
        assert!(near(first, Vec3d::new(-0.6651864261194508, 0.3325932130597254, -0.6685123582500481)), "{first:?}");
        assert!(near(rays.ray(100.5, 50.5).direction, Vec3d::new(0.0, 0.0, -1.0)));
    }

    #[test]
    fn one_ray_and_many_have_the_same_bits() {
        let mut random = SplitMix64::new(5);
        let rays = CameraRays::new(&camera(), [640, 480], Sampling::Centers);
        for count in [0, 1, 15, 16, 17, 64, 101] {
            let mut place = |size: f64| (0..count).map(|_| random.uniform(0.0, size) as f32).collect::<Vec<f32>>();
            let (x, y) = (place(640.0), place(480.0));
            for level in Level::available() {
                let mut batch = RayBatch::new();
                batch.push(&Ray::new(Vec3f::ONE, Vec3f::ONE));
                rays.fill(level, &x, &y, &mut batch);
                assert_eq!(batch.len(), count);
                for i in 0..count {
                    let ray = rays.ray(x[i], y[i]);
                    assert_eq!(batch.get(i), ray, "{} at {}", i, level.name());
                    assert!((ray.direction.length() - 1.0).abs() < 3e-7);
                }
            }
        }
    }

    #[test]
    fn faults() {
        let good = camera();
        assert_eq!(good.fault(), None);
        assert_eq!(Camera { up: Vec3d::new(0.0, 1e-300, 0.0), ..good }.fault(), None);
        let bad = [
            Camera { look_at: good.eye, ..good },
            Camera { up: good.eye * 3.0, ..good },
            Camera { up: Vec3d::ZERO, ..good },
            Camera { vfov: 0.0, ..good },
            Camera { vfov: 180.0, ..good },
            Camera { vfov: f64::NAN, ..good },
            Camera { eye: Vec3d::new(0.0, f64::NAN, 0.0), ..good },
            Camera { look_at: Vec3d::new(0.0, f64::INFINITY, 0.0), ..good },
        ];
        assert!(bad.iter().all(|camera| camera.fault().is_some()), "{bad:?}");
    }
}
