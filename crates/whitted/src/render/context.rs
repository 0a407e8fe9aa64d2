//! What every part of a render reads.

use super::execution::Execution;
use super::progress::Cancel;
use crate::classic::Caster;
use crate::math::Vec3f;
use crate::scene::{Antialias, CameraRays, Geometry, Look, Prepared, Settings};
use crate::tree::Query;

/// What every part of a render reads and none changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Context<'a> {
    pub(super) geometry: &'a Geometry,
    pub(super) look: &'a Look,
    pub(super) settings: &'a Settings,
    pub(super) execution: &'a Execution,
    pub(super) cancel: &'a Cancel,
    pub(super) camera: CameraRays,
    /// The tree, with the walk and instruction set that were asked for.
    pub(super) query: Query<'a>,
    /// What the recursive renderer asks instead of the tree.
    pub(super) caster: Option<Caster<'a>>,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        prepared: &'a Prepared,
        settings: &'a Settings,
        execution: &'a Execution,
        cancel: &'a Cancel,
    ) -> Self {
        let geometry = prepared.geometry();
        let query = Query {
            tree: geometry.tree(),
            primitives: geometry.primitives(),
            level: execution.level,
            walk: execution.walk,
        };
        let camera = CameraRays::new(prepared.look().camera(), settings.size, settings.sampling);
        Self { geometry, look: prepared.look(), settings, execution, cancel, camera, query, caster: None }
    }

    /// Whether what the first samples see must be kept.
    pub(super) fn keeps_first_samples(&self) -> bool {
        self.execution.first_samples || matches!(self.settings.antialias, Antialias::Paper | Antialias::Edge)
    }

    /// The material number of a primitive.
    #[inline]
    pub(super) fn material_of(&self, primitive: u32) -> u32 {
        self.look.primitive_materials()[primitive as usize]
    }

    /// The share of light that a primitive lets pass on its way to other things.
    pub(super) fn filter(&self, primitive: u32) -> Vec3f {
        self.look.material(self.material_of(primitive)).transmit()
    }
}
