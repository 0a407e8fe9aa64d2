//! The camera of each moment.

use super::flight::Flight;
use super::motion;
use whitted::math::Vec3d;
use whitted::scene::Camera;

/// Half of what is still to be moved is moved in this many seconds, times ln 2: the hand does not see the lag, and the
/// eye does not see the steps of the mouse.
const EASE: f64 = 0.045;

/// Less than this (radians, or shares of the distance) is moved at once: so motion ends.
const REST: f64 = 4e-4;

/// Speed of flying in sizes of the scene a second, and how much faster with Shift.
const SPEED: f64 = 0.35;
const FASTER: f64 = 4.0;

/// The turntable's turn, in radians a second: once around in fifteen seconds.
const TURNTABLE: f64 = std::f64::consts::TAU / 15.0;

/// A longer step than this, in seconds, is taken as this: the machine was busy elsewhere.
const LONGEST_STEP: f64 = 0.1;

/// Moves a camera as its user wants, smoothly.
#[derive(Clone, Debug)]
pub(crate) struct Navigator {
    camera: Camera,
    /// The point around which the camera turns; none: the point that it looks at.
    pivot: Option<Vec3d>,
    /// A length to measure speeds by.
    scene_size: f64,
    pending: Pending,
    /// Directions of flight that are held: right, up, forward, each −1 to 1; and whether to hurry.
    fly: ([f64; 3], bool),
    /// Scene units a second, along right, up, forward.
    velocity: Vec3d,
    flight: Option<Flight>,
    turntable: bool,
}

/// What is asked for and not yet moved.
#[derive(Clone, Copy, Debug, Default)]
struct Pending {
    /// Radians to the left and upwards around the pivot.
    orbit: [f64; 2],
    /// Radians to the left and upwards around the eye.
    look: [f64; 2],
    /// Shares of the distance to the pivot, right and up.
    pan: [f64; 2],
    /// Logarithm of the factor of the distance to `toward`.
    zoom: f64,
    toward: Vec3d,
}

impl Navigator {
    /// Stand at `camera` in a scene of this size (a length in scene units, > 0).
    pub(crate) fn new(camera: Camera, scene_size: f64) -> Self {
        Self {
            camera,
            pivot: None,
            scene_size,
            pending: Pending::default(),
            fly: ([0.0; 3], false),
            velocity: Vec3d::ZERO,
            flight: None,
            turntable: false,
        }
    }

    /// The camera of this moment.
    pub(crate) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The point around which it turns.
    pub(crate) fn pivot(&self) -> Vec3d {
        self.pivot.unwrap_or(self.camera.look_at)
    }

    /// The scene has this size now.
    pub(crate) fn set_scene_size(&mut self, size: f64) {
        self.scene_size = size;
    }

    /// Turn around the pivot by radians to the left and upwards.
    pub(crate) fn orbit(&mut self, by: [f64; 2]) {
        self.take_over();
        add(&mut self.pending.orbit, by);
    }

    /// Turn the view by radians to the left and upwards, the eye staying.
    pub(crate) fn look(&mut self, by: [f64; 2]) {
        self.take_over();
        add(&mut self.pending.look, by);
    }

    /// Move sideways so that the pivot moves in the picture by shares of half the picture's height, right and up.
    pub(crate) fn pan(&mut self, [right, up]: [f64; 2]) {
        self.take_over();
        let reach = self.camera.half_height();
        add(&mut self.pending.pan, [-right * reach, -up * reach]);
    }

    /// Multiply the distance to `toward` by the exponential of `log_factor`.
    pub(crate) fn zoom(&mut self, log_factor: f64, toward: Vec3d) {
        self.take_over();
        self.pending.zoom += log_factor;
        self.pending.toward = toward;
    }

    /// Fly in these directions (right, up, forward, each −1 to 1) until told otherwise.
    pub(crate) fn fly(&mut self, directions: [f64; 3], hurry: bool) {
        if directions != [0.0; 3] {
            self.take_over();
        }
        self.fly = (directions, hurry);
    }

    /// Go to `camera`.
    pub(crate) fn go_to(&mut self, camera: Camera) {
        self.stop();
        self.pivot = None;
        self.flight = Some(Flight::new(self.camera, camera));
    }

    /// Be at `camera` at once.
    pub(crate) fn jump_to(&mut self, camera: Camera) {
        self.stop();
        self.pivot = None;
        self.camera = camera;
    }

    /// Look at a point from here, and turn around it from now on.
    pub(crate) fn look_at(&mut self, point: Vec3d) {
        let camera = Camera { look_at: point, ..self.camera };
        if camera.fault().is_none() {
            self.go_to(camera);
        }
    }

    /// Turn around the pivot by itself, or stop doing so.
    pub(crate) fn toggle_turntable(&mut self) {
        self.take_over();
        self.turntable = !self.turntable;
    }

    /// Where the camera will come to rest, if it is left alone.
    pub(crate) fn destination(&self) -> Camera {
        self.flight.map_or(self.camera, |flight| flight.destination())
    }

    /// True while the camera moves by itself.
    pub(crate) fn is_moving(&self) -> bool {
        self.flight.is_some()
            || self.turntable
            || self.fly.0 != [0.0; 3]
            || self.velocity != Vec3d::ZERO
            || self.pending.is_some()
    }

    /// Move on by so many seconds. True if the camera changed.
    pub(crate) fn advance(&mut self, seconds: f64) -> bool {
        let before = self.camera;
        let seconds = seconds.clamp(0.0, LONGEST_STEP);
        if let Some(flight) = &mut self.flight {
            let (camera, arrived) = flight.advance(seconds);
            self.camera = camera;
            if arrived {
                self.flight = None;
            }
        }
        if self.turntable {
            let pivot = self.pivot();
            motion::orbit(&mut self.camera, pivot, TURNTABLE * seconds, 0.0);
        }
        self.move_pending(1.0 - (-seconds / EASE).exp());
        self.move_flying(seconds);
        self.camera != before
    }

    fn move_pending(&mut self, share: f64) {
        if !self.pending.is_some() {
            return;
        }
        let now = self.pending.take(share);
        let pivot = self.pivot();
        motion::orbit(&mut self.camera, pivot, now.orbit[0], now.orbit[1]);
        let eye = self.camera.eye;
        motion::orbit(&mut self.camera, eye, now.look[0], now.look[1]);
        let [right, up, forward] = self.camera.axes();
        let ahead = (pivot - self.camera.eye).dot(forward);
        let distance = if ahead > 0.0 { ahead } else { (self.camera.look_at - self.camera.eye).length() };
        self.shift((right * now.pan[0] + up * now.pan[1]) * distance);
        motion::zoom(&mut self.camera, now.toward, now.zoom.exp(), self.scene_size);
    }

    fn move_flying(&mut self, seconds: f64) {
        let ([right, up, forward], hurry) = self.fly;
        let speed = SPEED * self.scene_size * if hurry { FASTER } else { 1.0 };
        let wanted = Vec3d::new(right, up, forward) * speed;
        self.velocity = self.velocity + (wanted - self.velocity) * (1.0 - (-seconds / EASE).exp());
        if wanted == Vec3d::ZERO && self.velocity.length() < REST * speed {
            self.velocity = Vec3d::ZERO;
        }
        if self.velocity != Vec3d::ZERO {
            let [right, up, forward] = self.camera.axes();
            let v = self.velocity;
            self.shift((right * v.x + up * v.y + forward * v.z) * seconds);
        }
    }

    /// Move without turning; the pivot comes along.
    fn shift(&mut self, by: Vec3d) {
        motion::shift(&mut self.camera, by);
        self.pivot = self.pivot.map(|pivot| pivot + by);
    }

    /// The hand is stronger than a flight.
    fn take_over(&mut self) {
        self.flight = None;
    }

    fn stop(&mut self) {
        self.pending = Pending::default();
        self.velocity = Vec3d::ZERO;
        self.turntable = false;
        self.flight = None;
    }
}

impl Pending {
    /// Cut off a share of what is pending, or all if there is little left.
    fn take(&mut self, share: f64) -> Self {
        let mut now = Self { toward: self.toward, ..Self::default() };
        for (now, rest) in now.numbers_mut().into_iter().zip(self.numbers_mut()) {
            *now = if rest.abs() < REST { *rest } else { *rest * share };
            *rest -= *now;
        }
        now
    }

    fn numbers_mut(&mut self) -> [&mut f64; 7] {
        let Self { orbit: [a, b], look: [c, d], pan: [e, f], zoom, .. } = self;
        [a, b, c, d, e, f, zoom]
    }

    fn is_some(mut self) -> bool {
        self.numbers_mut().into_iter().any(|number| *number != 0.0)
    }
}

fn add(to: &mut [f64; 2], by: [f64; 2]) {
    to[0] += by[0];
    to[1] += by[1];
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: f64 = 1.0 / 60.0;

    fn navigator() -> Navigator {
        Navigator::new(Camera::default(), 2.0)
    }

    /// Let it move until it rests; the number of frames that it took.
    fn settle(navigator: &mut Navigator) -> usize {
        for frame in 0..600 {
            if !navigator.is_moving() {
                return frame;
            }
            navigator.advance(FRAME);
        }
        panic!("it never rests: {navigator:?}");
    }

    #[test]
    fn what_was_asked_for_is_moved_in_the_end_whatever_the_frame_rate() {
        let ends = [1.0 / 240.0, FRAME, 0.09].map(|step| {
            let mut navigator = navigator();
            navigator.orbit([1.0, 0.25]);
            while navigator.is_moving() {
                navigator.advance(step);
            }
            navigator.camera().eye
        });
        assert!((ends[0] - ends[1]).length() < 1e-2 && (ends[1] - ends[2]).length() < 5e-2, "{ends:?}");
    }

    #[test]
    fn motion_ends_soon() {
        let mut navigator = navigator();
        navigator.orbit([0.5, 0.1]);
        navigator.zoom(0.5, Vec3d::ZERO);
        assert!(settle(&mut navigator) < 40);
        navigator.fly([0.0, 0.0, 1.0], false);
        navigator.advance(FRAME);
        assert!(navigator.is_moving());
        navigator.fly([0.0; 3], false);
        assert!(settle(&mut navigator) < 60);
    }

    #[test]
    fn a_flight_ends_exactly_at_its_camera_and_the_hand_can_stop_it() {
        let mut navigator = navigator();
        let there = Camera { eye: Vec3d::new(4.0, 1.0, 1.0), ..Camera::default() };
        navigator.go_to(there);
        assert_eq!(navigator.destination(), there);
        settle(&mut navigator);
        assert_eq!(*navigator.camera(), there);
        navigator.go_to(Camera::default());
        navigator.advance(FRAME);
        navigator.orbit([0.1, 0.0]);
        settle(&mut navigator);
        assert_ne!(*navigator.camera(), Camera::default());
    }

    #[test]
    fn a_picked_point_becomes_the_pivot() {
        let mut navigator = navigator();
        let point = Vec3d::new(0.5, 0.25, 0.0);
        navigator.look_at(point);
        settle(&mut navigator);
        assert_eq!(navigator.pivot(), point);
        let distance = (navigator.camera().eye - point).length();
        navigator.orbit([1.0, 0.0]);
        settle(&mut navigator);
        assert!(((navigator.camera().eye - point).length() - distance).abs() < 1e-9);
    }

    #[test]
    fn a_panned_point_follows_the_cursor() {
        let mut navigator = navigator();
        let before = *navigator.camera();
        navigator.pan([0.5, 0.0]);
        settle(&mut navigator);
        let [right, _, forward] = before.axes();
        let d = before.look_at - navigator.camera().eye;
        assert!((d.dot(right) / (d.dot(forward) * before.half_height()) - 0.5).abs() < 1e-9);
    }

    #[test]
    fn the_turntable_turns_until_it_is_stopped() {
        let mut navigator = navigator();
        navigator.toggle_turntable();
        (0..900).for_each(|_| assert!(navigator.advance(FRAME)));
        assert!((navigator.camera().eye - Camera::default().eye).length() < 1e-6, "once around");
        navigator.toggle_turntable();
        assert!(!navigator.is_moving());
    }
}
