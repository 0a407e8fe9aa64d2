//! Embree's side: its calls as contestants.

use crate::contest::Contestant;
use crate::embree::{Align16, Align32, Align64, Device, EmbreeError, Quality, RayHits, Rays, Scene};
use crate::packets::{Packet, Packets};
use crate::ray_sets::RaySet;
use crate::scenes;
use std::cell::RefCell;
use std::rc::Rc;
use whitted::ray::RayBatch;

/// The same scene, built in both qualities.
pub(crate) struct Peer<'d> {
    scenes: [(Quality, Scene<'d>); 2],
}

impl<'d> Peer<'d> {
    /// Hand the scene to Embree and build it.
    ///
    /// # Errors
    /// Embree's.
    pub(crate) fn new(device: &'d Device, scene: &scenes::Scene) -> Result<Self, EmbreeError> {
        let build = |quality| {
            let built = device.scene(&scene.mesh.vertices, &scene.mesh.triangles, &scene.spheres, quality)?;
            built.commit()?;
            Ok((quality, built))
        };
        Ok(Self { scenes: [build(Quality::Medium)?, build(Quality::High)?] })
    }

    /// Every call that can answer the set: single rays and packets of 8 and 16, coherent and not, for either build.
    pub(crate) fn calls(&self, set: &RaySet) -> Vec<Box<dyn Contestant + '_>> {
        let mut calls = self.single_calls(set);
        if set.kind.is_occlusion() {
            self.add::<Rays<Align32, 8>>(set, &mut calls);
            self.add::<Rays<Align64, 16>>(set, &mut calls);
        } else {
            self.add::<RayHits<Align32, 8>>(set, &mut calls);
            self.add::<RayHits<Align64, 16>>(set, &mut calls);
        }
        calls
    }

    /// The calls that answer one ray, for either build.
    pub(crate) fn single_calls(&self, set: &RaySet) -> Vec<Box<dyn Contestant + '_>> {
        let mut calls = Vec::new();
        match set.kind.is_occlusion() {
            true => self.add::<Rays<Align16, 1>>(set, &mut calls),
            false => self.add::<RayHits<Align16, 1>>(set, &mut calls),
        }
        calls
    }

    fn add<'s, P: Packet + 's>(&'s self, set: &RaySet, calls: &mut Vec<Box<dyn Contestant + 's>>) {
        for (rays, note) in set.orientations() {
            let packets = Rc::new(RefCell::new(Packets::<P>::new(rays)));
            let flags: &[bool] = if P::WIDTH == 1 { &[false] } else { &[false, true] };
            for &coherent in flags {
                for (quality, scene) in &self.scenes {
                    let packets = Rc::clone(&packets);
                    calls.push(Box::new(Call { scene, quality: *quality, packets, coherent, note }));
                }
            }
        }
    }
}

/// One function of Embree on one of its trees.
struct Call<'s, P> {
    scene: &'s Scene<'s>,
    quality: Quality,
    /// Shared by the calls that read the same shape, and reset before each.
    packets: Rc<RefCell<Packets<P>>>,
    coherent: bool,
    note: &'static str,
}

impl<P: Packet> Contestant for Call<'_, P> {
    fn name(&self) -> String {
        let flag = match (P::WIDTH, self.coherent) {
            (1, _) => "",
            (_, false) => "i",
            (_, true) => "c",
        };
        format!("{}{flag} {}{}", P::WIDTH, self.quality, self.note)
    }

    fn is_peer(&self) -> bool {
        true
    }

    fn prepare(&mut self) {
        self.packets.borrow_mut().reset();
    }

    fn run(&mut self) {
        self.packets.borrow_mut().query(self.scene, self.coherent);
    }

    fn answers(&self) -> Vec<f32> {
        self.packets.borrow().answers()
    }
}

/// How many answers differ: one is a miss and the other none, or t differs by more than a ten thousandth.
pub(crate) fn differing(rays: &RayBatch, ours: &[f32], theirs: &[f32]) -> Vec<usize> {
    const TOLERANCE: f32 = 1e-4;
    let differs = |&index: &usize| {
        let (a, b) = (ours[index], theirs[index]);
        a.is_finite() != b.is_finite() || (a.is_finite() && (a - b).abs() > TOLERANCE * a.abs().max(1.0))
    };
    (0..rays.len()).filter(differs).collect()
}
