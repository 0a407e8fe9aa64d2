//! Command-line options that several commands share.

use crate::embree::{Device, Embree, EmbreeError};
use clap::{Args, ValueEnum};
use simd::Level;
use std::fmt;
use std::path::PathBuf;
use whitted::tree::{TreeKind, WalkKind};

/// How our side builds and walks.
#[derive(Args, Clone, Debug)]
pub(crate) struct OurOptions {
    /// Instruction set of our side: scalar, sse4.2, avx2, avx512 (the widest of this CPU if not given)
    #[arg(long, value_parser = parse_level)]
    pub level: Option<Level>,
    /// How rays are walked through the tree
    #[arg(long, value_enum, default_value = "auto")]
    pub walk: Walk,
    /// Which splits the builder may use
    #[arg(long, value_enum, default_value = "best")]
    pub tree: TreeName,
}

impl OurOptions {
    /// The instruction set to use.
    pub(crate) fn level(&self) -> Level {
        self.level.unwrap_or_else(Level::best)
    }
}

fn parse_level(name: &str) -> Result<Level, String> {
    Level::by_name(name).ok_or_else(|| {
        let names: Vec<&str> = Level::available().into_iter().map(Level::name).collect();
        format!("this CPU has {}", names.join(", "))
    })
}

/// [`WalkKind`] by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Walk {
    /// The walk that suits the rays
    Auto,
    /// Lists of rays pushed through the tree together
    Stream,
    /// One ray after the other
    Single,
}

impl From<Walk> for WalkKind {
    fn from(walk: Walk) -> Self {
        match walk {
            Walk::Auto => Self::Auto,
            Walk::Stream => Self::Stream,
            Walk::Single => Self::Single,
        }
    }
}

/// [`TreeKind`] by name; no tree at all would take years.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TreeName {
    /// Object and spatial splits compete
    Best,
    /// Object splits only
    Fast,
    /// Spatial splits only
    Kd,
}

impl fmt::Display for TreeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.to_possible_value().expect("no kind is hidden").get_name())
    }
}

impl From<TreeName> for TreeKind {
    fn from(name: TreeName) -> Self {
        match name {
            TreeName::Best => Self::Best,
            TreeName::Fast => Self::Fast,
            TreeName::Kd => Self::Kd,
        }
    }
}

/// Where Embree is.
#[derive(Args, Clone, Debug)]
pub(crate) struct EmbreeOptions {
    /// Embree 4: its library file, or the folder that holds it
    #[arg(long, env = "EMBREE_LIB", value_name = "PATH")]
    pub embree: Option<PathBuf>,
    /// Limit Embree's instruction set, as avx2
    #[arg(long, value_name = "ISA")]
    pub embree_isa: Option<String>,
}

impl EmbreeOptions {
    /// Load Embree, if a path is known; says so on standard error if not.
    ///
    /// # Errors
    /// The path is known, but there is no Embree 4.
    pub(crate) fn load(&self) -> Result<Option<Embree>, EmbreeError> {
        let Some(path) = &self.embree else {
            eprintln!("No Embree: give its library by --embree PATH or EMBREE_LIB. Only our own figures follow.");
            return Ok(None);
        };
        Embree::load(path).map(Some)
    }

    /// A device of one thread with the chosen instruction set, if a path is known.
    ///
    /// # Errors
    /// As [`load`](Self::load), or Embree refuses the instruction set.
    pub(crate) fn one_thread(&self) -> Result<Option<Device>, EmbreeError> {
        self.load()?.map(|embree| embree.device(1, self.embree_isa.as_deref())).transpose()
    }
}

/// Which scenes.
#[derive(Args, Clone, Debug)]
pub(crate) struct SceneOptions {
    /// Scenes by name, or files of any format that `whitted` reads; all standard scenes if not given
    #[arg(long = "scene", value_name = "NAME", num_args = 1..)]
    pub scenes: Vec<String>,
    /// Scenes to leave out
    #[arg(long, value_name = "NAME", num_args = 1..)]
    pub skip: Vec<String>,
    /// The folder whose `scenes` holds meshes
    #[arg(long, env = "WHITTED_SHARED", value_name = "DIR")]
    pub shared: Option<PathBuf>,
}
