//! Recording the way of the camera, to render it frame by frame afterwards.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use whitted::render::{Cancel, Execution, PixelRect, Renderer, Silent, Unwatched};
use whitted::scene::{Camera, Prepared, Settings};

use crate::host::{Host, Shot};
use crate::painter::nameless;

/// Pictures for each second of a recorded way.
const RATE: f64 = 30.0;

/// The longest way that is recorded: ten minutes are 18 000 pictures.
const LONGEST: Duration = Duration::from_secs(600);

/// Remembers where the camera was.
#[derive(Debug, Default)]
pub(super) struct Recorder {
    start: Option<Instant>,
    way: Vec<(Duration, Camera)>,
    /// Stops the frames that are being rendered.
    cancel: Arc<Cancel>,
}

impl Recorder {
    /// Whether it records.
    pub(super) fn is_on(&self) -> bool {
        self.start.is_some()
    }

    pub(super) fn start(&mut self, now: Instant) {
        self.start = Some(now);
        self.way.clear();
    }

    /// Remember where the camera is now.
    pub(super) fn observe(&mut self, camera: &Camera, now: Instant) {
        let Some(start) = self.start else { return };
        let time = now.duration_since(start);
        if time <= LONGEST {
            self.way.push((time, *camera));
        }
    }

    /// End the recording: the camera of each frame.
    pub(super) fn stop(&mut self) -> Vec<Camera> {
        self.start = None;
        frames(&std::mem::take(&mut self.way))
    }

    /// What stops frames that are being rendered.
    pub(super) fn cancel(&self) -> &Arc<Cancel> {
        &self.cancel
    }
}

/// The way in frames at equal distances in time; each camera is one that was there or lies between two that were.
fn frames(way: &[(Duration, Camera)]) -> Vec<Camera> {
    let Some(((end, last), rest)) = way.split_last() else { return Vec::new() };
    if rest.is_empty() {
        return vec![*last];
    }
    let count = (end.as_secs_f64() * RATE) as usize + 1;
    let frame = |number: usize| {
        let time = Duration::from_secs_f64(number as f64 / RATE);
        let after = way.partition_point(|(at, _)| *at < time).clamp(1, way.len() - 1);
        between(&way[after - 1], &way[after], time)
    };
    (0..count).map(frame).collect()
}

fn between((start, a): &(Duration, Camera), (end, b): &(Duration, Camera), time: Duration) -> Camera {
    let length = end.saturating_sub(*start).as_secs_f64();
    let share = if length > 0.0 { time.saturating_sub(*start).as_secs_f64() / length } else { 1.0 }.min(1.0);
    let camera =
        Camera { eye: a.eye + (b.eye - a.eye) * share, look_at: a.look_at + (b.look_at - a.look_at) * share, ..*b };
    if camera.fault().is_none() { camera } else { *b }
}

/// What is needed to render a recorded way.
pub(super) struct Film {
    pub(super) host: Arc<dyn Host>,
    pub(super) pool: Arc<rayon::ThreadPool>,
    pub(super) scene: Arc<Prepared>,
    pub(super) settings: Settings,
    pub(super) execution: Execution,
    pub(super) cameras: Vec<Camera>,
    pub(super) cancel: Arc<Cancel>,
}

impl Film {
    /// Render all frames into a new folder, and tell how it goes.
    pub(super) fn develop(self, tell: &dyn Fn(String)) {
        match self.try_develop(tell) {
            Ok(folder) => tell(format!("{} frames are in {}", self.cameras.len(), folder.display())),
            Err(_) if self.cancel.is_cancelled() => {}
            Err(text) => tell(text),
        }
    }

    fn try_develop(&self, tell: &dyn Fn(String)) -> Result<PathBuf, String> {
        let folder = free_name(self.host.path(), "-frames", "");
        std::fs::create_dir(&folder)
            .map_err(|error| format!("cannot make the folder {}: {error}", folder.display()))?;
        let renderer = Renderer::default();
        for (number, camera) in (1..).zip(&self.cameras) {
            let scene = self.scene.with_camera(&nameless(camera)).map_err(|error| error.to_string())?;
            let whole = PixelRect::whole(self.settings.size);
            let render =
                || renderer.render(&scene, &self.settings, &self.execution, &whole, &Silent, &self.cancel, &Unwatched);
            let frame = self.pool.install(render).map_err(|cancelled| cancelled.to_string())?;
            let rgb8 = frame.image.to_rgb8(&self.settings);
            let shot = Shot { size: self.settings.size, rgb8: &rgb8, linear: Some(&frame.image) };
            self.host.save(&folder.join(format!("{number:05}.png")), &shot)?;
            if number % 10 == 0 {
                tell(format!("frame {number} of {}", self.cameras.len()));
            }
        }
        Ok(folder)
    }
}

/// A name in the current folder, made of that of `scene`, that no file has yet.
pub(super) fn free_name(scene: &Path, suffix: &str, extension: &str) -> PathBuf {
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let name = |number: u32| {
        let number = if number > 1 { format!("-{number}") } else { String::new() };
        PathBuf::from(format!("{stem}{suffix}{number}{extension}"))
    };
    (1..).map(name).find(|name| !name.exists()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitted::math::Vec3d;

    fn at(seconds: f64, x: f64) -> (Duration, Camera) {
        let camera = Camera { eye: Vec3d::new(x, 0.0, 5.0), look_at: Vec3d::new(x, 0.0, 0.0), ..Camera::default() };
        (Duration::from_secs_f64(seconds), camera)
    }

    #[test]
    fn frames_have_equal_distances_in_time() {
        let cameras = frames(&[at(0.0, 0.0), at(0.3, 3.0), at(0.31, 3.1), at(1.0, 10.0)]);
        assert_eq!(cameras.len(), 31);
        for (number, camera) in (0..).zip(&cameras) {
            assert!((camera.eye.x - 10.0 * f64::from(number) / RATE).abs() < 1e-6, "{number}: {camera:?}");
        }
    }

    #[test]
    fn short_ways_have_few_frames() {
        assert!(frames(&[]).is_empty());
        assert_eq!(frames(&[at(0.0, 1.0)]).len(), 1);
        assert_eq!(frames(&[at(0.0, 1.0), at(0.0, 2.0)]).len(), 1);
    }
}
