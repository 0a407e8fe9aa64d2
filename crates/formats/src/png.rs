//! PNG, the pictures that are written: eight bits per component, sRGB.

use std::path::Path;

use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

use crate::error::{Error, ErrorKind};

/// The file of a picture of `width · height` pixels: `rgb8` holds red, green and blue of each, row by row from the top
/// left. The file says that the values are sRGB.
///
/// # Errors
/// If `rgb8` has another length, or the picture is empty or too large for the format (2³¹ − 1 pixels on a side).
pub fn encode(width: u32, height: u32, rgb8: &[u8]) -> Result<Vec<u8>, Error> {
    encode_described(width, height, rgb8, "")
}

/// As [`encode`], with a line of text in the file that says what the picture shows, if it is not empty.
///
/// # Errors
/// As [`encode`]; also for characters beyond Latin-1.
pub fn encode_described(width: u32, height: u32, rgb8: &[u8], description: &str) -> Result<Vec<u8>, Error> {
    let fail = |kind, what: String| Error::new(kind, Path::new(""), what);
    let expected = 3 * u128::from(width) * u128::from(height);
    if rgb8.len() as u128 != expected {
        let what = format!("a picture of {width}×{height} pixels needs {expected} bytes, not {}", rgb8.len());
        return Err(fail(ErrorKind::Input, what));
    }
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fast);
    let described = match description {
        "" => Ok(()),
        text => encoder.add_text_chunk("Description".to_owned(), text.to_owned()),
    };
    let written = described.and_then(|()| encoder.write_header()).and_then(|mut writer| {
        writer.write_image_data(rgb8)?;
        writer.finish()
    });
    match written {
        Ok(()) => Ok(file),
        Err(e) => Err(fail(ErrorKind::Limit, format!("cannot encode the picture: {e}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_can_be_read() {
        for (width, height) in [(1, 1), (3, 2), (64, 48), (1, 300)] {
            let pixels: Vec<u8> = (0..3 * width * height).map(|i| (i * i % 251) as u8).collect();
            let file = encode(width, height, &pixels).unwrap();
            let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
            assert!(reader.info().srgb.is_some());
            let mut decoded = vec![0; reader.output_buffer_size().unwrap()];
            let info = reader.next_frame(&mut decoded).unwrap();
            assert_eq!((info.width, info.height, info.color_type), (width, height, ColorType::Rgb));
            assert_eq!(decoded, pixels);
        }
    }

    #[test]
    fn descriptions_are_kept() {
        let file = encode_described(1, 1, &[1, 2, 3], "depth, 2 to 4").unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let [text] = &reader.info().uncompressed_latin1_text[..] else { panic!("one text") };
        assert_eq!((&*text.keyword, &*text.text), ("Description", "depth, 2 to 4"));
        assert!(encode_described(1, 1, &[1, 2, 3], "\u{2192}").is_err());
    }

    #[test]
    fn wrong_sizes_are_refused() {
        assert_eq!(encode(2, 2, &[0; 11]).unwrap_err().kind(), ErrorKind::Input);
        assert!(encode(0, 0, &[]).is_err());
        assert!(encode(u32::MAX, u32::MAX, &[0; 3]).is_err());
    }
}
