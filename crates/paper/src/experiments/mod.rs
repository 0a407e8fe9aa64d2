//! The experiments, one a file: which variants, in which scenes, and what they show.

pub(crate) mod exact;
pub(crate) mod grid;
pub(crate) mod kd_tree;
mod kernels;
mod mesh;
pub(crate) mod pictures;
pub(crate) mod promise;
mod renderers;
mod stock;
pub(crate) mod table1;
pub(crate) mod table2;
pub(crate) mod vectors;

use crate::report::Section;
use crate::session::Session;
use whitted::render::Cancelled;

/// Measures, and fills the section with whatever was measured, also if the user stops it.
pub(crate) type Run = fn(&Session, &mut Section) -> Result<(), Cancelled>;
