//! `record`: measures everything and keeps it in `bench/record/`, as JSON for programs and as tables for people.

use crate::embree::EmbreeError;
use crate::options::{EmbreeOptions, OurOptions, SceneOptions};
use crate::{builds, machine, pictures, rays};
use clap::Args;
use serde_json::{Value, json};
use std::error::Error;
use std::path::PathBuf;

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
    /// Where records are kept
    #[arg(long, value_name = "DIR", default_value = "bench/record")]
    folder: PathBuf,
}

/// What a ratio should be: the floor below which the work is not done, and the goal.
struct Target {
    floor: f64,
    goal: f64,
}

/// Measure rays, builds and pictures, and write both files.
///
/// # Errors
/// A measurement fails, or a file cannot be written.
pub(crate) fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let Options { embree, scenes, ours, passes, max_rays, folder } = options;
    let (date, cpu, commit) = (machine::date(), machine::cpu(), machine::commit());
    let base = folder.join(format!("{date}-{}-{}", slug(&cpu), slug(&commit)));
    std::fs::create_dir_all(folder)?;
    let rays = rays::run(&rays::Options::new(embree, scenes, ours, *passes, *max_rays))?;
    let build = builds::run(&builds::Options::new(embree, scenes, ours))?;
    let pictures = pictures::run(&pictures::Options::new(scenes.shared.clone()))?;
    let level = ours.level().name();
    let record = json!({
        "date": date, "cpu": cpu, "commit": commit, "level": level, "passes": passes, "max_rays": max_rays,
        "embree": version(embree)?, "embree_isa": embree.embree_isa,
        "rays": rays, "build": build, "pictures": pictures,
    });
    std::fs::write(base.with_extension("json"), format!("{record:#}\n"))?;
    std::fs::write(base.with_extension("md"), page(&record))?;
    println!("written to {}.json and .md", base.display());
    Ok(())
}

/// Embree's version; `None` without it.
fn version(options: &EmbreeOptions) -> Result<Option<String>, EmbreeError> {
    let Some(embree) = options.load()? else { return Ok(None) };
    Ok(Some(embree.device(1, None)?.version()))
}

/// Lower-case letters, digits and single hyphens.
fn slug(text: &str) -> String {
    let parts = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("-").to_lowercase()
}

fn page(record: &Value) -> String {
    let word = |key: &str| record[key].as_str().unwrap_or("-");
    let mut out = format!("# {}, {}, commit {}\n\n", word("date"), word("cpu"), word("commit"));
    let isa = record["embree_isa"].as_str().map_or(String::new(), |isa| format!(" limited to {isa}"));
    let peer = record["embree"].as_str().map_or("no Embree".into(), |version| format!("Embree {version}{isa}"));
    let thinned = record["max_rays"].as_u64().map_or(String::new(), |n| format!(", at most {n} rays of each set"));
    let (ours, passes) = (word("level"), &record["passes"]);
    out += &format!("Ours: {ours}; {peer}; median of {passes} passes{thinned}. ");
    out += "Taken by `cargo run --release -p whitted-bench -- record`.\n\n";
    let sections =
        [("rays", rays_section as fn(&[Value]) -> String), ("build", build_section), ("pictures", pictures_section)];
    for (key, section) in sections {
        out += &section(record[key].as_array().map_or(&[], Vec::as_slice));
    }
    out
}

fn rays_section(rows: &[Value]) -> String {
    let head = "Mrays/s on one core; floor and goal are those of the ratio.\n";
    let columns = ["scene", "rays", "batch", "ours", "Embree", "its best call", "ratio", "floor", "goal", "wrong"];
    let cells = |row: &Value| {
        let target = target(text(row, "scene"), text(row, "rays")).filter(|_| row["batch"] == "all");
        let [floor, goal] = target.map_or([String::new(), String::new()], |t| [t.floor, t.goal].map(|x| x.to_string()));
        vec![
            text(row, "scene").into(),
            text(row, "rays").into(),
            text(row, "batch").into(),
            number(row, "ours_mrays", 2),
            number(row, "embree_mrays", 2),
            text(row, "embree_call").into(),
            number(row, "ratio", 2),
            floor,
            goal,
            number(row, "wrong", 0),
        ]
    };
    table("Ray queries", head, &columns, rows.iter().map(cells))
}

fn build_section(rows: &[Value]) -> String {
    let head = "Millions of primitives per second: of CPU time with one thread, of wall-clock time with one and two. \
        References are per primitive; tests, steps and Mrays/s are those of our walk for diffuse and random rays.\n";
    let columns = [
        "scene",
        "build",
        "CPU",
        "wall",
        "2 threads",
        "B/primitive",
        "references",
        "depth",
        "tests",
        "steps",
        "Mrays/s",
    ];
    let cells = |row: &Value| {
        let per_primitive = row["references"].as_f64().zip(row["primitives"].as_f64()).map(|(r, n)| r / n);
        vec![
            text(row, "scene").into(),
            text(row, "build").into(),
            number(row, "mprim_per_cpu_second", 3),
            number(row, "mprim_per_second", 3),
            number(row, "mprim_per_second_2_threads", 3),
            number(row, "bytes_per_primitive", 1),
            per_primitive.map_or("-".into(), |r| format!("{r:.2}")),
            number(row, "depth", 0),
            number(row, "tests_per_ray", 2),
            number(row, "steps_per_ray", 2),
            number(row, "mrays", 2),
        ]
    };
    table("Builds", head, &columns, rows.iter().map(cells))
}

fn pictures_section(rows: &[Value]) -> String {
    let head = "640 × 480, depth 5, cut-off 1/255, one sample a pixel, one thread; CPU seconds of tracing.\n";
    let columns = ["scene", "renderer", "trace s", "ours is faster by", "rays", "shadow", "reflected", "refracted"];
    let cells = |row: &Value| {
        vec![
            text(row, "scene").into(),
            text(row, "renderer").into(),
            number(row, "trace_cpu_seconds", 3),
            number(row, "ours_is_faster_by", 2),
            number(row, "rays", 0),
            number(row, "shadow", 0),
            number(row, "reflected", 0),
            number(row, "refracted", 0),
        ]
    };
    table("Pictures", head, &columns, rows.iter().map(cells))
}

fn table(title: &str, head: &str, columns: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut out = format!("## {title}\n{head}\n");
    out += &line(&columns.iter().map(|&column| column.into()).collect::<Vec<_>>());
    out += &line(&vec!["---".into(); columns.len()]);
    rows.for_each(|cells| out += &line(&cells));
    out + "\n"
}

fn text<'v>(row: &'v Value, key: &str) -> &'v str {
    row[key].as_str().unwrap_or("-")
}

fn number(row: &Value, key: &str, digits: usize) -> String {
    row[key].as_f64().map_or("-".into(), |number| format!("{number:.digits$}"))
}

/// The targets of ray sets, on the whole set against Embree's best call; `None` where there is none.
fn target(scene: &str, rays: &str) -> Option<Target> {
    let column = match scene {
        "hairball2M9" => return None,
        "spheres10" | "spheres100" => 2,
        _ if scene.starts_with("spheres") || scene.starts_with("flake") => 1,
        _ => 0,
    };
    let targets = match rays {
        "primary" => [(1.0, 1.5), (6.0, 12.0), (2.5, 6.0)],
        "shadow" => [(1.0, 1.5), (2.5, 6.0), (2.0, 5.0)],
        "mirror" => [(1.1, 2.0), (2.5, 4.5), (2.0, 4.0)],
        "diffuse" => [(1.4, 2.5), (2.5, 4.5), (2.0, 4.0)],
        "random" => [(1.3, 2.0), (1.6, 4.0), (2.0, 4.0)],
        _ => return None,
    };
    let (floor, goal) = targets[column];
    Some(Target { floor, goal })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_a_line_for_each_row() {
        let ray = json!({ "scene": "bunny", "rays": "diffuse", "batch": "all", "ours_mrays": 2.0, "ratio": null });
        let page = page(&json!({ "date": "2026-01-31", "rays": [ray], "build": [], "pictures": [] }));
        assert!(page.starts_with("# 2026-01-31, -, commit -\n"));
        assert!(page.contains("\n| bunny | diffuse | all | 2.00 | - | - | - | 1.4 | 2.5 | - |\n"), "{page}");
    }

    #[test]
    fn file_names_are_plain() {
        assert_eq!(slug("AMD EPYC 9B45 (Zen 5)"), "amd-epyc-9b45-zen-5");
    }
}
