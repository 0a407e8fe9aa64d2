//! Scenes of spheres that any program can make from a few numbers: the paper's cubes, Haines' sphereflake, a grid.
//!
//! Built from exact operations alone: the same spheres, bit by bit, on every machine.

use super::{Antialias, Settings, Shadows};
use super::{Background, Camera, Light, LightKind, NamedCamera, NamedMaterial, Scene};
use crate::math::{SplitMix64, Vec3d, Vec3f, sin_cos_degrees};
use crate::shading::{Material, Texture};
use std::f64::consts::PI;

/// A sphere of a generated scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratedSphere {
    /// The middle.
    pub center: Vec3d,
    /// Radius, > 0.
    pub radius: f64,
    /// What decides its material: a class below [`CLASSES`], for sphereflakes the level.
    pub class: u32,
}

/// Number of material classes of cubes and grids.
pub const CLASSES: u32 = 12;

/// The part of the cube that the spheres of the paper's scenes fill.
pub const PAPER_FILL: f64 = 0.12;

/// The most spheres of a generated scene; bounds its memory to 400 megabytes.
const MAX_SPHERES: u64 = 10_000_000;

/// Places tried in vain, one after the other, before a cube is called full.
const MAX_FAILURES: u32 = 1_000_000;

/// Why a scene cannot be generated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// Too many spheres.
    #[error("{0} spheres, at most {MAX_SPHERES} are generated")]
    TooMany(u64),
    /// The filled part of the cube cannot be reached.
    #[error("spheres cannot fill {0} of the cube: use a value above 0 and at most {1}")]
    Fill(f64, f64),
    /// No place is left.
    #[error("only {placed} of {count} spheres found a place: use a smaller fill")]
    Full {
        /// Spheres that found a place.
        placed: u32,
        /// Spheres asked for.
        count: u32,
    },
}

/// `count` spheres of random places, radii and classes that do not overlap and fill about the part `fill` of the cube
/// from −1 to 1: the scenes of the paper's measurements, made with SplitMix64 from `seed` (the published scenes take
/// `count`) and [`PAPER_FILL`].
///
/// Radii are uniform in 0.7 to 1.3 of R, where spheres of radius R would fill `fill`.
///
/// # Errors
/// [`GenerateError`]; `fill` is at most 0.3, beyond which random places are hardly found.
pub fn sphere_cube(count: u32, seed: u64, fill: f64) -> Result<Vec<GeneratedSphere>, GenerateError> {
    const MAX_FILL: f64 = 0.3;
    check(count.into(), fill, MAX_FILL)?;
    let mean = mean_radius(fill, count);
    let mut random = SplitMix64::new(seed);
    let mut packing = Packing::new(count, LARGEST * mean);
    let mut failures = 0;
    while packing.spheres.len() < count as usize {
        let placed = packing.insert(random_sphere(&mut random, mean));
        failures = if placed { 0 } else { failures + 1 };
        if failures > MAX_FAILURES {
            return Err(GenerateError::Full { placed: packing.spheres.len() as u32, count });
        }
    }
    Ok(packing.spheres)
}

/// The smallest radius and the range of radii in a cube, in units of R; the largest.
const SMALLEST: f64 = 0.7;
const RANGE: f64 = 0.6;
const LARGEST: f64 = 1.3;

/// Drawn in this order: radius, x, y, z, class. The sphere lies within the cube if its radius is below 1.
fn random_sphere(random: &mut SplitMix64, mean: f64) -> GeneratedSphere {
    let radius = mean * (SMALLEST + RANGE * random.next_f64());
    let mut coordinate = || (-1.0 + radius) + (2.0 - 2.0 * radius) * random.next_f64();
    let center = Vec3d::new(coordinate(), coordinate(), coordinate());
    let class = (random.next_f64() * f64::from(CLASSES)) as u32;
    GeneratedSphere { center, radius, class }
}

/// The radius of `count` equal spheres that fill the part `fill` of the cube.
fn mean_radius(fill: f64, count: u32) -> f64 {
    const CUBE: f64 = 8.0;
    cbrt(fill * CUBE * 3.0 / (4.0 * PI * f64::from(count)))
}

/// Spheres in the cube, found by the cell that their centre lies in. Cells are at least as wide as two of the largest
/// radii, so that neighbours of a sphere lie in the 27 cells around it.
struct Packing {
    spheres: Vec<GeneratedSphere>,
    per_edge: usize,
    /// The latest sphere of each cell, and for each sphere the one before it in its cell.
    latest: Vec<Option<u32>>,
    before: Vec<Option<u32>>,
}

impl Packing {
    fn new(count: u32, largest_radius: f64) -> Self {
        // More cells than spheres would be empty.
        let enough = cbrt(f64::from(count)) as usize + 1;
        let per_edge = ((1.0 / largest_radius) as usize).clamp(1, enough);
        let latest = vec![None; per_edge * per_edge * per_edge];
        Self { spheres: Vec::with_capacity(count as usize), per_edge, latest, before: Vec::new() }
    }

    /// Add a sphere, unless it is too close to one that is there.
    fn insert(&mut self, sphere: GeneratedSphere) -> bool {
        let width = 2.0 / self.per_edge as f64;
        let cell = sphere.center.map(|c| (((c + 1.0) / width) as usize).min(self.per_edge - 1));
        let around = |c: usize| c.saturating_sub(1)..=(c + 1).min(self.per_edge - 1);
        for x in around(cell.x) {
            for y in around(cell.y) {
                if around(cell.z).any(|z| self.overlaps(self.index(x, y, z), &sphere)) {
                    return false;
                }
            }
        }
        let index = self.index(cell.x, cell.y, cell.z);
        self.before.push(self.latest[index].replace(self.spheres.len() as u32));
        self.spheres.push(sphere);
        true
    }

    /// True if a sphere of this cell is too close to `sphere`.
    fn overlaps(&self, cell: usize, sphere: &GeneratedSphere) -> bool {
        /// A gap between spheres: squared distances of centres exceed the squared sum of radii by this factor.
        const GAP: f64 = 1.0002;
        std::iter::successors(self.latest[cell], |&i| self.before[i as usize]).any(|i| {
            let other = &self.spheres[i as usize];
            let reach = other.radius + sphere.radius;
            (other.center - sphere.center).length_squared() < reach * reach * GAP
        })
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (x * self.per_edge + y) * self.per_edge + z
    }
}

/// The cube root of a positive number by Newton's iteration, to an ulp or two.
fn cbrt(x: f64) -> f64 {
    /// Doubles the correct bits from the fifth that the first guess has to all 53.
    const ITERATIONS: usize = 5;
    /// Two thirds of the bits of 1.0: the exponent's bias for the guess.
    const BIAS: u64 = 1.0_f64.to_bits() / 3 * 2;
    let guess = f64::from_bits(x.to_bits() / 3 + BIAS);
    (0..ITERATIONS).fold(guess, |y, _| (2.0 * y + x / (y * y)) / 3.0)
}

/// Haines' sphereflake ("balls" of the Standard Procedural Databases, 1987) with y up: a sphere of radius 1/2 with nine
/// children of a third of its radius, each with nine children, and so on for `depth` levels: (9^(depth+1) − 1) / 8
/// spheres, parents before their children. The class is the level.
///
/// # Errors
/// [`GenerateError::TooMany`] beyond depth 7.
pub fn sphereflake(depth: u32) -> Result<Vec<GeneratedSphere>, GenerateError> {
    const ROOT_RADIUS: f64 = 0.5;
    let count = (0..=depth).fold(0_u64, |count, _| count.saturating_mul(9).saturating_add(1));
    check_count(count)?;
    let mut spheres = Vec::with_capacity(count as usize);
    let root = GeneratedSphere { center: Vec3d::ZERO, radius: ROOT_RADIUS, class: 0 };
    add_flake(root, Vec3d::new(0.0, 0.0, 1.0), depth, &child_directions(), &mut spheres);
    // Haines' z is up.
    for sphere in &mut spheres {
        let Vec3d { x, y, z } = sphere.center;
        sphere.center = Vec3d::new(x, z, -y);
    }
    Ok(spheres)
}

/// The recursion is as deep as the flake, at most 8.
fn add_flake(
    sphere: GeneratedSphere,
    axis: Vec3d,
    depth: u32,
    directions: &[Vec3d; 9],
    spheres: &mut Vec<GeneratedSphere>,
) {
    spheres.push(sphere);
    if depth == 0 {
        return;
    }
    let radius = sphere.radius / 3.0;
    let turn = turn_from_z(axis);
    for &direction in directions {
        let axis = turn(direction);
        let center = sphere.center + axis * (sphere.radius + radius);
        add_flake(GeneratedSphere { center, radius, class: sphere.class + 1 }, axis, depth - 1, directions, spheres);
    }
}

/// Where the children of a sphere whose axis is z sit: three times one above and two on the equator.
fn child_directions() -> [Vec3d; 9] {
    let around = |azimuth: f64, sin_elevation: f64, cos_elevation: f64| {
        let (sin, cos) = sin_cos_degrees(azimuth);
        Vec3d::new(cos * cos_elevation, sin * cos_elevation, sin_elevation)
    };
    // The elevation of close-packed balls: that of a regular tetrahedron's edges.
    let (sin, cos) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let set = |turn: f64| [around(45.0 + turn, sin, cos), around(15.0 + turn, 0.0, 1.0), around(75.0 + turn, 0.0, 1.0)];
    let ([a, b, c], [d, e, f], [g, h, i]) = (set(0.0), set(120.0), set(240.0));
    [a, b, c, d, e, f, g, h, i]
}

/// The rotation that takes z to `axis` the short way.
fn turn_from_z(axis: Vec3d) -> impl Fn(Vec3d) -> Vec3d {
    let Vec3d { x: a, y: b, z: c } = axis;
    // Straight down every way is short: about the y axis.
    let k = 1.0 / (1.0 + c);
    let (x, y) = match k.is_finite() {
        true => (Vec3d::new(1.0 - a * a * k, -a * b * k, -a), Vec3d::new(-a * b * k, 1.0 - b * b * k, -b)),
        false => (Vec3d::new(-1.0, 0.0, 0.0), Vec3d::new(0.0, 1.0, 0.0)),
    };
    move |v| x * v.x + y * v.y + axis * v.z
}

/// `per_edge`³ equal spheres on a lattice that fill the part `fill` of the cube from −1 to 1; classes change from each
/// to the next.
///
/// # Errors
/// [`GenerateError`]; `fill` is at most 0.5, near π/6, where neighbours touch.
pub fn grid(per_edge: u32, fill: f64) -> Result<Vec<GeneratedSphere>, GenerateError> {
    const MAX_FILL: f64 = 0.5;
    let count = u64::from(per_edge).saturating_mul(per_edge.into()).saturating_mul(per_edge.into());
    check(count, fill, MAX_FILL)?;
    let radius = mean_radius(fill, count as u32);
    let coordinate = |i: u32| (2.0 * f64::from(i) + 1.0) / f64::from(per_edge) - 1.0;
    let lattice = (0..per_edge).flat_map(|x| (0..per_edge).flat_map(move |y| (0..per_edge).map(move |z| [x, y, z])));
    let sphere = |at: [u32; 3]| GeneratedSphere {
        center: at.map(coordinate).into(),
        radius,
        class: at.iter().sum::<u32>() % CLASSES,
    };
    Ok(lattice.map(sphere).collect())
}

fn check(count: u64, fill: f64, max_fill: f64) -> Result<(), GenerateError> {
    check_count(count)?;
    if fill > 0.0 && fill <= max_fill { Ok(()) } else { Err(GenerateError::Fill(fill, max_fill)) }
}

fn check_count(count: u64) -> Result<(), GenerateError> {
    if count <= MAX_SPHERES { Ok(()) } else { Err(GenerateError::TooMany(count)) }
}

/// The two families of scenes in which sphere cubes are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaperFamily {
    /// Half of the spheres matte, a quarter mirrors, a quarter glass.
    Mix,
    /// Every sphere diffuse, specular, reflective and transparent: a full binary tree of rays.
    All4,
}

/// The twelve materials of a family, by class: `m0` to `m11`.
///
/// The numbers are those of the peers' scenes. POV-Ray scales the ambient part by opacity; `ambient` is what remains.
pub fn paper_materials(family: PaperFamily) -> Vec<NamedMaterial> {
    (0..CLASSES)
        .map(|class| NamedMaterial { name: format!("m{class}"), material: paper_material(family, class) })
        .collect()
}

fn paper_material(family: PaperFamily, class: u32) -> Material {
    const COLORS: [[f32; 3]; 6] = [
        [0.85, 0.25, 0.20],
        [0.20, 0.65, 0.30],
        [0.25, 0.35, 0.85],
        [0.85, 0.75, 0.20],
        [0.70, 0.30, 0.75],
        [0.80, 0.80, 0.80],
    ];
    let material = |ambient, diffuse, specular, exponent, reflect, transmit, ior| Material {
        color: Texture::Color(COLORS[class as usize % COLORS.len()].into()),
        ambient,
        diffuse,
        specular: Vec3f::splat(specular),
        exponent,
        reflect: Vec3f::splat(reflect),
        transmit: Vec3f::splat(transmit),
        ior,
        ..Material::default()
    };
    match (family, class) {
        (PaperFamily::All4, _) => material(0.1, 0.35, 0.3, 40.0, 0.25, 0.4, 1.5),
        (PaperFamily::Mix, 0..6) => material(0.1, 0.8, 0.3, 40.0, 0.0, 0.0, 1.0),
        (PaperFamily::Mix, 6..9) => material(0.1, 0.3, 0.5, 80.0, 0.6, 0.0, 1.0),
        (PaperFamily::Mix, _) => material(0.005, 0.05, 0.5, 80.0, 0.1, 0.85, 1.5),
    }
}

/// The scene `mix-N` or `all4-N` of the measurements: `count` spheres from seed `count`, two lights without fall-off,
/// 640 × 480, depth 5, cut-off 1/255, no supersampling, opaque shadows.
///
/// # Errors
/// [`GenerateError`] for more than ten million spheres.
pub fn paper_scene(family: PaperFamily, count: u32) -> Result<Scene, GenerateError> {
    let spheres = sphere_cube(count, count.into(), PAPER_FILL)?;
    let camera = Camera { eye: Vec3d::new(2.2, 1.5, 3.4), look_at: Vec3d::ZERO, vfov: 36.0, ..Camera::default() };
    let light = |position: [f64; 3], color: [f32; 3]| Light {
        kind: LightKind::Point { position: position.into() },
        color: color.into(),
        inverse_square: false,
    };
    Ok(Scene {
        cameras: vec![NamedCamera { name: "main".to_owned(), camera }],
        lights: vec![light([12.0, 14.0, 10.0], [0.65, 0.65, 0.60]), light([-14.0, 9.0, 8.0], [0.40, 0.42, 0.50])],
        ambient: Vec3f::ONE,
        background: Background::Color(Vec3f::new(0.20, 0.30, 0.50)),
        materials: paper_materials(family),
        spheres: spheres.into_iter().map(|s| (s.center, s.radius, s.class)).collect(),
        settings: Settings { antialias: Antialias::Off, shadows: Shadows::Opaque, ..Settings::default() },
        ..Scene::default()
    })
}
