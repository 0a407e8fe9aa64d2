//! Writing changed values back into the text of a scene.
//!
//! The values are found by their places in the text and replaced one by one; what is not replaced stays, byte by byte:
//! comments, order, blanks, keys. The changed text is read again before it is given away, and must say what was wanted.

mod light;
mod literal;
mod look;
mod material;
mod patch;

use std::path::Path;

use whitted::scene::{Camera, Change, Light, NamedCamera, Scene, Settings, difference};

use super::document::{Fault, Node};
use super::{build, look_of, toml};
use crate::error::{Error, ErrorKind, quoted};
use crate::source::Source;
use patch::Patch;

/// The lines of a section for a camera, to be put into a scene: `[camera.NAME]`, or `[camera]` if `name` is empty.
pub fn camera_block(name: &str, camera: &Camera) -> String {
    let entries = look::whole_camera(camera).into_iter().map(|(key, value)| format!("{key} = {value}\n"));
    format!("{}\n{}", camera_header(name), entries.collect::<String>())
}

fn camera_header(name: &str) -> String {
    if name.is_empty() { "[camera]".to_owned() } else { format!("[camera.{}]", literal::key(name)) }
}

/// `text`, a scene in TOML, with the values that differ between `old`, the scene that was read from it, and `new`.
///
/// Written back are settings, ambient light, background, and the values of cameras, lights and materials that the text
/// states; lights that are new or no more; materials that the text does not state but could; and cameras that are new
/// by their name. `file` stands for the text in messages.
///
/// # Errors
/// [`ErrorKind::Unsupported`] for all other changes, and where the text is written in a way
/// in which a value has no place. [`ErrorKind::Input`] if the text is not a scene.
pub fn write_back(file: &Path, text: &str, old: &Scene, new: &Scene) -> Result<String, Error> {
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source { file, bytes: body.as_bytes() };
    let stated = super::decode(&source, &super::TOML)?;
    let before = build::look(&stated, source)?;
    let wanted = wanted(&before, &build::implied_materials(&stated), old, new)
        .map_err(|what| Error::new(ErrorKind::Unsupported, file, what))?;
    let fail = |fault| super::error(&source, fault).blame(ErrorKind::Unsupported);
    let document = toml::parse(body).map_err(fail)?;
    let mut patch = Patch::new(body);
    write(&mut patch, &document, &before, &wanted).map_err(fail)?;
    let written = patch.apply();
    let found = look_of(Source { file, bytes: written.as_bytes() });
    if !found.is_ok_and(|found| says(&found, &wanted)) {
        let what = "the text is written in a way into which this change cannot be put";
        return Err(Error::new(ErrorKind::Unsupported, file, what));
    }
    Ok(format!("{}{written}", &text[..text.len() - body.len()]))
}

/// What the text shall say: `before` with all that differs between `old` and `new`.
fn wanted(before: &Scene, implied: &[String], old: &Scene, new: &Scene) -> Result<Scene, String> {
    if difference(old, new) == Change::Geometry {
        return Err("changed shapes cannot be written back".to_owned());
    }
    let mut wanted = before.clone();
    settings(&mut wanted.settings, &old.settings, &new.settings);
    take_over(&mut wanted.ambient, &old.ambient, &new.ambient);
    take_over(&mut wanted.background, &old.background, &new.background);
    lights(&mut wanted, old, new)?;
    materials(&mut wanted, implied, old, new)?;
    cameras(&mut wanted, old, new)?;
    Ok(wanted)
}

fn take_over<T: PartialEq + Clone>(value: &mut T, old: &T, new: &T) {
    if old != new {
        value.clone_from(new);
    }
}

/// Only what differs: other settings may stand in for those of the text.
fn settings(settings: &mut Settings, old: &Settings, new: &Settings) {
    take_over(&mut settings.size, &old.size, &new.size);
    take_over(&mut settings.depth, &old.depth, &new.depth);
    take_over(&mut settings.min_weight, &old.min_weight, &new.min_weight);
    take_over(&mut settings.antialias, &old.antialias, &new.antialias);
    take_over(&mut settings.antialias_max, &old.antialias_max, &new.antialias_max);
    take_over(&mut settings.sampling, &old.sampling, &new.sampling);
    take_over(&mut settings.shadows, &old.shadows, &new.shadows);
    take_over(&mut settings.exposure, &old.exposure, &new.exposure);
    take_over(&mut settings.tone, &old.tone, &new.tone);
    take_over(&mut settings.seed, &old.seed, &new.seed);
}

fn lights(wanted: &mut Scene, old: &Scene, new: &Scene) -> Result<(), String> {
    if old.lights == new.lights {
        return Ok(());
    }
    if old.lights.len() != wanted.lights.len() {
        return Err("lights that the file does not state cannot be written back".to_owned());
    }
    let stated = |(origin, new): (Option<usize>, &Light)| match origin {
        Some(index) => {
            let mut light = wanted.lights[index];
            take_over(&mut light, &old.lights[index], new);
            light
        }
        None => *new,
    };
    wanted.lights = light::origins(&old.lights, &new.lights).into_iter().zip(&new.lights).map(stated).collect();
    Ok(())
}

/// `implied`: names of materials that need not be stated, but can.
fn materials(wanted: &mut Scene, implied: &[String], old: &Scene, new: &Scene) -> Result<(), String> {
    let names = |scene: &Scene| scene.materials.iter().map(|named| named.name.clone()).collect::<Vec<_>>();
    if names(old) != names(new) {
        return Err("materials cannot be added, removed or renamed".to_owned());
    }
    for (old, new) in old.materials.iter().zip(&new.materials).filter(|(old, new)| old != new) {
        match wanted.materials.iter_mut().find(|named| named.name == new.name) {
            Some(stated) => take_over(&mut stated.material, &old.material, &new.material),
            None if implied.contains(&new.name) => wanted.materials.push(new.clone()),
            None => return Err(format!("the material {} does not stand in this file", quoted(&new.name))),
        }
    }
    Ok(())
}

/// Cameras are known by their names: their order may differ.
fn cameras(wanted: &mut Scene, old: &Scene, new: &Scene) -> Result<(), String> {
    let named = |scene: &Scene, name: &str| scene.cameras.iter().find(|camera| camera.name == name).cloned();
    if let Some(lost) = old.cameras.iter().find(|camera| named(new, &camera.name).is_none()) {
        return Err(format!("the camera {} cannot be removed or renamed", quoted(&lost.name)));
    }
    for camera in &new.cameras {
        let stated = wanted.cameras.iter().position(|stated| stated.name == camera.name);
        match (named(old, &camera.name), stated) {
            (Some(before), _) if before == *camera => {}
            (Some(_), Some(index)) => wanted.cameras[index] = camera.clone(),
            (None, None) if !wanted.cameras.is_empty() => wanted.cameras.push(camera.clone()),
            // A file without a camera gets lights and a floor too: with one, it would lose them.
            _ => return Err("the file states no camera: the scene would no longer be furnished".to_owned()),
        }
    }
    Ok(())
}

/// Put everything in which `wanted` differs from `before` into the text.
fn write(patch: &mut Patch, document: &Node<'_>, before: &Scene, wanted: &Scene) -> Result<(), Fault> {
    let render = look::render(before, wanted);
    match document.get("render") {
        Some(table) => look::set_all(patch, table, render)?,
        None => {
            let entries: Vec<_> = render.into_iter().filter_map(|(key, value)| Some((key, value?))).collect();
            if !entries.is_empty() {
                patch.append("[render]", &entries);
            }
        }
    }
    light::lights(patch, document, &before.lights, &wanted.lights)?;
    let materials = document.get("material");
    for (old, new) in before.materials.iter().zip(&wanted.materials) {
        if let Some(table) = materials.and_then(|node| node.get(&new.name)) {
            material::material(patch, table, &old.material, &new.material)?;
        }
    }
    for new in wanted.materials.iter().skip(before.materials.len()) {
        material::append(patch, &new.name, &new.material)?;
    }
    write_cameras(patch, document, &before.cameras, &wanted.cameras)
}

fn write_cameras(
    patch: &mut Patch,
    document: &Node<'_>,
    before: &[NamedCamera],
    wanted: &[NamedCamera],
) -> Result<(), Fault> {
    let Some(table) = document.get("camera") else { return Ok(()) };
    let is_single = super::sections::is_single_camera(table);
    for (old, new) in before.iter().zip(wanted) {
        let table = if is_single { Some(table) } else { table.get(&new.name) };
        if let Some(table) = table {
            look::set_all(patch, table, look::camera(&old.camera, &new.camera))?;
        }
    }
    let added = &wanted[before.len()..];
    if let (true, false, Some(first)) = (is_single, added.is_empty(), before.first()) {
        // Where there are several, each has its name.
        patch.replace(table, camera_header(&first.name));
    }
    for camera in added {
        patch.append(&camera_header(&camera.name), &look::whole_camera(&camera.camera));
    }
    Ok(())
}

/// Whether two scenes say the same but for shapes.
fn says(found: &Scene, wanted: &Scene) -> bool {
    difference(found, wanted) == Change::Nothing
}
