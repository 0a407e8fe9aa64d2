//! `whitted render`: check, load, build, trace, write, report.

use crate::args::{RenderArguments, Stats};
use crate::check::contents;
use crate::exit::Failure;
use crate::interrupt::{self, stop_if};
use crate::load::load;
use crate::output::Target;
use crate::picture::PictureFormat;
use crate::progress::Display;
use crate::report::{Report, Spent};
use crate::stopwatch::Stopwatch;
use crate::variant::Built;
use cpu_time::ProcessTime;
use std::path::{Path, PathBuf};
use std::time::Instant;
use whitted::render::{
    Aov, AovPicture, Cancel, Classic, Execution, Frame, Method, PixelRect, aovs, aovs_classic, render_classic,
    render_rect,
};
use whitted::scene::{Prepared, Scene};
use whitted::tree::BuildOptions;
use whitted::tree::policy::{self, Origins, RaySort};

pub(crate) fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    arguments.picture.check()?;
    let variant = arguments.execution.variant()?;
    let outputs = Outputs::check(arguments)?;
    let pool = arguments.execution.pool()?;
    let cancel = interrupt::install();
    let mut report = Report::default();

    let scene = timed(&mut report.load, || scene(arguments))?;
    let rectangle = arguments.picture.rectangle(scene.settings.size)?;
    stop_if(cancel)?;
    let prepared = timed(&mut report.build, || pool.install(|| build(&scene, arguments, cancel)))?;
    let classic = timed(&mut report.build, || {
        variant.map(|variant| pool.install(|| variant.build(prepared.geometry().primitives())))
    });
    stop_if(cancel)?;
    tell_details(arguments, &scene, &prepared, pool.current_num_threads());
    if classic.is_none() && arguments.verbosity.verbose {
        tell_walks(&prepared, &arguments.execution.execution());
    }
    let watch = Stopwatch::default();
    let job = Job { prepared: &prepared, classic: classic.as_ref(), rectangle, scene: &scene, arguments };
    let frame = timed(&mut report.trace, || pool.install(|| job.trace(cancel, &watch)))?;
    report.shares = watch.shares();
    report.statistics = frame.statistics;
    report.tree = classic.as_ref().map_or(prepared.geometry().tree().report(), Built::report);
    let aovs = timed(&mut report.aov, || pool.install(|| job.other_pictures(&frame, cancel)))?;
    timed(&mut report.write, || {
        outputs.write_picture(&frame, &scene, cancel)?;
        outputs.write_aovs(&aovs, arguments.verbosity.quiet)
    })?;
    tell_summary(arguments, &outputs.picture, rectangle, &report);
    outputs.write_stats(&report)
}

/// Where everything goes, checked.
struct Outputs {
    picture: Target,
    format: PictureFormat,
    /// In the order of the arguments.
    aovs: Vec<Target>,
    stats: Option<(Stats, Target)>,
}

impl Outputs {
    fn check(arguments: &RenderArguments) -> Result<Self, Failure> {
        let path = arguments.output.clone().unwrap_or_else(|| default_output(arguments));
        let format = PictureFormat::of(&path)?;
        let picture = Target::check(&path)?;
        let aovs = aov_targets(&arguments.aov, &path)?;
        let stats = arguments.stats.clone().map(|stats| {
            let target = Target::check(&stats.file.clone().unwrap_or_else(|| PathBuf::from("-")))?;
            if let Some(same) = aovs.iter().chain([&picture]).find(|other| target.is_same_as(other)) {
                let text = format!("the picture and the statistics cannot both go to the same file, {same}");
                return Err(Failure::Usage(text));
            }
            Ok((stats, target))
        });
        Ok(Self { picture, format, aovs, stats: stats.transpose()? })
    }

    fn write_picture(&self, frame: &Frame, scene: &Scene, cancel: &Cancel) -> Result<(), Failure> {
        let file = self.format.encode(&frame.image, || frame.image.to_rgb8(&scene.settings))?;
        stop_if(cancel)?;
        self.picture.write(&file)
    }

    fn write_aovs(&self, pictures: &[AovPicture], quiet: bool) -> Result<(), Failure> {
        for (picture, target) in pictures.iter().zip(&self.aovs) {
            let description = picture.to_string();
            let png = formats::png::encode_described(picture.width, picture.height, &picture.rgb8, &description);
            target.write(&png.map_err(|error| Failure::Io(error.to_string()))?)?;
            if !quiet {
                eprintln!("wrote {target}: {description}");
            }
        }
        Ok(())
    }

    fn write_stats(&self, report: &Report) -> Result<(), Failure> {
        let Some((stats, target)) = &self.stats else { return Ok(()) };
        target.write(report.render(stats.format).as_bytes())
    }
}

/// The scene's name with `.png`, in the current folder.
fn default_output(arguments: &RenderArguments) -> PathBuf {
    PathBuf::from(arguments.scene.scene.file_name().unwrap_or_default()).with_extension("png")
}

/// Where the other pictures go: `a.depth.png` beside `a.png`.
fn aov_targets(aovs: &[Aov], picture: &Path) -> Result<Vec<Target>, Failure> {
    if !aovs.is_empty() && picture.as_os_str() == "-" {
        let text = "--aov writes its pictures beside the other, which must be a file and not standard output";
        return Err(Failure::Usage(text.to_owned()));
    }
    aovs.iter().map(|aov| Target::check(&picture.with_extension(format!("{}.png", aov.name())))).collect()
}

fn scene(arguments: &RenderArguments) -> Result<Scene, Failure> {
    let mut scene = load(&arguments.scene, &arguments.verbosity)?.scene;
    arguments.picture.choose_camera(&mut scene)?;
    scene.settings = arguments.picture.over(scene.settings);
    Ok(scene)
}

fn build(scene: &Scene, arguments: &RenderArguments, cancel: &Cancel) -> Result<Prepared, Failure> {
    let options = BuildOptions { kind: arguments.execution.tree_kind(), ..BuildOptions::default() };
    let display = Display::new(arguments.verbosity.quiet);
    let prepared = Prepared::new_until(scene, &options, &|share| {
        display.built(share);
        cancel.is_cancelled()
    });
    display.finish();
    let prepared = prepared.map_err(|e| Failure::Scene(format!("{}: {e}", arguments.scene.scene.display())))?;
    prepared.ok_or(Failure::Interrupted)
}

/// What is to be rendered, and how.
struct Job<'a> {
    prepared: &'a Prepared,
    classic: Option<&'a Built>,
    rectangle: PixelRect,
    scene: &'a Scene,
    arguments: &'a RenderArguments,
}

impl Job<'_> {
    fn trace(&self, cancel: &Cancel, watch: &Stopwatch) -> Result<Frame, Failure> {
        let Self { prepared, classic, ref rectangle, scene, arguments } = *self;
        let display = Display::new(arguments.verbosity.quiet);
        let settings = &scene.settings;
        let execution = Execution { first_samples: !arguments.aov.is_empty(), ..arguments.execution.execution() };
        let frame = match classic {
            None => render_rect(prepared, settings, &execution, rectangle, &display, cancel, watch),
            Some(built) => {
                let caster = built.caster(prepared.geometry().primitives());
                render_classic(&Classic { prepared, caster }, settings, &execution, rectangle, &display, cancel, watch)
            }
        };
        display.finish();
        frame.map_err(|_cancelled| Failure::Interrupted)
    }

    fn other_pictures(&self, frame: &Frame, cancel: &Cancel) -> Result<Vec<AovPicture>, Failure> {
        let Self { prepared, classic, scene, arguments, .. } = *self;
        let start = Instant::now();
        // 2⁶⁴ ns are five centuries.
        let clock = || start.elapsed().as_nanos() as u64;
        let (wanted, settings, execution) = (&arguments.aov[..], &scene.settings, arguments.execution.execution());
        let pictures = match classic {
            None => aovs(wanted, frame, prepared, settings, &execution, &clock, cancel),
            Some(built) => {
                let classic = Classic { prepared, caster: built.caster(prepared.geometry().primitives()) };
                aovs_classic(wanted, frame, &classic, settings, &execution, &clock, cancel)
            }
        };
        pictures.map_err(|_cancelled| Failure::Interrupted)
    }
}

fn timed<T>(spent: &mut Spent, work: impl FnOnce() -> T) -> T {
    let (start, cpu) = (Instant::now(), ProcessTime::try_now());
    let result = work();
    spent.wall += start.elapsed();
    spent.cpu += cpu.and_then(|cpu| cpu.try_elapsed()).unwrap_or_default();
    result
}

fn tell_details(arguments: &RenderArguments, scene: &Scene, prepared: &Prepared, threads: usize) {
    if !arguments.verbosity.verbose {
        return;
    }
    let level = arguments.execution.execution().level.name();
    eprintln!("{}: {}", arguments.scene.scene.display(), contents(scene));
    eprintln!("{threads} threads, {level}");
    if prepared.geometry().dropped() > 0 {
        eprintln!("{} degenerate primitives can never be hit", prepared.geometry().dropped());
    }
}

/// Say how each sort of rays goes through the tree, and why.
fn tell_walks(prepared: &Prepared, execution: &Execution) {
    const SORTS: [(&str, Origins); 2] =
        [("rays from the camera and to lights", Origins::Shared), ("reflected and refracted rays", Origins::Own)];
    let count = match execution.method {
        Method::Wavefront => usize::MAX,
        Method::Recursive => 1,
    };
    let geometry = prepared.geometry();
    for (rays, origins) in SORTS {
        let sort = RaySort { count, origins };
        eprintln!("{rays}: {}", policy::choose(execution.walk, geometry.tree(), geometry.primitives(), &sort));
    }
}

fn tell_summary(arguments: &RenderArguments, picture: &Target, rectangle: PixelRect, report: &Report) {
    if arguments.verbosity.quiet {
        return;
    }
    let PixelRect { width, height, .. } = rectangle;
    let seconds = |spent: &Spent| spent.wall.as_secs_f64();
    let [load, build, trace, write] = [&report.load, &report.build, &report.trace, &report.write].map(seconds);
    let total = load + build + trace + write + seconds(&report.aov);
    eprintln!(
        "wrote {picture}, {width}x{height}, in {total:.2} s (load {load:.2}, build {build:.2}, trace {trace:.2}, write {write:.2})"
    );
}
