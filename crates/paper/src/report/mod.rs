//! The report as data; beside it what makes files of it.

mod csv;
mod files;
mod format;
mod head;
mod html;
mod markdown;
mod style;
mod table;

pub use files::File;
pub(crate) use format::{number, percent, plural, spaced};
pub use head::Head;
pub use table::{Cell, Column, Number, Row, Table};

use crate::Experiment;
use crate::measure::Check;
use serde::Serialize;

/// Everything that was measured in one run.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Where and how.
    pub head: Head,
    /// How the run ended.
    pub ending: Ending,
    /// One for each experiment that was begun.
    pub sections: Vec<Section>,
    /// What each variant computed beside the default.
    pub checks: Vec<Check>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// Everything was measured, and every variant computed what it must.
    Complete,
    /// The user stopped it; what stands here was measured.
    Interrupted,
    /// A variant computed something else: see [`Report::checks`].
    Wrong,
}

/// One experiment.
#[derive(Clone, Debug, Serialize)]
pub struct Section {
    /// Name of the experiment.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What it shows, in a sentence.
    pub shows: String,
    /// Where and why it differs from the paper, in a sentence or two; may be empty.
    pub differs: String,
    /// False if the run was stopped in it.
    pub complete: bool,
    /// Tables, drawings and pictures, from top to bottom.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Block {
    /// Numbers.
    Table(Table),
    /// Lines and shapes.
    Drawing(Drawing),
    /// Pixels.
    Picture(Picture),
}

/// A chart or a diagram.
#[derive(Clone, Debug, Serialize)]
pub struct Drawing {
    /// Unique in the report; the name of its file.
    pub id: String,
    /// What stands below.
    pub caption: String,
    /// What it looks like, for those who cannot see it.
    pub alt: String,
    /// The drawing, coloured by the classes of the report's style.
    #[serde(skip)]
    pub svg: svg::Document,
}

/// A picture.
#[derive(Clone, Debug, Serialize)]
pub struct Picture {
    /// Unique in the report; the name of its file.
    pub id: String,
    /// What stands below.
    pub caption: String,
    /// What it looks like, for those who cannot see it.
    pub alt: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The file.
    #[serde(skip)]
    pub png: Vec<u8>,
}

impl Section {
    /// An empty section.
    pub(crate) fn new(experiment: Experiment) -> Self {
        let (id, title) = (experiment.name(), experiment.title());
        Self { id, title, shows: String::new(), differs: String::new(), complete: false, blocks: Vec::new() }
    }

    /// The tables, from top to bottom.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Table(table) => Some(table),
            _ => None,
        })
    }
}
