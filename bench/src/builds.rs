//! `build`: how fast trees are built, how large they are and what walking them costs, beside Embree's builds.
//!
//! A rate is primitives per second: of CPU time of the whole process with one thread, and of the wall clock with one
//! and two. All builders run in turn, and the median of rounds counts. Embree's bytes are what its allocator holds for
//! the scene, without the caller's arrays handed to it. Tests and steps are those of our walk for the same diffuse and
//! random rays in each of our trees. Cost is the expected cost of a tree as a share of that of the exact sweep: object splits
//! only, every border between two centres tried.

use crate::contest::{Contestant, median, thread_seconds};
use crate::embree::{Device, Embree, Quality};
use crate::machine;
use crate::options::{EmbreeOptions, OurOptions, SceneOptions, TreeName};
use crate::ours::{Ours, TimedBuild};
use crate::ray_sets::{Origins, RayKind, RaySet};
use crate::scenes::{self, Scene};
use clap::{Args, ValueEnum};
use cpu_time::ProcessTime;
use serde_json::{Value, json};
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use whitted::geometry::Primitives;
use whitted::ray::HitBatch;
use whitted::tree::{BuildOptions, Query, Scratch, Tree, TreeKind, TreeReport};

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

const ROUNDS: usize = 3;

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

/// A tree of ours and what walking it costs, per ray.
struct Walked {
    report: TreeReport,
    /// Expected cost of a ray, of that in the tree by the exact sweep.
    cost: f64,
    tests: f64,
    steps: f64,
    mrays: f64,
}

/// Measure and print; returns the rows as JSON.
///
/// # Errors
/// A scene cannot be had, Embree fails, or the JSON file cannot be written.
pub(crate) fn run(options: &Options) -> Result<Value, Box<dyn Error>> {
    let embree = options.embree.load()?;
    println!("{} · {} · commit {}", machine::date(), machine::cpu(), machine::commit());
    println!(
        "{:<12} {:>9} {:<14} {:>9} {:>8} {:>8} {:>7} {:>6} {:>5} {:>6} {:>9} {:>9} {:>7}",
        "scene",
        "primitives",
        "build",
        "M/s CPU",
        "M/s wall",
        "2 thr",
        "B/prim",
        "refs",
        "depth",
        "cost",
        "tests/ray",
        "steps/ray",
        "Mrays/s"
    );
    let mut rows = Vec::new();
    for source in scenes::select(&options.scenes.scenes, options.scenes.shared.as_deref())? {
        if !options.scenes.skip.contains(&source.name) {
            rows.extend(measure(options, &source.scene()?, embree)?);
        }
    }
    let rows = Value::Array(rows);
    if let Some(path) = &options.json {
        std::fs::write(path, format!("{rows:#}\n"))?;
    }
    Ok(rows)
}

/// A row for each builder.
fn measure(options: &Options, scene: &Scene, embree: Option<Embree>) -> Result<Vec<Value>, Box<dyn Error>> {
    let primitives = scene.primitives();
    let mut builders = our_builders(&primitives)?;
    if let Some(embree) = embree {
        builders.extend(embree_builders(scene, embree, options.embree.embree_isa.as_deref())?);
    }
    let mut rounds: Vec<Vec<Build>> = builders.iter().map(|_| Vec::new()).collect();
    for _ in 0..options.rounds.max(1) {
        for (builds, builder) in rounds.iter_mut().zip(&builders) {
            builds.push((builder.build)()?);
        }
    }
    let mut walked = walk_each(options, scene, &primitives).into_iter();
    let with_both = builders.chunks(THREADS.len()).zip(rounds.chunks(THREADS.len()));
    Ok(with_both.map(|(builder, rounds)| row(scene, &builder[0].name, &rounds[0], &rounds[1], walked.next())).collect())
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

/// Walk each kind of tree with the same rays.
fn walk_each(options: &Options, scene: &Scene, primitives: &Primitives) -> Vec<Walked> {
    let exact = BuildOptions { exact: true, ..TreeKind::Fast.into() };
    let sweep_cost = Tree::build(primitives, &exact).expected_cost();
    let mut sets = Vec::new();
    let walk = |&kind: &TreeName| {
        let tree = Tree::build(primitives, &TreeKind::from(kind).into());
        let query = Query { tree: &tree, primitives, level: options.ours.level(), walk: options.ours.walk.into() };
        if sets.is_empty() {
            sets = ray_sets(scene, primitives, query);
        }
        walk_one(query, &sets, sweep_cost)
    };
    TreeName::value_variants().iter().map(walk).collect()
}

/// Diffuse and random rays, an eighth of a million each.
fn ray_sets(scene: &Scene, primitives: &Primitives, query: Query<'_>) -> Vec<RaySet> {
    const RAYS: usize = 1 << 17;
    let origins = Origins::new(scene, primitives, |rays| {
        let mut hits = HitBatch::default();
        query.closest_hit(rays, &mut hits, &mut Scratch::default());
        hits
    });
    let thinned = |kind| {
        let mut set = origins.set(kind);
        set.thin(RAYS);
        set
    };
    [RayKind::Diffuse, RayKind::Random].map(thinned).into()
}

fn walk_one(query: Query<'_>, sets: &[RaySet], sweep_cost: f64) -> Walked {
    const PASSES: usize = 5;
    let mut ours: Vec<Ours<'_>> =
        sets.iter().map(|set| Ours::new(query, &set.rays, usize::MAX, set.kind.is_occlusion(), "")).collect();
    let rays: f64 = sets.iter().map(|set| set.rays.len() as f64).sum();
    let (mut tests, mut steps) = (0, 0);
    for one in &mut ours {
        let counts = one.count();
        tests += counts.primitive_tests;
        steps += counts.node_steps;
    }
    let mut pass = || thread_seconds(|| ours.iter_mut().for_each(|one| one.run()));
    let seconds = median((0..PASSES).map(|_| pass()).collect());
    let (report, cost) = (query.tree.report(), query.tree.expected_cost() / sweep_cost);
    Walked { report, cost, tests: tests as f64 / rays, steps: steps as f64 / rays, mrays: rays / seconds / 1e6 }
}

/// Print one builder's line and return it as JSON; `one` and `two` are its builds with one and two threads.
fn row(scene: &Scene, name: &str, one: &[Build], two: &[Build], walked: Option<Walked>) -> Value {
    let count = scene.len() as f64;
    let rate =
        |builds: &[Build], seconds: fn(&Build) -> f64| count / median(builds.iter().map(seconds).collect()) / 1e6;
    let (cpu, wall, two_threads) = (rate(one, |b| b.cpu), rate(one, |b| b.wall), rate(two, |b| b.wall));
    let bytes = median(one.iter().map(|b| b.bytes).collect()) / count;
    let walk = walked.as_ref().map_or(String::new(), |w| {
        let references = w.report.references as f64 / count;
        format!(
            "{references:>6.2} {:>5} {:>6.3} {:>9.2} {:>9.2} {:>7.2}",
            w.report.depth, w.cost, w.tests, w.steps, w.mrays
        )
    });
    println!(
        "{:<12} {:>9} {name:<14} {cpu:>9.3} {wall:>8.3} {two_threads:>8.3} {bytes:>7.1} {walk}",
        scene.name,
        scene.len()
    );
    json!({
        "scene": scene.name,
        "primitives": scene.len(),
        "build": name,
        "mprim_per_cpu_second": cpu,
        "mprim_per_second": wall,
        "mprim_per_second_2_threads": two_threads,
        "bytes_per_primitive": bytes,
        "references": walked.as_ref().map(|w| w.report.references),
        "dropped": walked.as_ref().map(|w| w.report.dropped),
        "depth": walked.as_ref().map(|w| w.report.depth),
        "cost_of_exact_sweep": walked.as_ref().map(|w| w.cost),
        "tests_per_ray": walked.as_ref().map(|w| w.tests),
        "steps_per_ray": walked.as_ref().map(|w| w.steps),
        "mrays": walked.as_ref().map(|w| w.mrays),
    })
}
