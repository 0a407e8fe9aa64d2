//! Renderers that compute the same picture, timed in turn and checked.

use super::{Bound, Check, Measured, Reference, Rounds, Sample, Threads, interleaved};
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
    /// Bands across the picture, as high as a region, however long one takes: for what depends on the order of pixels.
    Bands,
    /// All pixels all the same: for several threads, which a few tiles could not share evenly.
    Whole,
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
    for contestant in contestants {
        match prepare(session, stage, contestant) {
            Ok(sample) => entered.push(Entry { contestant, sample, factor: 1.0 }),
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
    let whole = |(entry, rounds): (&Entry, Rounds)| {
        rounds.measured().map(|measured| measured.extrapolated(entry.factor, entry.sample.part))
    };
    (entered.iter().zip(taken).map(whole).collect(), outcome)
}

/// Gives the same bands to all of one kind that trace bands, as many as the slowest of them can: a picture's parts differ,
/// and so do its orders of pixels, but never both at once.
fn share_bands(session: &Session, entered: &mut [Entry]) {
    for of_paper in [true, false] {
        let is_of_kind = |entry: &&mut Entry| {
            entry.contestant.of_paper == of_paper && matches!(entry.contestant.spread, Spread::Bands)
        };
        let mut kind: Vec<&mut Entry> = entered.iter_mut().filter(is_of_kind).collect();
        let least = kind.iter().map(|entry| entry.sample.part).fold(1.0, f64::min);
        kind.iter_mut().for_each(|entry| entry.sample = Sample::bands(session.effort.size, least));
    }
}

/// A contestant with the pixels that it traces.
struct Entry<'a> {
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

/// As many pixels as the contestant traces in the time that it is given.
fn prepare(session: &Session, stage: &Stage, contestant: &Contestant) -> Result<Sample, Cancelled> {
    session.at(stage.span[0], &format!("{}, {}", stage.scene, contestant.name))?;
    let size = session.effort.size;
    let part = |tile| -> Result<f64, Cancelled> {
        let (parts, seconds) = trace(contestant, &Sample::tiles(size, tile, 0.0));
        Ok(session.effort.seconds / (seconds * per_ray(stage, &parts?)))
    };
    Ok(match contestant.spread {
        Spread::Tiles(side) => Sample::tiles(size, side, part(side)?),
        Spread::Bands => Sample::bands(size, part(TRIAL_TILE)?),
        Spread::Whole => Sample::whole(size),
    })
}

/// Side of the tile by which the cost of a contestant that traces bands is estimated, in pixels.
const TRIAL_TILE: u32 = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Effort, Watch};
    use whitted::render::{Cancel, Image};

    struct Unwatched;

    impl Watch for Unwatched {
        fn at(&self, _: f64, _: &str) {}
    }

    /// A picture whose pixels are their places, except for one, and some rays for each.
    fn picture(rect: &PixelRect, wrong: Option<[u32; 2]>) -> Rendered {
        let color = |pixel: [u32; 2]| {
            let [x, y] = pixel.map(|c| c as f32);
            Vec3f::new(x, y, if wrong == Some(pixel) { 1.0 } else { 0.0 })
        };
        let statistics = Statistics { camera_rays: rect.len() as u64, ..Statistics::default() };
        Rendered { pixels: rect.pixels().map(color).collect(), statistics }
    }

    fn reference(size: [u32; 2]) -> Reference {
        let rect = PixelRect::whole(size);
        let Rendered { pixels, statistics } = picture(&rect, None);
        let image = Image { width: size[0], height: size[1], pixels };
        let (first, supersampled, apron) = (Vec::new(), Vec::new(), Statistics::default());
        Reference { frame: Frame { rect, image, first, supersampled, statistics, apron } }
    }

    #[test]
    fn one_wrong_pixel_is_found_whatever_part_is_traced() {
        let effort = Effort { size: [64, 192], rounds: 3, ..Effort::quick() };
        let cancel = Cancel::new();
        let session = Session::new(&effort, &Unwatched, &cancel).unwrap();
        let reference = reference(effort.size);
        let stage = Stage { scene: "places", reference: &reference, span: [0.0, 1.0] };
        let contestant = |name: &str, spread, wrong| Contestant {
            of_paper: true,
            name: name.to_owned(),
            bound: Bound::Equal,
            threads: &session.one,
            spread,
            render: Box::new(move |rect| Ok(picture(rect, wrong))),
        };
        let all = [
            contestant("right", Spread::Tiles(8), None),
            contestant("wrong", Spread::Whole, Some([63, 191])),
            contestant("wrong in a band", Spread::Bands, Some([5, 100])),
        ];
        let (measured, outcome) = contest(&session, &stage, &all);
        assert_eq!(outcome, Ok(()));
        assert!(
            measured.iter().all(|measured| measured.is_some_and(|m| m.rounds == 3 && m.traced > 0.0)),
            "{measured:?}"
        );
        let differing: Vec<(String, usize)> =
            session.checks().into_iter().map(|check| (check.variant, check.differing)).collect();
        assert_eq!(differing, [("right".into(), 0), ("wrong".into(), 1), ("wrong in a band".into(), 1)]);
        assert!(!session.checks().iter().all(Check::holds));
    }

    #[test]
    fn a_part_stands_for_the_whole() {
        let effort = Effort { size: [256, 192], rounds: 3, seconds: 0.004, ..Effort::quick() };
        let cancel = Cancel::new();
        let session = Session::new(&effort, &Unwatched, &cancel).unwrap();
        let reference = reference(effort.size);
        let stage = Stage { scene: "places", reference: &reference, span: [0.0, 1.0] };
        let contestant = |spread| Contestant {
            of_paper: true,
            name: format!("{spread:?}"),
            bound: Bound::Equal,
            threads: &session.one,
            spread,
            render: Box::new(|rect| {
                // Each pixel takes the same time.
                (0..rect.len() * 3000).for_each(|i| _ = std::hint::black_box(i));
                Ok(picture(rect, None))
            }),
        };
        let all = [Spread::Whole, Spread::Tiles(8), Spread::Bands].map(contestant);
        let (measured, _) = contest(&session, &stage, &all);
        let [whole, tiles, bands] = [0, 1, 2].map(|index| measured[index].unwrap());
        assert!(whole.traced == 1.0 && tiles.traced < 0.5 && bands.traced < 0.5, "{measured:?}");
        for part in [tiles, bands] {
            assert!((0.5..2.0).contains(&(part.median / whole.median)), "{measured:?}");
        }
    }

    #[test]
    fn a_part_is_extrapolated_by_rays() {
        let effort = Effort { size: [640, 480], ..Effort::quick() };
        let cancel = Cancel::new();
        let session = Session::new(&effort, &Unwatched, &cancel).unwrap();
        let reference = reference(effort.size);
        let stage = Stage { scene: "places", reference: &reference, span: [0.0, 1.0] };
        let tile = picture(&PixelRect { x: 0, y: 0, width: 64, height: 48 }, None);
        assert_eq!(per_ray(&stage, &[tile]), 100.0);
        cancel.cancel();
        assert!(session.at(0.0, "stopped").is_err());
    }
}
