//! Changed lights, new ones, and those that are no more.

use whitted::math::Vec3f;
use whitted::scene::{Light, LightKind};

use super::literal::{color, number, point, single, word};
use super::look::{Entry, changed, set_all};
use super::patch::Patch;
use crate::scene::document::{Fault, Node, Value};

/// Which of `old` each of `new` was: lights of one kind, in their order, so that as much as possible stays as it was.
/// `None` for new ones; those of `old` that are not named are no more.
pub(super) fn origins(old: &[Light], new: &[Light]) -> Vec<Option<usize>> {
    let first = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let (rest_old, rest_new) = (&old[first..], &new[first..]);
    let last = rest_old.iter().rev().zip(rest_new.iter().rev()).take_while(|(a, b)| a == b).count();
    let changed = changed_origins(&rest_old[..rest_old.len() - last], &rest_new[..rest_new.len() - last]);
    let changed = changed.into_iter().map(|origin| origin.map(|i| first + i));
    (0..first).map(Some).chain(changed).chain((old.len() - last..old.len()).map(Some)).collect()
}

/// [`origins`], in time and memory that grow with the square of their number.
fn changed_origins(old: &[Light], new: &[Light]) -> Vec<Option<usize>> {
    let alike = best_alike(old, new);
    let (mut i, mut origins) = (0, Vec::with_capacity(new.len()));
    for (j, light) in new.iter().enumerate() {
        while i < old.len() && alike[i][j] == alike[i + 1][j] {
            i += 1;
        }
        let is_same = i < old.len() && alike[i][j] == likeness(&old[i], light) + alike[i + 1][j + 1];
        origins.push(is_same.then_some(i));
        i += usize::from(is_same);
    }
    origins
}

/// `[i][j]`: how much the lights of `old` from `i` on and those of `new` from `j` on have in common at best.
fn best_alike(old: &[Light], new: &[Light]) -> Vec<Vec<u32>> {
    let mut best = vec![vec![0; new.len() + 1]; old.len() + 1];
    for i in (0..old.len()).rev() {
        for j in (0..new.len()).rev() {
            let paired = match likeness(&old[i], &new[j]) {
                0 => 0,
                alike => alike + best[i + 1][j + 1],
            };
            best[i][j] = paired.max(best[i + 1][j]).max(best[i][j + 1]);
        }
    }
    best
}

/// How much two lights have in common; 0 for those of different kinds.
fn likeness(a: &Light, b: &Light) -> u32 {
    if std::mem::discriminant(&a.kind) != std::mem::discriminant(&b.kind) {
        return 0;
    }
    let same = [a.kind == b.kind, a.color == b.color, a.inverse_square == b.inverse_square];
    1 + same.into_iter().map(u32::from).sum::<u32>()
}

/// Put everything in which the lights `new` differ from `old`, those of the text, into the text.
pub(super) fn lights(patch: &mut Patch, document: &Node<'_>, old: &[Light], new: &[Light]) -> Result<(), Fault> {
    let list = document.get("light");
    let tables = list.map_or(&[][..], |node| if let Value::List(items) = &node.value { items } else { &[] });
    let origins = origins(old, new);
    let mut last = None;
    for (&origin, light) in origins.iter().zip(new) {
        match origin.and_then(|i| tables.get(i).zip(old.get(i))) {
            Some((table, old)) => {
                change(patch, table, old, light)?;
                last = Some(table);
            }
            None => match (last, tables.first()) {
                (Some(table), _) => patch.insert_after(table, "[[light]]", &whole(light))?,
                (None, Some(first)) => patch.insert_before(first, "[[light]]", &whole(light))?,
                (None, None) => patch.append("[[light]]", &whole(light)),
            },
        }
    }
    let lost = (0..old.len()).filter(|&i| !origins.contains(&Some(i)));
    lost.filter_map(|i| tables.get(i)).try_for_each(|table| patch.remove(table))
}

/// All keys of a light that differ from the default.
fn whole(light: &Light) -> Vec<(&'static str, String)> {
    let mut entries = match light.kind {
        LightKind::Point { position } => vec![("point", point(position))],
        LightKind::Directional { direction } => vec![("direction", point(direction))],
        LightKind::Spot { position, look_at, inner, outer } => vec![
            ("spot", point(position)),
            ("look_at", point(look_at)),
            ("inner", number(inner)),
            ("outer", number(outer)),
        ],
    };
    if light.color != Vec3f::ONE {
        entries.push(("color", color(light.color)));
    }
    if light.inverse_square {
        entries.push(("falloff", falloff(true)));
    }
    entries
}

fn falloff(inverse_square: bool) -> String {
    word(if inverse_square { "inverse-square" } else { "none" })
}

/// Change the section of a light.
fn change(patch: &mut Patch, table: &Node<'_>, old: &Light, new: &Light) -> Result<(), Fault> {
    set_all(patch, table, place(table, &old.kind, &new.kind))?;
    if old.color != new.color {
        brightness(patch, table, old.color, new.color)?;
    }
    set_all(patch, table, [("falloff", changed(old, new, |light| light.inverse_square, falloff))])
}

/// The keys of a light's place where `new` differs from `old`, which is of the same kind.
fn place(table: &Node<'_>, old: &LightKind, new: &LightKind) -> Vec<Entry> {
    match (old, new) {
        (LightKind::Point { position: a }, LightKind::Point { position: b }) => {
            vec![("point", changed(a, b, |p| *p, point))]
        }
        (LightKind::Directional { direction: a }, LightKind::Directional { direction: b }) => {
            vec![("direction", changed(a, b, |d| *d, point))]
        }
        (
            LightKind::Spot { position: a, look_at: c, inner: e, outer: g },
            LightKind::Spot { position: b, look_at: d, inner: f, outer: h },
        ) => {
            // Left out, it follows the outer angle.
            let inner_follows = table.get("inner").is_none() && g != h;
            vec![
                ("spot", changed(a, b, |p| *p, point)),
                ("look_at", changed(c, d, |p| *p, point)),
                ("inner", if inner_follows { Some(number(*f)) } else { changed(e, f, |x| *x, number) }),
                ("outer", changed(g, h, |x| *x, number)),
            ]
        }
        _ => Vec::new(),
    }
}

/// Change the colour times the intensity of a light: one of the two alone if that gives the colour to the bit.
fn brightness(patch: &mut Patch, table: &Node<'_>, old: Vec3f, new: Vec3f) -> Result<(), Fault> {
    let intensity = match table.get("intensity").map(|node| &node.value) {
        Some(Value::Float(intensity)) => *intensity as f32,
        Some(Value::Integer(intensity)) => *intensity as f32,
        _ => 1.0,
    };
    let plain = old / intensity;
    let brighter = new.max_component() / plain.max_component();
    if brighter.is_finite() && plain * intensity == old && plain * brighter == new {
        return patch.set(table, "intensity", single(brighter));
    }
    let tint = new / intensity;
    if tint.is_finite() && tint * intensity == new {
        return patch.set(table, "color", color(tint));
    }
    let reset = table.get("intensity").map(|_| single(1.0));
    set_all(patch, table, [("color", Some(color(new))), ("intensity", reset)])
}
