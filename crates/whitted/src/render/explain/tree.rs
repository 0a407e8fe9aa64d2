//! The rays of a pixel as data.

use crate::math::{Vec3d, Vec3f};

/// What is known about a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTree {
    /// Its column and row in the picture.
    pub pixel: [u32; 2],
    /// Samples that it has; 0 outside the picture.
    pub sample_count: u32,
    /// Its linear colour in the picture: the mean of all its samples.
    pub color: Vec3f,
    /// Those of its samples that were asked for, in order.
    pub samples: Vec<SampleTree>,
}

/// One sample of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleTree {
    /// Its number in the pixel.
    pub number: u32,
    /// Where it lies, in pixels from the upper left corner of the picture.
    pub place: [f32; 2],
    /// Its linear colour: the sum of [`TracedRay::light`] over all rays, in fixed point of 2⁻³².
    pub color: Vec3f,
    /// Its rays: the camera ray first, each followed by its shadow rays and by all that descends from it.
    pub rays: Vec<TracedRay>,
}

/// A ray of a sample, or one that was not worth tracing. In world space.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedRay {
    /// Where it comes from.
    pub kind: RayKind,
    /// The ray that hit the surface from which it comes, by its number in [`SampleTree::rays`]; none for a camera ray.
    pub parent: Option<usize>,
    /// Surfaces between the eye and its origin; shadow rays count as the ray whose surface they light.
    pub generation: u32,
    /// Where it starts. Shadow rays may start at the lamp.
    pub origin: Vec3d,
    /// Unit direction.
    pub direction: Vec3d,
    /// How far it goes; infinite if nothing ends it.
    pub length: f64,
    /// The share of its light that reaches the eye. For shadow rays, the light that arrives if nothing is in the way.
    pub weight: Vec3f,
    /// How it ends.
    pub end: RayEnd,
    /// Light that its sample gains at its end.
    pub light: Vec3f,
}

/// Where a ray comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// The eye.
    Camera,
    /// A surface, mirrored.
    Reflected,
    /// A surface, through which it goes.
    Refracted,
    /// Between a surface and a lamp, by its number in the scene.
    Shadow(usize),
}

/// How a ray ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayEnd {
    /// It hits nothing and sees the background.
    Missed,
    /// It hits a surface. What leaves that comes after it; nothing does if the surface neither mirrors nor transmits.
    Hit(SurfaceHit),
    /// A shadow ray that nothing blocks.
    Clear,
    /// A shadow ray that goes through transparent surfaces only, which colour its light.
    Filtered,
    /// A shadow ray that something blocks: of all in the way, what is nearest to its origin.
    Blocked {
        /// Its object, as in [`SurfaceHit`].
        object: u32,
        /// Its primitive, as in [`SurfaceHit`].
        primitive: u32,
    },
    /// A shadow ray that was not traced: the surface looks away from the lamp.
    FacesAway,
    /// Not traced: its weight is below the least that the settings allow.
    WeightLimit,
    /// Not traced: the depth of the settings is reached.
    DepthLimit,
    /// Not traced: its sample has no rays left.
    BudgetSpent,
    /// A refracted ray that does not exist: the surface reflects totally. It has no direction.
    TotalReflection,
}

impl RayEnd {
    /// False for rays that were not traced.
    pub fn is_traced(&self) -> bool {
        match self {
            Self::Missed | Self::Hit(_) | Self::Clear | Self::Filtered | Self::Blocked { .. } => true,
            Self::FacesAway | Self::WeightLimit | Self::DepthLimit | Self::BudgetSpent | Self::TotalReflection => false,
        }
    }
}

/// Where a ray hits a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Its object, as [`Geometry::object`](crate::scene::Geometry::object) numbers them.
    pub object: u32,
    /// Its primitive.
    pub primitive: u32,
    /// Its material, by its number in the scene.
    pub material: u32,
    /// The point.
    pub position: Vec3d,
    /// Shading unit normal on the side from which the ray comes.
    pub n_s: Vec3f,
    /// Geometric unit normal on that side.
    pub n_g: Vec3f,
    /// True if the ray goes against the surface's own normal: into the body.
    pub enters: bool,
    /// The ray's weight there, after what the medium on the way has absorbed.
    pub weight: Vec3f,
}

impl RayTree {
    /// A pixel that the picture does not have.
    pub(super) fn outside(pixel: [u32; 2]) -> Self {
        Self { pixel, sample_count: 0, color: Vec3f::ZERO, samples: Vec::new() }
    }
}

impl TracedRay {
    /// Where it ends; `None` if it goes on for ever or was not traced.
    pub fn end_point(&self) -> Option<Vec3d> {
        (self.end.is_traced() && self.length.is_finite()).then(|| self.origin + self.direction * self.length)
    }
}
