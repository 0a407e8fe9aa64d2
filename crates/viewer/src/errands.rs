//! Work that must not keep anybody waiting: pictures that are saved, frames that are recorded.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

/// A piece of work; it tells how it went, in a line for the window.
type Errand = Box<dyn FnOnce(&dyn Fn(String)) + Send>;

/// A thread that does one errand after the other. When it is dropped, what has been begun is brought to its end: no file
/// is left half written.
pub(crate) struct Errands {
    outbox: Option<Sender<Errand>>,
    told: Receiver<String>,
    thread: Option<JoinHandle<()>>,
}

impl Errands {
    /// Start the thread; `wake` is called when an errand has told something.
    ///
    /// # Errors
    /// If the system has no thread left.
    pub(crate) fn start(wake: Arc<dyn Fn() + Send + Sync>) -> std::io::Result<Self> {
        let (outbox, inbox) = channel::<Errand>();
        let (teller, told) = channel();
        let run = move || {
            for errand in inbox {
                errand(&|line| {
                    // If nobody listens any more, the viewer is about to close.
                    let _ = teller.send(line);
                    wake();
                });
            }
        };
        let thread = std::thread::Builder::new().name("errands".to_owned()).spawn(run)?;
        Ok(Self { outbox: Some(outbox), told, thread: Some(thread) })
    }

    /// Do this when what was asked for before is done.
    pub(crate) fn run(&self, errand: impl FnOnce(&dyn Fn(String)) + Send + 'static) {
        if let Some(outbox) = &self.outbox {
            // The thread only ends when this does, or after a panic that it has reported.
            let _ = outbox.send(Box::new(errand));
        }
    }

    /// What an errand told.
    pub(crate) fn told(&self) -> Option<String> {
        self.told.try_recv().ok()
    }
}

impl Drop for Errands {
    fn drop(&mut self) {
        self.outbox = None;
        if let Some(thread) = self.thread.take() {
            // If it panicked, it has said so already.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;
    use std::time::Duration;

    #[test]
    fn what_was_begun_is_brought_to_its_end() {
        let done = Arc::new(Mutex::new(Vec::new()));
        let errands = Errands::start(Arc::new(|| {})).unwrap();
        for number in 0..3 {
            let done = Arc::clone(&done);
            errands.run(move |tell| {
                std::thread::sleep(Duration::from_millis(10));
                done.lock().unwrap().push(number);
                tell(number.to_string());
            });
        }
        drop(errands);
        assert_eq!(*done.lock().unwrap(), [0, 1, 2]);
    }
}
