//! Scene, mesh and image files.
