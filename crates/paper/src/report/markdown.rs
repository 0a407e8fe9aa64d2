//! The report as Markdown, with its figures in files beside it.

use super::html::{details, median};
use super::{Block, Cell, Number, Report, Section, Table, files, number, spaced};

/// What the report is, in two sentences.
pub(super) const LEAD: &str = "Every table and figure of the paper, measured in one run on this machine, beside the \
    numbers that the paper prints and beside what Whitted adds to them. Times are of rendering alone, without reading, \
    building and writing.";

impl Report {
    /// The whole report as Markdown; its pictures are in `figures/`.
    pub fn to_markdown(&self) -> String {
        let mut out = format!("# Speed optimized recursive ray tracing, repeated\n\n{LEAD}\n");
        for warning in self.warnings() {
            out += &format!("\n> **{warning}**\n");
        }
        out += "\n| | |\n| --- | --- |\n";
        for (what, value) in self.head.rows() {
            out += &line([what.to_owned(), value].into_iter());
        }
        self.sections.iter().for_each(|section| out += &section.to_markdown());
        out
    }
}

impl Section {
    fn to_markdown(&self) -> String {
        let mut out = format!("\n## {}\n\n{}\n", self.title, self.shows);
        for block in &self.blocks {
            out += "\n";
            out += &block.to_markdown();
        }
        if !self.differs.is_empty() {
            out += &format!("\n**Beside the paper:** {}\n", self.differs);
        }
        if !self.complete {
            out += "\n> **The run was interrupted here.**\n";
        }
        out
    }
}

impl Block {
    fn to_markdown(&self) -> String {
        let figure = |alt: &str, id: &str, ending: &str, caption: &str| {
            format!("![{}]({})\n\n*{caption}*\n", alt.replace(['[', ']'], ""), files::figure(id, ending))
        };
        match self {
            Self::Table(table) => table.to_markdown(),
            Self::Drawing(drawing) => figure(&drawing.alt, &drawing.id, "svg", &drawing.caption),
            Self::Picture(picture) => figure(&picture.alt, &picture.id, "png", &picture.caption),
        }
    }
}

impl Table {
    fn to_markdown(&self) -> String {
        let heading =
            |name: &str, unit: &str| if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") };
        let names = self.columns.iter().map(|column| heading(&column.name, column.unit));
        let mut out = format!("**{}**\n\n", self.caption);
        out += &line([self.corner.to_owned()].into_iter().chain(names));
        out += &line(["---".to_owned()].into_iter().chain(self.columns.iter().map(|_| "---:".to_owned())));
        for row in &self.rows {
            out += &line([row.name.clone()].into_iter().chain(row.cells.iter().map(Cell::to_markdown)));
        }
        out
    }
}

impl Cell {
    fn to_markdown(&self) -> String {
        match self {
            Self::Empty => "–".to_owned(),
            Self::Text(words) => words.clone(),
            Self::Count(count) => spaced(*count),
            Self::Number(Number { measured, paper }) => {
                let own = measured.as_ref().map(|m| {
                    let details = details(m);
                    let details = if details.is_empty() { String::new() } else { format!(" ({})", details.join("; ")) };
                    median(m) + &details
                });
                let paper = paper.map(|paper| format!("paper {}", number(paper)));
                let both: Vec<String> = own.into_iter().chain(paper).collect();
                if both.is_empty() { "–".to_owned() } else { both.join("; ") }
            }
        }
    }
}

/// A line of a table.
fn line(cells: impl Iterator<Item = String>) -> String {
    let cells: Vec<String> = cells.map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}
