//! How the viewer shall work.

use simd::Level;
use whitted::render::Execution;
use whitted::tree::BuildOptions;

/// How the viewer shall work: nothing here changes the finished picture but its size.
#[derive(Clone, Debug)]
pub struct Options {
    /// Pictures a second that are kept up while things move; > 0.
    pub fps_target: f64,
    /// Size of the window in pixels; none: as the scene says.
    pub size: Option<[u32; 2]>,
    /// Threads that render; 0: one for each core.
    pub threads: usize,
    /// How finished pictures are computed.
    pub execution: Execution,
    /// How the tree is built.
    pub build: BuildOptions,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fps_target: 30.0,
            size: None,
            threads: 0,
            execution: Execution { level: Level::best(), ..Execution::default() },
            build: BuildOptions::default(),
        }
    }
}
