//! What a render did, as text for people and as JSON for programs, with the same stable keys.

use crate::args::StatsFormat;
use crate::stopwatch::Shares;
use std::fmt::Write;
use std::time::Duration;
use whitted::render::Statistics;
use whitted::tree::TreeReport;

/// Everything that is reported of one render.
#[derive(Clone, Debug, Default)]
pub(crate) struct Report {
    pub(crate) statistics: Statistics,
    pub(crate) tree: TreeReport,
    pub(crate) load: Spent,
    pub(crate) build: Spent,
    pub(crate) trace: Spent,
    /// For pictures of something other than light.
    pub(crate) aov: Spent,
    pub(crate) write: Spent,
    pub(crate) shares: Shares,
}

/// What a phase took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spent {
    pub(crate) wall: Duration,
    /// Of all threads; zero where the system does not tell.
    pub(crate) cpu: Duration,
}

/// One value of the report.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Count(u64),
    /// A ratio or seconds; finite.
    Real(f64),
    /// This system does not tell.
    Unknown,
}

impl Report {
    /// The statistics in the wanted form, ending in a line break.
    pub(crate) fn render(&self, format: StatsFormat) -> String {
        match format {
            StatsFormat::Text => text(&self.rows()),
            StatsFormat::Json => json(&self.rows()),
        }
    }

    /// Stable keys with their values; keys of one group (the part before the point) stand together.
    fn rows(&self) -> Vec<(&'static str, Value)> {
        use Value::{Count, Real, Unknown};
        let s = &self.statistics;
        let wall = |spent: Spent| Real(spent.wall.as_secs_f64());
        let cpu = |spent: Spent| Real(spent.cpu.as_secs_f64());
        let per_ray = |count: u64| Real(count as f64 / s.rays().max(1) as f64);
        vec![
            ("rays.camera", Count(s.camera_rays)),
            ("rays.shadow", Count(s.shadow_rays)),
            ("rays.reflected", Count(s.reflected_rays)),
            ("rays.refracted", Count(s.refracted_rays)),
            ("hits.camera", Count(s.camera_hits)),
            ("tests_per_ray", per_ray(s.primitive_tests)),
            ("steps_per_ray", per_ray(s.node_steps)),
            ("tree.nodes", Count(self.tree.nodes as u64)),
            ("tree.leaves", Count(self.tree.leaves as u64)),
            ("tree.references", Count(self.tree.references as u64)),
            ("seconds.load", wall(self.load)),
            ("seconds.build", wall(self.build)),
            ("seconds.trace", wall(self.trace)),
            ("seconds.aov", wall(self.aov)),
            ("seconds.write", wall(self.write)),
            ("cpu_seconds.load", cpu(self.load)),
            ("cpu_seconds.build", cpu(self.build)),
            ("cpu_seconds.trace", cpu(self.trace)),
            ("cpu_seconds.aov", cpu(self.aov)),
            ("cpu_seconds.write", cpu(self.write)),
            ("percent.trace", Real(self.shares.trace)),
            ("percent.shadow", Real(self.shares.shadow)),
            ("percent.shade", Real(self.shares.shade)),
            ("percent.queue", Real(self.shares.queue)),
            ("percent.refine", Real(self.shares.refine)),
            ("pixels.supersampled", Count(s.supersampled_pixels)),
            ("cut.weight", Count(s.cut_by_weight)),
            ("cut.depth", Count(s.cut_by_depth)),
            ("cut.budget", Count(s.cut_by_budget)),
            ("peak_memory_bytes", peak_memory_bytes().map_or(Unknown, Count)),
        ]
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Count(count) => write!(f, "{count}"),
            Self::Real(real) => write!(f, "{real:.6}"),
            Self::Unknown => write!(f, "null"),
        }
    }
}

fn text(rows: &[(&str, Value)]) -> String {
    let width = rows.iter().map(|(key, _)| key.len()).max().unwrap_or(0);
    rows.iter().fold(String::new(), |mut out, (key, value)| {
        writeln!(out, "{key:width$}  {:>16}", value.to_string()).expect("writing to a string");
        out
    })
}

/// `a.b` becomes a member `b` of the object `a`.
fn json(rows: &[(&str, Value)]) -> String {
    let mut members: Vec<String> = Vec::new();
    for group in rows.chunk_by(|(a, _), (b, _)| group_of(a).is_some() && group_of(a) == group_of(b)) {
        let inner = group.iter().map(|(key, value)| format!("\"{}\": {value}", key.rsplit('.').next().unwrap_or(key)));
        let inner = inner.collect::<Vec<_>>().join(", ");
        members.push(match group_of(group[0].0) {
            Some(name) => format!("  \"{name}\": {{ {inner} }}"),
            None => format!("  {inner}"),
        });
    }
    format!("{{\n{}\n}}\n", members.join(",\n"))
}

fn group_of(key: &str) -> Option<&str> {
    key.split_once('.').map(|(group, _)| group)
}

/// The most memory this process has had resident at once; `None` where the system does not tell.
pub(crate) fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_groups_keys_and_text_keeps_them_flat() {
        let rows = [("a.x", Value::Count(1)), ("a.y", Value::Real(0.5)), ("b", Value::Unknown), ("c", Value::Count(2))];
        assert_eq!(json(&rows), "{\n  \"a\": { \"x\": 1, \"y\": 0.500000 },\n  \"b\": null,\n  \"c\": 2\n}\n");
        assert_eq!(text(&rows).lines().count(), 4);
        assert!(text(&rows).starts_with("a.x                 1\na.y          0.500000\n"));
    }

    #[test]
    fn no_rays_give_zero_per_ray() {
        let report = Report::default().render(StatsFormat::Text);
        let line = report.lines().find(|line| line.starts_with("tests_per_ray")).unwrap();
        assert!(line.ends_with(" 0.000000"));
    }
}
