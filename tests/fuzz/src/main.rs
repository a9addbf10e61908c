//! Fuzzing of one reader: the one that is called as the folder of the first argument, as in `corpus/png`.
#![no_main]

#[path = "../../src/readers/mod.rs"]
mod readers;

use libfuzzer_sys::fuzz_target;
use readers::{READERS, Reader, reader};
use std::path::Path;
use std::sync::OnceLock;

static CHOSEN: OnceLock<Reader> = OnceLock::new();

/// The reader that the arguments name; ends the program where they name none.
fn chosen() -> Reader {
    let first = std::env::args().skip(1).find(|argument| !argument.starts_with('-')).unwrap_or_default();
    let path = Path::new(&first);
    let folder = if path.is_file() { path.parent() } else { Some(path) };
    let name = folder.and_then(Path::file_name).and_then(|name| name.to_str()).unwrap_or_default();
    reader(name).unwrap_or_else(|| {
        let names = READERS.map(|reader| reader.name).join(", ");
        eprintln!("name the folder of a reader first, as in corpus/png; there are {names}");
        std::process::exit(2);
    })
}

fuzz_target!(init: { _ = CHOSEN.set(chosen()) }, |bytes: &[u8]| (CHOSEN.get_or_init(chosen).read)(bytes));
