//! `record`: measures everything and keeps it in `bench/record/`, as JSON for programs and as tables for people; the
//! README can be given the latest.

mod page;
mod readme;
mod targets;

use crate::embree::EmbreeError;
use crate::options::{EmbreeOptions, OurOptions, SceneOptions};
use crate::{builds, curve, machine, pictures, rays};
use clap::Args;
use serde_json::{Value, json};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Options of `record`.
#[derive(Args, Clone, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    embree: EmbreeOptions,
    #[command(flatten)]
    scenes: SceneOptions,
    #[command(flatten)]
    ours: OurOptions,
    /// Timed passes of ray queries
    #[arg(long, default_value_t = rays::PASSES)]
    passes: usize,
    /// Use at most this many rays of each set
    #[arg(long, value_name = "N")]
    max_rays: Option<usize>,
    /// Take the rows that `rays --json` wrote, instead of measuring
    #[arg(long, value_name = "FILE")]
    take_rays: Option<PathBuf>,
    /// Take the rows that `curve --json` wrote, instead of measuring
    #[arg(long, value_name = "FILE")]
    take_curve: Option<PathBuf>,
    /// Take the rows that `build --json` wrote, instead of measuring
    #[arg(long, value_name = "FILE")]
    take_build: Option<PathBuf>,
    /// Take the rows that `pictures --json` wrote, instead of measuring
    #[arg(long, value_name = "FILE")]
    take_pictures: Option<PathBuf>,
    /// Where records are kept
    #[arg(long, value_name = "DIR", default_value = "bench/record")]
    folder: PathBuf,
    /// Put the main figures into this file, between the comments that mark their place
    #[arg(long, value_name = "FILE")]
    readme: Option<PathBuf>,
}

/// Measure rays, their growth, builds and pictures, and write all files.
///
/// # Errors
/// A measurement fails, or a file cannot be read or written.
pub(crate) fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let Options { embree, scenes, ours, passes, max_rays, .. } = options;
    let (date, cpu, commit) = (machine::date(), machine::cpu(), machine::commit());
    let name = format!("{date}-{}-{}", slug(&cpu), slug(&commit));
    let base = options.folder.join(&name);
    std::fs::create_dir_all(&options.folder)?;
    // First, for they need other programs, which may not be there: an hour of measurements would be lost.
    let pictures =
        taken(options.take_pictures.as_deref(), || pictures::run(&pictures::Options::new(scenes.shared.clone())))?;
    let rays = taken(options.take_rays.as_deref(), || {
        rays::run(&rays::Options::new(embree, scenes, ours, *passes, *max_rays))
    })?;
    let curve = taken(options.take_curve.as_deref(), || curve::run(&curve::Options::new(embree, ours)))?;
    let build = taken(options.take_build.as_deref(), || builds::run(&builds::Options::new(embree, scenes, ours)))?;
    let level = ours.level().name();
    let record = json!({
        "date": date, "cpu": cpu, "commit": commit, "level": level, "passes": passes, "max_rays": max_rays,
        "embree": version(embree)?, "embree_isa": embree.embree_isa,
        "rays": rays, "curve": curve, "build": build, "pictures": pictures,
    });
    std::fs::write(base.with_extension("json"), format!("{record:#}\n"))?;
    std::fs::write(base.with_extension("md"), page::page(&record))?;
    if let Some(path) = &options.readme {
        let text = readme::updated(&std::fs::read_to_string(path)?, &record, &name)?;
        std::fs::write(path, text)?;
    }
    println!("written to {}.json and .md", base.display());
    Ok(())
}

/// The rows in a file, or those that are measured now.
fn taken(
    file: Option<&Path>,
    measure: impl FnOnce() -> Result<Value, Box<dyn Error>>,
) -> Result<Value, Box<dyn Error>> {
    let Some(path) = file else { return measure() };
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?)
}

/// Embree's version; `None` without it.
fn version(options: &EmbreeOptions) -> Result<Option<String>, EmbreeError> {
    Ok(options.one_thread()?.map(|device| device.version()))
}

/// Lower-case letters, digits and single hyphens.
fn slug(text: &str) -> String {
    let parts = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("-").to_lowercase()
}

/// The rows of a kind of measurement.
fn rows<'v>(record: &'v Value, key: &str) -> &'v [Value] {
    record[key].as_array().map_or(&[], Vec::as_slice)
}

fn text<'v>(row: &'v Value, key: &str) -> &'v str {
    row[key].as_str().unwrap_or("-")
}

fn number(row: &Value, key: &str, digits: usize) -> String {
    row[key].as_f64().map_or("-".into(), |number| format!("{number:.digits$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_are_plain() {
        assert_eq!(slug("AMD EPYC 9B45 (Zen 5)"), "amd-epyc-9b45-zen-5");
    }

    #[test]
    fn rows_of_a_file_are_not_measured_again() {
        let path = std::env::temp_dir().join(format!("whitted-bench-rows-{}.json", std::process::id()));
        std::fs::write(&path, "[1]").unwrap();
        let rows = taken(Some(&path), || Err("measured".into()));
        std::fs::remove_file(&path).unwrap();
        assert_eq!(rows.unwrap(), json!([1]));
        assert!(taken(Some(&path), || Ok(json!([]))).is_err());
        assert!(taken(None, || Err("measured".into())).is_err());
    }
}
