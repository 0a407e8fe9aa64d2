//! Finding what a ray hits: the builder, the trees, the walks and the brute-force oracle.

/// Which splits the builder may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TreeKind {
    /// No tree: every ray against every primitive.
    None,
    /// Spatial splits only: the cells of a kd-tree.
    Kd,
    /// Object splits only: quick to build and refittable.
    Fast,
    /// Object and spatial splits compete.
    #[default]
    Best,
}

/// How rays are walked through the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum WalkKind {
    /// The walk that suits the kind of ray.
    #[default]
    Auto,
    /// Lists of up to 4096 rays pushed through the tree together.
    Stream,
    /// One ray after the other.
    Single,
}
