//! What the picture shall be like: everything here can change a pixel, nothing else can.

/// The settings of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Width and height in pixels, each ≥ 1.
    pub size: [u32; 2],
    /// Generations of secondary rays: 0 = primary rays only.
    pub depth: u32,
    /// A secondary ray is not traced if the largest component of its weight is below this; 0 = never cut.
    pub min_weight: f32,
    /// Where and how to supersample.
    pub antialias: Antialias,
    /// Samples of a supersampled pixel, the first pass included; ≥ 1.
    pub antialias_max: u32,
    /// Where in a pixel its first sample lies.
    pub sampling: Sampling,
    /// How transparent things cast shadows.
    pub shadows: Shadows,
    /// Exposure in stops: linear values are multiplied by 2^exposure.
    pub exposure: f32,
    /// From linear light to what a display shows.
    pub tone: Tone,
    /// Seed of the jitter of supersampling.
    pub seed: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: [640, 480],
            depth: 5,
            min_weight: 1.0 / 255.0,
            antialias: Antialias::Edge,
            antialias_max: 8,
            sampling: Sampling::Centers,
            shadows: Shadows::Filter,
            exposure: 0.0,
            tone: Tone::Clamp,
            seed: 0,
        }
    }
}

/// Where and how to supersample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Antialias {
    /// One sample in each pixel.
    Off,
    /// The paper's rule (§3.2): pixels whose object differs from that of the pixel to the left or above.
    Paper,
    /// Both sides of a switch of object, a jump of normal or depth, or contrast.
    Edge,
    /// This many samples in every pixel.
    Uniform(u32),
}

/// Where in a pixel its first sample lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// In the middle.
    Centers,
    /// At lattice points that include the corners of the picture, as in Haines' Standard Procedural Databases.
    Corners,
}

/// How transparent things cast shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    /// Light passes, multiplied by the transmittance of every surface on its way.
    Filter,
    /// Everything casts a full shadow.
    Opaque,
}

/// From linear light to what a display shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Clamp to [0, 1], then the sRGB transfer function.
    Clamp,
    /// Compress bright light smoothly (Reinhard et al. 2002, by luminance), then the sRGB transfer function.
    Reinhard,
    /// Clamp to [0, 1], no transfer function: for comparisons with programs that write linear pixels.
    Linear,
}
