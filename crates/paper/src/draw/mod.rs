//! Charts and diagrams as SVG, coloured by classes so that they follow the light or dark of the page.
//!
//! All are [`WIDTH`] units wide, which is about what a phone has in pixels: there letters keep their size.

mod bars;
mod canvas;
mod kd;
mod lines;
mod scale;

pub(crate) use bars::{Bar, Group, bar_chart};
pub(crate) use kd::{Path, Plan, Rect, Role, plan};
pub(crate) use lines::{Series, line_chart};

/// Width of every drawing, in its own units.
const WIDTH: f64 = 360.0;
