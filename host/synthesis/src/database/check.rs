//! What can be said of a whole database: which of its records are whole.

use super::{DatabaseError, Record, RecordKind, Store};
use serde::Serialize;
use std::path::Path;

/// What was found out about a database.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DatabaseReport {
    /// How many records are whole.
    pub whole: usize,
    /// The records that are not.
    pub problems: Vec<DamagedRecord>,
    /// What is wrong with the file as a whole; none if nothing is.
    pub file: Option<String>,
}

/// A record that is not whole.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DamagedRecord {
    /// Its kind.
    pub kind: RecordKind,
    /// Its name.
    pub name: String,
    /// What is wrong with it.
    pub problem: String,
}

impl DatabaseReport {
    /// Checks the pages of a file and every number of every record.
    ///
    /// # Errors
    /// [`DatabaseError`] if there is no such file, it is no database, or another process writes to it.
    pub fn of(path: &Path) -> Result<DatabaseReport, DatabaseError> {
        let mut report = DatabaseReport::default();
        let store = match Store::open_existing(path) {
            Err(error @ DatabaseError::Damaged { .. }) => {
                report.file = Some(error.to_string());
                match Store::open(path) {
                    Err(DatabaseError::Damaged { .. }) => return Ok(report),
                    other => other?,
                }
            }
            // A file that may only be read.
            Err(DatabaseError::File { source, .. }) if source.kind() == std::io::ErrorKind::PermissionDenied => {
                Store::open(path)?
            }
            other => other?,
        };
        for kind in RecordKind::ALL {
            let listed = store.each(&[kind], |kind, name, bytes| {
                match Record::of_bytes(kind, name, bytes) {
                    Ok(_) => report.whole += 1,
                    Err(error) => {
                        report.problems.push(DamagedRecord { kind, name: name.into(), problem: error.to_string() });
                    }
                }
                Ok(())
            });
            match listed {
                Err(error) if report.file.is_none() => report.file = Some(error.to_string()),
                _ => {}
            }
        }
        Ok(report)
    }

    /// Whether everything is whole.
    pub fn is_whole(&self) -> bool {
        self.file.is_none() && self.problems.is_empty()
    }
}
