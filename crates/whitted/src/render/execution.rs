//! How the picture is computed: nothing here can change a pixel.

use simd::Level;

/// How a picture is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Execution {
    /// Instruction set.
    pub level: Level,
    /// Size of the regions, which are batches and parallel tasks at once.
    pub region: Region,
    /// Generations of batches, or one ray after the other.
    pub method: Method,
    /// The walk through the tree.
    pub walk: crate::tree::WalkKind,
    /// Whether [`Frame::first`](super::Frame::first) is wanted; what edges need is found in any case. Without it, a picture
    /// takes a third of the memory.
    pub first_samples: bool,
}

impl Default for Execution {
    fn default() -> Self {
        Self {
            level: Level::best(),
            region: Region::Rectangle(64, 64),
            method: Method::Wavefront,
            walk: crate::tree::WalkKind::Auto,
            first_samples: true,
        }
    }
}

/// Size of a region (paper §3.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// Width and height in pixels, each ≥ 1.
    Rectangle(u32, u32),
    /// One line of the picture.
    Scanline,
    /// The whole picture.
    Frame,
}

/// Order of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Batches, generation by generation.
    Wavefront,
    /// One ray after the other, recursively: the paper's renderer and the oracle of the wavefront.
    Recursive,
}
