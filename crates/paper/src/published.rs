//! The paper's own numbers, as printed, to set beside ours. Nothing here is ever shown as measured.

/// What the paper was measured on.
pub(crate) const MACHINE: &str = "AMD Athlon XP 2500+, 1 GB, Linux, GCC 3.4, 640 × 480";

/// Title, author and place.
pub(crate) const CITATION: &str = "Balázs Tóth, Speed optimized Recursive Ray-tracer with KD-Tree and SSE vector \
    mathematics, Budapest University of Technology and Economics";

/// A row of Table 1: rendering times in seconds by number of objects, where printed.
pub(crate) type Times = &'static [(u32, f64)];

/// Table 1, every ray against every object in scalar arithmetic.
pub(crate) const NAIVE: Times = &[(10, 2.2), (1_000, 161.5)];
/// Table 1, the same with SSE.
pub(crate) const SSE: Times = &[(10, 1.1), (1_000, 142.4)];
/// Table 1, kd-tree and SSE.
pub(crate) const KD: Times = &[(10, 0.1), (1_000, 3.5), (50_000, 6.3)];
/// Table 1, kd-tree, SSE and regions.
pub(crate) const KD_REGION: Times = &[(10, 0.1), (1_000, 3.1), (50_000, 5.8)];

/// Table 2: seconds by the side of a region in pixels. The scene is not named.
pub(crate) const REGIONS: Times = &[(1, 1.78), (16, 1.69), (32, 1.45), (64, 1.30), (128, 1.5)];

/// Table 3: 50 million vector multiplications; printed in microseconds, which cannot be right.
pub(crate) const MULTIPLICATIONS: [f64; 3] = [409.0, 249.0, 221.0];

/// Table 4: seconds of 50 million normalisations.
pub(crate) const NORMALISATIONS: [f64; 3] = [4.6, 1.6, 1.4];

/// The entry for `key`.
pub(crate) fn at(times: Times, key: u32) -> Option<f64> {
    times.iter().find(|(known, _)| *known == key).map(|&(_, seconds)| seconds)
}
