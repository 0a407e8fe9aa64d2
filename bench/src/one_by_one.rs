//! Our side as most programs ask: a ray at a time, through the library's interface for one ray.

use crate::contest::Contestant;
use whitted::query::RayScene;
use whitted::ray::{Hit, Ray, RayBatch};

/// Rays that are asked one after the other, with room for their answers.
pub(crate) struct OneByOne<'a> {
    scene: &'a RayScene,
    rays: Vec<Ray>,
    answers: Answers,
    note: &'static str,
}

enum Answers {
    Hits(Vec<Hit>),
    Occlusion(Vec<bool>),
}

impl<'a> OneByOne<'a> {
    /// Ask `scene` about `rays`; `note` tells apart contestants for the same set.
    pub(crate) fn new(scene: &'a RayScene, rays: &RayBatch, is_occlusion: bool, note: &'static str) -> Self {
        let count = rays.len();
        let answers = match is_occlusion {
            true => Answers::Occlusion(vec![false; count]),
            false => Answers::Hits(vec![Hit::MISS; count]),
        };
        Self { scene, rays: (0..count).map(|index| rays.get(index)).collect(), answers, note }
    }
}

impl Contestant for OneByOne<'_> {
    fn name(&self) -> String {
        self.note.into()
    }

    fn is_peer(&self) -> bool {
        false
    }

    fn run(&mut self) {
        match &mut self.answers {
            Answers::Hits(hits) => {
                for (ray, hit) in self.rays.iter().zip(hits) {
                    *hit = self.scene.closest_hit(ray).unwrap_or(Hit::MISS);
                }
            }
            Answers::Occlusion(blocked) => {
                for (ray, blocked) in self.rays.iter().zip(blocked) {
                    *blocked = self.scene.occluded(ray);
                }
            }
        }
    }

    fn answers(&self) -> Vec<f32> {
        match &self.answers {
            Answers::Hits(hits) => hits.iter().map(|hit| hit.t).collect(),
            Answers::Occlusion(blocked) => blocked.iter().map(|&is| if is { 0.0 } else { f32::INFINITY }).collect(),
        }
    }
}
