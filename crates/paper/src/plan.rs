//! What is to be measured, and how much effort it may take.

use crate::Experiment;

/// What is to be measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The experiments, in this order.
    pub experiments: Vec<Experiment>,
    /// How much.
    pub effort: Effort,
}

/// How much work goes into the experiments.
#[derive(Clone, Debug)]
pub struct Effort {
    /// What the report calls it.
    pub name: &'static str,
    /// Width and height of pictures.
    pub size: [u32; 2],
    /// Scenes of Table 1 by their numbers of spheres.
    pub spheres: Vec<u32>,
    /// Scenes of Table 2.
    pub region_spheres: Vec<u32>,
    /// Sides of the regions of Table 2, in pixels.
    pub regions: Vec<u32>,
    /// Scenes in which Havran's promise is checked.
    pub promise_spheres: Vec<u32>,
    /// How often everything is measured, in turn; ≥ 1.
    pub rounds: usize,
    /// Seconds of one round of one cell; what would take longer traces a part of the pixels only.
    pub seconds: f64,
    /// Operations of Tables 3 and 4.
    pub operations: u64,
    /// Threads of the rows that use several; ≥ 1.
    pub threads: usize,
}

impl Effort {
    /// A quarter of an hour at most.
    pub fn full() -> Self {
        Self {
            name: "full",
            size: [640, 480],
            spheres: vec![10, 100, 1_000, 50_000],
            region_spheres: vec![1_000, 50_000],
            regions: vec![1, 2, 4, 8, 16, 32, 64, 128],
            promise_spheres: vec![10, 100, 1_000, 10_000, 100_000, 1_000_000],
            rounds: 5,
            seconds: 0.7,
            operations: 50_000_000,
            threads: cores(),
        }
    }

    /// A minute at most: smaller pictures and fewer of them, three rounds.
    pub fn quick() -> Self {
        Self {
            name: "quick",
            size: [320, 240],
            spheres: vec![10, 1_000, 50_000],
            region_spheres: vec![1_000],
            regions: vec![1, 16, 32, 64, 128],
            promise_spheres: vec![10, 100, 1_000, 10_000, 100_000],
            rounds: 3,
            seconds: 0.06,
            ..Self::full()
        }
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
