//! The pixel inspector: what a pixel shows, its rays as a tree, and the same rays drawn over the picture.

use super::status::short;
use super::theme::{ACCENT, FAINT, card};
use crate::session::{Inspection, Session};
use egui::{
    Align2, CollapsingHeader, Color32, Context, Grid, Id, LayerId, Order, Pos2, RichText, ScrollArea, Stroke, Ui,
};
use egui::{Window, pos2, vec2};
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{RayEnd, RayKind, SampleTree, SurfaceHit, TracedRay};
use whitted::scene::{Camera, Scene};

/// Width of the inspector in units of layout.
const WIDTH: f32 = 330.0;

/// Rays that hit nothing are drawn as long as this share of the distance that is looked at.
const ENDLESS: f64 = 2.0;

/// Nearer to the eye than this share of the distance that is looked at nothing is drawn.
const NEAR: f64 = 1e-4;

/// More rays than this are not listed: a sample of glass in glass has thousands.
const MOST: usize = 400;

/// Draw the rays and the card about the pixel.
pub(super) fn show(context: &Context, session: &mut Session) {
    let Some(inspection) = session.inspection().cloned() else { return };
    let Some(sample) = inspection.tree.as_ref().and_then(|tree| tree.samples.first()) else { return };
    draw_rays(context, session.camera(), sample, inspection.chosen);
    let mut chosen = None;
    let mut is_open = true;
    let window =
        Window::new(format!("pixel {}, {}", inspection.pixel[0], inspection.pixel[1])).id(Id::new("inspector"));
    let window = window.frame(card()).anchor(Align2::LEFT_TOP, vec2(10.0, 10.0)).resizable(false).collapsible(false);
    window.open(&mut is_open).show(context, |ui| {
        ui.set_width(WIDTH);
        if let Some(scene) = session.scene() {
            facts(ui, scene, &inspection, sample);
            ui.separator();
            let height = (context.content_rect().height() - 280.0).max(60.0);
            ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
                chosen = rays(ui, scene, sample);
            });
        }
    });
    match is_open {
        true => session.choose_ray(chosen),
        false => session.forget_pixel(),
    }
}

fn facts(ui: &mut Ui, scene: &Scene, inspection: &Inspection, sample: &SampleTree) {
    let Some(tree) = &inspection.tree else { return };
    Grid::new("facts").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
        let mut row = |name: &str, value: String| {
            ui.label(RichText::new(name).color(FAINT));
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        };
        match sample.rays.first().map(|ray| (ray, ray.end)) {
            Some((ray, RayEnd::Hit(hit))) => {
                row("object", scene.object_name(hit.object));
                row("material", material(scene, &hit));
                row("position", numbers(hit.position));
                row("normal", numbers(hit.n_s.to_f64()));
                row("distance", format!("{:.5}", ray.length));
            }
            _ => row("object", "none: the background".to_owned()),
        }
        row("colour", numbers(tree.color.to_f64()));
        row("samples", tree.sample_count.to_string());
        row("rays", format!("{} in the first sample", short(sample.rays.len() as f64)));
    });
}

fn numbers(v: Vec3d) -> String {
    format!("{:.4}  {:.4}  {:.4}", v.x, v.y, v.z)
}

fn material(scene: &Scene, hit: &SurfaceHit) -> String {
    scene.materials.get(hit.material as usize).map_or_else(String::new, |named| named.name.clone())
}

/// The rays of a sample as a tree. Tells the one under the pointer.
fn rays(ui: &mut Ui, scene: &Scene, sample: &SampleTree) -> Option<usize> {
    let mut chosen = None;
    if !sample.rays.is_empty() {
        branch(ui, scene, sample, 0, &mut chosen);
    }
    if sample.rays.len() > MOST {
        ui.label(RichText::new(format!("and {} more", sample.rays.len() - MOST)).color(FAINT));
    }
    chosen
}

/// A ray with all that descends from it.
fn branch(ui: &mut Ui, scene: &Scene, sample: &SampleTree, number: usize, chosen: &mut Option<usize>) {
    let ray = &sample.rays[number];
    let children: Vec<usize> =
        (number + 1..sample.rays.len().min(MOST)).filter(|&child| sample.rays[child].parent == Some(number)).collect();
    let text = RichText::new(label(scene, ray)).color(tint(ray));
    let response = if children.is_empty() {
        ui.horizontal(|ui| {
            ui.add_space(18.0);
            ui.label(text)
        })
        .inner
    } else {
        let header = CollapsingHeader::new(text).id_salt(number).default_open(ray.generation < 3);
        header
            .show(ui, |ui| children.into_iter().for_each(|child| branch(ui, scene, sample, child, chosen)))
            .header_response
    };
    if response.contains_pointer() {
        *chosen = Some(number);
    }
}

/// A ray in a line.
fn label(scene: &Scene, ray: &TracedRay) -> String {
    let kind = match ray.kind {
        RayKind::Camera => "camera ray".to_owned(),
        RayKind::Reflected => "reflected".to_owned(),
        RayKind::Refracted => "refracted".to_owned(),
        RayKind::Shadow(light) => format!("light {}", light + 1),
    };
    format!("{kind}  {}  {}", share(ray.weight), end(scene, ray))
}

fn share(weight: Vec3f) -> String {
    format!("{:.1} %", 100.0 * weight.max_component())
}

fn end(scene: &Scene, ray: &TracedRay) -> String {
    match ray.end {
        RayEnd::Missed => "hits nothing".to_owned(),
        RayEnd::Hit(hit) => format!("hits {}", scene.object_name(hit.object)),
        RayEnd::Clear => "shines".to_owned(),
        RayEnd::Filtered => "shines through glass".to_owned(),
        RayEnd::Blocked { object, .. } => format!("blocked by {}", scene.object_name(object)),
        RayEnd::FacesAway => "behind the surface".to_owned(),
        RayEnd::WeightLimit => "too weak to be traced".to_owned(),
        RayEnd::DepthLimit => "depth limit".to_owned(),
        RayEnd::BudgetSpent => "no rays left".to_owned(),
        RayEnd::TotalReflection => "total reflection".to_owned(),
    }
}

/// The colour of a ray, by its kind; those that came to nothing are dim.
fn tint(ray: &TracedRay) -> Color32 {
    let color = match ray.kind {
        RayKind::Camera => Color32::from_rgb(240, 240, 240),
        RayKind::Reflected => Color32::from_rgb(110, 205, 255),
        RayKind::Refracted => Color32::from_rgb(150, 235, 150),
        RayKind::Shadow(_) if matches!(ray.end, RayEnd::Clear | RayEnd::Filtered) => ACCENT,
        RayKind::Shadow(_) => Color32::from_rgb(190, 110, 100),
    };
    if ray.end.is_traced() { color } else { FAINT }
}

/// Draw all rays of a sample where they are in the picture of `camera`.
fn draw_rays(context: &Context, camera: &Camera, sample: &SampleTree, chosen: Option<usize>) {
    let painter = context.layer_painter(LayerId::new(Order::Background, Id::new("rays")));
    let screen = context.content_rect();
    let view = View::new(camera, [screen.width(), screen.height()]);
    for (number, ray) in sample.rays.iter().enumerate().take(MOST).filter(|(_, ray)| ray.end.is_traced()) {
        let length = if ray.length.is_finite() { ray.length } else { view.distance * ENDLESS };
        let Some(ends) = view.segment(ray.origin, ray.origin + ray.direction * length) else { continue };
        let is_chosen = chosen == Some(number);
        let is_shadow = matches!(ray.kind, RayKind::Shadow(_));
        let width = if is_chosen {
            3.5
        } else if is_shadow {
            0.8
        } else {
            1.6
        };
        painter.line_segment(ends, Stroke::new(width + 1.6, Color32::from_black_alpha(110)));
        painter.line_segment(ends, Stroke::new(width, tint(ray)));
        if let RayEnd::Hit(hit) = ray.end
            && let Some([at, _]) = view.segment(hit.position, hit.position)
        {
            painter.circle(at, if is_chosen { 5.0 } else { 3.0 }, tint(ray), Stroke::new(1.0, Color32::BLACK));
        }
    }
}

/// From the scene to the picture.
struct View {
    camera: Camera,
    axes: [Vec3d; 3],
    size: [f32; 2],
    distance: f64,
}

impl View {
    fn new(camera: &Camera, size: [f32; 2]) -> Self {
        Self { camera: *camera, axes: camera.axes(), size, distance: (camera.look_at - camera.eye).length() }
    }

    /// Right, up and forward from the eye.
    fn seen(&self, point: Vec3d) -> Vec3d {
        let d = point - self.camera.eye;
        Vec3d::new(d.dot(self.axes[0]), d.dot(self.axes[1]), d.dot(self.axes[2]))
    }

    /// Where the part of a segment that lies before the eye is in the picture; `None` if none does.
    fn segment(&self, from: Vec3d, to: Vec3d) -> Option<[Pos2; 2]> {
        let near = NEAR * self.distance;
        let [a, b] = [self.seen(from), self.seen(to)];
        let cut = |a: Vec3d, b: Vec3d| if a.z < near { a + (b - a) * ((near - a.z) / (b.z - a.z)) } else { a };
        (a.z >= near || b.z >= near).then(|| [self.place(cut(a, b)), self.place(cut(b, a))])
    }

    fn place(&self, seen: Vec3d) -> Pos2 {
        // Far outside the window it does not matter where.
        const FARTHEST: f64 = 1e5;
        let scale = f64::from(self.size[1]) * 0.5 / (self.camera.half_height() * seen.z);
        let [x, y] = [seen.x * scale, -seen.y * scale].map(|a| a.clamp(-FARTHEST, FARTHEST) as f32);
        pos2(self.size[0] * 0.5 + x, self.size[1] * 0.5 + y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_drawn_where_their_rays_pass() {
        let camera = Camera { eye: Vec3d::new(1.0, 2.0, 5.0), vfov: 50.0, ..Camera::default() };
        let rays = whitted::scene::CameraRays::new(&camera, [400, 300], whitted::scene::Sampling::Centers);
        let view = View::new(&camera, [400.0, 300.0]);
        for place in [[10.0, 20.0], [200.0, 150.0], [399.0, 1.0]] {
            let direction = rays.ray(place[0], place[1]).direction.to_f64();
            let point = camera.eye + direction * 7.0;
            let [from, to] = view.segment(point, point).unwrap();
            assert!((from - pos2(place[0], place[1])).length() < 0.01 && from == to, "{from:?}");
        }
    }

    #[test]
    fn what_lies_behind_the_eye_is_cut_off() {
        let view = View::new(&Camera::default(), [100.0, 100.0]);
        let behind = Vec3d::new(0.0, 1.0, 9.0);
        assert!(view.segment(behind, behind).is_none());
        let [from, to] = view.segment(behind, Vec3d::ZERO).unwrap();
        assert!(from.y < 0.0 && to == pos2(50.0, 50.0), "{from:?} {to:?}");
    }
}
