//! The formats in which pictures are written, told by the names of their files.

use crate::exit::Failure;
use std::path::Path;
use whitted::render::Image;

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureFormat {
    /// As it is seen, eight bits for each component.
    Png,
    /// Linear colours.
    Exr,
}

impl PictureFormat {
    /// The format of a file of this name; standard output takes a PNG.
    pub(crate) fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            _ if path.as_os_str() == "-" => Ok(Self::Png),
            _ => {
                let text = format!("cannot write '{}': the format must be one of: .png, .exr", path.display());
                Err(Failure::Usage(text))
            }
        }
    }

    /// The file of a picture with these linear colours, seen as `rgb8`.
    pub(crate) fn encode(self, image: &Image, rgb8: impl FnOnce() -> Vec<u8>) -> Result<Vec<u8>, Failure> {
        let file = match self {
            Self::Png => formats::png::encode(image.width, image.height, &rgb8()),
            Self::Exr => formats::exr::encode(image),
        };
        file.map_err(|error| Failure::Io(error.to_string()))
    }
}
