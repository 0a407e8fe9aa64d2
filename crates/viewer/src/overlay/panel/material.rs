//! A material in the panel.

use super::{choice, colour, row};
use egui::{DragValue, Slider, Ui};
use whitted::math::Vec3f;
use whitted::shading::{Material, Reflectance, SpecularModel, Texture};

/// The rows of a grid in which it can be changed.
pub(super) fn rows(ui: &mut Ui, material: &mut Material) {
    match &mut material.color {
        Texture::Color(color) => row(ui, "colour", |ui| colour(ui, color)),
        Texture::Checker { even, odd, size } => row(ui, "colours", |ui| {
            colour(ui, even);
            colour(ui, odd);
            ui.add(DragValue::new(size).speed(0.01).range(1e-6..=f32::MAX));
        }),
    }
    row(ui, "ambient", |ui| strength(ui, &mut material.ambient));
    row(ui, "diffuse", |ui| strength(ui, &mut material.diffuse));
    row(ui, "highlight", |ui| amount(ui, &mut material.specular));
    row(ui, "exponent", |ui| {
        ui.add(Slider::new(&mut material.exponent, 0.0..=2000.0).logarithmic(true).max_decimals(1));
    });
    row(ui, "", |ui| {
        choice(ui, &mut material.specular_model, &[(SpecularModel::Phong, "Phong"), (SpecularModel::Blinn, "Blinn")]);
    });
    row(ui, "reflects", |ui| amount(ui, &mut material.reflect));
    row(ui, "transmits", |ui| amount(ui, &mut material.transmit));
    row(ui, "by angle", |ui| {
        let all =
            [(Reflectance::Constant, "constant"), (Reflectance::Fresnel, "Fresnel"), (Reflectance::Schlick, "Schlick")];
        choice(ui, &mut material.reflectance, &all);
    });
    row(ui, "refraction", |ui| {
        ui.add(DragValue::new(&mut material.ior).speed(0.002).range(0.01..=10.0).max_decimals(4));
    });
    row(ui, "absorbs", |ui| {
        for component in [&mut material.absorb.x, &mut material.absorb.y, &mut material.absorb.z] {
            ui.add(DragValue::new(component).speed(0.005).range(0.0..=f32::MAX).max_decimals(3));
        }
    });
}

fn strength(ui: &mut Ui, value: &mut f32) {
    ui.add(Slider::new(value, 0.0..=1.0).clamping(egui::SliderClamping::Never).max_decimals(3));
}

/// A strength for each component: a slider for all together, and a colour.
fn amount(ui: &mut Ui, value: &mut Vec3f) {
    let mut largest = value.max_component();
    let before = largest;
    strength(ui, &mut largest);
    if largest != before {
        *value = if before > 0.0 { *value * (largest / before) } else { Vec3f::splat(largest) };
    }
    colour(ui, value);
}
