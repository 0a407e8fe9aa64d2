//! `[[light]]`.

use serde::Deserialize;
use whitted::math::Vec3f;
use whitted::scene::{Light, LightKind};

use crate::scene::decode::At;
use crate::scene::document::Fault;
use crate::scene::values::{Color, Direction, HalfAngle, NotNegative, Point};

/// A light: exactly one of "point", "direction" and "spot" says of which kind.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Light"))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct LightSection {
    /// Where a light is that shines in all directions.
    point: Option<Point>,
    /// The direction in which the light of an infinitely far source travels.
    direction: Option<Direction>,
    /// Where a light is that shines into a cone.
    spot: Option<Point>,
    /// A point in the middle of the cone of a spot.
    look_at: Option<Point>,
    /// The angle in degrees from the middle of the cone within which a spot is full. Default: 9/10 of "outer".
    inner: Option<HalfAngle>,
    /// The angle in degrees from the middle of the cone beyond which a spot gives no light. Default: 30.
    outer: Option<HalfAngle>,
    /// The colour. Default: [1, 1, 1].
    color: Option<Color>,
    /// Multiplies the colour. Default: 1.
    intensity: Option<NotNegative>,
    /// How light lessens with distance. Default: "none".
    falloff: Option<Falloff>,
}

/// How light lessens with distance.
#[derive(Debug, Deserialize, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
enum Falloff {
    /// Not at all.
    None,
    /// With the square of the distance in scene units: at distance 1 the light is as bright as stated.
    InverseSquare,
}

impl At<LightSection> {
    pub(in crate::scene) fn light(&self) -> Result<Light, Fault> {
        let section = &self.value;
        let color = section.color.map_or(Vec3f::ONE, |color| color.0);
        let color = color * section.intensity.map_or(1.0, |x| x.single());
        if !color.is_finite() {
            return Err(Fault::new(self.span.clone(), "the light is too bright"));
        }
        let kind = self.kind()?;
        Ok(Light { kind, color, inverse_square: section.falloff == Some(Falloff::InverseSquare) })
    }

    fn kind(&self) -> Result<LightKind, Fault> {
        let section = &self.value;
        let cone = section.look_at.is_some() || section.inner.is_some() || section.outer.is_some();
        match (section.point, section.direction, section.spot) {
            (Some(Point(position)), None, None) if !cone => Ok(LightKind::Point { position }),
            (None, Some(Direction(direction)), None) if !cone => Ok(LightKind::Directional { direction }),
            (None, None, Some(position)) => self.spot(position),
            (None, None, None) => Err(self.fault("a light needs \"point\", \"direction\" or \"spot\"")),
            (Some(_), None, None) | (None, Some(_), None) => {
                Err(self.fault("only a spot has \"look_at\", \"inner\" and \"outer\""))
            }
            _ => Err(self.fault("a light can have only one of \"point\", \"direction\" and \"spot\"")),
        }
    }

    fn spot(&self, Point(position): Point) -> Result<LightKind, Fault> {
        /// Degrees.
        const DEFAULT_OUTER: f64 = 30.0;
        /// Share of the outer angle.
        const DEFAULT_INNER: f64 = 0.9;
        let section = &self.value;
        let Some(Point(look_at)) = section.look_at else {
            return Err(self.fault("a spot needs \"look_at\""));
        };
        let outer = section.outer.map_or(DEFAULT_OUTER, |angle| angle.0);
        let inner = section.inner.map_or(DEFAULT_INNER * outer, |angle| angle.0);
        match () {
            () if look_at == position => Err(self.fault("the spot is where it looks at")),
            () if inner > outer => Err(self.fault("the inner angle of the spot exceeds the outer one")),
            () => Ok(LightKind::Spot { position, look_at, inner, outer }),
        }
    }

    fn fault(&self, what: &str) -> Fault {
        Fault::new(self.span.clone(), what)
    }
}
