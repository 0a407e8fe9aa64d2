//! PLY by small files written here.

use std::path::Path;

use formats::{Error, ErrorKind, Format, LoadOptions, Loaded, Place};
use whitted::scene::Mesh;

fn load(bytes: impl Into<Vec<u8>>) -> Result<Loaded, Error> {
    formats::parse(Format::Ply, Path::new("t.ply"), bytes.into(), &LoadOptions::default())
}

fn mesh(bytes: impl Into<Vec<u8>>) -> Mesh {
    load(bytes).unwrap().scene.meshes.remove(0)
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

#[test]
fn all_encodings_give_the_same_mesh() {
    let points: [[f32; 3]; 4] = [[0.1, 0.0, 0.0], [1.0, 1e-7, 0.0], [1.0, 1.0, 0.033], [0.0, 1.0, -0.025]];
    let header = |format: &str| {
        let faces = "element face 1\nproperty list ushort int vertex_indices\n";
        format!("ply\nformat {format} 1.0\nelement vertex 4\n{XYZ}{faces}end_header\n")
    };
    let mut text = header("ascii");
    let (mut little, mut big) = (header("binary_little_endian").into_bytes(), header("binary_big_endian").into_bytes());
    for point in points {
        text += &format!("{} {} {}\n", point[0], point[1], point[2]);
        little.extend(point.iter().flat_map(|a| a.to_le_bytes()));
        big.extend(point.iter().flat_map(|a| a.to_be_bytes()));
    }
    text += "4 0 1 2 3";
    little.extend(4u16.to_le_bytes());
    big.extend(4u16.to_be_bytes());
    for index in 0..4i32 {
        little.extend(index.to_le_bytes());
        big.extend(index.to_be_bytes());
    }
    for bytes in [text.into_bytes(), little, big] {
        let mesh = mesh(bytes);
        assert_eq!(mesh.positions, points);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]], "a fan from the first corner");
    }
}

#[test]
fn properties_come_in_any_order_and_type() {
    let mesh = mesh(
        "ply\r\nformat ascii 1.0\r\nelement other 2\r\nproperty list uchar float junk\r\nelement face 1\r\n\
         property uchar red\r\nproperty list int uint vertex_index\r\nelement vertex 3\r\nproperty double nz\r\n\
         property float t\r\nproperty int x\r\nproperty double nx\r\nproperty uchar red\r\nproperty short z\r\n\
         property float s\r\nproperty double ny\r\nproperty float y\r\nend_header\r\n2 1 2\r\n0\r\n255 3 2 1 0\r\n\
         1 0.5 7 0 9 3 0.25 0 5.5\r\n1 0 0 0 9 0 0 0 0\r\n1 0 1 0 9 0 0 0 0\r\n",
    );
    assert_eq!((mesh.positions[0], mesh.normals[0], mesh.uvs[0]), ([7.0, 5.5, 3.0], [0.0, 0.0, 1.0], [0.25, 0.5]));
    assert_eq!(mesh.triangles, [[2, 1, 0]]);
}

#[test]
fn strips_turn_every_other_triangle() {
    let header = format!("ply\nformat ascii 1.0\nelement vertex 5\n{XYZ}element tristrips 1\n");
    let strip = "property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n";
    let mesh = mesh(format!("{header}{strip}8 0 1 2 3 -1 2 3 4\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
}

#[test]
fn far_doubles_keep_their_precision() {
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
    let mesh = mesh(format!("{header}end_header\n1e6 1e6 1e6\n1000000.001 1e6 1e6\n1e6 1000001 1e6\n"));
    let x = mesh.origin.x + f64::from(mesh.positions[1][0]);
    assert!((x - 1_000_000.001).abs() < 1e-6, "{x}");
}

#[test]
fn errors_tell_line_and_column_or_byte() {
    let header = format!("ply\nformat ascii 1.0\nelement vertex 3\n{XYZ}element face 1\n");
    let header = format!("{header}property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
    let error = load(format!("{header}3 0 1 7\n")).unwrap_err();
    let text = "t.ply:13:7: vertex 7 does not exist: there are 3, counted from 0\n  3 0 1 7\n        ^";
    assert_eq!(error.to_string(), text);
    assert_eq!(error.kind(), ErrorKind::Input);

    let binary = format!("ply\nformat binary_little_endian 1.0\nelement vertex 2\n{XYZ}end_header\n");
    let length = binary.len();
    let error = load([binary.as_bytes(), &[0; 24]].concat());
    assert!(error.is_ok());
    let error = load([binary.as_bytes(), &[0; 23]].concat()).unwrap_err();
    let place = Place::Text { line: 3, column: 16 };
    assert_eq!(error.report().place, place, "the count is refused before {length} is passed: {error}");
}

#[test]
fn misspelt_types_are_recognised() {
    let error = load("ply\nformat ascii 1.0\nelement vertex 1\nproperty flaot x\nend_header\n0\n").unwrap_err();
    assert_eq!(error.report().hint.as_deref(), Some("did you mean \"float\"?"));
}
