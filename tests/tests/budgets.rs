//! Small files that ask for much memory: each is done or refused, soon, within the memory that the program was given.

#[path = "budgets/bombs.rs"]
mod bombs;

use bombs::BOMBS;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tests::TIMEOUT;

/// The program; the variable PERIS_PROGRAM names another, such as an optimised one whose times are to be seen.
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
/// Memory of a bomb, bytes.
const MEMORY: u64 = 256 << 20;
/// Most bytes of a texel, with its smaller copies.
const TEXEL: f64 = 6.0;

/// How a run ended.
struct Ended {
    code: Option<i32>,
    said: String,
    peak: u64,
    seconds: f64,
}

fn run(folder: &Path, arguments: &[String], memory: &str) -> Ended {
    let program = std::env::var("PERIS_PROGRAM").unwrap_or_else(|_| PERIS.into());
    let begin = Instant::now();
    let mut command = Command::new(program);
    command.args(arguments).args(["--memory", memory]).current_dir(folder);
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    let mut errors = child.stderr.take().expect("a pipe");
    let errors = std::thread::spawn(move || {
        let mut text = String::new();
        errors.read_to_string(&mut text).map(|_| text)
    });
    let (status, mut peak) = (format!("/proc/{}/status", child.id()), 0);
    let code = loop {
        let told = std::fs::read_to_string(&status).unwrap_or_default();
        let line = told.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        peak = line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok()).unwrap_or(peak);
        if let Some(status) = child.try_wait().expect("it runs") {
            break status.code();
        }
        if begin.elapsed() > TIMEOUT {
            let _ = child.kill();
            break None;
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    let said = errors.join().expect("read").expect("text");
    Ended { code, said, peak: peak << 10, seconds: begin.elapsed().as_secs_f64() }
}

#[test]
fn fifty_bombs_are_done_or_refused_within_the_memory_that_was_given() {
    assert!(BOMBS.len() >= 40);
    let mut wrong = Vec::new();
    for bomb in BOMBS {
        let folder = tempfile::tempdir().expect("a folder");
        (bomb.make)(folder.path());
        let arguments: Vec<String> = bomb.command.split(' ').map(str::to_owned).collect();
        let Ended { code, said, peak, seconds } = run(folder.path(), &arguments, "256M");
        let first = said.lines().next().unwrap_or_default();
        println!("{:<52} {seconds:6.2} s {:4} MiB  {code:?} {first}", bomb.name, peak >> 20);
        // What is refused says why, and 101 is a panic.
        let is_told = code == Some(0) || matches!(code, Some(1..=5)) && said.contains("peris ");
        if !is_told || peak > MEMORY || said.contains("panicked") || !said.contains(bomb.says) {
            wrong.push(format!("{}: {code:?} {} MiB {said}", bomb.name, peak >> 20));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn images_on_surfaces_take_at_most_six_bytes_a_texel() {
    let is_long = std::env::var_os("PERIS_LONG").is_some();
    let side = if is_long { 16_384 } else { 2048 };
    let folder = tempfile::tempdir().expect("a folder");
    let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let peak = |file: &str| {
        let script = format!("sphere(1).material(picture(\"{file}\"));");
        std::fs::write(folder.path().join("a.rhai"), script).expect("written");
        let Ended { code, said, peak, seconds } = run(folder.path(), &words("plan a.rhai"), "6G");
        println!("{file} of {side} x {side}: {seconds:.2} s, {} MiB", peak >> 20);
        assert_eq!(code, Some(0), "{said}");
        peak
    };
    std::fs::write(folder.path().join("none.png"), bombs::zero_png([1, 1], 2, 8, 1)).expect("written");
    let beside = peak("none.png");
    let mut files = vec!["bytes.png", "words.png", "grey.png"];
    for (name, color, depth) in [("bytes.png", 2, 8), ("words.png", 2, 16), ("grey.png", 0, 16)] {
        std::fs::write(folder.path().join(name), bombs::zero_png([side; 2], color, depth, side)).expect("written");
    }
    // Converting takes a picture in floating-point numbers.
    let small = if is_long { 8192 } else { side };
    std::fs::write(folder.path().join("small.png"), bombs::zero_png([small; 2], 2, 8, small)).expect("written");
    assert_eq!(run(folder.path(), &words("convert small.png floats.exr"), "6G").code, Some(0));
    files.push("floats.exr");
    for file in files {
        let texels = f64::from(if file == "floats.exr" { small } else { side }).powi(2);
        let bytes = (peak(file) - beside) as f64 / texels;
        assert!(bytes <= TEXEL, "{file}: {bytes:.2} bytes a texel");
    }
}
