//! Databases: geometry, textures, materials, light sources, spectra and stored photons, on disk and in the program.
//!
//! A database is one file. What one transaction writes is there as a whole or not at all, also after a crash; one
//! process writes at a time, and any number of processes and threads read meanwhile, each what was there when it began.
//! A record has a name, a note of its source and terms, the version of its form, and a checksum, so that it is found
//! out when it is damaged or of a later program.
//!
//! The database that ships with the program has records of the same kinds and is read-only.

mod photons;
mod check;
mod error;
mod exchange;
mod materials_v1;
mod materials_v2;
mod kind;
mod library;
mod record;
pub mod shipped;
mod store;
#[cfg(test)]
mod fault_tests;
#[cfg(test)]
mod tests;

pub use check::{DamagedRecord, DatabaseReport};
pub use error::DatabaseError;
pub use exchange::{ColumnQuantity, read, write};
pub use kind::{LONGEST_NAME, MAX_RECORD, RecordKind};
pub use library::Library;
pub use photons::{PhotonBlock, StoredPhotons};
pub use record::{Curves, Record, RecordContent, RecordEntry, check_name};
pub use store::Store;
