//! `rays`: ray queries beside Embree, on the same rays in the same process.
//!
//! Both sides have their rays in the shape they like best before the clock starts: ours in batches row by row, Embree's
//! in packets of 16, packets of 8 and structs, reset before each pass outside the clock. Our batches are reset, sorted
//! and bucketed inside it. Both deliver t, primitive, u and v, or whether a shadow ray is blocked. Each side may turn
//! shadow rays round. Embree's best call counts, over both flags and both builds; so does our better orientation.
//! Embree's calls know no batches: they answer the same loop whatever our batch is. Batch 1 is another contest: our
//! interface for one ray against Embree's.

use crate::embree::Device;
use crate::field::Field;
use crate::machine;
use crate::options::{EmbreeOptions, OurOptions, SceneOptions};
use crate::ours::{Judge, TimedBuild, no_tree};
use crate::peer::Peer;
use crate::ray_sets::{Origins, RayKind};
use crate::row::Row;
use crate::scenes::{self, Source};
use clap::{Args, ValueEnum};
use serde_json::Value;
use simd::Level;
use std::error::Error;
use std::path::PathBuf;
use whitted::geometry::Primitives;
use whitted::query::RayScene;
use whitted::ray::HitBatch;
use whitted::tree::{Query, Scratch, TreeKind};

/// Options of `rays`.
#[derive(Args, Clone, Debug)]
pub(crate) struct Options {
    #[command(flatten)]
    embree: EmbreeOptions,
    #[command(flatten)]
    scenes: SceneOptions,
    #[command(flatten)]
    ours: OurOptions,
    /// Ray sets; all if not given
    #[arg(long = "rays", value_enum, value_name = "KIND", num_args = 1..)]
    kinds: Vec<RayKind>,
    /// Sizes of our batches; all if not given
    #[arg(long = "batch", value_parser = [WHOLE, "4096", "1024", "64", ONE], value_name = "SIZE", num_args = 1..)]
    batches: Vec<String>,
    /// Timed passes, of which the median counts
    #[arg(long, default_value_t = PASSES)]
    passes: usize,
    /// Use at most this many rays of each set
    #[arg(long, value_name = "N")]
    max_rays: Option<usize>,
    /// Write the rows to this file as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Timed passes unless another number is asked for.
pub(crate) const PASSES: usize = 7;

impl Options {
    /// Everything.
    pub(crate) fn new(
        embree: &EmbreeOptions,
        scenes: &SceneOptions,
        ours: &OurOptions,
        passes: usize,
        max_rays: Option<usize>,
    ) -> Self {
        let (embree, scenes, ours) = (embree.clone(), scenes.clone(), ours.clone());
        Self { embree, scenes, ours, kinds: Vec::new(), batches: Vec::new(), passes, max_rays, json: None }
    }

    /// In one batch each.
    pub(crate) fn in_whole_sets(self) -> Self {
        Self { batches: vec![WHOLE.into()], ..self }
    }

    fn wants(&self, batch: &str) -> bool {
        self.batches.is_empty() || self.batches.iter().any(|wanted| wanted == batch)
    }
}

/// The name of the row of whole sets.
const WHOLE: &str = "all";
/// The name of the row of single rays.
const ONE: &str = "1";

/// Sizes of our batches: the whole set first.
const BATCHES: [(&str, usize); 4] = [(WHOLE, usize::MAX), ("4096", 4096), ("1024", 1024), ("64", 64)];

/// Measure and print; returns the rows as JSON.
///
/// # Errors
/// A scene cannot be had, Embree fails, or the JSON file cannot be written.
pub(crate) fn run(options: &Options) -> Result<Value, Box<dyn Error>> {
    let device = options.embree.one_thread()?;
    let about = about(options, device.as_ref());
    println!("{about}\n{}", Row::header());
    let mut rows = Vec::new();
    for source in scenes::select(&options.scenes.scenes, options.scenes.shared.as_deref())? {
        if !options.scenes.skip.contains(&source.name) {
            measure_scene(options, &source, device.as_ref(), &mut |row| {
                println!("{}", row.text());
                rows.push(row.json());
            })?;
        }
    }
    let rows = Value::Array(rows);
    if let Some(path) = &options.json {
        std::fs::write(path, format!("{rows:#}\n"))?;
    }
    Ok(rows)
}

fn about(options: &Options, device: Option<&Device>) -> String {
    let isa = options.embree.embree_isa.as_deref().map_or(String::new(), |isa| format!(" limited to {isa}"));
    let peer = device.map_or("no Embree".into(), |device| format!("Embree {}{isa}", device.version()));
    let (level, ours) = (options.ours.level(), &options.ours);
    format!(
        "{} · {} · commit {} · ours {level}, walk {:?}, tree {:?} · {peer} · one core, thread CPU time, median of {} passes",
        machine::date(),
        machine::cpu(),
        machine::commit(),
        ours.walk,
        ours.tree,
        options.passes,
    )
}

/// Measure one scene and hand out its rows.
///
/// # Errors
/// The scene cannot be had, or Embree fails.
pub(crate) fn measure_scene(
    options: &Options,
    source: &Source,
    device: Option<&Device>,
    emit: &mut impl FnMut(Row),
) -> Result<(), Box<dyn Error>> {
    let scene = source.scene()?;
    let primitives = scene.primitives();
    let TimedBuild { tree, wall, cpu } = TimedBuild::new(&primitives, options.ours.tree.into());
    let query =
        Query { tree: &tree, primitives: &primitives, level: options.ours.level(), walk: options.ours.walk.into() };
    let brute_force = no_tree(&primitives);
    let judge = Judge::new(query, &brute_force);
    let peer = device.map(|device| Peer::new(device, &scene)).transpose()?;
    let held = device.map_or(0, Device::bytes) as f64 / 1e6;
    let count = scene.len();
    eprintln!("{}: {count} primitives, our build {wall:.2} s ({cpu:.2} s CPU), Embree holds {held:.0} MB", scene.name);
    let origins = Origins::new(&scene, &primitives, |rays| {
        let mut hits = HitBatch::default();
        query.closest_hit(rays, &mut hits, &mut Scratch::default());
        hits
    });
    let single = single(options, &primitives);
    let kinds = if options.kinds.is_empty() { RayKind::value_variants() } else { &options.kinds };
    for &kind in kinds {
        let mut set = origins.set(kind);
        set.thin(options.max_rays.unwrap_or(usize::MAX));
        if set.rays.is_empty() {
            continue;
        }
        let batches: Vec<_> = BATCHES.into_iter().filter(|&(name, _)| options.wants(name)).collect();
        let mut field = Field::of_batches(&set, query, &batches, peer.as_ref());
        field.run(options.passes);
        batches.iter().for_each(|&(batch, _)| emit(field.row(&scene, batch, &judge)));
        if let Some(single) = &single {
            let mut field = Field::of_one(&set, ONE, single, peer.as_ref());
            field.run(options.passes);
            emit(field.row(&scene, ONE, &judge));
        }
    }
    Ok(())
}

/// The scene behind the interface for one ray, if its row is wanted; it takes the instruction set that it likes.
fn single(options: &Options, primitives: &Primitives) -> Option<RayScene> {
    let is_ours = options.ours.level() == Level::best();
    (options.wants(ONE) && is_ours)
        .then(|| RayScene::from_primitives(primitives.clone(), &TreeKind::from(options.ours.tree).into()))
}
