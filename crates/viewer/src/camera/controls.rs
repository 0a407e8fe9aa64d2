//! From mouse and keys to motions of the camera.

use super::Navigator;
use crate::input::{Button, Input, Key, Modifiers};
use whitted::math::Vec3d;

/// A drag over the whole height of the picture turns by this many radians: half a turn.
const TURN: f64 = std::f64::consts::PI;

/// A drag over the whole height of the picture turns the view by so many fields of view when looking around.
const LOOK: f64 = 1.0;

/// One notch of the wheel comes nearer by this factor, as a logarithm.
const NOTCH: f64 = -0.16;

/// A press that moves no further than this, in pixels, is a click.
const CLICK: f64 = 4.0;

/// A button was pressed and released at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Click {
    pub(crate) button: Button,
    pub(crate) at: [f64; 2],
}

/// What is held at the moment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Controls {
    pointer: Option<[f64; 2]>,
    drag: Option<Drag>,
    modifiers: Modifiers,
    held: Vec<char>,
}

#[derive(Clone, Copy, Debug)]
struct Drag {
    button: Button,
    start: [f64; 2],
    is_click: bool,
}

/// Keys that fly, and where: right, up, forward.
const FLY: [(char, [f64; 3]); 6] = [
    ('w', [0.0, 0.0, 1.0]),
    ('s', [0.0, 0.0, -1.0]),
    ('a', [-1.0, 0.0, 0.0]),
    ('d', [1.0, 0.0, 0.0]),
    ('e', [0.0, 1.0, 0.0]),
    ('q', [0.0, -1.0, 0.0]),
];

impl Controls {
    /// The modifiers that are held.
    pub(crate) fn modifiers(&self) -> Modifiers {
        self.modifiers
    }

    /// True while a button is held: the picture is in the person's hand.
    pub(crate) fn is_dragging(&self) -> bool {
        self.drag.is_some()
    }

    /// Take in an event in a picture of this height in pixels; `under` tells what is at a pixel, in the scene. Tells a
    /// click that was completed.
    pub(crate) fn take(
        &mut self,
        input: &Input,
        height: f64,
        navigator: &mut Navigator,
        under: impl Fn([f64; 2]) -> Vec3d,
    ) -> Option<Click> {
        match *input {
            Input::Pointer(at) => self.moved(at, height, navigator),
            Input::Button(button, true) => self.pressed(button),
            Input::Button(button, false) => return self.released(button),
            Input::Wheel(notches) => {
                if let Some(at) = self.pointer {
                    navigator.zoom(NOTCH * notches, under(at));
                }
            }
            Input::Key(Key::Char(c), is_pressed) => self.key(c, is_pressed, navigator),
            Input::Modifiers(modifiers) => {
                self.modifiers = modifiers;
                self.fly(navigator);
            }
            Input::Focus(false) => {
                *self = Self { pointer: self.pointer, ..Self::default() };
                self.fly(navigator);
            }
            Input::PointerGone => {
                if self.drag.is_none() {
                    self.pointer = None;
                }
            }
            Input::Key(..) | Input::Text(_) | Input::Focus(true) => {}
        }
        None
    }

    fn moved(&mut self, at: [f64; 2], height: f64, navigator: &mut Navigator) {
        let before = self.pointer.replace(at).unwrap_or(at);
        let Some(drag) = &mut self.drag else { return };
        if drag.is_click && distance(at, drag.start) <= CLICK {
            return;
        }
        // What was held back to tell a click from a drag is moved now.
        let from = if std::mem::take(&mut drag.is_click) { drag.start } else { before };
        let [dx, dy] = [(at[0] - from[0]) / height, (at[1] - from[1]) / height];
        match drag.button {
            Button::Left if !self.modifiers.shift => navigator.orbit([-dx * TURN, -dy * TURN]),
            Button::Left | Button::Middle => navigator.pan([2.0 * dx, -2.0 * dy]),
            Button::Right => {
                let angle = navigator.camera().vfov.to_radians() * LOOK;
                navigator.look([-dx * angle, -dy * angle]);
            }
        }
    }

    fn pressed(&mut self, button: Button) {
        if let (None, Some(start)) = (self.drag, self.pointer) {
            self.drag = Some(Drag { button, start, is_click: true });
        }
    }

    fn released(&mut self, button: Button) -> Option<Click> {
        let drag = self.drag.take_if(|drag| drag.button == button)?;
        drag.is_click.then_some(Click { button, at: drag.start })
    }

    fn key(&mut self, c: char, is_pressed: bool, navigator: &mut Navigator) {
        if !FLY.iter().any(|(key, _)| *key == c) {
            return;
        }
        self.held.retain(|held| *held != c);
        if is_pressed && !self.modifiers.control {
            self.held.push(c);
        }
        self.fly(navigator);
    }

    fn fly(&self, navigator: &mut Navigator) {
        let mut directions = [0.0; 3];
        for (_, direction) in FLY.iter().filter(|(key, _)| self.held.contains(key)) {
            directions.iter_mut().zip(direction).for_each(|(sum, d)| *sum += d);
        }
        navigator.fly(directions, self.modifiers.shift);
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitted::scene::Camera;

    struct Hand {
        controls: Controls,
        navigator: Navigator,
    }

    impl Hand {
        fn new() -> Self {
            Self { controls: Controls::default(), navigator: Navigator::new(Camera::default(), 1.0) }
        }

        fn does(&mut self, input: Input) -> Option<Click> {
            self.controls.take(&input, 400.0, &mut self.navigator, |_| Vec3d::ZERO)
        }

        fn drags(&mut self, button: Button, by: [f64; 2]) -> Camera {
            self.does(Input::Pointer([100.0, 100.0]));
            self.does(Input::Button(button, true));
            self.does(Input::Pointer([100.0 + by[0], 100.0 + by[1]]));
            assert_eq!(self.does(Input::Button(button, false)), None, "a drag is no click");
            self.rests()
        }

        fn rests(&mut self) -> Camera {
            while self.navigator.is_moving() {
                self.navigator.advance(1.0 / 60.0);
            }
            *self.navigator.camera()
        }
    }

    #[test]
    fn dragging_to_the_right_turns_the_scene_to_the_right() {
        let eye = Hand::new().drags(Button::Left, [200.0, 0.0]).eye;
        assert!((eye - Vec3d::new(-5.0, 0.0, 0.0)).length() < 0.05, "a quarter turn: {eye:?}");
        assert!(Hand::new().drags(Button::Left, [0.0, 50.0]).eye.y > 0.5, "dragging down shows the top");
    }

    #[test]
    fn dragging_with_the_others_pans_and_looks() {
        let panned = Hand::new().drags(Button::Middle, [40.0, 0.0]);
        assert!(panned.eye.x < 0.0 && panned.look_at.x < 0.0 && panned.eye.x == panned.look_at.x);
        let looked = Hand::new().drags(Button::Right, [40.0, 0.0]);
        assert!((looked.eye - Camera::default().eye).length() < 1e-12);
        assert!(looked.look_at.x > 0.0, "to the right");
    }

    #[test]
    fn a_press_that_hardly_moves_is_a_click() {
        let mut hand = Hand::new();
        hand.does(Input::Pointer([10.0, 20.0]));
        hand.does(Input::Button(Button::Middle, true));
        hand.does(Input::Pointer([12.0, 19.0]));
        let click = hand.does(Input::Button(Button::Middle, false));
        assert_eq!(click, Some(Click { button: Button::Middle, at: [10.0, 20.0] }));
        assert!(!hand.navigator.is_moving());
    }

    #[test]
    fn keys_fly_until_released_or_out_of_focus() {
        let mut hand = Hand::new();
        hand.does(Input::Key(Key::Char('w'), true));
        hand.navigator.advance(0.1);
        hand.navigator.advance(0.1);
        assert!(hand.navigator.camera().eye.z < 5.0);
        hand.does(Input::Focus(false));
        hand.rests();
        hand.does(Input::Key(Key::Char('d'), true));
        hand.does(Input::Key(Key::Char('d'), false));
        assert!(hand.rests().eye.x.abs() < 1e-3);
    }

    #[test]
    fn the_wheel_comes_nearer() {
        let mut hand = Hand::new();
        hand.does(Input::Wheel(3.0));
        assert_eq!(hand.rests(), Camera::default(), "a wheel without a pointer points at nothing");
        hand.does(Input::Pointer([3.0, 3.0]));
        hand.does(Input::Wheel(3.0));
        assert!(hand.rests().eye.z < 4.0);
    }
}
