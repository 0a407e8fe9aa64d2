//! The main figures of a record, for the README.

use super::{number, rows, text};
use serde_json::Value;

/// The comments between which the figures stand.
const BEGIN: &str = "<!-- figures: written by `whitted-bench record --readme` -->\n";
const END: &str = "<!-- end of figures -->\n";

/// The scenes of the table, and what they are.
const SCENES: [(&str, &str); 7] = [
    ("bunny", "bunny, 69 k triangles"),
    ("sponza", "Sponza, 66 k"),
    ("dragon871k", "dragon, 871 k"),
    ("terrain2M", "terrain, 2.1 M"),
    ("spheres1000", "1000 spheres"),
    ("spheres50000", "50 000 spheres"),
    ("spheres1M", "a million spheres"),
];

/// The ray sets, and what the table calls them.
const SETS: [(&str, &str); 5] =
    [("primary", "camera"), ("shadow", "shadow"), ("mirror", "mirror"), ("diffuse", "diffuse"), ("random", "random")];

/// `readme` with the figures of `record`, which is kept under `name`.
///
/// # Errors
/// The comments that mark the place are not there.
pub(super) fn updated(readme: &str, record: &Value, name: &str) -> Result<String, String> {
    let missing = |comment: &str| format!("no `{}`", comment.trim());
    let (before, rest) = readme.split_once(BEGIN).ok_or_else(|| missing(BEGIN))?;
    let (_, after) = rest.split_once(END).ok_or_else(|| missing(END))?;
    Ok(format!("{before}{BEGIN}{}{END}{after}", figures(record, name)))
}

fn figures(record: &Value, name: &str) -> String {
    let parts = [ratios(record), pictures(record), frames(record), builds(record), growth(record)];
    let machine = format!(
        "{}, {}, commit {}: [every row](bench/record/{name}.md).\n",
        text(record, "cpu"),
        text(record, "date"),
        text(record, "commit")
    );
    parts.into_iter().flatten().collect::<Vec<_>>().join("\n") + "\n" + &machine
}

/// How many times faster rays are found than by Embree's best call.
fn ratios(record: &Value) -> Option<String> {
    let of = |scene: &str, set: &str| {
        let fits = |row: &&Value| row["scene"] == scene && row["rays"] == set && row["batch"] == "all";
        rows(record, "rays").iter().find(fits).and_then(|row| row["ratio"].as_f64())
    };
    let line = |(scene, label): (&str, &str)| {
        let ratios: Vec<String> = SETS.iter().filter_map(|(set, _)| Some(format!("{:.2}×", of(scene, set)?))).collect();
        (ratios.len() == SETS.len()).then(|| format!("| {label} | {} |\n", ratios.join(" | ")))
    };
    let lines: String = SCENES.into_iter().filter_map(line).collect();
    let head = SETS.map(|(_, label)| label).join(" | ");
    (!lines.is_empty()).then(|| format!("| scene | {head} |\n| --- |{}\n{lines}", " ---: |".repeat(SETS.len())))
}

/// How many times faster whole pictures are.
fn pictures(record: &Value) -> Option<String> {
    let peers = rows(record, "pictures").iter().filter(|row| row["renderer"] != "whitted");
    let mut said: Vec<(&str, Vec<String>)> = Vec::new();
    for row in peers.filter(|row| row["ours_is_faster_by"].is_number()) {
        let peer = format!("{}× {}", number(row, "ours_is_faster_by", 1), text(row, "renderer"));
        match said.last_mut().filter(|(scene, _)| *scene == text(row, "scene")) {
            Some((_, peers)) => peers.push(peer),
            None => said.push((text(row, "scene"), vec![peer])),
        }
    }
    let said: Vec<String> = said.into_iter().map(|(scene, peers)| format!("{scene} {}", peers.join(" and "))).collect();
    (!said.is_empty()).then(|| format!("Whole pictures, one core, equal work: {}.\n", said.join("; ")))
}

fn frames(record: &Value) -> Option<String> {
    let both = |row: &&Value| row["threads"] == 2 && row["frames_per_second"].is_number();
    let row = rows(record, "pictures").iter().find(both)?;
    let rate = number(row, "frames_per_second", 0);
    Some(format!("{}, 640 × 480, on two cores: {rate} frames per second.\n", text(row, "scene")))
}

/// The slowest and the fastest build of either sort.
fn builds(record: &Value) -> Option<String> {
    let rates = |build: &str| {
        let of_build = rows(record, "build").iter().filter(|row| row["build"] == build);
        let meshes = of_build.filter(|row| SCENES.iter().any(|(scene, _)| row["scene"] == *scene));
        let rates: Vec<f64> = meshes.filter_map(|row| row["mprim_per_cpu_second"].as_f64()).collect();
        let (low, high) = rates.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &rate| (l.min(rate), h.max(rate)));
        let (low, high) = (format!("{low:.1}"), format!("{high:.1}"));
        let range = if low == high { low } else { format!("{low} to {high}") };
        (!rates.is_empty()).then(|| format!("{range} (`{build}`)"))
    };
    let rates: Vec<String> = ["best", "fast"].into_iter().filter_map(rates).collect();
    (!rates.is_empty())
        .then(|| format!("Trees, millions of primitives per second of one core: {}.\n", rates.join(", ")))
}

/// The mean growth over all of a curve.
fn growth(record: &Value) -> Option<String> {
    let of_family = |family: &str| {
        let rows = rows(record, "curve").iter().filter(|row| row["family"] == family);
        let growths: Vec<f64> = rows.filter_map(|row| row["ours_growth"].as_f64()).collect();
        let mean = (growths.iter().map(|growth| growth.ln()).sum::<f64>() / growths.len() as f64).exp();
        mean.is_finite().then(|| format!("{mean:.2}× ({family})"))
    };
    let said: Vec<String> = ["spheres", "terrain"].into_iter().filter_map(of_family).collect();
    (!said.is_empty())
        .then(|| format!("With ten times the primitives a ray takes {} as long, on average.\n", said.join(" or ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn figures_replace_what_stands_between_the_comments() {
        let rays: Vec<Value> = SETS
            .iter()
            .map(|(set, _)| json!({ "scene": "bunny", "rays": set, "batch": "all", "ratio": 1.5 }))
            .collect();
        let picture = |renderer: &str, factor: Option<f64>| json!({ "scene": "mix-1000", "renderer": renderer, "ours_is_faster_by": factor });
        let frames = json!({ "scene": "mix-1000", "renderer": "whitted", "threads": 2, "frames_per_second": 40.2 });
        let record = json!({
            "date": "2026-01-31",
            "rays": rays,
            "pictures": [picture("whitted", Some(1.0)), picture("A", Some(6.0)), picture("B", Some(3.0)), frames],
            "build": [{ "scene": "bunny", "build": "best", "mprim_per_cpu_second": 1.5 }],
            "curve": [{ "family": "spheres", "ours_growth": 2.0 }, { "family": "spheres", "ours_growth": 0.5 }],
        });
        let text = updated(&format!("before\n{BEGIN}old\n{END}after\n"), &record, "x").unwrap();
        assert!(
            text.starts_with(&format!("before\n{BEGIN}| scene | camera |")) && text.ends_with(&format!("{END}after\n"))
        );
        for part in [
            "| bunny, 69 k triangles | 1.50× | 1.50× |",
            "equal work: mix-1000 6.0× A and 3.0× B.\n",
            "on two cores: 40 frames per second",
            "1.5 (`best`).",
            "takes 1.00× (spheres) as long",
            "(bench/record/x.md)",
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert!(!text.contains("old") && !text.contains("Sponza"));
    }

    #[test]
    fn a_readme_without_a_place_is_left_alone() {
        assert!(updated("text", &json!({}), "x").is_err());
        assert!(updated(&format!("{BEGIN}text"), &json!({}), "x").is_err());
    }
}
