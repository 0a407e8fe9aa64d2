//! Cameras that see a whole box.

use crate::action::Side;
use whitted::math::Vec3d;
use whitted::scene::Camera;

/// The part of the picture's width and height that the box may take.
const FRAME: f64 = 0.94;

/// How far a view from above is tilted from straight down, in radians: invisible, but left and right are defined.
const TILT: f64 = 2e-3;

/// `camera`, moved along its view and sideways until the box between the corners `lo` and `hi` fills the picture of
/// `aspect` = width / height. Boxes that are empty or not finite change nothing.
pub(crate) fn framing_all(camera: &Camera, [lo, hi]: [Vec3d; 2], aspect: f64) -> Camera {
    let center = (lo + hi) * 0.5;
    let half = (hi - lo) * 0.5;
    let [right, up, forward] = camera.axes();
    let height = camera.half_height() * FRAME;
    let width = height * aspect;
    // Each corner must be so far away that its place in the picture lies within the frame.
    let distance = corners(half).map(|corner| {
        let needed = (corner.dot(right).abs() / width).max(corner.dot(up).abs() / height);
        needed - corner.dot(forward)
    });
    let distance = distance.fold(0.0, f64::max);
    let framed = Camera { eye: center - forward * distance, look_at: center, ..*camera };
    if framed.fault().is_none() { framed } else { *camera }
}

/// The box seen from a side, its other two sides being defined by `home`: up is up there, and the front is the side
/// along the axis nearest to +z that is level.
pub(crate) fn from_side(home: &Camera, side: Side, bounds: [Vec3d; 2], aspect: f64) -> Camera {
    let up = nearest_axis(home.up.direction());
    let depth = Vec3d::new(0.0, 0.0, 1.0);
    // In a scene whose z is up, the front is toward −y, as modellers have it.
    let front = if up.z.abs() > 0.5 { Vec3d::new(0.0, -1.0, 0.0) } else { depth };
    let right = up.cross(front);
    let toward_eye = match side {
        Side::Front => front,
        Side::Right => right,
        Side::Top => (up + front * TILT).normalize(),
    };
    let center = (bounds[0] + bounds[1]) * 0.5;
    framing_all(&Camera { eye: center + toward_eye, look_at: center, up, ..*home }, bounds, aspect)
}

/// The axis, with its sign, that is nearest to a unit vector.
fn nearest_axis(v: Vec3d) -> Vec3d {
    let [x, y, z] = v.abs().to_array();
    if y >= x && y >= z {
        Vec3d::new(0.0, v.y.signum(), 0.0)
    } else if z >= x {
        Vec3d::new(0.0, 0.0, v.z.signum())
    } else {
        Vec3d::new(v.x.signum(), 0.0, 0.0)
    }
}

fn corners(half: Vec3d) -> impl Iterator<Item = Vec3d> {
    let signs = [-1.0, 1.0];
    signs.into_iter().flat_map(move |x| {
        signs
            .into_iter()
            .flat_map(move |y| signs.into_iter().map(move |z| Vec3d::new(x * half.x, y * half.y, z * half.z)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Place of a point in the picture: −1 to 1 in both directions.
    fn place(camera: &Camera, point: Vec3d, aspect: f64) -> [f64; 2] {
        let [right, up, forward] = camera.axes();
        let d = point - camera.eye;
        let height = camera.half_height() * d.dot(forward);
        [d.dot(right) / (height * aspect), d.dot(up) / height]
    }

    #[test]
    fn everything_is_in_the_picture_from_every_side() {
        let (lo, hi) = (Vec3d::new(-1.0, 2.0, -5.0), Vec3d::new(7.0, 3.0, 4.0));
        let zup = Camera { up: Vec3d::new(0.0, 0.1, 1.0), eye: Vec3d::new(1.0, 9.0, 2.0), ..Camera::default() };
        for home in [Camera::default(), zup] {
            for aspect in [0.4, 1.0, 2.5] {
                let sides = [Side::Front, Side::Right, Side::Top].map(|side| from_side(&home, side, [lo, hi], aspect));
                for camera in sides.into_iter().chain([framing_all(&home, [lo, hi], aspect)]) {
                    assert_eq!(camera.fault(), None);
                    let reach = corners((hi - lo) * 0.5).map(|corner| place(&camera, (lo + hi) * 0.5 + corner, aspect));
                    let reach = reach.flat_map(|[x, y]| [x.abs(), y.abs()]).fold(0.0, f64::max);
                    assert!((0.5..=FRAME + 1e-9).contains(&reach), "{reach} with {camera:?}");
                }
            }
        }
    }

    #[test]
    fn sides_are_where_they_are_called() {
        let bounds = [Vec3d::splat(-1.0), Vec3d::ONE];
        let eye = |side| from_side(&Camera::default(), side, bounds, 1.0).eye;
        assert!(eye(Side::Front).z > 1.0 && eye(Side::Right).x > 1.0 && eye(Side::Top).y > 1.0);
    }

    #[test]
    fn impossible_boxes_change_nothing() {
        let camera = Camera::default();
        for bounds in [[Vec3d::splat(f64::NAN); 2], [Vec3d::splat(f64::INFINITY), Vec3d::ZERO]] {
            assert_eq!(framing_all(&camera, bounds, 1.0), camera);
        }
    }
}
