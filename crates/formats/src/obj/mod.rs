//! Wavefront OBJ: <http://paulbourke.net/dataformats/obj/>.
//!
//! Read: `v`, `vt`, `vn`, `f` with positive and relative indices, `usemtl`, `mtllib`. All faces become one mesh, cut
//! into fans from their first corner in file order. Everything else that belongs to the format is passed over; lines
//! and points are not drawn. Line ends may be LF, CR LF or CR; a backslash joins lines; a byte-order mark is allowed.

mod materials;
mod vertices;

use std::collections::{HashMap, HashSet};

use whitted::math::Vec3d;
use whitted::scene::{Mesh, NamedMaterial};
use whitted::shading::Material;

use crate::error::{Error, ErrorKind, quoted};
use crate::files::Context;
use crate::mesh::{self, MeshFile};
use crate::source::{self, Source, lossy};
use crate::text::{Lines, Words, float, trim};
use vertices::{Corner, Faces, IndexRange};

/// Read a mesh and its materials.
pub(crate) fn read(source: Source<'_>, context: &mut Context<'_>) -> Result<MeshFile, Error> {
    let mut reader = Reader {
        source,
        context,
        points: Vec::new(),
        normals: Vec::new(),
        uvs: Vec::new(),
        ranges: [IndexRange::default(); 3],
        faces: Faces::default(),
        names: MaterialNames::default(),
        library: HashMap::new(),
        unknown: HashSet::new(),
    };
    for line in Lines::new(source.bytes) {
        reader.statement(line)?;
    }
    reader.finish()
}

/// Statements of the format that draw nothing here.
const PASSED_OVER: [&[u8]; 38] = [
    b"o",
    b"g",
    b"s",
    b"l",
    b"p",
    b"vp",
    b"mg",
    b"usemap",
    b"maplib",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"call",
    b"csh",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"curv",
    b"curv2",
    b"surf",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"ctech",
    b"stech",
    b"bsp",
    b"bzp",
    b"cdc",
    b"cdp",
    b"res",
];

struct Reader<'a, 'c, 'o> {
    source: Source<'a>,
    context: &'c mut Context<'o>,
    points: Vec<Vec3d>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    /// The indices used of positions, texture coordinates and normals.
    ranges: [IndexRange<'a>; 3],
    faces: Faces,
    names: MaterialNames<'a>,
    library: HashMap<Vec<u8>, Material>,
    /// Statements that were warned of.
    unknown: HashSet<&'a [u8]>,
}

/// The names of materials in order of their first use.
#[derive(Default)]
struct MaterialNames<'a> {
    names: Vec<&'a [u8]>,
    numbers: HashMap<&'a [u8], u32>,
}

impl<'a> MaterialNames<'a> {
    fn number(&mut self, name: &'a [u8]) -> u32 {
        *self.numbers.entry(name).or_insert_with(|| {
            self.names.push(name);
            self.names.len() as u32 - 1
        })
    }
}

impl<'a> Reader<'a, '_, '_> {
    fn statement(&mut self, line: &'a [u8]) -> Result<(), Error> {
        let mut words = Words::new(line);
        match words.next() {
            None => {}
            Some(b"v") => {
                let [x, y, z] = self.numbers(line, &mut words)?;
                self.points.push(Vec3d::new(x, y, z));
            }
            Some(b"vn") => {
                let normal = self.numbers(line, &mut words)?;
                self.normals.push(normal.map(|a| a as f32));
            }
            Some(b"vt") => {
                let [u] = self.numbers(line, &mut words)?;
                let v = words.next().map_or(Ok(0.0), |word| self.number(word))?;
                self.uvs.push([u as f32, v as f32]);
            }
            Some(b"f" | b"fo") => self.face(line, words)?,
            Some(b"usemtl") => self.faces.material = self.names.number(trim(words.rest())),
            Some(b"mtllib") => self.library(trim(words.rest())),
            Some(word) if word[0] == b'#' || PASSED_OVER.contains(&word) => {}
            Some(word) => self.unknown(word)?,
        }
        Ok(())
    }

    /// The first `N` numbers of a statement; more (weights, colours) are passed over.
    fn numbers<const N: usize>(&mut self, line: &'a [u8], words: &mut Words<'a>) -> Result<[f64; N], Error> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            let Some(word) = words.next() else {
                return Err(self.source.error_at(line, format!("at least {N} numbers are needed here")));
            };
            *number = self.number(word)?;
        }
        Ok(numbers)
    }

    fn number(&mut self, word: &'a [u8]) -> Result<f64, Error> {
        if let Some(number) = float(word) {
            return Ok(number);
        }
        let not_a_number = self.source.error_at(word, format!("{} is not a number", quoted(word)));
        // Some writers put the sign of the exponent before its letter.
        let text = lossy(word);
        match float(text.replace("+e", "e+").replace("-e", "e-").as_bytes()) {
            Some(number) => {
                self.context.warn(not_a_number.hint(format!("it was read as {number}")).into_warning());
                Ok(number)
            }
            None => Err(not_a_number),
        }
    }

    fn face(&mut self, line: &'a [u8], words: Words<'a>) -> Result<(), Error> {
        let before = self.faces.corners();
        for word in words {
            let corner = self.corner(word)?;
            self.faces.add_corner(corner);
        }
        if self.faces.corners() - before < 3 {
            return Err(self.source.error_at(line, "a face needs at least three corners"));
        }
        self.faces.end_face();
        Ok(())
    }

    /// `position`, `position/uv`, `position//normal` or `position/uv/normal`.
    fn corner(&mut self, word: &'a [u8]) -> Result<Corner, Error> {
        let mut parts = word.split(|&b| b == b'/');
        let mut next = |number: usize, defined: usize| match parts.next() {
            None | Some(b"") if number > 0 => Ok(None),
            part => self.ranges[number].resolve(&self.source, part.unwrap_or(word), defined).map(Some),
        };
        let position = next(0, self.points.len())?;
        let uv = next(1, self.uvs.len())?;
        let normal = next(2, self.normals.len())?;
        if parts.next().is_some() {
            return Err(self.source.error_at(word, "a corner has at most three indices"));
        }
        Ok(Corner::new(position.unwrap_or(0), uv, normal))
    }

    fn unknown(&mut self, word: &'a [u8]) -> Result<(), Error> {
        let what = format!("{} is no statement of OBJ", quoted(word));
        let error = self.source.error_at(word, what);
        // Words of other programs' dialects are passed over; what is no word at all is no OBJ.
        if !word.iter().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-' | b'.' | b':')) {
            return Err(error);
        }
        if self.unknown.insert(word) {
            self.context.warn(error.hint("all such lines were passed over").into_warning());
        }
        Ok(())
    }

    /// Read the material libraries `names`: one name with spaces, or several. What is wrong with them is warned of.
    fn library(&mut self, names: &'a [u8]) {
        let whole = self.context.read_named(self.source.file, &lossy(names));
        let several: Vec<&[u8]> = Words::new(names).collect();
        if whole.is_ok() || several.len() < 2 {
            return self.add_library(names, whole);
        }
        for name in several {
            let file = self.context.read_named(self.source.file, &lossy(name));
            self.add_library(name, file);
        }
    }

    fn add_library(&mut self, name: &'a [u8], file: Result<(std::path::PathBuf, Vec<u8>), Error>) {
        let text = file.and_then(|(path, bytes)| Ok((source::decode(&path, bytes)?, path)));
        match text {
            Ok((bytes, path)) => {
                let source = Source { file: &path, bytes: &bytes };
                let found = materials::read(source, &mut |w| self.context.warn(w));
                self.library.extend(found);
            }
            Err(e) => {
                let what = format!("the material library {} was not read: {}", quoted(name), e.report().what);
                self.context.warn(self.source.error_at(name, what).into_warning());
            }
        }
    }

    fn finish(self) -> Result<MeshFile, Error> {
        let defined = [self.points.len(), self.uvs.len(), self.normals.len()];
        let [positions, uvs, normals] = &self.ranges;
        positions.check(&self.source, "vertex", defined[0])?;
        let uvs = uvs.check(&self.source, "texture coordinate", defined[1]);
        let normals = normals.check(&self.source, "normal", defined[2]);
        // A mesh without them can be drawn.
        for missing in [uvs, normals].into_iter().filter_map(Result::err) {
            self.context.warn(missing.into_warning());
        }
        if [defined[0], self.faces.corners()].iter().any(|&n| u32::try_from(n).is_err()) {
            let error = self.source.error_whole("more than 2^32 - 1 vertices or corners");
            return Err(error.blame(ErrorKind::Limit));
        }
        let (positions, origin) = mesh::place(&self.points);
        drop(self.points);
        let mut mesh = Mesh { origin, ..self.faces.build(positions, &self.uvs, &self.normals) };
        let used = self.names.names.iter().map(|name| {
            let material = self.library.get(*name).cloned().unwrap_or_else(|| {
                let what = format!("the material {} is not defined: it is light grey", quoted(name));
                self.context.warn(self.source.error_at(name, what).into_warning());
                Material::default()
            });
            NamedMaterial { name: lossy(name).into_owned(), material }
        });
        let mut materials: Vec<NamedMaterial> = used.collect();
        if mesh.triangle_materials.contains(&vertices::NONE) {
            // Faces before the first "usemtl".
            let default = materials.len() as u32;
            mesh.triangle_materials.iter_mut().filter(|m| **m == vertices::NONE).for_each(|m| *m = default);
            materials.push(NamedMaterial { name: "default".to_owned(), material: Material::default() });
        }
        if let Some(what) = mesh::repair(&mut mesh) {
            self.context.warn(self.source.error_whole(what).into_warning());
        }
        Ok(MeshFile { mesh, materials })
    }
}
