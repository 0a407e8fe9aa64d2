//! Scripts: what a person would do, a line each, for tests and documentation. They run without a display, on the very
//! code that serves the window.

mod run;

pub use run::{ScriptFailure, run};

use crate::input::{Button, Key, Modifiers};
use std::path::PathBuf;
use std::time::Duration;

/// One line of a script.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Let the window have this size.
    Size([u32; 2]),
    /// Wait until the scene is read, the picture finished and nothing moves.
    WaitRefined,
    /// Wait until the scene is broken.
    WaitTrouble,
    /// Wait.
    Wait(Duration),
    /// Press and release a key, with modifiers.
    Key(Modifiers, Key),
    /// Press or release a key.
    Hold(Key, bool),
    /// Move the pointer to a pixel.
    Move([f64; 2]),
    /// Press and release a button of the mouse at a pixel.
    Click(Button, [f64; 2]),
    /// Drag from a pixel to another one within so long, with modifiers.
    Drag(Button, Modifiers, [[f64; 2]; 2], Duration),
    /// Turn the wheel by so many notches.
    Wheel(f64),
    /// Save the window as it is, with all that lies over the picture.
    Screenshot(PathBuf),
    /// Save the finished picture.
    Save(PathBuf),
    /// Print how many pictures a second were shown lately, and how good they were.
    Report,
    /// Close the window.
    Quit,
}

/// What is wrong with a script.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct ScriptError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub what: String,
}

/// Read a script: a step a line, `#` begins a comment. `docs/viewer.md` lists the steps.
///
/// # Errors
/// The first line that is no step.
pub fn parse(text: &str) -> Result<Vec<Step>, ScriptError> {
    let mut steps = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = line.split_whitespace().collect();
        if !words.is_empty() {
            steps.push(step(&words).map_err(|what| ScriptError { line: number, what })?);
        }
    }
    Ok(steps)
}

/// How steps are written, for messages.
const USAGE: [(&str, &str); 14] = [
    ("size", "size WIDTHxHEIGHT"),
    ("wait", "wait refined|trouble|SECONDS"),
    ("key", "key [shift+|control+]KEY"),
    ("press", "press KEY"),
    ("release", "release KEY"),
    ("move", "move X Y"),
    ("click", "click [left|middle|right] X Y"),
    ("drag", "drag [shift+][left|middle|right] X Y X Y [SECONDS]"),
    ("orbit", "orbit X Y X Y [SECONDS]"),
    ("wheel", "wheel NOTCHES"),
    ("screenshot", "screenshot FILE.png"),
    ("save", "save FILE.png|FILE.exr"),
    ("report", "report"),
    ("quit", "quit"),
];

fn step(words: &[&str]) -> Result<Step, String> {
    let Some((_, usage)) = USAGE.iter().find(|(name, _)| *name == words[0]) else {
        let known = USAGE.map(|(name, _)| name).join(", ");
        return Err(format!("there is no step '{}'; there are: {known}", words[0]));
    };
    parse_step(words).ok_or_else(|| format!("expected: {usage}"))
}

fn parse_step(words: &[&str]) -> Option<Step> {
    Some(match *words {
        ["size", size] => Step::Size(parse_size(size)?),
        ["wait", "refined"] => Step::WaitRefined,
        ["wait", "trouble"] => Step::WaitTrouble,
        ["wait", seconds] => Step::Wait(parse_seconds(seconds)?),
        ["key", key] => {
            let (modifiers, key) = with_modifiers(key);
            Step::Key(modifiers, Key::by_name(key)?)
        }
        ["press", key] => Step::Hold(Key::by_name(key)?, true),
        ["release", key] => Step::Hold(Key::by_name(key)?, false),
        ["move", x, y] => Step::Move(parse_point(x, y)?),
        ["click", x, y] => Step::Click(Button::Left, parse_point(x, y)?),
        ["click", button, x, y] => Step::Click(parse_button(button)?, parse_point(x, y)?),
        ["orbit", ref places @ ..] => parse_drag("left", places)?,
        ["drag", button, ref places @ ..] => parse_drag(button, places)?,
        ["wheel", notches] => Step::Wheel(notches.parse().ok().filter(|n: &f64| n.is_finite())?),
        ["screenshot", file] => Step::Screenshot(file.into()),
        ["save", file] => Step::Save(file.into()),
        ["report"] => Step::Report,
        ["quit"] => Step::Quit,
        _ => return None,
    })
}

fn parse_drag(button: &str, places: &[&str]) -> Option<Step> {
    let (modifiers, button) = with_modifiers(button);
    let (seconds, [x0, y0, x1, y1]) = match *places {
        [x0, y0, x1, y1] => ("0.25", [x0, y0, x1, y1]),
        [x0, y0, x1, y1, seconds] => (seconds, [x0, y0, x1, y1]),
        _ => return None,
    };
    let ends = [parse_point(x0, y0)?, parse_point(x1, y1)?];
    Some(Step::Drag(parse_button(button)?, modifiers, ends, parse_seconds(seconds)?))
}

/// `shift+control+rest`.
fn with_modifiers(text: &str) -> (Modifiers, &str) {
    let (mut modifiers, mut rest) = (Modifiers::default(), text);
    while let Some((name, tail)) = rest.split_once('+') {
        match name {
            "shift" => modifiers.shift = true,
            "control" => modifiers.control = true,
            "alt" => modifiers.alt = true,
            _ => break,
        }
        rest = tail;
    }
    (modifiers, rest)
}

fn parse_size(text: &str) -> Option<[u32; 2]> {
    const LARGEST: u32 = 16_384;
    let (width, height) = text.split_once('x')?;
    let size = [width.parse().ok()?, height.parse().ok()?];
    size.iter().all(|side| (1..=LARGEST).contains(side)).then_some(size)
}

fn parse_seconds(text: &str) -> Option<Duration> {
    const LONGEST: f64 = 3600.0;
    text.parse().ok().filter(|seconds| (0.0..=LONGEST).contains(seconds)).map(Duration::from_secs_f64)
}

fn parse_point(x: &str, y: &str) -> Option<[f64; 2]> {
    let point: [f64; 2] = [x.parse().ok()?, y.parse().ok()?];
    point.iter().all(|coordinate| coordinate.is_finite()).then_some(point)
}

fn parse_button(text: &str) -> Option<Button> {
    match text {
        "left" => Some(Button::Left),
        "middle" => Some(Button::Middle),
        "right" => Some(Button::Right),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_read() {
        let text =
            "# a comment\nsize 640x480\nwait refined # another\n\n key shift+M \norbit 10 20 30 40\nclick middle 5 6\n";
        let shift = Modifiers { shift: true, ..Modifiers::default() };
        let expected = [
            Step::Size([640, 480]),
            Step::WaitRefined,
            Step::Key(shift, Key::Char('m')),
            Step::Drag(Button::Left, Modifiers::default(), [[10.0, 20.0], [30.0, 40.0]], Duration::from_millis(250)),
            Step::Click(Button::Middle, [5.0, 6.0]),
        ];
        assert_eq!(parse(text).unwrap(), expected);
    }

    #[test]
    fn each_step_says_how_it_is_written() {
        for (name, usage) in USAGE {
            let complaint = parse(&format!("\n{name} one two three four five six seven")).unwrap_err();
            assert_eq!((complaint.line, complaint.what), (2, format!("expected: {usage}")));
        }
        assert!(parse("jump 3").unwrap_err().what.starts_with("there is no step 'jump'"));
    }

    #[test]
    fn impossible_numbers_are_refused() {
        for bad in ["wait nan", "wait -1", "wait 1e9", "size 0x1", "size 99999x1", "move inf 0", "wheel nan", "key f99"]
        {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
