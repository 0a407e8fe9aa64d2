//! All contestants for one set of rays, and who won.

use crate::contest::{self, Contestant, Times};
use crate::one_by_one::OneByOne;
use crate::ours::{Judge, Ours};
use crate::peer::{Peer, differing};
use crate::ray_sets::RaySet;
use crate::row::{PeerCell, Row};
use crate::scenes::Scene;
use std::ops::Range;
use whitted::query::RayScene;
use whitted::ray::RayBatch;
use whitted::tree::Query;

/// Contestants on one side.
type Team<'a> = Vec<Box<dyn Contestant + 'a>>;

/// Ours in batches of several sizes, or ray by ray, and the calls of Embree that compare.
pub(crate) struct Field<'a> {
    set: &'a RaySet,
    contestants: Team<'a>,
    times: Vec<Option<Times>>,
    /// Each size of batch by name, with those of ours that have it: one for each orientation of the set.
    ours: Vec<(&'static str, Range<usize>)>,
    peers: Range<usize>,
}

impl<'a> Field<'a> {
    /// Ours in batches of these sizes, and every call of Embree.
    pub(crate) fn of_batches(
        set: &'a RaySet,
        query: Query<'a>,
        batches: &[(&'static str, usize)],
        peer: Option<&'a Peer<'_>>,
    ) -> Self {
        let of_size = |&(batch, size)| {
            let ours = move |(rays, note)| -> Box<dyn Contestant + 'a> {
                Box::new(Ours::new(query, rays, size, set.kind.is_occlusion(), note))
            };
            (batch, set.orientations().into_iter().map(ours).collect())
        };
        Self::new(set, batches.iter().map(of_size).collect(), peer.map(|peer| peer.calls(set)))
    }

    /// Rays one by one: our interface for one ray, and Embree's.
    pub(crate) fn of_one(
        set: &'a RaySet,
        batch: &'static str,
        scene: &'a RayScene,
        peer: Option<&'a Peer<'_>>,
    ) -> Self {
        let ours = |(rays, note)| -> Box<dyn Contestant + 'a> {
            Box::new(OneByOne::new(scene, rays, set.kind.is_occlusion(), note))
        };
        let ours = set.orientations().into_iter().map(ours).collect();
        Self::new(set, vec![(batch, ours)], peer.map(|peer| peer.single_calls(set)))
    }

    fn new(set: &'a RaySet, batches: Vec<(&'static str, Team<'a>)>, peers: Option<Team<'a>>) -> Self {
        let (mut contestants, mut ours) = (Vec::new(), Vec::new());
        for (batch, team) in batches {
            let first = contestants.len();
            contestants.extend(team);
            ours.push((batch, first..contestants.len()));
        }
        let first_peer = contestants.len();
        contestants.extend(peers.unwrap_or_default());
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
    pub(crate) fn row(&mut self, scene: &Scene, batch: &'static str, judge: &Judge<'_>) -> Row {
        let range = self.ours.iter().find(|(name, _)| *name == batch).expect("a size that was asked for").1.clone();
        let first = range.start;
        let (own, own_times) = self.fastest(range).expect("ours never drop out");
        let rays = self.set.orientations()[own - first].0;
        let mrays = |times: &Times| rays.len() as f64 / times.median() / 1e6;
        let own_answers = self.answers(own);
        let best_peer = self.fastest(self.peers.clone());
        let suspects = best_peer.as_ref().map(|&(best, _)| differing(rays, &own_answers, &self.answers(best)));
        let (wrong, judged) = self.judge(judge, rays, &own_answers, suspects.as_deref().unwrap_or_default());
        let peer = best_peer.zip(suspects).map(|((best, times), suspects)| PeerCell {
            mrays: mrays(&times),
            call: self.contestants[best].name(),
            ratio: own_times.speed_up_over(&times),
            differ: suspects.len(),
        });
        Row {
            scene: scene.name.clone(),
            primitives: scene.len(),
            kind: self.set.kind,
            batch,
            rays: rays.len(),
            ours_mrays: mrays(&own_times),
            ours_note: self.contestants[own].name(),
            peer,
            wrong,
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
