//! Tables: rows of cells under columns with units.

use crate::measure::Measured;
use serde::Serialize;

/// Numbers in rows.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Unique in the report.
    pub id: String,
    /// What stands above.
    pub caption: String,
    /// What the first column names.
    pub corner: &'static str,
    /// All columns but the first.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A column.
#[derive(Clone, Debug, Serialize)]
pub struct Column {
    /// Heading.
    pub name: String,
    /// Unit of its numbers; empty for counts and ratios.
    pub unit: &'static str,
}

/// A row.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What it is about.
    pub name: String,
    /// True for what the paper has, or the paper's renderer does; false for what is ours.
    pub of_paper: bool,
    /// One cell for each column.
    pub cells: Vec<Cell>,
}

/// What stands at a row and a column.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Nothing: it was not measured.
    Empty,
    /// Words.
    Text(String),
    /// A whole number, counted.
    Count(u64),
    /// A number.
    Number(Number),
}

/// A number of ours, the paper's, or both.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Number {
    /// What was measured in this run.
    pub measured: Option<Measured>,
    /// What the paper prints.
    pub paper: Option<f64>,
}

impl Column {
    /// A column of numbers in this unit.
    pub(crate) fn new(name: impl Into<String>, unit: &'static str) -> Self {
        Self { name: name.into(), unit }
    }
}

impl Cell {
    /// What was measured beside what the paper prints, if there is either.
    pub(crate) fn beside(measured: Option<Measured>, paper: Option<f64>) -> Self {
        match (measured, paper) {
            (None, None) => Self::Empty,
            _ => Self::Number(Number { measured, paper }),
        }
    }

    /// A number that is counted or derived, not a median of rounds.
    pub(crate) fn exact(value: f64) -> Self {
        Self::beside(Some(Measured::exact(value)), None)
    }

    /// What was measured, if it is a number.
    pub fn measured(&self) -> Option<&Measured> {
        match self {
            Self::Number(number) => number.measured.as_ref(),
            _ => None,
        }
    }
}
