//! Asking why a pixel looks as it does.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use whitted::render::{Cancel, RayTree, explain};
use whitted::scene::{Prepared, Settings};

/// A pixel that was asked about. It stays what it was while the camera moves on: its rays can be seen from elsewhere.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Its rays, once they are known.
    pub tree: Option<Arc<RayTree>>,
    /// The ray that is looked at, by its number in the first sample.
    pub chosen: Option<usize>,
}

/// Asks one question at a time; a new one takes the place of the old one.
pub(super) struct Inspector {
    current: Option<Inspection>,
    cancel: Arc<Cancel>,
    wake: Arc<dyn Fn() + Send + Sync>,
    outbox: Sender<RayTree>,
    inbox: Receiver<RayTree>,
}

impl Inspector {
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (outbox, inbox) = channel();
        Self { current: None, cancel: Arc::default(), wake, outbox, inbox }
    }

    /// Ask about a pixel of the picture that `scene` gives with `settings`.
    pub(super) fn ask(&mut self, pixel: [u32; 2], scene: Prepared, settings: Settings) {
        self.forget();
        self.current = Some(Inspection { pixel, tree: None, chosen: None });
        let (cancel, wake, outbox) = (Arc::clone(&self.cancel), Arc::clone(&self.wake), self.outbox.clone());
        let ask = move || {
            if let Ok(tree) = explain(&scene, &settings, pixel, 0..1, &cancel) {
                // If nobody listens any more, the viewer is about to close.
                let _ = outbox.send(tree);
                wake();
            }
        };
        // Without a thread there is no answer; the question stays in sight.
        let _ = std::thread::Builder::new().name("inspector".to_owned()).spawn(ask);
    }

    /// Take in an answer. Tells whether there was one.
    pub(super) fn listen(&mut self) -> bool {
        let mut heard = false;
        for tree in self.inbox.try_iter() {
            if let Some(current) = self.current.as_mut().filter(|current| current.pixel == tree.pixel) {
                current.tree = Some(Arc::new(tree));
                heard = true;
            }
        }
        heard
    }

    /// Ask nothing any more.
    pub(super) fn forget(&mut self) {
        self.cancel.cancel();
        self.cancel = Arc::default();
        self.current = None;
    }

    pub(super) fn current(&self) -> Option<&Inspection> {
        self.current.as_ref()
    }

    /// Look at a ray.
    pub(super) fn choose(&mut self, ray: Option<usize>) {
        if let Some(current) = &mut self.current {
            current.chosen = ray;
        }
    }
}

impl Drop for Inspector {
    fn drop(&mut self) {
        self.cancel.cancel();
    }
}
