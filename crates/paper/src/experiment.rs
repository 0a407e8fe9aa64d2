//! The experiments of the paper, by name.

use crate::Effort;
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
    /// In which scenes a kd-tree beats a grid.
    Grid,
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
    pub const ALL: [Self; 13] = [
        Self::Table1,
        Self::Table2,
        Self::Table3,
        Self::Table4,
        Self::Grid,
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
            Self::Grid => "grid",
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
            Self::Grid => "Kd-tree or grid: where the tree is four times as fast",
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

    /// About how many seconds it takes on a core of 2025: for the progress, which needs only their ratios.
    pub(crate) fn weight(self, effort: &Effort) -> f64 {
        let (rounds, regions) = (effort.rounds as f64, effort.regions.len() + 2);
        let measured = rounds * effort.seconds;
        match self {
            Self::Table1 => 10.0 * effort.spheres.len() as f64 * (0.7 + 2.0 * measured),
            Self::Table2 => (effort.region_spheres.len() * regions) as f64 * (0.2 + 2.0 * measured),
            Self::Table3 => 0.2 * rounds,
            Self::Table4 => 0.6 * rounds,
            Self::Grid => 3.0 + 20.0 * measured,
            Self::Promise => experiments::promise::weight(&effort.promise_spheres),
            Self::Exact => 4.0,
            _ => 1.0,
        }
    }

    /// What measures it.
    pub(crate) const fn run(self) -> Run {
        match self {
            Self::Table1 => experiments::table1::run,
            Self::Table2 => experiments::table2::run,
            Self::Table3 => experiments::vectors::multiplications,
            Self::Table4 => experiments::vectors::normalisations,
            Self::Grid => experiments::grid::run,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_keep_to_their_time() {
        let seconds = |effort: Effort| Experiment::ALL.iter().map(|e| e.weight(&effort)).sum::<f64>();
        let (quick, full) = (seconds(Effort::quick()), seconds(Effort::full()));
        println!("about {quick:.0} s, about {full:.0} s");
        assert!(quick <= 60.0 && full <= 15.0 * 60.0, "{quick} {full}");
    }

    #[test]
    fn names_are_unique_and_found() {
        for experiment in Experiment::ALL {
            assert_eq!(Experiment::by_name(experiment.name()), Some(experiment));
        }
        assert_eq!(Experiment::by_name("table5"), None);
    }
}
