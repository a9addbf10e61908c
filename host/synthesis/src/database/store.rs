//! The file: transactions, many readers beside one writer, and what happens when it is damaged.

use super::{DatabaseError, Record, RecordEntry, RecordKind};
use crate::spelling;
use files::Destination;
use redb::backends::FileBackend;
use redb::{
    Builder, ConcurrencyMode, Database, ReadOnlyDatabase, ReadTransaction, ReadableDatabase, ReadableTable,
    StorageError, TableDefinition, TableError,
};
use std::cell::Cell;
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Once;
use std::time::{Duration, Instant};

/// The form of the file as a whole.
const FORM: u64 = 1;
/// What the file says of itself.
const ABOUT: TableDefinition<'_, &str, u64> = TableDefinition::new("peris");
const FORM_KEY: &str = "form";
/// How long to wait for another process that writes.
const LOCK_TIMEOUT: Duration = if cfg!(test) { Duration::from_secs(1) } else { Duration::from_secs(5) };
const PAUSE: Duration = Duration::from_millis(20);
/// Memory for pages that were read, bytes.
const CACHE: usize = 64 << 20;

/// A database in a file, open for reading or for writing too.
pub struct Store {
    path: PathBuf,
    handle: Handle,
}

enum Handle {
    Write(Database),
    Read(ReadOnlyDatabase),
}

fn table(kind: RecordKind) -> TableDefinition<'static, &'static str, &'static [u8]> {
    TableDefinition::new(kind.word())
}

impl Store {
    /// Opens a database for reading. Others may read it and one may write to it meanwhile.
    ///
    /// One that a process left when it was killed is put in order first.
    ///
    /// # Errors
    /// [`DatabaseError`] if there is none, or it is none, or a later program wrote it.
    pub fn open(path: impl AsRef<Path>) -> Result<Store, DatabaseError> {
        let path = path.as_ref();
        match Store::open_read_only(path) {
            Err(DatabaseError::Disorder { .. }) => {
                drop(Store::open_existing(path).map_err(|error| match error {
                    DatabaseError::File { .. } => DatabaseError::Disorder { path: path.into() },
                    other => other,
                })?);
                Store::open_read_only(path)
            }
            other => other,
        }
    }

    fn open_read_only(path: &Path) -> Result<Store, DatabaseError> {
        guarded(path, || {
            let database = builder().open_read_only(path).map_err(|error| opening(path, error))?;
            let store = Store { path: path.into(), handle: Handle::Read(database) };
            store.check_form().map(|()| store)
        })
    }

    /// Opens a database for writing; makes one where there is no file. Its pages are checked first. If another process
    /// writes to it, waits a few seconds.
    ///
    /// # Errors
    /// [`DatabaseError::Busy`] if the other one does not end, else as [`Store::open`].
    pub fn open_to_write(path: impl AsRef<Path>) -> Result<Store, DatabaseError> {
        Store::open_as(path.as_ref(), true)
    }

    /// Opens a database that exists for writing.
    ///
    /// # Errors
    /// [`DatabaseError::File`] if there is no file, [`DatabaseError::Busy`] if another process writes to it, else as
    /// [`Store::open`].
    pub fn open_existing(path: impl AsRef<Path>) -> Result<Store, DatabaseError> {
        Store::open_as(path.as_ref(), false)
    }

    fn open_as(path: &Path, create: bool) -> Result<Store, DatabaseError> {
        if create && std::fs::metadata(path).map_or(true, |found| found.len() == 0) {
            Destination::of(path)?.make_once(|file| Store::make_in(path, file))?;
        }
        let since = Instant::now();
        loop {
            match Store::open_once(path, |builder| builder.open(path)) {
                Err(DatabaseError::Busy { .. }) if since.elapsed() < LOCK_TIMEOUT => std::thread::sleep(PAUSE),
                other => return other,
            }
        }
    }

    /// Makes an empty database in an empty file. The file gets its name when all is written.
    fn make_in(path: &Path, file: &File) -> Result<(), DatabaseError> {
        let failed = |source| DatabaseError::File { path: path.into(), source };
        let file = file.try_clone().map_err(failed)?;
        let made = guarded(path, || {
            let made = FileBackend::new(file).and_then(|file| builder().create_with_backend(file));
            made.map_err(|error| opening(path, error))
        })?;
        Store { path: path.into(), handle: Handle::Write(made) }.mark_form()
    }

    /// Opens what the builder is told to open, and checks it.
    fn open_once(
        path: &Path,
        open: impl FnOnce(&Builder) -> Result<Database, redb::DatabaseError>,
    ) -> Result<Store, DatabaseError> {
        guarded(path, || {
            let mut builder = builder();
            builder.set_check_integrity_on_open(true);
            let database = open(&builder).map_err(|error| opening(path, error))?;
            let store = Store { path: path.into(), handle: Handle::Write(database) };
            store.check_form().map(|()| store)
        })
    }

    /// Opens or makes a database in a storage of the tests.
    #[cfg(test)]
    pub(super) fn over(storage: impl redb::StorageBackend, is_new: bool) -> Result<Store, DatabaseError> {
        let path = Path::new("storage");
        match is_new {
            true => guarded(path, || {
                let made = builder().create_with_backend(storage).map_err(|error| opening(path, error))?;
                let store = Store { path: path.into(), handle: Handle::Write(made) };
                store.mark_form().map(|()| store)
            }),
            false => Store::open_once(path, |builder| builder.create_with_backend(storage)),
        }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the form into a new database.
    fn mark_form(&self) -> Result<(), DatabaseError> {
        let failed = |error: redb::Error| failure(&self.path, error);
        self.change(|write| {
            let mut about = write.open_table(ABOUT).map_err(|error| failed(error.into()))?;
            about.insert(FORM_KEY, FORM).map_err(|error| failed(error.into()))?;
            Ok(())
        })
    }

    fn check_form(&self) -> Result<(), DatabaseError> {
        let other = |why: &str| DatabaseError::Other { path: self.path.clone(), why: why.into() };
        let read = self.begin()?;
        let about = match read.open_table(ABOUT) {
            Err(TableError::TableDoesNotExist(_) | TableError::TableTypeMismatch { .. }) => {
                return Err(other("it holds other tables"));
            }
            about => about.map_err(|error| failure(&self.path, error.into()))?,
        };
        let form = about.get(FORM_KEY).map_err(|error| failure(&self.path, error.into()))?;
        match form.map(|form| form.value()) {
            None => Err(other("it does not say its form")),
            Some(found) if found > FORM => {
                Err(DatabaseError::Newer { what: self.path.display().to_string(), found, known: FORM })
            }
            Some(_) => Ok(()),
        }
    }

    fn begin(&self) -> Result<ReadTransaction, DatabaseError> {
        match &self.handle {
            Handle::Write(database) => database.begin_read(),
            Handle::Read(database) => database.begin_read(),
        }
        .map_err(|error| failure(&self.path, error.into()))
    }

    /// Calls a function with kind, name and bytes of every record, of one transaction.
    pub(super) fn each(
        &self,
        kinds: &[RecordKind],
        mut found: impl FnMut(RecordKind, &str, &[u8]) -> Result<(), DatabaseError>,
    ) -> Result<(), DatabaseError> {
        let failed = |error: redb::Error| failure(&self.path, error);
        guarded(&self.path, || {
            let read = self.begin()?;
            for kind in kinds {
                let table = match read.open_table(table(*kind)) {
                    Err(TableError::TableDoesNotExist(_)) => continue,
                    table => table.map_err(|error| failed(error.into()))?,
                };
                for row in table.iter().map_err(|error| failed(error.into()))? {
                    let (name, bytes) = row.map_err(|error| failed(error.into()))?;
                    found(*kind, name.value(), bytes.value())?;
                }
            }
            Ok(())
        })
    }

    /// What there is, of one kind or of all, by kind and name.
    ///
    /// # Errors
    /// [`DatabaseError`] if the file is damaged or a later program wrote a record.
    pub fn entries(&self, kind: Option<RecordKind>) -> Result<Vec<RecordEntry>, DatabaseError> {
        let mut entries = Vec::new();
        self.each(kind.as_ref().map_or(&RecordKind::ALL[..], std::slice::from_ref), |kind, name, bytes| {
            entries.push(RecordEntry::of_bytes(kind, name, bytes)?);
            Ok(())
        })?;
        Ok(entries)
    }

    /// The names of a kind.
    ///
    /// # Errors
    /// [`DatabaseError`] if the file is damaged.
    pub fn names(&self, kind: RecordKind) -> Result<Vec<String>, DatabaseError> {
        let mut names = Vec::new();
        self.each(&[kind], |_, name, _| {
            names.push(name.to_owned());
            Ok(())
        })?;
        Ok(names)
    }

    /// A record, checked.
    ///
    /// # Errors
    /// [`DatabaseError::Unknown`] with the names that there are, or another one if it is damaged.
    pub fn record(&self, kind: RecordKind, name: &str) -> Result<Record, DatabaseError> {
        match self.find(kind, name)? {
            Some(record) => Ok(record),
            None => Err(unknown(kind.word(), name, &self.names(kind)?)),
        }
    }

    /// A record, checked; none if there is none of that name.
    ///
    /// # Errors
    /// [`DatabaseError`] if it is damaged.
    pub fn find(&self, kind: RecordKind, name: &str) -> Result<Option<Record>, DatabaseError> {
        let failed = |error: redb::Error| failure(&self.path, error);
        guarded(&self.path, || {
            let read = self.begin()?;
            let table = match read.open_table(table(kind)) {
                Err(TableError::TableDoesNotExist(_)) => return Ok(None),
                table => table.map_err(|error| failed(error.into()))?,
            };
            let bytes = table.get(name).map_err(|error| failed(error.into()))?;
            bytes.map(|bytes| Record::of_bytes(kind, name, bytes.value())).transpose()
        })
    }

    /// Adds records, all or none; they are there when this returns, whatever happens then.
    ///
    /// - `replace`: whether records of the same kind and name give way.
    ///
    /// # Errors
    /// [`DatabaseError::Exists`], or the first record that is impossible, or the file cannot be written.
    pub fn add(&self, records: &[Record], replace: bool) -> Result<(), DatabaseError> {
        let rows = records.iter().map(|record| Ok((record.kind(), &*record.name, record.to_bytes()?)));
        let rows: Vec<(RecordKind, &str, Vec<u8>)> = rows.collect::<Result<_, DatabaseError>>()?;
        self.change(|write| {
            for (kind, name, bytes) in &rows {
                let mut table = write.open_table(table(*kind)).map_err(|error| self.failed(error.into()))?;
                let before = table.insert(*name, bytes.as_slice()).map_err(|error| self.failed(error.into()))?;
                if before.is_some() && !replace {
                    return Err(DatabaseError::Exists { kind: *kind, name: (*name).into() });
                }
            }
            Ok(())
        })
    }

    /// Removes records, all or none.
    ///
    /// # Errors
    /// [`DatabaseError::Unknown`], or the file cannot be written.
    pub fn remove(&self, records: &[(RecordKind, &str)]) -> Result<(), DatabaseError> {
        self.change(|write| {
            for (kind, name) in records {
                let mut table = write.open_table(table(*kind)).map_err(|error| self.failed(error.into()))?;
                let before = table.remove(*name).map_err(|error| self.failed(error.into()))?.is_some();
                if !before {
                    let names = table.iter().map_err(|error| self.failed(error.into()))?;
                    let names = names.filter_map(|row| Some(row.ok()?.0.value().to_owned())).collect::<Vec<_>>();
                    return Err(unknown(kind.word(), name, &names));
                }
            }
            Ok(())
        })
    }

    fn failed(&self, error: redb::Error) -> DatabaseError {
        failure(&self.path, error)
    }

    /// One transaction: it is committed if the function succeeds.
    fn change(
        &self,
        changes: impl FnOnce(&redb::WriteTransaction) -> Result<(), DatabaseError>,
    ) -> Result<(), DatabaseError> {
        guarded(&self.path, || {
            let Handle::Write(database) = &self.handle else {
                let problem = "the database was opened for reading only".into();
                return Err(DatabaseError::Exchange { path: self.path.clone(), problem });
            };
            let write = database.begin_write().map_err(|error| self.failed(error.into()))?;
            match changes(&write) {
                Ok(()) => write.commit().map_err(|error| self.failed(error.into())),
                Err(error) => {
                    write.abort().map_err(|error| self.failed(error.into()))?;
                    Err(error)
                }
            }
        })
    }

    /// Writes bytes as a record, for tests of damaged ones.
    #[cfg(test)]
    pub(super) fn put_bytes(&self, kind: RecordKind, name: &str, bytes: &[u8]) -> Result<(), DatabaseError> {
        self.change(|write| {
            let mut table = write.open_table(table(kind)).map_err(|error| self.failed(error.into()))?;
            table.insert(name, bytes).map_err(|error| self.failed(error.into()))?;
            Ok(())
        })
    }
}

/// The error that names what there is.
pub(super) fn unknown<T: AsRef<str>>(kind: &str, name: &str, known: &[T]) -> DatabaseError {
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    DatabaseError::Unknown { kind: kind.into(), name: name.into(), advice: spelling::advice(name, &known) }
}

fn builder() -> Builder {
    let mut builder = Builder::new();
    builder.set_concurrency_mode(ConcurrencyMode::SingleWriter).set_cache_size(CACHE);
    builder
}

/// The error for a database that cannot be opened.
fn opening(path: &Path, error: redb::DatabaseError) -> DatabaseError {
    let path = path.to_owned();
    match error {
        redb::DatabaseError::DatabaseAlreadyOpen => DatabaseError::Busy { path },
        redb::DatabaseError::LockProtocolMismatch => DatabaseError::Shared { path },
        redb::DatabaseError::RepairAborted => DatabaseError::Disorder { path },
        redb::DatabaseError::UpgradeRequired(form) => {
            DatabaseError::Other { path, why: format!("its pages have the old form {form}") }
        }
        redb::DatabaseError::Storage(StorageError::Io(error)) if error.kind() == std::io::ErrorKind::InvalidData => {
            DatabaseError::Other { path, why: error.to_string() }
        }
        other => failure(&path, other.into()),
    }
}

/// What the store says, in our words.
fn failure(path: &Path, error: redb::Error) -> DatabaseError {
    let path = path.to_owned();
    match error {
        redb::Error::Io(source) => DatabaseError::File { path, source },
        redb::Error::Corrupted(what) => DatabaseError::Damaged { path, what },
        other => DatabaseError::Damaged { path, what: other.to_string() },
    }
}

thread_local! {
    /// Whether a panic of this thread is reported as an error.
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs what reads the file. The store trusts its pages and may panic where they are damaged; that is an error here.
fn guarded<T>(path: &Path, action: impl FnOnce() -> Result<T, DatabaseError>) -> Result<T, DatabaseError> {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !GUARDED.get() {
                before(panic);
            }
        }));
    });
    let outer = GUARDED.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(action));
    GUARDED.set(outer);
    outcome.unwrap_or_else(|_| {
        Err(DatabaseError::Damaged { path: path.into(), what: "its pages contradict each other".into() })
    })
}
