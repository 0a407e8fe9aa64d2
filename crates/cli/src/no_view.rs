//! `whitted view` in a build without the viewer: says how to get it.

use crate::args::ViewArguments;
use crate::exit::Failure;

pub(crate) fn run(arguments: &ViewArguments) -> Result<(), Failure> {
    let scene = arguments.scene.scene.display();
    Err(Failure::Io(format!(
        "this build of whitted has no viewer\nhint: cargo run --release --features viewer -- view {scene}"
    )))
}
