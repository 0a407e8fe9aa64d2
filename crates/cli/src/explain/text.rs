//! The rays of a pixel for people: an indented tree.

use super::Answer;
use std::fmt::Write;
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{RayEnd, RayKind, SampleTree, SurfaceHit, TracedRay};

impl Answer<'_> {
    /// The tree, ending in a line break.
    pub(super) fn text(&self) -> String {
        let [x, y] = self.tree.pixel;
        let shown = self.shown().iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
        let (listed, all) = (self.tree.samples.len(), self.tree.sample_count);
        let mut out = format!("pixel {x},{y}: {} (sRGB {shown}), ", color(self.tree.color));
        let _ = match all {
            1 => writeln!(out, "one sample"),
            _ => writeln!(out, "the mean of {all} samples, {listed} of them here"),
        };
        self.tree.samples.iter().for_each(|sample| self.sample(sample, &mut out));
        out
    }

    fn sample(&self, sample: &SampleTree, out: &mut String) {
        let [x, y] = sample.place;
        let _ = writeln!(out, "sample {} at {x},{y}: {}", sample.number, color(sample.color));
        let mut last_child = vec![0; sample.rays.len()];
        for (index, ray) in sample.rays.iter().enumerate() {
            ray.parent.into_iter().for_each(|parent| last_child[parent] = index);
        }
        // What stands before the children of each ray.
        let mut indents: Vec<String> = Vec::with_capacity(sample.rays.len());
        for (index, ray) in sample.rays.iter().enumerate() {
            let (before, indent) = match ray.parent {
                None => (String::new(), String::new()),
                Some(parent) if last_child[parent] == index => {
                    (format!("{}└─ ", indents[parent]), format!("{}   ", indents[parent]))
                }
                Some(parent) => (format!("{}├─ ", indents[parent]), format!("{}│  ", indents[parent])),
            };
            let _ = writeln!(out, "{before}{}", self.ray(ray));
            indents.push(indent);
        }
    }

    /// One ray in one line.
    fn ray(&self, ray: &TracedRay) -> String {
        let kind = match ray.kind {
            RayKind::Camera => "camera".to_owned(),
            RayKind::Reflected => format!("reflected × {}", color(ray.weight)),
            RayKind::Refracted if ray.end == RayEnd::TotalReflection => "refracted".to_owned(),
            RayKind::Refracted => format!("refracted × {}", color(ray.weight)),
            RayKind::Shadow(light) => format!("light {}", light + 1),
        };
        let gain = Some(color(ray.light)).filter(|light| light != "0").map(|light| format!(": + {light}"));
        let gain = gain.unwrap_or_default();
        format!("{kind} {}{gain}", self.end(ray))
    }

    fn end(&self, ray: &TracedRay) -> String {
        let settings = &self.scene.settings;
        match ray.end {
            RayEnd::Missed => "sees the background".to_owned(),
            RayEnd::Hit(hit) => self.hit(&hit, ray.length),
            RayEnd::Clear => "arrives".to_owned(),
            RayEnd::Filtered => "arrives through what is transparent".to_owned(),
            RayEnd::Blocked { object, .. } => format!("is blocked by {}", self.scene.object_name(object)),
            RayEnd::FacesAway => "is behind the surface".to_owned(),
            RayEnd::WeightLimit => format!("not traced: its weight is below {}", number(settings.min_weight.into())),
            RayEnd::DepthLimit => format!("not traced: the depth limit is {}", settings.depth),
            RayEnd::BudgetSpent => "not traced: the sample has no rays left".to_owned(),
            RayEnd::TotalReflection => "does not exist: total reflection".to_owned(),
        }
    }

    fn hit(&self, hit: &SurfaceHit, length: f64) -> String {
        let (object, material) = (self.scene.object_name(hit.object), self.material(hit.material));
        let side = if hit.enters { "" } else { " from inside" };
        let (place, normal) = (point(hit.position), point(hit.n_s.to_f64()));
        let length = number(length);
        format!("hits {object} ('{material}'){side}, {length} away at {place}, normal {normal}")
    }
}

fn point(point: Vec3d) -> String {
    format!("({})", point.to_array().map(number).join(", "))
}

/// The components, or one for all if they are equal.
fn color(color: Vec3f) -> String {
    let [r, g, b] = color.to_array().map(|component| number(component.into()));
    if r == g && g == b { r } else { format!("({r}, {g}, {b})") }
}

/// Four significant digits, but no fewer than those before the point.
fn number(value: f64) -> String {
    const DIGITS: i32 = 4;
    const MOST_DECIMALS: i32 = 6;
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let before_point = value.abs().log10().floor() as i32 + 1;
    let decimals = (DIGITS - before_point).clamp(0, MOST_DECIMALS) as usize;
    let text = format!("{value:.decimals$}");
    if !text.contains('.') {
        return text;
    }
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => "0".to_owned(),
        short => short.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (0.1f32.into(), "0.1"),
            (123456.789, "123457"),
            (2.34567, "2.346"),
            (-0.001234567, "-0.001235"),
            (0.000012345, "0.000012"),
            (1e-12, "0"),
            (-1e-12, "0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(color(Vec3f::splat(0.25)), "0.25");
        assert_eq!(color(Vec3f::new(0.25, 0.5, 1.0)), "(0.25, 0.5, 1)");
    }
}
