//! Tables of rays as they come: right, odd and broken.

use formats::ErrorKind;
use formats::rays::{HitFormat, RayFormat, RayReader};
use std::path::Path;
use whitted::ray::{Hit, HitBatch, NONE, Ray, RayBatch};

/// All rays of `bytes`, read `piece` at a time; or the first error, as its reader sees it.
fn read(format: RayFormat, bytes: &[u8], piece: usize) -> Result<Vec<Ray>, String> {
    let mut reader = RayReader::new(format, Path::new("rays"), bytes).map_err(|error| error.to_string())?;
    let (mut batch, mut all) = (RayBatch::new(), Vec::new());
    loop {
        reader.read(&mut batch, piece).map_err(|error| error.to_string())?;
        if batch.is_empty() {
            return Ok(all);
        }
        all.extend((0..batch.len()).map(|index| batch.get(index)));
    }
}

fn csv(text: &str) -> Result<Vec<Ray>, String> {
    read(RayFormat::Csv, text.as_bytes(), 2)
}

/// The ray with the numbers 1, 2, 3 as origin and 4, 5, 6 as direction.
fn counted() -> Ray {
    Ray::new([1.0, 2.0, 3.0], [4.0, 5.0, 6.0])
}

#[test]
fn columns_come_in_any_order_and_lines_end_in_any_way() {
    let expected = vec![counted(), Ray { t_min: 0.5, t_max: 9.0, ..counted() }];
    for text in [
        "ox,oy,oz,dx,dy,dz,t_min,t_max\n1,2,3,4,5,6,,\n1,2,3,4,5,6,0.5,9\n",
        "t_max,dz,dy,dx,oz,oy,ox,t_min\ninf,6,5,4,3,2,1,0\n9,6,5,4,3,2,1,.5",
        "\u{feff}ox,oy,oz,dx,dy,dz,t_min,t_max\r\n\r\n1,2,3,4,5,6,,\r\n1,2,3,4,5,6,5e-1,9\r\n\n\n",
        "# ox, oy, oz, dx, dy, dz, t_min, t_max\n 1 , 2,3,+4,5.0,6 , , inf\n1,2,3,4,5,6,0.5,9\n",
        "\"ox\",\"oy\",\"oz\",\"dx\",\"dy\",\"dz\",\"t_min\",\"t_max\"\n\"1\",2,3,4,5,6,0,\n1,2,3,4,5,6,0.5,\" 9\"",
    ] {
        assert_eq!(csv(text), Ok(expected.clone()), "{text}");
    }
    assert_eq!(csv("ox,oy,oz,dx,dy,dz\n"), Ok(Vec::new()));
}

#[test]
fn other_columns_are_told() {
    let text = "id,ox,oy,oz,dx,dy,dz\nseven,1,2,3,4,5,6\n";
    let reader = RayReader::new(RayFormat::Csv, Path::new("rays"), text.as_bytes()).expect("a sound head");
    assert!(reader.warnings()[0].to_string().contains("\"id\" is not read"), "{:?}", reader.warnings());
    assert_eq!(csv(text), Ok(vec![counted()]));
}

#[test]
fn faults_of_text_tell_line_column_and_what() {
    let head = "ox,oy,oz,dx,dy,dz\n";
    for (text, words) in [
        ("", "rays: the file is empty"),
        ("\n\n", "the file is empty"),
        ("1,2,3,4,5,6\n", "rays:1:1: a number where a column's name should be"),
        ("ox,oy,oz,dx,dy\n", "no column dz"),
        ("x,y,z,dx,dy,dz\n", "no column ox, oy, oz"),
        ("ox,oy,oz,dx,dy,dz,oy\n", "rays:1:19: the column \"oy\" occurs twice"),
        (&format!("{head}1,2,3,4,5,6\n1,2,3,4,five,6\n"), "rays:3:9: dy must be a number, not \"five\""),
        (&format!("{head}\r\n1,2,,4,5,6\r\n"), "rays:3:5: oz must be a number, not \"\""),
        (&format!("{head}1,2,3,4,5\n"), "rays:2:1: 5 values, but 6 columns were named"),
        (&format!("{head}1,2,3,4,5,6,7\n"), "7 values, but 6 columns were named"),
        (&format!("{head}1;2;3;4;5;6\n"), "hint: values are separated by commas"),
        (&format!("{head}{}", "1".repeat(70_000)), "the line is longer than 65536 bytes"),
        ("o\0x\0", "this is no text in UTF-8"),
    ] {
        let error = csv(text).expect_err(text);
        assert!(error.contains(words), "{text:.40}: no '{words}' in: {error}");
    }
    let latin1 = [head.as_bytes(), b"1,2,3,4,5,\xFC\n"].concat();
    assert!(read(RayFormat::Csv, &latin1, 9).expect_err("no number").contains("dz must be a number"));
}

/// A NumPy file of a version, with this dictionary, around `data`.
fn npy(version: u8, dictionary: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    let text = format!("{dictionary:<70}\n");
    match version {
        1 => bytes.extend((text.len() as u16).to_le_bytes()),
        _ => bytes.extend((text.len() as u32).to_le_bytes()),
    }
    bytes.extend(text.bytes());
    bytes.extend(data);
    bytes
}

fn le32(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

const SIX: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

fn dictionary(descr: &str, order: &str, shape: &str) -> String {
    format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}")
}

#[test]
fn numpy_arrays_of_every_version_and_number_are_read() {
    let two = le32(&[SIX, SIX].concat());
    let doubled = SIX.map(f64::from);
    let cases = [
        (npy(1, &dictionary("<f4", "False", "(2, 6)"), &two), 2),
        (npy(2, &dictionary("<f4", "False", "(2,6)"), &two), 2),
        (npy(3, &dictionary("<f4", "False", "(2, 6)").replace('\'', "\""), &two), 2),
        (npy(1, &dictionary(">f4", "False", "(1, 6)"), &SIX.map(f32::to_be_bytes).concat()), 1),
        (npy(1, &dictionary("<f8", "False", "(1, 6)"), &doubled.map(f64::to_le_bytes).concat()), 1),
        (npy(1, &dictionary(">f8", "False", "(1, 6)"), &doubled.map(f64::to_be_bytes).concat()), 1),
        (npy(1, &dictionary("<f4", "False", "(0, 6)"), &[]), 0),
    ];
    for (bytes, count) in cases {
        assert_eq!(read(RayFormat::Npy, &bytes, 1), Ok(vec![counted(); count]));
        let reader = RayReader::new(RayFormat::Npy, Path::new("rays"), &bytes[..]).expect("a sound head");
        assert_eq!(reader.total(), Some(count as u64));
    }
    let ranged = npy(1, &dictionary("<f4", "False", "(1, 8)"), &le32(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.5, 9.0]));
    assert_eq!(read(RayFormat::Npy, &ranged, 9), Ok(vec![Ray { t_min: 0.5, t_max: 9.0, ..counted() }]));
}

#[test]
fn faults_of_numpy_files_are_told() {
    let head = |descr: &str, order: &str, shape: &str| npy(1, &dictionary(descr, order, shape), &le32(&SIX));
    let cut = head("<f4", "False", "(2, 6)");
    for (bytes, words) in [
        (vec![], "no NumPy file"),
        (b"PK\x03\x04 this is an archive".to_vec(), "no NumPy file"),
        (npy(9, "", &[]), "version 9"),
        (cut[..9].to_vec(), "ends within its head"),
        (cut[..40].to_vec(), "ends within its head"),
        (b"\x93NUMPY\x02\0\xff\xff\xff\xff".to_vec(), "no head of an array of rays"),
        (head("<i4", "False", "(1, 6)"), "numbers must be float32 or float64, not \"<i4\""),
        (head("<c8", "False", "(1, 6)"), "\"<c8\""),
        (head("|O", "False", "(1, 6)"), "\"|O\""),
        (npy(1, "{'descr': [('ox', '<f4')], 'fortran_order': False, 'shape': (1,), }", &[]), "numbers must be float32"),
        (head("<f4", "True", "(1, 6)"), "Fortran order"),
        (head("<f4", "Maybe", "(1, 6)"), "\"Maybe\""),
        (head("<f4", "False", "(1, 7)"), "the shape must be (n, 6) or (n, 8), not (1, 7)"),
        (head("<f4", "False", "(6,)"), "not (6,)"),
        (head("<f4", "False", "(1, 1, 6)"), "not (1, 1, 6)"),
        (head("<f4", "False", "(-1, 6)"), "not (-1, 6)"),
        (head("<f4", "False", "(99999999999999999999, 6)"), "the shape must be"),
        (npy(1, "{'descr': '<f4', 'shape': (1, 6), }", &[]), "does not tell fortran_order"),
        (npy(1, "{}", &[]), "does not tell descr"),
        (cut, "byte 105: the file ends, but 1 more rays were announced"),
        (npy(1, &dictionary("<f4", "False", "(0, 6)"), &[1]), "goes on after the 0 rays announced"),
        // A count that nobody could keep in memory costs no memory.
        (head("<f4", "False", "(9223372036854775807, 6)"), "more rays were announced"),
    ] {
        let error = read(RayFormat::Npy, &bytes, 1000).expect_err(words);
        assert!(error.contains(words), "no '{words}' in: {error}");
    }
}

#[test]
fn raw_rays_are_whole() {
    let three = le32(&[SIX, SIX, SIX].concat());
    for piece in [1, 2, 100] {
        assert_eq!(read(RayFormat::F32, &three, piece), Ok(vec![counted(); 3]));
    }
    assert_eq!(read(RayFormat::F32, &[], 5), Ok(vec![]));
    let error = read(RayFormat::F32, &three[..50], 2).expect_err("two rays and two bytes");
    assert!(error.contains("byte 50: the file ends within a ray: 2 of 24 bytes"), "{error}");
    let error = read(RayFormat::F32x8, &three, 9).expect_err("two rays and a quarter");
    assert!(error.contains("8 of 32 bytes") && error.contains("format f32"), "{error}");
}

#[test]
fn formats_are_told_by_extensions() {
    assert_eq!(RayFormat::of(Path::new("a/b.CSV")), Ok(RayFormat::Csv));
    assert_eq!(RayFormat::of(Path::new("b.f32x8")), Ok(RayFormat::F32x8));
    assert_eq!(HitFormat::of(Path::new("b.npy")), Ok(HitFormat::Npy));
    let error = HitFormat::of(Path::new("b.xlsx")).expect_err("unknown");
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains(".csv, .npy, .f32"), "{error}");
}

#[test]
fn hits_are_written_as_they_are_read() {
    let mut hits = HitBatch::default();
    hits.resize(2);
    hits.set(0, Hit { t: 1.5, u: 0.25, v: 1e-9, primitive: 7, instance: NONE });
    let normals = [vec![0.0, 0.0], vec![-1.0, 0.0], vec![0.0, 0.0]];
    let mut text = HitFormat::Csv.head(2);
    HitFormat::Csv.append(&hits, &normals, &mut text);
    let text = String::from_utf8(text).expect("text");
    assert_eq!(text, "t,primitive,u,v,nx,ny,nz\n1.5,7,0.25,1e-9,0.0,-1.0,0.0\ninf,,,,,,\n");

    let mut records = Vec::new();
    HitFormat::F32.append(&hits, &normals, &mut records);
    assert_eq!(records.len(), 2 * 28);
    assert_eq!(records[4..8], 7i32.to_le_bytes());
    assert_eq!((&records[28..32], &records[32..36]), (&f32::INFINITY.to_le_bytes()[..], &(-1i32).to_le_bytes()[..]));

    let (small, large) = (HitFormat::Npy.head(0), HitFormat::Npy.head(u64::MAX));
    assert_eq!((small.len(), small.len() % 64), (large.len(), 0));
    assert_eq!(&small[..8], b"\x93NUMPY\x01\0");
    assert_eq!(usize::from(u16::from_le_bytes([small[8], small[9]])), small.len() - 10);
    assert!(large.ends_with(b"\n") && String::from_utf8_lossy(&large).contains("'shape': (18446744073709551615,), }"));
}
