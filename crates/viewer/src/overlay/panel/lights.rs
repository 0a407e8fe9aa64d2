//! Lights, ambient light and background in the panel.

use super::{colour, grid, row};
use crate::overlay::theme::FAINT;
use crate::session::Session;
use egui::{DragValue, RichText, Ui};
use whitted::math::{Vec3d, Vec3f};
use whitted::scene::{Background, Camera, Light, LightKind};

/// The largest half angle of a cone in degrees.
const WIDEST: f64 = 180.0;

/// What can be changed of them; lights can be added and removed.
pub(super) fn show(ui: &mut Ui, session: &mut Session) {
    let Some(mut look) = session.look().cloned() else { return };
    let before = (look.lights.clone(), look.ambient, look.background);
    let mut unwanted = None;
    for (index, light) in look.lights.iter_mut().enumerate() {
        grid(ui, &format!("light {index}"), |ui| {
            if light_rows(ui, index, light) {
                unwanted = Some(index);
            }
        });
        ui.separator();
    }
    if let Some(index) = unwanted {
        look.lights.remove(index);
    }
    ui.horizontal(|ui| {
        ui.label(RichText::new("add").color(FAINT));
        look.lights.extend(light_kinds(session.camera()).into_iter().filter_map(|(name, kind)| {
            let light = Light { kind, color: Vec3f::ONE, inverse_square: false };
            ui.button(name).clicked().then_some(light)
        }));
    });
    grid(ui, "surroundings", |ui| {
        row(ui, "ambient", |ui| colour(ui, &mut look.ambient));
        row(ui, "background", |ui| match &mut look.background {
            Background::Color(color) => colour(ui, color),
            Background::Gradient { down, up } => {
                colour(ui, up);
                colour(ui, down);
            }
        });
    });
    if (&look.lights, look.ambient, look.background) != (&before.0, before.1, before.2) {
        session.set_look(look);
    }
}

/// The kinds of new lights: they shine from the camera at what it looks at.
fn light_kinds(camera: &Camera) -> [(&'static str, LightKind); 3] {
    /// Half angles in degrees of the cone of a new spot.
    const CONE: [f64; 2] = [27.0, 30.0];
    let (position, look_at, [inner, outer]) = (camera.eye, camera.look_at, CONE);
    [
        ("point", LightKind::Point { position }),
        ("sun", LightKind::Directional { direction: look_at - position }),
        ("spot", LightKind::Spot { position, look_at, inner, outer }),
    ]
}

/// What can be changed of a light. Tells whether it shall be removed.
fn light_rows(ui: &mut Ui, index: usize, light: &mut Light) -> bool {
    let mut is_unwanted = false;
    let (kind, place) = match &mut light.kind {
        LightKind::Point { position } => ("point", position),
        LightKind::Directional { direction } => ("sun", direction),
        LightKind::Spot { position, .. } => ("spot", position),
    };
    row(ui, &format!("{}: {kind}", index + 1), |ui| {
        coordinates(ui, place);
        is_unwanted = ui.small_button("remove").clicked();
    });
    if let LightKind::Spot { look_at, inner, outer, .. } = &mut light.kind {
        row(ui, "shines at", |ui| coordinates(ui, look_at));
        row(ui, "within", |ui| {
            ui.add(DragValue::new(inner).speed(0.1).range(0.0..=*outer).suffix("°").max_decimals(2));
            ui.add(DragValue::new(outer).speed(0.1).range(*inner..=WIDEST).suffix("°").max_decimals(2));
        });
    }
    row(ui, "light", |ui| {
        let mut brightness = light.color.max_component();
        let before = brightness;
        ui.add(DragValue::new(&mut brightness).speed(0.01).range(0.0..=f32::MAX).max_decimals(3));
        if brightness != before {
            light.color = if before > 0.0 { light.color * (brightness / before) } else { Vec3f::splat(brightness) };
        }
        colour(ui, &mut light.color);
        ui.checkbox(&mut light.inverse_square, "falls off");
    });
    is_unwanted
}

fn coordinates(ui: &mut Ui, point: &mut Vec3d) {
    for component in [&mut point.x, &mut point.y, &mut point.z] {
        ui.add(DragValue::new(component).speed(0.02).max_decimals(3));
    }
}
