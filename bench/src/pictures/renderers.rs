//! How each renderer is started, and what its report says.

use serde_json::Value;
use std::fmt;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use wait4::Wait4;

/// A program that renders the paper's scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Renderer {
    /// Ours.
    Whitted,
    /// POV-Ray 3.7 with its BSP tree.
    PovRay,
    /// Tachyon.
    Tachyon,
}

impl fmt::Display for Renderer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Whitted => "whitted",
            Self::PovRay => "POV-Ray BSP",
            Self::Tachyon => "Tachyon",
        })
    }
}

/// What one render took.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Render {
    /// CPU seconds of tracing alone.
    pub trace: f64,
    /// Rays, where the renderer counts them.
    pub rays: Option<RayCounts>,
}

/// How many rays of each sort.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RayCounts {
    /// Camera, reflected and refracted rays.
    pub all: u64,
    /// Shadow rays; tests of a point against a light.
    pub shadow: u64,
    /// Reflected ones among all.
    pub reflected: u64,
    /// Refracted ones among all.
    pub refracted: u64,
}

/// Where things are.
pub(super) struct Places {
    /// Folder with a scene NAME in each renderer's format.
    pub scenes: PathBuf,
    /// Our command.
    pub whitted: PathBuf,
}

impl Renderer {
    /// Every renderer, ours first.
    pub(super) const ALL: [Self; 3] = [Self::Whitted, Self::PovRay, Self::Tachyon];

    /// Render a scene once, in one thread: 640 × 480, camera rays and five generations, cut-off 1/255, one sample a
    /// pixel.
    ///
    /// # Errors
    /// The program cannot be started, fails, or reports no time.
    pub(super) fn render(self, name: &str, places: &Places) -> io::Result<Render> {
        let (text, cpu) = run(&mut self.command(name, places), &places.scenes)?;
        let report = match self {
            Self::Whitted => ours(&text),
            Self::PovRay => pov_ray(&text),
            Self::Tachyon => tachyon(&text, cpu),
        };
        report.ok_or_else(|| {
            io::Error::new(io::ErrorKind::InvalidData, format!("no report of times from {self}:\n{text}"))
        })
    }

    /// The command that renders a scene.
    fn command(self, name: &str, places: &Places) -> Command {
        let mut command = Command::new(match self {
            Self::Whitted => places.whitted.as_os_str(),
            Self::PovRay => "povray".as_ref(),
            Self::Tachyon => "tachyon".as_ref(),
        });
        command.args(match self {
            Self::Whitted => format!(
                "render {name}.toml --size 640x480 --depth 5 --aa off --shadows opaque --threads 1 --quiet --stats json \
                -o whitted.png"
            ),
            Self::PovRay => format!("+I{name}.pov +W640 +H480 -D -P +Opov.png +WT1 -A +BM2"),
            // Its depth counts the camera ray.
            Self::Tachyon => format!("{name}.dat +V -numthreads 1 -raydepth 6 -format PPM -o tachyon.ppm"),
        }.split_whitespace());
        command
    }
}

/// Run a command in a folder; what it said on both streams, and its CPU seconds.
fn run(command: &mut Command, folder: &Path) -> io::Result<(String, f64)> {
    let path = folder.join("output.txt");
    let file = File::create(&path)?;
    command.current_dir(folder).stdin(Stdio::null()).stdout(file.try_clone()?).stderr(file);
    let used = command.spawn()?.wait4()?;
    let text = String::from_utf8_lossy(&std::fs::read(&path)?).into_owned();
    match used.status.success() {
        true => Ok((text, (used.rusage.utime + used.rusage.stime).as_secs_f64())),
        false => Err(io::Error::other(format!("{command:?} failed: {text}"))),
    }
}

/// Tracing's share of the CPU time of the process, by the wall-clock times that it reports for its phases.
fn share(cpu: f64, trace: f64, others: &[f64]) -> f64 {
    cpu * trace / (trace + others.iter().sum::<f64>())
}

/// Our statistics are JSON, with the CPU seconds of each phase.
fn ours(text: &str) -> Option<Render> {
    let report: Value = serde_json::from_str(&text[text.find('{')?..]).ok()?;
    let rays = |sort: &str| report["rays"][sort].as_u64();
    let (reflected, refracted) = (rays("reflected")?, rays("refracted")?);
    let all = rays("camera")? + reflected + refracted;
    let rays = Some(RayCounts { all, shadow: rays("shadow")?, reflected, refracted });
    Some(Render { trace: report["cpu_seconds"]["trace"].as_f64()?, rays })
}

/// POV-Ray gives the CPU seconds of tracing itself.
fn pov_ray(text: &str) -> Option<Render> {
    let render = &text[text.rfind("Trace Time:")?..];
    let before = render[..render.find("CPU-seconds total")?].trim_end();
    let trace = before.rsplit(' ').next()?.parse().ok()?;
    let count = |label: &str| text[text.find(label)? + label.len()..].split_whitespace().next()?.parse().ok();
    // The lines of sorts of rays that did not occur are left out.
    let rays = count("Rays:").map(|all| RayCounts {
        all,
        shadow: count("Shadow Ray Tests:").unwrap_or(0),
        reflected: count("Reflected Rays:").unwrap_or(0),
        refracted: count("Refracted Rays:").unwrap_or(0),
    });
    Some(Render { trace, rays })
}

/// Tachyon gives wall-clock times, and counts no rays.
fn tachyon(text: &str, cpu: f64) -> Option<Render> {
    let seconds = |label: &str| -> Option<f64> {
        text[text.find(label)? + label.len()..].split_whitespace().next()?.parse().ok()
    };
    let others = [seconds("Scene Parsing Time:")?, seconds("Preprocessing Time:")?, seconds("Image I/O Time:")?];
    Some(Render { trace: share(cpu, seconds("Ray Tracing Time:")?, &others), rays: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_are_read() {
        let pov = "Rays:  823806   Saved: 5\nShadow Ray Tests:   803262  Succeeded:  9\nReflected Rays:  291449\n\
            Bounding Time: 0 (0.009 seconds)\n using 1 thread(s) with 0.005 CPU-seconds total\n\
            Trace Time:  0 (2.016 seconds)\n   using 1 thread(s) with 0.756 CPU-seconds total\n";
        let render = pov_ray(pov).unwrap();
        assert_eq!(render.trace, 0.756);
        assert_eq!(render.rays, Some(RayCounts { all: 823_806, shadow: 803_262, reflected: 291_449, refracted: 0 }));

        let ours_text = r#"{ "rays": { "camera": 3, "shadow": 4, "reflected": 2, "refracted": 1 },
            "cpu_seconds": { "load": 0.1, "build": 0.1, "trace": 0.6, "write": 0.2 } }"#;
        let render = ours(ours_text).unwrap();
        assert_eq!(render.trace, 0.6);
        assert_eq!(render.rays.unwrap().all, 6);

        let tachyon_text = "Scene Parsing Time:     0.25 seconds\nPreprocessing Time: 0.25 seconds\n\
            Ray Tracing Time:     1.0 seconds\n    Image I/O Time:     0.5 seconds\n";
        assert_eq!(tachyon(tachyon_text, 1.0).unwrap().trace, 0.5);
        assert!(tachyon("error", 1.0).is_none() && pov_ray("").is_none() && ours("").is_none());
    }
}
