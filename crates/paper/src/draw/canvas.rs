//! The few shapes that drawings are made of.

use super::WIDTH;
use svg::Document;
use svg::node::element::{Circle, Line, Rectangle, Text, Title};

/// A drawing of this height.
pub(super) fn document(height: f64) -> Document {
    Document::new().set("viewBox", (0.0, 0.0, WIDTH, rounded(height))).set("class", "drawing")
}

/// Where a text is held.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

pub(super) fn text(x: f64, y: f64, class: &str, anchor: Anchor, content: impl Into<String>) -> Text {
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let text = Text::new(content).set("x", rounded(x)).set("y", rounded(y));
    text.set("class", class).set("text-anchor", anchor)
}

/// A rectangle; what it says when pointed at.
pub(super) fn rectangle(x: f64, y: f64, width: f64, height: f64, class: &str, tip: &str) -> Rectangle {
    let rectangle = Rectangle::new().set("x", rounded(x)).set("y", rounded(y)).set("class", class);
    let rectangle = rectangle.set("width", rounded(width.max(0.0))).set("height", rounded(height.max(0.0)));
    if tip.is_empty() { rectangle } else { rectangle.add(Title::new(tip)) }
}

pub(super) fn line(from: [f64; 2], to: [f64; 2], class: &str) -> Line {
    let line = Line::new().set("x1", rounded(from[0])).set("y1", rounded(from[1])).set("class", class);
    line.set("x2", rounded(to[0])).set("y2", rounded(to[1]))
}

pub(super) fn circle([x, y]: [f64; 2], radius: f64, class: &str, tip: &str) -> Circle {
    let circle =
        Circle::new().set("cx", rounded(x)).set("cy", rounded(y)).set("r", rounded(radius)).set("class", class);
    if tip.is_empty() { circle } else { circle.add(Title::new(tip)) }
}

/// To a hundredth of a unit: more is not seen and makes files large.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// A row of coloured squares with what they stand for, from `x` on.
pub(super) fn legend(mut document: Document, y: f64, entries: &[(&str, &str)]) -> Document {
    const SQUARE: f64 = 9.0;
    /// A letter of the legend's size is about this wide.
    const LETTER: f64 = 5.6;
    let mut x = 0.0;
    for (class, name) in entries {
        document = document.add(rectangle(x, y - SQUARE, SQUARE, SQUARE, class, "")).add(text(
            x + SQUARE + 4.0,
            y,
            "label",
            Anchor::Start,
            *name,
        ));
        x += SQUARE + 18.0 + LETTER * name.chars().count() as f64;
    }
    document
}
