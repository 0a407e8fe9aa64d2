//! Reading a scene and telling the user what was odd about it.

use crate::args::{SceneArguments, Verbosity};
use crate::exit::Failure;
use formats::{ErrorKind, LoadOptions, Loaded};
use whitted::scene::Scene;

/// Reads the scene; warnings go to standard error unless it shall be quiet.
pub(crate) fn load(arguments: &SceneArguments, verbosity: &Verbosity) -> Result<Loaded, Failure> {
    load_with(arguments, verbosity, LoadOptions::default())
}

/// As [`load`], without what makes a scene look well: no floor is added.
pub(crate) fn load_shapes(arguments: &SceneArguments, verbosity: &Verbosity) -> Result<Scene, Failure> {
    let options = LoadOptions { furnish: false, ..LoadOptions::default() };
    load_with(arguments, verbosity, options).map(|loaded| loaded.scene)
}

fn load_with(arguments: &SceneArguments, verbosity: &Verbosity, options: LoadOptions) -> Result<Loaded, Failure> {
    let options = LoadOptions { allow_outside: arguments.allow_outside, ..options };
    let loaded = formats::load(&arguments.scene, &options).map_err(|error| blame(&error))?;
    if !verbosity.quiet {
        loaded.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    }
    Ok(loaded)
}

/// Sorts a reader's error by who can help.
pub(crate) fn blame(error: &formats::Error) -> Failure {
    match error.kind() {
        ErrorKind::Io => Failure::Io(error.to_string()),
        _ => Failure::Scene(error.to_string()),
    }
}
