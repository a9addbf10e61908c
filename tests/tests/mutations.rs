//! No reader panics or hangs, whatever chance makes of the bytes that it gets.
//!
//! The inputs are those of `tests/fuzz/corpus`, changed by lot, the same ones each time; in the long lane, with
//! `PERIS_LONG=1`, a million of them. Fuzzing, which looks for what was not yet seen, is in `tests/fuzz`.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use std::{env, fs, process, thread};
use tests::readers::{READERS, Reader};

/// Changed inputs of all readers together, in an ordinary run.
const FEW: usize = 4_050;
/// Changed inputs of all readers together, in the long lane.
const MANY: usize = 1_000_000;
/// An input that takes longer hangs.
const PATIENCE: Duration = Duration::from_secs(60);
/// Longest input, bytes.
const LONGEST: usize = 1 << 17;
/// Numbers that lengths and indices are least ready for.
const NUMBERS: [u64; 8] = [0, 1, 0x7F, 0xFF, 0x7FFF_FFFF, 0xFFFF_FFFF, 0x8000_0000, u64::MAX];

/// What a worker does now.
struct Now {
    reader: &'static str,
    number: usize,
    since: Instant,
    bytes: Vec<u8>,
}

/// The inputs that are kept for a reader, in the order of their names.
fn kept(reader: &Reader) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(reader.name);
    let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder can be read").path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    paths.iter().map(|path| fs::read(path).expect("a file of the corpus can be read")).collect()
}

/// A changed copy of one input, some of it from the others.
fn changed(random: &mut Pcg64Mcg, inputs: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = inputs[random.random_range(..inputs.len())].clone();
    for _ in 0..1 << random.random_range(0..4) {
        let other = &inputs[random.random_range(..inputs.len())];
        change(random, &mut bytes, other);
        bytes.truncate(LONGEST);
    }
    bytes
}

/// Changes bytes at one place: flips a bit, sets a byte or a number, inserts, deletes, duplicates, splices, cuts.
fn change(random: &mut Pcg64Mcg, bytes: &mut Vec<u8>, other: &[u8]) {
    let at = random.random_range(0..=bytes.len());
    let part = at..random.random_range(at..=bytes.len().min(at + 64));
    let of_other = random.random_range(0..=other.len());
    match random.random_range(0..8) {
        0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << random.random_range(0..8)),
        1 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.next_u32() as u8),
        2 => {
            let number = NUMBERS[random.random_range(..NUMBERS.len())].to_le_bytes();
            let width = 1 << random.random_range(0..4);
            bytes.iter_mut().skip(at).zip(&number[..width]).for_each(|(byte, new)| *byte = *new);
        }
        3 => drop(bytes.splice(at..at, vec![random.next_u32() as u8; 1 << random.random_range(0..7)])),
        4 => drop(bytes.drain(part)),
        5 => {
            let copy = bytes[part].to_vec();
            bytes.splice(at..at, copy);
        }
        6 => {
            bytes.truncate(at);
            bytes.extend_from_slice(&other[of_other..]);
        }
        _ => bytes.truncate(at),
    }
}

/// Gives changed inputs to a reader; those at which it panics are written to files, whose names are returned.
fn tried(reader: &Reader, count: usize, now: &Mutex<Option<Now>>) -> Vec<String> {
    let inputs = kept(reader);
    let mut random = Pcg64Mcg::seed_from_u64(reader.name.bytes().fold(1, |sum, byte| sum * 31 + u64::from(byte)));
    let mut failed = Vec::new();
    for number in 0..count {
        let bytes = changed(&mut random, &inputs);
        let begun = Now { reader: reader.name, number, since: Instant::now(), bytes: bytes.clone() };
        *now.lock().expect("no worker holds it while it panics") = Some(begun);
        if catch_unwind(AssertUnwindSafe(|| (reader.read)(&bytes))).is_err() {
            failed.push(saved(reader.name, number, &bytes));
        }
    }
    *now.lock().expect("no worker holds it while it panics") = None;
    failed
}

/// Writes an input to a file, so that it can be tried again; its name.
fn saved(reader: &str, number: usize, bytes: &[u8]) -> String {
    let path = env::temp_dir().join(format!("peris-mutation-{reader}-{number}"));
    fs::write(&path, bytes).expect("there is room for temporary files");
    path.display().to_string()
}

/// Ends the tests if a worker hangs.
fn watch(workers: &[Mutex<Option<Now>>]) {
    for worker in workers {
        let now = worker.lock().expect("no worker holds it while it panics");
        if let Some(Now { reader, number, bytes, .. }) = now.as_ref().filter(|now| now.since.elapsed() > PATIENCE) {
            eprintln!("{reader} takes longer than {PATIENCE:?} for {}", saved(reader, *number, bytes));
            process::exit(1);
        }
    }
}

#[test]
fn readers_survive_what_chance_makes_of_their_inputs() {
    let is_long = env::var("PERIS_LONG").is_ok_and(|value| value == "1");
    let count = if is_long { MANY } else { FEW }.div_ceil(READERS.len());
    let workers: Vec<Mutex<Option<Now>>> =
        (0..thread::available_parallelism().map_or(1, usize::from)).map(|_| Mutex::new(None)).collect();
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = |worker: &Mutex<Option<Now>>| {
        while let Some(reader) = READERS.get(next.fetch_add(1, Ordering::Relaxed)) {
            let begun = Instant::now();
            let found = tried(reader, count, worker);
            println!("{}: {count} in {:.2} s", reader.name, begun.elapsed().as_secs_f64());
            failed.lock().expect("nothing panics here").extend(found);
        }
    };
    thread::scope(|scope| {
        let threads: Vec<_> = workers.iter().map(|worker| scope.spawn(|| work(worker))).collect();
        while threads.iter().any(|thread| !thread.is_finished()) {
            thread::sleep(Duration::from_millis(20));
            watch(&workers);
        }
    });
    let failed = failed.into_inner().expect("nothing panics here");
    assert!(failed.is_empty(), "readers panicked; their inputs are {}", failed.join(", "));
}
