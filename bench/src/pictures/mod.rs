//! `pictures`: whole renders beside POV-Ray and Tachyon.
//!
//! Equal work: the same spheres, camera, lights and materials, 640 × 480, camera rays and five generations, cut-off
//! 1/255, one sample a pixel, one thread. What differs: POV-Ray and Tachyon let light pass through glass where we cast
//! opaque shadows, and Tachyon does not bend rays. Query counts are printed so that equal work can be seen.
//!
//! All renderers run in turn, and medians count. Trace times are CPU seconds: POV-Ray reports them; for the others it is
//! the share of the process' CPU time that tracing has of the wall-clock times of all phases.
//!
//! Then frames per second: one of the scenes again and again, with one thread and with two.

mod frames;
mod renderers;

use crate::contest::median;
use crate::machine;
use clap::Args;
use renderers::{Places, Render, Renderer};
use serde_json::{Value, json};
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Options of `pictures`.
#[derive(Args, Clone, Debug)]
pub(crate) struct Options {
    /// Scenes: mix-N and all4-N with N of 10, 100, 1000, 50000, or bunny
    #[arg(long = "scene", value_name = "NAME", num_args = 1.., default_values = SCENES)]
    scenes: Vec<String>,
    /// Rounds, of which the median counts
    #[arg(long, default_value_t = ROUNDS)]
    rounds: usize,
    /// Our command [default: beside this program]
    #[arg(long, value_name = "PATH")]
    whitted: Option<PathBuf>,
    /// The folder whose `peers/renderers` makes the scenes of the other renderers
    #[arg(long, env = "WHITTED_SHARED", value_name = "DIR")]
    shared: Option<PathBuf>,
    /// Write the rows to this file as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

const ROUNDS: usize = 5;

impl Options {
    /// Everything.
    pub(crate) fn new(shared: Option<PathBuf>) -> Self {
        Self { scenes: SCENES.map(String::from).into(), rounds: ROUNDS, whitted: None, shared, json: None }
    }
}

/// The scenes whose figures count.
const SCENES: [&str; 4] = [MOVING, "mix-50000", "all4-1000", "bunny"];
/// The scene that should be smooth on a screen.
const MOVING: &str = "mix-1000";

/// A folder that is removed in the end.
struct TemporaryFolder(PathBuf);

impl TemporaryFolder {
    fn new() -> io::Result<Self> {
        let folder = std::env::temp_dir().join(format!("whitted-bench-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // A folder that cannot be removed harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Measure and print; returns the rows as JSON.
///
/// # Errors
/// A scene cannot be made, or a renderer fails.
pub(crate) fn run(options: &Options) -> Result<Value, Box<dyn Error>> {
    let folder = TemporaryFolder::new()?;
    let has_peer_scenes = options.shared.as_deref().map_or(Ok(false), |shared| make_peer_scenes(shared, &folder.0))?;
    if !has_peer_scenes {
        eprintln!("No scenes for other renderers: give --shared DIR or WHITTED_SHARED. Only our own figures follow.");
    }
    let whitted = match &options.whitted {
        Some(path) => path.canonicalize()?,
        None => std::env::current_exe()?.with_file_name("whitted").with_extension(std::env::consts::EXE_EXTENSION),
    };
    let places = Places { scenes: folder.0.clone(), whitted };
    println!("{} · {} · commit {}", machine::date(), machine::cpu(), machine::commit());
    println!(
        "{:<10} {:<12} {:>10} {:>8} {:>10} {:>10} {:>10} {:>10}",
        "scene", "renderer", "trace CPU", "ours is", "rays", "shadow", "reflected", "refracted"
    );
    let mut rows = Vec::new();
    for name in &options.scenes {
        match our_scene(name) {
            Some(text) => std::fs::write(places.scenes.join(format!("{name}.toml")), text)?,
            None => return Err(format!("no scene `{name}`: known are mix-N, all4-N and bunny").into()),
        }
        if name == "bunny" && !has_peer_scenes {
            eprintln!("bunny left out: its mesh comes with the scenes of the other renderers");
            continue;
        }
        rows.extend(measure(name, &places, options.rounds.max(1), has_peer_scenes)?);
    }
    let moving = options.scenes.iter().filter(|name| *name == MOVING);
    for (name, text) in moving.filter_map(|name| Some((name, our_scene(name)?))) {
        rows.extend(frames::run(name, &text)?);
    }
    let rows = Value::Array(rows);
    if let Some(path) = &options.json {
        std::fs::write(path, format!("{rows:#}\n"))?;
    }
    Ok(rows)
}

/// Let the script of the shared folder write the scenes of all renderers; false if there is no such script.
fn make_peer_scenes(shared: &Path, folder: &Path) -> io::Result<bool> {
    let script = shared.join("peers/renderers/make_scenes.py");
    if !script.is_file() {
        return Ok(false);
    }
    let status = Command::new("python3").arg(&script).arg(folder).stdout(Stdio::null()).status()?;
    if status.success() { Ok(true) } else { Err(io::Error::other(format!("{} failed", script.display()))) }
}

/// Render with every renderer that is installed, in turn; a row for each.
fn measure(name: &str, places: &Places, rounds: usize, with_peers: bool) -> Result<Vec<Value>, Box<dyn Error>> {
    let mut contestants: Vec<(Renderer, Vec<Render>)> = Renderer::ALL.map(|renderer| (renderer, Vec::new())).into();
    if !with_peers {
        contestants.truncate(1);
    }
    for _ in 0..rounds {
        let mut missing = Vec::new();
        for (renderer, renders) in &mut contestants {
            match renderer.render(name, places) {
                Ok(render) => renders.push(render),
                Err(error) if error.kind() == io::ErrorKind::NotFound && *renderer != Renderer::Whitted => {
                    eprintln!("{renderer} is not installed");
                    missing.push(*renderer);
                }
                Err(error) => return Err(format!("{renderer}, {name}: {error}").into()),
            }
        }
        contestants.retain(|(renderer, _)| !missing.contains(renderer));
    }
    let ours = contestants[0].1.clone();
    Ok(contestants.iter().map(|(renderer, renders)| row(name, *renderer, renders, &ours)).collect())
}

/// Print one renderer's line and return it as JSON.
fn row(name: &str, renderer: Renderer, renders: &[Render], ours: &[Render]) -> Value {
    let trace = median(renders.iter().map(|render| render.trace).collect());
    let ratio = median(renders.iter().zip(ours).map(|(peer, ours)| peer.trace / ours.trace).collect());
    let rays = renders[0].rays;
    let counts = rays.map(|r| [r.all, r.shadow, r.reflected, r.refracted].map(|n| n.to_string()));
    let [all, shadow, reflected, refracted] = counts.unwrap_or_else(|| std::array::from_fn(|_| "-".into()));
    println!(
        "{name:<10} {renderer:<12} {trace:>8.3} s {ratio:>7.2}x {all:>10} {shadow:>10} {reflected:>10} {refracted:>10}"
    );
    json!({
        "scene": name,
        "renderer": renderer.to_string(),
        "trace_cpu_seconds": trace,
        "ours_is_faster_by": ratio,
        "rays": rays.map(|r| r.all),
        "shadow": rays.map(|r| r.shadow),
        "reflected": rays.map(|r| r.reflected),
        "refracted": rays.map(|r| r.refracted),
    })
}

/// Our description of a scene; `None` if there is none of this name.
fn our_scene(name: &str) -> Option<String> {
    const SETTINGS: &str = "version = 1\n[render]\nbackground = [0.2, 0.3, 0.5]\n";
    const BUNNY: &str = include_str!("bunny.toml");
    const CUBE: &str = include_str!("cube.toml");
    if name == "bunny" {
        return Some(format!("{SETTINGS}{BUNNY}"));
    }
    let (family, count) = name.split_once('-')?;
    let count: u32 = count.parse().ok()?;
    let generate = format!("[[generate]]\nkind = \"sphere-cube\"\ncount = {count}\nfamily = \"{family}\"\n");
    matches!(family, "mix" | "all4").then(|| format!("{SETTINGS}{CUBE}{generate}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_that_counts_is_known() {
        assert!(SCENES.iter().all(|name| our_scene(name).is_some()));
        assert!(our_scene("mix-7").unwrap().contains("count = 7\nfamily = \"mix\""));
        assert!(["mix", "mix-x", "all5-10"].iter().all(|name| our_scene(name).is_none()));
    }
}
