//! What hosts and partners that misbehave cost: those that do not read, send nothing, or stand still.

use rustix::process::Signal;
use std::{
    fs,
    io::Write,
    net::{TcpListener, TcpStream},
    os::unix::fs::PermissionsExt,
    path::Path,
    time::{Duration, Instant},
};
use tests::{Ended, Host, Machine, TIMEOUT, run};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");
/// Hosts that one socket of the machine serves.
const MAX_HOSTS: usize = 64;
/// What is to take a second may take so long on a machine with other work.
const SOON: Duration = Duration::from_secs(5);

fn is_long() -> bool {
    std::env::var_os("PERIS_LONG").is_some()
}

/// Waits until a condition holds.
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !holds() {
        assert!(begin.elapsed() < TIMEOUT, "{what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// A number of the machine's counters.
fn counter(machine: &mut Machine, name: &str) -> u64 {
    let counters = machine.operator_command("counters");
    let value = counters.split(' ').find_map(|word| word.strip_prefix(name)?.strip_prefix('='));
    value.and_then(|value| value.parse().ok()).unwrap_or_else(|| panic!("no {name} in {counters}"))
}

#[test]
fn eight_hosts_that_do_not_read_cost_at_most_200_megabytes() {
    // Short messages cost most beside what they carry; to fill the output queue of a host with them takes longer.
    let (text, count) = if is_long() { ("a", 4_000_000) } else { ("twenty bytes of text", 600_000) };
    let mut machine = Machine::start(PS340, &[]);
    let mut hosts: Vec<TcpStream> = (0..8).map(|_| TcpStream::connect(&machine.line).unwrap()).collect();
    for (number, host) in hosts.iter_mut().enumerate() {
        // Two functions that send each other a message for ever, and the host each time.
        let text = format!(
            "A{number} := F:NOP; B{number} := F:NOP; CONNECT A{number}<1>:<1>B{number}; CONNECT B{number}<1>:<1>A{number};
             CONNECT A{number}<1>:<1>HOST_MESSAGE; SEND '{text}' TO <1>A{number};"
        );
        host.write_all(text.as_bytes()).unwrap();
    }
    let mut most = 0.0_f64;
    until("the machine has sent enough", || {
        most = most.max(machine.resident_megabytes());
        counter(&mut machine, "messages_out") >= count
    });
    most = most.max(machine.resident_megabytes());
    assert!(most < 200.0, "{most} MB");
    // A host that reads is served all the same.
    drop(hosts);
    let mut host = machine.attach();
    host.send("INITIALIZE;");
    host.synchronize();
}

/// Attaches hosts, one after the other.
fn attach(machine: &Machine, count: usize) -> Vec<Host> {
    (0..count).map(|_| machine.attach()).collect()
}

#[test]
fn silent_hosts_give_way_to_one_that_comes_later() {
    let machine = Machine::start(PS340, &[]);
    let mut silent = attach(&machine, MAX_HOSTS);
    let begin = Instant::now();
    let mut newcomer = machine.attach();
    newcomer.synchronize();
    assert!(begin.elapsed() < SOON, "{:?}", begin.elapsed());
    assert_eq!(silent[0].rest(), "", "the one that came first has left");
    silent[1].synchronize();
    newcomer.synchronize();
}

#[test]
fn hosts_that_have_spoken_keep_their_places_and_the_newcomer_is_told() {
    let machine = Machine::start(PS340, &[]);
    let mut hosts = attach(&machine, MAX_HOSTS);
    hosts.iter_mut().for_each(Host::synchronize);
    let begin = Instant::now();
    let mut newcomer = machine.attach();
    newcomer.send("INITIALIZE;");
    let said = newcomer.rest();
    assert!(begin.elapsed() < SOON, "{:?}", begin.elapsed());
    assert_eq!(said, "The PS 340 is full: 64 hosts are attached. Come again when one has left.\r\n");
    hosts.pop();
    until("the place is free", || {
        let mut later = machine.attach();
        later.send("SEND 'SERVED' TO <1>HOST_MESSAGE;");
        later.message() == "SERVED"
    });
    hosts.iter_mut().for_each(Host::synchronize);
}

#[test]
fn memory_goes_back_after_initialize() {
    let count = if is_long() { 20_000_000 } else { 2_000_000 };
    let mut machine = Machine::start(PS340, &[]);
    let folder = tempfile::tempdir().unwrap();
    let picture = format!("picture vector {} 64", folder.path().join("a.png").display());
    let mut host = machine.attach();
    let before = machine.resident_megabytes();
    for list in 0..count / 100_000 {
        let y = f64::from(list) / f64::from(count / 100_000) - 0.5;
        let vectors = format!("-.3,{y:.3} .3,{y:.3} ").repeat(50_000);
        host.send(format!("A{list} := VECTOR_LIST SEPARATE N = 2 {vectors}; DISPLAY A{list};"));
    }
    host.synchronize();
    // The list of strokes keeps them all; a picture alone would not.
    machine.operator_command("strokes 1");
    machine.operator_command(&picture);
    let full = machine.resident_megabytes();
    assert!(full > before + f64::from(count) * 30.0 / 1e6, "{before} MB, then {full} MB");
    host.send("INITIALIZE;");
    host.synchronize();
    machine.operator_command("frames 2");
    let after = machine.resident_megabytes();
    println!("{before:.0} MB before, {full:.0} MB with {count} vectors, {after:.0} MB after INITIALIZE");
    assert!(after < before + 50.0, "{before} MB before, {full} MB with the vectors, {after} MB after INITIALIZE");
}

fn peris(arguments: &[&str], ps340: &str, folder: &Path) -> Ended {
    run(PERIS, arguments, &[("PERIS_PS340", ps340)], folder, TIMEOUT)
}

#[test]
fn a_mute_partner_is_given_up_with_the_time_that_it_had() {
    let folder = tempfile::tempdir().unwrap();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("tcp:{}", listener.local_addr().unwrap());
    // It accepts, and keeps what it accepted until the test ends.
    std::thread::spawn(move || listener.incoming().collect::<Vec<_>>());
    for command in ["run", "show"] {
        let ended = peris(&[command, "primitives", "--to", &address, "--patience", "1"], PS340, folder.path());
        assert_eq!(ended.code, Some(4), "{}", ended.errors);
        let told = "did not answer within 1 s; waited for the end of what was sent";
        assert!(ended.errors.contains(told), "{}", ended.errors);
    }
}

#[test]
fn a_machine_that_stands_still_is_given_up() {
    let folder = tempfile::tempdir().unwrap();
    let machine = Machine::start(PS340, &[]);
    machine.signal(Signal::STOP);
    let address = format!("tcp:{}", machine.line);
    let ended = peris(&["run", "primitives", "--to", &address, "--patience", "1"], PS340, folder.path());
    assert_eq!(ended.code, Some(4), "{}", ended.errors);
    assert!(ended.errors.contains("did not answer within 1 s"), "{}", ended.errors);
}

#[test]
fn a_machine_of_our_own_that_does_not_get_ready_is_given_up_and_ended() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("mute");
    fs::write(&program, "#!/bin/sh\necho $$ > process\nexec sleep 1000\n").unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let ended = peris(&["demo", "--quick", "--patience", "1"], &program.display().to_string(), folder.path());
    assert_eq!(ended.code, Some(4), "{}", ended.errors);
    assert!(ended.errors.contains("it does not get ready within 1 s"), "{}", ended.errors);
    let process = fs::read_to_string(folder.path().join("process")).unwrap();
    assert!(!Path::new("/proc").join(process.trim()).exists(), "the program is still there");
}

#[test]
fn orders_that_take_long_end_when_the_machine_stands_still() {
    let folder = tempfile::tempdir().unwrap();
    // It gives the number of the machine's process.
    let program = folder.path().join("still");
    let script = format!("#!/bin/sh\necho $$ > process\nexec {PS340} \"$@\"\n");
    fs::write(&program, script).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let mut child = std::process::Command::new(PERIS)
        .args(["show", "primitives", "--patience", "1"])
        .env("PERIS_PS340", &program)
        .current_dir(folder.path())
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut orders = child.stdin.take().unwrap();
    // An operator command that takes longer than the timeout is no fault.
    writeln!(orders, "frames 75").unwrap();
    let mut said = std::io::BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    while !line.starts_with("ok") {
        line.clear();
        assert!(std::io::BufRead::read_line(&mut said, &mut line).unwrap() > 0, "it goes on");
    }
    let process = fs::read_to_string(folder.path().join("process")).unwrap().trim().parse::<i32>().unwrap();
    let process = rustix::process::Pid::from_raw(process).unwrap();
    rustix::process::kill_process(process, Signal::STOP).unwrap();
    writeln!(orders, "counters").unwrap();
    assert_eq!(tests::wait(&mut child), Some(4));
    let errors = std::io::read_to_string(child.stderr.take().unwrap()).unwrap();
    assert!(errors.contains("did not answer within 1 s"), "{errors}");
    assert!(
        !Path::new(&format!("/proc/{}", process.as_raw_nonzero())).exists(),
        "a machine that stands still is ended too"
    );
}
