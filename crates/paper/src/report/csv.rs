//! The numbers of all tables, one a line.

use super::{Cell, Number, Report, Section, Table};

/// Names of the columns.
const COLUMNS: &str = "section,table,row,column,unit,median,low,high,rounds,traced,paper,words";

impl Report {
    /// A line for each cell that has something in it; a number that was not measured or not printed is empty.
    pub fn to_csv(&self) -> String {
        let mut out = format!("{COLUMNS}\n");
        for section in &self.sections {
            section.tables().for_each(|table| add(&mut out, section, table));
        }
        out
    }
}

fn add(out: &mut String, section: &Section, table: &Table) {
    for row in &table.rows {
        for (column, cell) in table.columns.iter().zip(&row.cells) {
            let Some(values) = values(cell) else { continue };
            let names = [section.id, &table.id, &row.name, &column.name, column.unit].map(field);
            let line: Vec<String> = names.into_iter().chain(values).collect();
            *out += &(line.join(",") + "\n");
        }
    }
}

/// Median to words; `None` for an empty cell.
fn values(cell: &Cell) -> Option<[String; 7]> {
    match cell {
        Cell::Empty => None,
        Cell::Text(words) => {
            let mut values: [String; 7] = Default::default();
            values[6] = field(words);
            Some(values)
        }
        Cell::Count(count) => {
            let mut values: [String; 7] = Default::default();
            values[0] = count.to_string();
            Some(values)
        }
        Cell::Number(Number { measured, paper }) => {
            let text = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let of = |f: fn(&crate::Measured) -> f64| text(measured.as_ref().map(f));
            let rounds = measured.map_or(String::new(), |m| m.rounds.to_string());
            Some([
                of(|m| m.median),
                of(|m| m.low),
                of(|m| m.high),
                rounds,
                of(|m| m.traced),
                text(*paper),
                String::new(),
            ])
        }
    }
}

/// Quoted where it must be (RFC 4180); numbers in names without the gaps that people like.
fn field(text: &str) -> String {
    let text = &text.replace('\u{202f}', "");
    if text.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.clone() }
}
