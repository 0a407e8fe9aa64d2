//! The elementary motions of a camera. None of them makes a camera that cannot be.

use whitted::math::Vec3d;
use whitted::scene::Camera;

/// The view stays this far from straight up and straight down, in radians: there, left and right are undefined.
const POLE: f64 = 2e-3;

/// The least and greatest distance to the point that is looked at, relative to the size of the scene.
const DISTANCES: [f64; 2] = [1e-6, 1e6];

/// `v` turned around the unit vector `axis` by `angle` (radians, right-handed): Rodrigues' formula.
pub(super) fn turned(v: Vec3d, axis: Vec3d, angle: f64) -> Vec3d {
    let (sin, cos) = angle.sin_cos();
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}

/// Turn the camera around a point: to the left by `yaw`, upwards by `pitch` (radians), its upward direction staying.
pub(super) fn orbit(camera: &mut Camera, pivot: Vec3d, yaw: f64, pitch: f64) {
    let up = camera.up.direction();
    turn(camera, pivot, up, yaw);
    let [right, _, forward] = camera.axes();
    let elevation = forward.dot(up).clamp(-1.0, 1.0).asin();
    let limit = std::f64::consts::FRAC_PI_2 - POLE;
    let pitch = (elevation + pitch).clamp(-limit, limit) - elevation;
    turn(camera, pivot, right, pitch);
}

/// Turn the camera around an axis through a point, unless it would become impossible.
fn turn(camera: &mut Camera, pivot: Vec3d, axis: Vec3d, angle: f64) {
    let place = |p: Vec3d| pivot + turned(p - pivot, axis, angle);
    let moved = Camera { eye: place(camera.eye), look_at: place(camera.look_at), ..*camera };
    accept(camera, moved);
}

/// Move without turning.
pub(super) fn shift(camera: &mut Camera, by: Vec3d) {
    let moved = Camera { eye: camera.eye + by, look_at: camera.look_at + by, ..*camera };
    accept(camera, moved);
}

/// Come nearer to `toward`, so that its distance is multiplied by `factor`, without turning; what `toward` covers in
/// the picture stays where it is.
pub(super) fn zoom(camera: &mut Camera, toward: Vec3d, factor: f64, scene_size: f64) {
    let [_, _, forward] = camera.axes();
    let distance = (camera.look_at - camera.eye).length() * factor;
    if !(DISTANCES[0] * scene_size..=DISTANCES[1] * scene_size).contains(&distance) {
        return;
    }
    let eye = toward + (camera.eye - toward) * factor;
    accept(camera, Camera { eye, look_at: eye + forward * distance, ..*camera });
}

/// Take over a camera that can be.
fn accept(camera: &mut Camera, moved: Camera) {
    if moved.fault().is_none() {
        *camera = moved;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera { eye: Vec3d::new(3.0, 2.0, 4.0), look_at: Vec3d::new(0.0, 1.0, 0.0), ..Camera::default() }
    }

    fn near(a: Vec3d, b: Vec3d) -> bool {
        (a - b).abs().max_component() < 1e-9
    }

    #[test]
    fn orbits_keep_the_distance_and_never_reach_the_poles() {
        let mut moved = camera();
        let pivot = Vec3d::new(0.5, 0.5, 0.5);
        let distance = (moved.eye - pivot).length();
        for step in 0..1000 {
            orbit(&mut moved, pivot, 0.1, if step < 500 { 0.3 } else { -0.3 });
            assert_eq!(moved.fault(), None);
            assert!(((moved.eye - pivot).length() - distance).abs() < 1e-9);
            assert_eq!(moved.up, camera().up);
        }
        let [_, _, forward] = moved.axes();
        assert!(forward.dot(moved.up).abs() > 0.999_9, "it went as far as it may");
    }

    #[test]
    fn a_turn_to_the_left_moves_the_camera_to_the_left() {
        let mut moved = camera();
        let [right, _, _] = moved.axes();
        let pivot = moved.look_at;
        orbit(&mut moved, pivot, -0.01, 0.0);
        assert!((moved.eye - camera().eye).dot(right) < 0.0);
    }

    #[test]
    fn zooming_keeps_what_is_under_the_cursor() {
        let mut moved = camera();
        let toward = Vec3d::new(0.3, 0.2, -0.4);
        let before = (toward - moved.eye).normalize();
        zoom(&mut moved, toward, 0.5, 1.0);
        assert!(near((toward - moved.eye).normalize(), before));
        assert!(near(moved.axes()[2], camera().axes()[2]), "it does not turn");
        zoom(&mut moved, toward, 2.0, 1.0);
        assert!(near(moved.eye, camera().eye) && near(moved.look_at, camera().look_at));
    }

    #[test]
    fn impossible_motions_are_refused() {
        let mut moved = camera();
        shift(&mut moved, Vec3d::splat(f64::NAN));
        (0..10_000).for_each(|_| zoom(&mut moved, Vec3d::ZERO, 0.5, 1.0));
        assert_eq!(moved.fault(), None);
        shift(&mut moved, Vec3d::splat(f64::INFINITY));
        assert_eq!(moved.fault(), None);
    }
}
