//! The command line: every option, and the reading of its value. What the options mean for a render is in `render.rs`.

mod paper;

pub(crate) use self::paper::PaperArguments;
use clap::{Args, Parser, Subcommand, ValueEnum};
use formats::rays::{HitFormat, RayFormat};
use std::path::PathBuf;
use std::str::FromStr;
use whitted::classic::{Split, TriangleTest, Walk};
use whitted::render::{Aov, Method, Region};
use whitted::scene::{Antialias, Sampling, Shadows};
use whitted::tree::{TreeKind, WalkKind};

/// Exit codes, shown below the help.
const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 a file could not be read or written or the render failed, 2 wrong usage, 3 error in the scene or the rays, \
130 interrupted.";

/// The columns of rays and hits, shown below the help of `trace`.
const TABLES: &str = "\
Rays: a CSV file names its columns in the first line: ox,oy,oz,dx,dy,dz and, if wanted, t_min,t_max, in any order. A \
NumPy array has the shape (n, 6) or (n, 8). Raw rays are six (.f32) or eight (.f32x8) little-endian numbers each.

Hits: t,primitive,u,v,nx,ny,nz, a line for each ray, in order; t in lengths of the ray's direction, primitives counted \
from 0, the geometric normal of length 1. A miss has t = inf and no primitive (-1 in a NumPy or raw file, whose records \
are f32 t, i32 primitive, f32 u, v, nx, ny, nz).

Exit codes: 0 done, 1 a file could not be read or written, 2 wrong usage, 3 error in the scene or the rays, \
130 interrupted.";

/// Ray tracer in the manner of Whitted: exact, deterministic, on the CPU.
#[derive(Debug, Parser)]
#[command(name = "whitted", version, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a picture
    #[command(after_help = EXIT_CODES)]
    Render(Box<RenderArguments>),
    /// Read a scene, report what is wrong with it, and render nothing
    #[command(after_help = EXIT_CODES)]
    Check(CheckArguments),
    /// Tell why a pixel looks as it does: every ray of its samples
    #[command(after_help = EXIT_CODES)]
    Explain(Box<ExplainArguments>),
    /// Find what each ray of a table hits first
    #[command(after_help = TABLES)]
    Trace(TraceArguments),
    /// Repeat the experiments of the paper that Whitted follows, and report them beside the paper's numbers
    #[command(after_help = paper::HELP)]
    Paper(PaperArguments),
    /// Look around in a scene, interactively, while its file is edited
    #[command(after_help = EXIT_CODES)]
    View(Box<ViewArguments>),
}

#[derive(Clone, Debug, Args)]
pub(crate) struct ViewArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Pictures a second that are kept up while things move
    #[arg(long, value_name = "N", default_value = "30", value_parser = parse_rate)]
    pub(crate) fps_target: f64,
    /// Open no window; do what the lines of this file say (docs/viewer.md)
    #[arg(long, value_name = "FILE")]
    pub(crate) script: Option<PathBuf>,
    /// Open no window; save what it would show when the picture is finished (.png)
    #[arg(long, value_name = "FILE")]
    pub(crate) screenshot: Option<PathBuf>,
    /// Threads [default: one per core]
    #[arg(short, long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Splits that the tree may use; fast is built sooner and walked slower [default: best]
    #[arg(long, value_name = "best|fast|kd|none", value_parser = parse_named(&TREES))]
    pub(crate) tree: Option<TreeKind>,
    #[command(flatten)]
    pub(crate) picture: PictureArguments,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Column and row of the pixel, counted from 0 at the top left
    #[arg(value_name = "X,Y", value_parser = parse_pixel)]
    pub(crate) pixel: [u32; 2],
    /// Tell of all samples of the pixel [default: of the one in its middle]
    #[arg(long)]
    pub(crate) all_samples: bool,
    /// Write JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) verbosity: Verbosity,
    #[command(flatten)]
    pub(crate) picture: PictureArguments,
}

#[derive(Debug, Args)]
pub(crate) struct TraceArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Rays (.csv, .npy, .f32, .f32x8), or - for standard input
    pub(crate) rays: PathBuf,
    /// Hits to write (.csv, .npy, .f32), or - for standard output [default: -]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// How the rays are written down [default: as their name says; csv for standard input]
    #[arg(long, value_name = "csv|npy|f32|f32x8", value_parser = parse_named(&RayFormat::ALL))]
    pub(crate) rays_format: Option<RayFormat>,
    /// How to write the hits down [default: as their name says; as the rays for standard output]
    #[arg(long, value_name = "csv|npy|f32", value_parser = parse_named(&HitFormat::ALL))]
    pub(crate) hits_format: Option<HitFormat>,
    /// Threads [default: one per core]
    #[arg(short, long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Splits that the tree may use; never changes a hit [default: best]
    #[arg(long, value_name = "best|fast|kd|none", value_parser = parse_named(&TREES))]
    pub(crate) tree: Option<TreeKind>,
    #[command(flatten)]
    pub(crate) verbosity: Verbosity,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    #[command(flatten)]
    pub(crate) verbosity: Verbosity,
}

#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArguments {
    /// Scene (.toml, .json, .nff) or bare mesh (.obj, .ply)
    pub(crate) scene: PathBuf,
    /// Let the scene open files outside its own folder
    #[arg(long, display_order = 100)]
    pub(crate) allow_outside: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Verbosity {
    /// Show errors only
    #[arg(short, long, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Show what was loaded and how it is rendered
    #[arg(short, long)]
    pub(crate) verbose: bool,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Picture to write: .png, .exr with linear colours, or - for a PNG on standard output [default: the scene's name with
    /// .png, in this folder]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Write these pictures too, beside the other as NAME.png: masks of importance and supersampling, heat maps of nodes,
    /// tests and time
    #[arg(long, value_name = "NAME[,NAME]", value_delimiter = ',', value_parser = parse_named(&Aov::ALL))]
    pub(crate) aov: Vec<Aov>,
    /// Report statistics when done, on standard output or into a file
    #[arg(long, value_name = "text|json[=FILE]", value_parser = parse_stats)]
    pub(crate) stats: Option<Stats>,
    #[command(flatten)]
    pub(crate) verbosity: Verbosity,
    #[command(flatten)]
    pub(crate) picture: PictureArguments,
    #[command(flatten)]
    pub(crate) execution: ExecutionArguments,
}

/// Options that change the picture; each left out keeps what the scene says.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureArguments {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Render this rectangle of the picture only, as a picture of its own size
    #[arg(long, value_name = "X,Y,WxH", value_parser = parse_crop)]
    pub(crate) crop: Option<Crop>,
    /// Camera of the scene, by name
    #[arg(long, value_name = "NAME")]
    pub(crate) camera: Option<String>,
    /// Generations of reflected and refracted rays; 0 for camera rays only
    #[arg(long, value_name = "N")]
    pub(crate) depth: Option<u32>,
    /// Do not trace a ray that can contribute less than this; 0 for no limit
    #[arg(long, value_name = "W", value_parser = parse_weight)]
    pub(crate) min_weight: Option<f32>,
    /// Supersampling: none, the paper's rule, every edge, or N samples in each pixel
    #[arg(long, value_name = "off|paper|edge|N", value_parser = parse_antialias)]
    pub(crate) aa: Option<Antialias>,
    /// Samples of a supersampled pixel
    #[arg(long, value_name = "N")]
    pub(crate) aa_max: Option<u32>,
    /// Where in a pixel its first sample lies
    #[arg(long, value_name = "centers|corners", value_parser = parse_named(&SAMPLINGS))]
    pub(crate) sampling: Option<Sampling>,
    /// Shadows of transparent things: coloured by them, or black
    #[arg(long, value_name = "filter|opaque", value_parser = parse_named(&SHADOWS))]
    pub(crate) shadows: Option<Shadows>,
}

/// Options that change how the picture is computed, never the picture.
#[derive(Debug, Args)]
#[command(next_help_heading = "Execution (never changes the picture)")]
pub(crate) struct ExecutionArguments {
    /// Threads [default: one per core]
    #[arg(short, long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Size of the regions that are rendered one after another [default: 64]
    #[arg(long, value_name = "N|WxH|scanline|frame", value_parser = parse_region)]
    pub(crate) region: Option<Region>,
    /// Splits that the tree may use; or, with --render recursive, the paper's kd-tree of 8-byte nodes (by surface areas,
    /// or by medians) or a uniform grid [default: best]
    #[arg(long, value_name = "best|fast|kd|none|kd8|median|grid", value_parser = parse_named(&RENDER_TREES))]
    pub(crate) tree: Option<TreeChoice>,
    /// How rays go through the tree; sequential and stack are for kd8 and median [default: auto; stack]
    #[arg(long, value_name = "auto|stream|single|sequential|stack", value_parser = parse_named(&WALKS))]
    pub(crate) walk: Option<WalkChoice>,
    /// Instruction set: scalar, sse4.2, avx2, avx512 [default: the widest this CPU has]
    #[arg(long, value_name = "LEVEL", value_parser = parse_level)]
    pub(crate) simd: Option<simd::Level>,
    /// Batches of rays by generation, or one ray after the other [default: wavefront]
    #[arg(long, value_name = "wavefront|recursive", value_parser = parse_named(&METHODS))]
    pub(crate) render: Option<Method>,
    /// Arithmetic of the paper's tests, with --render recursive and --tree kd8, median, grid or none: one component at a
    /// time, four at once, or four with estimated square roots [default: scalar]
    #[arg(long, value_name = "scalar|sse|rsqrt", value_parser = parse_named(&MATHS))]
    pub(crate) math: Option<MathChoice>,
    /// Test of triangles: watertight, or the paper's, which may differ at edges and is for the same trees as --math
    /// [default: watertight]
    #[arg(long, value_name = "watertight|projection", value_parser = parse_named(&TRIANGLES), help_heading = "Picture")]
    pub(crate) triangle: Option<TriangleTest>,
}

/// What rays are walked through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TreeChoice {
    /// The production tree.
    Wide(TreeKind),
    /// The paper's kd-tree.
    Kd8(Split),
    Grid,
}

/// How they are walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WalkChoice {
    /// Through the production tree.
    Wide(WalkKind),
    /// Through the paper's kd-tree.
    Kd8(Walk),
}

/// Arithmetic of the paper's tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MathChoice {
    Scalar,
    Sse,
    Rsqrt,
}

/// A rectangle of the picture in pixels from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Crop {
    pub(crate) x: u32,
    pub(crate) y: u32,
    pub(crate) size: [u32; 2],
}

/// Where and in which form statistics go.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stats {
    pub(crate) format: StatsFormat,
    pub(crate) file: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StatsFormat {
    Text,
    Json,
}

/// More pixels in a row or column than anyone wants; the library limits their product.
const MAX_SIDE: u32 = 65_535;

/// Far above any machine; keeps a typing error from starting a million threads.
const MAX_THREADS: usize = 4096;

const SAMPLINGS: [(&str, Sampling); 2] = [("centers", Sampling::Centers), ("corners", Sampling::Corners)];
const SHADOWS: [(&str, Shadows); 2] = [("filter", Shadows::Filter), ("opaque", Shadows::Opaque)];
const TREES: [(&str, TreeKind); 4] =
    [("best", TreeKind::Best), ("fast", TreeKind::Fast), ("kd", TreeKind::Kd), ("none", TreeKind::None)];
const RENDER_TREES: [(&str, TreeChoice); 7] = [
    ("best", TreeChoice::Wide(TreeKind::Best)),
    ("fast", TreeChoice::Wide(TreeKind::Fast)),
    ("kd", TreeChoice::Wide(TreeKind::Kd)),
    ("none", TreeChoice::Wide(TreeKind::None)),
    ("kd8", TreeChoice::Kd8(Split::Sah)),
    ("median", TreeChoice::Kd8(Split::Median)),
    ("grid", TreeChoice::Grid),
];
const WALKS: [(&str, WalkChoice); 5] = [
    ("auto", WalkChoice::Wide(WalkKind::Auto)),
    ("stream", WalkChoice::Wide(WalkKind::Stream)),
    ("single", WalkChoice::Wide(WalkKind::Single)),
    ("sequential", WalkChoice::Kd8(Walk::Sequential)),
    ("stack", WalkChoice::Kd8(Walk::Stack)),
];
const MATHS: [(&str, MathChoice); 3] =
    [("scalar", MathChoice::Scalar), ("sse", MathChoice::Sse), ("rsqrt", MathChoice::Rsqrt)];
const TRIANGLES: [(&str, TriangleTest); 2] =
    [("watertight", TriangleTest::Watertight), ("projection", TriangleTest::Projection)];
const METHODS: [(&str, Method); 2] = [("wavefront", Method::Wavefront), ("recursive", Method::Recursive)];

/// A parser for a closed list of names.
fn parse_named<T: Copy + Send + Sync>(
    names: &'static [(&'static str, T)],
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let found = names.iter().find(|(name, _)| *name == text);
        found.map(|(_, value)| *value).ok_or_else(|| format!("expected {}", list(names.iter().map(|(name, _)| *name))))
    }
}

/// `a, b or c`.
fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => names.concat(),
    }
}

fn number<T: FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("'{text}' is not a whole number in range"))
}

fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=MAX_THREADS) => Ok(threads),
        _ => Err(format!("expected a number from 1 to {MAX_THREADS}")),
    }
}

fn parse_rate(text: &str) -> Result<f64, String> {
    const RATES: std::ops::RangeInclusive<f64> = 1.0..=1000.0;
    text.parse().ok().filter(|rate| RATES.contains(rate)).ok_or_else(|| "expected a number from 1 to 1000".to_owned())
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once('x').ok_or("expected WIDTHxHEIGHT, such as 640x480")?;
    let size = [number(width)?, number(height)?];
    if size.iter().any(|side| !(1..=MAX_SIDE).contains(side)) {
        return Err(format!("each side must lie between 1 and {MAX_SIDE}"));
    }
    Ok(size)
}

fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let (x, y) = text.split_once(',').ok_or("expected X,Y, such as 320,240")?;
    Ok([number(x)?, number(y)?])
}

fn parse_crop(text: &str) -> Result<Crop, String> {
    match text.split(',').collect::<Vec<_>>()[..] {
        [x, y, size] => Ok(Crop { x: number(x)?, y: number(y)?, size: parse_size(size)? }),
        _ => Err("expected X,Y,WIDTHxHEIGHT, such as 100,50,64x64".to_owned()),
    }
}

fn parse_weight(text: &str) -> Result<f32, String> {
    let weight: f32 = text.parse().map_err(|_| format!("'{text}' is not a number"))?;
    if (0.0..=1.0).contains(&weight) { Ok(weight) } else { Err("expected a number from 0 to 1".to_owned()) }
}

fn parse_antialias(text: &str) -> Result<Antialias, String> {
    match text {
        "off" => Ok(Antialias::Off),
        "paper" => Ok(Antialias::Paper),
        "edge" => Ok(Antialias::Edge),
        _ => match text.parse() {
            Ok(samples) => Ok(Antialias::Uniform(samples)),
            Err(_) => Err("expected off, paper, edge or a number of samples".to_owned()),
        },
    }
}

fn parse_region(text: &str) -> Result<Region, String> {
    match text {
        "scanline" => Ok(Region::Scanline),
        "frame" => Ok(Region::Frame),
        _ if text.contains('x') => parse_size(text).map(|[width, height]| Region::Rectangle(width, height)),
        _ => match text.parse() {
            Ok(side @ 1..=MAX_SIDE) => Ok(Region::Rectangle(side, side)),
            _ => Err("expected a number of pixels, WIDTHxHEIGHT, scanline or frame".to_owned()),
        },
    }
}

fn parse_level(text: &str) -> Result<simd::Level, String> {
    simd::Level::by_name(text).ok_or_else(|| {
        let available = simd::Level::available();
        format!("this CPU has {}", list(available.iter().map(|level| level.name())))
    })
}

fn parse_stats(text: &str) -> Result<Stats, String> {
    let (format, file) = text.split_once('=').map_or((text, None), |(format, file)| (format, Some(file)));
    let format = StatsFormat::from_str(format, false).map_err(|_| "expected text or json".to_owned())?;
    match file {
        Some("") => Err("a file name must follow '='".to_owned()),
        // `-` is standard output, as for --output.
        file => Ok(Stats { format, file: file.filter(|&name| name != "-").map(PathBuf::from) }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn sizes_and_crops() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        for bad in ["", "640", "640x", "0x1", "1x0", "70000x1", "-1x2", "1x2x3", "1.5x2"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_crop("1,2,3x4"), Ok(Crop { x: 1, y: 2, size: [3, 4] }));
        assert!(parse_crop("1,2,3,4").is_err() && parse_crop("-1,2,3x4").is_err());
    }

    #[test]
    fn pixels_are_two_numbers() {
        assert_eq!(parse_pixel("3,4"), Ok([3, 4]));
        for bad in ["", "3", "3x4", "-1,2", "1,2,3"] {
            assert!(parse_pixel(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn weights_reject_what_is_no_fraction() {
        assert_eq!(parse_weight("0"), Ok(0.0));
        for bad in ["-0.1", "1.1", "nan", "inf", "x"] {
            assert!(parse_weight(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn antialias_and_regions() {
        assert_eq!(parse_antialias("paper"), Ok(Antialias::Paper));
        assert_eq!(parse_antialias("16"), Ok(Antialias::Uniform(16)));
        assert!(parse_antialias("-1").is_err() && parse_antialias("best").is_err());
        assert_eq!(parse_region("32"), Ok(Region::Rectangle(32, 32)));
        assert_eq!(parse_region("32x8"), Ok(Region::Rectangle(32, 8)));
        assert_eq!(parse_region("frame"), Ok(Region::Frame));
        assert!(parse_region("0").is_err());
    }

    #[test]
    fn levels_name_what_there_is() {
        assert_eq!(parse_level("scalar").map(simd::Level::name), Ok("scalar"));
        assert!(parse_level("mmx").unwrap_err().contains("scalar"));
    }

    #[test]
    fn stats_may_name_a_file() {
        let json = |file: Option<&str>| Ok(Stats { format: StatsFormat::Json, file: file.map(PathBuf::from) });
        assert_eq!(parse_stats("json"), json(None));
        assert_eq!(parse_stats("json=a=b.json"), json(Some("a=b.json")));
        assert_eq!(parse_stats("json=-"), json(None));
        assert!(parse_stats("json=").is_err() && parse_stats("xml").is_err());
    }
}
