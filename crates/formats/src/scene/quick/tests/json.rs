//! JSON.

use super::{check_changes, check_orders, compare};
use crate::scene::JSON;

/// A scene that uses most of what scenes in JSON have, in a way that is not left to the oracle.
const SAMPLE: &str = r##"{ "version": 1,
"render": {"size": [32, 16], "depth": 3, "exposure": 1.5e0, "aa": "edge", "background": "#102030"},
"camera": {"a b": {"eye": [0.5e-1, -0, 50], "look_at": [0, 16, 1E2]}, "\u0062": {"eye": [1, 2, 3], "look_at": [0, 0, 0]}},
"light": [{"p\u006fint": [1, -2.5, 3], "falloff": "inverse-square"}, {"spot": [0, 1, 0], "look_at": [0, 0, 0], "color": "#aa\u0030000", "inner": null}],
"material": {"glass": {"color": {"checker": [[1, 1, 1], "#aa00ff"], "size": 2}, "transmit": 0.9, "ior": 1.5}, "g": {"specular": {"exponent": 9}}, "é": {}},
"sphere": [
    {"center": [0, 0.5, -0.0], "radius": 0.5e0, "material": "glass"},
	{ "radius" : 2 , "center" : [ 1.25 , -0 , 7.000000000000000000001 ] , "material" : "\u0067" } ,
    {"material": null, "radius": 123456789012345678901, "center": [1.7976931348623157e308, 9007199254740993, 5e-324]}
],
"plane": [{"point": [0, 0, 0]}, {"point": [0, 1, 0], "normal": [0, -1, 0], "material": "é"}],
"disc": [{"center": [0, 0, 0], "radius": 1, "inner_radius": 0.25}],
"box": [{"min": [0, 0, 0], "max": [1, 1, 1]}],
"cylinder": [{"base": [0, 0, 0], "apex": [0, 1, 0], "radius": 1, "capped": false}],
"cone": [{"base": [0, 0, 0], "apex": [0, 1, 0], "base_radius": 1, "capped": null}],
"mesh": [{"file": "a.ply", "smooth": true, "rotate": {"axis": [0, 0, 1], "angle": 90}}, {"file": "b.ply", "rotate": [1, 2, 3], "scale": 2}],
"generate": [{"per_edge": 2, "materials": ["g", "glass"], "kind": "grid"}]}"##;

/// Texts that fit between the parts of others, and hurt. The first ones are entries of scenes.
const PIECES: [&str; 48] = [
    r#""sphere": [],"#,
    r#""sphere": [{"center": [0, 0, 0], "radius": 1}, {"center": [0, 0, 0], "radius": 2}],"#,
    r#""sphere": [[[0, 0, 0], 1, null]],"#,
    r#""sphere": {},"#,
    r#""sphere": null,"#,
    r#""plane": [{"point": [0, 0, 0]}],"#,
    r#""generate": [],"#,
    r#""generate": [{"kind": "sphereflake", "depth": 1}],"#,
    r#""material": {},"#,
    r#""material": [],"#,
    r#""material": {"x": {}, "x": {}},"#,
    r#""camera": {"eye": [0, 0, 1], "look_at": [0, 0, 0]},"#,
    r#""camera": [],"#,
    r#""render": {"seed": 1, "seed": 1},"#,
    r#""light": [{"direction": [0, 0, 1]}],"#,
    r#""unknown": [],"#,
    r#""unknown": 1,"#,
    r#""version": 1,"#,
    r#""\u0064isc": [],"#,
    r#"{"center": [0, 0, 0], "radius": 1},"#,
    r#"{"center": [0, 0, 0], "radius": 1, "radius": 1},"#,
    r#"[[0, 0, 0], 1, "g"],"#,
    r#""\u0063apped": true,"#,
    r#""capped": true,"#,
    r#""material": "g","#,
    r#""material": null,"#,
    r#""falloff": {"none": null},"#,
    r#""radius": 2,"#,
    r#""kind": "grid","#,
    "\"",
    "\\",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\n",
    "\r",
    " ",
    "\u{b}",
    "0",
    "-",
    "-0,",
    "1e999,",
    "NaN,",
    "null,",
    "[],",
];

#[test]
fn what_scenes_consist_of_is_read() {
    assert_eq!(compare(&JSON, SAMPLE), (true, true));
    assert_eq!(compare(&JSON, &SAMPLE.replace('\n', "\r\n")), (true, true));
    assert_eq!(compare(&JSON, r#"{"version": 1}"#), (true, true));
}

#[test]
fn places_are_those_of_the_text() {
    let file = (JSON.quick)(SAMPLE).unwrap();
    let names = [&file.sphere[0].material, &file.sphere[1].material];
    let places = names.map(|name| &SAMPLE[name.as_ref().unwrap().span.clone()]);
    assert_eq!(places, ["\"glass\"", "\"\\u0067\""]);
    assert_eq!(&SAMPLE[file.boxes[0].span.clone()], r#"{"min": [0, 0, 0], "max": [1, 1, 1]}"#);
}

#[test]
fn what_is_unusual_is_left_to_the_oracle() {
    assert_eq!(compare(&JSON, r#"{"version": 1, "\u0073phere": []}"#), (false, true));
}

#[test]
fn what_is_wrong_is_left_to_the_oracle() {
    for entry in [
        r#""unknown": []"#,
        r#""unknown": 1"#,
        r#""material": []"#,
        r#""material": {"a": {}, "a": {}}"#,
        r#""camera": []"#,
        r#""sphere": {}"#,
        r#""sphere": null"#,
        r#""sphere": [], "sphere": []"#,
        r#""render": {}, "render": {}"#,
        r#""sphere": [{"center": [0, 0, 0]}]"#,
        r#""sphere": [{"center": [0, 0], "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, 0, 0], "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, 01], "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, NaN], "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, "0"], "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, 1e999], "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, 0], "radius": true}]"#,
        r#""sphere": [{"center": [0, 0, 0], "radius": 1, "radius": 1}]"#,
        r#""sphere": [{"center": [0, 0, 0], "radius": 1, "x": 1}]"#,
        r#""sphere": [{"center": [0, 0, 0], "radius": 1, "material": 1}]"#,
        r#""sphere": [{"center": [0, 0, 0], "radius": 1},]"#,
        r#""sphere": [{"center": [0, 0, 0], "radius": 1} {"center": [0, 0, 0], "radius": 1}]"#,
        r#""light": [{"point": [0, 0, 0], "falloff": {"none": null}}]"#,
        r#""mesh": [{"file": "a", "rotate": {"axis": [0, 0, 1], "axis": [0, 0, 1], "angle": 9}}]"#,
    ] {
        let text = format!("{{\"version\": 1, {entry}}}");
        assert_eq!(compare(&JSON, &text), (false, false), "{entry}");
    }
    for text in
        ["", "1", "[]", "{}", r#"{"version": 1"#, r#"{"version": 1} 1"#, r#"{"version": 1,}"#, r#"{"sphere": []}"#]
    {
        assert_eq!(compare(&JSON, text), (false, false), "{text}");
    }
    let nested = ["[", "{\"center\":"].map(|open| format!("{{\"version\": 1, \"sphere\": [{}", open.repeat(100_000)));
    nested.iter().for_each(|text| assert_eq!(compare(&JSON, text), (false, false)));
}

#[test]
fn random_changes_make_no_difference() {
    check_changes(&JSON, SAMPLE, &PIECES, |before| before.ends_with(['{', '[', ',']));
}

#[test]
fn random_orders_make_no_difference() {
    check_orders(&JSON, &PIECES[..19], ["{", "\"version\": 1}"], 4);
}
