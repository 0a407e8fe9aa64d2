//! The rays of a pixel for programs.

use super::Answer;
use serde_json::{Value, json};
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{RayEnd, RayKind, SampleTree, SurfaceHit, TracedRay};

impl Answer<'_> {
    /// An object with stable keys, ending in a line break. Infinite lengths are null.
    pub(super) fn json(&self) -> String {
        let samples: Vec<Value> = self.tree.samples.iter().map(|sample| self.sample_json(sample)).collect();
        let object = json!({
            "pixel": self.tree.pixel,
            "sample_count": self.tree.sample_count,
            "color": color(self.tree.color),
            "srgb8": self.shown(),
            "samples": samples,
        });
        format!("{object:#}\n")
    }

    fn sample_json(&self, sample: &SampleTree) -> Value {
        let rays: Vec<Value> = sample.rays.iter().map(|ray| self.ray_json(ray)).collect();
        let place = sample.place.map(shortest);
        json!({ "sample": sample.number, "place": place, "color": color(sample.color), "rays": rays })
    }

    fn ray_json(&self, ray: &TracedRay) -> Value {
        let (kind, light) = match ray.kind {
            RayKind::Camera => ("camera", None),
            RayKind::Reflected => ("reflected", None),
            RayKind::Refracted => ("refracted", None),
            RayKind::Shadow(light) => ("shadow", Some(light)),
        };
        let mut object = json!({
            "kind": kind,
            "parent": ray.parent,
            "generation": ray.generation,
            "origin": point(ray.origin),
            "direction": point(ray.direction),
            "length": ray.length,
            "weight": color(ray.weight),
            "end": end(&ray.end),
            "adds": color(ray.light),
        });
        light.into_iter().for_each(|light| object["light"] = json!(light));
        match ray.end {
            RayEnd::Hit(hit) => object["hit"] = self.hit_json(&hit),
            RayEnd::Blocked { object: blocker, primitive } => {
                object["blocked_by"] = json!({ "object": self.scene.object_name(blocker), "primitive": primitive });
            }
            _ => {}
        }
        object
    }

    fn hit_json(&self, hit: &SurfaceHit) -> Value {
        json!({
            "object": self.scene.object_name(hit.object),
            "primitive": hit.primitive,
            "material": self.material(hit.material),
            "position": point(hit.position),
            "normal": color(hit.n_s),
            "geometric_normal": color(hit.n_g),
            "enters": hit.enters,
            "weight": color(hit.weight),
        })
    }
}

/// A stable word for how a ray ends.
fn end(end: &RayEnd) -> &'static str {
    match end {
        RayEnd::Missed => "missed",
        RayEnd::Hit(_) => "hit",
        RayEnd::Clear => "clear",
        RayEnd::Filtered => "filtered",
        RayEnd::Blocked { .. } => "blocked",
        RayEnd::FacesAway => "faces_away",
        RayEnd::WeightLimit => "weight_limit",
        RayEnd::DepthLimit => "depth_limit",
        RayEnd::BudgetSpent => "budget_spent",
        RayEnd::TotalReflection => "total_reflection",
    }
}

fn point(point: Vec3d) -> [f64; 3] {
    point.to_array()
}

fn color(color: Vec3f) -> [f64; 3] {
    color.to_array().map(shortest)
}

/// The double that is written with the fewest digits that tell this number from other single-precision ones.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}
