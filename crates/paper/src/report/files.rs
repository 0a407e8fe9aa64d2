//! The files of a report.

use super::{Block, Report};

/// A file of the report.
#[derive(Clone, Debug)]
pub struct File {
    /// Path in the report's folder, with `/` between its parts.
    pub path: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

/// Where the Markdown finds a figure.
pub(super) fn figure(id: &str, ending: &str) -> String {
    format!("figures/{id}.{ending}")
}

impl Report {
    /// All files: the page, the same as Markdown with its figures, as CSV and as JSON.
    pub fn files(&self) -> Vec<File> {
        let file = |path: &str, text: String| File { path: path.to_owned(), bytes: text.into_bytes() };
        let mut files = vec![
            file("report.html", self.to_html()),
            file("report.md", self.to_markdown()),
            file("report.csv", self.to_csv()),
            file("report.json", self.to_json()),
        ];
        for block in self.sections.iter().flat_map(|section| &section.blocks) {
            match block {
                Block::Drawing(drawing) => files.push(file(&figure(&drawing.id, "svg"), drawing.file())),
                Block::Picture(picture) => {
                    files.push(File { path: figure(&picture.id, "png"), bytes: picture.png.clone() });
                }
                Block::Table(_) => {}
            }
        }
        files
    }

    /// Everything but lines and pixels, for programs.
    pub fn to_json(&self) -> String {
        let text = serde_json::to_string_pretty(self);
        // Only maps with keys that are not text, and writers that fail, make errors; there are none.
        text.unwrap_or_default() + "\n"
    }
}
