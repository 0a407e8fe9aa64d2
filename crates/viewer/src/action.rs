//! What a key asks for: one table, from which the cheat sheet is made too.

use crate::input::Key;

/// Something that a key, a script or a panel asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Look along −z, −x or −y of the scene's own directions.
    Side(Side),
    /// Back to the camera with which the scene was opened.
    Reset,
    /// Move along the view until everything is in the picture.
    FrameAll,
    /// The next camera of the scene.
    NextCamera,
    /// Turn around the pivot, or stop.
    Turntable,
    /// Read the scene again.
    Reload,
    /// The next view: picture, normals, …
    NextView,
    /// The view before.
    PreviousView,
    /// Print the camera as it is written in a scene file, and copy it.
    CopyCamera,
    /// Save the finished picture as it is seen.
    Save,
    /// Save its linear colours.
    SaveLight,
    /// Begin or end to record the way of the camera.
    Record,
    /// Show or hide the cheat sheet.
    Help,
    /// Show or hide the panel.
    Panel,
    /// Show or hide everything but the picture.
    Clean,
    /// Close what is open, or the window.
    Close,
}

/// A side of the scene to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From the front.
    Front,
    /// From the right.
    Right,
    /// From above.
    Top,
}

/// Keys, what they ask for and how the cheat sheet says it. As in F3D where F3D has them.
pub const KEYS: &[(Key, Action, &str)] = &[
    (Key::Char('1'), Action::Side(Side::Front), "front view"),
    (Key::Char('3'), Action::Side(Side::Right), "right view"),
    (Key::Char('7'), Action::Side(Side::Top), "top view"),
    (Key::Enter, Action::Reset, "reset the camera"),
    (Key::Char('f'), Action::FrameAll, "frame everything"),
    (Key::Char('c'), Action::NextCamera, "next camera of the scene"),
    (Key::Space, Action::Turntable, "turntable"),
    (Key::Up, Action::Reload, "reload the scene"),
    (Key::Char('m'), Action::NextView, "next view (Shift: previous)"),
    (Key::Char('p'), Action::CopyCamera, "copy and print the camera"),
    (Key::Function(12), Action::Save, "save the picture (Shift: as EXR)"),
    (Key::Char('r'), Action::Record, "record the camera's way"),
    (Key::Char('h'), Action::Help, "this cheat sheet"),
    (Key::Tab, Action::Panel, "panel"),
    (Key::Char('o'), Action::Clean, "picture only"),
    (Key::Escape, Action::Close, "close"),
];

/// What the mouse and held keys do, for the cheat sheet.
pub const GESTURES: &[(&str, &str)] = &[
    ("Left drag", "orbit"),
    ("Shift + left, or middle drag", "pan"),
    ("Wheel", "zoom to the cursor"),
    ("Middle click", "look at this point, orbit around it"),
    ("Right drag", "look around"),
    ("W A S D, E Q", "fly (Shift: faster)"),
    ("Click", "what is this pixel?"),
];

impl Action {
    /// What a pressed key asks for.
    pub fn of(key: Key, shift: bool) -> Option<Self> {
        let action = KEYS.iter().find(|(known, _, _)| *known == key).map(|(_, action, _)| *action)?;
        Some(match action {
            Self::NextView if shift => Self::PreviousView,
            Self::Save if shift => Self::SaveLight,
            _ => action,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn no_key_asks_for_two_things() {
        let keys: HashSet<Key> = KEYS.iter().map(|(key, _, _)| *key).collect();
        assert_eq!(keys.len(), KEYS.len());
        for fly in ['w', 'a', 's', 'd', 'e', 'q'] {
            assert_eq!(Action::of(Key::Char(fly), false), None, "{fly} flies");
        }
        assert_eq!(Action::of(Key::Char('m'), true), Some(Action::PreviousView));
        assert_eq!(Action::of(Key::Function(12), true), Some(Action::SaveLight));
    }
}
