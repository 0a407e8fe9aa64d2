//! What the viewer asks of whoever opens it: files and their formats are not its own.

use std::path::{Path, PathBuf};
use whitted::render::Image;
use whitted::scene::{NamedCamera, Scene};

/// A scene and the files that it came from.
#[derive(Clone, Debug, Default)]
pub struct Opened {
    /// The scene.
    pub scene: Scene,
    /// All files that were read: whoever changes one of them changes the scene.
    pub files: Vec<PathBuf>,
    /// What was odd, a line or more for each.
    pub warnings: Vec<String>,
}

/// A picture to be saved.
#[derive(Clone, Copy, Debug)]
pub struct Shot<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// As it is seen: RGB row by row.
    pub rgb8: &'a [u8],
    /// Its linear colours, if it shows light and nothing else.
    pub linear: Option<&'a Image>,
}

/// Opens and saves for the viewer. Called from threads of the viewer's, never from the one that serves the window.
pub trait Host: Send + Sync + 'static {
    /// The file of the scene, for the title and as the first to watch.
    fn path(&self) -> &Path;

    /// Read the scene as it is now.
    ///
    /// # Errors
    /// What is wrong and where, in lines that a person can read: they are shown in the window.
    fn open(&self) -> Result<Opened, String>;

    /// Write a picture in the format that the name of the file says. The file must be whole or not there, whatever happens
    /// meanwhile.
    ///
    /// # Errors
    /// Why it could not be written.
    fn save(&self, path: &Path, shot: &Shot<'_>) -> Result<(), String>;

    /// Write what differs between `old`, the scene as it was read, and `new` into the scene's file, which otherwise stays
    /// as it is.
    ///
    /// # Errors
    /// What cannot be written, and why.
    fn write_back(&self, old: &Scene, new: &Scene) -> Result<(), String>;

    /// The camera as it is written in a scene file.
    fn camera_block(&self, camera: &NamedCamera) -> String;
}
