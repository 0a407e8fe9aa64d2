//! The panel: settings, cameras, materials and lights, live; and what the scene and its picture are made of.

mod lights;
mod material;

use super::cards::grouped;
use super::status::short;
use super::theme::{ACCENT, FAINT, GAP, card, room, scrolled};
use crate::action::{Action, Side};
use crate::session::Session;
use egui::{Align2, CollapsingHeader, ComboBox, Context, DragValue, Grid, RichText, Slider, Ui, Window, vec2};
use whitted::math::{Vec3d, Vec3f};
use whitted::render::Aov;
use whitted::scene::{Antialias, Settings, Shadows, Tone};

/// Width of the panel in units of layout.
const WIDTH: f32 = 290.0;

/// The deepest recursion and the most samples that sliders offer; numbers can be typed beyond.
const DEEPEST: u32 = 20;
const MOST_SAMPLES: u32 = 64;

/// What is chosen in the panel.
#[derive(Debug, Default)]
pub(super) struct Panel {
    material: usize,
}

impl Panel {
    pub(super) fn show(&mut self, context: &Context, session: &mut Session) {
        let window = Window::new("panel").title_bar(false).resizable(false).movable(false).frame(card());
        let room = room(context);
        let size = vec2(room.x.min(WIDTH), room.y);
        window.anchor(Align2::RIGHT_TOP, vec2(-GAP, GAP)).fixed_size(size).show(context, |ui| {
            scrolled(ui, size, |ui| {
                ui.set_width(WIDTH);
                ui.label(RichText::new(session.title()).heading());
                view(ui, session);
                section(ui, "Picture", true, |ui| picture(ui, session));
                section(ui, "Cameras", true, |ui| cameras(ui, session));
                section(ui, "Materials", false, |ui| self.materials(ui, session));
                section(ui, "Lights", false, |ui| lights::show(ui, session));
                section(ui, "Statistics", true, |ui| statistics(ui, session));
            });
        });
    }

    fn materials(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(mut look) = session.look().cloned() else { return };
        self.material = self.material.min(look.materials.len().saturating_sub(1));
        let Some(chosen) = look.materials.get(self.material) else { return };
        ComboBox::from_id_salt("material").selected_text(&chosen.name).width(WIDTH - 20.0).show_ui(ui, |ui| {
            for (index, named) in look.materials.iter().enumerate() {
                ui.selectable_value(&mut self.material, index, &named.name);
            }
        });
        let Some(named) = look.materials.get_mut(self.material) else { return };
        let before = named.material.clone();
        grid(ui, "material", |ui| material::rows(ui, &mut named.material));
        if named.material != before && named.material.fault().is_none() {
            session.set_look(look);
        }
    }
}

fn section(ui: &mut Ui, title: &str, open: bool, show: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(title).color(ACCENT)).default_open(open).show_unindented(ui, show);
    ui.add_space(2.0);
}

fn grid(ui: &mut Ui, id: &str, show: impl FnOnce(&mut Ui)) {
    Grid::new(id).num_columns(2).spacing([12.0, 5.0]).show(ui, show);
}

/// A row of a grid: a name and what can be changed.
fn row(ui: &mut Ui, name: &str, show: impl FnOnce(&mut Ui)) {
    ui.label(RichText::new(name).color(FAINT));
    ui.horizontal(show);
    ui.end_row();
}

/// What is shown: light, or something else.
fn view(ui: &mut Ui, session: &mut Session) {
    let mut view = session.view();
    ComboBox::from_id_salt("view").selected_text(view.map_or("picture", Aov::name)).width(WIDTH - 20.0).show_ui(
        ui,
        |ui| {
            ui.selectable_value(&mut view, None, "picture");
            for (name, aov) in Aov::ALL {
                ui.selectable_value(&mut view, Some(aov), name);
            }
        },
    );
    session.set_view(view);
}

fn picture(ui: &mut Ui, session: &mut Session) {
    let mut settings = session.settings().clone();
    grid(ui, "picture", |ui| picture_rows(ui, &mut settings));
    if settings != *session.settings() {
        session.set_settings(settings);
    }
    ui.horizontal(|ui| {
        if ui.add_enabled(session.is_changed(), egui::Button::new("write into the file")).clicked() {
            session.write_back();
        }
    });
    ui.horizontal(|ui| {
        if ui.button("save").clicked() {
            session.act(Action::Save);
        }
        if ui.button("save EXR").clicked() {
            session.act(Action::SaveLight);
        }
        let record = if session.is_recording() { "stop and render" } else { "record a way" };
        if ui.button(record).clicked() {
            session.act(Action::Record);
        }
    });
}

fn picture_rows(ui: &mut Ui, settings: &mut Settings) {
    row(ui, "depth", |ui| {
        ui.add(Slider::new(&mut settings.depth, 0..=DEEPEST).clamping(egui::SliderClamping::Never));
    });
    row(ui, "least weight", |ui| {
        ui.add(DragValue::new(&mut settings.min_weight).speed(0.0005).range(0.0..=1.0).max_decimals(4));
    });
    row(ui, "antialiasing", |ui| antialias(ui, settings));
    row(ui, "exposure", |ui| {
        ui.add(Slider::new(&mut settings.exposure, -5.0..=5.0).max_decimals(2));
    });
    row(ui, "tone", |ui| {
        choice(
            ui,
            &mut settings.tone,
            &[(Tone::Clamp, "clamp"), (Tone::Reinhard, "Reinhard"), (Tone::Linear, "linear")],
        );
    });
    row(ui, "glass shadows", |ui| {
        choice(ui, &mut settings.shadows, &[(Shadows::Filter, "coloured"), (Shadows::Opaque, "black")]);
    });
}

fn antialias(ui: &mut Ui, settings: &mut Settings) {
    let uniform = match settings.antialias {
        Antialias::Uniform(samples) => samples,
        _ => settings.antialias_max,
    };
    let modes = [
        (Antialias::Off, "off"),
        (Antialias::Paper, "paper"),
        (Antialias::Edge, "edges"),
        (Antialias::Uniform(uniform), "all pixels"),
    ];
    choice(ui, &mut settings.antialias, &modes);
    let samples = match &mut settings.antialias {
        Antialias::Off => return,
        Antialias::Uniform(samples) => samples,
        Antialias::Paper | Antialias::Edge => &mut settings.antialias_max,
    };
    ui.add(DragValue::new(samples).range(1..=MOST_SAMPLES).speed(0.1).suffix("×"));
}

/// One of a few values.
fn choice<T: PartialEq + Copy>(ui: &mut Ui, value: &mut T, all: &[(T, &str)]) {
    let name = all.iter().find(|(known, _)| known == value).map_or("", |(_, name)| name);
    ComboBox::from_id_salt(ui.next_auto_id()).selected_text(name).width(96.0).show_ui(ui, |ui| {
        for (known, name) in all {
            ui.selectable_value(value, *known, *name);
        }
    });
}

fn cameras(ui: &mut Ui, session: &mut Session) {
    let names: Vec<String> =
        session.scene().map_or_else(Vec::new, |scene| scene.cameras.iter().map(|named| named.name.clone()).collect());
    ui.horizontal_wrapped(|ui| {
        for (index, name) in names.iter().enumerate() {
            if ui.button(name).clicked() {
                session.go_to_camera(index);
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for (name, action) in [
            ("front", Action::Side(Side::Front)),
            ("right", Action::Side(Side::Right)),
            ("top", Action::Side(Side::Top)),
            ("frame all", Action::FrameAll),
            ("turntable", Action::Turntable),
        ] {
            if ui.small_button(name).clicked() {
                session.act(action);
            }
        }
    });
    let camera = *session.camera();
    let shown = |v: Vec3d| format!("{:.3}  {:.3}  {:.3}", v.x, v.y, v.z);
    grid(ui, "camera", |ui| {
        row(ui, "eye", |ui| _ = ui.monospace(shown(camera.eye)));
        row(ui, "looks at", |ui| _ = ui.monospace(shown(camera.look_at)));
    });
}

/// A linear colour; brighter than white it keeps its brightness.
fn colour(ui: &mut Ui, color: &mut Vec3f) {
    let scale = color.max_component().max(1.0);
    let mut rgb = color.to_array().map(|component| component / scale);
    if ui.color_edit_button_rgb(&mut rgb).changed() {
        *color = Vec3f::from(rgb) * scale;
    }
}

fn statistics(ui: &mut Ui, session: &Session) {
    let Some(scene) = session.scene() else { return };
    let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let tree = session.prepared().map(|prepared| prepared.geometry().tree().report());
    let picture = session.picture();
    let (finished, draft) = (picture.finished.clone(), picture.draft);
    drop(picture);
    grid(ui, "statistics", |ui| {
        let mut number = |name: &str, value: usize| {
            if value > 0 {
                row(ui, name, |ui| _ = ui.monospace(grouped(value)));
            }
        };
        number("triangles", triangles);
        number("spheres", scene.spheres.len());
        number("other shapes", scene.shapes.len() + scene.planes.len());
        number("lights", scene.lights.len());
        if let Some(tree) = tree {
            number("tree nodes", tree.nodes);
        }
        if let Some([read, build]) = session.opening_times() {
            let text = format!("{:.2} s, {:.2} s", read.as_secs_f64(), build.as_secs_f64());
            row(ui, "read, built", |ui| _ = ui.monospace(text));
        }
        if draft.size != [0; 2] {
            let [width, height] = draft.size;
            row(ui, "draft", |ui| _ = ui.monospace(format!("{width}×{height}, depth {}", draft.depth)));
            row(ui, "its weights", |ui| _ = ui.monospace(format!("from {}", draft.weight())));
        }
        let Some(finished) = finished else { return };
        let (statistics, seconds) = (finished.frame.statistics, finished.time.as_secs_f64());
        for (name, count) in [
            ("camera rays", statistics.camera_rays),
            ("shadow rays", statistics.shadow_rays),
            ("reflected", statistics.reflected_rays),
            ("refracted", statistics.refracted_rays),
            ("supersampled", statistics.supersampled_pixels),
            ("cut by weight", statistics.cut_by_weight),
            ("cut by depth", statistics.cut_by_depth),
        ] {
            row(ui, name, |ui| _ = ui.monospace(short(count as f64)));
        }
        let per_ray = |count: u64| count as f64 / statistics.rays().max(1) as f64;
        row(ui, "nodes, tests", |ui| {
            let text =
                format!("{:.1}, {:.1} a ray", per_ray(statistics.node_steps), per_ray(statistics.primitive_tests));
            ui.monospace(text);
        });
        row(ui, "rays", |ui| _ = ui.monospace(format!("{}/s", short(statistics.rays() as f64 / seconds.max(1e-9)))));
    });
}
