//! Renderers that compute the same picture, timed in turn and checked.

use super::{Bound, Check, Measured, Reference, Sample, Threads, interleaved};
use crate::session::Session;
use rayon::prelude::*;
use whitted::math::Vec3f;
use whitted::render::{Cancelled, Frame, PixelRect, Statistics};

/// What a renderer makes of some pixels.
pub(crate) struct Rendered {
    pub(crate) pixels: Vec<Vec3f>,
    pub(crate) statistics: Statistics,
}

impl From<Frame> for Rendered {
    fn from(frame: Frame) -> Self {
        Self { pixels: frame.image.pixels, statistics: frame.statistics }
    }
}

/// Which pixels a renderer gets where the whole picture would take too long.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spread {
    /// Square tiles of this side, in pixels.
    Tiles(u32),
    /// Bands across the picture, as high as a region, or nothing at all: for what depends on the order of pixels.
    Bands,
    /// Bands, or where even one takes too long, tiles.
    BandsOrTiles(u32),
}

/// Renders a rectangle of the picture.
pub(crate) type Render<'a> = Box<dyn Fn(&PixelRect) -> Result<Rendered, Cancelled> + Sync + 'a>;

/// A renderer that takes part.
pub(crate) struct Contestant<'a> {
    pub(crate) of_paper: bool,
    pub(crate) name: String,
    pub(crate) bound: Bound,
    pub(crate) threads: &'a Threads,
    pub(crate) spread: Spread,
    pub(crate) render: Render<'a>,
}

/// Where all take part.
pub(crate) struct Stage<'a> {
    pub(crate) scene: &'a str,
    pub(crate) reference: &'a Reference,
    /// Parts of the experiment (0 to 1) that are done before and after.
    pub(crate) span: [f64; 2],
}

/// Seconds for the whole picture of each contestant, `None` where it was not measured; and whether the user stopped it.
pub(crate) fn contest(
    session: &Session,
    stage: &Stage,
    contestants: &[Contestant],
) -> (Vec<Option<Measured>>, Result<(), Cancelled>) {
    let mut entered = Vec::new();
    for (index, contestant) in contestants.iter().enumerate() {
        match prepare(session, stage, contestant) {
            Ok(Some(sample)) => entered.push(Entry { index, contestant, sample, factor: 1.0 }),
            Ok(None) => {}
            Err(cancelled) => return (vec![None; contestants.len()], Err(cancelled)),
        }
    }
    share_bands(session, &mut entered);
    let (count, rounds) = (entered.len(), session.effort.rounds);
    let (taken, outcome) = interleaved(&mut entered, rounds, |entry, turn, round| {
        let part = (round * count + turn) as f64 / (rounds * count) as f64;
        let what = format!("{}, {}, round {} of {rounds}", stage.scene, entry.contestant.name, round + 1);
        session.at(stage.span[0] + part * (stage.span[1] - stage.span[0]), &what)?;
        entry.run(session, stage, round == 0)
    });
    let mut measured = vec![None; contestants.len()];
    for (entry, rounds) in entered.iter().zip(taken) {
        measured[entry.index] = rounds.measured().map(|m| m.extrapolated(entry.factor, entry.sample.part));
    }
    (measured, outcome)
}

/// Gives the same bands to all of one kind that trace bands, as many as the slowest of them can: a picture's parts differ,
/// and so do its orders of pixels, but never both at once.
fn share_bands(session: &Session, entered: &mut [Entry]) {
    let size = session.effort.size;
    let is_banded = |entry: &Entry| entry.sample.rects.iter().all(|rect| rect.width == size[0]);
    for of_paper in [true, false] {
        let mut kind: Vec<&mut Entry> = entered
            .iter_mut()
            .filter(|entry| {
                entry.contestant.of_paper == of_paper && !matches!(entry.contestant.spread, Spread::Tiles(_))
            })
            .filter(|entry| is_banded(entry))
            .collect();
        let least = kind.iter().map(|entry| entry.sample.part).fold(1.0, f64::min);
        kind.iter_mut().for_each(|entry| entry.sample = Sample::bands(size, least));
    }
}

/// A contestant with the pixels that it traces.
struct Entry<'a> {
    /// Its place among all.
    index: usize,
    contestant: &'a Contestant<'a>,
    sample: Sample,
    /// From the rays of the sample to those of the whole picture.
    factor: f64,
}

impl Entry<'_> {
    /// CPU seconds for the sample.
    fn run(&mut self, session: &Session, stage: &Stage, is_first: bool) -> Result<f64, Cancelled> {
        let (parts, seconds) = trace(self.contestant, &self.sample);
        let parts = parts?;
        if is_first {
            self.factor = per_ray(stage, &parts);
            for (rect, rendered) in self.sample.rects.iter().zip(&parts) {
                session.checked(check(stage, self.contestant, rect, rendered));
            }
        }
        Ok(seconds)
    }
}

fn check(stage: &Stage, contestant: &Contestant, rect: &PixelRect, rendered: &Rendered) -> Check {
    stage.reference.check(contestant, stage.scene, rect, &rendered.pixels)
}

/// How many times more rays the whole picture has.
fn per_ray(stage: &Stage, parts: &[Rendered]) -> f64 {
    let rays: u64 = parts.iter().map(|part| part.statistics.rays()).sum();
    stage.reference.frame.statistics.rays() as f64 / rays.max(1) as f64
}

fn trace(contestant: &Contestant, sample: &Sample) -> (Result<Vec<Rendered>, Cancelled>, f64) {
    contestant.threads.seconds(|| sample.rects.par_iter().map(|rect| (contestant.render)(rect)).collect())
}

/// Seconds beyond the allowance, as a multiple of it, that a single band may take.
const PATIENCE: f64 = 8.0;

/// As many pixels as the contestant traces in the time that it is given; `None` if it cannot take part.
fn prepare(session: &Session, stage: &Stage, contestant: &Contestant) -> Result<Option<Sample>, Cancelled> {
    session.at(stage.span[0], &format!("{}, {}", stage.scene, contestant.name))?;
    let size = session.effort.size;
    let tile = match contestant.spread {
        Spread::Tiles(side) | Spread::BandsOrTiles(side) => side,
        Spread::Bands => TRIAL_TILE,
    };
    let (parts, seconds) = trace(contestant, &Sample::tiles(size, tile, 0.0));
    let whole = seconds * per_ray(stage, &parts?);
    let part = session.effort.seconds / whole;
    let bands = || (part * PATIENCE * f64::from(size[1]) >= f64::from(Sample::BAND)).then(|| Sample::bands(size, part));
    Ok(match contestant.spread {
        Spread::Tiles(side) => Some(Sample::tiles(size, side, part)),
        Spread::Bands => bands(),
        Spread::BandsOrTiles(side) => Some(bands().unwrap_or_else(|| Sample::tiles(size, side, part))),
    })
}

/// Side of the tile by which the cost of a contestant is estimated, in pixels.
const TRIAL_TILE: u32 = 16;
