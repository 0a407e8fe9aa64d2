//! Ctrl-C: the first asks the render to stop, the second ends the process at once.

use crate::exit::{Failure, INTERRUPTED};
use whitted::render::Cancel;

static CANCEL: Cancel = Cancel::new();

/// Installs the handler and returns the flag it sets. Termination requests and hang-ups count as Ctrl-C.
pub(crate) fn install() -> &'static Cancel {
    let installed = ctrlc::set_handler(|| {
        if CANCEL.is_cancelled() {
            std::process::exit(i32::from(INTERRUPTED));
        }
        CANCEL.cancel();
        eprintln!("\nstopping; press Ctrl-C again to abort");
    });
    // Without a handler the system's default remains: Ctrl-C ends the process, and nothing is under the final name.
    drop(installed);
    &CANCEL
}

/// The end of the work if the user asked for it.
pub(crate) fn stop_if(cancel: &Cancel) -> Result<(), Failure> {
    if cancel.is_cancelled() { Err(Failure::Interrupted) } else { Ok(()) }
}
