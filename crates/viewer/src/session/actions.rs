//! What keys, panels and scripts ask for.

use super::recorder::{Film, free_name};
use super::{Effect, Session};
use crate::action::{Action, Side};
use crate::camera::{framing_all, from_side};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use whitted::math::Vec3d;
use whitted::render::Aov;
use whitted::scene::{Camera, NamedCamera, Scene, Settings};

/// Where a picture is saved. The name's extension says in which format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// In this file.
    Named(PathBuf),
    /// In the current folder, in a file named after the scene, with this extension, that is not there yet.
    Free(&'static str),
}

impl Destination {
    fn path(self, scene: &Path) -> PathBuf {
        match self {
            Self::Named(path) => path,
            Self::Free(extension) => free_name(scene, "", &format!(".{extension}")),
        }
    }
}

impl Session {
    /// Do what is asked for.
    pub fn act(&mut self, action: Action) {
        let now = Instant::now();
        match action {
            Action::Side(side) => self.go_to_side(side),
            Action::Reset => self.go_home(),
            Action::FrameAll => self.frame_all(),
            Action::NextCamera => self.next_camera(now),
            Action::Turntable => self.navigator.toggle_turntable(),
            Action::Reload => self.opener.reload(),
            Action::NextView => self.step_view(1),
            Action::PreviousView => self.step_view(Aov::ALL.len()),
            Action::CopyCamera => self.copy_camera(now),
            Action::Save => self.save(Destination::Free("png")),
            Action::SaveLight => self.save(Destination::Free("exr")),
            Action::Record => self.record(now),
            Action::Help => self.shown.help = !self.shown.help,
            Action::Panel => self.shown.panel = !self.shown.panel,
            Action::Clean => self.shown.clean = !self.shown.clean,
            Action::Close => self.close(),
        }
    }

    /// Close what is open, last things first; then the window.
    fn close(&mut self) {
        if self.shown.help {
            self.shown.help = false;
        } else if self.inspector.current().is_some() {
            self.inspector.forget();
        } else if self.shown.panel {
            self.shown.panel = false;
        } else {
            self.effects.push(Effect::Close);
        }
    }

    /// Go on by so many views, in a circle of light and all others.
    fn step_view(&mut self, steps: usize) {
        let count = Aov::ALL.len() + 1;
        let now = self.view.map_or(0, |view| 1 + Aov::ALL.iter().position(|(_, aov)| *aov == view).unwrap_or(0));
        let next = (now + steps) % count;
        self.view = next.checked_sub(1).map(|index| Aov::ALL[index].1);
    }

    fn home(&self) -> Option<Camera> {
        Some(self.scene()?.cameras.first()?.camera)
    }

    fn go_home(&mut self) {
        if let Some(home) = self.home() {
            self.navigator.go_to(home);
        }
    }

    fn bounds_and_aspect(&self) -> Option<([Vec3d; 2], f64)> {
        let [width, height] = self.settings.size.map(f64::from);
        Some((self.ready.as_ref()?.bounds?, width / height.max(1.0)))
    }

    fn go_to_side(&mut self, side: Side) {
        if let (Some((bounds, aspect)), Some(home)) = (self.bounds_and_aspect(), self.home()) {
            self.navigator.go_to(from_side(&home, side, bounds, aspect));
        }
    }

    fn frame_all(&mut self) {
        if let Some((bounds, aspect)) = self.bounds_and_aspect() {
            self.navigator.go_to(framing_all(&self.navigator.destination(), bounds, aspect));
        }
    }

    /// Go to camera number `index` of the scene.
    pub fn go_to_camera(&mut self, index: usize) {
        let camera = self.scene().and_then(|scene| scene.cameras.get(index)).map(|named| named.camera);
        if let Some(camera) = camera {
            self.navigator.go_to(camera);
        }
    }

    fn next_camera(&mut self, now: Instant) {
        let here = self.navigator.destination();
        let Some(cameras) = self.scene().map(|scene| &scene.cameras) else { return };
        let next = cameras.iter().position(|named| named.camera == here).map_or(0, |index| (index + 1) % cameras.len());
        let name = cameras.get(next).map(|named| named.name.clone()).unwrap_or_default();
        self.notes.add(format!("camera {name}"), now);
        self.go_to_camera(next);
    }

    fn copy_camera(&mut self, now: Instant) {
        let name = self.scene().and_then(|scene| scene.cameras.first()).map_or("", |first| &first.name).to_owned();
        let camera = NamedCamera { name, camera: *self.navigator.camera() };
        self.effects.push(Effect::Copy(self.host.camera_block(&camera)));
        self.notes.add("the camera is on the clipboard", now);
    }

    /// True if materials, lights or settings are not those of the file.
    pub fn is_changed(&self) -> bool {
        let Some((ready, look)) = self.ready.as_ref().zip(self.look.as_ref()) else { return false };
        let (scene, size) = (&ready.scene, ready.scene.settings.size);
        let settings = Settings { size, ..self.settings.clone() };
        settings != scene.settings
            || look.materials != scene.materials
            || look.lights != scene.lights
            || look.ambient != scene.ambient
            || look.background != scene.background
    }

    /// Write materials, lights and settings into the scene's file, whose comments and all else stay.
    pub fn write_back(&mut self) {
        let Some((ready, look)) = self.ready.as_ref().zip(self.look.clone()) else { return };
        let (host, old, settings) = (Arc::clone(&self.host), Arc::clone(&ready.scene), self.settings.clone());
        self.errands.run(move |tell| {
            let new = Scene {
                settings: Settings { size: old.settings.size, ..settings },
                materials: look.materials,
                lights: look.lights,
                ambient: look.ambient,
                background: look.background,
                ..Scene::clone(&old)
            };
            match host.write_back(&old, &new) {
                Ok(()) => tell(format!("written into {}", host.path().display())),
                Err(text) => tell(text),
            }
        });
    }

    /// Save the picture when it is finished.
    pub fn save(&mut self, destination: Destination) {
        if self.finished().is_none() {
            self.notes.add("the picture is saved when it is finished", Instant::now());
        }
        self.saves.push(destination);
    }

    /// Save what was asked for, if it is finished by now.
    pub(super) fn save_what_waits(&mut self) {
        if self.saves.is_empty() {
            return;
        }
        let Some(finished) = self.finished() else { return };
        for destination in self.saves.drain(..) {
            let (host, finished) = (Arc::clone(&self.host), Arc::clone(&finished));
            self.errands.run(move |tell| {
                let path = destination.path(host.path());
                match finished.save(&*host, &path) {
                    Ok(()) => tell(format!("saved {}", path.display())),
                    Err(text) => tell(text),
                }
            });
        }
    }

    /// True while a recording is under way.
    pub fn is_recording(&self) -> bool {
        self.recorder.is_on()
    }

    fn record(&mut self, now: Instant) {
        if !self.recorder.is_on() {
            self.recorder.start(now);
            self.notes.add("recording the camera's way: R again renders it", now);
            return;
        }
        let cameras = self.recorder.stop();
        let Some(scene) = self.shown_scene.clone() else { return };
        self.notes.add(format!("rendering {} frames", cameras.len()), now);
        let film = Film {
            host: Arc::clone(&self.host),
            pool: Arc::clone(&self.pool),
            scene,
            settings: self.settings.clone(),
            execution: self.options.execution,
            cameras,
            cancel: Arc::clone(self.recorder.cancel()),
        };
        self.errands.run(move |tell| film.develop(tell));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // Frames are rendered for minutes; a picture that is being written is written to its end.
        self.recorder.cancel().cancel();
    }
}
