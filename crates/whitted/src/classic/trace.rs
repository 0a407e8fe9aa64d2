//! The way of one ray, written down: what Figure 2 of the paper draws.

use super::{NodeId, Observer};

/// What happened, in order. Intervals are parameters of the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A plane was compared with the ray, which is in its cell between these parameters.
    Step {
        /// The node; [`KdTree::cells`](super::KdTree::cells) has its box and plane.
        node: NodeId,
        /// Where the ray is in the cell.
        interval: [f32; 2],
    },
    /// A leaf was reached.
    Leaf {
        /// The node.
        node: NodeId,
        /// Where the ray is in the cell.
        interval: [f32; 2],
    },
    /// A primitive was tested.
    Test {
        /// Which.
        primitive: u32,
    },
    /// A test gave the nearest hit so far.
    Accept {
        /// Where, before refinement in double precision.
        t: f32,
        /// Of which primitive.
        primitive: u32,
    },
}

/// An observer that remembers everything.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// What happened.
    pub events: Vec<Event>,
}

impl Observer for Trace {
    fn step(&mut self, node: NodeId, interval: [f32; 2]) {
        self.events.push(Event::Step { node, interval });
    }

    fn leaf(&mut self, node: NodeId, interval: [f32; 2]) {
        self.events.push(Event::Leaf { node, interval });
    }

    fn test(&mut self, primitive: u32) {
        self.events.push(Event::Test { primitive });
    }

    fn accept(&mut self, t: f32, primitive: u32) {
        self.events.push(Event::Accept { t, primitive });
    }
}
