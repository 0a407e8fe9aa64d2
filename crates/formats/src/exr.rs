//! OpenEXR, the pictures that are written with all their light: linear, 32-bit floating point, not compressed.
//!
//! The layout is that of a single-part scan line file, version 2
//! (<https://openexr.com/en/latest/OpenEXRFileLayout.html>).

use std::path::Path;

use whitted::render::Image;

use crate::error::{Error, ErrorKind};

/// Magic number, and version 2 without flags: one part of scan lines.
const START: [u8; 8] = [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];

/// Channels, in the order of their names, and the component that each holds.
const CHANNELS: [(&str, usize); 3] = [("B", 2), ("G", 1), ("R", 0)];

/// Codes of the format: components of 32-bit floating point, no compression, lines from the top.
const FLOAT: i32 = 2;
const NO_COMPRESSION: u8 = 0;
const FROM_THE_TOP: u8 = 0;

/// The file of `image`: its linear colours (primaries of sRGB) as they are, before exposure and tone curve.
///
/// # Errors
/// If the picture is empty or too large for the format (2³¹ − 1 pixels on a side, or bytes in a row).
pub fn encode(image: &Image) -> Result<Vec<u8>, Error> {
    let (width, height) = (image.width as usize, image.height as usize);
    let row_bytes = width * CHANNELS.len() * size_of::<f32>();
    let (Ok(row_length), Ok(last_row)) = (i32::try_from(row_bytes), i32::try_from(image.height)) else {
        return Err(impossible("the picture is too large for the format"));
    };
    if image.pixels.is_empty() || image.pixels.len() != width * height {
        return Err(impossible("there is no picture"));
    }
    let mut file = header(width as i32, last_row);
    let block = size_of::<[i32; 2]>() + row_bytes;
    let first = file.len() + height * size_of::<u64>();
    file.reserve_exact(height * (size_of::<u64>() + block));
    for row in 0..height {
        file.extend(((first + row * block) as u64).to_le_bytes());
    }
    for (y, row) in (0..last_row).zip(image.pixels.chunks_exact(width)) {
        file.extend(y.to_le_bytes());
        file.extend(row_length.to_le_bytes());
        for (_, component) in CHANNELS {
            file.extend(row.iter().flat_map(|pixel| pixel.to_array()[component].to_le_bytes()));
        }
    }
    Ok(file)
}

fn impossible(what: &str) -> Error {
    Error::new(ErrorKind::Limit, Path::new(""), what)
}

/// Everything before the table of lines.
fn header(width: i32, height: i32) -> Vec<u8> {
    let mut header = START.to_vec();
    let window = ints(&[0, 0, width - 1, height - 1]);
    let one = 1.0_f32.to_le_bytes();
    for (name, kind, value) in [
        ("channels", "chlist", &channels()[..]),
        ("compression", "compression", &[NO_COMPRESSION]),
        ("dataWindow", "box2i", &window),
        ("displayWindow", "box2i", &window),
        ("lineOrder", "lineOrder", &[FROM_THE_TOP]),
        ("pixelAspectRatio", "float", &one),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &one),
    ] {
        header.extend(text(name).chain(text(kind)));
        header.extend((value.len() as u32).to_le_bytes());
        header.extend(value);
    }
    header.push(0);
    header
}

fn channels() -> Vec<u8> {
    // Type, no hint of how a lossy compression should take it, and a sample for every pixel.
    let description = ints(&[FLOAT, 0, 1, 1]);
    let mut list: Vec<u8> = CHANNELS.iter().flat_map(|(name, _)| text(name).chain(description.clone())).collect();
    list.push(0);
    list
}

fn text(text: &str) -> impl Iterator<Item = u8> + '_ {
    text.bytes().chain([0])
}

fn ints(values: &[i32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitted::math::Vec3f;

    fn int(bytes: &[u8], at: usize) -> usize {
        u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
    }

    #[test]
    fn every_pixel_is_where_the_table_says() {
        let (width, height) = (5, 3);
        let mut image = Image::new(width, height);
        for (number, pixel) in image.pixels.iter_mut().enumerate() {
            *pixel = Vec3f::new(number as f32, 1000.5 * number as f32, -0.25);
        }
        let file = encode(&image).unwrap();
        assert_eq!(file[..8], START);
        let table = header(width as i32, height as i32).len();
        for y in 0..height as usize {
            let line = int(&file, table + 8 * y);
            assert_eq!([int(&file, line), int(&file, line + 4)], [y, 5 * 3 * 4]);
            for x in 0..width as usize {
                for (channel, (_, component)) in CHANNELS.iter().enumerate() {
                    let bits = int(&file, line + 8 + 4 * (channel * width as usize + x)) as u32;
                    assert_eq!(f32::from_bits(bits), image.pixels[y * width as usize + x].to_array()[*component]);
                }
            }
        }
        assert_eq!(file.len(), int(&file, table + 16) + 8 + 5 * 3 * 4, "the last line ends the file");
    }

    #[test]
    fn attributes_have_their_lengths() {
        let header = header(640, 480);
        let mut at = START.len();
        let mut names = Vec::new();
        let word = |at: &mut usize| {
            let end = *at + header[*at..].iter().position(|&byte| byte == 0).unwrap();
            String::from_utf8(header[std::mem::replace(at, end + 1)..end].to_vec()).unwrap()
        };
        while header[at] != 0 {
            names.push([word(&mut at), word(&mut at)]);
            at += 4 + int(&header, at);
        }
        assert_eq!(at + 1, header.len());
        assert_eq!(names.len(), 8);
        assert!(names.is_sorted() && names.contains(&["dataWindow".to_owned(), "box2i".to_owned()]));
    }

    #[test]
    fn there_must_be_a_picture() {
        assert!(encode(&Image::new(0, 4)).is_err());
        let missing = Image { pixels: vec![Vec3f::ZERO; 3], ..Image::new(2, 2) };
        assert!(encode(&missing).is_err());
    }
}
