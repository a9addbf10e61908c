//! Records: what they hold, and their bytes.
//!
//! The bytes of a record are its version and a checksum, four bytes each, lowest first, and then, encoded, a head (what
//! it is in a few words, source, terms) and the content. The checksum covers kind, name and all behind it.

use super::kind::{LONGEST_NAME, MAX_RECORD};
use super::{DatabaseError, RecordKind, StoredPhotons, materials_v1, materials_v2};
use crate::color::shipped::ComplexIndex;
use crate::color::{Origin, Spectrum};
use crate::encoding::{Integers, decode, encode};
use crate::illumination::light::{Light, SkyMap};
use crate::illumination::material::Material;
use crate::mesh::Grouped;
use crate::picture::Picture;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Bytes before the head.
const BEFORE: usize = 8;

/// A record of a database.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Its name, the only one of its kind.
    pub name: String,
    /// Where it comes from; empty where that is not known.
    pub origin: Origin,
    /// What it holds.
    pub content: RecordContent,
}

/// What a record holds.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordContent {
    /// A mesh with its groups.
    Geometry(Box<Grouped>),
    /// A picture.
    Texture(Box<Picture>),
    /// A material.
    Material(Box<Material>),
    /// A source of light.
    Light(Box<Light>),
    /// A quantity over the wavelength, or several.
    Spectrum(Curves),
    /// Stored photons of a lamp on surfaces.
    Photons(Box<StoredPhotons>),
}

/// Quantities over the wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Curves {
    /// What a surface reflects, 0..=1.
    Reflectance(Spectrum),
    /// The power of a light, relative to any unit, 0 and more.
    Light(Spectrum),
    /// Index and extinction of a metal, 0 and more.
    Metal(ComplexIndex),
    /// Functions that belong together, each with its name.
    Functions(Vec<(String, Spectrum)>),
}

/// What a list says of a record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordEntry {
    /// Its kind.
    pub kind: RecordKind,
    /// Its name.
    pub name: String,
    /// What it holds, in a few words.
    pub summary: String,
    /// What it is.
    pub what: String,
    /// Who measured or made it.
    pub source: String,
    /// Under which terms it may be passed on.
    pub terms: String,
    /// Its bytes; 0 for what ships with the program.
    pub bytes: u64,
}

/// The head of a record as it is stored.
#[derive(Serialize, Deserialize)]
struct Head {
    summary: String,
    what: String,
    source: String,
    terms: String,
}

/// A picture as it is stored: red, green, blue and coverage of each pixel, row by row from the top.
#[derive(Serialize, Deserialize)]
struct Pixels {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 4]>,
}

/// Checks that a text can be the name of a record.
///
/// # Errors
/// [`DatabaseError::Name`] if it is empty, longer than [`LONGEST_NAME`], begins or ends with a blank, or holds a
/// control character.
pub fn check_name(name: &str) -> Result<(), DatabaseError> {
    let possible = (1..=LONGEST_NAME).contains(&name.len()) && name.trim() == name;
    if possible && !name.chars().any(char::is_control) { Ok(()) } else { Err(DatabaseError::Name(name.into())) }
}

impl RecordContent {
    /// Its kind.
    pub fn kind(&self) -> RecordKind {
        match self {
            RecordContent::Geometry(_) => RecordKind::Geometry,
            RecordContent::Texture(_) => RecordKind::Texture,
            RecordContent::Material(_) => RecordKind::Material,
            RecordContent::Light(_) => RecordKind::Light,
            RecordContent::Spectrum(_) => RecordKind::Spectrum,
            RecordContent::Photons(_) => RecordKind::Photons,
        }
    }

    /// What it holds, in a few words.
    pub fn summary(&self) -> String {
        match self {
            RecordContent::Geometry(grouped) => {
                format!("{} vertices, {} triangles", grouped.mesh.vertices.len(), grouped.mesh.triangles.len())
            }
            RecordContent::Texture(picture) => format!("{} x {} pixels", picture.width(), picture.height()),
            RecordContent::Material(material) => material.word().into(),
            RecordContent::Light(light) => light.words().into(),
            RecordContent::Spectrum(curves) => curves.summary(),
            RecordContent::Photons(photons) => photons.summary(),
        }
    }

    /// Checks every number; the problem in words.
    fn check(&self) -> Result<(), String> {
        match self {
            RecordContent::Geometry(grouped) => {
                let finite = |look: &crate::mesh::MetallicRoughness| {
                    look.base.is_finite() && look.metallic.is_finite() && look.roughness.is_finite()
                };
                grouped.mesh.validate().map_err(|fault| fault.to_string())?;
                let looks = grouped.materials.iter().flatten().all(finite);
                if looks { Ok(()) } else { Err("the material of a surface is not finite".into()) }
            }
            RecordContent::Texture(picture) if picture.is_finite() => Ok(()),
            RecordContent::Texture(_) => Err("a pixel is not finite".into()),
            RecordContent::Material(material) => material.check().map_err(|error| error.to_string()),
            RecordContent::Light(light) => match light.sky_map() {
                Some(SkyMap { file, .. }) => {
                    Err(format!("the picture {file} of a sky is kept as a texture, not in a light"))
                }
                None => light.check().map_err(|error| error.to_string()),
            },
            RecordContent::Spectrum(curves) => curves.check(),
            RecordContent::Photons(photons) => photons.check(),
        }
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        match self {
            RecordContent::Geometry(grouped) => encoded(grouped),
            RecordContent::Texture(picture) => {
                let of = |p: &crate::picture::Pixel| [p.radiance[0], p.radiance[1], p.radiance[2], p.coverage];
                let pixels = picture.pixels().iter().map(of).collect();
                encoded(&Pixels { width: picture.width(), height: picture.height(), pixels })
            }
            RecordContent::Material(material) => encoded(material),
            RecordContent::Light(light) => encoded(light),
            RecordContent::Spectrum(curves) => encoded(curves),
            RecordContent::Photons(photons) => encoded(photons),
        }
    }

    /// - `version`: of the form in which it was stored, up to that of the kind.
    fn of_bytes(kind: RecordKind, version: u32, bytes: &[u8]) -> Result<RecordContent, String> {
        let content = match kind {
            RecordKind::Geometry => RecordContent::Geometry(Box::new(decoded(bytes)?)),
            RecordKind::Texture => RecordContent::Texture(Box::new(decoded::<Pixels>(bytes)?.picture()?)),
            RecordKind::Material if version == 1 => {
                RecordContent::Material(Box::new(decoded::<materials_v1::MaterialV1>(bytes)?.into()))
            }
            RecordKind::Material if version == 2 => {
                RecordContent::Material(Box::new(decoded::<materials_v2::MaterialV2>(bytes)?.into()))
            }
            RecordKind::Material => RecordContent::Material(Box::new(decoded(bytes)?)),
            RecordKind::Light => RecordContent::Light(Box::new(decoded(bytes)?)),
            RecordKind::Spectrum => RecordContent::Spectrum(decoded(bytes)?),
            RecordKind::Photons => RecordContent::Photons(Box::new(decoded(bytes)?)),
        };
        content.check().map(|()| content)
    }
}

impl Pixels {
    fn picture(self) -> Result<Picture, String> {
        let mut picture = Picture::new(self.width, self.height).map_err(|error| error.to_string())?;
        if picture.pixels().len() != self.pixels.len() {
            return Err(format!("{} pixels for {} x {}", self.pixels.len(), self.width, self.height));
        }
        for (pixel, [red, green, blue, coverage]) in picture.pixels_mut().iter_mut().zip(self.pixels) {
            (pixel.radiance, pixel.coverage) = ([red, green, blue], coverage);
        }
        Ok(picture)
    }
}

impl Curves {
    /// Each curve with its name.
    pub fn named(&self) -> Vec<(&str, &Spectrum)> {
        match self {
            Curves::Reflectance(spectrum) => vec![("reflectance", spectrum)],
            Curves::Light(spectrum) => vec![("power", spectrum)],
            Curves::Metal(metal) => vec![("n", &metal.n), ("k", &metal.k)],
            Curves::Functions(functions) => functions.iter().map(|(name, spectrum)| (&**name, spectrum)).collect(),
        }
    }

    /// What they are, in a word.
    pub fn word(&self) -> &'static str {
        match self {
            Curves::Reflectance(_) => "reflectance",
            Curves::Light(_) => "light",
            Curves::Metal(_) => "metal",
            Curves::Functions(_) => "functions",
        }
    }

    fn summary(&self) -> String {
        let curves = self.named();
        let count: usize = curves.iter().map(|(_, spectrum)| spectrum.count()).sum();
        let range = |(low, high): (f64, f64), (_, s): &(&str, &Spectrum)| (low.min(s.range().0), high.max(s.range().1));
        let (low, high) = curves.iter().fold((f64::INFINITY, 0.0), range);
        format!("{}, {count} samples, {low} to {high} nm", self.word())
    }

    /// Checks every number; the problem in words.
    pub(super) fn check(&self) -> Result<(), String> {
        let curves = self.named();
        if curves.is_empty() {
            return Err("there is no curve".into());
        }
        let (least, most) = match self {
            // A spectrum that was measured may err a little.
            Curves::Reflectance(_) => (0.0, 1.001),
            Curves::Light(_) | Curves::Metal(_) => (0.0, f64::MAX),
            Curves::Functions(_) => (f64::MIN, f64::MAX),
        };
        for (name, spectrum) in curves {
            if let Some((wavelength, value)) = spectrum.samples().find(|(_, value)| !(least..=most).contains(value)) {
                return Err(format!("{name} is {value} at {wavelength} nm: it must lie within {least} and {most}"));
            }
        }
        Ok(())
    }
}

impl Record {
    /// Its kind.
    pub fn kind(&self) -> RecordKind {
        self.content.kind()
    }

    /// What a list says of it.
    pub fn entry(&self, bytes: u64) -> RecordEntry {
        let Origin { what, source, terms } = self.origin.clone();
        RecordEntry {
            kind: self.kind(),
            name: self.name.clone(),
            summary: self.content.summary(),
            what,
            source,
            terms,
            bytes,
        }
    }

    /// Its bytes as a database holds them; the same record gives the same bytes.
    ///
    /// # Errors
    /// [`DatabaseError::Name`], [`DatabaseError::Record`] for content that is wrong, [`DatabaseError::TooLarge`] beyond
    /// [`MAX_RECORD`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, DatabaseError> {
        let (kind, name) = (self.kind(), self.name.clone());
        let failed = |problem: String| DatabaseError::Record { kind, name: name.clone(), problem };
        check_name(&self.name)?;
        self.content.check().map_err(failed)?;
        let Origin { what, source, terms } = self.origin.clone();
        let head = Head { summary: self.content.summary(), what, source, terms };
        let mut bytes = kind.version().to_le_bytes().to_vec();
        bytes.extend([0; 4]);
        bytes.extend(encoded(&head).map_err(failed)?);
        bytes.extend(self.content.bytes().map_err(failed)?);
        if bytes.len() > MAX_RECORD {
            return Err(DatabaseError::TooLarge { kind, name: self.name.clone() });
        }
        let sum = checksum(kind, &self.name, &bytes);
        bytes[4..BEFORE].copy_from_slice(&sum.to_le_bytes());
        Ok(bytes)
    }

    /// Reads what [`Record::to_bytes`] wrote, for the same kind and name.
    ///
    /// # Errors
    /// [`DatabaseError::Record`] for bytes that are damaged or of another record, [`DatabaseError::Newer`] for those of
    /// a later program.
    pub fn of_bytes(kind: RecordKind, name: &str, bytes: &[u8]) -> Result<Record, DatabaseError> {
        let failed = |problem: String| DatabaseError::Record { kind, name: name.into(), problem };
        let (version, Head { what, source, terms, .. }, content) = head(kind, name, bytes)?;
        if checksum(kind, name, bytes).to_le_bytes() != bytes[4..BEFORE] {
            return Err(failed("damaged: its checksum is another".into()));
        }
        let content = RecordContent::of_bytes(kind, version, content).map_err(failed)?;
        Ok(Record { name: name.into(), origin: Origin { what, source, terms }, content })
    }
}

impl RecordEntry {
    /// What a list says of a record, from its bytes; only its head is read.
    pub(super) fn of_bytes(kind: RecordKind, name: &str, bytes: &[u8]) -> Result<RecordEntry, DatabaseError> {
        let (_, Head { summary, what, source, terms }, _) = head(kind, name, bytes)?;
        Ok(RecordEntry { kind, name: name.into(), summary, what, source, terms, bytes: bytes.len() as u64 })
    }
}

/// The version of a record, its head, and the bytes behind it.
fn head<'a>(kind: RecordKind, name: &str, bytes: &'a [u8]) -> Result<(u32, Head, &'a [u8]), DatabaseError> {
    let failed = |problem: String| DatabaseError::Record { kind, name: name.into(), problem };
    let (before, rest) = bytes.split_at_checked(BEFORE).ok_or_else(|| failed("damaged: it has no head".into()))?;
    let version = before[..4].iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte));
    let known = kind.version();
    if version > known {
        let (found, known) = (u64::from(version), u64::from(known));
        return Err(DatabaseError::Newer { what: format!("{kind} \"{name}\""), found, known });
    }
    if version == 0 {
        return Err(failed("damaged: it has no version".into()));
    }
    let (head, used) = decode::<_, MAX_RECORD>(rest, Integers::Compact)
        .map_err(|error| failed(format!("damaged: its head cannot be read: {error}")))?;
    Ok((version, head, &rest[used..]))
}

/// The checksum over kind, name, version and all behind the checksum.
fn checksum(kind: RecordKind, name: &str, bytes: &[u8]) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    for part in [kind.word().as_bytes(), &[0], name.as_bytes(), &[0], &bytes[..4], &bytes[BEFORE..]] {
        sum.update(part);
    }
    sum.finalize()
}

/// The bytes of a record with a content of the form of an earlier version.
#[cfg(test)]
pub(super) fn earlier_for_tests(record: &Record, version: u8, content: &impl Serialize) -> Vec<u8> {
    let Origin { what, source, terms } = record.origin.clone();
    let head = Head { summary: record.content.summary(), what, source, terms };
    let mut bytes = vec![version, 0, 0, 0, 0, 0, 0, 0];
    bytes.extend(encoded(&head).expect("a head"));
    bytes.extend(encoded(content).expect("a content"));
    let sum = checksum(record.kind(), &record.name, &bytes);
    bytes[4..BEFORE].copy_from_slice(&sum.to_le_bytes());
    bytes
}

#[cfg(test)]
pub(super) fn checksum_for_tests(kind: RecordKind, name: &str, bytes: &[u8]) -> u32 {
    if bytes.len() < BEFORE { 0 } else { checksum(kind, name, bytes) }
}

fn encoded<T: Serialize>(value: &T) -> Result<Vec<u8>, String> {
    encode(value, Integers::Compact).map_err(|error| format!("it cannot be stored: {error}"))
}

fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    let (value, used) = decode::<_, MAX_RECORD>(bytes, Integers::Compact)
        .map_err(|error| format!("its content cannot be read: {error}"))?;
    if used == bytes.len() { Ok(value) } else { Err("its content is followed by other bytes".into()) }
}
