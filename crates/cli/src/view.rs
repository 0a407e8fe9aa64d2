//! `whitted view`: opens a window on a scene, or does what a script says.

use crate::args::{PictureArguments, SceneArguments, ViewArguments};
use crate::exit::Failure;
use crate::output::Target;
use crate::picture::PictureFormat;
use formats::{Format, LoadOptions, Loader};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use viewer::script::{self, ScriptFailure, Step};
use viewer::{Host, Opened, Options, Shot, WindowError};
use whitted::scene::{NamedCamera, Scene};

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
        if PictureFormat::of(path)? == PictureFormat::Exr {
            return Err(Failure::Usage("--screenshot saves what is seen, as .png".to_owned()));
        }
        Target::check(path)?;
        steps.extend([Step::WaitRefined, Step::Screenshot(path.clone())]);
    }
    Ok(Some(steps))
}

fn blame(error: &ScriptFailure) -> Failure {
    Failure::Io(error.to_string())
}

/// Write what is shown; as EXR it must be light.
fn write(path: &Path, shot: &Shot<'_>) -> Result<(), Failure> {
    let file = match (PictureFormat::of(path)?, shot.linear) {
        (format, Some(image)) => format.encode(image, || shot.rgb8.to_vec())?,
        (PictureFormat::Png, None) => encode_png(shot)?,
        (PictureFormat::Exr, None) => {
            let text = format!("cannot write '{}': only light can be saved as EXR, not another view", path.display());
            return Err(Failure::Usage(text));
        }
    };
    Target::check(path)?.write(&file)
}

fn encode_png(shot: &Shot<'_>) -> Result<Vec<u8>, Failure> {
    let [width, height] = shot.size;
    formats::png::encode(width, height, shot.rgb8).map_err(|error| Failure::Io(error.to_string()))
}

/// Names of cameras that no author gave.
const NO_NAMES: [&str; 2] = ["default", "auto"];

/// The files of the viewer.
struct Files {
    path: PathBuf,
    loader: Mutex<Loader>,
    scene: SceneArguments,
    picture: PictureArguments,
}

impl Files {
    fn new(arguments: &ViewArguments) -> Self {
        let ViewArguments { scene, picture, .. } = arguments.clone();
        Self { path: scene.scene.clone(), loader: Mutex::default(), scene, picture }
    }
}

impl Host for Files {
    fn path(&self) -> &Path {
        &self.path
    }

    fn open(&self) -> Result<Opened, String> {
        let options = LoadOptions { allow_outside: self.scene.allow_outside, ..LoadOptions::default() };
        // What a panic elsewhere has left is at worst a mesh that is read again.
        let mut loader = self.loader.lock().unwrap_or_else(PoisonError::into_inner);
        let loaded = loader.load(&self.path, &options).map_err(|error| error.to_string())?;
        drop(loader);
        let mut scene = loaded.scene;
        self.picture.choose_camera(&mut scene).map_err(|failure| failure.to_string())?;
        scene.settings = self.picture.over(scene.settings);
        let warnings = loaded.warnings.iter().map(ToString::to_string).collect();
        Ok(Opened { scene, files: loaded.files, warnings })
    }

    fn save(&self, path: &Path, shot: &Shot<'_>) -> Result<(), String> {
        write(path, shot).map_err(|failure| failure.to_string())
    }

    fn write_back(&self, old: &Scene, new: &Scene) -> Result<(), String> {
        if Format::of(&self.path) != Ok(Format::Toml) {
            return Err("only scenes in TOML can be written into".to_owned());
        }
        let text = std::fs::read_to_string(&self.path).map_err(|error| format!("cannot read the scene: {error}"))?;
        let written = formats::write_back(&self.path, &text, old, new).map_err(|error| error.to_string())?;
        let target = Target::check(&self.path).and_then(|target| target.write(written.as_bytes()));
        target.map_err(|failure| failure.to_string())
    }

    fn camera_block(&self, named: &NamedCamera) -> String {
        let name = if NO_NAMES.contains(&named.name.as_str()) { "" } else { &named.name };
        formats::camera_block(name, &named.camera).trim_end().to_owned()
    }
}
