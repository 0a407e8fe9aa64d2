//! Figures 3, 4 and 5, and where the work goes: pictures of the renderer itself.

use super::stock::Stock;
use crate::report::{Block, Picture, Section, percent, plural, spaced};
use crate::session::Session;
use whitted::geometry::Plane;
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{Aov, AovPicture, Cancelled, Execution, Frame, PixelRect, Silent, Unwatched, render_rect};
use whitted::scene::generate::{PaperFamily, sphereflake};
use whitted::scene::{Antialias, Background, Camera, Light, LightKind, NamedCamera, NamedMaterial, Scene, Settings};
use whitted::shading::{Material, Texture};

/// Spheres in the scene of the pictures.
const SPHERES: u32 = 1_000;

/// Samples of a supersampled pixel of Figures 4 and 5.
const SAMPLES: u32 = 8;

/// Width and height of all pictures here: one of each is quickly rendered.
const SIZE: [u32; 2] = [640, 480];

fn mix(session: &Session) -> Stock {
    Stock::spheres(PaperFamily::Mix, SPHERES, SIZE, &session.several)
}

/// Figure 3.
pub(crate) fn importance(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "White are the pixels where a ray was not followed because it could contribute too little, before the \
        depth limit ended its branch."
            .into();
    section.differs = "The paper gives no threshold. At 1/255, the default, no cut can be seen in a picture of eight bits; a \
        larger one saves more rays. Glass is white throughout, since it reflects little; mirrors are cut where they see \
        each other often enough."
        .into();
    session.at(0.0, "the scenes of figure 3")?;
    let flake = Stock::new("sphereflake".into(), Scene { settings: single(), ..flake(FLAKE_LEVELS) }, &session.several);
    for (part, stock, id, name, threshold) in
        [(0.1, mix(session), "figure3-mix", "1/255", 1.0 / 255.0), (0.5, flake, "figure3-flake", "1/20", 1.0 / 20.0)]
    {
        session.at(part, &stock.name)?;
        let limited = |min_weight| Settings { min_weight, ..stock.scene.settings.clone() };
        let unlimited = render(session, &stock, &limited(0.0))?.statistics.rays();
        let settings = limited(threshold);
        let frame = render(session, &stock, &settings)?;
        let [mask] = &aovs(session, &stock, &settings, &frame, &[Aov::Importance])?[..] else { continue };
        let white = mask.rgb8.chunks_exact(3).filter(|pixel| pixel[0] > 0).count();
        let share = percent(white as f64 / frame.first.len() as f64);
        let caption = format!(
            "{}, no ray below a weight of {name}: {} instead of {}; {share} of the pixels are white.",
            stock.name,
            plural(frame.statistics.rays(), "ray"),
            spaced(unlimited),
        );
        let alt = format!("White where rays were cut, {share} of the picture, within spheres; black elsewhere.");
        section.blocks.push(Block::Picture(picture(id, settings.size, &mask.rgb8, caption, alt)));
    }
    Ok(())
}

/// A ray for each pixel.
fn single() -> Settings {
    Settings { antialias: Antialias::Off, size: SIZE, ..Settings::default() }
}

/// Where the work goes.
pub(crate) fn cost(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "What each pixel costs: nodes of the tree that its rays visit, and objects that they are tested against, \
        from dark for little to bright for much."
            .into();
    section.differs =
        "The paper has no such picture. It shows why a tree pays: background costs next to nothing, and what is \
        dear are not many objects but many reflections."
            .into();
    session.at(0.0, "the scene of the costs")?;
    let stock = mix(session);
    let settings = &stock.scene.settings;
    let frame = render(session, &stock, settings)?;
    for shown in aovs(session, &stock, settings, &frame, &[Aov::Nodes, Aov::Tests])? {
        let caption = format!("{}: {shown}.", stock.name);
        let alt = format!("The spheres in false colours: {}.", shown.aov.what());
        let id = format!("cost-{}", shown.aov.name());
        section.blocks.push(Block::Picture(picture(&id, settings.size, &shown.rgb8, caption, alt)));
    }
    Ok(())
}

fn aovs(
    session: &Session,
    stock: &Stock,
    settings: &Settings,
    frame: &Frame,
    wanted: &[Aov],
) -> Result<Vec<AovPicture>, Cancelled> {
    let (execution, cancel) = (Execution::default(), session.cancel);
    // No picture of time is asked for.
    let clock = || 0;
    let paint = || whitted::render::aovs(wanted, frame, &stock.prepared, settings, &execution, &clock, cancel);
    session.several.seconds(paint).0
}

/// Figure 4.
pub(crate) fn supersampling(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows = "White are the pixels that got more than one sample.".into();
    section.differs = "The paper compares a pixel's object with those to its left and above, so only one side of an edge is \
        smoothed, and edges inside reflections and of shadows are missed. By default Whitted takes both sides, and jumps of \
        normal, depth and contrast."
        .into();
    session.at(0.0, "the scene of figure 4")?;
    let stock = mix(session);
    for (rule, id, name) in
        [(Antialias::Paper, "figure4-paper", "The paper's rule"), (Antialias::Edge, "figure4-edge", "Whitted's rule")]
    {
        session.at(0.2, name)?;
        let settings = Settings { antialias: rule, antialias_max: SAMPLES, ..stock.scene.settings.clone() };
        let frame = render(session, &stock, &settings)?;
        let mask: Vec<u8> = frame.supersampled.iter().flat_map(|&white| [if white { u8::MAX } else { 0 }; 3]).collect();
        let count = frame.statistics.supersampled_pixels;
        let part = percent(count as f64 / frame.supersampled.len() as f64);
        let caption = format!("{name}: {} of {}, {part}, got {SAMPLES} samples.", plural(count, "pixel"), stock.name);
        let alt = format!("Outlines of the spheres in white on black, {part} of the picture.");
        section.blocks.push(Block::Picture(picture(id, settings.size, &mask, caption, alt)));
    }
    Ok(())
}

/// Figure 5.
pub(crate) fn example(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows = "A picture as it comes: reflections, highlights, shadows and smooth edges.".into();
    section.differs = "The paper's own scene is not published. This one, a sphereflake (Haines 1987), is older and \
        easily described: a sphere with nine smaller ones around it, each with nine around it, and so on."
        .into();
    session.at(0.0, "the scene of figure 5")?;
    let stock = Stock::new("sphereflake".into(), flake(FLAKE_LEVELS), &session.several);
    let settings = &stock.scene.settings;
    let frame = render(session, &stock, settings)?;
    let (spheres, rays) = (stock.scene.spheres.len() as u64, frame.statistics.rays());
    let caption = format!("{}, {}.", plural(spheres, "sphere"), plural(rays, "ray"));
    let alt = "A large mirroring sphere with smaller and smaller ones all around it, on a chequered floor.".to_owned();
    section.blocks.push(Block::Picture(picture(
        "figure5",
        settings.size,
        &frame.image.to_rgb8(settings),
        caption,
        alt,
    )));
    Ok(())
}

/// Levels of the sphereflake of Figure 5.
const FLAKE_LEVELS: u32 = 3;

/// A sphereflake of `levels` levels, at most 4, each in its colour, over a chequered floor.
pub(super) fn flake(levels: u32) -> Scene {
    const COLORS: [[f32; 3]; 5] =
        [[0.9, 0.75, 0.35], [0.75, 0.3, 0.25], [0.3, 0.5, 0.7], [0.35, 0.6, 0.4], [0.6, 0.45, 0.7]];
    let shiny = |color: [f32; 3]| Material {
        color: Texture::Color(color.into()),
        diffuse: 0.5,
        specular: Vec3f::splat(0.5),
        exponent: 60.0,
        reflect: Vec3f::splat(0.4),
        ..Material::default()
    };
    let tiles = Texture::Checker { even: [0.85, 0.82, 0.75].into(), odd: [0.3, 0.32, 0.36].into(), size: 0.5 };
    let floor = Material { color: tiles, diffuse: 0.8, reflect: Vec3f::splat(0.15), ..Material::default() };
    let material = |(level, material): (usize, Material)| NamedMaterial { name: format!("level {level}"), material };
    let light = |[x, y, z]: [f64; 3], strength: f32| Light {
        kind: LightKind::Point { position: Vec3d::new(x, y, z) },
        color: Vec3f::splat(strength),
        inverse_square: false,
    };
    let camera = Camera {
        eye: Vec3d::new(1.7, 1.25, 2.4),
        look_at: Vec3d::new(0.0, 0.12, 0.0),
        vfov: 36.0,
        ..Camera::default()
    };
    let spheres = sphereflake(levels).expect("four levels are few spheres");
    Scene {
        cameras: vec![NamedCamera { name: "main".to_owned(), camera }],
        lights: vec![light([4.0, 6.0, 3.0], 0.75), light([-5.0, 4.0, 4.0], 0.35)],
        ambient: Vec3f::splat(0.25),
        background: Background::Gradient { up: Vec3f::new(0.12, 0.3, 0.62), down: Vec3f::new(0.85, 0.85, 0.8) },
        materials: COLORS.map(shiny).into_iter().chain([floor]).enumerate().map(material).collect(),
        spheres: spheres.into_iter().map(|sphere| (sphere.center, sphere.radius, sphere.class)).collect(),
        planes: vec![(
            Plane { point: Vec3d::new(0.0, -0.5, 0.0), normal: Vec3d::new(0.0, 1.0, 0.0) },
            COLORS.len() as u32,
        )],
        settings: Settings { antialias_max: SAMPLES, ..Settings::default() },
        ..Scene::default()
    }
}

fn render(session: &Session, stock: &Stock, settings: &Settings) -> Result<Frame, Cancelled> {
    let (execution, rect) = (Execution::default(), PixelRect::whole(settings.size));
    let work = || render_rect(&stock.prepared, settings, &execution, &rect, &Silent, session.cancel, &Unwatched);
    session.several.seconds(work).0
}

fn picture(id: &str, size: [u32; 2], rgb8: &[u8], caption: String, alt: String) -> Picture {
    let png =
        formats::png::encode(size[0], size[1], rgb8).expect("three bytes for each pixel of a picture of this size");
    Picture { id: id.to_owned(), caption, alt, size, png }
}
