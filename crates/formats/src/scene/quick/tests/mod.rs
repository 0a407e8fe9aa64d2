//! The quick ways answer as the oracles do, or not at all; and they do answer for what scenes consist of.

mod json;
mod toml;

use whitted::math::SplitMix64;

use crate::scene::{Language, SceneFile, sections_of};

/// What the oracle reads, places included; none if something is wrong.
fn oracle(language: &Language, text: &str) -> Option<SceneFile> {
    let document = (language.parse)(text).ok()?;
    document.get("version")?;
    sections_of(document).ok()
}

/// Checks that the quick way says nothing else than the oracle. Tells whether each of them has an answer.
#[track_caller]
fn compare(language: &Language, text: &str) -> (bool, bool) {
    let written = |file: SceneFile| format!("{file:?}");
    let (quick, oracle) = ((language.quick)(text).map(written), oracle(language, text).map(written));
    if quick.is_some() {
        assert_eq!(quick, oracle, "{text}");
    }
    (quick.is_some(), oracle.is_some())
}

/// Compares a sample with random changes: removed parts, and pieces put in wherever `fits` allows by the text before.
#[track_caller]
fn check_changes(language: &Language, sample: &str, pieces: &[&str], fits: impl Fn(&str) -> bool) {
    const RUNS: usize = 20_000;
    let mut random = SplitMix64::new(7);
    let (mut understood, mut right) = (0, 0);
    for _ in 0..RUNS {
        let mut text = sample.to_owned();
        for _ in 0..=random.below(3) {
            let at = at_any_character(&text, &mut random);
            let end = at_any_character(&text, &mut random).clamp(at, text.len().min(at + 8));
            let end = (end..).find(|&end| text.is_char_boundary(end)).unwrap_or(at);
            match random.below(3) {
                0 => text.replace_range(at..end, ""),
                _ => {
                    let at = (at..text.len()).find(|&at| text.get(..at).is_some_and(&fits)).unwrap_or(at);
                    text.insert_str(at, pieces[random.below(pieces.len() as u32) as usize]);
                }
            }
        }
        let (is_understood, is_right) = compare(language, &text);
        understood += usize::from(is_understood);
        right += usize::from(is_right);
    }
    println!("{understood} understood of {right} right ones of {RUNS}");
    assert!(right > RUNS / 20 && understood > right * 4 / 5);
}

/// Compares texts of pieces in any order, some of them more than once: fewer than `most` in a text.
#[track_caller]
fn check_orders(language: &Language, pieces: &[&str], [before, after]: [&str; 2], most: u32) {
    const RUNS: usize = 20_000;
    let mut random = SplitMix64::new(8);
    let mut right = 0;
    for _ in 0..RUNS {
        let mut text = before.to_owned();
        (0..random.below(most)).for_each(|_| text.push_str(pieces[random.below(pieces.len() as u32) as usize]));
        text.push_str(after);
        right += usize::from(compare(language, &text).1);
    }
    println!("{right} right ones of {RUNS}");
    assert!(right > RUNS / 20);
}

fn at_any_character(text: &str, random: &mut SplitMix64) -> usize {
    let at = random.below(text.len() as u32 + 1) as usize;
    (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}
