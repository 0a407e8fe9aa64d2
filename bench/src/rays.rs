//! `rays`: ray queries beside Embree, on the same rays in the same process.
//!
//! Both sides have their rays in the shape they like best before the clock starts: ours in batches row by row, Embree's
//! in packets of 16, packets of 8 and structs, reset before each pass outside the clock. Our batches are reset, sorted
//! and bucketed inside it. Both deliver t, primitive, u and v, or whether a shadow ray is blocked. Each side may turn
//! shadow rays round. Embree's best call counts, over both flags and both builds; so does our better orientation.
//! Embree's calls know no batches: they answer the same loop whatever our batch is.

use crate::contest::{self, Contestant, Times};
use crate::embree::Device;
use crate::machine;
use crate::options::{EmbreeOptions, OurOptions, SceneOptions};
use crate::ours::{Judge, Ours, TimedBuild, no_tree};
use crate::peer::{Peer, differing};
use crate::ray_sets::{Origins, RayKind, RaySet};
use crate::scenes::{self, Source};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::error::Error;
use std::path::PathBuf;
use whitted::ray::HitBatch;
use whitted::tree::{Query, Scratch};

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
    #[arg(long = "batch", value_parser = ["all", "4096", "1024", "64"], value_name = "SIZE", num_args = 1..)]
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

    fn wants(&self, batch: &str) -> bool {
        self.batches.is_empty() || self.batches.iter().any(|wanted| wanted == batch)
    }
}

/// Sizes of our batches: the whole set first.
const BATCHES: [(&str, usize); 4] = [("all", usize::MAX), ("4096", 4096), ("1024", 1024), ("64", 64)];

/// One line of the table.
struct Row {
    scene: String,
    kind: RayKind,
    batch: &'static str,
    rays: usize,
    ours_mrays: f64,
    ours_note: String,
    peer: Option<PeerCell>,
    /// Answers of ours that differ from brute force, and how many were compared.
    judged: (usize, usize),
}

/// Embree's part of a row.
struct PeerCell {
    mrays: f64,
    call: String,
    ratio: f64,
    /// Rays for which the answers differ.
    wrong: usize,
}

impl Row {
    fn header() -> String {
        let numbers = "  ours Mrays/s  Embree Mrays/s  best call              ratio  wrong";
        format!("{:<12} {:<8} {:>5}{numbers}", "scene", "rays", "batch")
    }

    fn text(&self) -> String {
        let start = format!("{:<12} {:<8} {:>5} {:>13.2}", self.scene, self.kind, self.batch, self.ours_mrays);
        let peer = self.peer.as_ref().map_or_else(
            || format!("  {:>14}  {:<21} {:>6} {:>6}", "-", "-", "-", "-"),
            |peer| format!("  {:>14.2}  {:<21} {:>6.2} {:>6}", peer.mrays, peer.call, peer.ratio, peer.wrong),
        );
        let note = if self.ours_note.is_empty() { String::new() } else { format!("  ours{}", self.ours_note) };
        let (wrong, judged) = self.judged;
        let fault = if wrong == 0 { String::new() } else { format!("  OURS FALSE: {wrong} of {judged} judged") };
        start + &peer + &note + &fault
    }

    fn json(&self) -> Value {
        let peer = self.peer.as_ref();
        json!({
            "scene": self.scene,
            "rays": self.kind.to_string(),
            "batch": self.batch,
            "count": self.rays,
            "ours_mrays": self.ours_mrays,
            "ours_call": self.ours_note.trim(),
            "embree_mrays": peer.map(|peer| peer.mrays),
            "embree_call": peer.map(|peer| &peer.call),
            "ratio": peer.map(|peer| peer.ratio),
            "wrong": peer.map(|peer| peer.wrong),
            "ours_false": self.judged.0,
            "ours_judged": self.judged.1,
        })
    }
}

/// Measure and print; returns the rows as JSON.
///
/// # Errors
/// A scene cannot be had, Embree fails, or the JSON file cannot be written.
pub(crate) fn run(options: &Options) -> Result<Value, Box<dyn Error>> {
    let device = match options.embree.load()? {
        Some(embree) => Some(embree.device(1, options.embree.embree_isa.as_deref())?),
        None => None,
    };
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

fn measure_scene(
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
    let kinds = if options.kinds.is_empty() { RayKind::value_variants() } else { &options.kinds };
    for &kind in kinds {
        let mut set = origins.set(kind);
        set.thin(options.max_rays.unwrap_or(usize::MAX));
        if !set.rays.is_empty() {
            measure_set(options, &source.name, &set, query, peer.as_ref(), &judge).into_iter().for_each(&mut *emit);
        }
    }
    Ok(())
}

/// A row for each size of batch.
fn measure_set(
    options: &Options,
    scene: &str,
    set: &RaySet,
    query: Query<'_>,
    peer: Option<&Peer<'_>>,
    judge: &Judge<'_>,
) -> Vec<Row> {
    let is_occlusion = set.kind.is_occlusion();
    let orientations: Vec<_> = [(Some(&set.rays), ""), (set.reversed.as_ref(), " from light")]
        .into_iter()
        .filter_map(|(r, n)| Some((r?, n)))
        .collect();
    let mut contestants: Vec<Box<dyn Contestant + '_>> = Vec::new();
    let batches: Vec<_> = BATCHES.into_iter().filter(|&(name, _)| options.wants(name)).collect();
    for &(_, size) in &batches {
        for &(rays, note) in &orientations {
            contestants.push(Box::new(Ours::new(query, rays, size, is_occlusion, note)));
        }
    }
    let ours_count = contestants.len();
    contestants.extend(peer.map(|peer| peer.calls(set)).unwrap_or_default());
    let times = contest::run(&mut contestants, options.passes);

    let best_peer = fastest(&times, ours_count..times.len());
    let peer_answers = best_peer.map(|best| answers(contestants[best].as_mut()));
    let groups = batches.iter().zip((0..ours_count).step_by(orientations.len()));
    let row = |(&(batch, _), first): (&(&'static str, usize), usize)| {
        let best = fastest(&times, first..first + orientations.len()).expect("our own calls never drop out");
        let ours = times[best].as_ref().expect("chosen among those that ran");
        let own_answers = answers(contestants[best].as_mut());
        let rays = orientations[best - first].0;
        let mrays = |times: &Times| rays.len() as f64 / times.median() / 1e6;
        let suspects = peer_answers.as_ref().map(|theirs| differing(rays, &own_answers, theirs));
        let all: Vec<usize> = (0..rays.len()).collect();
        let judged = [Some(&all), suspects.as_ref()].into_iter().flatten();
        let judged = judged.map(|indices| judge.wrong(rays, &own_answers, indices, is_occlusion));
        let peer = best_peer.zip(suspects.as_ref()).map(|(best, suspects)| {
            let theirs = times[best].as_ref().expect("chosen among those that ran");
            PeerCell {
                mrays: mrays(theirs),
                call: contestants[best].name(),
                ratio: ours.speed_up_over(theirs),
                wrong: suspects.len(),
            }
        });
        Row {
            scene: scene.into(),
            kind: set.kind,
            batch,
            rays: rays.len(),
            ours_mrays: mrays(ours),
            ours_note: contestants[best].name(),
            peer,
            judged: judged.fold((0, 0), |sum, next| (sum.0 + next.0, sum.1 + next.1)),
        }
    };
    groups.map(row).collect()
}

/// The contestant in `range` with the shortest median.
fn fastest(times: &[Option<Times>], range: std::ops::Range<usize>) -> Option<usize> {
    let medians = range.filter_map(|index| Some((index, times[index].as_ref()?.median())));
    medians.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}

/// Answers of a fresh pass: calls that read the same packets overwrite each other's.
fn answers(contestant: &mut (dyn Contestant + '_)) -> Vec<f32> {
    contestant.prepare();
    contestant.run();
    contestant.answers()
}
