//! NFF, the Neutral File Format of Eric Haines' Standard Procedural Databases, version 3.1.
//!
//! What the format leaves open, and what it means here:
//! * `angle` is the vertical field of view; `hither` is read and has no effect.
//! * A light without colour has intensity 1/√n, where n is the number of lights: the rule of the databases' own tools.
//! * `Ks` is the strength of the highlight and of the mirror reflection, `T` of transmission; there is no ambient light.
//! * Everything is visible from both sides, whatever the sign of a radius. Cones and cylinders are open.
//! * Polygons may be concave. Corners of polygons are kept relative to a common origin if they lie far from 0.

mod scanner;

use std::collections::HashMap;

use whitted::geometry::{Cone, Cylinder, Shape};
use whitted::math::{Vec3d, Vec3f};
use whitted::scene::{Background, Camera, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Scene};
use whitted::shading::{Material, Texture};

use crate::error::{Error, ErrorKind, Warning, quoted};
use crate::files::LoadOptions;
use crate::source::{Source, lossy};
use crate::{check, mesh, polygon, suggest};
use scanner::Scanner;

/// Read a scene. It has no camera if the file has no view.
pub(crate) fn read(source: Source<'_>, options: &LoadOptions, warn: &mut dyn FnMut(Warning)) -> Result<Scene, Error> {
    let mut reader = Reader {
        scan: Scanner::new(source),
        options,
        warn,
        scene: Scene::default(),
        uncolored_lights: Vec::new(),
        fills: HashMap::new(),
        fill: None,
        faceted: Polygons::default(),
        smooth: Polygons::default(),
        work: polygon::WORK,
    };
    while let Some(word) = reader.scan.word() {
        reader.entity(word)?;
    }
    reader.finish()
}

/// The words that begin an entity.
const ENTITIES: [&str; 8] = ["v", "b", "l", "f", "s", "c", "p", "pp"];
/// The words within a view.
const VIEW: [&str; 6] = ["from", "at", "up", "angle", "hither", "resolution"];
/// Words of later programs that can be passed over with the rest of their line: how finely to tessellate.
const PASSED_OVER: [&[u8]; 1] = [b"tess"];

struct Reader<'a, 'w> {
    scan: Scanner<'a>,
    options: &'w LoadOptions,
    warn: &'w mut dyn FnMut(Warning),
    scene: Scene,
    /// Lights that have yet to get their intensity.
    uncolored_lights: Vec<usize>,
    /// Materials by the bits of their numbers: files repeat them for every object.
    fills: HashMap<[u32; 8], u32>,
    fill: Option<u32>,
    faceted: Polygons,
    smooth: Polygons,
    /// Work left for cutting polygons.
    work: u64,
}

/// Polygons cut into triangles.
#[derive(Default)]
struct Polygons {
    points: Vec<Vec3d>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    materials: Vec<u32>,
}

impl<'a> Reader<'a, '_> {
    fn entity(&mut self, word: &'a [u8]) -> Result<(), Error> {
        match word {
            b"v" => self.view(word),
            b"b" => self.background(word),
            b"l" => self.light(word),
            b"f" => self.fill(word),
            b"s" => self.sphere(word),
            b"c" => self.cone(word),
            b"p" => self.polygon(word, false),
            b"pp" => self.polygon(word, true),
            _ if PASSED_OVER.contains(&word) => {
                while self.scan.word_in_line().is_some() {}
                self.warn_at(word, format!("{} has no effect", quoted(word)));
                Ok(())
            }
            _ => Err(self.unknown(word)),
        }
    }

    fn unknown(&self, word: &[u8]) -> Error {
        let error = self.scan.source.error_at(word, format!("{} is no word of NFF", quoted(word)));
        let hint = match VIEW.contains(&&*lossy(word)) {
            true => Some("this word belongs into a view, which begins with \"v\"".to_owned()),
            false => suggest::hint(&lossy(word), ENTITIES),
        };
        match hint {
            Some(hint) => error.hint(hint),
            None => error,
        }
    }

    fn warn_at(&mut self, word: &[u8], what: impl Into<String>) {
        (self.warn)(self.scan.source.error_at(word, what).into_warning());
    }

    fn view(&mut self, begin: &[u8]) -> Result<(), Error> {
        let (mut from, mut at, mut up, mut angle) = (None, None, None, None);
        while let Some(word) = self.scan.peek().filter(|word| VIEW.contains(&&*lossy(word))) {
            self.scan.word();
            match word {
                b"from" => from = Some(self.scan.vector("the eye")?),
                b"at" => at = Some(self.scan.vector("the point looked at")?),
                b"up" => up = Some(self.scan.vector("the up direction")?),
                b"angle" => angle = Some(self.angle(word)?),
                b"hither" => drop(self.scan.number("the hither distance")?),
                _ => self.resolution(word)?,
            }
        }
        let (Some(eye), Some(look_at), Some(up), Some(vfov)) = (from, at, up, angle) else {
            return Err(self.scan.source.error_at(begin, "a view needs \"from\", \"at\", \"up\" and \"angle\""));
        };
        let camera = Camera { eye, look_at, up, vfov };
        if let Some(what) = camera.fault() {
            return Err(self.scan.source.error_at(begin, format!("impossible camera: {what}")));
        }
        if !self.scene.cameras.is_empty() {
            self.warn_at(begin, "a second view: the first is used unless another is chosen");
        }
        let name = format!("view-{}", self.scene.cameras.len() + 1);
        self.scene.cameras.push(NamedCamera { name, camera });
        Ok(())
    }

    fn angle(&mut self, word: &[u8]) -> Result<f64, Error> {
        let angle = self.scan.number("the view angle")?;
        check::angle(angle).map_or(Ok(angle), |what| Err(self.scan.source.error_at(word, what)))
    }

    fn resolution(&mut self, word: &[u8]) -> Result<(), Error> {
        let size = [self.scan.count("the width in pixels")?, self.scan.count("the height in pixels")?];
        self.scene.settings.size = check::size(size.map(|n| n as u64), self.options)
            .map_err(|(kind, what)| self.scan.source.error_at(word, what).blame(kind))?;
        Ok(())
    }

    fn background(&mut self, word: &[u8]) -> Result<(), Error> {
        let color = self.scan.vector("the background colour")?;
        self.scene.background = Background::Color(self.color(word, color)?);
        Ok(())
    }

    /// A colour in single precision.
    fn color(&self, word: &[u8], color: Vec3d) -> Result<Vec3f, Error> {
        let single = color.to_f32();
        if single.is_finite() && single.min_component() >= 0.0 {
            return Ok(single);
        }
        Err(self.scan.source.error_at(word, format!("the colour {:?} is negative or too large", color.to_array())))
    }

    fn light(&mut self, word: &[u8]) -> Result<(), Error> {
        let position = self.scan.vector("the position of the light")?;
        let color = match self.scan.numbers_in_line("the colour of the light")?.as_slice() {
            &[r, g, b] => self.color(word, Vec3d::new(r, g, b))?,
            [] => {
                self.uncolored_lights.push(self.scene.lights.len());
                Vec3f::ONE
            }
            more => {
                let what = format!("a light has a position and perhaps a colour, not {} numbers", 3 + more.len());
                return Err(self.scan.source.error_at(word, what));
            }
        };
        self.scene.lights.push(Light { kind: LightKind::Point { position }, color, inverse_square: false });
        Ok(())
    }

    fn fill(&mut self, word: &[u8]) -> Result<(), Error> {
        /// Highlight exponent, transmittance and refraction index of a file that leaves them out.
        const DEFAULTS: [f64; 3] = [0.0, 0.0, 1.0];
        let mut numbers = self.scan.numbers_in_line("a number of the material")?;
        if let given @ 5..8 = numbers.len() {
            numbers.extend(&DEFAULTS[given - 5..]);
            self.warn_at(word, format!("a material has eight numbers, not {given}: the rest is taken as 0 0 1"));
        }
        let Ok(numbers) = <[f64; 8]>::try_from(numbers.as_slice()) else {
            let what = "a material needs eight numbers: red green blue Kd Ks Shine T index";
            return Err(self.scan.source.error_at(word, format!("{what}, not {}", numbers.len())));
        };
        if let Some(extra) = self.scan.word_in_line() {
            while self.scan.word_in_line().is_some() {}
            self.warn_at(extra, format!("{} was passed over: NFF has no textures", quoted(extra)));
        }
        let mut numbers = numbers.map(|a| a as f32);
        if numbers.iter().any(|a| !a.is_finite()) {
            return Err(self.scan.source.error_at(word, "a number of the material is too large"));
        }
        if numbers[7] <= 0.0 {
            if numbers[6] > 0.0 {
                self.warn_at(word, "a refraction index must be greater than 0: 1 is taken");
            }
            numbers[7] = 1.0;
        }
        let fill = self.material(numbers);
        if let Some(what) = self.scene.materials[fill as usize].material.fault() {
            return Err(self.scan.source.error_at(word, format!("impossible material: {what}")));
        }
        self.fill = Some(fill);
        Ok(())
    }

    /// The material with these numbers, made if it is new.
    fn material(&mut self, numbers: [f32; 8]) -> u32 {
        let materials = &mut self.scene.materials;
        *self.fills.entry(numbers.map(f32::to_bits)).or_insert_with(|| {
            let [r, g, b, kd, ks, shine, t, index] = numbers;
            let material = Material {
                color: Texture::Color(Vec3f::new(r, g, b)),
                ambient: 0.0,
                diffuse: kd,
                specular: Vec3f::splat(ks),
                exponent: shine.max(0.0),
                reflect: Vec3f::splat(ks),
                transmit: Vec3f::splat(t),
                ior: index,
                ..Material::default()
            };
            materials.push(NamedMaterial { name: format!("fill-{}", materials.len() + 1), material });
            materials.len() as u32 - 1
        })
    }

    /// The material of an object that begins with `word`.
    fn current_material(&mut self, word: &[u8]) -> u32 {
        if let Some(fill) = self.fill {
            return fill;
        }
        self.warn_at(word, "an object before any \"f\": it is light grey");
        let grey = self.material([0.8, 0.8, 0.8, 1.0, 0.0, 0.0, 0.0, 1.0]);
        self.fill = Some(grey);
        grey
    }

    /// Pass over numbers after the last one of a sphere or cone: later programs put levels of detail there.
    fn pass_over_numbers(&mut self) {
        let after = self.scan;
        if let (Some(first), Ok([_, ..])) = (self.scan.word_in_line(), { after }.numbers_in_line("").as_deref()) {
            self.scan = after;
            while self.scan.word_in_line().is_some() {}
            self.warn_at(first, format!("{} and what follows in the line has no effect", quoted(first)));
        } else {
            self.scan = after;
        }
    }

    fn sphere(&mut self, word: &[u8]) -> Result<(), Error> {
        let material = self.current_material(word);
        let center = self.scan.vector("the centre of the sphere")?;
        let radius = self.scan.number("the radius of the sphere")?.abs();
        self.pass_over_numbers();
        if radius == 0.0 {
            self.warn_at(word, "a sphere of radius 0 was left out");
        } else {
            self.scene.spheres.push((center, radius, material));
        }
        Ok(())
    }

    fn cone(&mut self, word: &[u8]) -> Result<(), Error> {
        let material = self.current_material(word);
        let base = self.scan.vector("the base of the cone")?;
        let base_radius = self.scan.number("the base radius of the cone")?.abs();
        let apex = self.scan.vector("the apex of the cone")?;
        let apex_radius = self.scan.number("the apex radius of the cone")?.abs();
        self.pass_over_numbers();
        if base == apex || base_radius.max(apex_radius) == 0.0 {
            self.warn_at(word, "a cone without length or without radius was left out");
            return Ok(());
        }
        let capped = false;
        let shape = match base_radius == apex_radius {
            true => Shape::Cylinder(Cylinder { base, apex, radius: base_radius, capped }),
            false => Shape::Cone(Cone { base, apex, base_radius, apex_radius, capped }),
        };
        self.scene.shapes.push((shape, material));
        Ok(())
    }

    fn polygon(&mut self, word: &[u8], patch: bool) -> Result<(), Error> {
        /// The shortest text of three numbers.
        const CORNER_BYTES: usize = 6;
        let material = self.current_material(word);
        let count = self.scan.count("the number of corners")?;
        if count > self.scan.bytes_left().div_ceil(CORNER_BYTES) {
            let what = format!("the polygon claims {count} corners, more than the rest of the file can hold");
            return Err(self.scan.source.error_at(word, what));
        }
        let mut corners = Vec::with_capacity(count);
        let mut normals = Vec::new();
        for _ in 0..count {
            corners.push(self.scan.vector("a corner of the polygon")?);
            if patch {
                let normal = self.scan.vector("a normal of the patch")?;
                normals.push(normal.to_f32().to_array());
            }
        }
        if count < 3 {
            self.warn_at(word, "a polygon with fewer than three corners was left out");
            return Ok(());
        }
        let polygons = if patch { &mut self.smooth } else { &mut self.faceted };
        polygons
            .add(&corners, &normals, material, &mut self.work)
            .map_err(|what| self.scan.source.error_at(word, what).blame(ErrorKind::Limit))
    }

    fn finish(mut self) -> Result<Scene, Error> {
        let lights = self.scene.lights.len() as f32;
        for &light in &self.uncolored_lights {
            self.scene.lights[light].color = Vec3f::splat(1.0 / lights.sqrt());
        }
        let source = self.scan.source;
        for polygons in [self.faceted, self.smooth] {
            let mut mesh = polygons.into_mesh();
            if let Some(what) = mesh::repair(&mut mesh) {
                (self.warn)(source.error_whole(what).into_warning());
            }
            if !mesh.triangles.is_empty() {
                self.scene.meshes.push(mesh);
            }
        }
        let Scene { spheres, shapes, meshes, cameras, .. } = &self.scene;
        if cameras.is_empty() && spheres.is_empty() && shapes.is_empty() && meshes.is_empty() {
            return Err(source.error_whole("there is no view (\"v\") and no object"));
        }
        Ok(self.scene)
    }
}

impl Polygons {
    fn add(&mut self, corners: &[Vec3d], normals: &[[f32; 3]], material: u32, work: &mut u64) -> Result<(), String> {
        let vertices = u32::try_from(self.points.len() + corners.len());
        let first = self.points.len() as u32;
        if vertices.is_err() {
            return Err("more than 2^32 - 1 corners of polygons".to_owned());
        }
        let cut = polygon::triangulate(corners, work, |t| {
            self.triangles.push(t.map(|corner| first + corner as u32));
            self.materials.push(material);
        });
        if !cut {
            return Err("the concave polygons up to here take too long to cut into triangles".to_owned());
        }
        self.points.extend(corners);
        self.normals.extend(normals);
        Ok(())
    }

    fn into_mesh(self) -> Mesh {
        let (positions, origin) = mesh::place(&self.points);
        let name = if self.normals.is_empty() { "polygons" } else { "patches" };
        Mesh {
            name: name.to_owned(),
            positions,
            origin,
            triangles: self.triangles,
            normals: self.normals,
            triangle_materials: self.materials,
            ..Mesh::default()
        }
    }
}
