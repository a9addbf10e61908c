//! The database that ships with the program: read-only, each record with its source and its terms.

use super::store::unknown;
use super::{Curves, DatabaseError, Record, RecordContent, RecordEntry, RecordKind};
use crate::color::shipped;
use crate::color::{ColorError, Origin};
use crate::illumination::material::{Finish, MaterialKind, Metal, RefractiveIndex, Transparent};
use crate::mesh;

/// The name of the mesh that ships.
const BUNNY: &str = "bunny";

/// The names of a kind, in the order of their tables.
pub fn names(kind: RecordKind) -> Vec<&'static str> {
    match kind {
        RecordKind::Geometry => {
            if cfg!(feature = "bunny") {
                vec![BUNNY]
            } else {
                Vec::new()
            }
        }
        RecordKind::Material => [shipped::metals(), shipped::glasses(), shipped::liquids()].concat(),
        RecordKind::Spectrum => {
            [shipped::lights(), shipped::metals(), shipped::reflectances(), shipped::functions()].concat()
        }
        RecordKind::Texture | RecordKind::Light | RecordKind::Photons => Vec::new(),
    }
}

/// What there is, of one kind or of all.
pub fn entries(kind: Option<RecordKind>) -> Vec<RecordEntry> {
    let all =
        |kind: &RecordKind| names(*kind).into_iter().filter_map(|name| find(*kind, name).ok()?).collect::<Vec<_>>();
    let kinds = kind.as_ref().map_or(&RecordKind::ALL[..], std::slice::from_ref);
    kinds.iter().flat_map(all).map(|record| record.entry(0)).collect()
}

/// A record.
///
/// # Errors
/// [`DatabaseError::Unknown`] with the names that there are.
pub fn record(kind: RecordKind, name: &str) -> Result<Record, DatabaseError> {
    find(kind, name)?.ok_or_else(|| unknown(kind.word(), name, &names(kind)))
}

/// A record; none if there is none of that name.
///
/// # Errors
/// [`DatabaseError::Record`] if what is in the program is damaged, or was left out when it was built.
pub fn find(kind: RecordKind, name: &str) -> Result<Option<Record>, DatabaseError> {
    if (kind, name) == (RecordKind::Geometry, BUNNY) {
        return bunny().map(Some);
    }
    if !names(kind).contains(&name) {
        return Ok(None);
    }
    let failed = |error: ColorError| DatabaseError::Record { kind, name: name.into(), problem: error.to_string() };
    let origin = shipped::origin(name).unwrap_or_default();
    let made = match kind {
        RecordKind::Material if shipped::metals().contains(&name) => {
            shipped::metal(name).map(|shipped::ComplexIndex { n, k }| polished(n, k))
        }
        RecordKind::Material if shipped::liquids().contains(&name) => {
            shipped::liquid(name).map(|liquid| clear(liquid, Transparent::LIQUID))
        }
        RecordKind::Material => shipped::glass(name).map(|glass| clear(glass, 0)),
        RecordKind::Spectrum => curves(name).map(RecordContent::Spectrum),
        RecordKind::Geometry | RecordKind::Texture | RecordKind::Light | RecordKind::Photons => return Ok(None),
    };
    Ok(Some(Record { name: name.into(), origin, content: made.map_err(failed)? }))
}

fn curves(name: &str) -> Result<Curves, ColorError> {
    if shipped::lights().contains(&name) {
        shipped::light(name).map(Curves::Light)
    } else if shipped::metals().contains(&name) {
        shipped::metal(name).map(Curves::Metal)
    } else if shipped::functions().contains(&name) {
        let owned = |all: Vec<(&str, _)>| all.into_iter().map(|(name, s)| (name.to_owned(), s)).collect();
        shipped::function(name).map(|all| Curves::Functions(owned(all)))
    } else {
        shipped::reflectance(name).map(Curves::Reflectance)
    }
}

fn polished(n: crate::color::Spectrum, k: crate::color::Spectrum) -> RecordContent {
    RecordContent::Material(Box::new(MaterialKind::Metal(Metal { n, k, finish: Finish::Polished }).into()))
}

fn clear(substance: crate::color::Glass, priority: i32) -> RecordContent {
    let body = Transparent { priority, ..Transparent::clear(RefractiveIndex::Dispersive(substance)) };
    RecordContent::Material(Box::new(MaterialKind::Transparent(body).into()))
}

fn bunny() -> Result<Record, DatabaseError> {
    let left_out = |error: mesh::NoBunny| DatabaseError::Record {
        kind: RecordKind::Geometry,
        name: BUNNY.into(),
        problem: error.to_string(),
    };
    let mesh = mesh::bunny().map_err(left_out)?;
    let origin = Origin {
        what: "The Stanford bunny, closed, about 2 units high.".into(),
        source: "Stanford 3D Scanning Repository, scan of Greg Turk and Marc Levoy, 1994; its holes are filled.".into(),
        terms:
            "Free to pass on and to publish with thanks to the Stanford Computer Graphics Laboratory; no commercial \
                use without its permission."
                .into(),
    };
    Ok(Record { name: BUNNY.into(), origin, content: RecordContent::Geometry(Box::new(mesh.into())) })
}
