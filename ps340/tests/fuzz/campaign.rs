//! Trying inputs on a target: what fails is kept, made short, and written to a file.

use crate::{
    chance::Chance,
    mutation::mutate,
    pool::{Features, InputPool},
    watch::Slot,
};
use std::{
    cell::{Cell, RefCell},
    collections::BTreeMap,
    env, fs,
    panic::{self, AssertUnwindSafe},
    path::{Path, PathBuf},
    sync::{
        Mutex, MutexGuard, Once, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
};

/// Executions that making a failing input shorter may take.
const REDUCTIONS: usize = 1_000;

/// Something that takes any bytes, and panics if a promise is broken.
#[derive(Debug)]
pub struct Target {
    pub name: &'static str,
    pub seeds: fn() -> Vec<Vec<u8>>,
    pub run: fn(&[u8], &mut Features),
}

/// An input that fails, and how.
#[derive(Clone, Debug)]
pub struct FuzzFailure {
    pub message: String,
    pub input: Vec<u8>,
}

/// A target, its pool, and what was found.
#[derive(Debug)]
pub struct Campaign {
    pub target: &'static Target,
    pool: Mutex<InputPool>,
    executions: AtomicU64,
    /// By the location in the source that panicked.
    failures: Mutex<BTreeMap<String, FuzzFailure>>,
}

impl Campaign {
    /// A campaign that has tried every seed.
    pub fn new(target: &'static Target, slot: Option<&Slot>) -> Campaign {
        let mut pool = InputPool::default();
        let seeds = (target.seeds)();
        seeds.iter().for_each(|seed| pool.plant(seed.clone()));
        let campaign = Campaign { target, pool: pool.into(), executions: 0.into(), failures: BTreeMap::new().into() };
        let mut chance = Chance::new(0);
        seeds.iter().for_each(|seed| campaign.execute(seed, &mut chance, slot));
        campaign
    }

    /// Tries one changed input.
    pub fn advance(&self, chance: &mut Chance, slot: Option<&Slot>) {
        let (parent, other) = {
            let pool = lock(&self.pool);
            (pool.draw(chance), pool.draw(chance))
        };
        self.execute(&mutate(chance, &parent, &other), chance, slot);
    }

    fn execute(&self, input: &[u8], chance: &mut Chance, slot: Option<&Slot>) {
        if let Some(slot) = slot {
            slot.begin(self.target.name, input);
        }
        let result = attempt(self.target, input);
        if let Some(slot) = slot {
            slot.end();
        }
        self.executions.fetch_add(1, Ordering::Relaxed);
        match result {
            Ok(features) => lock(&self.pool).learn(input, features, chance),
            Err((place, message)) => self.fail(place, message, input),
        }
    }

    fn fail(&self, place: String, message: String, input: &[u8]) {
        let known = lock(&self.failures).contains_key(&place);
        if known {
            return;
        }
        let input = reduced(self.target, input, &place);
        let file = write_input(self.target.name, &place, &input);
        eprintln!("fuzz {}: {place}: {message}\n  again with PERIS_FUZZ_INPUT={}", self.target.name, file.display());
        lock(&self.failures).insert(place, FuzzFailure { message, input });
    }

    pub fn failures(&self) -> BTreeMap<String, FuzzFailure> {
        lock(&self.failures).clone()
    }

    pub fn executions(&self) -> u64 {
        self.executions.load(Ordering::Relaxed)
    }

    /// Inputs in the pool, and things that were seen.
    pub fn sizes(&self) -> (usize, usize) {
        let pool = lock(&self.pool);
        (pool.len(), pool.seen())
    }
}

pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Where inputs are written.
pub fn folder() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// An input as it stands in a file: the target, a line end, the bytes.
pub fn file_form(target: &str, input: &[u8]) -> Vec<u8> {
    [target.as_bytes(), b"\n", input].concat()
}

fn write_input(target: &str, place: &str, input: &[u8]) -> PathBuf {
    let place: String = place.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let path = folder().join(format!("fuzz-{target}-{place}.input"));
    if let Err(error) = fs::write(&path, file_form(target, input)) {
        eprintln!("fuzz: {}: {error}", path.display());
    }
    path
}

/// Leaves out what is not needed for the same failure.
fn reduced(target: &Target, input: &[u8], place: &str) -> Vec<u8> {
    let mut short = input.to_vec();
    let (mut size, mut left) = (short.len() / 2, REDUCTIONS);
    while size > 0 {
        let mut at = 0;
        while at < short.len() && left > 0 {
            let mut less = short.clone();
            less.drain(at..(at + size).min(short.len()));
            left -= 1;
            if attempt(target, &less).is_err_and(|(other, _)| other == place) { short = less } else { at += size }
        }
        size /= 2;
    }
    short
}

thread_local! {
    static TRYING: Cell<bool> = const { Cell::new(false) };
    static LATEST: RefCell<Option<(String, String)>> = const { RefCell::new(None) };
}

/// Runs a target; location and message if it panics.
fn attempt(target: &Target, input: &[u8]) -> Result<Features, (String, String)> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !TRYING.get() {
                return usual(info);
            }
            let place = info.location().map_or("?".into(), |at| format!("{}:{}", at.file(), at.line()));
            let message = info.payload_as_str().unwrap_or("?").to_owned();
            LATEST.replace(Some((place, message)));
        }));
    });
    let mut features = Features::default();
    TRYING.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(|| (target.run)(input, &mut features)));
    TRYING.set(false);
    match result {
        Ok(()) => Ok(features),
        Err(_) => Err(LATEST.take().unwrap_or(("another thread".into(), "a panic".into()))),
    }
}
