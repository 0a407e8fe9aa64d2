//! Meshes from binary PLY files, with their view in a text file of the same name that ends in `.cam`.

use super::{Mesh, Scene, View};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use whitted::math::{Aabb, Vec3f};

/// The mesh files in a folder; none if there is no such folder.
pub(super) fn ply_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "ply")).collect()
}

/// Load a mesh and its view; without a `.cam` file the view is chosen by the mesh's size.
pub(super) fn load(path: &Path, name: &str) -> io::Result<Scene> {
    let mesh = read_ply(&mut BufReader::new(std::fs::File::open(path)?))?;
    let view = match std::fs::read_to_string(path.with_extension("cam")) {
        Ok(text) => parse_view(&text).ok_or_else(|| invalid("the .cam file lacks a line or a number"))?,
        Err(_) => View::around(Aabb::around(mesh.vertices.iter().copied())),
    };
    Ok(Scene { name: name.into(), mesh, spheres: Vec::new(), view })
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}

impl View {
    /// A view of everything in `bounds`, from above and the side.
    fn around(bounds: Aabb) -> Self {
        let (at, size) = (bounds.center(), bounds.size().max_component());
        let from = |x, y, z| at + Vec3f::new(x, y, z) * size;
        let up = Vec3f::new(0.0, 1.0, 0.0);
        Self { eye: from(0.6, 0.5, 1.3), at, up, fov: 40.0, light: from(1.5, 2.5, 2.0), bounds: None }
    }
}

/// Lines of a word and its numbers: `eye`, `at`, `up`, `fovy`, `light`, `bounds`.
fn parse_view(text: &str) -> Option<View> {
    let numbers = |word: &str| -> Option<Vec<f32>> {
        let line = text.lines().find(|line| line.split_whitespace().next() == Some(word))?;
        line.split_whitespace().skip(1).map(|number| number.parse().ok()).collect()
    };
    let point = |word| <[f32; 3]>::try_from(numbers(word)?).ok().map(Vec3f::from);
    let bounds = <[f32; 6]>::try_from(numbers("bounds")?).ok()?;
    let [lo_x, lo_y, lo_z, hi_x, hi_y, hi_z] = bounds;
    Some(View {
        eye: point("eye")?,
        at: point("at")?,
        up: point("up")?,
        fov: *numbers("fovy")?.first()?,
        light: point("light")?,
        bounds: Some(Aabb::new(Vec3f::new(lo_x, lo_y, lo_z), Vec3f::new(hi_x, hi_y, hi_z))),
    })
}

/// The one flavour of PLY that benchmark meshes have: little-endian, vertices of three floats, triangles as lists with
/// a byte's count and 32-bit numbers.
fn read_ply(file: &mut impl BufRead) -> io::Result<Mesh> {
    let (vertices, triangles) = read_header(file)?;
    let mut mesh = Mesh::default();
    for _ in 0..vertices {
        let [x, y, z] = [number(file)?, number(file)?, number(file)?].map(f32::from_bits);
        mesh.vertices.push(Vec3f::new(x, y, z));
    }
    for _ in 0..triangles {
        let mut count = [0];
        file.read_exact(&mut count)?;
        let corners = [number(file)?, number(file)?, number(file)?];
        if count != [3] || corners.iter().any(|&corner| corner as usize >= vertices) {
            return Err(invalid("a face is no triangle of the file's vertices"));
        }
        mesh.triangles.push(corners);
    }
    Ok(mesh)
}

fn number(file: &mut impl Read) -> io::Result<u32> {
    let mut bytes = [0; 4];
    file.read_exact(&mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}

/// Numbers of vertices and faces; refuses any other layout than [`read_ply`] reads.
fn read_header(file: &mut impl BufRead) -> io::Result<(usize, usize)> {
    const LAYOUT: [&str; 4] = ["property float x", "property float y", "property float z", "property list uchar"];
    let (mut vertices, mut faces, mut properties) = (0, 0, Vec::new());
    loop {
        let mut line = String::new();
        if file.read_line(&mut line)? == 0 {
            return Err(invalid("no end_header"));
        }
        match line.trim().split_once(' ').unwrap_or((line.trim(), "")) {
            ("end_header", _) => break,
            ("format", format) if format != "binary_little_endian 1.0" => return Err(invalid("not little-endian")),
            ("element", element) => match element.split_once(' ').map(|(name, count)| (name, count.parse())) {
                Some(("vertex", Ok(count))) => vertices = count,
                Some(("face", Ok(count))) => faces = count,
                _ => return Err(invalid("unknown element")),
            },
            ("property", _) => properties.push(line.trim().to_owned()),
            _ => {}
        }
    }
    let fits = properties.len() == LAYOUT.len() && properties.iter().zip(LAYOUT).all(|(p, known)| p.starts_with(known));
    if fits { Ok((vertices, faces)) } else { Err(invalid("other properties than x, y, z and a list of vertices")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n";

    fn file(corners: [u32; 3]) -> Vec<u8> {
        let numbers = (1..10).map(|i| (i as f32).to_le_bytes());
        let corners = corners.map(u32::to_le_bytes);
        HEADER.bytes().chain(numbers.flatten()).chain([3]).chain(corners.into_iter().flatten()).collect()
    }

    #[test]
    fn a_triangle_is_read() {
        let mesh = read_ply(&mut &file([2, 0, 1])[..]).unwrap();
        assert_eq!(mesh.vertices[1], Vec3f::new(4.0, 5.0, 6.0));
        assert_eq!(mesh.triangles, [[2, 0, 1]]);
    }

    #[test]
    fn unknown_vertices_and_short_files_are_refused() {
        assert!(read_ply(&mut &file([0, 1, 3])[..]).is_err());
        assert!(read_ply(&mut &file([0, 1, 2])[..HEADER.len() + 40]).is_err());
        assert!(read_ply(&mut "ply\nformat ascii 1.0\nend_header\n".as_bytes()).is_err());
    }

    #[test]
    fn a_view_needs_all_its_lines() {
        let text = "eye 1 2 3\nat 0 0 0\nup 0 1 0\nfovy 40\nlight 3 5 4\nbounds -1 -1 -1 1 1 2";
        assert_eq!(parse_view(text).unwrap().bounds.unwrap().hi.z, 2.0);
        assert!(parse_view(&text.replace("up", "down")).is_none());
    }
}
