//! PLY, the polygon file of Stanford: <http://paulbourke.net/dataformats/ply/>.
//!
//! Read: text and binary of both byte orders; elements and properties in any order and of any type; `vertex` with
//! `x y z`, `nx ny nz` and texture coordinates under their usual names; `face` with `vertex_indices` (or
//! `vertex_index`), polygons cut into fans from their first corner in file order; `tristrips`. Everything else
//! (colours too) is passed over.

mod body;
mod header;

use whitted::math::Vec3d;
use whitted::scene::Mesh;

use crate::error::{Error, ErrorKind, Warning, quoted};
use crate::mesh;
use crate::source::Source;
use body::{Ascii, Binary, Body};
use header::{Element, Encoding, Header, Type, lossy_name};

/// Read a mesh.
pub(crate) fn read(source: Source<'_>, warn: &mut dyn FnMut(Warning)) -> Result<Mesh, Error> {
    let mut header = Header::parse(&source)?;
    header.warnings.drain(..).for_each(&mut *warn);
    let mut reader = Reader::new(source, &header)?;
    match header.encoding {
        Encoding::Ascii => reader.read(&header, &mut Ascii::new(source, header.body))?,
        Encoding::LittleEndian => reader.read(&header, &mut Binary::<false>::new(source, header.body))?,
        Encoding::BigEndian => reader.read(&header, &mut Binary::<true>::new(source, header.body))?,
    }
    let (mut mesh, dropped_faces) = reader.finish();
    if dropped_faces > 0 {
        let what = format!("{dropped_faces} faces have fewer than three corners and were left out");
        warn(source.error_whole(what).into_warning());
    }
    if let Some(what) = mesh::repair(&mut mesh) {
        warn(source.error_whole(what).into_warning());
    }
    Ok(mesh)
}

/// Where the value of a vertex property goes.
const SLOTS: [(&[&str], usize); 8] = [
    (&["x"], 0),
    (&["y"], 1),
    (&["z"], 2),
    (&["nx", "normal_x"], 3),
    (&["ny", "normal_y"], 4),
    (&["nz", "normal_z"], 5),
    (&["u", "s", "texture_u", "texture_s"], 6),
    (&["v", "t", "texture_v", "texture_t"], 7),
];
/// The slot of values that nobody wants.
const UNUSED: usize = 8;

/// A property as the vertex loop needs it.
#[derive(Clone, Copy)]
enum Step {
    Number(Type, usize),
    SkipList(Type, Type),
}

struct Reader<'a> {
    source: Source<'a>,
    vertices: usize,
    /// Used if single precision holds all positions, else [`points`](Self::points).
    positions: Vec<[f32; 3]>,
    points: Vec<Vec3d>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<[u32; 3]>,
    dropped_faces: usize,
}

impl<'a> Reader<'a> {
    fn new(source: Source<'a>, header: &Header<'_>) -> Result<Self, Error> {
        let mut vertex = header.elements.iter().filter(|e| e.name == b"vertex");
        let Some(first) = vertex.next() else {
            return Err(source.error_whole("there is no \"vertex\" element"));
        };
        if let Some(second) = vertex.next() {
            return Err(source.error_at(second.name, "a second \"vertex\" element"));
        }
        if u32::try_from(first.count).is_err() {
            let error = source.error_at(first.count_word, "more than 2^32 - 1 vertices");
            return Err(error.blame(ErrorKind::Limit));
        }
        Ok(Self {
            source,
            vertices: first.count,
            positions: Vec::new(),
            points: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
            dropped_faces: 0,
        })
    }

    fn read<B: Body>(&mut self, header: &Header<'_>, body: &mut B) -> Result<(), Error> {
        let wanted = |e: &Element<'_>| matches!(e.name, b"vertex" | b"face" | b"tristrips");
        let last = header.elements.iter().rposition(wanted).map_or(0, |last| last + 1);
        for element in &header.elements[..last] {
            self.check_count(element, body)?;
            match element.name {
                b"vertex" => self.read_vertices(element, body)?,
                b"face" => self.read_lists(element, body, Self::read_face::<B>)?,
                b"tristrips" => self.read_lists(element, body, Self::read_strip::<B>)?,
                _ => self.skip_element(element, body)?,
            }
        }
        Ok(())
    }

    /// Refuse a count that the rest of the file cannot hold, before anything is allocated for it.
    fn check_count<B: Body>(&self, element: &Element<'_>, body: &B) -> Result<(), Error> {
        let item: usize = element.properties.iter().map(|p| B::size(p.list.unwrap_or(p.item))).sum();
        if element.count.checked_mul(item).is_some_and(|bytes| bytes <= body.bytes_left()) {
            return Ok(());
        }
        let what = format!(
            "the header claims {} of element \"{}\", more than the rest of the file can hold",
            element.count,
            lossy_name(element.name)
        );
        Err(self.source.error_at(element.count_word, what))
    }

    fn read_vertices<B: Body>(&mut self, element: &Element<'_>, body: &mut B) -> Result<(), Error> {
        let steps = self.vertex_steps(element)?;
        let has = |slots: &[usize]| {
            slots.iter().all(|slot| steps.iter().any(|s| matches!(s, Step::Number(_, to) if to == slot)))
        };
        if !has(&[0, 1, 2]) {
            return Err(self.source.error_at(element.name, "vertices have no position: x, y or z is missing"));
        }
        let (normals, uvs) = (has(&[3, 4, 5]), has(&[6, 7]));
        let single = steps.iter().all(|step| match step {
            Step::Number(kind, 0..=2) => kind.fits_f32(),
            _ => true,
        });
        if single {
            self.positions.reserve_exact(element.count)
        } else {
            self.points.reserve_exact(element.count)
        }
        self.normals.reserve_exact(if normals { element.count } else { 0 });
        self.uvs.reserve_exact(if uvs { element.count } else { 0 });
        for _ in 0..element.count {
            let mut values = [0.0; UNUSED + 1];
            for step in &steps {
                match *step {
                    Step::Number(kind, slot) => values[slot] = body.number(kind)?,
                    Step::SkipList(length, item) => skip_list(body, length, item)?,
                }
            }
            body.end_item();
            let [x, y, z, nx, ny, nz, u, v, _] = values;
            if single {
                self.positions.push([x as f32, y as f32, z as f32]);
            } else {
                self.points.push(Vec3d::new(x, y, z));
            }
            if normals {
                self.normals.push([nx as f32, ny as f32, nz as f32]);
            }
            if uvs {
                self.uvs.push([u as f32, v as f32]);
            }
        }
        Ok(())
    }

    fn vertex_steps(&self, element: &Element<'_>) -> Result<Vec<Step>, Error> {
        let mut taken = [false; UNUSED];
        let mut steps = Vec::with_capacity(element.properties.len());
        for property in &element.properties {
            let named = |names: &[&str]| names.iter().any(|name| name.as_bytes() == property.name);
            let slot = SLOTS.iter().find(|(names, _)| named(names)).map(|(_, slot)| *slot);
            steps.push(match (property.list, slot) {
                (Some(length), _) => Step::SkipList(length, property.item),
                (None, Some(slot)) if std::mem::replace(&mut taken[slot], true) => {
                    let what = format!("vertices have the property {} twice", quoted(property.name));
                    return Err(self.source.error_at(property.name, what));
                }
                (None, slot) => Step::Number(property.item, slot.unwrap_or(UNUSED)),
            });
        }
        Ok(steps)
    }

    /// Give the list of vertex numbers of each item of `element` to `read_list`, and pass over its other properties.
    fn read_lists<B: Body>(
        &mut self,
        element: &Element<'_>,
        body: &mut B,
        read_list: fn(&mut Self, &mut B, Type, usize) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let is_indices = |name: &[u8]| matches!(name, b"vertex_indices" | b"vertex_index");
        let indices = element.properties.iter().position(|p| p.list.is_some() && is_indices(p.name));
        let Some(indices) = indices else {
            return match element.count {
                0 => Ok(()),
                _ => Err(self.source.error_at(element.name, "faces without a list \"vertex_indices\"")),
            };
        };
        // A triangle takes at least its list's length and three indices.
        let list = &element.properties[indices];
        self.triangles.reserve(element.count.min(body.at_most(list.item) / 3));
        for _ in 0..element.count {
            for (number, property) in element.properties.iter().enumerate() {
                match property.list {
                    Some(length) if number == indices => {
                        let count = list_length(body, length, property.item)?;
                        read_list(self, body, property.item, count)?;
                    }
                    Some(length) => skip_list(body, length, property.item)?,
                    None => body.skip(property.item, 1)?,
                }
            }
            body.end_item();
        }
        Ok(())
    }

    /// A polygon as a fan from its first corner.
    fn read_face<B: Body>(&mut self, body: &mut B, kind: Type, count: usize) -> Result<(), Error> {
        if count < 3 {
            self.dropped_faces += 1;
            return body.skip(kind, count);
        }
        let first = self.index(body, kind)?;
        let mut previous = self.index(body, kind)?;
        for _ in 2..count {
            let next = self.index(body, kind)?;
            self.triangles.push([first, previous, next]);
            previous = next;
        }
        Ok(())
    }

    /// A triangle strip: every corner makes a triangle with the two before it, turned alternately; −1 starts anew.
    fn read_strip<B: Body>(&mut self, body: &mut B, kind: Type, count: usize) -> Result<(), Error> {
        let (mut a, mut b) = (None, None);
        let mut turned = false;
        for _ in 0..count {
            let number = body.integer(kind)?;
            if number == -1 {
                (a, b, turned) = (None, None, false);
                continue;
            }
            let next = self.check_index(body, number)?;
            if let (Some(a), Some(b)) = (a, b) {
                self.triangles.push(if turned { [b, a, next] } else { [a, b, next] });
                turned = !turned;
            }
            (a, b) = (b, Some(next));
        }
        Ok(())
    }

    #[inline]
    fn index<B: Body>(&self, body: &mut B, kind: Type) -> Result<u32, Error> {
        let number = body.integer(kind)?;
        self.check_index(body, number)
    }

    #[inline]
    fn check_index<B: Body>(&self, body: &B, number: i64) -> Result<u32, Error> {
        if (0..self.vertices as i64).contains(&number) {
            return Ok(number as u32);
        }
        Err(body.fault(format!("vertex {number} does not exist: there are {}, counted from 0", self.vertices)))
    }

    fn skip_element<B: Body>(&self, element: &Element<'_>, body: &mut B) -> Result<(), Error> {
        if element.properties.is_empty() {
            return Ok(());
        }
        for _ in 0..element.count {
            for property in &element.properties {
                match property.list {
                    Some(length) => skip_list(body, length, property.item)?,
                    None => body.skip(property.item, 1)?,
                }
            }
            body.end_item();
        }
        Ok(())
    }

    fn finish(self) -> (Mesh, usize) {
        let (positions, origin) = match self.points.is_empty() {
            true => (self.positions, Vec3d::ZERO),
            false => mesh::place(&self.points),
        };
        let (triangles, normals, uvs) = (self.triangles, self.normals, self.uvs);
        (Mesh { positions, origin, triangles, normals, uvs, ..Mesh::default() }, self.dropped_faces)
    }
}

/// The length of a list, if the rest of the file can hold it.
#[inline]
fn list_length<B: Body>(body: &mut B, length: Type, item: Type) -> Result<usize, Error> {
    let count = body.integer(length)?;
    match usize::try_from(count) {
        Ok(count) if count <= body.at_most(item) => Ok(count),
        Ok(_) => Err(body.fault(format!("a list claims {count} numbers, more than the rest of the file can hold"))),
        Err(_) => Err(body.fault(format!("a list cannot have {count} numbers"))),
    }
}

fn skip_list<B: Body>(body: &mut B, length: Type, item: Type) -> Result<(), Error> {
    let count = list_length(body, length, item)?;
    body.skip(item, count)
}
