//! All contestants for one set of rays, and who won.

use crate::contest::{self, Contestant, Times};
use crate::ours::{Judge, Ours};
use crate::peer::{Peer, differing};
use crate::ray_sets::RaySet;
use crate::row::{PeerCell, Row};
use std::ops::Range;
use whitted::ray::RayBatch;
use whitted::tree::Query;

/// Ours in batches of several sizes, and every call of Embree.
pub(crate) struct Field<'a> {
    set: &'a RaySet,
    contestants: Vec<Box<dyn Contestant + 'a>>,
    times: Vec<Option<Times>>,
    /// Each size of batch by name, with those of ours that have it: one for each orientation of the set.
    ours: Vec<(&'static str, Range<usize>)>,
    peers: Range<usize>,
}

impl<'a> Field<'a> {
    /// Everybody gets the rays in the shape that it likes.
    pub(crate) fn new(
        set: &'a RaySet,
        query: Query<'a>,
        batches: &[(&'static str, usize)],
        peer: Option<&'a Peer<'_>>,
    ) -> Self {
        let mut contestants: Vec<Box<dyn Contestant + 'a>> = Vec::new();
        let mut ours = Vec::new();
        for &(batch, size) in batches {
            let first = contestants.len();
            for (rays, note) in set.orientations() {
                contestants.push(Box::new(Ours::new(query, rays, size, set.kind.is_occlusion(), note)));
            }
            ours.push((batch, first..contestants.len()));
        }
        let first_peer = contestants.len();
        contestants.extend(peer.map(|peer| peer.calls(set)).unwrap_or_default());
        let peers = first_peer..contestants.len();
        Self { set, contestants, times: Vec::new(), ours, peers }
    }

    /// Run everybody.
    pub(crate) fn run(&mut self, passes: usize) {
        self.times = contest::run(&mut self.contestants, passes);
    }

    /// The line of a size of batch.
    ///
    /// # Panics
    /// Before [`run`](Self::run), or if there is no such size.
    pub(crate) fn row(&mut self, scene: &str, batch: &'static str, judge: &Judge<'_>) -> Row {
        let range = self.ours.iter().find(|(name, _)| *name == batch).expect("a size that was asked for").1.clone();
        let first = range.start;
        let (own, own_times) = self.fastest(range).expect("ours never drop out");
        let rays = self.set.orientations()[own - first].0;
        let mrays = |times: &Times| rays.len() as f64 / times.median() / 1e6;
        let own_answers = self.answers(own);
        let best_peer = self.fastest(self.peers.clone());
        let suspects = best_peer.as_ref().map(|&(best, _)| differing(rays, &own_answers, &self.answers(best)));
        let judged = self.judge(judge, rays, &own_answers, suspects.as_deref().unwrap_or_default());
        let peer = best_peer.zip(suspects).map(|((best, times), suspects)| PeerCell {
            mrays: mrays(&times),
            call: self.contestants[best].name(),
            ratio: own_times.speed_up_over(&times),
            wrong: suspects.len(),
        });
        Row {
            scene: scene.into(),
            kind: self.set.kind,
            batch,
            rays: rays.len(),
            ours_mrays: mrays(&own_times),
            ours_note: self.contestants[own].name(),
            peer,
            judged,
        }
    }

    /// The contestant in `range` with the shortest median.
    fn fastest(&self, range: Range<usize>) -> Option<(usize, Times)> {
        let ran = range.filter_map(|index| Some((index, self.times[index].clone()?)));
        ran.min_by(|a, b| a.1.median().total_cmp(&b.1.median()))
    }

    /// Answers of a fresh pass: calls that read the same packets overwrite each other's.
    fn answers(&mut self, index: usize) -> Vec<f32> {
        let contestant = &mut self.contestants[index];
        contestant.prepare();
        contestant.run();
        contestant.answers()
    }

    /// How many of our answers are false, of a sample of all and of the suspects; and how many were judged.
    fn judge(&self, judge: &Judge<'_>, rays: &RayBatch, answers: &[f32], suspects: &[usize]) -> (usize, usize) {
        let all: Vec<usize> = (0..rays.len()).collect();
        let [sample, doubtful] =
            [&all[..], suspects].map(|indices| judge.wrong(rays, answers, indices, self.set.kind.is_occlusion()));
        (sample.0 + doubtful.0, sample.1 + doubtful.1)
    }
}
