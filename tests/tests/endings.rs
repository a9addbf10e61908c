//! Processes that are ended by a signal at any moment leave nothing: no socket, no child, no temporary file.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rustix::process::Signal;
use std::{
    fs,
    io::{BufRead, BufReader},
    os::unix::process::ExitStatusExt,
    path::Path,
    process::{Child, Command, ExitStatus, Stdio},
    time::{Duration, Instant},
};
use tests::{TIMEOUT, send_signal};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
/// Marks the processes of a test, children of children included.
const MARK: &str = "PERIS_TEST_MARK";
/// Exit code of a program that was asked to end.
const INTERRUPTED: i32 = 130;
/// How long a child may be seen after its parent; generous, for machines with other work.
const SOON: Duration = Duration::from_secs(10);

/// How often each program is started and ended.
fn rounds() -> u32 {
    if std::env::var_os("PERIS_LONG").is_some() { 500 } else { 20 }
}

/// Starts a program whose standard input stays open.
fn start(program: &str, arguments: &[&str], folder: &Path) -> Child {
    Command::new(program)
        .args(arguments)
        .env("PERIS_PS340", PS340)
        .env("TMPDIR", folder)
        .env(MARK, folder)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts")
}

fn wait(child: &mut Child) -> ExitStatus {
    let end = Instant::now() + TIMEOUT;
    loop {
        match child.try_wait().expect("the process can be asked") {
            Some(status) => return status,
            None => assert!(Instant::now() < end, "the process does not end"),
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The processes with the mark of a folder.
fn marked(folder: &Path) -> Vec<String> {
    let mark = format!("{MARK}={}", folder.display());
    let is_marked = |process: &String| {
        let environment = fs::read(format!("/proc/{process}/environ")).unwrap_or_default();
        environment.split(|byte| *byte == 0).any(|variable| variable == mark.as_bytes())
    };
    let entries = fs::read_dir("/proc").expect("Linux").filter_map(Result::ok);
    let processes = entries.filter_map(|entry| entry.file_name().into_string().ok());
    processes.filter(|name| name.parse::<u32>().is_ok()).filter(is_marked).collect()
}

/// What is in a folder and in those inside it, but for files that a program was asked to make.
fn left(folder: &Path, made: &[&str]) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).expect("it is there").map(|entry| entry.expect("it can be read")) {
        let name = entry.file_name().to_string_lossy().into_owned();
        match entry.file_type().expect("it has a type").is_dir() {
            true => names.extend(left(&entry.path(), made)),
            false if made.contains(&name.as_str()) => {}
            false => names.push(name),
        }
    }
    names
}

/// Starts a program again and again, and ends it by a signal at a random moment.
///
/// - `made`: the files that it may leave.
/// - `longest`: seconds until the signal, at most.
fn end_at_any_moment(program: &str, arguments: &[&str], made: &[&str], signals: &[Signal], longest: f64) {
    // A job in the background ignores Ctrl-C, and so do the programs that it starts, until they say otherwise.
    let signals: Vec<Signal> =
        signals.iter().copied().filter(|signal| !processes::is_ignored(signal.as_raw() as u32)).collect();
    let mut random = Pcg64Mcg::seed_from_u64(1988);
    let mut ended_by_itself = 0;
    for round in 0..rounds() {
        let folder = tempfile::tempdir().expect("a folder");
        let signal = signals[random.random_range(0..signals.len())];
        // Half of the moments are in the beginning, where most is made.
        let scale = if random.random() { longest } else { longest / 5.0 };
        let mut child = start(program, arguments, folder.path());
        std::thread::sleep(Duration::from_secs_f64(random.random_range(0.0..scale)));
        send_signal(&child, signal);
        let status = wait(&mut child);
        // Before the program takes signals the system ends it; there is nothing yet.
        let by_signal = status.signal() == Some(signal.as_raw()) || status.code() == Some(INTERRUPTED);
        ended_by_itself += u32::from(!by_signal);
        let told = format!("round {round}, {signal:?}, {status}");
        let end = Instant::now() + SOON;
        while !marked(folder.path()).is_empty() {
            assert!(Instant::now() < end, "{told}: a child is left");
            std::thread::sleep(Duration::from_millis(2));
        }
        assert_eq!(left(folder.path(), made), Vec::<String>::new(), "{told}");
    }
    assert!(ended_by_itself * 2 < rounds(), "{ended_by_itself} of {} ended before the signal", rounds());
}

#[test]
fn a_machine_that_is_ended_by_a_signal_leaves_no_socket() {
    let arguments =
        ["--listen", "unix:line", "--listen", "pty:", "--operator", "unix:operator", "--capture", "capture"];
    end_at_any_moment(PS340, &arguments, &["capture"], &[Signal::INT, Signal::TERM, Signal::HUP], 0.15);
}

#[test]
fn a_host_that_is_ended_by_a_signal_leaves_no_machine() {
    let signals = [Signal::INT, Signal::TERM, Signal::HUP, Signal::KILL];
    end_at_any_moment(PERIS, &["show", "primitives"], &[], &signals, 0.6);
}

#[test]
fn a_signal_after_the_machine_is_ready_ends_it_as_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["--listen", "unix:line", "--operator", "none"];
    // As nohup does it.
    let script = "trap '' HUP; exec \"$0\" \"$@\"";
    for outlives in [false, true] {
        // Whoever started the tests may have made them ignore a hang-up.
        let (program, first) = if outlives { ("sh", ["-c", script]) } else { ("env", ["--default-signal=HUP", "--"]) };
        let mut command = Command::new(program);
        command
            .args(first)
            .arg(PS340)
            .args(arguments)
            .current_dir(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        let mut child = command.spawn().expect("the program starts");
        let said = BufReader::new(child.stdout.take().expect("piped")).lines();
        assert!(said.map_while(Result::ok).any(|line| line == "ready"));
        send_signal(&child, Signal::HUP);
        if outlives {
            std::thread::sleep(Duration::from_millis(300));
            assert_eq!(child.try_wait().expect("it can be asked"), None, "a hang-up that is ignored ends nothing");
            send_signal(&child, Signal::TERM);
        }
        assert_eq!(wait(&mut child).code(), Some(INTERRUPTED));
        assert_eq!(left(folder.path(), &[]), Vec::<String>::new());
    }
}

#[test]
fn a_machine_that_stands_still_ends_with_a_host_that_is_killed() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut host = start(PERIS, &["show", "primitives"], folder.path());
    let own = host.id().to_string();
    let end = Instant::now() + TIMEOUT;
    let machine = loop {
        let others = marked(folder.path()).into_iter().find(|process| *process != own);
        // Its name shows that it is the machine already, and not yet the host that makes it.
        let name =
            others.as_ref().map(|process| fs::read_to_string(format!("/proc/{process}/comm")).unwrap_or_default());
        match (others, name) {
            (Some(process), Some(name)) if name.starts_with("ps340") => break process,
            _ => assert!(Instant::now() < end, "the host starts a machine"),
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    // It has asked the system to end with its parent when it listens.
    std::thread::sleep(Duration::from_millis(500));
    let process = rustix::process::Pid::from_raw(machine.parse().expect("a number")).expect("a process");
    rustix::process::kill_process(process, Signal::STOP).expect("it can be stopped");
    send_signal(&host, Signal::KILL);
    wait(&mut host);
    let end = Instant::now() + SOON;
    while !marked(folder.path()).is_empty() {
        assert!(Instant::now() < end, "the machine is left");
        std::thread::sleep(Duration::from_millis(2));
    }
}
