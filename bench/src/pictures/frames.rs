//! Frames per second: one prepared scene, rendered again and again in this process, without output.

use crate::contest::median;
use crate::machine::{Neighbours, QUIET};
use cpu_time::ProcessTime;
use formats::{Format, LoadOptions};
use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use whitted::render::{Cancel, Cancelled, Execution, PixelRect, Renderer, Silent, Unwatched};
use whitted::scene::{Antialias, Prepared, Settings, Shadows};
use whitted::tree::BuildOptions;

/// Numbers of threads that render.
const THREADS: [usize; 2] = [1, 2];
/// Frames that follow each other with one number of threads, as they do where something moves: threads that have slept
/// for the time of a frame may wake on one core, and stay there for milliseconds.
const BURST: usize = 11;
/// Bursts with each number of threads. The first warms up; of the frames of the others the median counts.
const BURSTS: usize = 5;

/// Seconds that a frame took.
struct Frame {
    wall: f64,
    cpu: f64,
}

/// Render the scene that `text` describes, 640 × 480 and otherwise as `pictures` does; print a line for each number of
/// threads and return them as JSON.
///
/// # Errors
/// The scene is wrong, or threads cannot be started.
pub(super) fn run(name: &str, text: &str) -> Result<Vec<Value>, Box<dyn Error>> {
    let bytes = text.as_bytes().to_vec();
    let scene = formats::parse(Format::Toml, Path::new(name), bytes, &LoadOptions::default())?.scene;
    let settings = Settings { antialias: Antialias::Off, shadows: Shadows::Opaque, ..scene.settings.clone() };
    let prepared = Prepared::new(&scene, &BuildOptions::default())?;
    let mut pools = Vec::new();
    for threads in THREADS {
        pools.push((rayon::ThreadPoolBuilder::new().num_threads(threads).build()?, Vec::new()));
    }
    let renderer = Renderer::default();
    let neighbours = Neighbours::watch();
    for burst in 0..BURSTS {
        for (pool, frames) in &mut pools {
            for _ in 0..BURST {
                let frame = pool.install(|| timed(&renderer, &prepared, &settings))?;
                if burst > 0 {
                    frames.push(frame);
                }
            }
        }
    }
    let others = neighbours.cores();
    Ok(THREADS.iter().zip(&pools).map(|(&threads, (_, frames))| row(name, threads, frames, others)).collect())
}

fn timed(renderer: &Renderer, prepared: &Prepared, settings: &Settings) -> Result<Frame, Cancelled> {
    let (start, cpu) = (Instant::now(), ProcessTime::now());
    let execution = Execution { first_samples: false, ..Execution::default() };
    let whole = PixelRect::whole(settings.size);
    renderer.recycle(renderer.render(prepared, settings, &execution, &whole, &Silent, &Cancel::new(), &Unwatched)?);
    Ok(Frame { wall: start.elapsed().as_secs_f64(), cpu: cpu.elapsed().as_secs_f64() })
}

/// By the wall clock if other programs left the cores alone, else as many as CPU time allows if every thread had a core.
fn row(name: &str, threads: usize, frames: &[Frame], others: Option<f64>) -> Value {
    let middle = |seconds: fn(&Frame) -> f64| median(frames.iter().map(seconds).collect());
    let (rate, by) = match others.is_some_and(|cores| cores < QUIET) {
        true => (1.0 / middle(|frame| frame.wall), "wall"),
        false => (threads as f64 / middle(|frame| frame.cpu), "cpu"),
    };
    let clock = if by == "wall" { "wall clock" } else { "CPU time; other programs were running" };
    println!("{name:<10} whitted, {threads} threads {rate:>8.1} frames/s by {clock}");
    json!({
        "scene": name,
        "renderer": "whitted",
        "threads": threads,
        "frames_per_second": rate,
        "frames_per_second_by": by,
        "cpu_seconds_per_frame": middle(|frame| frame.cpu),
    })
}
