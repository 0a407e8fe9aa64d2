//! Lights: what is wrong with them, and how they are prepared.

use super::{Light, LightKind};
use crate::math::Vec3d;
use crate::shading::PreparedLight;

impl Light {
    /// What makes the light impossible, if anything.
    pub fn fault(&self) -> Option<&'static str> {
        if !self.color.to_array().into_iter().all(|c| c >= 0.0 && c.is_finite()) {
            return Some("its colour must be finite and not negative");
        }
        match self.kind {
            LightKind::Point { position } if !position.is_finite() => Some("its position is not finite"),
            LightKind::Point { .. } => None,
            LightKind::Directional { direction } if !direction.direction().is_finite() => {
                Some("its direction has no finite length")
            }
            LightKind::Directional { .. } => None,
            LightKind::Spot { position, look_at, inner, outer } => {
                let angles = 0.0 <= inner && inner <= outer && outer <= 180.0;
                match (look_at - position).direction().is_finite() {
                    false => Some("it must stand at a finite point and look at another one"),
                    true => (!angles).then_some("its angles must fulfil 0 ≤ inner ≤ outer ≤ 180 degrees"),
                }
            }
        }
    }

    /// The light for rendering in a space where the world point p lies at `place(p)` and world lengths are multiplied
    /// by `scale`. The light has no [`fault`](Self::fault).
    pub fn prepare(&self, place: impl Fn(Vec3d) -> Vec3d, scale: f64) -> PreparedLight {
        // Intensity is per world length: in a space of twice the lengths the same point gets a fourth, and so four times.
        let color =
            if self.inverse_square { self.color.map(|c| (f64::from(c) * scale * scale) as f32) } else { self.color };
        let point = |position: Vec3d| PreparedLight::point(place(position).to_f32(), color, self.inverse_square);
        match self.kind {
            LightKind::Point { position } => point(position),
            LightKind::Directional { direction } => PreparedLight::directional(direction.direction(), self.color),
            LightKind::Spot { position, look_at, inner, outer } => {
                point(position).within_cone((look_at - position).direction(), inner, outer)
            }
        }
    }
}
