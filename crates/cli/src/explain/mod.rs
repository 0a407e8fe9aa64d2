//! `whitted explain`: why a pixel looks as it does, ray by ray.

mod json;
mod text;

use crate::args::ExplainArguments;
use crate::exit::Failure;
use crate::interrupt;
use crate::load::load;
use crate::output::Target;
use std::path::Path;
use whitted::render::{Image, RayTree, explain};
use whitted::scene::{Prepared, Scene};
use whitted::tree::BuildOptions;

pub(crate) fn run(arguments: &ExplainArguments) -> Result<(), Failure> {
    arguments.picture.check()?;
    if arguments.picture.crop.is_some() {
        return Err(Failure::Usage("explain counts pixels in the whole picture: leave --crop out".to_owned()));
    }
    let cancel = interrupt::install();
    let scene = scene(arguments)?;
    let [x, y] = arguments.pixel;
    let [width, height] = scene.settings.size;
    if x >= width || y >= height {
        let text = format!("pixel {x},{y} does not lie inside the picture of {width}x{height} pixels, counted from 0");
        return Err(Failure::Usage(text));
    }
    let prepared = Prepared::new(&scene, &BuildOptions::default());
    let prepared = prepared.map_err(|error| Failure::Scene(format!("{}: {error}", arguments.scene.scene.display())))?;
    let samples = 0..if arguments.all_samples { u32::MAX } else { 1 };
    let tree = explain(&prepared, &scene.settings, arguments.pixel, samples, cancel);
    let tree = tree.map_err(|_cancelled| Failure::Interrupted)?;
    let answer = Answer { scene: &scene, tree: &tree };
    let text = if arguments.json { answer.json() } else { answer.text() };
    Target::check(Path::new("-"))?.write(text.as_bytes())
}

fn scene(arguments: &ExplainArguments) -> Result<Scene, Failure> {
    let mut scene = load(&arguments.scene, &arguments.verbosity)?.scene;
    arguments.picture.choose_camera(&mut scene)?;
    scene.settings = arguments.picture.over(scene.settings);
    Ok(scene)
}

/// What is told about a pixel of a scene.
struct Answer<'a> {
    scene: &'a Scene,
    tree: &'a RayTree,
}

impl Answer<'_> {
    /// What a display shows of the pixel.
    fn shown(&self) -> Vec<u8> {
        Image { width: 1, height: 1, pixels: vec![self.tree.color] }.to_rgb8(&self.scene.settings)
    }

    fn material(&self, material: u32) -> &str {
        &self.scene.materials[material as usize].name
    }
}
