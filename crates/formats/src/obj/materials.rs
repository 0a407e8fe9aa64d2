//! MTL, the material libraries of OBJ: <http://paulbourke.net/dataformats/mtl/>.
//!
//! `Kd`, `Ks`, `Ns`, `Ni`, `d`, `Tr`, `Tf` and `illum` become a [`Material`]; `Ka` has no effect, because writers put
//! anything there. The rest (textures above all) is warned of once per word. A fault passes its line over: a wrong
//! colour must not hide a right mesh.

use std::collections::HashSet;

use whitted::math::{Vec3, Vec3f};
use whitted::shading::{Material, Reflectance, Texture};

use crate::error::{Error, Warning, quoted};
use crate::source::{Source, lossy};
use crate::text::{Lines, Words, finite, trim};

/// The materials of a library by name.
pub(super) fn read(source: Source<'_>, warn: &mut dyn FnMut(Warning)) -> Vec<(Vec<u8>, Material)> {
    let mut found: Vec<(Vec<u8>, Numbers)> = Vec::new();
    let mut warned = HashSet::new();
    for line in Lines::new(source.bytes) {
        let mut words = Words::new(line);
        let Some(word) = words.next().filter(|word| word[0] != b'#') else { continue };
        if word == b"newmtl" {
            found.push((trim(words.rest()).to_vec(), Numbers::default()));
            continue;
        }
        let known = match found.last_mut() {
            Some((_, numbers)) => numbers.set(&source, word, words),
            None if warned.is_empty() => {
                warned.insert(word);
                Err(source.error_at(word, "what stands before the first \"newmtl\" was passed over"))
            }
            None => Ok(true),
        };
        match known {
            Ok(true) => {}
            Ok(false) if warned.insert(word) => {
                let what = format!("{} of materials is not supported", quoted(word));
                warn(source.error_at(word, what).into_warning());
            }
            Ok(false) => {}
            Err(e) => warn(e.into_warning()),
        }
    }
    found.into_iter().map(|(name, numbers)| (name, numbers.material())).collect()
}

/// The numbers of one material as the library gives them.
struct Numbers {
    kd: Vec3f,
    ks: Vec3f,
    tf: Option<Vec3f>,
    ns: f32,
    ni: f32,
    /// Dissolve: 1 is opaque.
    d: f32,
    illum: u32,
}

impl Default for Numbers {
    fn default() -> Self {
        Self { kd: Vec3::splat(0.8), ks: Vec3f::ZERO, tf: None, ns: 0.0, ni: 1.0, d: 1.0, illum: 2 }
    }
}

impl Numbers {
    /// Take over a property; false if it is not supported.
    fn set(&mut self, source: &Source<'_>, word: &[u8], words: Words<'_>) -> Result<bool, Error> {
        match word {
            b"Ka" => {}
            // Many writers state that nothing glows.
            b"Ke" => return Ok(color(source, word, words)? == Vec3f::ZERO),
            b"Kd" => self.kd = color(source, word, words)?,
            b"Ks" => self.ks = color(source, word, words)?,
            b"Tf" => self.tf = Some(color(source, word, words)?),
            b"Ns" => self.ns = number(source, word, words)?,
            b"Ni" => self.ni = number(source, word, words)?,
            b"d" => self.d = number(source, word, words)?.min(1.0),
            b"Tr" => self.d = 1.0 - number(source, word, words)?.min(1.0),
            b"illum" => self.illum = number(source, word, words)? as u32,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The material by the format's list of illumination models.
    fn material(&self) -> Material {
        let (highlight, mirror) = (self.illum >= 2, matches!(self.illum, 3..=9));
        let (refracts, fresnel) = (matches!(self.illum, 4 | 6 | 7 | 9), matches!(self.illum, 5 | 7));
        let filter = self.tf.unwrap_or(Vec3f::ONE);
        let transmit = match self.tf {
            // With refraction the filter alone says how much passes.
            Some(filter) if refracts && self.d == 1.0 => filter,
            _ => filter * (1.0 - self.d),
        };
        Material {
            color: Texture::Color(self.kd),
            diffuse: self.d,
            specular: if highlight { self.ks } else { Vec3f::ZERO },
            exponent: self.ns,
            reflect: if mirror { self.ks } else { Vec3f::ZERO },
            reflectance: if fresnel { Reflectance::Fresnel } else { Reflectance::Constant },
            transmit,
            ior: if (refracts || fresnel) && self.ni > 0.0 { self.ni } else { 1.0 },
            ..Material::default()
        }
    }
}

/// Three numbers, or one for all three.
fn color(source: &Source<'_>, word: &[u8], words: Words<'_>) -> Result<Vec3f, Error> {
    let numbers: Vec<f32> = words.take(3).map(|word| single(source, word)).collect::<Result<_, _>>()?;
    match *numbers.as_slice() {
        [r, g, b] => Ok(Vec3::new(r, g, b)),
        [grey] => Ok(Vec3::splat(grey)),
        _ => Err(source.error_at(word, format!("{} needs three numbers", lossy(word)))),
    }
}

/// The last word as a number: options may stand before it.
fn number(source: &Source<'_>, word: &[u8], words: Words<'_>) -> Result<f32, Error> {
    match words.last() {
        Some(last) => single(source, last),
        None => Err(source.error_at(word, format!("{} needs a number", lossy(word)))),
    }
}

fn single(source: &Source<'_>, word: &[u8]) -> Result<f32, Error> {
    let number = finite(source, word, "a property of a material")? as f32;
    match number.is_finite() && number >= 0.0 {
        true => Ok(number),
        false => Err(source.error_at(word, format!("{} is negative or too large", quoted(word)))),
    }
}
