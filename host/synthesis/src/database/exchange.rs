//! Records from files, and files from records.
//!
//! Meshes come and go in the formats of meshes, pictures in those of pictures, spectra as columns of text (see
//! [`columns`]), and all but meshes and pictures as JSON: `{"name": "...", "source": "...", "terms": "...", "material":
//! {...}}`, with `light` or `spectrum` in place of `material`.

use super::{Curves, DatabaseError, Record, RecordContent, check_name};
use crate::color::shipped::ComplexIndex;
use crate::color::{Extrapolation, Origin, Spectrum, columns};
use crate::illumination::{Light, Material};
use crate::memory;
use crate::mesh;
use crate::picture::Picture;
use files::Destination;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;

/// The longest text that is read, bytes.
const MAX_TEXT: u64 = 64 << 20;

/// What the columns of a text are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ColumnQuantity {
    /// Each what a surface reflects, 0..=1.
    Reflectance,
    /// Each the power of a light.
    Light,
    /// Index and extinction of a metal, called n and k.
    Metal,
    /// Functions that belong together.
    Functions,
}

/// A record as JSON.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordJson {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    what: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    terms: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    material: Option<Material>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    light: Option<Light>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    spectrum: Option<Curves>,
}

impl Record {
    /// The record as JSON; none of a mesh, a picture or stored photons.
    pub fn json(&self) -> Option<serde_json::Value> {
        let Origin { what, source, terms } = self.origin.clone();
        let mut sheet = RecordJson {
            name: Some(self.name.clone()),
            what,
            source,
            terms,
            material: None,
            light: None,
            spectrum: None,
        };
        match &self.content {
            RecordContent::Material(material) => sheet.material = Some((**material).clone()),
            RecordContent::Light(light) => sheet.light = Some((**light).clone()),
            RecordContent::Spectrum(curves) => sheet.spectrum = Some(curves.clone()),
            RecordContent::Geometry(_) | RecordContent::Texture(_) | RecordContent::Photons(_) => return None,
        }
        serde_json::to_value(&sheet).ok()
    }
}

/// The records of a file, whose ending names its format; a text with several columns gives several.
///
/// - `name`: what the record is called; without it what the file says, or its name without ending.
/// - `quantity`: what the columns of a text are; without it a metal where they are called n and k, and else
///   reflectances, if they lie within 0 and 1.
///
/// # Errors
/// [`DatabaseError`], with the place where the content is wrong.
pub fn read(path: &Path, name: Option<&str>, quantity: Option<ColumnQuantity>) -> Result<Vec<Record>, DatabaseError> {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let one = |content| Record { name: name.unwrap_or(stem).to_owned(), origin: Origin::default(), content };
    let records = match ending(path).as_str() {
        _ if mesh::Format::of(path).is_some() => {
            vec![one(RecordContent::Geometry(Box::new(mesh::read_grouped(path)?)))]
        }
        "png" | "exr" => vec![one(RecordContent::Texture(Box::new(Picture::read_finite(path)?)))],
        "txt" => of_columns(path, name, stem, quantity)?,
        "json" => vec![of_json(path, name, stem)?],
        _ => return Err(unknown_ending(path)),
    };
    records.iter().try_for_each(|record| check_name(&record.name))?;
    Ok(records)
}

/// Writes a record into a file, whose ending names the format.
///
/// # Errors
/// [`DatabaseError`] if the format cannot hold it, or the file cannot be written; it may be kept elsewhere then.
pub fn write(record: &Record, destination: &Destination) -> Result<(), DatabaseError> {
    let path = destination.path();
    let failed = |problem: &str| DatabaseError::Exchange { path: path.into(), problem: problem.into() };
    let text = match (&record.content, ending(path).as_str()) {
        (RecordContent::Geometry(grouped), _) if mesh::Format::of(path).is_some() => {
            return Ok(mesh::write_grouped(grouped, destination)?);
        }
        (RecordContent::Geometry(_), _) => {
            return Err(failed("a mesh goes into .obj, .ply, .stl, .gltf, .glb or .cmesh"));
        }
        (RecordContent::Texture(picture), "png" | "exr") => return Ok(picture.write(destination)?),
        (RecordContent::Texture(_), _) => return Err(failed("a texture goes into .png or .exr")),
        (RecordContent::Photons(_), _) => return Err(failed("stored photons are of use in their database only")),
        (RecordContent::Spectrum(curves), "txt") => {
            let named = match curves {
                Curves::Reflectance(spectrum) | Curves::Light(spectrum) => vec![(&*record.name, spectrum)],
                _ => curves.named(),
            };
            let text = columns::print(&record.origin, &named);
            text.ok_or_else(|| failed("its curves are over different wavelengths; write .json"))?
        }
        (_, "json") => match record.json().map(|json| serde_json::to_string_pretty(&json)) {
            Some(Ok(text)) => text + "\n",
            _ => return Err(failed("it cannot be written as JSON")),
        },
        (RecordContent::Spectrum(_), _) => return Err(failed("a spectrum goes into .txt or .json")),
        _ => return Err(failed("a material or a light goes into .json")),
    };
    Ok(destination.write_or_save_elsewhere(|file| file.write_all(text.as_bytes()))?)
}

fn ending(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase()
}

fn unknown_ending(path: &Path) -> DatabaseError {
    let known =
        "known are meshes (.obj, .stl, .ply, .gltf, .glb, .cmesh), pictures (.png, .exr), spectra (.txt) and .json";
    DatabaseError::Exchange { path: path.into(), problem: format!("unknown kind of file; {known}") }
}

fn text_of(path: &Path) -> Result<String, DatabaseError> {
    let failed = |source| DatabaseError::File { path: path.into(), source };
    memory::read_text(path, MAX_TEXT).map_err(failed)
}

fn of_columns(
    path: &Path,
    name: Option<&str>,
    stem: &str,
    quantity: Option<ColumnQuantity>,
) -> Result<Vec<Record>, DatabaseError> {
    let failed = |problem: String| DatabaseError::Exchange { path: path.into(), problem };
    let text = text_of(path)?;
    let origin = columns::origin(&text);
    let found = |beyond| columns::spectra(&text, beyond).map_err(|error| failed(error.to_string()));
    let held = found(Extrapolation::Held)?;
    let is_metal = held.len() == 2 && held[0].0 == "n" && held[1].0 == "k";
    let quantity = quantity.unwrap_or(if is_metal { ColumnQuantity::Metal } else { ColumnQuantity::Reflectance });
    let whole = |curves| vec![(name.unwrap_or(stem).to_owned(), curves)];
    let each = |columns: Vec<(&str, Spectrum)>, of: fn(Spectrum) -> Curves| match (name, columns.len()) {
        (Some(_), 2..) => Err(failed("a name for several columns; each is called by its head".into())),
        _ => Ok(columns.into_iter().map(|(head, s)| (name.unwrap_or(head).to_owned(), of(s))).collect()),
    };
    let all: Vec<(String, Curves)> = match quantity {
        ColumnQuantity::Metal if is_metal => {
            let mut both = held.into_iter().map(|(_, spectrum)| spectrum);
            let metal = both.next().zip(both.next()).map(|(n, k)| Curves::Metal(ComplexIndex { n, k }));
            metal.map(whole).unwrap_or_default()
        }
        ColumnQuantity::Metal => return Err(failed("a metal has two columns, called n and k".into())),
        ColumnQuantity::Reflectance => each(held, Curves::Reflectance)?,
        ColumnQuantity::Light => each(found(Extrapolation::Zero)?, Curves::Light)?,
        ColumnQuantity::Functions => whole(Curves::Functions(
            found(Extrapolation::Zero)?.into_iter().map(|(head, s)| (head.to_owned(), s)).collect(),
        )),
    };
    let record = |(name, curves): (String, Curves)| {
        let hint = if quantity == ColumnQuantity::Reflectance { " (or is it a light?)" } else { "" };
        curves.check().map_err(|problem| failed(format!("{name}: {problem}{hint}")))?;
        Ok(Record { name, origin: origin.clone(), content: RecordContent::Spectrum(curves) })
    };
    all.into_iter().map(record).collect()
}

fn of_json(path: &Path, name: Option<&str>, stem: &str) -> Result<Record, DatabaseError> {
    let failed = |problem: String| DatabaseError::Exchange { path: path.into(), problem };
    let sheet: RecordJson = serde_json::from_str(&text_of(path)?).map_err(|error| failed(error.to_string()))?;
    let content = match (sheet.material, sheet.light, sheet.spectrum) {
        (Some(material), None, None) => RecordContent::Material(Box::new(material)),
        (None, Some(light), None) => RecordContent::Light(Box::new(light)),
        (None, None, Some(curves)) => RecordContent::Spectrum(curves),
        _ => return Err(failed("it must hold one of material, light and spectrum".into())),
    };
    let name = name.map(str::to_owned).or(sheet.name).unwrap_or_else(|| stem.to_owned());
    let origin = Origin { what: sheet.what, source: sheet.source, terms: sheet.terms };
    Ok(Record { name, origin, content })
}
