//! The pixel inspector: what a pixel shows, its rays as a tree, and the same rays drawn over the picture.

use super::projection::View;
use super::status::short;
use super::theme::{ACCENT, FAINT, GAP, card, room, scrolled};
use crate::session::{Inspection, Session};
use egui::{Align2, CollapsingHeader, Color32, Context, Grid, Id, LayerId, Order, Painter, RichText, ScrollArea};
use egui::{Stroke, Ui, Window, vec2};
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{RayEnd, RayKind, SampleTree, SurfaceHit, TracedRay};
use whitted::scene::{Geometry, Scene};

/// Width of the inspector in units of layout.
const WIDTH: f32 = 330.0;

/// The least height of the list of rays.
const LEAST_LIST: f32 = 60.0;

/// Rays that hit nothing are drawn as long as this share of the distance that is looked at.
const ENDLESS: f64 = 2.0;

/// More rays than this are not listed: a sample of glass in glass has thousands.
const MOST: usize = 400;

/// More boxes than this are not drawn: they would hide the picture.
const MOST_BOXES: usize = 96;

/// What is chosen in the inspector.
#[derive(Debug, Default)]
pub(super) struct Inspector {
    /// Draw the boxes of the tree that the chosen ray enters.
    boxes: bool,
}

impl Inspector {
    /// Draw the rays and the card about the pixel.
    pub(super) fn show(&mut self, context: &Context, session: &mut Session) {
        let Some(inspection) = session.inspection().cloned() else { return };
        let Some(sample) = inspection.tree.as_ref().and_then(|tree| tree.samples.first()) else { return };
        let screen = context.content_rect();
        let view = View::new(session.camera(), [screen.width(), screen.height()]);
        let painter = context.layer_painter(LayerId::new(Order::Background, Id::new("rays")));
        if self.boxes
            && let Some(prepared) = session.prepared()
        {
            let chosen = inspection.chosen.and_then(|number| sample.rays.get(number)).or(sample.rays.first());
            chosen.into_iter().for_each(|ray| draw_boxes(&painter, &view, prepared.geometry(), ray));
        }
        draw_rays(&painter, &view, sample, inspection.chosen);
        let mut chosen = None;
        let mut is_open = true;
        let window = Window::new("inspector").title_bar(false).resizable(false).movable(false).frame(card());
        let room = room(context);
        let window = window.anchor(Align2::LEFT_TOP, vec2(GAP, GAP)).min_width(0.0).default_width(room.x.min(WIDTH));
        window.show(context, |ui| {
            scrolled(ui, room, |ui| {
                ui.set_width(WIDTH);
                ui.horizontal(|ui| {
                    is_open = !ui.small_button("×").clicked();
                    ui.heading(format!("pixel {}, {}", inspection.pixel[0], inspection.pixel[1]));
                });
                if let Some(scene) = session.scene() {
                    facts(ui, scene, &inspection, sample);
                    ui.checkbox(&mut self.boxes, "boxes of the tree on the ray's way");
                    ui.separator();
                    let height = (room.y - ui.min_rect().height()).max(LEAST_LIST);
                    ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
                        chosen = rays(ui, scene, sample);
                    });
                }
            });
        });
        match is_open {
            true => session.choose_ray(chosen),
            false => session.forget_pixel(),
        }
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

/// Draw the boxes of the tree that a ray enters before its end: leaves bright, what is around them faint.
fn draw_boxes(painter: &Painter, view: &View, geometry: &Geometry, ray: &TracedRay) {
    if !ray.end.is_traced() {
        return;
    }
    let boxes = geometry.boxes_entered(ray.origin, ray.direction, ray.length);
    for entered in boxes.iter().take(MOST_BOXES) {
        let alpha = if entered.primitives.is_some() { 200 } else { 70 };
        let stroke = Stroke::new(1.0, Color32::from_rgba_unmultiplied(120, 255, 190, alpha));
        for [from, to] in edges(entered.lo, entered.hi) {
            view.segment(from, to).into_iter().for_each(|ends| _ = painter.line_segment(ends, stroke));
        }
    }
}

/// The twelve edges of a box.
fn edges(lo: Vec3d, hi: Vec3d) -> impl Iterator<Item = [Vec3d; 2]> {
    let corner = move |bits: usize| {
        let pick = |axis: usize| if bits >> axis & 1 == 1 { hi[axis] } else { lo[axis] };
        Vec3d::new(pick(0), pick(1), pick(2))
    };
    (0..8).flat_map(move |from| {
        (0..3).filter(move |axis| from >> axis & 1 == 0).map(move |axis| [corner(from), corner(from | 1 << axis)])
    })
}

/// Draw all rays of a sample where they are in the picture.
fn draw_rays(painter: &Painter, view: &View, sample: &SampleTree, chosen: Option<usize>) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_twelve_edges() {
        let edges: Vec<[Vec3d; 2]> = edges(Vec3d::ZERO, Vec3d::new(1.0, 2.0, 4.0)).collect();
        assert_eq!(edges.len(), 12);
        let total: f64 = edges.iter().map(|[from, to]| (*to - *from).length()).sum();
        assert_eq!(total, 28.0, "four of each length");
    }
}
