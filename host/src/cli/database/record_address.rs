//! Where a record of a database is.

use crate::cli::{CommandFailure, Exit};
use crate::database::{DatabaseError, Library, Record, RecordKind, Store, shipped};
use crate::spelling;
use clap::Args;
use std::path::{Path, PathBuf};

/// What stands for the database in the program.
pub(super) const SHIPPED: &str = "shipped";

/// Where a record is.
#[derive(Args, Debug)]
pub(super) struct RecordAddress {
    /// The database (.redb), or "shipped" for what ships with the program
    #[arg(value_name = "DATABASE")]
    pub(super) database: PathBuf,
    /// Its name
    #[arg(value_name = "NAME")]
    pub(super) name: String,
    /// Its kind, if there are several of that name
    #[arg(long, value_enum, value_name = "KIND")]
    pub(super) kind: Option<RecordKind>,
}

impl RecordAddress {
    /// The file; none for what ships.
    pub(super) fn file(&self) -> Option<&Path> {
        Some(&*self.database).filter(|path| *path != Path::new(SHIPPED))
    }

    /// The record.
    pub(super) fn record(&self) -> Result<Record, CommandFailure> {
        let kind = kind_of(self)?;
        match self.file() {
            Some(file) => Ok(Store::open(file)?.record(kind, &self.name)?),
            None => Ok(shipped::record(kind, &self.name)?),
        }
    }

    /// Records of the file, and those that ship.
    pub(super) fn library(&self) -> Result<Library, CommandFailure> {
        Ok(Library::of(self.file())?)
    }
}

/// The kind of a record; an error that lists the kinds, if there are several, or the names, if there is none.
pub(super) fn kind_of(address: &RecordAddress) -> Result<RecordKind, CommandFailure> {
    if let Some(kind) = address.kind {
        return Ok(kind);
    }
    let names = match address.file() {
        Some(file) => {
            let store = Store::open(file)?;
            RecordKind::ALL.map(|kind| store.names(kind))
        }
        None => RecordKind::ALL.map(|kind| Ok(shipped::names(kind).into_iter().map(str::to_owned).collect())),
    };
    let (mut kinds, mut known) = (Vec::new(), Vec::new());
    for (kind, names) in RecordKind::ALL.into_iter().zip(names) {
        let names: Vec<String> = names?;
        if names.contains(&address.name) {
            kinds.push(kind);
        }
        known.extend(names);
    }
    known.sort_unstable();
    known.dedup();
    match kinds[..] {
        [kind] => Ok(kind),
        [] => {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let advice = spelling::advice(&address.name, &known);
            Err(DatabaseError::Unknown { kind: "record".into(), name: address.name.clone(), advice }.into())
        }
        _ => {
            let kinds: Vec<String> = kinds.iter().map(|kind| format!("--kind {kind}")).collect();
            let message = format!("there are several records \"{}\"; say {}", address.name, kinds.join(" or "));
            Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)))
        }
    }
}
