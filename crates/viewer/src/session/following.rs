//! Following the scene's file: what is read takes the place of what was shown.

use super::Session;
use crate::opener::{News, Ready};
use std::sync::Arc;
use std::time::Instant;
use whitted::scene::{Camera, Scene, Settings};

impl Session {
    /// Take in what the opener tells.
    pub(super) fn hear(&mut self, news: News, now: Instant) {
        self.revision += 1;
        match news {
            News::Read(size) => self.proposed_size = Some(size),
            News::Broken(text) => self.trouble = Some(text),
            News::Ready(ready) => {
                self.trouble = None;
                self.adopt(*ready, now);
            }
        }
    }

    /// Show a new scene, or a new state of it. What the file has changed is followed, what the person has is kept.
    fn adopt(&mut self, ready: Ready, now: Instant) {
        let size = self.settings.size;
        let home = ready.scene.cameras.first().map_or_else(Camera::default, |named| named.camera);
        let before = self.ready.take();
        let old = before.as_ref().map(|before| &before.scene);
        self.navigator.set_scene_size(scene_size(&ready, &home));
        if old.and_then(|old| old.cameras.first()).is_none_or(|old| old.camera != home) {
            self.navigator.jump_to(home);
        }
        if old.is_none_or(|old| old.settings != ready.scene.settings) {
            self.settings = Settings { size, ..ready.scene.settings.clone() };
        }
        match &before {
            Some(_) => self.edit = ready.saved.filter(|_| self.is_visible),
            None => ready.warnings.iter().for_each(|warning| self.notes.add(warning.clone(), now)),
        }
        self.look = Some(look_of(&ready.scene));
        self.shown_scene = Some(Arc::clone(&ready.prepared));
        self.ready = Some(ready);
        // An edit is finished when it arrives: its draft is refined at once.
        self.last_change = None;
    }

    /// Once a change of the file is seen, tell how long that took.
    pub(super) fn tell_of_edit(&mut self, now: Instant) {
        let Some(saved) = self.edit else { return };
        let is_seen = {
            let picture = self.picture();
            picture.scene.as_ref().zip(self.shown_scene.as_ref()).is_some_and(|(seen, shown)| Arc::ptr_eq(seen, shown))
        };
        if is_seen {
            self.edit = None;
            // A clock that was set meanwhile tells nothing.
            let time = saved.elapsed().unwrap_or_default();
            self.edit_time = Some(time);
            self.notes.add(format!("seen {} ms after it was saved", time.as_millis()), now);
            self.revision += 1;
        }
    }
}

/// The scene without its shapes.
fn look_of(scene: &Scene) -> Scene {
    Scene {
        cameras: scene.cameras.clone(),
        lights: scene.lights.clone(),
        ambient: scene.ambient,
        background: scene.background,
        materials: scene.materials.clone(),
        settings: scene.settings.clone(),
        ..Scene::default()
    }
}

/// A length by which speeds are measured: the extent of the scene, or the distance to what is looked at.
fn scene_size(ready: &Ready, home: &Camera) -> f64 {
    let extent = ready.bounds.map_or(0.0, |[lo, hi]| (hi - lo).length());
    let size = if extent > 0.0 { extent } else { (home.look_at - home.eye).length() };
    if size.is_finite() { size } else { 1.0 }
}
