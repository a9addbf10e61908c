//! Readers of luminaires, exchange files, records, and whole databases.

use super::place::with_file;
use super::sums;
use glam::DVec3;
use host::database::{DatabaseReport, Record, RecordKind, Store, read, shipped};
use host::illumination::light::Goniometry;
use std::path::Path;

/// What is read gives an intensity in every direction.
pub fn luminaire(bytes: &[u8]) {
    let Ok(goniometry) = Goniometry::parse(&String::from_utf8_lossy(bytes)) else { return };
    for towards in [DVec3::NEG_Z, DVec3::Z, DVec3::X, DVec3::new(0.48, -0.64, -0.6)] {
        let candelas = goniometry.candelas(towards);
        assert!((0.0..=goniometry.greatest() * 1.001).contains(&candelas), "{candelas} cd");
    }
}

pub fn columns(bytes: &[u8]) {
    exchanged("a.txt", bytes);
}

pub fn sheet(bytes: &[u8]) {
    exchanged("a.json", bytes);
}

/// What a database takes comes back the same.
fn exchanged(name: &str, bytes: &[u8]) {
    let Ok(records) = with_file(name, bytes, |path| read(path, None, None)) else { return };
    for record in records {
        let Ok(bytes) = record.to_bytes() else { continue };
        let again = Record::of_bytes(record.kind(), &record.name, &bytes).expect("what was written is read");
        assert_eq!(again.to_bytes().ok(), Some(bytes));
    }
}

/// The first byte is the number of the kind, what follows the bytes of the record.
pub fn record(bytes: &[u8]) {
    let Some((number, bytes)) = bytes.split_first() else { return };
    let kind = RecordKind::ALL[usize::from(*number) % RecordKind::ALL.len()];
    let Ok(record) = Record::of_bytes(kind, "a", &sums::record(kind, "a", bytes)) else { return };
    let written = record.to_bytes().expect("what is read can be written");
    let again = Record::of_bytes(kind, "a", &written).expect("what was written is read");
    assert_eq!(again.to_bytes().ok(), Some(written));
}

/// A file is looked at as `db check` does, every record is read, and one is added.
pub fn database(bytes: &[u8]) {
    with_file("a.redb", bytes, |path| {
        let _ = DatabaseReport::of(path);
        let Ok(store) = Store::open(path) else { return };
        let _ = store.entries(None);
        drop(store);
        add(path);
    });
}

fn add(path: &Path) {
    let record = shipped::record(RecordKind::Spectrum, "cobalt_blue").expect("it ships");
    if let Ok(store) = Store::open_existing(path)
        && store.add(std::slice::from_ref(&record), true).is_ok()
    {
        let found = store.find(RecordKind::Spectrum, "cobalt_blue").expect("what was acknowledged is read");
        assert_eq!(found, Some(record));
    }
}
