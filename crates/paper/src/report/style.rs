//! Colours and letters, for light and dark.

use super::Drawing;
use svg::node::element::Style;

/// The colours, by the reader's preference.
const COLORS: &str = include_str!("colors.css");
/// What drawings look like.
const DRAWING: &str = include_str!("drawing.css");
/// What the page looks like.
const PAGE: &str = include_str!("page.css");

/// The style of the page.
pub(super) fn page() -> String {
    [COLORS, PAGE, DRAWING].concat()
}

impl Drawing {
    /// The drawing as a file of its own, which brings its colours.
    pub(super) fn file(&self) -> String {
        let background = "svg { background: var(--card); }\n";
        let style = Style::new([COLORS, DRAWING, background].concat());
        format!("{}\n", self.accessible().add(style))
    }

    /// The drawing as a part of the page.
    pub(super) fn inline(&self) -> String {
        self.accessible().to_string()
    }

    /// With what it shows, for those who cannot see it.
    fn accessible(&self) -> svg::Document {
        // The writer of attributes leaves quotation marks as they are.
        self.svg.clone().set("role", "img").set("aria-label", self.alt.replace('"', "″"))
    }
}
