//! Horizontal bars on a logarithmic scale, the paper's below ours.

use super::WIDTH;
use super::canvas::{Anchor, document, legend, line, rectangle, text};
use super::scale::{Scale, tick_name};
use crate::measure::Measured;
use crate::report::number;
use svg::Document;

/// Bars under one heading.
pub(crate) struct Group {
    pub(crate) name: String,
    pub(crate) bars: Vec<Bar>,
}

/// What one row says.
pub(crate) struct Bar {
    pub(crate) name: String,
    /// False for what goes beyond the paper.
    pub(crate) of_paper: bool,
    pub(crate) measured: Option<Measured>,
    pub(crate) paper: Option<f64>,
}

/// Where bars begin and where the longest ends; beyond it is room for its number.
const FROM: f64 = 146.0;
const TO: f64 = 310.0;
const _: () = assert!(TO < WIDTH);
/// Height of a row, and what the paper's bar adds to it.
const ROW: f64 = 16.0;
const PAPER_ROW: f64 = 12.0;
/// Heights of a group's name, of the legend above all and of the axis below.
const HEADING: f64 = 26.0;
const LEGEND: f64 = 18.0;
const AXIS: f64 = 34.0;

/// The chart of `groups`; `unit` stands at the axis.
pub(crate) fn bar_chart(groups: &[Group], unit: &str) -> Document {
    let all = || groups.iter().flat_map(|group| &group.bars);
    let ends = |bar: &Bar| [bar.measured.map(|m| m.low), bar.measured.map(|m| m.high), bar.paper];
    let scale = Scale::around(all().flat_map(ends).flatten(), FROM, TO).with_room();
    let rows: f64 = all().map(height).sum();
    let bottom = LEGEND + HEADING * groups.len() as f64 + rows;
    let mut out = legend(document(bottom + AXIS), LEGEND - 6.0, &entries(groups));
    out = axis(out, &scale, bottom, unit);
    let mut y = LEGEND;
    for group in groups {
        y += HEADING;
        out = out.add(text(0.0, y - 8.0, "heading", Anchor::Start, &group.name));
        for bar in &group.bars {
            out = draw(out, bar, &scale, y);
            y += height(bar);
        }
    }
    out
}

/// What the colours mean, of those that occur.
fn entries(groups: &[Group]) -> Vec<(&'static str, &'static str)> {
    let any = |is: fn(&Bar) -> bool| groups.iter().flat_map(|group| &group.bars).any(is);
    let all = [
        (any(|bar| bar.of_paper), ("classic", "the paper's, measured")),
        (any(|bar| !bar.of_paper), ("ours", "ours, measured")),
        (any(|bar| bar.paper.is_some()), ("paper", "printed")),
    ];
    all.into_iter().filter(|(occurs, _)| *occurs).map(|(_, entry)| entry).collect()
}

fn height(bar: &Bar) -> f64 {
    if bar.paper.is_some() { ROW + PAPER_ROW } else { ROW }
}

fn axis(mut out: Document, scale: &Scale, bottom: f64, unit: &str) -> Document {
    for tick in scale.ticks() {
        let x = scale.at(tick);
        out = out.add(line([x, LEGEND + 4.0], [x, bottom + 2.0], "grid")).add(text(
            x,
            bottom + 14.0,
            "tick",
            Anchor::Middle,
            tick_name(tick),
        ));
    }
    out.add(text((FROM + TO) / 2.0, bottom + 29.0, "tick", Anchor::Middle, unit))
}

fn draw(mut out: Document, bar: &Bar, scale: &Scale, y: f64) -> Document {
    out = out.add(text(FROM - 6.0, y + 9.0, "label", Anchor::End, &bar.name));
    if let Some(measured) = bar.measured {
        let (end, class) = (scale.at(measured.median), if bar.of_paper { "classic" } else { "ours" });
        let name = value(&measured);
        let [low, high] = [measured.low, measured.high].map(|end| scale.at(end));
        out = out
            .add(rectangle(FROM, y + 1.0, (end - FROM).max(1.0), 9.0, class, &format!("{}: {name}", bar.name)))
            .add(line([low, y + 5.5], [high, y + 5.5], "whisker"))
            .add(text(end.max(high) + 4.0, y + 9.0, "value", Anchor::Start, name));
    }
    if let Some(paper) = bar.paper {
        let end = scale.at(paper);
        let tip = format!("{} in the paper: {}", bar.name, number(paper));
        out = out.add(rectangle(FROM, y + 12.5, (end - FROM).max(1.0), 7.0, "paper", &tip)).add(text(
            end + 4.0,
            y + 20.0,
            "value muted",
            Anchor::Start,
            number(paper),
        ));
    }
    out
}

fn value(measured: &Measured) -> String {
    let about = if measured.traced < 1.0 { "≈ " } else { "" };
    format!("{about}{}", number(measured.median))
}
