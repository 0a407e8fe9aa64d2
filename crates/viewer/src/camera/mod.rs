//! Where the camera is and how it moves: from what a person does to the camera of each moment.

mod controls;
mod fit;
mod flight;
mod motion;
mod navigator;

pub(crate) use controls::{Click, Controls};
pub(crate) use fit::{framing_all, from_side};
pub(crate) use navigator::Navigator;
