//! From what a person does to what the library of the panels understands.

use crate::input::{Button, Input, Key, Modifiers};
use egui::{Event, MouseWheelUnit, PointerButton, Pos2, RawInput, TouchPhase, pos2, vec2};

/// Events that wait for the next layout.
#[derive(Debug, Default)]
pub(super) struct Events {
    waiting: Vec<Event>,
    pointer: Option<Pos2>,
    modifiers: egui::Modifiers,
    is_out_of_focus: bool,
}

impl Events {
    /// Where the pointer is, in units of layout.
    pub(super) fn pointer(&self) -> Option<Pos2> {
        self.pointer
    }

    pub(super) fn push(&mut self, input: &Input, scale: f32) {
        match input {
            Input::Pointer([x, y]) => {
                let at = pos2(*x as f32 / scale, *y as f32 / scale);
                self.pointer = Some(at);
                self.waiting.push(Event::PointerMoved(at));
            }
            Input::PointerGone => {
                self.pointer = None;
                self.waiting.push(Event::PointerGone);
            }
            Input::Button(button, pressed) => {
                let (Some(pos), modifiers) = (self.pointer, self.modifiers) else { return };
                let (button, pressed) = (pointer_button(*button), *pressed);
                self.waiting.push(Event::PointerButton { pos, button, pressed, modifiers });
            }
            Input::Wheel(notches) => self.waiting.push(Event::MouseWheel {
                unit: MouseWheelUnit::Line,
                delta: vec2(0.0, *notches as f32),
                phase: TouchPhase::Move,
                modifiers: self.modifiers,
            }),
            Input::Key(key, pressed) => self.waiting.extend(named(*key).map(|key| Event::Key {
                key,
                physical_key: None,
                pressed: *pressed,
                repeat: false,
                modifiers: self.modifiers,
            })),
            Input::Text(text) => self.waiting.push(Event::Text(text.clone())),
            Input::Modifiers(modifiers) => self.modifiers = translated(*modifiers),
            Input::Focus(has_focus) => {
                self.is_out_of_focus = !has_focus;
                self.waiting.push(Event::WindowFocused(*has_focus));
            }
        }
    }

    /// Hand everything over.
    pub(super) fn move_to(&mut self, raw: &mut RawInput) {
        raw.events = std::mem::take(&mut self.waiting);
        raw.modifiers = self.modifiers;
        raw.focused = !self.is_out_of_focus;
    }
}

fn pointer_button(button: Button) -> PointerButton {
    match button {
        Button::Left => PointerButton::Primary,
        Button::Middle => PointerButton::Middle,
        Button::Right => PointerButton::Secondary,
    }
}

fn translated(modifiers: Modifiers) -> egui::Modifiers {
    let Modifiers { shift, control, alt } = modifiers;
    egui::Modifiers { alt, ctrl: control, shift, mac_cmd: false, command: control }
}

fn named(key: Key) -> Option<egui::Key> {
    match key {
        Key::Char(c) => egui::Key::from_name(&c.to_uppercase().to_string()),
        Key::Enter => Some(egui::Key::Enter),
        Key::Escape => Some(egui::Key::Escape),
        Key::Tab => Some(egui::Key::Tab),
        Key::Space => Some(egui::Key::Space),
        Key::Backspace => Some(egui::Key::Backspace),
        Key::Delete => Some(egui::Key::Delete),
        Key::Up => Some(egui::Key::ArrowUp),
        Key::Down => Some(egui::Key::ArrowDown),
        Key::Left => Some(egui::Key::ArrowLeft),
        Key::Right => Some(egui::Key::ArrowRight),
        Key::Function(_) => None,
    }
}
