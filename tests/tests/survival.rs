//! Processes that are ended at any moment, and places that take no files: older files stay whole or are replaced by
//! whole ones, nothing else is left, and interrupted work goes on to the same bytes.

use std::collections::BTreeMap;
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use tests::TIMEOUT;

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
/// What stands in each file before the program begins.
const OLDER: &[u8] = b"an older file";
/// What takes longer is tried less often; on a slow machine, what takes longer than so many times the median of all.
const LONG: (Duration, u32) = (Duration::from_millis(500), 8);
/// What takes even longer is tried in the long lane only.
const LONGEST: (Duration, u32) = (Duration::from_millis(1500), 24);

/// A command that writes.
struct Case {
    program: &'static str,
    /// Its arguments; those that name files do so in the current folder.
    arguments: &'static [&'static str],
    /// The files that it writes.
    files: &'static [&'static str],
    /// Arguments that make it go on where it was interrupted.
    resume: &'static [&'static str],
}

/// A command of the host.
const fn peris_case(
    arguments: &'static [&'static str],
    files: &'static [&'static str],
    resume: &'static [&'static str],
) -> Case {
    Case { program: PERIS, arguments, files, resume }
}

impl Case {
    /// The program with its arguments, in a folder.
    fn command(&self, folder: &Path) -> Command {
        let mut command = Command::new(self.program);
        command.args(self.arguments).current_dir(folder).env("PERIS_PS340", PS340).stdin(Stdio::null());
        command
    }
}

/// Every sub-command that writes files of its own.
const CASES: &[Case] = &[
    peris_case(
        &["render", "teapot", "--width", "48", "--samples", "24", "-o", "a.png", "-o", "a.exr", "--layers"],
        &["a.png", "a.exr"],
        &[],
    ),
    peris_case(
        &["render", "teapot", "--width", "48", "--samples", "24", "-o", "b.exr"],
        &["b.exr"],
        &["--resume", "b.state", "--checkpoint", "0.02"],
    ),
    peris_case(
        &["render", "teapot", "--width", "32", "--samples", "8", "--views", "3", "-o", "c.png"],
        &["c-1.png", "c-2.png", "c-3.png"],
        &["--resume", "c.state", "--checkpoint", "0.02"],
    ),
    peris_case(
        &["render", "ring", "--renderer", "two-way", "--width", "24", "--samples", "10", "-o", "d.exr"],
        &["d.exr"],
        &["--resume", "d.state", "--checkpoint", "0.1"],
    ),
    peris_case(
        &["render", "cube.rhai", "--renderer", "radiosity", "--width", "24", "-o", "e.exr"],
        &["e.exr"],
        &["--resume", "e.state"],
    ),
    peris_case(&["compose", "one.exr", "over", "two.exr", "-o", "f.png"], &["f.png"], &[]),
    peris_case(&["diff", "one.exr", "two.exr", "--map", "g.png"], &["g.png"], &[]),
    peris_case(&["octree", "cube.rhai", "-o", "h.octree"], &["h.octree"], &[]),
    peris_case(&["tessellate", "cube.rhai", "-o", "i.obj"], &["i.obj"], &[]),
    peris_case(&["convert", "one.stl", "j.ply"], &["j.ply"], &[]),
    peris_case(&["convert", "one.exr", "k.png"], &["k.png"], &[]),
    peris_case(&["convert", "cube.rhai", "l.ps300"], &["l.ps300"], &[]),
    peris_case(&["boolean", "one.stl", "-", "two.stl", "-o", "m.glb"], &["m.glb"], &[]),
    peris_case(&["check", "one.stl", "--repair", "n.stl"], &["n.stl"], &[]),
    peris_case(&["intersect", "cube.rhai", "-o", "o.csv"], &["o.csv"], &[]),
    peris_case(&["db", "export", "shipped", "copper", "p.json", "--kind", "material"], &["p.json"], &[]),
    peris_case(&["db", "plot", "shipped", "copper", "--kind", "material", "-o", "q"], &["q/copper.png"], &[]),
    peris_case(
        &["run", "cube.rhai", "-o", "r", "--samples", "1"],
        &[
            "r/vector-before.png",
            "r/vector-after.png",
            "r/raytraced.png",
            "r/raytraced.exr",
            "r/raster.png",
            "r/CONTENTS.txt",
        ],
        &[],
    ),
    peris_case(
        &["demo", "--quick", "-o", "s", "--samples", "1"],
        &["s/vector-before.png", "s/vector-after.png", "s/raytraced.png", "s/raytraced.exr", "s/raster.png"],
        &[],
    ),
    peris_case(
        &["study", "illumination", "--roughness", "0.5", "-o", "t"],
        &["t/illumination.csv", "t/illumination-0.5.svg", "t/illumination-0.5.png"],
        &["--resume"],
    ),
    Case {
        program: PS340,
        arguments: &["play", "--orders", "u.play", "--quiet", "--picture", "u.png", "--transcript", "u.txt"],
        files: &["u.png", "v.png", "u.txt"],
        resume: &[],
    },
];

const SCRIPT: &str = "box(2, 2, 2).name(\"a\"); sphere(1.3).name(\"b\").translate(0, 1, 0);
    rectangle_light(#{ corner: [-1, 4, -1], across: [2, 0, 0], up: [0, 0, 2], radiance: 10 });";

const PLAY: &str = "A := VECTOR_LIST ITEMIZED N=2 P 0,0 L 1,1;\nDISPLAY A;\n@ frames 20\n@ picture vector v.png\n";

/// Runs the program to its end; its exit code and what it said on standard error.
fn peris(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(PERIS).args(arguments).current_dir(folder).output().expect("the program starts");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Makes what the commands read.
fn prepare(folder: &Path) {
    std::fs::write(folder.join("cube.rhai"), SCRIPT).expect("written");
    std::fs::write(folder.join("ball.rhai"), "sphere(1.2);").expect("written");
    std::fs::write(folder.join("u.play"), PLAY).expect("written");
    for arguments in [
        &["render", "teapot", "--width", "40", "--samples", "1", "--matte", "-o", "one.exr"][..],
        &["render", "teapot", "--width", "40", "--samples", "2", "--matte", "-o", "two.exr"],
        &["tessellate", "cube.rhai", "-o", "cube.stl"],
        &["tessellate", "ball.rhai", "-o", "one.stl"],
        &["convert", "one.stl", "two.stl", "--scale", "0.5"],
    ] {
        let (code, said) = peris(folder, arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {said}");
    }
}

/// The files of a folder and of those inside it, with what is in them.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry")) {
        let (name, path) = (entry.file_name().to_string_lossy().into_owned(), entry.path());
        match path.is_dir() {
            true => found.extend(contents(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes))),
            false => drop(found.insert(name, std::fs::read(path).unwrap_or_default())),
        }
    }
    found
}

/// Whether a process that runs is a zombie or gone within a time.
fn ended_within(child: &mut Child, limit: Duration) -> Option<ExitStatus> {
    let end = Instant::now() + limit;
    loop {
        if let Some(status) = child.try_wait().expect("it runs") {
            return Some(status);
        }
        if Instant::now() >= end {
            return None;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Ends a process by a signal.
fn signal(child: &Child, signal: rustix::process::Signal) {
    let pid = rustix::process::Pid::from_child(child);
    // It may have ended just now.
    let _ = rustix::process::kill_process(pid, signal);
}

/// What a file contains, but for the times in the tables of studies, which differ from run to run.
fn written(path: &Path) -> std::io::Result<Vec<u8>> {
    let bytes = std::fs::read(path)?;
    let Ok(text) = str::from_utf8(&bytes) else { return Ok(bytes) };
    // They are the last columns; cells before them may contain commas.
    let heading = text.lines().next().unwrap_or_default();
    let times = heading.rsplit(',').take_while(|name| name.ends_with("(ns)")).count();
    if times == 0 {
        return Ok(bytes);
    }
    let without = |line: &str| line.rsplitn(times + 1, ',').last().unwrap_or_default().to_string() + "\n";
    // A table that is cut in its last line must not look whole.
    let end = if text.ends_with('\n') { "" } else { "cut" };
    Ok((text.lines().map(without).collect::<String>() + end).into_bytes())
}

/// A reference run of each case: its files, and how long it takes.
fn references(folder: &Path) -> Vec<(Vec<Vec<u8>>, Duration)> {
    let run = |case: &Case| {
        let start = Instant::now();
        let output = case.command(folder).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(0), "{:?}: {output:?}", case.arguments);
        let took = start.elapsed();
        let files = case.files.iter().map(|file| written(&folder.join(file)).expect("written")).collect();
        (files, took)
    };
    CASES.iter().map(run).collect()
}

/// A picture that is whole, as an interrupted rendering may leave one with fewer samples.
fn is_picture(bytes: &[u8]) -> bool {
    image::load_from_memory(bytes).is_ok()
}

/// Ends commands at random moments by random signals.
fn survive(rounds: usize, seed: u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    prepare(folder);
    let mut references = references(folder);
    let inputs = contents(folder);
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let (mut interrupted, mut resumed, mut resumable) = (0, 0, 0);
    // Those that take longer come in every fourth turn, those that can be resumed at least once.
    let turns = (0..).flat_map(|turn| (0..CASES.len()).map(move |number| (turn, number)));
    let is_long = std::env::var_os("PERIS_LONG").is_some();
    let times: Vec<Duration> = references.iter().map(|(_, took)| *took).collect();
    let mut sorted = times.clone();
    sorted.sort_unstable();
    let median = sorted[sorted.len() / 2];
    let [long, longest] = [LONG, LONGEST].map(|(least, times)| least.max(median * times));
    let in_turn = |(turn, number): &(usize, usize)| match times[*number] {
        took if took < long => true,
        took => turn % 4 == 0 && (is_long || took < longest) || *turn == 0 && !CASES[*number].resume.is_empty(),
    };
    for (round, (_, number)) in turns.filter(in_turn).take(rounds).enumerate() {
        let (case, (whole, took)) = (&CASES[number], &mut references[number]);
        let Case { arguments, files, resume, .. } = case;
        resumable += usize::from(!resume.is_empty());
        let is_older: bool = random.random();
        for file in *files {
            let path = folder.join(file);
            let _ = std::fs::remove_file(&path);
            if is_older {
                std::fs::write(path, OLDER).expect("written");
            }
        }
        let mut attempts = 0;
        loop {
            attempts += 1;
            let mut child = case
                .command(folder)
                .args(*resume)
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .expect("the program starts");
            let wait = took.mul_f64(random.random::<f64>() * (0.5 + 0.5 * f64::from(attempts)));
            let signals = [
                rustix::process::Signal::KILL,
                rustix::process::Signal::TERM,
                rustix::process::Signal::HUP,
                rustix::process::Signal::INT,
            ];
            let chosen = signals[random.random_range(0..signals.len())];
            let start = Instant::now();
            match ended_within(&mut child, wait) {
                // The machine may have been busy with something else when the reference was run.
                Some(_) if attempts == 1 => *took = start.elapsed().min(*took),
                Some(_) => {}
                None => {
                    signal(&child, chosen);
                    interrupted += 1;
                }
            }
            let status = ended_within(&mut child, TIMEOUT).unwrap_or_else(|| panic!("{arguments:?} does not end"));
            let mut said = String::new();
            child.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
            let place = || format!("round {round}, {arguments:?}, {chosen:?} after {wait:?}: {status}\n{said}");
            for (file, whole) in files.iter().zip(&*whole) {
                match written(&folder.join(file)) {
                    Ok(found) if found == *whole || (is_older && found == OLDER) => {}
                    // The first pass of a rendering gives a whole picture.
                    Ok(found) => {
                        assert!(arguments[0] == "render" && is_picture(&found), "{file} is not whole: {}", place());
                        assert!(!status.success(), "{file} is another: {}", place());
                    }
                    Err(_) => assert!(!is_older && !status.success(), "{file} is missing: {}", place()),
                }
            }
            for (name, content) in contents(folder) {
                // What other cases wrote is not looked at.
                let is_written = CASES.iter().any(|case| case.files.contains(&&*name));
                let is_state = name.contains(".state") && !resume.is_empty();
                let is_growing = name.starts_with("u.txt.") && name.ends_with(".part");
                let is_before = inputs.get(&name).is_some_and(|before| *before == content);
                if chosen == rustix::process::Signal::KILL && name.contains(".peris-") {
                    // Killed between the two names of a file that replaces another: a moment that a signal waits for.
                    std::fs::remove_file(folder.join(name)).expect("removed");
                    continue;
                }
                assert!(is_written || is_state || is_growing || is_before, "{name} is left: {}", place());
            }
            if status.success() {
                let files = files.iter().map(|file| written(&folder.join(file)).expect("written"));
                assert!(files.eq(whole.iter().cloned()), "other bytes after {attempts} attempts: {}", place());
                resumed += usize::from(attempts > 1);
                break;
            }
            let is_by_signal = status.code().is_none_or(|code| code == 130);
            assert!(is_by_signal, "{}", place());
            if resume.is_empty() {
                break;
            }
        }
        let is_unfinished = |name: &String| name.contains(".state") || name.ends_with(".part");
        for name in contents(folder).into_keys().filter(is_unfinished) {
            std::fs::remove_file(folder.join(name)).expect("removed");
        }
    }
    assert!(
        interrupted > rounds / 4 && resumed > resumable / 3,
        "of {rounds}, {interrupted} interrupted; of {resumable} that can be resumed, {resumed} were"
    );
}

#[test]
fn what_is_ended_at_any_moment_harms_no_file_and_goes_on_to_the_same_bytes() {
    let is_long = std::env::var_os("PERIS_LONG").is_some();
    survive(if is_long { 2_000 } else { 200 }, 1);
}

#[test]
fn what_an_interrupted_study_has_done_is_not_replaced_and_a_finished_one_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let state = folder.join("illumination.state");
    std::fs::write(&state, OLDER).expect("written");
    let (code, said) = peris(folder, &["study", "illumination", "--roughness", "0.5"]);
    assert!(code == Some(2) && said.contains("--resume goes on"), "{code:?}: {said}");
    let (code, said) = peris(folder, &["study", "illumination", "--roughness", "0.5", "--resume"]);
    assert!(code == Some(2) && said.contains("the state of other work"), "{code:?}: {said}");
    assert_eq!(std::fs::read(&state).expect("there"), OLDER);
    std::fs::remove_file(&state).expect("removed");
    let (code, said) = peris(folder, &["study", "illumination", "--roughness", "0.5"]);
    assert!(code == Some(0) && !state.exists(), "{code:?}: {said}");
}

/// The arguments of a case with its files in another folder.
fn elsewhere(case: &Case, place: &str) -> Vec<String> {
    let in_place = |argument: &&str| match case.files.iter().any(|file| file.replace("-1", "") == **argument) {
        true => format!("{place}/{argument}"),
        false => argument.to_string(),
    };
    case.arguments.iter().map(in_place).collect()
}

#[test]
fn a_place_that_takes_no_file_is_refused_before_the_work_and_the_message_names_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    prepare(folder);
    std::fs::write(folder.join("file"), OLDER).expect("written");
    std::fs::create_dir(folder.join("closed")).expect("made");
    std::fs::set_permissions(folder.join("closed"), PermissionsExt::from_mode(0o555)).expect("closed");
    // Who may write everywhere finds no folder closed.
    let is_root = rustix::process::geteuid().is_root();
    let places = [("none", "there is no folder none"), ("file", "file is no folder"), ("closed", "takes no files")];
    let inputs = contents(folder);
    for case in CASES.iter().filter(|case| case.program == PERIS && !case.files[0].contains('/')) {
        for (place, expected) in places.iter().filter(|(place, _)| !(is_root && *place == "closed")) {
            let arguments = elsewhere(case, place);
            let (code, said) = peris(folder, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
            assert_eq!(code, Some(1), "{arguments:?}: {said}");
            assert!(said.contains("writing ") && said.contains(expected), "{arguments:?}: {said}");
            assert!(contents(folder) == inputs, "{arguments:?} leaves something");
        }
    }
}

#[test]
fn a_disk_that_is_full_leaves_the_older_file_and_the_whole_one_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    prepare(folder);
    // A file system of 64 KiB, seen by one process and its children.
    let script = "mkdir small && mount -t tmpfs -o size=64k none small && echo older > small/a.exr && \
                  \"$0\" render teapot --width 200 --samples 1 -o small/a.exr; echo \"code $?\"; \
                  cat small/a.exr; ls -A small";
    let mut command = Command::new("unshare");
    command.args(["--user", "--map-root-user", "--mount", "sh", "-c", script, PERIS]).current_dir(folder);
    command.env("TMPDIR", folder);
    let Ok(output) = command.output() else { return eprintln!("skipped: there is no unshare") };
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if !said.contains("code") {
        return eprintln!("skipped: no file system can be mounted: {errors}");
    }
    assert!(said.ends_with("code 1\nolder\na.exr\n"), "{said}{errors}");
    let kept = folder.join("a.exr");
    let expected = format!(
        "writing small/a.exr: No space left on device (os error 28); the whole file is kept as {}",
        kept.display()
    );
    assert!(errors.contains(&expected), "{errors}");
    assert!(is_picture(&std::fs::read(kept).expect("it is kept")));
}

#[test]
fn a_file_system_that_takes_nothing_is_refused_before_the_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    prepare(folder);
    std::fs::create_dir(folder.join("closed")).expect("made");
    let script = "mount -t tmpfs none closed && echo older > closed/a.exr && mount -o remount,ro closed && echo closed \
                  && \"$0\" \"$@\"; echo \"code $?\"; ls -A closed; cat closed/a.exr";
    for case in CASES.iter().filter(|case| case.program == PERIS && !case.files[0].contains('/')) {
        let mut command = Command::new("unshare");
        command.args(["--user", "--map-root-user", "--mount", "sh", "-c", script, PERIS]);
        command.args(elsewhere(case, "closed")).current_dir(folder).env("TMPDIR", folder);
        let Ok(output) = command.output() else { return eprintln!("skipped: there is no unshare") };
        let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        if !said.starts_with("closed") {
            return eprintln!("skipped: no file system can be mounted: {errors}");
        }
        assert!(said.ends_with("code 1\na.exr\nolder\n"), "{:?}: {said}{errors}", case.arguments);
        assert!(errors.contains("writing closed/") && errors.contains("Read-only"), "{:?}: {errors}", case.arguments);
    }
}
