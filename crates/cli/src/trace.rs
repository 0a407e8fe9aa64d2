//! `whitted trace`: rays in, first hits out, piece by piece.

use crate::args::TraceArguments;
use crate::exit::Failure;
use crate::interrupt::{self, stop_if};
use crate::load::{blame, load_shapes};
use crate::output::{Sink, Target};
use crate::progress::{Display, Done};
use crate::report::peak_memory_bytes;
use formats::rays::{HitFormat, RayFormat, RayReader};
use std::fs::File;
use std::io::{self, BufRead, BufReader, IsTerminal, Read};
use std::path::{Path, PathBuf};
use std::time::Instant;
use whitted::math::Vec3;
use whitted::query::RayScene;
use whitted::ray::{HitBatch, RayBatch};
use whitted::render::Cancel;
use whitted::scene::Space;
use whitted::tree::BuildOptions;
use whitted::tree::policy::{Origins, RaySort};

/// Rays that are read, traced and written at a time: the more there are, the more neighbours has each that is put in order,
/// and the longer does a pipe wait for its first hits.
const PIECE: usize = 1 << 18;

pub(crate) fn run(arguments: &TraceArguments) -> Result<(), Failure> {
    let start = Instant::now();
    let formats = Formats::choose(arguments)?;
    let target = Target::check(arguments.output.as_deref().unwrap_or(Path::new("-")))?;
    refuse_terminal(&target, formats.hits)?;
    let mut rays = open(arguments, formats.rays)?;
    let announced = announced(&rays, &target, formats.hits)?;
    let pool = crate::settings::pool(arguments.threads)?;
    let cancel = interrupt::install();

    let traced = pool.install(|| {
        let shapes = Shapes::prepare(arguments)?;
        stop_if(cancel)?;
        let mut sink = target.open()?;
        sink.write(&formats.hits.head(announced.unwrap_or(0)))?;
        let display = Display::new(arguments.verbosity.quiet);
        let traced = trace(&shapes, &mut rays, formats.hits, &mut sink, &display, cancel);
        display.finish();
        let traced = traced?;
        if formats.hits.announces_count() && announced.is_none() {
            sink.rewrite_start(&formats.hits.head(traced.rays))?;
        }
        stop_if(cancel)?;
        sink.finish().map(|()| traced)
    })?;
    tell_summary(arguments, &target, &traced, start);
    Ok(())
}

/// How rays and hits are written down.
struct Formats {
    rays: RayFormat,
    hits: HitFormat,
}

impl Formats {
    /// What the options say, or else the names of the files; hits without either are written as the rays are.
    fn choose(arguments: &TraceArguments) -> Result<Self, Failure> {
        let usage = |error: formats::Error| Failure::Usage(error.to_string());
        let is_stream = |path: &Path| path == Path::new("-");
        let rays = match arguments.rays_format {
            Some(format) => format,
            None if is_stream(&arguments.rays) => RayFormat::Csv,
            None => RayFormat::of(&arguments.rays).map_err(usage)?,
        };
        let hits = match (arguments.hits_format, &arguments.output) {
            (Some(format), _) => format,
            (None, Some(path)) if !is_stream(path) => HitFormat::of(path).map_err(usage)?,
            _ => match rays {
                RayFormat::Csv => HitFormat::Csv,
                RayFormat::Npy => HitFormat::Npy,
                RayFormat::F32 | RayFormat::F32x8 => HitFormat::F32,
            },
        };
        Ok(Self { rays, hits })
    }
}

fn refuse_terminal(target: &Target, hits: HitFormat) -> Result<(), Failure> {
    if target.is_stdout() && hits != HitFormat::Csv && io::stdout().is_terminal() {
        let text = "binary hits are not written to a terminal: name a file with --output, or take --hits-format csv";
        return Err(Failure::Usage(text.to_owned()));
    }
    Ok(())
}

/// Rays with what is known about their source.
struct Source {
    reader: RayReader<Box<dyn BufRead + Send>>,
    /// Length of the file, and how far it is read.
    bytes: Option<u64>,
    read: std::sync::Arc<std::sync::atomic::AtomicU64>,
}

fn open(arguments: &TraceArguments, format: RayFormat) -> Result<Source, Failure> {
    let path = &arguments.rays;
    let (input, name, bytes): (Box<dyn Read + Send>, _, _) = if path == Path::new("-") {
        (Box::new(io::stdin()), PathBuf::from("standard input"), None)
    } else {
        let refused = |error| Failure::Io(format!("{}: cannot open the file: {error}", path.display()));
        let file = File::open(path).map_err(refused)?;
        let metadata = file.metadata().map_err(refused)?;
        if metadata.is_dir() {
            return Err(Failure::Io(format!("{}: it is a folder", path.display())));
        }
        (Box::new(file), path.clone(), metadata.is_file().then_some(metadata.len()))
    };
    let read = std::sync::Arc::default();
    let counted = Counted { input, read: std::sync::Arc::clone(&read) };
    let reader = RayReader::new(format, &name, Box::new(BufReader::with_capacity(1 << 18, counted)) as _);
    let reader = reader.map_err(|error| blame(&error))?;
    if !arguments.verbosity.quiet {
        reader.warnings().iter().for_each(|warning| eprintln!("warning: {warning}"));
    }
    Ok(Source { reader, bytes, read })
}

/// Tells how much was read.
struct Counted {
    input: Box<dyn Read + Send>,
    read: std::sync::Arc<std::sync::atomic::AtomicU64>,
}

impl Read for Counted {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let len = self.input.read(bytes)?;
        self.read.fetch_add(len as u64, std::sync::atomic::Ordering::Relaxed);
        Ok(len)
    }
}

/// The number of hits to announce, if it is known; it need not be where the head can be written anew at the end.
fn announced(rays: &Source, target: &Target, hits: HitFormat) -> Result<Option<u64>, Failure> {
    let known = rays.reader.total();
    if hits.announces_count() && known.is_none() && !target.is_file() {
        let text = "a NumPy file begins with the number of hits, which these rays do not tell: name a file with \
                    --output, or take --hits-format csv or f32";
        return Err(Failure::Usage(text.to_owned()));
    }
    Ok(known)
}

/// What is traced, and where it lies.
struct Shapes {
    scene: RayScene,
    space: Space,
}

impl Shapes {
    fn prepare(arguments: &TraceArguments) -> Result<Self, Failure> {
        let scene = load_shapes(&arguments.scene, &arguments.verbosity)?;
        let name = arguments.scene.scene.display();
        let (primitives, space) = scene.primitives().map_err(|error| Failure::Scene(format!("{name}: {error}")))?;
        drop(scene);
        let options = BuildOptions { kind: arguments.tree.unwrap_or_default(), ..BuildOptions::default() };
        let scene = RayScene::from_primitives(primitives, &options);
        if arguments.verbosity.verbose {
            eprintln!("{name}: {} primitives, {} of them degenerate", scene.len(), scene.dropped());
            let sort = RaySort { count: PIECE, origins: Origins::Unknown };
            eprintln!("rays go through the tree {}", scene.choice(&sort));
        }
        Ok(Self { scene, space })
    }

    /// The first hits of rays in world space, and their normals.
    fn closest_hits(&self, rays: &mut RayBatch) -> (HitBatch, [Vec<f32>; 3]) {
        let moved = self.space != Space::IDENTITY;
        if moved {
            self.to_internal(rays);
        }
        let mut hits = self.scene.closest_hit_batch(&*rays);
        let normals = self.scene.normal_batch(&*rays, &hits);
        if moved {
            hits.t.iter_mut().for_each(|t| *t = (f64::from(*t) / self.space.scale()) as f32);
        }
        (hits, normals)
    }

    /// Directions stay as they are: so t is as many times longer as the space is larger.
    fn to_internal(&self, rays: &mut RayBatch) {
        for index in 0..rays.len() {
            let origin = Vec3::new(rays.origin.x[index], rays.origin.y[index], rays.origin.z[index]).to_f64();
            let origin = self.space.point_f32(origin);
            (rays.origin.x[index], rays.origin.y[index], rays.origin.z[index]) = (origin.x, origin.y, origin.z);
            for t in [&mut rays.t_min[index], &mut rays.t_max[index]] {
                *t = (f64::from(*t) * self.space.scale()) as f32;
            }
        }
    }
}

/// What was done.
#[derive(Default)]
struct Traced {
    rays: u64,
    hits: u64,
}

fn trace(
    shapes: &Shapes,
    source: &mut Source,
    format: HitFormat,
    sink: &mut Sink,
    display: &Display,
    cancel: &Cancel,
) -> Result<Traced, Failure> {
    let (mut rays, mut bytes, mut traced) = (RayBatch::new(), Vec::new(), Traced::default());
    loop {
        stop_if(cancel)?;
        source.reader.read(&mut rays, PIECE).map_err(|error| blame(&error))?;
        if rays.is_empty() {
            return Ok(traced);
        }
        let (hits, normals) = shapes.closest_hits(&mut rays);
        bytes.clear();
        format.append(&hits, &normals, &mut bytes);
        sink.write(&bytes)?;
        traced.rays += rays.len() as u64;
        traced.hits += (0..hits.len()).filter(|&index| hits.get(index).is_hit()).count() as u64;
        let read = source.read.load(std::sync::atomic::Ordering::Relaxed);
        display.rays_done(&Done { rays: traced.rays, read, bytes: source.bytes });
    }
}

fn tell_summary(arguments: &TraceArguments, target: &Target, traced: &Traced, start: Instant) {
    if arguments.verbosity.quiet {
        return;
    }
    let Traced { rays, hits } = traced;
    eprintln!("traced {rays} rays, {hits} hit, to {target}, in {:.2} s", start.elapsed().as_secs_f64());
    if let Some(bytes) = peak_memory_bytes().filter(|_| arguments.verbosity.verbose) {
        eprintln!("peak memory {} KiB", bytes / 1024);
    }
}
