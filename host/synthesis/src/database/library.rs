//! Several databases as one: files, and behind them what ships with the program.

use super::store::unknown;
use super::{Curves, DatabaseError, Record, RecordContent, RecordKind, Store, shipped};
use crate::color::Spectrum;
use crate::color::shipped::ComplexIndex;
use std::path::{Path, PathBuf};

/// The databases in which names are looked up: those in files, the last one first, then the one that ships.
#[derive(Default)]
pub struct Library {
    stores: Vec<Store>,
}

impl Library {
    /// What ships alone, or in front of it a database in a file.
    ///
    /// # Errors
    /// [`DatabaseError`] if the file cannot be opened or is no database; see [`Store::open`].
    pub fn of(file: Option<&Path>) -> Result<Library, DatabaseError> {
        let mut library = Library::default();
        file.map_or(Ok(()), |file| library.open(file)).map(|()| library)
    }

    /// Puts a database in a file in front of the others.
    ///
    /// # Errors
    /// [`DatabaseError`] if the file cannot be opened or is no database; see [`Store::open`].
    pub fn open(&mut self, path: &Path) -> Result<(), DatabaseError> {
        self.stores.push(Store::open(path)?);
        Ok(())
    }

    /// The first record of a kind and name, and the file that holds it; none if it ships.
    ///
    /// # Errors
    /// [`DatabaseError::Unknown`] with the names that there are, or another one if it is damaged.
    pub fn record(&self, kind: RecordKind, name: &str) -> Result<(Record, Option<PathBuf>), DatabaseError> {
        for store in self.stores.iter().rev() {
            if let Some(record) = store.find(kind, name)? {
                return Ok((record, Some(store.path().to_owned())));
            }
        }
        match shipped::find(kind, name)? {
            Some(record) => Ok((record, None)),
            None => Err(unknown(kind.word(), name, &self.names(kind)?)),
        }
    }

    /// All names of a kind, each once; those in files first.
    ///
    /// # Errors
    /// [`DatabaseError`] if a file is damaged.
    pub fn names(&self, kind: RecordKind) -> Result<Vec<String>, DatabaseError> {
        let mut names = Vec::new();
        for store in self.stores.iter().rev() {
            names.extend(store.names(kind)?);
        }
        names.extend(shipped::names(kind).into_iter().map(str::to_owned));
        let mut seen = std::collections::HashSet::new();
        names.retain(|name| seen.insert(name.clone()));
        Ok(names)
    }

    /// What a surface of a name reflects.
    ///
    /// # Errors
    /// [`DatabaseError::Unknown`] with the names of the reflectances.
    pub fn reflectance(&self, name: &str) -> Result<Spectrum, DatabaseError> {
        self.curves("reflectance", name, |curves| match curves {
            Curves::Reflectance(spectrum) => Some(spectrum),
            _ => None,
        })
    }

    /// The power of a light of a name over the wavelength.
    ///
    /// # Errors
    /// [`DatabaseError::Unknown`] with the names of the spectra of lights.
    pub fn light(&self, name: &str) -> Result<Spectrum, DatabaseError> {
        self.curves("light", name, |curves| match curves {
            Curves::Light(spectrum) => Some(spectrum),
            _ => None,
        })
    }

    /// Index and extinction of a metal of a name.
    ///
    /// # Errors
    /// [`DatabaseError::Unknown`] with the names of the metals.
    pub fn metal(&self, name: &str) -> Result<ComplexIndex, DatabaseError> {
        self.curves("metal", name, |curves| match curves {
            Curves::Metal(metal) => Some(metal),
            _ => None,
        })
    }

    /// Curves of one sort, by their name.
    fn curves<T>(&self, sort: &str, name: &str, of: impl Fn(Curves) -> Option<T>) -> Result<T, DatabaseError> {
        let found = |name: &str| match self.record(RecordKind::Spectrum, name).map(|(record, _)| record.content) {
            Ok(RecordContent::Spectrum(curves)) => Ok(of(curves)),
            Ok(_) | Err(DatabaseError::Unknown { .. }) => Ok(None),
            Err(error) => Err(error),
        };
        if let Some(curves) = found(name)? {
            return Ok(curves);
        }
        let mut known = Vec::new();
        for name in self.names(RecordKind::Spectrum)? {
            if found(&name)?.is_some() {
                known.push(name);
            }
        }
        Err(unknown(sort, name, &known))
    }
}
