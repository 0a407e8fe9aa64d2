//! A line of the table of ray queries.

use crate::ray_sets::RayKind;
use serde_json::{Value, json};

/// One line of the table.
pub(crate) struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Number of its primitives.
    pub primitives: usize,
    /// The set of rays.
    pub kind: RayKind,
    /// Size of our batches.
    pub batch: &'static str,
    /// Number of rays.
    pub rays: usize,
    /// Our rate, in millions of rays per second.
    pub ours_mrays: f64,
    /// Which orientation of ours won.
    pub ours_note: String,
    /// Embree's part, if it is there.
    pub peer: Option<PeerCell>,
    /// Answers of ours that differ from brute force: none is expected.
    pub wrong: usize,
    /// How many of ours were compared with brute force: a sample, and those that differ from Embree's.
    pub judged: usize,
}

/// Embree's part of a row.
pub(crate) struct PeerCell {
    /// The rate of its best call.
    pub mrays: f64,
    /// Its best call: width of the packet, flag, build, orientation.
    pub call: String,
    /// Our rate over its rate, the median of passes.
    pub ratio: f64,
    /// Rays that the two sides answer differently.
    pub differ: usize,
}

impl Row {
    /// The line above all rows.
    pub(crate) fn header() -> String {
        let numbers = "  ours Mrays/s  Embree Mrays/s  best call              ratio differ  wrong judged";
        format!("{:<12} {:<8} {:>5}{numbers}", "scene", "rays", "batch")
    }

    /// The line of the table.
    pub(crate) fn text(&self) -> String {
        let start = format!("{:<12} {:<8} {:>5} {:>13.2}", self.scene, self.kind, self.batch, self.ours_mrays);
        let peer = self.peer.as_ref().map_or_else(
            || format!("  {:>14}  {:<21} {:>6} {:>6}", "-", "-", "-", "-"),
            |peer| format!("  {:>14.2}  {:<21} {:>6.2} {:>6}", peer.mrays, peer.call, peer.ratio, peer.differ),
        );
        let note = if self.ours_note.is_empty() { String::new() } else { format!("  ours{}", self.ours_note) };
        start + &peer + &format!(" {:>6} {:>6}", self.wrong, self.judged) + &note
    }

    /// The row with stable keys; what Embree would say is null without it.
    pub(crate) fn json(&self) -> Value {
        let peer = self.peer.as_ref();
        json!({
            "scene": self.scene,
            "primitives": self.primitives,
            "rays": self.kind.to_string(),
            "batch": self.batch,
            "count": self.rays,
            "ours_mrays": self.ours_mrays,
            "ours_call": self.ours_note.trim(),
            "embree_mrays": peer.map(|peer| peer.mrays),
            "embree_call": peer.map(|peer| &peer.call),
            "ratio": peer.map(|peer| peer.ratio),
            "wrong": self.wrong,
            "judged": self.judged,
            "differ": peer.map(|peer| peer.differ),
        })
    }
}
