//! The slow and obviously right twin of [`object_split`](super::object_split): every border between centres is tried.

use super::object_split::ObjectSplit;
use super::reference::Reference;
use super::{Bounds, BuildOptions, cost};

/// The cheapest split by centres; `None` if all centres coincide.
pub(super) fn find(options: &BuildOptions, references: &[Reference], bounds: Bounds) -> Option<ObjectSplit> {
    let mut best: Option<ObjectSplit> = None;
    for axis in 0..3 {
        for split in splits(options, references, bounds, axis) {
            if best.is_none_or(|best| split.cost < best.cost) {
                best = Some(split);
            }
        }
    }
    best
}

/// All splits along an axis.
fn splits(options: &BuildOptions, references: &[Reference], bounds: Bounds, axis: usize) -> Vec<ObjectSplit> {
    let center = |reference: &Reference| reference.bounds().center2(axis);
    let mut sorted = references.to_vec();
    sorted.sort_by(|a, b| center(a).total_cmp(&center(b)));
    let lefts = running_boxes(sorted.iter());
    let mut rights = running_boxes(sorted.iter().rev());
    rights.reverse();
    // Equal centres stay together.
    let borders = (1..sorted.len()).filter(|&i| center(&sorted[i - 1]) < center(&sorted[i]));
    let split = |i: usize| {
        let sides = [lefts[i - 1], rights[i]];
        let cost = cost::split(options, bounds, [(sides[0], i), (sides[1], sorted.len() - i)]);
        ObjectSplit::at_center(axis, center(&sorted[i]), sides, cost)
    };
    borders.map(split).collect()
}

/// The boxes around the first one, two, three … references.
fn running_boxes<'a>(references: impl Iterator<Item = &'a Reference>) -> Vec<Bounds> {
    let grow = |sum: &mut Bounds, reference: &Reference| {
        *sum = sum.union(*reference.bounds());
        Some(*sum)
    };
    references.scan(Bounds::EMPTY, grow).collect()
}
