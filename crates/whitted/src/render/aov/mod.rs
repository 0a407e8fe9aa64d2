//! Pictures of something other than light: normals, depths, objects, the paper's two masks, and what pixels cost.
//!
//! Most are painted from what a [`Frame`] holds anyway. What a pixel costs is found by tracing it again, one ray after
//! the other by the single walk, whose counts are those of each ray: no other walk counts for anybody.

mod cost;
mod first_hits;
mod paint;
mod palette;

pub use palette::heat;

use super::context::Context;
use super::execution::Execution;
use super::frame::{Classic, Frame};
use super::progress::{Cancel, Cancelled};
use crate::scene::{Prepared, Settings};
use crate::tree::WalkKind;
pub use cost::Clock;
use cost::Cost;

/// What a picture can show instead of light.
///
/// All but the last three depend on scene and settings only, to the byte; those are of the single walk through the tree
/// at hand, which is the same on every machine for `Nodes` and `Tests`, and never the same for `Time`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// Shading normal of the first sample on the side of the viewer: x, y, z from −1 to 1 as red, green, blue. Black:
    /// nothing was hit.
    Normal,
    /// Distance of the first sample from the eye: grey, linear in 1 / distance, from the nearest (white) to the farthest
    /// (dark grey). Black: nothing was hit.
    Depth,
    /// Object that the first sample hit, each with its colour: a mesh is one. Black: none.
    Id,
    /// Primitive that the first sample hit, each with its colour: a mesh has many. Black: none.
    Primitive,
    /// White where rays of the first sample were cut by their weight before the depth limit: the paper's figure 3.
    Importance,
    /// White where a pixel was supersampled: the paper's figure 4.
    Supersampled,
    /// Nodes of the tree that all rays of the pixel's samples visit, shadow rays included.
    Nodes,
    /// Primitives against which they are tested.
    Tests,
    /// Time that they take, one after the other.
    Time,
}

impl Aov {
    /// All, with their names.
    pub const ALL: [(&'static str, Self); 9] = [
        ("normal", Self::Normal),
        ("depth", Self::Depth),
        ("id", Self::Id),
        ("primitive", Self::Primitive),
        ("importance", Self::Importance),
        ("supersampled", Self::Supersampled),
        ("nodes", Self::Nodes),
        ("tests", Self::Tests),
        ("time", Self::Time),
    ];

    /// Its name in [`ALL`](Self::ALL).
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }

    /// True if pixels must be traced again for it.
    pub fn is_cost(self) -> bool {
        matches!(self, Self::Nodes | Self::Tests | Self::Time)
    }

    /// What the picture shows, in a few words.
    pub fn what(self) -> &'static str {
        match self {
            Self::Normal => "normals: x, y, z from -1 to 1 as red, green, blue",
            Self::Depth => "distance from the eye, grey by its reciprocal",
            Self::Id => "objects, each with its colour",
            Self::Primitive => "primitives, each with its colour",
            Self::Importance => "white: a ray was cut by its weight before the depth limit",
            Self::Supersampled => "white: more than one sample",
            Self::Nodes => "nodes of the tree visited for the pixel",
            Self::Tests => "primitives tested for the pixel",
            Self::Time => "nanoseconds spent on the pixel, ray by ray",
        }
    }
}

/// A picture of something other than light.
#[derive(Clone, Debug, PartialEq)]
pub struct AovPicture {
    /// What it shows.
    pub aov: Aov,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top left.
    pub rgb8: Vec<u8>,
    /// What the colours stand for, where they stand for amounts and there are any.
    pub legend: Option<Legend>,
}

/// What the first and the last colour of a scale stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legend {
    /// The amount of the first colour: white for depth, dark for costs.
    pub first: f32,
    /// The amount of the last colour: dark grey for depth, bright for costs; these pixels may have cost more.
    pub last: f32,
}

impl std::fmt::Display for AovPicture {
    /// What the picture shows, and of what amounts.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.aov.what())?;
        match (self.legend, self.aov) {
            (None, _) => Ok(()),
            (Some(Legend { first, last }), Aov::Depth) => write!(f, ", {first} (white) to {last} (dark)"),
            (Some(Legend { first, last }), _) => write!(f, ", {first} (dark) to {last} and more (bright)"),
        }
    }
}

/// The pictures `wanted` of `frame`, which was rendered from `prepared` with `settings`, in their order.
///
/// `clock` is asked for [`Aov::Time`] only. `execution` changes nothing but how long it takes. Runs in the current rayon
/// pool.
///
/// # Panics
/// If any is wanted of a frame that was rendered without [`Execution::first_samples`] and without edges.
///
/// # Errors
/// If `cancel` was set.
pub fn aovs(
    wanted: &[Aov],
    frame: &Frame,
    prepared: &Prepared,
    settings: &Settings,
    execution: &Execution,
    clock: Clock,
    cancel: &Cancel,
) -> Result<Vec<AovPicture>, Cancelled> {
    let execution = Execution { walk: WalkKind::Single, ..*execution };
    pictures(wanted, frame, &Context::new(prepared, settings, &execution, cancel), clock)
}

/// As [`aovs`], with the costs of the paper's structures.
///
/// # Errors
/// If `cancel` was set.
pub fn aovs_classic(
    wanted: &[Aov],
    frame: &Frame,
    classic: &Classic<'_>,
    settings: &Settings,
    execution: &Execution,
    clock: Clock,
    cancel: &Cancel,
) -> Result<Vec<AovPicture>, Cancelled> {
    let context = Context::new(classic.prepared, settings, execution, cancel);
    pictures(wanted, frame, &Context { caster: Some(classic.caster), ..context }, clock)
}

fn pictures(wanted: &[Aov], frame: &Frame, context: &Context, clock: Clock) -> Result<Vec<AovPicture>, Cancelled> {
    assert!(wanted.is_empty() || frame.first.len() == frame.rect.len(), "what the first samples saw was not kept");
    let clock = wanted.contains(&Aov::Time).then_some(clock);
    let costs = match wanted.iter().any(|aov| aov.is_cost()) {
        true => cost::of_pixels(context, frame, clock)?,
        false => Vec::new(),
    };
    wanted.iter().map(|&aov| picture(aov, frame, context, &costs)).collect()
}

/// One picture; `costs` are those of all pixels if it shows costs.
fn picture(aov: Aov, frame: &Frame, context: &Context, costs: &[Cost]) -> Result<AovPicture, Cancelled> {
    let amounts = |of: fn(&Cost) -> u64| costs.iter().map(|cost| of(cost) as f32).collect::<Vec<f32>>();
    let (rgb8, legend) = match aov {
        Aov::Normal => (paint::normals(&frame.first), None),
        Aov::Depth => paint::depths(&frame.first),
        Aov::Id => (paint::numbers(frame.first.iter().map(|first| first.object)), None),
        Aov::Primitive => (paint::numbers(first_hits::primitives(context, frame)?), None),
        Aov::Importance => (paint::mask(frame.first.iter().map(|first| first.cut)), None),
        Aov::Supersampled => (paint::mask(frame.supersampled.iter().copied()), None),
        Aov::Nodes => paint::amounts(&amounts(|cost| cost.nodes)),
        Aov::Tests => paint::amounts(&amounts(|cost| cost.tests)),
        Aov::Time => paint::amounts(&amounts(|cost| cost.nanoseconds)),
    };
    Ok(AovPicture { aov, width: frame.rect.width, height: frame.rect.height, rgb8, legend })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_in_the_order_of_the_kinds() {
        Aov::ALL.iter().for_each(|&(name, aov)| assert_eq!(aov.name(), name));
    }
}
