//! `[render]`: what the picture shall be like.

use serde::Deserialize;
use whitted::math::Vec3f;
use whitted::scene::{Antialias, Background, Sampling, Scene, Settings, Shadows, Tone};

use crate::check;
use crate::files::LoadOptions;
use crate::scene::decode::At;
use crate::scene::loose::{FromLoose, Loose, NoTable, read_loosely};
use crate::scene::values::{Color, Count, Depth, NotNegative, Real, Samples};
use crate::source::Source;
use crate::{Error, suggest};

/// What the picture shall be like.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Render"))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct RenderSection {
    /// Width and height in pixels. Default: [640, 480].
    size: Option<At<[Count; 2]>>,
    /// Generations of reflected and refracted rays after the first rays: 0 = none. Default: 5.
    depth: Option<Depth>,
    /// Rays that count for less than this are not traced; 0 = trace all. Default: 1/255.
    min_weight: Option<NotNegative>,
    /// Anti-aliasing: "off", "paper", "edge", or a number of samples for every pixel. Default: "edge".
    aa: Option<Aa>,
    /// Samples of a pixel that "paper" or "edge" refines. Default: 8.
    aa_max: Option<Samples>,
    /// Where the first sample of a pixel lies. Default: "centers".
    sampling: Option<SamplingWord>,
    /// How transparent things cast shadows. Default: "filter".
    shadows: Option<ShadowsWord>,
    /// Exposure in stops: +1 doubles the light. Default: 0.
    exposure: Option<Real>,
    /// From linear light to what the display shows. Default: "clamp".
    tone: Option<ToneWord>,
    /// Seed of the jitter of supersampling. Default: 0.
    seed: Option<Count>,
    /// What a ray sees that hits nothing. Default: black.
    background: Option<BackgroundValue>,
    /// Light that reaches every point from everywhere; multiplies the ambient of each material. Default: [1, 1, 1].
    ambient: Option<Color>,
}

impl RenderSection {
    /// Take the section over into `scene`.
    pub(in crate::scene) fn apply(
        &self,
        scene: &mut Scene,
        source: &Source<'_>,
        options: &LoadOptions,
    ) -> Result<(), Error> {
        let default = Settings::default();
        let size = match &self.size {
            Some(At { span, value }) => check::size(value.map(|n| u64::from(n.whole())), options)
                .map_err(|(kind, what)| source.error(span.clone(), what).blame(kind))?,
            None => default.size,
        };
        scene.settings = Settings {
            size,
            depth: self.depth.map_or(default.depth, |n| n.whole()),
            min_weight: self.min_weight.map_or(default.min_weight, |x| x.single()),
            antialias: self.aa.as_ref().map_or(default.antialias, |aa| aa.0),
            antialias_max: self.aa_max.map_or(default.antialias_max, |n| n.whole()),
            sampling: self.sampling.as_ref().map_or(default.sampling, SamplingWord::value),
            shadows: self.shadows.as_ref().map_or(default.shadows, ShadowsWord::value),
            exposure: self.exposure.map_or(default.exposure, |x| x.single()),
            tone: self.tone.as_ref().map_or(default.tone, ToneWord::value),
            seed: self.seed.map_or(default.seed, |n| n.whole()),
        };
        scene.background = self.background.as_ref().map_or_else(Background::default, |b| b.0);
        scene.ambient = self.ambient.map_or(Vec3f::ONE, |color| color.0);
        Ok(())
    }
}

/// Where and how to supersample.
#[derive(Debug)]
struct Aa(Antialias);

impl FromLoose for Aa {
    const EXPECTED: &'static str = "\"off\", \"paper\", \"edge\", or a whole number of samples from 1 to 4096";
    const SCHEMA: &'static str = r#"{"anyOf": [
        {"enum": ["off", "paper", "edge"]},
        {"type": "integer", "minimum": 1, "maximum": 4096}
    ]}"#;
    type Table = NoTable;

    fn from_loose(loose: Loose<NoTable>) -> Result<Self, String> {
        Ok(Self(match loose {
            Loose::Word(word) => match word.as_str() {
                "off" => Antialias::Off,
                "paper" => Antialias::Paper,
                "edge" => Antialias::Edge,
                other => return Err(unknown(other, Self::EXPECTED, &["off", "paper", "edge"])),
            },
            number => Antialias::Uniform(Samples::from_loose(number).map_err(|_| String::new())?.whole()),
        }))
    }
}

/// A sentence about a word that is not known.
pub(super) fn unknown(word: &str, expected: &str, known: &[&str]) -> String {
    let near = suggest::nearest(word, known.iter().copied());
    let near = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
    format!("expected {expected}, found {}{near}", crate::error::quoted(word))
}

/// A colour, or a gradient.
#[derive(Debug)]
struct BackgroundValue(Background);

/// A gradient of the sky.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Gradient {
    /// The colour straight up.
    up: Color,
    /// The colour straight down.
    down: Color,
}

impl FromLoose for BackgroundValue {
    const EXPECTED: &'static str = "a colour, or { up = colour, down = colour }";
    const SCHEMA: &'static str = Color::SCHEMA;
    type Table = Gradient;

    fn from_loose(loose: Loose<Gradient>) -> Result<Self, String> {
        Ok(Self(match loose {
            Loose::Table(Gradient { up, down }) => Background::Gradient { up: up.0, down: down.0 },
            Loose::Number(x) => Background::Color(Color::from_loose(Loose::Number(x))?.0),
            Loose::Word(word) => Background::Color(Color::from_loose(Loose::Word(word))?.0),
            Loose::Triple(rgb) => Background::Color(Color::from_loose(Loose::Triple(rgb))?.0),
        }))
    }
}

/// Words of the file for values of the library.
macro_rules! words {
    ($($name:ident => $type:ident { $($(#[$doc:meta])* $variant:ident),* })*) => {$(
        #[derive(Debug, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[serde(rename_all = "kebab-case")]
        enum $name {
            $($(#[$doc])* $variant),*
        }

        impl $name {
            fn value(&self) -> $type {
                match self {
                    $(Self::$variant => $type::$variant),*
                }
            }
        }
    )*};
}

words! {
    SamplingWord => Sampling {
        /// In the middle of the pixel.
        Centers,
        /// At lattice points that include the corners of the picture.
        Corners
    }
    ShadowsWord => Shadows {
        /// Light passes, multiplied by what each surface on its way transmits.
        Filter,
        /// Everything casts a full shadow.
        Opaque
    }
    ToneWord => Tone {
        /// Cut off at white, then the sRGB transfer function.
        Clamp,
        /// Compress bright light smoothly, then the sRGB transfer function.
        Reinhard,
        /// Cut off at white, no transfer function.
        Linear
    }
}

read_loosely!(Aa, BackgroundValue);
