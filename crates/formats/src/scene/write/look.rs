//! From changed values to changed text, section by section.

use whitted::scene::{Antialias, Background, Camera, Sampling, Scene, Shadows, Tone};

use super::literal::{color, list, number, point, single, word};
use super::patch::Patch;
use crate::scene::document::{Fault, Node};

/// A key and its new value, if that is another one.
pub(super) type Entry = (&'static str, Option<String>);

/// `value` of `new` where it differs from that of `old`.
pub(super) fn changed<S, T: PartialEq>(
    old: &S,
    new: &S,
    value: impl Fn(&S) -> T,
    write: impl Fn(T) -> String,
) -> Option<String> {
    (value(old) != value(new)).then(|| write(value(new)))
}

/// Set all entries that have a new value.
pub(super) fn set_all(
    patch: &mut Patch,
    table: &Node<'_>,
    entries: impl IntoIterator<Item = Entry>,
) -> Result<(), Fault> {
    entries.into_iter().try_for_each(|(key, value)| match value {
        Some(value) => patch.set(table, key, value),
        None => Ok(()),
    })
}

/// The keys of a camera, where `new` differs from `old`.
pub(super) fn camera(old: &Camera, new: &Camera) -> [Entry; 4] {
    [
        ("eye", changed(old, new, |camera| camera.eye, point)),
        ("look_at", changed(old, new, |camera| camera.look_at, point)),
        ("up", changed(old, new, |camera| camera.up, point)),
        ("vfov", changed(old, new, |camera| camera.vfov, number)),
    ]
}

/// All keys of a new camera that differ from the default.
pub(super) fn whole_camera(camera: &Camera) -> Vec<(&'static str, String)> {
    let default = Camera::default();
    let mut entries = vec![("eye", point(camera.eye)), ("look_at", point(camera.look_at))];
    let others = [
        ("up", changed(&default, camera, |camera| camera.up, point)),
        ("vfov", changed(&default, camera, |camera| camera.vfov, number)),
    ];
    entries.extend(others.into_iter().filter_map(|(key, value)| Some((key, value?))));
    entries
}

/// The keys of `[render]`, where `new` differs from `old`.
pub(super) fn render(old: &Scene, new: &Scene) -> [Entry; 12] {
    let (a, b) = (&old.settings, &new.settings);
    let whole = |value: u32| value.to_string();
    [
        ("size", changed(a, b, |s| s.size, |size| list(size.map(whole)))),
        ("depth", changed(a, b, |s| s.depth, whole)),
        ("min_weight", changed(a, b, |s| s.min_weight, single)),
        ("aa", changed(a, b, |s| s.antialias, antialias)),
        ("aa_max", changed(a, b, |s| s.antialias_max, whole)),
        ("sampling", changed(a, b, |s| s.sampling, sampling)),
        ("shadows", changed(a, b, |s| s.shadows, shadows)),
        ("exposure", changed(a, b, |s| s.exposure, single)),
        ("tone", changed(a, b, |s| s.tone, tone)),
        ("seed", changed(a, b, |s| s.seed, whole)),
        ("background", changed(old, new, |scene| scene.background, background)),
        ("ambient", changed(old, new, |scene| scene.ambient, color)),
    ]
}

fn antialias(antialias: Antialias) -> String {
    match antialias {
        Antialias::Off => word("off"),
        Antialias::Paper => word("paper"),
        Antialias::Edge => word("edge"),
        Antialias::Uniform(samples) => samples.to_string(),
    }
}

fn sampling(sampling: Sampling) -> String {
    word(match sampling {
        Sampling::Centers => "centers",
        Sampling::Corners => "corners",
    })
}

fn shadows(shadows: Shadows) -> String {
    word(match shadows {
        Shadows::Filter => "filter",
        Shadows::Opaque => "opaque",
    })
}

fn tone(tone: Tone) -> String {
    word(match tone {
        Tone::Clamp => "clamp",
        Tone::Reinhard => "reinhard",
        Tone::Linear => "linear",
    })
}

fn background(background: Background) -> String {
    match background {
        Background::Color(flat) => color(flat),
        Background::Gradient { down, up } => format!("{{ up = {}, down = {} }}", color(up), color(down)),
    }
}
