//! The scenes of the experiments.

use crate::measure::{Reference, Threads};
use crate::session::Session;
use whitted::render::{Cancelled, Execution, PixelRect, Silent, Unwatched, render_rect};
use whitted::scene::generate::{PaperFamily, paper_scene};
use whitted::scene::{Prepared, Scene};
use whitted::tree::BuildOptions;

/// A scene, ready.
pub(super) struct Stock {
    pub(super) name: String,
    pub(super) scene: Scene,
    pub(super) prepared: Prepared,
    /// CPU seconds of one thread that the production tree took.
    pub(super) build_seconds: f64,
}

/// The families with what tables call them.
pub(super) const FAMILIES: [(PaperFamily, &str); 2] = [(PaperFamily::All4, "all4"), (PaperFamily::Mix, "mix")];

impl Stock {
    /// `count` spheres of a family, for pictures of `size`, built by `threads`.
    pub(super) fn spheres(family: PaperFamily, count: u32, size: [u32; 2], threads: &Threads) -> Self {
        let name = FAMILIES.iter().find(|(known, _)| *known == family).map_or("", |(_, name)| name);
        let mut scene = paper_scene(family, count).expect("the counts of the experiments are below ten million");
        scene.settings.size = size;
        Self::new(format!("{name}-{count}"), scene, threads)
    }

    /// Any scene.
    pub(super) fn new(name: String, scene: Scene, threads: &Threads) -> Self {
        let build = || Prepared::new(&scene, &BuildOptions::default());
        let (prepared, build_seconds) = threads.seconds(build);
        let prepared = prepared.expect("the scenes of the experiments are well-formed");
        Self { name, scene, prepared, build_seconds }
    }

    /// The same shapes without lights.
    pub(super) fn unlit(&self) -> Prepared {
        let scene = Scene { lights: Vec::new(), ..self.scene.clone() };
        self.prepared.with_look_of(&scene).expect("a scene needs no lights")
    }

    /// The whole picture by the default renderer.
    pub(super) fn reference(&self, session: &Session) -> Result<Reference, Cancelled> {
        let (settings, rect) = (&self.scene.settings, PixelRect::whole(self.scene.settings.size));
        let execution = Execution::default();
        let render = || render_rect(&self.prepared, settings, &execution, &rect, &Silent, session.cancel, &Unwatched);
        let (frame, _) = session.several.seconds(render);
        Ok(Reference { frame: frame? })
    }
}
