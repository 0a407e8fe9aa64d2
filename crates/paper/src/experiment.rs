//! The experiments of the paper, by name.

use crate::experiments::{self, Run};

/// One table, figure or claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// Rendering times by technique and number of objects.
    Table1,
    /// Rendering times by size of the region.
    Table2,
    /// Vector multiplications.
    Table3,
    /// Vector normalisations.
    Table4,
    /// A slice through the kd-tree.
    Figure1,
    /// One ray through the kd-tree.
    Figure2,
    /// Where the ray tree was cut for unimportance.
    Figure3,
    /// Which pixels are supersampled.
    Figure4,
    /// An example scene.
    Figure5,
    /// Where the work goes.
    Cost,
    /// Tests and steps per ray as the scene grows.
    Promise,
    /// What the variants compute, pixel by pixel.
    Exact,
}

impl Experiment {
    /// All, in the order of the report.
    pub const ALL: [Self; 12] = [
        Self::Table1,
        Self::Table2,
        Self::Table3,
        Self::Table4,
        Self::Promise,
        Self::Exact,
        Self::Figure1,
        Self::Figure2,
        Self::Figure3,
        Self::Figure4,
        Self::Figure5,
        Self::Cost,
    ];

    /// The name by which it is chosen, and its anchor in the report.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Table1 => "table1",
            Self::Table2 => "table2",
            Self::Table3 => "table3",
            Self::Table4 => "table4",
            Self::Figure1 => "figure1",
            Self::Figure2 => "figure2",
            Self::Figure3 => "figure3",
            Self::Figure4 => "figure4",
            Self::Figure5 => "figure5",
            Self::Cost => "cost",
            Self::Promise => "promise",
            Self::Exact => "exact",
        }
    }

    /// The experiment of this name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|experiment| experiment.name() == name)
    }

    /// Its heading.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Table1 => "Table 1: rendering times",
            Self::Table2 => "Table 2: size of the region",
            Self::Table3 => "Table 3: vector multiplication",
            Self::Table4 => "Table 4: vector normalisation",
            Self::Figure1 => "Figure 1: subdivision by the kd-tree",
            Self::Figure2 => "Figure 2: a ray through the kd-tree",
            Self::Figure3 => "Figure 3: importance",
            Self::Figure4 => "Figure 4: supersampling",
            Self::Figure5 => "Figure 5: example scene",
            Self::Cost => "Where the work goes",
            Self::Promise => "Havran's promise: two or three tests per ray",
            Self::Exact => "What the variants compute",
        }
    }

    /// About how long it takes among the others, for the progress.
    pub(crate) const fn weight(self) -> f64 {
        match self {
            Self::Table1 => 60.0,
            Self::Table2 => 12.0,
            Self::Table3 | Self::Table4 => 3.0,
            Self::Promise => 15.0,
            Self::Exact => 3.0,
            _ => 0.5,
        }
    }

    /// What measures it.
    pub(crate) const fn run(self) -> Run {
        match self {
            Self::Table1 => experiments::table1::run,
            Self::Table2 => experiments::table2::run,
            Self::Table3 => experiments::vectors::multiplications,
            Self::Table4 => experiments::vectors::normalisations,
            Self::Figure1 => experiments::kd_tree::slice,
            Self::Figure2 => experiments::kd_tree::traversal,
            Self::Figure3 => experiments::pictures::importance,
            Self::Figure4 => experiments::pictures::supersampling,
            Self::Figure5 => experiments::pictures::example,
            Self::Cost => experiments::pictures::cost,
            Self::Promise => experiments::promise::run,
            Self::Exact => experiments::exact::run,
        }
    }
}
