//! Files cut off, changed and mixed at random, with fixed seeds: the answer is a scene or an error, never a panic.

use std::path::Path;
use std::time::{Duration, Instant};

use formats::{Format, LoadOptions};
use whitted::math::SplitMix64;

/// Small files that use all of their format.
const SAMPLES: [(Format, &[u8]); 6] = [
    (
        Format::Toml,
        b"version = 1\n[camera.a]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[render]\nsize = [64, 48]\naa = 4\n\
          background = { up = \"#ffffff\", down = [0, 0, 0.5] }\n[[light]]\nspot = [1, 2, 3]\nlook_at = [0, 0, 0]\n\
          [material.glass]\ncolor = { checker = [[1, 1, 1], \"#aa00ff\"], size = 2 }\nreflect = \"fresnel\"\n\
          transmit = 0.9\nior = 1.5\nabsorb = { color = [0.5, 0.5, 1], distance = 2.0 }\nspecular = { exponent = 9 }\n\
          [[sphere]]\ncenter = [0, 0.5, 0]\nradius = 0.5e0\nmaterial = \"glass\"\n[[cone]]\nbase = [0, 0, 0]\n\
          apex = [0, 1, 0]\nbase_radius = 1\n[[mesh]]\nfile = \"a/../b.ply\"\n[[generate]]\nkind = \"grid\"\nper_edge = 2\n",
    ),
    (
        Format::Json,
        br##"{"version": 1, "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0], "vfov": 4e1},
        "render": {"size": [64, 48], "background": "#ffffff", "seed": null},
        "light": [{"point": [1, -2.5, 3], "falloff": "inverse-square"}],
        "material": {"a\u0020b": {"reflect": {"strength": 0.5, "model": "schlick"}}},
        "sphere": [{"center": [0, 0, 0], "radius": 1, "material": "a b"}],
        "generate": [{"kind": "sphereflake", "depth": 1}, {"kind": "sphere-cube", "count": 10, "fill": 0.1}]}"##,
    ),
    (
        Format::Nff,
        b"# all of NFF\nb 0.1 0.2 0.3\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.01\nresolution 64 64\n\
          l 1 2 3\nl 3 2 1 0.5 0.5 1\nf 1 0.5 0 0.8 0.2 10 0.5 1.5\ns 0 0 0 1\nc\n0 0 0 1\n0 1 0 0.5\nc 0 0 0 1 1 1 1 1\n\
          p 5\n-1 -1 0\n1 -1 0\n0 0 0\n1 1 0\n-1 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 1 0\n0 1 0 1 0 0\ntess 4\n",
    ),
    (
        Format::Obj,
        b"# all of OBJ\r\nmtllib a.mtl b.mtl\r\no thing\ng part\nv 0 0 0\nv 1 0 0 \\\n1\rv .5 1e0 -0\nv -1 0 +2\nvt 0.5 0.25\n\
          vn 0 0 1\nusemtl red\nf 1/1/1 2//1 3/1 4\nf -1 -2 -3\ns off\nl 1 2\n",
    ),
    (
        Format::Ply,
        b"ply\nformat ascii 1.0\ncomment all of PLY\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n\
          property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nelement face 2\n\
          property list uchar int vertex_indices\nproperty list uchar float texcoord\nelement tristrips 1\n\
          property list int int vertex_indices\nend_header\n0 0 0 0 0 1 255\n1 0 0 0 0 1 0\n1 1 0 0 0 1 0\n\
          0 1 0 0 0 1 0\n4 0 1 2 3 0\n3 0 1 2 2 0.5 0.5\n5 0 1 2 -1 3\n",
    ),
    (
        Format::Ply,
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty short y\nproperty uchar z\n\
          element face 1\nproperty list uchar ushort vertex_index\nend_header\n\0\0\x80\x3f\x01\x00\x02\0\0\0\0\x05\x00\x06\
          \0\0\0\x40\0\0\0\x03\0\0\x01\0\x02\0",
    ),
];

/// What fits between the parts of any format, and what hurts.
const WORDS: [&[u8]; 24] = [
    b"0",
    b"-1",
    b"1e999",
    b"nan",
    b"4294967295",
    b"18446744073709551616",
    b"-9223372036854775808",
    b"1e-320",
    b"\0",
    b"\xff",
    b"\n",
    b"\r",
    b" ",
    b"[",
    b"{",
    b"\"",
    b"\\",
    b"#",
    b"/",
    b"=",
    b"element face 99999999999\n",
    b"p 999999\n",
    b"f 1/1 2 3\n",
    b"[[generate]]\n",
];

fn parse(format: Format, bytes: Vec<u8>) -> bool {
    const LONGEST: Duration = Duration::from_secs(5);
    let options = LoadOptions { max_generated: 10_000, ..LoadOptions::default() };
    let start = Instant::now();
    let result = formats::parse(format, Path::new("t"), bytes, &options);
    assert!(start.elapsed() < LONGEST);
    if let Err(error) = &result {
        let text = error.to_string();
        assert!(text.starts_with("t:") && !text.lines().next().unwrap().ends_with(' '), "{text:?}");
    }
    result.is_ok()
}

/// One to eight random changes.
fn mutate(bytes: &mut Vec<u8>, random: &mut SplitMix64) {
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len() as u32 + 1) as usize;
        let length = random.below(16) as usize;
        let end = (at + length).min(bytes.len());
        match random.below(6) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            1 if at < bytes.len() => bytes[at] = random.next_u64() as u8,
            2 => drop(bytes.drain(at..end)),
            3 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len() as u32 + 1) as usize;
                drop(bytes.splice(to..to, copy));
            }
            4 => bytes.truncate(at.max(1)),
            _ => drop(bytes.splice(at..end, WORDS[random.below(WORDS.len() as u32) as usize].iter().copied())),
        }
        if bytes.is_empty() {
            bytes.push(b' ');
        }
    }
}

#[test]
fn the_samples_are_right() {
    for (format, sample) in SAMPLES {
        let result = formats::parse(format, Path::new("t"), sample.to_vec(), &LoadOptions::default());
        match result {
            Ok(_) => {}
            // The one fault that a sample in memory cannot avoid.
            Err(e) => assert!(e.to_string().contains("cannot name files"), "{e}"),
        }
    }
}

#[test]
fn files_cut_off_anywhere_are_answered() {
    for (format, sample) in SAMPLES {
        (0..sample.len()).for_each(|end| {
            parse(format, sample[..end].to_vec());
        });
    }
}

#[test]
fn every_bit_may_flip() {
    for (format, sample) in SAMPLES {
        for bit in 0..8 * sample.len() {
            let mut bytes = sample.to_vec();
            bytes[bit / 8] ^= 1 << (bit % 8);
            parse(format, bytes);
        }
    }
}

#[test]
fn random_changes_are_answered() {
    const RUNS: usize = 20_000;
    for (number, (format, sample)) in SAMPLES.into_iter().enumerate() {
        let mut random = SplitMix64::new(number as u64);
        let accepted = (0..RUNS).filter(|_| {
            let mut bytes = sample.to_vec();
            mutate(&mut bytes, &mut random);
            parse(format, bytes)
        });
        let accepted = accepted.count();
        println!("{format:?}: {accepted} of {RUNS} accepted");
        assert!(accepted < RUNS, "changes must do something");
    }
}

#[test]
fn bytes_of_one_format_are_answered_by_all() {
    for (_, sample) in SAMPLES {
        for (_, format) in Format::ALL {
            parse(format, sample.to_vec());
        }
    }
}

#[test]
fn claims_of_gigabytes_are_refused_at_once() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let ply = |count: &str, format: &str| {
        let header = format!("ply\nformat {format} 1.0\nelement vertex {count}\n{xyz}element face {count}\n");
        format!("{header}property list uint int vertex_indices\nend_header\n0 0 0 0 0 0 0 0 0 0 0 0 0")
    };
    for count in ["4294967295", "4000000000", "18446744073709551615", "1000000000000"] {
        for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
            assert!(!parse(Format::Ply, ply(count, format).into_bytes()));
        }
        let polygon = format!("v from 0 0 1 at 0 0 0 up 0 1 0 angle 9\np {count} 0 0 0 1 0 0");
        assert!(!parse(Format::Nff, polygon.into_bytes()));
    }
    // Nothing to read is nothing to loop over, however often.
    let empty = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nelement vertex 0\n";
    assert!(parse(Format::Ply, format!("{empty}{xyz}end_header\n").into_bytes()));
}
