//! What a person does with mouse and keyboard, whatever window system tells it.

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// The pointer is at this pixel, counted from the top left corner of the picture.
    Pointer([f64; 2]),
    /// The pointer has left the window.
    PointerGone,
    /// A button of the mouse was pressed or released.
    Button(Button, bool),
    /// The wheel was turned by so many notches; positive is away from the person.
    Wheel(f64),
    /// A key was pressed or released. A key that is held is pressed once.
    Key(Key, bool),
    /// A key or keys gave this text.
    Text(String),
    /// These modifiers are held now.
    Modifiers(Modifiers),
    /// The window is the one to type into, or no longer: then nothing is held any more.
    Focus(bool),
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The left one.
    Left,
    /// The middle one, or the wheel.
    Middle,
    /// The right one.
    Right,
}

/// Modifier keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Shift.
    pub shift: bool,
    /// Control, or Command.
    pub control: bool,
    /// Alt, or Option.
    pub alt: bool,
}

/// A key that the viewer or its panels understand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// A letter, in lower case, or a digit.
    Char(char),
    /// Return.
    Enter,
    /// Escape.
    Escape,
    /// Tabulator.
    Tab,
    /// Space bar.
    Space,
    /// Delete to the left.
    Backspace,
    /// Delete to the right.
    Delete,
    /// Arrow.
    Up,
    /// Arrow.
    Down,
    /// Arrow.
    Left,
    /// Arrow.
    Right,
    /// A key in the top row.
    Function(u8),
}

impl Key {
    /// Keys that have no character, by the names that scripts use.
    const NAMED: [(&'static str, Self); 10] = [
        ("enter", Self::Enter),
        ("escape", Self::Escape),
        ("tab", Self::Tab),
        ("space", Self::Space),
        ("backspace", Self::Backspace),
        ("delete", Self::Delete),
        ("up", Self::Up),
        ("down", Self::Down),
        ("left", Self::Left),
        ("right", Self::Right),
    ];

    /// The key of this name, such as `h`, `7`, `enter` or `f12`, in any case of letters.
    pub fn by_name(name: &str) -> Option<Self> {
        let name = name.to_lowercase();
        let mut chars = name.chars();
        if let (Some(c), None) = (chars.next(), chars.next()) {
            return c.is_ascii_alphanumeric().then_some(Self::Char(c));
        }
        let function = || name.strip_prefix('f')?.parse().ok().filter(|n| (1..=12).contains(n)).map(Self::Function);
        Self::NAMED.iter().find(|(known, _)| *known == name).map(|(_, key)| *key).or_else(function)
    }

    /// The key as the cheat sheet calls it.
    pub fn label(self) -> String {
        match self {
            Self::Char(c) => c.to_uppercase().collect(),
            Self::Function(n) => format!("F{n}"),
            Self::Escape => "Esc".to_owned(),
            _ => {
                let name = Self::NAMED.iter().find(|(_, key)| *key == self).map_or("", |(name, _)| name);
                name[..1].to_uppercase() + &name[1..]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_names() {
        for (name, key) in Key::NAMED {
            assert_eq!(Key::by_name(name), Some(key));
            assert!(!key.label().is_empty());
        }
        assert_eq!(Key::by_name("F12"), Some(Key::Function(12)));
        assert_eq!(Key::by_name("W"), Some(Key::Char('w')));
        assert_eq!(Key::Tab.label(), "Tab");
        for bad in ["", "f0", "f13", "fx", "ß", "shift", "10"] {
            assert_eq!(Key::by_name(bad), None, "{bad}");
        }
    }
}
