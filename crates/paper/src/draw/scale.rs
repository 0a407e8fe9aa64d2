//! From numbers to places on paper.

/// A logarithmic scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// Decimal logarithms of the ends.
    from: f64,
    to: f64,
    /// Places of the ends.
    start: f64,
    end: f64,
}

impl Scale {
    /// A scale around all positive finite `values`, ending at whole powers of ten or at a step between them.
    pub(super) fn around(values: impl Iterator<Item = f64>, start: f64, end: f64) -> Self {
        let logs = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| (low.min(log), high.max(log)));
        let (from, to) = if low <= high { (below(low), -below(-high)) } else { (0.0, 1.0) };
        Self { from, to: to.max(from + 2.0 * STEP), start, end }
    }

    /// With room below the lowest value: what begins at the end of the scale shall be seen.
    pub(super) fn with_room(self) -> Self {
        Self { from: self.from - STEP, ..self }
    }

    /// Where `value` lies; those beyond an end, at it.
    pub(super) fn at(&self, value: f64) -> f64 {
        let part = (value.max(f64::MIN_POSITIVE).log10() - self.from) / (self.to - self.from);
        self.start + part.clamp(0.0, 1.0) * (self.end - self.start)
    }

    /// The powers of ten on it, or if there is at most one, also twice and five times them.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let powers = |factors: &[f64]| -> Vec<f64> {
            let exponents = self.from.floor() as i32..=self.to.ceil() as i32;
            let all = exponents.flat_map(|exponent| factors.iter().map(move |f| f * 10_f64.powi(exponent)));
            all.filter(|tick| (self.from - SLACK..=self.to + SLACK).contains(&tick.log10())).collect()
        };
        let tens = powers(&[1.0]);
        if tens.len() > 2 { tens } else { powers(&[1.0, 2.0, 5.0]) }
    }
}

/// The ends of a scale are multiples of this: three steps for a power of ten.
const STEP: f64 = 1.0 / 3.0;

/// Rounding in logarithms.
const SLACK: f64 = 1e-9;

fn below(log: f64) -> f64 {
    ((log + SLACK) / STEP).floor() * STEP
}

/// A tick as people write it: 0.01, 1, 1000, 1 M.
pub(super) fn tick_name(value: f64) -> String {
    const MILLION: f64 = 1e6;
    match value {
        _ if value >= MILLION * (1.0 - SLACK) => format!("{} M", (value / MILLION).round()),
        _ if value >= 1.0 - SLACK => crate::report::spaced(value.round() as u64),
        _ => {
            let decimals = (-value.log10() - SLACK).ceil().max(0.0) as usize;
            format!("{value:.decimals$}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_find_their_places() {
        let scale = Scale::around([0.02, 3.0, 700.0, f64::NAN, 0.0].into_iter(), 100.0, 300.0);
        assert!(scale.at(0.02) >= 100.0 && scale.at(700.0) <= 300.0);
        assert!(scale.at(0.0) == 100.0 && scale.at(1e9) == 300.0);
        let names: Vec<String> = scale.ticks().into_iter().map(tick_name).collect();
        assert_eq!(names, ["0.01", "0.1", "1", "10", "100", "1000"]);
    }

    #[test]
    fn narrow_and_empty_scales_have_ticks() {
        for values in [vec![], vec![3.0], vec![1.2, 1.5], vec![1.0, 10.0]] {
            let scale = Scale::around(values.clone().into_iter(), 0.0, 1.0);
            assert!(!scale.ticks().is_empty(), "{values:?}: {scale:?}");
        }
        assert_eq!([0.02, 0.5, 2.0, 1e6].map(tick_name), ["0.02", "0.5", "2", "1 M"]);
    }
}
