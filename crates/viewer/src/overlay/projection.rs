//! Where points of the scene are in the picture.

use egui::{Pos2, pos2};
use whitted::math::Vec3d;
use whitted::scene::Camera;

/// Nearer to the eye than this share of the distance that is looked at nothing is drawn.
const NEAR: f64 = 1e-4;

/// From the scene to the picture.
pub(super) struct View {
    camera: Camera,
    axes: [Vec3d; 3],
    size: [f32; 2],
    /// From the eye to the point that it looks at.
    pub(super) distance: f64,
}

impl View {
    /// The picture of `camera`, of this size in units of layout.
    pub(super) fn new(camera: &Camera, size: [f32; 2]) -> Self {
        Self { camera: *camera, axes: camera.axes(), size, distance: (camera.look_at - camera.eye).length() }
    }

    /// Right, up and forward from the eye.
    fn seen(&self, point: Vec3d) -> Vec3d {
        let d = point - self.camera.eye;
        Vec3d::new(d.dot(self.axes[0]), d.dot(self.axes[1]), d.dot(self.axes[2]))
    }

    /// Where the part of a segment that lies before the eye is in the picture; `None` if none does.
    pub(super) fn segment(&self, from: Vec3d, to: Vec3d) -> Option<[Pos2; 2]> {
        let near = NEAR * self.distance;
        let [a, b] = [self.seen(from), self.seen(to)];
        let cut = |a: Vec3d, b: Vec3d| if a.z < near { a + (b - a) * ((near - a.z) / (b.z - a.z)) } else { a };
        (a.z >= near || b.z >= near).then(|| [self.place(cut(a, b)), self.place(cut(b, a))])
    }

    fn place(&self, seen: Vec3d) -> Pos2 {
        // Far outside the window it does not matter where.
        const FARTHEST: f64 = 1e5;
        let scale = f64::from(self.size[1]) * 0.5 / (self.camera.half_height() * seen.z);
        let [x, y] = [seen.x * scale, -seen.y * scale].map(|a| a.clamp(-FARTHEST, FARTHEST) as f32);
        pos2(self.size[0] * 0.5 + x, self.size[1] * 0.5 + y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_drawn_where_their_rays_pass() {
        let camera = Camera { eye: Vec3d::new(1.0, 2.0, 5.0), vfov: 50.0, ..Camera::default() };
        let rays = whitted::scene::CameraRays::new(&camera, [400, 300], whitted::scene::Sampling::Centers);
        let view = View::new(&camera, [400.0, 300.0]);
        for place in [[10.0, 20.0], [200.0, 150.0], [399.0, 1.0]] {
            let direction = rays.ray(place[0], place[1]).direction.to_f64();
            let point = camera.eye + direction * 7.0;
            let [from, to] = view.segment(point, point).unwrap();
            assert!((from - pos2(place[0], place[1])).length() < 0.01 && from == to, "{from:?}");
        }
    }

    #[test]
    fn what_lies_behind_the_eye_is_cut_off() {
        let view = View::new(&Camera::default(), [100.0, 100.0]);
        let behind = Vec3d::new(0.0, 1.0, 9.0);
        assert!(view.segment(behind, behind).is_none());
        let [from, to] = view.segment(behind, Vec3d::ZERO).unwrap();
        assert!(from.y < 0.0 && to == pos2(50.0, 50.0), "{from:?} {to:?}");
    }
}
