//! A line of the table of ray queries.

use crate::ray_sets::RayKind;
use serde_json::{Value, json};

/// One line of the table.
pub(crate) struct Row {
    /// Name of the scene.
    pub scene: String,
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
    /// Answers of ours that differ from brute force, and how many were compared.
    pub judged: (usize, usize),
}

/// Embree's part of a row.
pub(crate) struct PeerCell {
    /// The rate of its best call.
    pub mrays: f64,
    /// Its best call: width of the packet, flag, build, orientation.
    pub call: String,
    /// Our rate over its rate, the median of passes.
    pub ratio: f64,
    /// Rays for which the answers differ.
    pub wrong: usize,
}

impl Row {
    /// The line above all rows.
    pub(crate) fn header() -> String {
        let numbers = "  ours Mrays/s  Embree Mrays/s  best call              ratio  wrong";
        format!("{:<12} {:<8} {:>5}{numbers}", "scene", "rays", "batch")
    }

    /// The line of the table.
    pub(crate) fn text(&self) -> String {
        let start = format!("{:<12} {:<8} {:>5} {:>13.2}", self.scene, self.kind, self.batch, self.ours_mrays);
        let peer = self.peer.as_ref().map_or_else(
            || format!("  {:>14}  {:<21} {:>6} {:>6}", "-", "-", "-", "-"),
            |peer| format!("  {:>14.2}  {:<21} {:>6.2} {:>6}", peer.mrays, peer.call, peer.ratio, peer.wrong),
        );
        let note = if self.ours_note.is_empty() { String::new() } else { format!("  ours{}", self.ours_note) };
        let (wrong, judged) = self.judged;
        let fault = if wrong == 0 { String::new() } else { format!("  OURS FALSE: {wrong} of {judged} judged") };
        start + &peer + &note + &fault
    }

    /// The row with stable keys; what Embree would say is null without it.
    pub(crate) fn json(&self) -> Value {
        let peer = self.peer.as_ref();
        json!({
            "scene": self.scene,
            "rays": self.kind.to_string(),
            "batch": self.batch,
            "count": self.rays,
            "ours_mrays": self.ours_mrays,
            "ours_call": self.ours_note.trim(),
            "embree_mrays": peer.map(|peer| peer.mrays),
            "embree_call": peer.map(|peer| &peer.call),
            "ratio": peer.map(|peer| peer.ratio),
            "wrong": peer.map(|peer| peer.wrong),
            "ours_false": self.judged.0,
            "ours_judged": self.judged.1,
        })
    }
}
