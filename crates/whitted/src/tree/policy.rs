//! Which walk suits which rays, and why: the one place where that is decided.
//!
//! | rays | walk | measured |
//! | --- | --- | --- |
//! | 64 to 256 with one origin and one main axis: of a camera, of a light | packet, bounded by a pyramid | decisions 2, 4 and 12 |
//! | others, many at a time | lists that go down the tree together, short ones in turns | decisions 6 and 10 |
//! | very many of them, whose lists soon become short | the same, put in order before | decision 11 |
//! | one | by itself | decision 9 |
//!
//! What is not known before is found out by the walks: whether 64 neighbours make a packet, whether it stays together (it
//! has a budget, and a packet that exceeds it goes on as a list), and which lists have become short. Where too many have,
//! the rest of a large batch is put in order before it is walked (decision 11).

use super::query::{CHUNK, Counts};
use super::walk::PACKET;
use super::{Tree, TreeKind, WalkKind, reorder};
use crate::geometry::Primitives;
use crate::ray::Rays;
use std::fmt;

/// What is known about rays before they are walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RaySort {
    /// How many there are at a time.
    pub count: usize,
    /// Where they start.
    pub origins: Origins,
}

/// Where rays start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origins {
    /// Neighbours start at one point: they come from a camera or from a light.
    Shared,
    /// Each starts somewhere else: they leave surfaces.
    Own,
    /// Not known.
    Unknown,
}

/// A way through the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// There is no tree: each ray against each primitive.
    BruteForce,
    /// Packets of 64 to 256 rays, each bounded by a pyramid; what makes none, as lists.
    Packets,
    /// Lists of rays that go down the tree together, short ones in turns.
    Lists,
    /// One ray after the other.
    OneByOne,
}

/// Why a way was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// [`TreeKind::None`] was built.
    NoTree,
    /// The caller wants it so, by [`WalkKind`].
    Asked,
    /// There is only one ray.
    OneRay,
    /// Fewer rays than a packet has.
    TooFew,
    /// There are discs, boxes, cylinders or cones, which packets do not test.
    OtherShapes,
    /// Rays that start at different points fit no pyramid.
    OwnOrigins,
    /// Rays that start at one point fit a pyramid.
    SharedOrigin,
    /// Whether 64 rays fit a pyramid is seen when they are there.
    Tried,
}

/// A way and the reason for it; its text is a sentence without a full stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The way.
    pub way: Way,
    /// Why.
    pub reason: Reason,
}

/// Choose the way of rays of a sort through `tree`, over `primitives`; `asked` is what the caller wants. No answer depends
/// on it.
pub fn choose(asked: WalkKind, tree: &Tree, primitives: &Primitives, rays: &RaySort) -> Choice {
    let choice = |way, reason| Choice { way, reason };
    if tree.kind() == TreeKind::None {
        return choice(Way::BruteForce, Reason::NoTree);
    }
    match asked {
        _ if rays.count == 1 => choice(Way::OneByOne, Reason::OneRay),
        WalkKind::Single => choice(Way::OneByOne, Reason::Asked),
        WalkKind::Stream => choice(Way::Lists, Reason::Asked),
        WalkKind::Auto if !primitives.shapes().is_empty() => choice(Way::Lists, Reason::OtherShapes),
        WalkKind::Auto if rays.count < PACKET => choice(Way::Lists, Reason::TooFew),
        WalkKind::Auto => match rays.origins {
            Origins::Shared => choice(Way::Packets, Reason::SharedOrigin),
            Origins::Unknown => choice(Way::Packets, Reason::Tried),
            Origins::Own => choice(Way::Lists, Reason::OwnOrigins),
        },
    }
}

/// What a list costs beside what its rays cost, in steps of a ray by itself.
const STEPS_OF_A_LIST: u64 = 13;

/// Chunks of rays that have to be put in order together for the half of what can be saved.
const HALF: usize = 8;

/// Whether it pays to put the next rays in order before they are walked, when the first `done` of them took `counts` as they
/// came.
///
/// To move a ray and its answer takes as long as three quarters of a step that a ray makes by itself. Such steps and lists
/// become fewer, the more rays there are to choose neighbours from: measured for eight kinds of scenes, it pays from one
/// step a ray on where there are very many (docs/decisions/0011). Rays with one origin are left alone, for they make packets.
pub(super) fn pays_to_reorder(counts: &Counts, done: usize, left: Rays<'_>) -> bool {
    let chunks = left.len().min(reorder::MOST) / CHUNK;
    let steps = counts.single_steps + STEPS_OF_A_LIST * counts.lists;
    chunks >= 2 && steps * chunks as u64 > (done * (chunks + HALF)) as u64 && !share_origins(left)
}

/// True if most of some rays, evenly spread, start where the next one starts. Few, since each waits for the memory.
fn share_origins(rays: Rays<'_>) -> bool {
    const SOME: usize = 16;
    let starts_with_next = |&index: &usize| rays.get(index).origin == rays.get(index + 1).origin;
    let shared = (0..rays.len() - 1).step_by(rays.len().div_ceil(SOME)).filter(starts_with_next).count();
    2 * shared > SOME
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BruteForce => "against every primitive",
            Self::Packets => "in packets of 64 to 256, the rest in lists",
            Self::Lists => "in lists, short ones in turns",
            Self::OneByOne => "one by one",
        })
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoTree => "there is no tree",
            Self::Asked => "it was asked for",
            Self::OneRay => "there is only one",
            Self::TooFew => "there are fewer than 64",
            Self::OtherShapes => "there are other shapes than triangles, spheres and planes",
            Self::OwnOrigins => "each starts at a point of its own",
            Self::SharedOrigin => "neighbours start at one point",
            Self::Tried => "64 at a time are a packet if they start at one point and run along one axis",
        })
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, because {}", self.way, self.reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Disc, Shape, Sphere};
    use crate::math::{Vec3d, Vec3f};

    const MANY: RaySort = RaySort { count: 4096, origins: Origins::Unknown };

    fn spheres() -> Primitives {
        let mut primitives = Primitives::new();
        primitives.push_sphere(Sphere { center: Vec3f::ZERO, radius: 1.0 });
        primitives
    }

    fn way(asked: WalkKind, rays: &RaySort) -> (Way, Reason) {
        let primitives = spheres();
        let tree = Tree::build(&primitives, &TreeKind::Fast.into());
        let Choice { way, reason } = choose(asked, &tree, &primitives, rays);
        (way, reason)
    }

    #[test]
    fn rays_choose_their_walk() {
        let auto = |rays| way(WalkKind::Auto, &rays);
        assert_eq!(auto(MANY), (Way::Packets, Reason::Tried));
        assert_eq!(auto(RaySort { origins: Origins::Shared, ..MANY }), (Way::Packets, Reason::SharedOrigin));
        assert_eq!(auto(RaySort { origins: Origins::Own, ..MANY }), (Way::Lists, Reason::OwnOrigins));
        assert_eq!(auto(RaySort { count: PACKET - 1, ..MANY }), (Way::Lists, Reason::TooFew));
        assert_eq!(auto(RaySort { count: 1, ..MANY }), (Way::OneByOne, Reason::OneRay));
    }

    /// Whether it pays to reorder so many chunks of rays when a ray of the first chunk took `steps` by itself.
    fn pays(steps: f64, chunks: usize, origins: &[f32]) -> bool {
        let row: Vec<f32> = origins.iter().copied().cycle().take(chunks * CHUNK).collect();
        let counts = Counts { single_steps: (steps * CHUNK as f64) as u64, ..Counts::default() };
        pays_to_reorder(&counts, CHUNK, Rays::new([&row, &row, &row], [&row, &row, &row]))
    }

    #[test]
    fn rays_are_reordered_where_lists_are_short() {
        let apart: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        assert!(pays(1.2, 64, &apart) && !pays(1.0, 64, &apart));
        assert!(pays(2.1, 8, &apart) && !pays(1.9, 8, &apart));
        assert!(pays(6.0, 2, &apart) && !pays(100.0, 1, &apart), "a chunk is walked together anyway");
        assert!(!pays(100.0, 64, &[1.0]), "they make packets");
        let lists = Counts { lists: CHUNK as u64 / 10, ..Counts::default() };
        let row: Vec<f32> = (0..64 * CHUNK).map(|i| i as f32).collect();
        let rays = Rays::new([&row, &row, &row], [&row, &row, &row]);
        assert!(pays_to_reorder(&lists, CHUNK, rays) && !pays_to_reorder(&lists, 2 * CHUNK, rays));
        assert!(!pays_to_reorder(&Counts::default(), 0, rays), "nothing is known before the first chunk");
    }

    #[test]
    fn callers_are_obeyed() {
        let shared = RaySort { origins: Origins::Shared, ..MANY };
        assert_eq!(way(WalkKind::Stream, &shared), (Way::Lists, Reason::Asked));
        assert_eq!(way(WalkKind::Single, &shared), (Way::OneByOne, Reason::Asked));
    }

    #[test]
    fn scenes_have_a_say() {
        let none = Tree::build(&spheres(), &TreeKind::None.into());
        assert_eq!(choose(WalkKind::Auto, &none, &spheres(), &MANY).way, Way::BruteForce);
        let mut primitives = spheres();
        let normal = Vec3d::new(0.0, 1.0, 0.0);
        primitives.push_shape(Shape::Disc(Disc { center: Vec3d::ZERO, normal, radius: 1.0, inner_radius: 0.0 }));
        let tree = Tree::build(&primitives, &TreeKind::Fast.into());
        let choice = choose(WalkKind::Auto, &tree, &primitives, &MANY);
        assert_eq!(choice, Choice { way: Way::Lists, reason: Reason::OtherShapes });
        assert!(choice.to_string().starts_with("in lists, short ones in turns, because there are other shapes"));
    }
}
