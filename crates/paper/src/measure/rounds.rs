//! Rounds: everything once, then everything again, so that what else the machine does falls on all alike.

use serde::Serialize;
use whitted::render::Cancelled;

/// What several rounds gave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Measured {
    /// The middle one.
    pub median: f64,
    /// The lowest.
    pub low: f64,
    /// The highest.
    pub high: f64,
    /// How many there were.
    pub rounds: usize,
    /// The part of the pixels that was traced; the rest is extrapolated by the number of rays.
    pub traced: f64,
}

impl Measured {
    /// A number that is counted or derived.
    pub(crate) const fn exact(value: f64) -> Self {
        Self { median: value, low: value, high: value, rounds: 1, traced: 1.0 }
    }

    /// All values times `factor`, measured on a part of the pixels.
    pub(crate) fn extrapolated(self, factor: f64, traced: f64) -> Self {
        let [median, low, high] = [self.median, self.low, self.high].map(|value| value * factor);
        Self { median, low, high, traced, ..self }
    }
}

/// A value of each round.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rounds(Vec<f64>);

impl Rounds {
    /// What they gave; `None` without any.
    pub(crate) fn measured(&self) -> Option<Measured> {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (*sorted.first()?, *sorted.last()?);
        let (below, above) = ((sorted.len() - 1) / 2, sorted.len() / 2);
        let median = (sorted[below] + sorted[above]) / 2.0;
        Some(Measured { median, low, high, rounds: sorted.len(), traced: 1.0 })
    }
}

/// Runs every contestant once in each of `rounds` rounds; `run` gets it, its number and that of the round.
///
/// A run that is cut short keeps the rounds that were taken.
pub(crate) fn interleaved<T>(
    contestants: &mut [T],
    rounds: usize,
    mut run: impl FnMut(&mut T, usize, usize) -> Result<f64, Cancelled>,
) -> (Vec<Rounds>, Result<(), Cancelled>) {
    let mut taken = vec![Rounds::default(); contestants.len()];
    for round in 0..rounds {
        for index in 0..contestants.len() {
            match run(&mut contestants[index], index, round) {
                Ok(value) => taken[index].0.push(value),
                Err(cancelled) => return (taken, Err(cancelled)),
            }
        }
    }
    (taken, Ok(()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_counts_and_the_ends_are_kept() {
        let Measured { median, low, high, rounds, .. } = Rounds(vec![3.0, 1.0, 9.0, 2.0]).measured().unwrap();
        assert_eq!((median, low, high, rounds), (2.5, 1.0, 9.0, 4));
        assert_eq!(Rounds::default().measured(), None);
        assert_eq!(Measured::exact(2.0).extrapolated(3.0, 0.1).high, 6.0);
    }

    #[test]
    fn rounds_alternate_and_survive_the_end() {
        let mut order = Vec::new();
        let (taken, outcome) = interleaved(&mut ["a", "b"], 3, |name, index, round| {
            order.push(*name);
            if (index, round) == (1, 2) { Err(Cancelled) } else { Ok(round as f64) }
        });
        assert_eq!(order, ["a", "b", "a", "b", "a", "b"]);
        assert_eq!(outcome, Err(Cancelled));
        assert_eq!(taken.iter().map(|rounds| rounds.0.len()).collect::<Vec<_>>(), [3, 2]);
    }
}
