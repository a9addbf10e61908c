//! A storage that fails: at every call of a change in turn, and in every way in which storages lose what they were told.

use super::*;
use crate::illumination::material::Classic;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use redb::{BackendError, StorageBackend};
use std::io::{Error, ErrorKind};
use std::ops::Bound;
use std::sync::{Arc, Mutex, MutexGuard};

/// Bytes that a disk writes at once or not at all.
const SECTOR: usize = 512;

/// How a storage fails.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// The call does nothing and is an error, as are all after it; what was written before is there.
    Refused,
    /// A write is cut off in the middle; then as before.
    Torn,
    /// The power goes: of what was not synchronised, any sectors are there, and others are not.
    Power(u64),
}

/// A change that was not synchronised.
#[derive(Clone, Debug)]
enum Pending {
    Write(usize, Vec<u8>),
    Length(usize),
}

#[derive(Debug, Default)]
struct Disk {
    /// What a reader sees.
    seen: Vec<u8>,
    /// What is sure to be there after the power has gone.
    lasting: Vec<u8>,
    pending: Vec<Pending>,
    calls: usize,
    /// At which call it fails, and how.
    fault: Option<(usize, Fault)>,
    is_dead: bool,
}

impl Pending {
    fn apply(&self, bytes: &mut Vec<u8>) {
        match self {
            Pending::Length(length) => bytes.resize(*length, 0),
            Pending::Write(at, data) => {
                if bytes.len() < at + data.len() {
                    bytes.resize(at + data.len(), 0);
                }
                bytes[*at..at + data.len()].copy_from_slice(data);
            }
        }
    }
}

impl Disk {
    fn of(bytes: Vec<u8>, fault: Option<(usize, Fault)>) -> Storage {
        let disk = Disk { seen: bytes.clone(), lasting: bytes, fault, ..Disk::default() };
        Storage(Arc::new(Mutex::new(disk)))
    }

    /// A change; an error once the storage has failed.
    fn change(&mut self, change: Option<Pending>) -> Result<(), BackendError> {
        let refused = || BackendError::Io(Error::new(ErrorKind::StorageFull, "the storage has failed"));
        if self.is_dead {
            return Err(refused());
        }
        let fault = self.fault.filter(|(at, _)| *at == self.calls).map(|(_, fault)| fault);
        self.calls += 1;
        if let Some(fault) = fault {
            self.is_dead = true;
            if let (Fault::Torn, Some(Pending::Write(at, data))) = (fault, &change) {
                Pending::Write(*at, data[..data.len() / 2].to_vec()).apply(&mut self.seen);
            }
            self.pending.extend(change);
            return Err(refused());
        }
        match change {
            Some(change) => {
                change.apply(&mut self.seen);
                self.pending.push(change);
            }
            None => {
                self.lasting = self.seen.clone();
                self.pending.clear();
            }
        }
        Ok(())
    }

    /// The bytes that are there when all processes have ended.
    fn left(&self) -> Vec<u8> {
        let Some((_, Fault::Power(seed))) = self.fault else { return self.seen.clone() };
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut left = self.lasting.clone();
        for pending in &self.pending {
            match pending {
                Pending::Length(_) if random.random() => pending.apply(&mut left),
                Pending::Length(_) => {}
                Pending::Write(at, data) => {
                    for (number, sector) in data.chunks(SECTOR).enumerate() {
                        if random.random() {
                            Pending::Write(at + number * SECTOR, sector.to_vec()).apply(&mut left);
                        }
                    }
                }
            }
        }
        left
    }
}

/// A storage that remembers in memory.
#[derive(Clone, Debug)]
struct Storage(Arc<Mutex<Disk>>);

impl Storage {
    fn disk(&self) -> MutexGuard<'_, Disk> {
        self.0.lock().expect("no panic")
    }
}

type Range = Bound<u64>;

impl StorageBackend for Storage {
    fn len(&self) -> Result<u64, Error> {
        Ok(self.disk().seen.len() as u64)
    }

    fn read(&self, offset: u64, out: &mut [u8]) -> Result<(), Error> {
        let disk = self.disk();
        let found = disk.seen.get(offset as usize..offset as usize + out.len());
        out.copy_from_slice(found.ok_or(ErrorKind::UnexpectedEof)?);
        Ok(())
    }

    fn set_len(&self, len: u64) -> Result<(), Error> {
        self.disk().change(Some(Pending::Length(len as usize))).map_err(io)
    }

    fn sync_data(&self) -> Result<(), Error> {
        self.disk().change(None).map_err(io)
    }

    fn write(&self, offset: u64, data: &[u8]) -> Result<(), Error> {
        self.disk().change(Some(Pending::Write(offset as usize, data.to_vec()))).map_err(io)
    }

    fn try_lock_range(&self, _: Range, _: Range) -> Result<bool, BackendError> {
        Ok(true)
    }

    fn try_lock_shared_range(&self, _: Range, _: Range) -> Result<bool, BackendError> {
        Ok(true)
    }

    fn lock_range(&self, _: Range, _: Range) -> Result<(), BackendError> {
        Ok(())
    }

    fn lock_shared_range(&self, _: Range, _: Range) -> Result<(), BackendError> {
        Ok(())
    }

    fn unlock_range(&self, _: Range, _: Range) -> Result<(), BackendError> {
        Ok(())
    }

    fn query_lock_range(&self, _: Range, _: Range) -> Result<bool, BackendError> {
        Ok(false)
    }
}

fn io(error: BackendError) -> Error {
    match error {
        BackendError::Io(error) => error,
        other => Error::other(other.to_string()),
    }
}

fn material(name: &str, grey: f64) -> Record {
    let classic = Classic { diffuse: crate::color::Color::grey(grey).into(), ..Classic::default() };
    let content = RecordContent::Material(Box::new(classic.into()));
    Record { name: name.into(), origin: Default::default(), content }
}

/// Enough to need new pages.
fn large() -> Record {
    let mut picture = crate::picture::Picture::new(60, 60).expect("small");
    for (pixel, value) in picture.pixels_mut().iter_mut().zip(0..) {
        (pixel.radiance, pixel.coverage) = ([value as f32, 0.5, 0.25], 1.0);
    }
    Record { name: "large".into(), origin: Default::default(), content: RecordContent::Texture(Box::new(picture)) }
}

/// A database with two records.
fn before() -> Vec<u8> {
    let storage = Disk::of(Vec::new(), None);
    let store = Store::over(storage.clone(), true).expect("made");
    store.add(&[material("kept", 0.1), material("replaced", 0.2)], false).expect("added");
    drop(store);
    storage.disk().left()
}

/// What is done to it: some records are added at once, one of them in place of another.
fn change(store: &Store) -> Result<(), DatabaseError> {
    store.add(&[material("new", 0.3), material("replaced", 0.4), large()], true)
}

#[test]
fn a_change_is_whole_or_has_not_been_whatever_the_storage_does_at_whichever_call() {
    let before = before();
    // How many calls there are without a fault.
    let whole = Disk::of(before.clone(), None);
    change(&Store::over(whole.clone(), false).expect("opened")).expect("changed");
    let calls = whole.disk().calls;
    assert!(calls > 10, "{calls}");
    let faults = [Fault::Refused, Fault::Torn].into_iter().chain((0..6).map(Fault::Power));
    let (mut old, mut new) = (0, 0);
    for fault in faults {
        for call in 0..=calls {
            let storage = Disk::of(before.clone(), Some((call, fault)));
            let changed = Store::over(storage.clone(), false).and_then(|store| change(&store));
            let left = storage.disk().left();
            let store = Store::over(Disk::of(left, None), false);
            let store = store.unwrap_or_else(|error| panic!("{fault:?} at call {call}: {error}"));
            let names = store.names(RecordKind::Material).expect("they can be read");
            let is_new = names.contains(&"new".to_owned());
            let grey = if is_new { 0.4 } else { 0.2 };
            let found = |name: &str| store.record(RecordKind::Material, name).expect("it is whole");
            assert!(found("kept") == material("kept", 0.1) && found("replaced") == material("replaced", grey));
            assert_eq!(names.len(), if is_new { 3 } else { 2 }, "{fault:?} at call {call}");
            let texture = store.find(RecordKind::Texture, "large").expect("it is whole or not there");
            assert_eq!(texture, is_new.then(large), "{fault:?} at call {call}");
            assert!(is_new || changed.is_err(), "{fault:?} at call {call}: what was acknowledged is lost");
            // And it takes further changes.
            change(&store).unwrap_or_else(|error| panic!("{fault:?} at call {call}: {error}"));
            *(if is_new { &mut new } else { &mut old }) += 1;
        }
    }
    assert!(old > 50 && new > 10, "{old} old, {new} new");
}
