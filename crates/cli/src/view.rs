//! `whitted view`: opens a window on a scene, or does what a script says.

use crate::args::{PictureArguments, SceneArguments, ViewArguments};
use crate::exit::Failure;
use crate::load::load_silently;
use crate::output::Target;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use viewer::script::{self, ScriptFailure, Step};
use viewer::{Host, Opened, Options, WindowError};
use whitted::math::Vec3d;
use whitted::scene::{Camera, NamedCamera};

pub(crate) fn run(arguments: &ViewArguments) -> Result<(), Failure> {
    arguments.picture.check()?;
    if arguments.picture.crop.is_some() {
        return Err(Failure::Usage("--crop is for pictures: a window shows all of its own".to_owned()));
    }
    // A scene that is not there needs no window; one that is broken gets one, and can be mended.
    std::fs::metadata(&arguments.scene.scene)
        .map_err(|error| Failure::Io(format!("{}: cannot open the file: {error}", arguments.scene.scene.display())))?;
    let steps = steps(arguments)?;
    let host = Arc::new(Files::new(arguments));
    let options = options(arguments);
    match steps {
        Some(steps) => script::run(host, options, &steps, &mut print).map_err(|e| blame(&e)),
        None => viewer::run(host, options).map_err(|error: WindowError| Failure::Io(error.to_string())),
    }
}

/// Prints a line for who listens.
fn print(line: &str) {
    // Whoever has closed standard output does not want it.
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn options(arguments: &ViewArguments) -> Options {
    Options {
        fps_target: arguments.fps_target,
        size: arguments.picture.size,
        threads: arguments.threads.unwrap_or(0),
        build: arguments.tree.unwrap_or_default().into(),
        ..Options::default()
    }
}

/// What the script says, and the screenshot at its end; none of either: a person shall look.
fn steps(arguments: &ViewArguments) -> Result<Option<Vec<Step>>, Failure> {
    let mut steps = match &arguments.script {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|error| Failure::Io(format!("{}: cannot read the file: {error}", path.display())))?;
            script::parse(&text).map_err(|error| Failure::Usage(format!("{}: {error}", path.display())))?
        }
        None if arguments.screenshot.is_none() => return Ok(None),
        None => Vec::new(),
    };
    if let Some(path) = &arguments.screenshot {
        Target::check(path)?;
        steps.extend([Step::WaitRefined, Step::Screenshot(path.clone())]);
    }
    Ok(Some(steps))
}

fn blame(error: &ScriptFailure) -> Failure {
    Failure::Io(error.to_string())
}

/// The files of the viewer.
struct Files {
    path: PathBuf,
    scene: SceneArguments,
    picture: PictureArguments,
}

impl Files {
    fn new(arguments: &ViewArguments) -> Self {
        let ViewArguments { scene, picture, .. } = arguments.clone();
        Self { path: scene.scene.clone(), scene, picture }
    }
}

impl Host for Files {
    fn path(&self) -> &Path {
        &self.path
    }

    fn open(&self) -> Result<Opened, String> {
        let loaded = load_silently(&self.scene).map_err(|error| error.to_string())?;
        let mut scene = loaded.scene;
        self.picture.choose_camera(&mut scene).map_err(|failure| failure.to_string())?;
        scene.settings = self.picture.over(scene.settings);
        let warnings = loaded.warnings.iter().map(ToString::to_string).collect();
        Ok(Opened { scene, files: loaded.files, warnings })
    }

    fn save(&self, path: &Path, [width, height]: [u32; 2], rgb8: &[u8]) -> Result<(), String> {
        let png = formats::png::encode(width, height, rgb8).map_err(|error| error.to_string())?;
        let written = Target::check(path).and_then(|target| target.write(&png));
        written.map_err(|failure| failure.to_string())
    }

    fn camera_block(&self, named: &NamedCamera) -> String {
        block(named)
    }
}

/// Names of cameras that the scene's author did not give.
const NO_NAMES: [&str; 2] = ["default", "auto"];

/// The section of a scene file that describes a camera, in digits enough to give the same picture.
fn block(NamedCamera { name, camera }: &NamedCamera) -> String {
    let mut text = String::from("[camera]");
    if !NO_NAMES.contains(&name.as_str()) {
        text = format!("[camera.{name:?}]");
    }
    let mut line = |key: &str, value: String| _ = write!(text, "\n{key} = {value}");
    let triple = |v: Vec3d| format!("{:?}", v.to_array());
    line("eye", triple(camera.eye));
    line("look_at", triple(camera.look_at));
    if camera.up != Camera::default().up {
        line("up", triple(camera.up));
    }
    line("vfov", format!("{:?}", camera.vfov));
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use formats::{Format, LoadOptions};

    #[test]
    fn a_camera_block_is_the_camera() {
        let eye = Vec3d::new(1.0 / 3.0, -2e-7, 1e21);
        for (name, up) in [("default", Camera::default().up), ("above the \"table\"", Vec3d::new(0.1, 1.0, 0.0))] {
            let camera = Camera { eye, look_at: Vec3d::new(0.1, 0.2, 0.3), up, vfov: 33.3 };
            let text = format!("version = 1\n{}\n", block(&NamedCamera { name: name.to_owned(), camera }));
            let loaded = formats::parse(Format::Toml, Path::new("x"), text.into_bytes(), &LoadOptions::default());
            let scene = loaded.expect("a scene").scene;
            assert_eq!(scene.cameras, [NamedCamera { name: name.to_owned(), camera }]);
        }
    }
}
