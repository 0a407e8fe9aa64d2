//! The way from one camera to another.

use super::motion::turned;
use whitted::math::Vec3d;
use whitted::scene::Camera;

/// How long a flight takes, in seconds.
const DURATION: f64 = 0.4;

/// Directions whose cosine is below this are opposite: there is no one way between them.
const OPPOSITE: f64 = -0.999;

/// A flight under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    from: Camera,
    to: Camera,
    seconds: f64,
}

impl Flight {
    pub(super) fn new(from: Camera, to: Camera) -> Self {
        Self { from, to, seconds: 0.0 }
    }

    /// The camera `seconds` later; exactly the destination, and `true`, at the end.
    pub(super) fn advance(&mut self, seconds: f64) -> (Camera, bool) {
        self.seconds += seconds;
        let share = self.seconds / DURATION;
        if share.is_nan() || share >= 1.0 {
            return (self.to, true);
        }
        let camera = between(&self.from, &self.to, share * share * (3.0 - 2.0 * share));
        if camera.fault().is_none() { (camera, false) } else { (self.to, true) }
    }

    /// Where it ends.
    pub(super) fn destination(&self) -> Camera {
        self.to
    }
}

/// The camera at `share` of the way: the point that is looked at on a line, the eye around it on an arc.
fn between(from: &Camera, to: &Camera, share: f64) -> Camera {
    let look_at = mix(from.look_at, to.look_at, share);
    let (a, b) = (from.eye - from.look_at, to.eye - to.look_at);
    // Distances in proportion: a zoom feels even.
    let distance = a.length() * (b.length() / a.length()).powf(share);
    let direction = arc(a.direction(), b.direction(), from.up.direction(), share);
    Camera {
        eye: look_at + direction * distance,
        look_at,
        up: mix(from.up.direction(), to.up.direction(), share),
        vfov: from.vfov + (to.vfov - from.vfov) * share,
    }
}

fn mix(a: Vec3d, b: Vec3d, share: f64) -> Vec3d {
    a + (b - a) * share
}

/// The unit vector at `share` of the way from `a` to `b` on the sphere; around `up` if they are opposite.
fn arc(a: Vec3d, b: Vec3d, up: Vec3d, share: f64) -> Vec3d {
    let cosine = a.dot(b).clamp(-1.0, 1.0);
    let axis = if cosine < OPPOSITE { up } else { a.cross(b).direction() };
    if axis.is_finite() { turned(a, axis, cosine.acos() * share).normalize() } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_is_smooth_and_ends_exactly() {
        let from = Camera { eye: Vec3d::new(0.0, 0.0, 5.0), ..Camera::default() };
        for eye in [[5.0, 0.0, 0.0], [0.0, 0.0, -5.0], [0.0, 4.999, 0.01], [0.0, 0.0, 500.0]] {
            let to = Camera { eye: eye.into(), vfov: 20.0, ..from };
            let mut flight = Flight::new(from, to);
            let mut last = from;
            loop {
                let (camera, arrived) = flight.advance(0.004);
                assert_eq!(camera.fault(), None);
                let step = (camera.eye - last.eye).length() / camera.eye.length();
                assert!(step < 0.1, "a jump of {step} to {eye:?}");
                last = camera;
                if arrived {
                    break;
                }
            }
            assert_eq!(last, to);
        }
    }
}
