//! Changed materials.

use whitted::math::Vec3f;
use whitted::shading::{Material, Reflectance, SpecularModel, Texture};

use super::literal::{self, color, list, single, strength, word};
use super::look::{Entry, changed, set_all};
use super::patch::Patch;
use crate::scene::document::{Fault, Node, Value};
use crate::scene::sections::plain_ior;
use crate::scene::toml;

/// Change the section of a material.
pub(super) fn material(patch: &mut Patch, table: &Node<'_>, old: &Material, new: &Material) -> Result<(), Fault> {
    set_all(
        patch,
        table,
        [
            ("ambient", changed(old, new, |m| m.ambient, single)),
            ("diffuse", changed(old, new, |m| m.diffuse, single)),
            ("transmit", changed(old, new, |m| m.transmit, strength)),
            ("ior", ior(table, old, new)),
            // As coefficients: few are those of a colour to the bit.
            ("absorb", changed(old, new, |m| m.absorb, |absorb| list(absorb.to_array().map(single)))),
        ],
    )?;
    if old.color != new.color {
        texture(patch, table, new.color)?;
    }
    specular(patch, table, old, new)?;
    reflect(patch, table, old, new)
}

/// Append a section for a material that has none.
pub(super) fn append(patch: &mut Patch, name: &str, material: &Material) -> Result<(), Fault> {
    // All that differs from the default, put into an empty section.
    let empty = toml::parse(EMPTY)?;
    let mut section = Patch::new(EMPTY);
    if let Some(table) = empty.get("m") {
        self::material(&mut section, table, &Material::default(), material)?;
    }
    let section = section.apply();
    let entries: Vec<_> =
        section.lines().filter_map(|line| line.split_once(" = ")).map(|(key, value)| (key, value.to_owned())).collect();
    patch.append(&format!("[material.{}]", literal::key(name)), &entries);
    Ok(())
}

const EMPTY: &str = "[m]";

/// Left out, the index follows the kind of reflection.
fn ior(table: &Node<'_>, old: &Material, new: &Material) -> Option<String> {
    let implied = table.get("ior").is_none();
    let before = if implied { plain_ior(new.reflectance) } else { old.ior };
    (before != new.ior).then(|| single(new.ior))
}

fn texture(patch: &mut Patch, table: &Node<'_>, new: Texture) -> Result<(), Fault> {
    match (new, table.get("color").filter(|node| is_table(node))) {
        (Texture::Color(flat), _) => patch.set(table, "color", color(flat)),
        (Texture::Checker { even, odd, size }, Some(checker)) => {
            patch.set(checker, "checker", list([color(even), color(odd)]))?;
            patch.set(checker, "size", single(size))
        }
        (Texture::Checker { even, odd, size }, None) => {
            let (colors, size) = (list([color(even), color(odd)]), single(size));
            patch.set(table, "color", format!("{{ checker = {colors}, size = {size} }}"))
        }
    }
}

fn specular(patch: &mut Patch, table: &Node<'_>, old: &Material, new: &Material) -> Result<(), Fault> {
    let model = |model| match model {
        SpecularModel::Phong => word("phong"),
        SpecularModel::Blinn => word("blinn"),
    };
    let entries: [Entry; 3] = [
        ("strength", changed(old, new, |m| m.specular, strength)),
        ("exponent", changed(old, new, |m| m.exponent, single)),
        ("model", changed(old, new, |m| m.specular_model, model)),
    ];
    let default = Material::default();
    let is_plain = new.exponent == default.exponent && new.specular_model == default.specular_model;
    let whole = || {
        let (strength, exponent) = (strength(new.specular), single(new.exponent));
        format!("{{ strength = {strength}, exponent = {exponent}, model = {} }}", model(new.specular_model))
    };
    compound(patch, table, "specular", entries, || if is_plain { strength(new.specular) } else { whole() })
}

fn reflect(patch: &mut Patch, table: &Node<'_>, old: &Material, new: &Material) -> Result<(), Fault> {
    let model = |reflectance| match reflectance {
        Reflectance::Constant => word("constant"),
        Reflectance::Fresnel => word("fresnel"),
        Reflectance::Schlick => word("schlick"),
    };
    let entries: [Entry; 2] = [
        ("strength", changed(old, new, |m| m.reflect, strength)),
        ("model", changed(old, new, |m| m.reflectance, model)),
    ];
    compound(patch, table, "reflect", entries, || match new.reflectance {
        Reflectance::Constant => strength(new.reflect),
        angular if new.reflect == Vec3f::ONE => model(angular),
        angular => format!("{{ strength = {}, model = {} }}", strength(new.reflect), model(angular)),
    })
}

/// Change a value that may be a table: its entries if it is one, else all of it.
fn compound<const N: usize>(
    patch: &mut Patch,
    table: &Node<'_>,
    key: &str,
    entries: [Entry; N],
    whole: impl Fn() -> String,
) -> Result<(), Fault> {
    if entries.iter().all(|(_, value)| value.is_none()) {
        return Ok(());
    }
    match table.get(key).filter(|node| is_table(node)) {
        Some(inner) => set_all(patch, inner, entries),
        None => patch.set(table, key, whole()),
    }
}

fn is_table(node: &Node<'_>) -> bool {
    matches!(node.value, Value::Table(_))
}
