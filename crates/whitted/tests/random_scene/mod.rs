//! Small scenes of everything, a part of it degenerate.

use whitted::geometry::{Boxed, Cone, Cylinder, Disc, Plane, Shape};
use whitted::math::{SplitMix64, Vec3, Vec3d, Vec3f};
use whitted::scene::{Background, Camera, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Scene};
use whitted::shading::{Material, Reflectance, SpecularModel, Texture};

/// A scene of up to about 60 primitives; the same for the same seed.
pub(crate) fn random_scene(seed: u64) -> Scene {
    let mut random = Random(SplitMix64::new(seed));
    let materials: Vec<NamedMaterial> = (0..6).map(|index| random.material(index)).collect();
    let count = random.0.below(20);
    Scene {
        cameras: vec![NamedCamera { name: String::new(), camera: random.camera() }],
        lights: (0..random.0.below(4)).map(|_| random.light()).collect(),
        ambient: random.color(),
        background: Background::Gradient { down: random.color(), up: random.color() },
        materials,
        spheres: (0..count).map(|_| random.sphere()).collect(),
        shapes: (0..random.0.below(10)).map(|_| random.shape()).collect(),
        planes: (0..random.0.below(2)).map(|_| random.plane()).collect(),
        meshes: (0..random.0.below(3)).map(|_| random.mesh()).collect(),
        ..Scene::default()
    }
}

struct Random(SplitMix64);

impl Random {
    /// Often a whole number, so that planes, edges and vertices coincide.
    fn coordinate(&mut self) -> f64 {
        let a = self.0.uniform(-2.0, 2.0);
        if self.0.below(3) == 0 { a.round() } else { a }
    }

    fn point(&mut self) -> Vec3d {
        Vec3::new(self.coordinate(), self.coordinate(), self.coordinate())
    }

    fn unit(&mut self) -> f32 {
        self.0.next_f64() as f32
    }

    fn color(&mut self) -> Vec3f {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }

    /// A colour that is black half of the time.
    fn maybe_color(&mut self) -> Vec3f {
        if self.0.below(2) == 0 { Vec3f::ZERO } else { self.color() }
    }

    fn camera(&mut self) -> Camera {
        let away = Vec3::new(self.coordinate(), self.coordinate(), 4.0 + self.coordinate());
        Camera { eye: away, vfov: self.0.uniform(20.0, 100.0), ..Camera::default() }
    }

    fn light(&mut self) -> Light {
        let position = self.point() * 3.0;
        let kind = match self.0.below(3) {
            0 => LightKind::Point { position },
            1 => LightKind::Directional { direction: position + Vec3d::new(0.0, 0.01, 0.0) },
            _ => LightKind::Spot {
                position: position + Vec3d::splat(0.1),
                look_at: Vec3d::ZERO,
                inner: 20.0,
                outer: 35.0,
            },
        };
        Light { kind, color: self.color(), inverse_square: self.0.below(3) == 0 }
    }

    fn material(&mut self, index: usize) -> NamedMaterial {
        let color = match self.0.below(3) {
            0 => Texture::Checker { even: self.color(), odd: self.color(), size: 0.3 + self.unit() },
            _ => Texture::Color(self.color()),
        };
        let reflectance = [Reflectance::Constant, Reflectance::Fresnel, Reflectance::Schlick];
        let material = Material {
            color,
            ambient: self.unit(),
            diffuse: self.unit(),
            specular: self.maybe_color(),
            exponent: self.unit() * 100.0,
            specular_model: if self.0.below(2) == 0 { SpecularModel::Phong } else { SpecularModel::Blinn },
            reflect: self.maybe_color(),
            reflectance: reflectance[self.0.below(3) as usize],
            transmit: self.maybe_color(),
            ior: 0.7 + self.unit(),
            absorb: self.maybe_color(),
        };
        NamedMaterial { name: format!("material {index}"), material }
    }

    fn index(&mut self) -> u32 {
        self.0.below(6)
    }

    fn radius(&mut self) -> f64 {
        // Zero is degenerate; negative ones count by their size.
        [0.0, -0.5, 1.0, 0.25, 0.7][self.0.below(5) as usize]
    }

    fn sphere(&mut self) -> (Vec3d, f64, u32) {
        (self.point(), self.radius(), self.index())
    }

    fn shape(&mut self) -> (Shape, u32) {
        let (a, b) = (self.point(), self.point());
        let radius = self.radius().abs();
        let shape = match self.0.below(4) {
            0 => Shape::Disc(Disc { center: a, normal: b, radius, inner_radius: radius * 0.5 }),
            1 => Shape::Boxed(Boxed { lo: a.min(b), hi: a.max(b) }),
            2 => Shape::Cylinder(Cylinder { base: a, apex: b, radius, capped: self.0.below(2) == 0 }),
            _ => Shape::Cone(Cone { base: a, apex: b, base_radius: radius, apex_radius: 0.1, capped: true }),
        };
        (shape, self.index())
    }

    fn plane(&mut self) -> (Plane, u32) {
        let normal = Vec3::new(self.coordinate() * 0.1, 1.0, self.coordinate() * 0.1);
        (Plane { point: Vec3::new(0.0, -2.0, 0.0), normal }, self.index())
    }

    /// Triangles among a few vertices: many share edges, some are degenerate, some occur twice.
    fn mesh(&mut self) -> Mesh {
        let vertices = 3 + self.0.below(6);
        let triangles = (0..self.0.below(24)).map(|_| [0; 3].map(|_: u32| self.0.below(vertices))).collect::<Vec<_>>();
        let positions = (0..vertices).map(|_| self.point().to_f32().to_array()).collect();
        let normals = match self.0.below(2) {
            0 => Vec::new(),
            _ => (0..vertices).map(|_| self.point().to_f32().to_array()).collect(),
        };
        Mesh { positions, triangles, normals, material: self.index(), ..Mesh::default() }
    }
}
