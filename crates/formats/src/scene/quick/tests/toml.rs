//! TOML.

use super::{check_changes, check_orders, compare};
use crate::scene::TOML;

/// A scene that uses most of what TOML allows, in a way that is not left to the oracle.
const SAMPLE: &str = "# A comment: [[sphere]]\nversion = 1\nrender.exposure = +1.5e+0\nrender.\"depth\" = 3\n\
    plane = [{ point = [0, 0, 0] }, { point = [0, 1, 0], normal = [0, -1, 0] }, ]\r\n\r\n\t[camera . 'a b']\n\
    eye = [ 0.5e-1, -0, 5_0, # five\n ]\nlook_at = [\n 0, 0x10\n, 1E2] # there\n[camera.b]\neye=[1,2,3]\n\
    look_at=[0,0,0]\n[[light]]\npoint = [1, -2.5, 3]\nfalloff = \"inverse-square\"\n[material.glass]\n\
    color = { checker = [[1, 1, 1], \"#aa00ff\"], size = 2 }\ntransmit = 0.9\nior = 1.5\n[material.\"g\"]\n\
    color = \"\\u0023ffffff\"\n[material.g.specular]\nexponent = 9\n[[sphere]]\ncenter = [0, 0.5, 0]\nradius = 0.5e0\n\
    material = \"glass\"\n[[sphere]]\nradius = 2\ncenter = [1.25, 0, 7]\nmaterial = '''g'''\n[[cylinder]]\n\
    base = [0, 0, 0]\napex = [0, 1, 0]\nradius = 1\ncapped = false\n[[cone]]\nbase = [0, 0, 0]\n\
    apex = [0, 1, 0]\nbase_radius = 1\n[[disc]]\ncenter = [0, 0, 0]\nradius = 1\n[[box]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[material.late]\ncolor = \"#ffffff\"\n[[mesh]]\n\
    file = \"\"\"a\\\n  .ply\"\"\"\n[mesh.rotate]\naxis = [0, 0, 1]\nangle = 90\n[[sphere]]\ncenter = [0, 0, 0]\n\
    radius = 1\n[[generate]]\nkind = \"grid\"\nper_edge = 2\nmaterials = [\"g\", 'glass']";

/// Texts that fit between the parts of others, and hurt.
const PIECES: [&str; 40] = [
    "\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n",
    "\n[material.x]\n",
    "\n[material]\n",
    "\n[material.x.specular]\nexponent = 3\n",
    "\n[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\n",
    "\n[camera.y]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\n",
    "\n[render]\n",
    "\n[mesh.rotate]\naxis = [1, 0, 0]\nangle = 1\n",
    "\n[sphere]\n",
    "\n[sphere.x]\n",
    "\n[[material]]\n",
    "\n[[light]]\npoint.x = 1\n",
    "\nmaterial.x.color = \"#ffffff\"\n",
    "\nmaterial.x = {}\n",
    "\nsphere = []\n",
    "\ncolor = \"#ffffff\"\n",
    "\nmaterial = \"g\"\n",
    "\nversion = 1\n",
    "\n# é\u{7f}\n",
    "\n# é [[sphere]]\r\n",
    "'''",
    "\"\"\"",
    "\"",
    "'",
    "\\",
    "[",
    "]",
    "{",
    "}",
    ",",
    "=",
    ".",
    "\r",
    "\n",
    " ",
    "0",
    "1e999",
    "_",
    "inf",
    "1979-05-27 07:32:00",
];

#[test]
fn what_scenes_consist_of_is_read() {
    assert_eq!(compare(&TOML, SAMPLE), (true, true));
    assert_eq!(compare(&TOML, &SAMPLE.replace("\r\n", "\n").replace('\n', "\r\n")), (true, true));
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
    let scenes = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes = scenes.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let read = scenes.map(|path| std::fs::read_to_string(path).unwrap()).map(|text| compare(&TOML, &text));
    assert!(read.inspect(|read| assert_eq!(*read, (true, true))).count() >= 10);
}

#[test]
fn what_is_unusual_is_left_to_the_oracle() {
    let camera = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    for unusual in [
        "[material.a]\n[render]\n[material.a.specular]\nexponent = 9\n",
        "[[mesh]]\nfile = \"a\"\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n[mesh.rotate]\naxis = [1, 0, 0]\nangle = 9\n",
        "[material.\"\\u0061\"]\n",
    ] {
        assert_eq!(compare(&TOML, &format!("version = 1\n{camera}{unusual}")), (false, true), "{unusual}");
    }
}

#[test]
fn what_is_wrong_is_left_to_the_oracle() {
    let entries = [
        "a = 1",
        "seed = 01",
        "seed = 1_",
        "seed = 1__0",
        "seed = 1.",
        "seed = .5",
        "seed = 1e",
        "seed = 1 2",
        "seed = 1979-05-27",
        "seed = 9223372036854775808",
        "seed = [1, , 2]",
        "seed = [,]",
        "seed = {,}",
        "seed = { a = 1, a = 2 }",
        "seed = \"a\nb\"",
        "seed = \"\\q\"",
        "seed =\n1",
        "seed\n= 1",
        "seed = 1\rsize = 2",
        "seed = 1 # \u{1}",
        "seed = 1\nseed = 2",
        "size = [1, 2] size = 3",
        "\"\"\"seed\"\"\" = 1",
        "[render]",
        "[[render]]",
        "[render ]]",
        "[[sphere] ]\ncenter = [0, 0, 0]\nradius = 1",
        "[]",
        "[a",
        "aa.x = 1\naa = 2",
        "background.up = 1\nseed = 1\nbackground.up = 2",
    ];
    for entry in entries {
        let text = format!("version = 1\n[render]\n{entry}\n");
        assert_eq!(compare(&TOML, &text), (false, false), "{entry}");
    }
    for scene in ["[render]\n", "version = 1\nunknown = []\n", "version = 1\nmaterial = []\n"] {
        assert_eq!(compare(&TOML, scene), (false, false), "{scene}");
    }
    let nested = format!("version = 1\nsphere = {}", "[".repeat(100_000));
    assert_eq!(compare(&TOML, &nested), (false, false));
}

#[test]
fn random_changes_make_no_difference() {
    check_changes(&TOML, SAMPLE, &PIECES, |_| true);
}

#[test]
fn random_orders_make_no_difference() {
    check_orders(&TOML, &PIECES[..20], ["version = 1\n", ""], 6);
}
