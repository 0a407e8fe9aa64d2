//! `build`: how fast trees are built, how large they are and what walking them costs, beside Embree's builds.
//!
//! A rate is primitives per second: of CPU time of the whole process with one thread, and of the wall clock with one
//! and two. All builders run in turn, and the median of rounds counts. The speed-up of two threads is that of the wall
//! clock if other programs left the cores alone; else it is printed as a bound (`≤`), by CPU time. Embree's bytes are
//! what its allocator holds for the scene, without the caller's arrays handed to it. Tests and steps are those of our
//! walk for the same diffuse and random rays in each of our trees. Cost is the expected cost of a tree as a share of
//! that of the exact sweep: object splits only, every border between two centres tried.

mod row;
mod walked;

use crate::embree::{Device, Embree, Quality};
use crate::machine::{self, Neighbours};
use crate::options::{EmbreeOptions, OurOptions, SceneOptions, TreeName};
use crate::ours::TimedBuild;
use crate::scenes::{self, Scene};
use clap::{Args, ValueEnum};
use cpu_time::ProcessTime;
use row::Row;
use serde_json::Value;
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use whitted::geometry::Primitives;

/// Options of `build`.
#[derive(Args, Clone, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    embree: EmbreeOptions,
    #[command(flatten)]
    scenes: SceneOptions,
    #[command(flatten)]
    ours: OurOptions,
    /// Rounds, of which the median counts
    #[arg(long, default_value_t = ROUNDS)]
    rounds: usize,
    /// Write the rows to this file as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

const ROUNDS: usize = 5;

impl Options {
    /// Everything.
    pub(crate) fn new(embree: &EmbreeOptions, scenes: &SceneOptions, ours: &OurOptions) -> Self {
        let (embree, scenes, ours) = (embree.clone(), scenes.clone(), ours.clone());
        Self { embree, scenes, ours, rounds: ROUNDS, json: None }
    }
}

/// Numbers of threads to build with.
const THREADS: [usize; 2] = [1, 2];

/// Seconds of one build, and the bytes it made.
struct Build {
    wall: f64,
    cpu: f64,
    bytes: f64,
}

/// Something that builds a tree; one of a kind for each of [`THREADS`].
struct Builder<'a> {
    name: String,
    build: Box<dyn Fn() -> Result<Build, Box<dyn Error>> + 'a>,
}

/// Measure and print; returns the rows as JSON.
///
/// # Errors
/// A scene cannot be had, Embree fails, or the JSON file cannot be written.
pub(crate) fn run(options: &Options) -> Result<Value, Box<dyn Error>> {
    let embree = options.embree.load()?;
    println!("{} · {} · commit {}", machine::date(), machine::cpu(), machine::commit());
    println!("{}", Row::header());
    let mut rows = Vec::new();
    for source in scenes::select(&options.scenes.scenes, options.scenes.shared.as_deref())? {
        if !options.scenes.skip.contains(&source.name) {
            for row in measure(options, &source.scene()?, embree)? {
                println!("{}", row.text());
                rows.push(row.json());
            }
        }
    }
    let rows = Value::Array(rows);
    if let Some(path) = &options.json {
        std::fs::write(path, format!("{rows:#}\n"))?;
    }
    Ok(rows)
}

/// A row for each builder.
fn measure(options: &Options, scene: &Scene, embree: Option<Embree>) -> Result<Vec<Row>, Box<dyn Error>> {
    let primitives = scene.primitives();
    let mut builders = our_builders(&primitives)?;
    if let Some(embree) = embree {
        builders.extend(embree_builders(scene, embree, options.embree.embree_isa.as_deref())?);
    }
    let mut rounds: Vec<Vec<Build>> = builders.iter().map(|_| Vec::new()).collect();
    let neighbours = Neighbours::watch();
    for _ in 0..options.rounds.max(1) {
        for (builds, builder) in rounds.iter_mut().zip(&builders) {
            builds.push((builder.build)()?);
        }
    }
    let others = neighbours.cores();
    let mut walked = walked::walk_each(options, scene, &primitives).into_iter();
    let with_both = builders.chunks(THREADS.len()).zip(rounds.chunks(THREADS.len()));
    let row = |(builders, rounds): (&[Builder<'_>], &[Vec<Build>])| {
        Row::new(scene, &builders[0].name, [&rounds[0], &rounds[1]], others, walked.next())
    };
    Ok(with_both.map(row).collect())
}

fn our_builders(primitives: &Primitives) -> Result<Vec<Builder<'_>>, Box<dyn Error>> {
    let mut builders = Vec::new();
    for &kind in TreeName::value_variants() {
        for threads in THREADS {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            let build = move || {
                let TimedBuild { tree, wall, cpu } = pool.install(|| TimedBuild::new(primitives, kind.into()));
                Ok(Build { wall, cpu, bytes: tree.report().bytes as f64 })
            };
            builders.push(Builder { name: kind.to_string(), build: Box::new(build) });
        }
    }
    Ok(builders)
}

fn embree_builders<'a>(
    scene: &'a Scene,
    embree: Embree,
    isa: Option<&str>,
) -> Result<Vec<Builder<'a>>, Box<dyn Error>> {
    let mut builders = Vec::new();
    for quality in [Quality::Medium, Quality::High] {
        for threads in THREADS {
            let device = embree.device(threads, isa)?;
            let build = move || embree_build(&device, scene, quality);
            builders.push(Builder { name: format!("Embree {quality}"), build: Box::new(build) });
        }
    }
    Ok(builders)
}

fn embree_build(device: &Device, scene: &Scene, quality: Quality) -> Result<Build, Box<dyn Error>> {
    let built = device.scene(&scene.mesh.vertices, &scene.mesh.triangles, &scene.spheres, quality)?;
    let before = device.bytes();
    let (start, cpu) = (Instant::now(), ProcessTime::now());
    built.commit()?;
    let (wall, cpu) = (start.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
    Ok(Build { wall, cpu, bytes: (device.bytes() - before) as f64 })
}
