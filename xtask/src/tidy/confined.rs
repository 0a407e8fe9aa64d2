//! Words that may stand in one crate only.

use super::Complaint;
use super::source::Source;

/// The crate that confines `unsafe` and everything that knows an instruction set.
const SIMD: &str = "crates/simd/";

/// Files that call foreign code, which cannot be had without `unsafe`.
const FOREIGN_EDGES: &[&str] = &["bench/src/embree.rs"];

const CONFINED: &[(&str, &str)] = &[
    ("unsafe", "`unsafe` belongs in crates/simd: offer the operation there behind a safe function"),
    ("target_feature", "instruction sets belong in crates/simd: write a kernel and call `simd::dispatch`"),
    ("is_x86_feature_detected", "detection belongs in crates/simd: ask `simd` for its level"),
    ("target_arch", "`cfg(target_arch)` belongs in crates/simd: if a kernel needs it, the lane vocabulary is wrong"),
];

pub(super) fn check(source: &Source) -> Vec<Complaint> {
    if source.path.starts_with(SIMD) || FOREIGN_EDGES.contains(&source.path) {
        return Vec::new();
    }
    let offences = CONFINED.iter().flat_map(|(word, message)| source.find_word(word).map(move |at| (at, message)));
    offences.map(|(at, message)| source.complaint(at, *message)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(path: &str, text: &str) -> Vec<usize> {
        check(&Source::new(path, text)).iter().map(|complaint| complaint.line).collect()
    }

    #[test]
    fn unsafe_and_isa_words_stay_in_simd() {
        let text = "// unsafe\nunsafe {}\n#[target_feature(enable = \"avx2\")]\n#[cfg(target_arch = \"x86\")]\n";
        assert_eq!(lines("crates/whitted/src/math.rs", text), [2, 3, 4]);
        assert_eq!(lines("crates/simd/src/avx2.rs", text), []);
        assert_eq!(lines("bench/src/embree.rs", text), []);
        assert_eq!(lines("crates/whitted/src/lib.rs", "#![forbid(unsafe_code)]\n"), []);
    }
}
