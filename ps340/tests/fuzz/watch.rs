//! What each worker tries now, so that an input that hangs, or ends the process, is not lost.

use crate::campaign::{file_form, folder, lock};
use std::{
    fs::{self, File},
    os::unix::fs::FileExt,
    path::PathBuf,
    sync::Mutex,
    time::{Duration, Instant},
};

/// An input that runs so long is reported.
const LONG: Duration = Duration::from_secs(20);

/// What one worker tries now.
#[derive(Debug)]
pub struct Slot {
    path: PathBuf,
    file: Option<File>,
    running: Mutex<Option<Running>>,
}

#[derive(Debug)]
struct Running {
    since: Instant,
    input: Vec<u8>,
    told: bool,
}

impl Slot {
    pub fn new(number: usize) -> Slot {
        let path = folder().join(format!("fuzz-worker-{number}.input"));
        Slot { file: File::create(&path).ok(), path, running: None.into() }
    }

    /// An input begins; until it ends it stands in the file of the slot too, which outlives a fallen process.
    pub fn begin(&self, target: &str, input: &[u8]) {
        let input = file_form(target, input);
        if let Some(file) = &self.file {
            let written = file.set_len(0).and_then(|()| file.write_all_at(&input, 0));
            written.unwrap_or_else(|error| eprintln!("fuzz: {}: {error}", self.path.display()));
        }
        *lock(&self.running) = Some(Running { since: Instant::now(), input, told: false });
    }

    pub fn end(&self) {
        *lock(&self.running) = None;
    }

    /// Reports an input that runs for long, once, and writes it to a file.
    pub fn tell_long(&self) -> bool {
        let mut running = lock(&self.running);
        let Some(running) = running.as_mut().filter(|running| running.since.elapsed() > LONG && !running.told) else {
            return false;
        };
        running.told = true;
        let path = self.path.with_extension(format!("{}.slow", running.input.len()));
        let _ = fs::write(&path, &running.input);
        eprintln!("fuzz: longer than {LONG:?}\n  again with PERIS_FUZZ_INPUT={}", path.display());
        true
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Memory of the process in MiB, where the system reports it.
pub fn resident() -> u64 {
    let pages =
        fs::read_to_string("/proc/self/statm").ok().and_then(|text| text.split(' ').nth(1)?.parse::<u64>().ok());
    pages.unwrap_or(0) / 256
}
