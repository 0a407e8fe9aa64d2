//! Ray queries: what a ray hits first, whether it is free, everything on its way.
//!
//! [`RayScene`] is the whole of it: built from arrays of vertices and indices and from spheres, asked for one ray or for
//! many at a time, from any number of threads.
//!
//! ```
//! use whitted::query::RayScene;
//! use whitted::ray::Ray;
//!
//! // A square of two triangles, and a ball above it.
//! let corners = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];
//! let square = [[0, 2, 1], [0, 3, 2]];
//! let scene = RayScene::builder().mesh(&corners, &square).spheres(&[([0.0, 1.0, 0.0], 0.5)]).build()?;
//!
//! // One ray: straight down, through the ball and the square's diagonal.
//! let ray = Ray::new([0.0, 5.0, 0.0], [0.0, -1.0, 0.0]);
//! let hit = scene.closest_hit(&ray).expect("the ball");
//! assert_eq!((hit.t, hit.primitive), (3.5, 2));
//! assert_eq!(scene.normal(&ray, &hit), [0.0, 1.0, 0.0]);
//! assert_eq!(scene.all_hits(&ray).iter().map(|hit| hit.t).collect::<Vec<_>>(), [3.5, 4.5, 5.0]);
//!
//! // Can one point see another?
//! assert!(scene.occluded(&Ray::between([0.0, 5.0, 0.0], [0.0, 0.1, 0.0])));
//! # Ok::<(), whitted::query::RaySceneError>(())
//! ```
//!
//! # What holds
//! * **No holes.** Triangles that share an edge leave no gap, whatever the ray; there is no epsilon to set.
//! * **One truth.** An answer depends on scene and ray alone: not on batches, threads, tree or CPU, to the bit. Of
//!   several primitives at the same t the one with the lowest number is reported.
//! * **No bad input.** A ray with a NaN, a zero or infinite direction, an infinite origin or an inverted range hits
//!   nothing. Primitives that are degenerate or not finite are never hit.
//! * t is measured in lengths of the direction, which need not be normalised.
//!
//! # One ray or many
//! Many rays at a time are several times faster than one by one: [`closest_hit_batch`](RayScene::closest_hit_batch) and
//! its like take the caller's slices as they are ([`Rays`](crate::ray::Rays)), use all threads of the current rayon pool,
//! and return new arrays. Those with `_into` in their name write to the caller's arrays and stay on the calling thread.

mod batch;
mod builder;
mod memory;
mod moving;
mod one;
mod scene;

pub use builder::{RaySceneBuilder, RaySceneError};
pub use moving::MoveError;
pub use scene::RayScene;
