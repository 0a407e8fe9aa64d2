//! Dependency arrows: between the modules of the library, and between the crates.

use super::Complaint;
use super::source::{Source, closing, is_identifier};

const LIBRARY: &str = "crates/whitted/src/";

/// The library's modules by layer: a module may name its own and every lower layer, never a neighbour or a higher one.
const LAYERS: &[&[&str]] =
    &[&["math"], &["ray"], &["geometry"], &["tree", "shading"], &["scene", "query", "classic"], &["render"]];

/// Each crate with the crates of this workspace that it may depend on.
const CRATES: &[(&str, &[&str])] = &[
    ("simd", &[]),
    ("whitted", &["simd"]),
    ("formats", &["simd", "whitted"]),
    ("paper", &["simd", "whitted", "formats"]),
    ("viewer", &["simd", "whitted"]),
    ("cli", &["simd", "whitted", "formats", "paper", "viewer"]),
];

/// Checks the arrows inside the library; tests may use any layer.
pub(super) fn check(source: &Source) -> Vec<Complaint> {
    let Some(inner) = source.path.strip_prefix(LIBRARY) else { return Vec::new() };
    let module = inner.split('/').next().unwrap_or(inner).trim_end_matches(".rs");
    if module == "lib" {
        return Vec::new();
    }
    let Some(layer) = layer_of(module) else {
        return vec![
            source.complaint(0, format!("module `{module}` has no layer: give it one in xtask/src/tidy/layers.rs")),
        ];
    };
    let wrong = |&(_, target): &(usize, &str)| {
        target != module && layer_of(target).is_none_or(|target_layer| target_layer >= layer)
    };
    root_paths(source)
        .into_iter()
        .filter(|&(at, _)| !source.is_test(at))
        .filter(wrong)
        .map(|(at, target)| source.complaint(at, explain(module, target)))
        .collect()
}

fn layer_of(module: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&module))
}

fn explain(module: &str, target: &str) -> String {
    match layer_of(target) {
        Some(_) => format!("`{module}` may not use `{target}`: arrows are {}", arrows()),
        None => format!("`crate::{target}` hides a layer: name it by its module, `crate::module::{target}`"),
    }
}

fn arrows() -> String {
    LAYERS.iter().map(|layer| layer.join(", ")).collect::<Vec<_>>().join(" ← ")
}

/// Every first name below `crate::`, also inside `crate::{a, b::c}`, with its offset.
fn root_paths<'s>(source: &'s Source) -> Vec<(usize, &'s str)> {
    let masked = &source.masked;
    let mut found = Vec::new();
    for at in source.find_word("crate") {
        let Some(tail) = masked[at..].strip_prefix("crate::") else { continue };
        let start = masked.len() - tail.len();
        match tail.as_bytes().first() {
            Some(b'{') => found.extend(group_names(masked, start)),
            _ => found.push((start, leading_name(tail))),
        }
    }
    found.retain(|(_, name)| !name.is_empty());
    found
}

/// The first name of each entry of the `{…}` group that opens at `open`.
fn group_names(masked: &str, open: usize) -> Vec<(usize, &str)> {
    let end = closing(masked, open);
    let (mut names, mut depth, mut expects_name) = (Vec::new(), 0, true);
    for (at, c) in masked[..end].char_indices().skip_while(|&(at, _)| at < open) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 1 => expects_name = true,
            c if depth == 1 && expects_name && is_identifier(c) => {
                names.push((at, leading_name(&masked[at..])));
                expects_name = false;
            }
            _ => {}
        }
    }
    names
}

fn leading_name(text: &str) -> &str {
    &text[..text.find(|c| !is_identifier(c)).unwrap_or(text.len())]
}

/// Checks the `[dependencies]` of a crate's manifest against [`CRATES`]; development dependencies are free.
pub(super) fn check_manifest(path: &str, text: &str) -> Vec<Complaint> {
    let Some(name) = path.strip_prefix("crates/").and_then(|inner| inner.strip_suffix("/Cargo.toml")) else {
        return Vec::new();
    };
    let allowed = CRATES.iter().find(|(known, _)| *known == name).map_or(&[][..], |(_, allowed)| *allowed);
    let is_own = |dependency: &str| CRATES.iter().any(|(known, _)| *known == dependency);
    let mut section = "";
    let mut complaints = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.starts_with('[') {
            section = line.trim();
            continue;
        }
        let dependency = leading_name(line);
        if section == "[dependencies]" && is_own(dependency) && !allowed.contains(&dependency) {
            let message = format!("crate `{name}` may not depend on `{dependency}`");
            complaints.push(Complaint { path: path.to_owned(), line: index + 1, message });
        }
    }
    complaints
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(path: &str, text: &str) -> Vec<String> {
        check(&Source::new(path, text)).iter().map(|complaint| complaint.message.clone()).collect()
    }

    #[test]
    fn lower_layers_and_the_own_module_are_free() {
        let text =
            "use crate::math::Vec3;\nuse crate::{ray::Ray, geometry::{Aabb, shading_of}};\nuse crate::tree::Node;\n";
        assert_eq!(messages("crates/whitted/src/tree/build/sah.rs", text), [] as [&str; 0]);
    }

    #[test]
    fn higher_layers_and_neighbours_are_refused() {
        for text in
            ["use crate::render::Film;", "use crate::{math::Vec3, shading::Light};", "fn f(s: &crate::scene::S) {}"]
        {
            assert_eq!(messages("crates/whitted/src/tree/mod.rs", text).len(), 1, "{text}");
        }
    }

    #[test]
    fn tests_lib_and_other_crates_are_exempt() {
        let text = "#[cfg(test)]\nmod tests { use crate::render::Film; }\n";
        assert!(messages("crates/whitted/src/tree/mod.rs", text).is_empty());
        assert!(messages("crates/whitted/src/lib.rs", "pub use crate::render::render;").is_empty());
        assert!(messages("crates/cli/src/args.rs", "use crate::render::run;").is_empty());
    }

    #[test]
    fn unknown_modules_and_root_re_exports_are_named() {
        assert!(messages("crates/whitted/src/util.rs", "")[0].contains("has no layer"));
        assert!(messages("crates/whitted/src/tree/mod.rs", "use crate::Scene;")[0].contains("hides a layer"));
    }

    #[test]
    fn manifests_keep_the_crate_order() {
        let bad =
            "[dependencies]\nsimd.workspace = true\nformats.workspace = true\n[dev-dependencies]\nformats = \"1\"\n";
        let complaints = check_manifest("crates/whitted/Cargo.toml", bad);
        assert_eq!(complaints.iter().map(|c| c.line).collect::<Vec<_>>(), [3]);
        assert!(check_manifest("crates/cli/Cargo.toml", bad).is_empty());
    }
}
