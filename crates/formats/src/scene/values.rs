//! Numbers, points and colours, each with the rule that its values keep.

use std::marker::PhantomData;

use serde::{Deserialize, Deserializer};
use whitted::math::{Vec3, Vec3d, Vec3f};

use super::color::parse_hex;
use super::loose::{self, FromLoose, Loose, NoTable, read_loosely};

/// Which numbers are allowed.
pub(super) trait Rule {
    /// What is expected, for errors.
    const EXPECTED: &'static str;
    /// The JSON schema.
    #[cfg_attr(not(feature = "schema"), allow(dead_code, reason = "only the schema reads it; schemas name each other"))]
    const SCHEMA: &'static str;

    /// True if the number `x`, finite in single precision, is allowed.
    fn allows(x: f64) -> bool;
}

/// A number that `R` allows and that single precision can hold.
#[derive(Debug)]
pub(super) struct Number<R>(pub(super) f64, PhantomData<R>);

impl<R> Clone for Number<R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Number<R> {}

impl<R> Number<R> {
    /// In single precision.
    pub(super) fn single(self) -> f32 {
        self.0 as f32
    }
}

impl<R: Rule> FromLoose for Number<R> {
    const EXPECTED: &'static str = R::EXPECTED;
    const SCHEMA: &'static str = R::SCHEMA;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        match loose {
            Loose::Number(x) if x.abs() <= f64::from(f32::MAX) && R::allows(x) => Ok(Self(x, PhantomData)),
            Loose::Number(x) => Err(format!("expected {}, found {x}", R::EXPECTED)),
            _ => Err(String::new()),
        }
    }
}

impl<'de, R: Rule> Deserialize<'de> for Number<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        loose::deserialize(deserializer)
    }
}

/// A rule by name, words, JSON schema and condition.
macro_rules! rules {
    ($($(#[$doc:meta])* $name:ident $alias:ident $expected:literal $schema:literal $allows:expr;)*) => {$(
        #[derive(Debug)]
        pub(super) enum $name {}

        $(#[$doc])*
        pub(super) type $alias = Number<$name>;

        impl Rule for $name {
            const EXPECTED: &'static str = $expected;
            const SCHEMA: &'static str = $schema;

            fn allows(x: f64) -> bool {
                let allows: fn(f64) -> bool = $allows;
                allows(x)
            }
        }

        #[cfg(feature = "schema")]
        impl schemars::JsonSchema for Number<$name> {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($alias).into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                crate::scene::schema::of_loose::<Self>(generator)
            }
        }
    )*};
}

rules! {
    /// Any finite number.
    AnyRule Real "a number" r#"{"type": "number"}"# |_| true;
    /// A length, also in single precision.
    PositiveRule Positive "a number greater than 0" r#"{"type": "number", "exclusiveMinimum": 0}"# |x| x as f32 > 0.0;
    /// A strength, an exponent.
    NotNegativeRule NotNegative "a number that is at least 0" r#"{"type": "number", "minimum": 0}"# |x| x >= 0.0;
    /// A view angle in degrees.
    AngleRule Angle "an angle between 0 and 180 degrees"
        r#"{"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180}"# |x| x > 0.0 && x < 180.0;
    /// Half the opening of a cone of light in degrees.
    HalfAngleRule HalfAngle "an angle from 0 to 180 degrees"
        r#"{"type": "number", "minimum": 0, "maximum": 180}"# |x| (0.0..=180.0).contains(&x);
    /// A number of things.
    CountRule Count "a whole number from 0 to 4294967295"
        r#"{"type": "integer", "minimum": 0, "maximum": 4294967295}"#
        |x| x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&x);
    /// A number of generations.
    DepthRule Depth "a whole number from 0 to 1000" r#"{"type": "integer", "minimum": 0, "maximum": 1000}"#
        |x| x.fract() == 0.0 && (0.0..=1000.0).contains(&x);
    /// A number of samples in a pixel.
    SamplesRule Samples "a whole number from 1 to 4096" r#"{"type": "integer", "minimum": 1, "maximum": 4096}"#
        |x| x.fract() == 0.0 && (1.0..=4096.0).contains(&x);
}

impl<R> Number<R> {
    /// A number whose rule says that it is whole and fits.
    pub(super) fn whole(self) -> u32 {
        self.0 as u32
    }
}

/// A point, or a direction of any length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point(pub(super) Vec3d);

impl FromLoose for Point {
    const EXPECTED: &'static str = "three numbers [x, y, z]";
    const SCHEMA: &'static str = TRIPLE;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        match loose {
            Loose::Triple(xyz) if xyz.iter().all(|a| a.is_finite()) => Ok(Self(xyz.into())),
            _ => Err(String::new()),
        }
    }
}

/// The schema of three numbers.
#[cfg_attr(not(feature = "schema"), allow(dead_code, reason = "only the schema reads it; schemas name each other"))]
const TRIPLE: &str = r#"{"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}"#;

/// A direction: not zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction(pub(super) Vec3d);

impl FromLoose for Direction {
    const EXPECTED: &'static str = "a direction [x, y, z] that is not zero";
    const SCHEMA: &'static str = TRIPLE;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        match Point::from_loose(loose) {
            Ok(Point(xyz)) if xyz != Vec3d::ZERO => Ok(Self(xyz)),
            _ => Err(String::new()),
        }
    }
}

/// A linear colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Color(pub(super) Vec3f);

impl FromLoose for Color {
    const EXPECTED: &'static str =
        "a colour: three linear numbers [red, green, blue] that are at least 0, or \"#rrggbb\" (sRGB)";
    const SCHEMA: &'static str = r##"{"anyOf": [
        {"type": "array", "items": {"type": "number", "minimum": 0}, "minItems": 3, "maxItems": 3},
        {"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"}
    ]}"##;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        match loose {
            Loose::Triple(rgb) => {
                let color = Vec3d::from(rgb).to_f32();
                let allowed = color.is_finite() && color.min_component() >= 0.0;
                if allowed { Ok(Self(color)) } else { Err(String::new()) }
            }
            Loose::Word(word) => parse_hex(&word).map(Self).ok_or_else(String::new),
            _ => Err(String::new()),
        }
    }
}

/// A strength, the same for all colours or one for each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strength(pub(super) Vec3f);

impl FromLoose for Strength {
    const EXPECTED: &'static str = "a strength: a number that is at least 0, or a colour";
    const SCHEMA: &'static str = r##"{"anyOf": [
        {"type": "number", "minimum": 0},
        {"type": "array", "items": {"type": "number", "minimum": 0}, "minItems": 3, "maxItems": 3},
        {"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"}
    ]}"##;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        match loose {
            Loose::Number(x) if x >= 0.0 && (x as f32).is_finite() => Ok(Self(Vec3::splat(x as f32))),
            Loose::Number(_) => Err(String::new()),
            color => Color::from_loose(color).map(|Color(color)| Self(color)),
        }
    }
}

/// A factor for all axes or one for each, none of them 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale(pub(super) Vec3d);

impl FromLoose for Scale {
    const EXPECTED: &'static str = "a factor that is not 0, or three of them [x, y, z]";
    const SCHEMA: &'static str = r#"{"anyOf": [
        {"type": "number"},
        {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
    ]}"#;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        let scale = match loose {
            Loose::Number(x) => Vec3::splat(x),
            Loose::Triple(xyz) => xyz.into(),
            _ => return Err(String::new()),
        };
        let allowed = scale.is_finite() && scale.abs().min_component() > 0.0;
        if allowed { Ok(Self(scale)) } else { Err(String::new()) }
    }
}

read_loosely!(Point, Direction, Color, Strength, Scale);
