//! Questions about one ray.

use super::RayScene;
use super::memory::{self, Memory};
use crate::ray::{Hit, MaskedRay, Ray};
use crate::tree::{Filter, WalkKind};

/// Where [`RayScene::contains`] looks: no axis, no diagonal.
const OUTWARD: [f32; 3] = [0.37, 0.61, 0.83];

impl RayScene {
    /// The first hit within the range of a ray, ends included.
    ///
    /// ```
    /// # use whitted::{query::RayScene, ray::Ray};
    /// let scene = RayScene::from_mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]])?;
    /// let ray = Ray::new([0.25, 0.5, 2.0], [0.0, 0.0, -1.0]);
    /// let hit = scene.closest_hit(&ray).expect("the triangle");
    /// assert_eq!((hit.t, hit.u, hit.v, hit.primitive), (2.0, 0.25, 0.5, 0));
    /// // Only what is nearer than 1:
    /// assert!(scene.closest_hit(Ray { t_max: 1.0, ..ray }).is_none());
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn closest_hit(&self, ray: impl Into<MaskedRay>) -> Option<Hit> {
        let MaskedRay { ray, mask } = ray.into();
        let sees = |_: usize, primitive: u32| self.sees(mask, primitive);
        self.closest_hit_by(&ray, self.filter(mask, &sees))
    }

    /// The first hit on a primitive for which `sees` holds, as if there were no others: all but the one that a ray
    /// starts from, say.
    ///
    /// `sees` may be asked about any primitive in reach, in any order and more than once.
    ///
    /// ```
    /// # use whitted::{query::RayScene, ray::Ray};
    /// let scene = RayScene::builder().spheres(&[([0.0; 3], 1.0), ([5.0, 0.0, 0.0], 1.0)]).build()?;
    /// let ray = Ray::new([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    /// assert_eq!(scene.closest_hit(&ray).unwrap().t, 0.0);
    /// assert_eq!(scene.closest_hit_where(&ray, |primitive| primitive != 0).unwrap().t, 3.0);
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn closest_hit_where(&self, ray: &Ray, sees: impl Fn(u32) -> bool) -> Option<Hit> {
        self.closest_hit_by(ray, Some(&|_, primitive| sees(primitive)))
    }

    /// Whether anything lies within the range of a ray, ends included.
    ///
    /// ```
    /// # use whitted::{query::RayScene, ray::Ray};
    /// let scene = RayScene::builder().spheres(&[([0.0; 3], 1.0)]).build()?;
    /// assert!(scene.occluded(&Ray::between([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0])));
    /// assert!(!scene.occluded(&Ray::between([-2.0, 2.0, 0.0], [2.0, 2.0, 0.0])));
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn occluded(&self, ray: impl Into<MaskedRay>) -> bool {
        let MaskedRay { ray, mask } = ray.into();
        let sees = |_: usize, primitive: u32| self.sees(mask, primitive);
        self.occluded_by(&ray, self.filter(mask, &sees))
    }

    /// Whether a primitive for which `sees` holds lies within the range of a ray; as
    /// [`closest_hit_where`](Self::closest_hit_where).
    pub fn occluded_where(&self, ray: &Ray, sees: impl Fn(u32) -> bool) -> bool {
        self.occluded_by(ray, Some(&|_, primitive| sees(primitive)))
    }

    /// Every hit within the range of a ray, in order: t never decreases, and equal t come by primitive.
    ///
    /// What is listed are passages through surfaces. A ray exactly through an edge or vertex that triangles share passes
    /// there once where the surface goes on (the hit is that of the first triangle). Where it only touches a surface, at
    /// an edge or vertex that all triangles there leave to the same side or at the outline of a sphere, it passes twice
    /// or not at all: as a ray does that is moved aside by an infinitesimal amount, the same for the whole scene. So:
    ///
    /// * A closed surface is passed an odd number of times if and only if the ray starts inside and goes on for ever.
    /// * The first of the hits is [`closest_hit`](Self::closest_hit), which counts touches, unless that is a touch.
    ///
    /// Triangles share an edge if its ends have the same coordinates, by whatever numbers.
    ///
    /// ```
    /// # use whitted::{query::RayScene, ray::Ray};
    /// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let scene = RayScene::from_mesh(&corners, &[[0, 1, 2], [0, 2, 3]])?;
    /// // Exactly through the diagonal, which belongs to both triangles.
    /// let hits = scene.all_hits(&Ray::new([0.5, 0.5, 1.0], [0.0, 0.0, -1.0]));
    /// assert_eq!(hits.len(), 1);
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn all_hits(&self, ray: impl Into<MaskedRay>) -> Vec<Hit> {
        self.with_all_hits(ray.into(), <[Hit]>::to_vec)
    }

    /// The number of [`all_hits`](Self::all_hits).
    pub fn count_hits(&self, ray: impl Into<MaskedRay>) -> usize {
        self.with_all_hits(ray.into(), <[Hit]>::len)
    }

    /// Whether a point lies inside the surfaces of the scene, which must be closed: whether a ray from it passes them an
    /// odd number of times. Exact but for points within rounding of a surface; edges and vertices make no exception.
    ///
    /// Inside two surfaces is outside: what lies in both of two overlapping balls is not contained.
    ///
    /// ```
    /// # use whitted::query::RayScene;
    /// let shell = [([0.0; 3], 2.0), ([0.0; 3], 1.0)];
    /// let scene = RayScene::builder().spheres(&shell).build()?;
    /// assert!(scene.contains([0.0, 1.5, 0.0]));
    /// assert!(!scene.contains([0.0, 0.5, 0.0]) && !scene.contains([0.0, 2.5, 0.0]));
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn contains(&self, point: [f32; 3]) -> bool {
        self.count_hits(Ray::new(point, OUTWARD)) % 2 == 1
    }

    /// The filter for a ray with a mask; none if it sees everything.
    #[inline]
    fn filter<'f>(&self, mask: u32, sees: Filter<'f>) -> Option<Filter<'f>> {
        (mask != u32::MAX || !self.all_seen_by_all()).then_some(sees)
    }

    fn closest_hit_by(&self, ray: &Ray, filter: Option<Filter<'_>>) -> Option<Hit> {
        memory::with(|memory| {
            let hit = self.query(WalkKind::Single).closest_hit_of(ray, filter, &mut memory.scratch);
            hit.is_hit().then_some(hit)
        })
    }

    fn occluded_by(&self, ray: &Ray, filter: Option<Filter<'_>>) -> bool {
        memory::with(|memory| self.query(WalkKind::Single).is_occluded(ray, filter, &mut memory.scratch))
    }

    fn with_all_hits<T>(&self, MaskedRay { ray, mask }: MaskedRay, use_hits: impl FnOnce(&[Hit]) -> T) -> T {
        let sees = |_: usize, primitive: u32| self.sees(mask, primitive);
        memory::with(|Memory { scratch, lists, .. }| {
            lists.clear();
            let query = self.query(WalkKind::Single);
            query.all_hits(&ray, self.filter(mask, &sees), lists, scratch);
            use_hits(lists.of(0))
        })
    }
}
