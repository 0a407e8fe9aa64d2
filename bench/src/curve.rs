//! `curve`: how the time for a ray grows with the number of primitives, from a thousand to ten millions.
//!
//! Measured as by `rays`, whole sets in one batch, over scenes that differ in nothing but the size and number of their
//! primitives. Growth is the factor by which time grows per tenfold primitives, from one scene to the next.

use crate::machine;
use crate::options::{EmbreeOptions, OurOptions, SceneOptions};
use crate::rays;
use crate::row::Row;
use crate::scenes;
use clap::Args;
use serde_json::{Value, json};
use std::error::Error;
use std::path::PathBuf;

/// Options of `curve`.
#[derive(Args, Clone, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    embree: EmbreeOptions,
    #[command(flatten)]
    ours: OurOptions,
    /// Timed passes, of which the median counts
    #[arg(long, default_value_t = PASSES)]
    passes: usize,
    /// Use at most this many rays of each set
    #[arg(long, value_name = "N", default_value_t = RAYS)]
    max_rays: usize,
    /// Leave out scenes with more primitives: ten millions take about 5 GB with Embree, 2 GB without
    #[arg(long, value_name = "N", default_value_t = u32::MAX, hide_default_value = true)]
    max_primitives: u32,
    /// Write the rows to this file as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

const PASSES: usize = 5;
const RAYS: usize = 1 << 17;

impl Options {
    /// Everything.
    pub(crate) fn new(embree: &EmbreeOptions, ours: &OurOptions) -> Self {
        let (embree, ours) = (embree.clone(), ours.clone());
        Self { embree, ours, passes: PASSES, max_rays: RAYS, max_primitives: u32::MAX, json: None }
    }

    /// The same for `rays`.
    fn of_rays(&self) -> rays::Options {
        let no_scenes = SceneOptions { scenes: Vec::new(), skip: Vec::new(), shared: None };
        rays::Options::new(&self.embree, &no_scenes, &self.ours, self.passes, Some(self.max_rays)).in_whole_sets()
    }
}

/// The time for a ray of a set in a scene.
struct Point {
    rays: String,
    primitives: usize,
    /// Nanoseconds for a ray: ours, and Embree's if it is there.
    ours: f64,
    embree: Option<f64>,
    wrong: usize,
}

impl From<Row> for Point {
    fn from(row: Row) -> Self {
        const NANOSECONDS_PER_RAY: f64 = 1e3;
        Self {
            rays: row.kind.to_string(),
            primitives: row.primitives,
            ours: NANOSECONDS_PER_RAY / row.ours_mrays,
            embree: row.peer.map(|peer| NANOSECONDS_PER_RAY / peer.mrays),
            wrong: row.wrong,
        }
    }
}

/// Measure and print; returns the rows as JSON.
///
/// # Errors
/// Embree fails, or the JSON file cannot be written.
pub(crate) fn run(options: &Options) -> Result<Value, Box<dyn Error>> {
    let of_rays = options.of_rays();
    let device = options.embree.one_thread()?;
    println!("{} · {} · commit {}", machine::date(), machine::cpu(), machine::commit());
    println!(
        "{:<8} {:<8} {:>10} {:>11} {:>8} {:>13} {:>8} {:>6}",
        "family", "rays", "primitives", "ours ns/ray", "growth", "Embree ns/ray", "growth", "wrong"
    );
    let mut rows = Vec::new();
    for (family, sources) in scenes::growing() {
        let mut before: Vec<Point> = Vec::new();
        for (_, source) in sources.iter().filter(|(primitives, _)| *primitives <= options.max_primitives) {
            let mut points: Vec<Point> = Vec::new();
            rays::measure_scene(&of_rays, source, device.as_ref(), &mut |row| {
                let point = Point::from(row);
                rows.push(point.row(family, before.iter().find(|before| before.rays == point.rays)));
                points.push(point);
            })?;
            before = points;
        }
    }
    let rows = Value::Array(rows);
    if let Some(path) = &options.json {
        std::fs::write(path, format!("{rows:#}\n"))?;
    }
    Ok(rows)
}

impl Point {
    /// Print the line and return it as JSON; `before` is the point of the next smaller scene.
    fn row(&self, family: &str, before: Option<&Self>) -> Value {
        let ours = before.map(|before| growth([before.primitives, self.primitives], [before.ours, self.ours]));
        let embree = before
            .and_then(|before| Some(growth([before.primitives, self.primitives], [before.embree?, self.embree?])));
        let text = |number: Option<f64>, digits| number.map_or("-".into(), |number| format!("{number:.digits$}"));
        println!(
            "{family:<8} {:<8} {:>10} {:>11.1} {:>8} {:>13} {:>8} {:>6}",
            self.rays,
            self.primitives,
            self.ours,
            text(ours, 2),
            text(self.embree, 1),
            text(embree, 2),
            self.wrong
        );
        json!({
            "family": family,
            "rays": self.rays,
            "primitives": self.primitives,
            "ours_ns": self.ours,
            "ours_growth": ours,
            "embree_ns": self.embree,
            "embree_growth": embree,
            "wrong": self.wrong,
        })
    }
}

/// By what factor time grows per tenfold primitives.
fn growth(primitives: [usize; 2], seconds: [f64; 2]) -> f64 {
    let tenfolds = (primitives[1] as f64 / primitives[0] as f64).log10();
    (seconds[1] / seconds[0]).powf(1.0 / tenfolds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_that_of_a_tenfold() {
        assert!((growth([10, 100], [2.0, 3.0]) - 1.5).abs() < 1e-12);
        assert!((growth([10, 1000], [2.0, 8.0]) - 2.0).abs() < 1e-12);
    }
}
