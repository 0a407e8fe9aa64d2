//! From the sections of a file to a scene.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use whitted::scene::generate::GeneratedSphere;
use whitted::scene::{Mesh, NamedCamera, NamedMaterial, Scene};
use whitted::shading::Material;

use super::decode::At;
use super::document::Fault;
use super::sections::{GenerateSection, Materials, MeshSection, SceneFile};
use crate::error::{Error, ErrorKind, quoted};
use crate::files::{Context, LoadOptions};
use crate::mesh::MeshFile;
use crate::source::Source;
use crate::{Format, read_mesh, smooth, suggest};

/// The name of the material of things that name none.
const DEFAULT: &str = "default";

/// The scene that `file` describes.
pub(super) fn build(file: &SceneFile, source: Source<'_>, context: &mut Context<'_>) -> Result<Scene, Error> {
    let mut builder = Builder::begin(file, source, context)?;
    builder.objects(file)?;
    file.mesh.iter().try_for_each(|mesh| builder.mesh(mesh))?;
    file.generate.iter().try_for_each(|section| builder.generate(section))?;
    if builder.scene.lights.is_empty() && !builder.scene.cameras.is_empty() {
        let what = "there is no light: only ambient light will be seen";
        builder.context.warn(source.error_whole(what).into_warning());
    }
    Ok(builder.scene)
}

/// What `file` says about cameras, lights, materials and the picture.
pub(super) fn look(file: &SceneFile, source: Source<'_>) -> Result<Scene, Error> {
    let options = LoadOptions::default();
    Builder::begin(file, source, &mut Context::closed(&options)).map(|builder| builder.scene)
}

/// The names of materials that things get which name none, in a file that may state them or not.
pub(super) fn implied_materials(file: &SceneFile) -> Vec<String> {
    let families = file.generate.iter().filter_map(|section| match section.value.materials() {
        Materials::Family(named) => Some(named),
        Materials::Named(_) | Materials::Default => None,
    });
    families.flatten().map(|named| named.name).chain([DEFAULT.to_owned()]).collect()
}

struct Builder<'a, 'c, 'o> {
    source: Source<'a>,
    context: &'c mut Context<'o>,
    scene: Scene,
    /// Numbers of the scene's materials by name.
    materials: HashMap<String, u32>,
    /// Primitives that may still be generated.
    generated_left: u64,
    /// Mesh files read so far: their path, length, content, and the number of their first material if they have any.
    mesh_files: HashMap<PathBuf, (u64, Arc<MeshFile>, Option<u32>)>,
}

impl<'a, 'c, 'o> Builder<'a, 'c, 'o> {
    /// All but the things.
    fn begin(file: &SceneFile, source: Source<'a>, context: &'c mut Context<'o>) -> Result<Self, Error> {
        let mut builder = Builder {
            source,
            generated_left: context.options.max_generated,
            context,
            scene: Scene::default(),
            materials: HashMap::new(),
            mesh_files: HashMap::new(),
        };
        builder.check_version(&file.version)?;
        file.render.apply(&mut builder.scene, &source, builder.context.options)?;
        builder.cameras(file)?;
        for light in &file.light {
            let light = light.light().map_err(|fault| builder.error(fault))?;
            builder.scene.lights.push(light);
        }
        for (name, section) in &file.material.0 {
            builder.add_material(&name.value, section.material());
        }
        Ok(builder)
    }

    fn error(&self, fault: Fault) -> Error {
        super::error(&self.source, fault)
    }

    fn check_version(&self, version: &At<super::values::Count>) -> Result<(), Error> {
        if version.value.whole() == 1 {
            return Ok(());
        }
        let what = format!("version {} of the scene format is not supported", version.value.whole());
        let error = self.source.error(version.span.clone(), what).blame(ErrorKind::Unsupported);
        Err(error.hint("this program reads version = 1"))
    }

    fn cameras(&mut self, file: &SceneFile) -> Result<(), Error> {
        for (name, section) in &file.camera.0 {
            let camera = section.value.camera();
            if let Some(what) = camera.fault() {
                return Err(self.source.error(section.span.clone(), format!("impossible camera: {what}")));
            }
            self.scene.cameras.push(NamedCamera { name: name.value.clone(), camera });
        }
        Ok(())
    }

    fn add_material(&mut self, name: &str, material: Material) -> u32 {
        let number = self.scene.materials.len() as u32;
        self.scene.materials.push(NamedMaterial { name: name.to_owned(), material });
        self.materials.insert(name.to_owned(), number);
        number
    }

    /// The number of the material with this name.
    fn material(&mut self, name: Option<&At<String>>) -> Result<u32, Error> {
        let wanted = name.map_or(DEFAULT, |name| name.value.as_str());
        match (self.materials.get(wanted), name) {
            (Some(&number), _) => Ok(number),
            (None, Some(name)) if wanted != DEFAULT => {
                let what = format!("there is no material {}", quoted(wanted));
                let hint = suggest::hint(wanted, self.materials.keys().map(String::as_str));
                Err(self.error(Fault::new(name.span.clone(), what).hint(hint)))
            }
            _ => Ok(self.add_material(DEFAULT, Material::default())),
        }
    }

    fn objects(&mut self, file: &SceneFile) -> Result<(), Error> {
        for sphere in &file.sphere {
            let material = self.material(sphere.material.as_ref())?;
            self.scene.spheres.push((sphere.center.0, sphere.radius.0, material));
        }
        for plane in &file.plane {
            let material = self.material(plane.material.as_ref())?;
            self.scene.planes.push((plane.plane(), material));
        }
        let shapes = [
            file.disc.iter().map(|s| (s.shape(), s.value.material.as_ref())).collect::<Vec<_>>(),
            file.boxes.iter().map(|s| (s.shape(), s.value.material.as_ref())).collect(),
            file.cylinder.iter().map(|s| (s.shape(), s.value.material.as_ref())).collect(),
            file.cone.iter().map(|s| (s.shape(), s.value.material.as_ref())).collect(),
        ];
        for (shape, material) in shapes.into_iter().flatten() {
            let shape = shape.map_err(|fault| self.error(fault))?;
            let material = self.material(material)?;
            self.scene.shapes.push((shape, material));
        }
        Ok(())
    }

    fn mesh(&mut self, section: &MeshSection) -> Result<(), Error> {
        let path = self.mesh_file(&section.file)?;
        let own = match &section.material {
            None => self.own_materials(&path),
            Some(_) => None,
        };
        let fallback = match own {
            None => Some(self.material(section.material.as_ref())?),
            Some(_) => None,
        };
        let (_, file, _) = &self.mesh_files[&path];
        let mut mesh = Mesh { transform: section.transform(), ..file.mesh.clone() };
        match (own, fallback) {
            (Some(first), _) => {
                mesh.material += first;
                mesh.triangle_materials.iter_mut().for_each(|material| *material += first);
            }
            (None, fallback) => {
                mesh.material = fallback.unwrap_or_default();
                mesh.triangle_materials.clear();
            }
        }
        match section.smooth {
            Some(true) if mesh.normals.is_empty() => smooth::smooth(&mut mesh),
            Some(false) => mesh.normals.clear(),
            _ => {}
        }
        self.scene.meshes.push(mesh);
        Ok(())
    }

    /// Read the mesh file `name` unless that was done before. Gives its path.
    fn mesh_file(&mut self, name: &At<String>) -> Result<PathBuf, Error> {
        let here = |e: Error| self.source.error(name.span.clone(), e.report().what.clone()).blame(e.kind());
        let path = self.context.path_named(self.source.file, &name.value);
        if let Some((bytes, ..)) = self.mesh_files.get(&path) {
            self.context.charge(&path, *bytes).map_err(here)?;
            return Ok(path);
        }
        let format = Format::of(&path).ok().filter(|format| format.is_mesh());
        let Some(format) = format else {
            let what = format!("{} is not a mesh that can be read", quoted(&name.value));
            let error = self.source.error(name.span.clone(), what).blame(ErrorKind::Unsupported);
            return Err(error.hint("known here: .obj, .ply"));
        };
        if let Some((length, known)) = self.context.known_mesh(self.source.file, &name.value).map_err(here)? {
            self.mesh_files.insert(path.clone(), (length, known, None));
            return Ok(path);
        }
        let beginning = self.context.beginning();
        let (path, bytes) = self.context.read_named(self.source.file, &name.value).map_err(here)?;
        let length = bytes.len() as u64;
        let mut file = read_mesh(format, &path, bytes, self.context)?;
        file.mesh.name = name.value.clone();
        let file = Arc::new(file);
        self.context.keep_mesh(beginning, &file);
        self.mesh_files.insert(path.clone(), (length, file, None));
        Ok(path)
    }

    /// The number of the first of the materials that the mesh file brings, if it brings any.
    fn own_materials(&mut self, path: &PathBuf) -> Option<u32> {
        let (_, file, first) = self.mesh_files.get_mut(path)?;
        if file.materials.is_empty() {
            return None;
        }
        Some(*first.get_or_insert_with(|| {
            let first = self.scene.materials.len() as u32;
            let named =
                |m: &NamedMaterial| NamedMaterial { name: format!("{}:{}", file.mesh.name, m.name), ..m.clone() };
            self.scene.materials.extend(file.materials.iter().map(named));
            first
        }))
    }

    fn generate(&mut self, At { span, value }: &At<GenerateSection>) -> Result<(), Error> {
        let left = self.generated_left.checked_sub(value.count());
        self.generated_left = left.ok_or_else(|| {
            let limit = self.context.options.max_generated;
            let what = format!("more than {limit} things would be generated");
            self.source.error(span.clone(), what).blame(ErrorKind::Limit)
        })?;
        let spheres = value.spheres().map_err(|e| self.source.error(span.clone(), e.to_string()))?;
        let materials: Vec<u32> = match value.materials() {
            Materials::Named(names) => names.iter().map(|name| self.material(Some(name))).collect::<Result<_, _>>()?,
            Materials::Default => vec![self.material(None)?],
            Materials::Family(named) => named.into_iter().map(|m| self.known_or_new(m)).collect(),
        };
        let place = value.place();
        let sphere = |s: GeneratedSphere| {
            let material = materials[s.class as usize % materials.len()];
            (place.center + s.center * place.scale, s.radius * place.scale, material)
        };
        self.scene.spheres.extend(spheres.into_iter().map(sphere));
        Ok(())
    }

    /// The number of the material, added unless there is one of its name.
    fn known_or_new(&mut self, NamedMaterial { name, material }: NamedMaterial) -> u32 {
        match self.materials.get(&name) {
            Some(&number) => number,
            None => self.add_material(&name, material),
        }
    }
}
