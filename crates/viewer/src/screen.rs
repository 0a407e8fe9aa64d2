//! The picture that is shown, shared by those who paint it and the one who shows it.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use whitted::render::{AovPicture, Frame, PixelRect};
use whitted::scene::{Camera, Prepared, Settings};

use crate::enlarge::packed;
use crate::host::{Host, Shot};
use crate::quality::Draft;

/// How far the picture is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stage {
    /// Nothing was painted yet.
    #[default]
    Blank,
    /// Painted in a hurry, because things move.
    Draft,
    /// Being painted in full: this share of all regions, 0 to 2 (once all regions, then their edges).
    Refining(f32),
    /// As good as the settings ask for.
    Finished,
}

/// A finished picture with all that is known of it.
#[derive(Debug)]
pub struct Finished {
    /// The picture.
    pub frame: Arc<Frame>,
    /// What is shown instead of it.
    pub view: Option<AovPicture>,
    /// The settings with which it was made.
    pub settings: Settings,
    /// The scene, with the camera of its file.
    pub scene: Arc<Prepared>,
    /// The camera.
    pub camera: Camera,
    /// How long it took from the first region to the last.
    pub time: Duration,
}

impl Finished {
    /// What is shown, RGB row by row.
    pub fn rgb8(&self) -> Vec<u8> {
        self.view.as_ref().map_or_else(|| self.frame.image.to_rgb8(&self.settings), |view| view.rgb8.clone())
    }

    /// Save what is shown.
    pub(crate) fn save(&self, host: &dyn Host, path: &Path) -> Result<(), String> {
        let linear = self.view.is_none().then_some(&self.frame.image);
        host.save(path, &Shot { size: self.settings.size, rgb8: &self.rgb8(), linear })
    }
}

/// The picture that is shown.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// Width and height in pixels; zero at first.
    pub size: [u32; 2],
    /// `0x00RRGGBB`, row by row.
    pub pixels: Vec<u32>,
    /// How far it is.
    pub stage: Stage,
    /// Counts changes.
    pub version: u64,
    /// The draft from which it began.
    pub draft: Draft,
    /// How long that draft took.
    pub draft_time: Duration,
    /// Drafts that were shown since the viewer was opened.
    pub drafts: u64,
    /// The scene from which the draft was made.
    pub(crate) scene: Option<Arc<Prepared>>,
    /// The finished picture, once it is.
    pub finished: Option<Arc<Finished>>,
}

/// Copy the pixels of `rect`, RGB row by row, to their places among those of a picture of this width.
pub(crate) fn copy_rect(pixels: &mut [u32], width: u32, rect: &PixelRect, rgb8: &[u8]) {
    for (y, row) in (rect.y as usize..).zip(rgb8.chunks_exact(3 * rect.width as usize)) {
        let start = y * width as usize + rect.x as usize;
        let to = &mut pixels[start..start + rect.width as usize];
        to.iter_mut().zip(row.chunks_exact(3)).for_each(|(to, rgb)| *to = packed(rgb));
    }
}

/// The shared picture. Whoever holds it copies pixels and nothing else, so nobody waits for long.
pub(crate) struct Screen {
    picture: Mutex<Picture>,
    /// Called after each change, from any thread.
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Screen {
    pub(crate) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self { picture: Mutex::default(), wake }
    }

    /// The picture, for a moment.
    pub(crate) fn look(&self) -> MutexGuard<'_, Picture> {
        // A panic elsewhere leaves a picture that can still be shown.
        self.picture.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Change the picture, and let it be shown.
    pub(crate) fn change(&self, change: impl FnOnce(&mut Picture)) {
        let mut picture = self.look();
        change(&mut picture);
        picture.version += 1;
        drop(picture);
        (self.wake)();
    }

    /// Replace some pixels of a picture that is being refined, if it still has this size.
    pub(crate) fn paint(&self, size: [u32; 2], rect: &PixelRect, rgb8: &[u8]) {
        self.change(|picture| {
            if picture.size == size {
                copy_rect(&mut picture.pixels, size[0], rect, rgb8);
            }
        });
    }

    /// As [`paint`](Self::paint), for single pixels.
    pub(crate) fn touch_up(&self, size: [u32; 2], pixels: &[[u32; 2]], rgb8: &[u8]) {
        self.change(|picture| {
            if picture.size == size {
                for (&[x, y], rgb) in pixels.iter().zip(rgb8.chunks_exact(3)) {
                    picture.pixels[y as usize * size[0] as usize + x as usize] = packed(rgb);
                }
            }
        });
    }
}
