//! The page of a record.

use super::targets::Target;
use super::{number, rows, text};
use serde_json::Value;

/// Makes a part of the page from rows.
type Section = fn(&[Value]) -> String;

/// All tables.
pub(super) fn page(record: &Value) -> String {
    let sections: [(&str, Section); 5] = [
        ("rays", rays_section),
        ("curve", curve_section),
        ("build", build_section),
        ("pictures", pictures_section),
        ("pictures", frames_section),
    ];
    sections.into_iter().fold(head(record), |page, (key, section)| page + &section(rows(record, key)))
}

fn head(record: &Value) -> String {
    let word = |key: &str| text(record, key);
    let isa = record["embree_isa"].as_str().map_or(String::new(), |isa| format!(" limited to {isa}"));
    let peer = record["embree"].as_str().map_or("no Embree".into(), |version| format!("Embree {version}{isa}"));
    let thinned = record["max_rays"].as_u64().map_or(String::new(), |n| format!(", at most {n} rays of each set"));
    format!(
        "# {}, {}, commit {}\n\nOurs: {}; {peer}; median of {} passes{thinned}. Taken by `cargo run --release -p \
        whitted-bench -- record`.\n\n",
        word("date"),
        word("cpu"),
        word("commit"),
        word("level"),
        record["passes"]
    )
}

fn rays_section(rows: &[Value]) -> String {
    let head = "Mrays/s on one core; floor and goal are those of the ratio. *Wrong* counts our answers that brute force \
        contradicts, of a sample and of all that *differ* from Embree's. Batch 1: one ray at a time, by both.\n";
    let columns =
        ["scene", "rays", "batch", "ours", "Embree", "its best call", "ratio", "floor", "goal", "wrong", "differ"];
    let cells = |row: &Value| {
        let target = Target::of(row);
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
            number(row, "differ", 0),
        ]
    };
    table("Ray queries", head, &columns, rows.iter().map(cells))
}

fn curve_section(rows: &[Value]) -> String {
    let head = "Nanoseconds for a ray on one core; growth is the factor per tenfold primitives (goal: at most 1.5).\n";
    let columns = ["family", "rays", "primitives", "ours", "growth", "Embree", "growth"];
    let cells = |row: &Value| {
        vec![
            text(row, "family").into(),
            text(row, "rays").into(),
            number(row, "primitives", 0),
            number(row, "ours_ns", 1),
            number(row, "ours_growth", 2),
            number(row, "embree_ns", 1),
            number(row, "embree_growth", 2),
        ]
    };
    // By rays, so that a curve is read downwards.
    let mut rows: Vec<&Value> = rows.iter().collect();
    rows.sort_by_key(|row| (text(row, "family"), text(row, "rays"), row["primitives"].as_u64()));
    table("Growth with the number of primitives", head, &columns, rows.into_iter().map(cells))
}

fn build_section(rows: &[Value]) -> String {
    let head = "Millions of primitives per second: of CPU time with one thread, of wall-clock time with one and two; the \
        speed-up of two threads is by the wall clock, or with ≤ only bounded by CPU time because other programs ran. \
        References are per primitive, cost is the expected cost as a share of that of the exact sweep; tests, steps and \
        Mrays/s are those of our walk for diffuse and random rays.\n";
    let columns = [
        "scene",
        "build",
        "CPU",
        "wall",
        "2 threads",
        "speed-up",
        "B/primitive",
        "references",
        "depth",
        "cost",
        "tests",
        "steps",
        "Mrays/s",
    ];
    let cells = |row: &Value| {
        let bound = if row["speed_up_by"] == "cpu" { "≤ " } else { "" };
        vec![
            text(row, "scene").into(),
            text(row, "build").into(),
            number(row, "mprim_per_cpu_second", 3),
            number(row, "mprim_per_second", 3),
            number(row, "mprim_per_second_2_threads", 3),
            format!("{bound}{}", number(row, "speed_up", 2)),
            number(row, "bytes_per_primitive", 1),
            number(row, "references_per_primitive", 2),
            number(row, "depth", 0),
            number(row, "cost_of_exact_sweep", 3),
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
    let whole = rows.iter().filter(|row| row["trace_cpu_seconds"].is_number());
    table("Pictures", head, &columns, whole.map(cells))
}

fn frames_section(rows: &[Value]) -> String {
    let head = "The same picture again and again, prepared once and not written: by the wall clock, or by CPU time where \
        other programs ran.\n";
    let columns = ["scene", "threads", "frames/s", "by", "CPU s a frame"];
    let cells = |row: &Value| {
        vec![
            text(row, "scene").into(),
            number(row, "threads", 0),
            number(row, "frames_per_second", 1),
            text(row, "frames_per_second_by").into(),
            number(row, "cpu_seconds_per_frame", 4),
        ]
    };
    let moving = rows.iter().filter(|row| row["frames_per_second"].is_number());
    table("Frames per second", head, &columns, moving.map(cells))
}

/// A section with a table; nothing without rows.
fn table(title: &str, head: &str, columns: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let lines: String = rows.map(|cells| line(&cells)).collect();
    if lines.is_empty() {
        return String::new();
    }
    let names = line(&columns.iter().map(|&column| column.into()).collect::<Vec<_>>());
    let rule = line(&vec!["---".into(); columns.len()]);
    format!("## {title}\n{head}\n{names}{rule}{lines}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_page_has_a_line_for_each_row() {
        let ray = json!({ "scene": "bunny", "rays": "diffuse", "batch": "all", "ours_mrays": 2.0, "wrong": 0 });
        let build = json!({ "scene": "bunny", "speed_up": 1.9, "speed_up_by": "cpu" });
        let frames = json!({ "scene": "mix-1000", "threads": 2, "frames_per_second": 41.0 });
        let page = page(&json!({ "date": "2026-01-31", "rays": [ray], "build": [build], "pictures": [frames] }));
        assert!(page.starts_with("# 2026-01-31, -, commit -\n"));
        assert!(page.contains("\n| bunny | diffuse | all | 2.00 | - | - | - | 1.4 | 2.5 | 0 | - |\n"), "{page}");
        assert!(page.contains("| ≤ 1.90 |") && page.contains("\n| mix-1000 | 2 | 41.0 | - | - |\n"), "{page}");
        assert!(!page.contains("## Pictures") && !page.contains("## Growth"), "{page}");
    }

    #[test]
    fn a_curve_is_read_downwards() {
        let row = |rays: &str, primitives: u64| json!({ "family": "f", "rays": rays, "primitives": primitives });
        let section = curve_section(&[row("b", 10), row("a", 10), row("b", 100), row("a", 100)]);
        let places = ["| a | 10 |", "| a | 100 |", "| b | 10 |", "| b | 100 |"].map(|line| section.find(line).unwrap());
        assert!(places.is_sorted());
    }
}
