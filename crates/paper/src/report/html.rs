//! The report as one page that needs nothing else: no network, no script, no other file.

use super::{Block, Cell, Drawing, Ending, Number, Picture, Report, Row, Section, Table, style};
use super::{number, percent, spaced};
use crate::measure::Measured;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

impl Report {
    /// The whole report as one HTML page.
    pub fn to_html(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { "The paper repeated: " (self.head.cpu) }
                    style { (PreEscaped(style::page())) }
                }
                body {
                    main {
                        (self.header())
                        @for section in &self.sections { (section.to_html()) }
                        (footer())
                    }
                }
            }
        };
        page.into_string()
    }

    fn header(&self) -> Markup {
        html! {
            header {
                h1 { "Speed optimized recursive ray tracing, repeated" }
                p.lead { (super::markdown::LEAD) }
                @for warning in self.warnings() { p.warning role="status" { (warning) } }
                nav aria-label="Experiments" {
                    ul { @for section in &self.sections { li { a href={ "#" (section.id) } { (short(section)) } } } }
                }
            }
            section {
                h2 { "Where and how" }
                dl { @for (what, value) in self.head.rows() { dt { (what) } dd { (value) } } }
            }
        }
    }

    /// What a reader must know before believing a number.
    pub(super) fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.ending == Ending::Interrupted {
            warnings.push("The run was interrupted: what stands here was measured, the rest is missing.".to_owned());
        }
        for check in self.checks.iter().filter(|check| !check.holds()) {
            let (variant, scene, differing) = (&check.variant, &check.scene, check.differing);
            warnings.push(format!(
                "“{variant}” computed something else in {scene}: {differing} of {} pixels differ, {} may.",
                check.pixels, check.allowed
            ));
        }
        if !self.head.optimised {
            warnings.push("This is a development build: its times are not those of a release.".to_owned());
        }
        warnings
    }
}

/// The title without what comes after the colon.
fn short(section: &Section) -> &str {
    section.title.split(':').next().unwrap_or(section.title)
}

fn footer() -> Markup {
    html! {
        footer {
            p { "Written by " code { "whitted paper" } ". The same numbers for programs: report.json, report.csv." }
        }
    }
}

impl Section {
    fn to_html(&self) -> Markup {
        html! {
            section id=(self.id) {
                h2 { (self.title) }
                p { (self.shows) }
                @for run in self.blocks.chunk_by(|a, b| a.is_picture() && b.is_picture()) {
                    @if run.len() > 1 { div.side-by-side { @for block in run { (block.to_html()) } } }
                    @else { (run[0].to_html()) }
                }
                @if !self.differs.is_empty() { p.differs { b { "Beside the paper: " } (self.differs) } }
                @if !self.complete { p.warning { "The run was interrupted here." } }
            }
        }
    }
}

impl Block {
    fn is_picture(&self) -> bool {
        matches!(self, Self::Picture(_))
    }

    fn to_html(&self) -> Markup {
        match self {
            Self::Table(table) => table.to_html(),
            Self::Drawing(drawing) => drawing.to_html(),
            Self::Picture(picture) => picture.to_html(),
        }
    }
}

impl Drawing {
    fn to_html(&self) -> Markup {
        html! { figure { (PreEscaped(self.inline())) figcaption { span { (self.caption) } } } }
    }
}

impl Picture {
    fn to_html(&self) -> Markup {
        let [width, height] = self.size;
        let data = format!("data:image/png;base64,{}", STANDARD.encode(&self.png));
        html! {
            figure {
                img src=(data) alt=(self.alt) width=(width) height=(height);
                figcaption { span { (self.caption) } }
            }
        }
    }
}

/// Rows from which on a table scrolls by itself.
const TALL: usize = 20;

impl Table {
    fn to_html(&self) -> Markup {
        html! {
            div.scroll.tall[self.rows.len() > TALL] tabindex="0" {
                table {
                    caption { span { (self.caption) } }
                    thead {
                        tr {
                            th scope="col" { (self.corner) }
                            @for (index, column) in self.columns.iter().enumerate() {
                                th.words[self.has_words(index)] scope="col" { (column.name) @if !column.unit.is_empty() { small { (column.unit) } } }
                            }
                        }
                    }
                    tbody { @for row in &self.rows { (row.to_html()) } }
                }
            }
        }
    }
}

impl Table {
    fn has_words(&self, column: usize) -> bool {
        self.rows.first().is_some_and(|row| matches!(row.cells.get(column), Some(Cell::Text(_))))
    }
}

impl Row {
    fn to_html(&self) -> Markup {
        html! {
            tr.classic[self.of_paper] {
                th scope="row" { (self.name) }
                @for cell in &self.cells { (cell.to_html()) }
            }
        }
    }
}

impl Cell {
    fn to_html(&self) -> Markup {
        match self {
            Self::Empty => html! { td { "–" } },
            Self::Text(words) => html! { td.words { (words) } },
            Self::Count(count) => html! { td { (spaced(*count)) } },
            Self::Number(Number { measured, paper }) => html! {
                td {
                    @match measured {
                        Some(measured) => { (median(measured)) @for line in details(measured) { small { (line) } } }
                        None => { @if paper.is_none() { "–" } }
                    }
                    @match (measured, paper) {
                        (None, Some(paper)) => { span.printed { (number(*paper)) } }
                        (Some(_), Some(paper)) => { small.printed { "paper " (number(*paper)) } }
                        (_, None) => {}
                    }
                }
            },
        }
    }
}

/// The median, marked if it is extrapolated.
pub(super) fn median(measured: &Measured) -> String {
    let about = if measured.traced < 1.0 { "≈ " } else { "" };
    format!("{about}{}", number(measured.median))
}

/// Spread and part of the pixels, where there is something to say.
pub(super) fn details(measured: &Measured) -> Vec<String> {
    let spread = (measured.rounds > 1).then(|| format!("{}\u{a0}– {}", number(measured.low), number(measured.high)));
    let part = (measured.traced < 1.0).then(|| format!("{} traced", percent(measured.traced)));
    spread.into_iter().chain(part).collect()
}
