//! From options to the library's settings: what was not said keeps what the scene says, or the default.

use crate::args::{Crop, ExecutionArguments, PictureArguments, WalkChoice};
use crate::exit::Failure;
use whitted::render::{Execution, PixelRect};
use whitted::scene::{Scene, Settings};

impl PictureArguments {
    /// Refuses values that no scene could make right; called before anything is loaded.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.over(Settings::default()).check().map_err(|error| Failure::Usage(error.to_string()))
    }

    /// `settings` with these options in place of what they name.
    pub(crate) fn over(&self, settings: Settings) -> Settings {
        Settings {
            size: self.size.unwrap_or(settings.size),
            depth: self.depth.unwrap_or(settings.depth),
            min_weight: self.min_weight.unwrap_or(settings.min_weight),
            antialias: self.aa.unwrap_or(settings.antialias),
            antialias_max: self.aa_max.unwrap_or(settings.antialias_max),
            sampling: self.sampling.unwrap_or(settings.sampling),
            shadows: self.shadows.unwrap_or(settings.shadows),
            ..settings
        }
    }

    /// The part of a picture of this size that is rendered.
    pub(crate) fn rectangle(&self, [width, height]: [u32; 2]) -> Result<PixelRect, Failure> {
        let Some(Crop { x, y, size }) = self.crop else { return Ok(PixelRect::whole([width, height])) };
        let fits = |start: u32, length: u32, end: u32| start.checked_add(length).is_some_and(|last| last <= end);
        if fits(x, size[0], width) && fits(y, size[1], height) {
            return Ok(PixelRect { x, y, width: size[0], height: size[1] });
        }
        let [crop_width, crop_height] = size;
        let crop = format!("{x},{y},{crop_width}x{crop_height}");
        Err(Failure::Usage(format!("--crop {crop} does not lie inside the picture of {width}x{height} pixels")))
    }

    /// Makes the chosen camera the scene's first, which is the one that is rendered.
    pub(crate) fn choose_camera(&self, scene: &mut Scene) -> Result<(), Failure> {
        let Some(name) = &self.camera else { return Ok(()) };
        let Some(chosen) = scene.cameras.iter().position(|camera| camera.name == *name) else {
            let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
            return Err(Failure::Usage(format!("no camera is called '{name}'; there are: {}", names.join(", "))));
        };
        scene.cameras.swap(0, chosen);
        Ok(())
    }
}

impl ExecutionArguments {
    /// How the picture is computed.
    pub(crate) fn execution(&self) -> Execution {
        let default = Execution::default();
        Execution {
            level: self.simd.unwrap_or(default.level),
            region: self.region.unwrap_or(default.region),
            method: self.render.unwrap_or(default.method),
            walk: match self.walk {
                Some(WalkChoice::Wide(walk)) => walk,
                _ => default.walk,
            },
            ..default
        }
    }

    /// The threads that render.
    pub(crate) fn pool(&self) -> Result<rayon::ThreadPool, Failure> {
        pool(self.threads)
    }
}

/// So many threads.
pub(crate) fn pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
    // Zero asks rayon for one thread per core.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    pool.build().map_err(|error| Failure::Io(format!("cannot start threads: {error}")))
}
