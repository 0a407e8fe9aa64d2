//! What ratios should be.

use serde_json::Value;

/// The floor below which the work is not done, and the goal.
pub(super) struct Target {
    pub floor: f64,
    pub goal: f64,
}

impl Target {
    /// For a row of ray queries: that of its whole set against Embree's best call; `None` where there is none.
    pub(super) fn of(row: &Value) -> Option<Self> {
        let (scene, rays) = (row["scene"].as_str()?, row["rays"].as_str()?);
        if row["batch"] != "all" || scene == "hairball2M9" {
            return None;
        }
        let (floor, goal) = targets(rays)?[column(scene, row["primitives"].as_u64().unwrap_or(u64::MAX))];
        Some(Self { floor, goal })
    }
}

/// Meshes, spheres, few spheres.
fn column(scene: &str, primitives: u64) -> usize {
    const FEW: u64 = 100;
    let is_of_spheres = scene.starts_with("spheres") || scene.starts_with("flake");
    match is_of_spheres {
        false => 0,
        true => 1 + usize::from(primitives <= FEW),
    }
}

fn targets(rays: &str) -> Option<[(f64, f64); 3]> {
    Some(match rays {
        "primary" => [(1.0, 1.5), (6.0, 12.0), (2.5, 6.0)],
        "shadow" => [(1.0, 1.5), (2.5, 6.0), (2.0, 5.0)],
        "mirror" => [(1.1, 2.0), (2.5, 4.5), (2.0, 4.0)],
        "diffuse" => [(1.4, 2.5), (2.5, 4.5), (2.0, 4.0)],
        "random" => [(1.3, 2.0), (1.6, 4.0), (2.0, 4.0)],
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn whole_sets_have_targets() {
        let row = |scene: &str, primitives: u64, batch: &str| {
            let row = json!({ "scene": scene, "primitives": primitives, "rays": "primary", "batch": batch });
            Target::of(&row).map(|target| target.floor)
        };
        assert_eq!(row("bunny", 100, "all"), Some(1.0));
        assert_eq!([row("spheres100", 100, "all"), row("spheres1000", 1000, "all")], [Some(2.5), Some(6.0)]);
        assert_eq!([row("bunny", 100, "64"), row("hairball2M9", 100, "all")], [None, None]);
    }
}
