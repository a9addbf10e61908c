//! The lines of the process `ps340`, with real terminals, sockets, files and standard streams.

use protocol::capture::{CaptureReader, Event};
use std::{
    fs::{self, File, OpenOptions},
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    sync::mpsc,
    time::{Duration, Instant},
};

const PS340: &str = env!("CARGO_BIN_EXE_ps340");
/// How long any single answer may take.
const PATIENCE: Duration = Duration::from_secs(30);

/// A network that answers: what is sent to `<1>E` comes back.
const ECHO: &str = "E := F:NOP; CONNECT E<1>:<1>HOST_MESSAGE;\n";

/// A process that is killed when dropped.
struct Process {
    child: Child,
    /// What it printed before it was ready, without `ready line `.
    lines: Vec<String>,
}

impl Process {
    fn start(arguments: &[&str]) -> Process {
        let mut command = Command::new(PS340);
        command.args(["--operator", "none"]).args(arguments);
        let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut process = Process { child: child.expect("it starts"), lines: Vec::new() };
        let out = process.child.stdout.take().expect("it is piped");
        for line in BufReader::new(out).lines().map_while(Result::ok) {
            match line.strip_prefix("ready line ") {
                Some(address) => process.lines.push(address.to_string()),
                None if line == "ready" => return process,
                None => {}
            }
        }
        panic!("it does not get ready: {:?}", process.child.wait());
    }

    /// The path or address of a line, without kind and conditions.
    fn place(&self, index: usize) -> &str {
        let (_, rest) = self.lines[index].split_once(':').expect("an address has a kind");
        rest.split(',').next().unwrap_or(rest)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Waits for something that a thread does.
fn within_patience<T: Send + 'static>(what: &str, action: impl FnOnce() -> T + Send + 'static) -> T {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || sender.send(action()));
    receiver.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("{what} takes too long"))
}

/// Waits until a capture records so many times that a host has left.
fn wait_until_left(capture: &str, times: usize) {
    let begin = Instant::now();
    let left = || {
        fs::read_to_string(format!("{capture}.part"))
            .unwrap_or_default()
            .lines()
            .filter(|line| line.ends_with(" -"))
            .count()
    };
    while left() < times {
        assert!(begin.elapsed() < PATIENCE, "{} of {times} hosts have left", left());
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn open(path: &str) -> File {
    OpenOptions::new().read(true).write(true).open(path).expect("the terminal can be opened")
}

/// Reads so many bytes.
fn read(from: &mut impl Read, count: usize, what: &str) -> Vec<u8> {
    let mut bytes = vec![0; count];
    from.read_exact(&mut bytes).unwrap_or_else(|error| panic!("{what}: {error}"));
    bytes
}

/// Sends commands and reads the message that they make.
fn ask<S: Read + Write + Send + 'static>(mut line: S, commands: &str, answer: &str) -> S {
    let (commands, answer) = (commands.to_string(), format!("{answer}\r\n"));
    let what = commands.clone();
    within_patience(&what, move || {
        line.write_all(commands.as_bytes()).expect("the line takes bytes");
        let found = read(&mut line, answer.len(), &commands);
        assert_eq!(String::from_utf8_lossy(&found), answer);
        line
    })
}

#[test]
fn a_pseudo_terminal_survives_that_its_host_goes_and_comes() {
    let folder = tempfile::tempdir().unwrap();
    let capture = folder.path().join("capture").display().to_string();
    let process = Process::start(&["--listen", "pty:", "--capture", &capture]);
    let path = process.place(0).to_string();
    assert!(path.starts_with("/dev/"), "{path}");
    let host = ask(open(&path), &format!("{ECHO} SEND 'first' TO <1>E;"), "first");
    drop(host);
    for round in 0..3 {
        // Half a command of a host that goes is no part of what the next one sends.
        let word = format!("round {round}");
        wait_until_left(&capture, round + 1);
        let mut host = ask(open(&path), &format!("SEND '{word}' TO <1>E;"), &word);
        host.write_all(b"SEND 'half").unwrap();
    }
    // All bytes pass as they are, in both directions.
    let odd = b"\x01\x03\x04\x11\x13\x1a\x7f\r\n\xff\\".to_vec();
    wait_until_left(&capture, 4);
    let mut host = open(&path);
    host.write_all(&[b"SEND '", &odd[..], b"' TO <1>E;"].concat()).unwrap();
    let found = within_patience("the echo", move || read(&mut host, odd.len() + 2, "the echo"));
    assert_eq!(found, b"\x01\x03\x04\x11\x13\x1a\x7f\r\n\xff\\\r\n");
}

#[test]
fn a_serial_device_is_a_line() {
    // The other end of the cable is a pseudo-terminal that this test holds.
    use std::os::{fd::OwnedFd, unix::ffi::OsStrExt};
    let near: OwnedFd = rustix::pty::openpt(rustix::pty::OpenptFlags::RDWR | rustix::pty::OpenptFlags::NOCTTY).unwrap();
    rustix::pty::grantpt(&near).unwrap();
    rustix::pty::unlockpt(&near).unwrap();
    let name = rustix::pty::ptsname(&near, Vec::new()).unwrap();
    let path = Path::new(std::ffi::OsStr::from_bytes(name.as_bytes())).display().to_string();
    let process = Process::start(&["--listen", &format!("serial:{path},19200,8N1")]);
    assert_eq!(process.lines, [format!("serial:{path},19200,8N1")]);
    let settings = rustix::termios::tcgetattr(&near).unwrap();
    assert_eq!(settings.output_speed(), 19_200);
    assert!(!settings.local_modes.contains(rustix::termios::LocalModes::ECHO));
    let host = ask(File::from(near), &format!("{ECHO} SEND 'by wire' TO <1>E;"), "by wire");
    drop(ask(host, "SEND 'again' TO <1>E;", "again"));
}

#[test]
fn hosts_on_several_lines_have_their_own_streams() {
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("line").display().to_string();
    let unix = format!("unix:{socket}");
    let process = Process::start(&["--listen", "tcp:127.0.0.1:0", "--listen", &unix, "--listen", "pty:,speed=1000000"]);
    assert_eq!(process.lines.len(), 3);
    let tcp = TcpStream::connect(process.place(0)).unwrap();
    tcp.set_nodelay(true).unwrap();
    let tcp = ask(tcp, &format!("{ECHO} SEND 'tcp' TO <1>E;"), "tcp");
    let mut terminal = open(process.place(2));
    // The terminal is attached when its command has been carried out; messages go to all hosts.
    terminal.write_all(b"SEND 'pty' TO <1>E; A := BEGIN_STRUCTURE").unwrap();
    let mut tcp = within_patience("the message", move || {
        let mut tcp = tcp;
        assert_eq!(read(&mut tcp, 5, "the message"), b"pty\r\n");
        tcp
    });
    // Each line is cut into its own packets and has its own open structures.
    tcp.write_all(b"\x160SEND 'ta").unwrap();
    let stream = std::os::unix::net::UnixStream::connect(&socket).unwrap();
    let unix = ask(stream, "SEND 'unix' TO <1>E;", "unix");
    tcp.write_all(b"il' TO <1>E;\x16\x16").unwrap();
    let found = within_patience("both messages", move || {
        let mut unix = unix;
        let found = read(&mut unix, 6, "the message");
        (found, read(&mut terminal, 17, "all messages"), read(&mut tcp, 12, "all messages"))
    });
    assert_eq!(found, (b"tail\r\n".into(), b"pty\r\nunix\r\ntail\r\n".into(), b"unix\r\ntail\r\n".into()));
}

#[test]
fn a_slow_terminal_is_slow() {
    let process = Process::start(&["--listen", "pty:,speed=4800", "--listen", "tcp:127.0.0.1:0"]);
    let host = ask(open(process.place(0)), &format!("{ECHO} SEND 'ready' TO <1>E;"), "ready");
    let begin = Instant::now();
    // 150 characters there and 152 back: 0.31 seconds each way, and the way back begins at the end of the way there.
    let text = "x".repeat(150 - 14);
    ask(host, &format!("SEND '{text}' TO <1>E;"), &text);
    let took = begin.elapsed().as_secs_f64();
    assert!((0.55..10.0).contains(&took), "{took} s");
}

#[test]
fn a_capture_is_what_passed_and_plays_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (first, second) = (file("first"), file("second"));
    let process = Process::start(&["--listen", "pty:", "--capture", &first]);
    let host = ask(open(process.place(0)), &format!("{ECHO} SEND 'one' TO <1>E;"), "one");
    drop(ask(host, "\x160SEND 'two' TO <1>E;\x16\x16", "two"));
    wait_until_left(&first, 1);
    drop(process);
    // The process was killed: what it captured is whole up to there, but not called so.
    assert!(!fs::exists(&first).unwrap());
    fs::rename(format!("{first}.part"), &first).unwrap();
    let told = |path: &str| {
        let mut reader = CaptureReader::default();
        reader.push(&fs::read(path).unwrap());
        let (mut from, mut to, mut closed) = (Vec::new(), Vec::new(), 0);
        for record in reader {
            match record.expect("it is well formed").event {
                Event::FromHost(bytes) => from.extend(bytes),
                Event::ToHost(bytes) => to.extend(bytes),
                Event::Open(peer) => assert!(peer.starts_with("pty:") || peer.starts_with("file:"), "{peer}"),
                Event::Close => closed += 1,
                Event::OperatorCommand(_) => {}
            }
        }
        (String::from_utf8(from).unwrap(), String::from_utf8(to).unwrap(), closed)
    };
    let captured = told(&first);
    let said = format!("{ECHO} SEND 'one' TO <1>E;\x160SEND 'two' TO <1>E;\x16\x16");
    assert_eq!(captured, (said.clone(), "one\r\ntwo\r\n".into(), 1));
    // A machine whose lines are files ends with them.
    let mut process = Process::start(&["--listen", &format!("file:{first},pace=captured"), "--capture", &second]);
    let status = within_patience("the end", move || process.child.wait().unwrap());
    assert!(status.success());
    assert_eq!(told(&second), (said, "one\r\ntwo\r\n".into(), 1), "it answers as before");
    let before = fs::read(&first).unwrap();
    let both = Command::new(PS340).args(["--listen", &format!("file:{first}"), "--capture", &first]).output().unwrap();
    assert_eq!((both.status.code(), fs::read(&first).unwrap() == before), (Some(1), true));
}

/// The process with a host on its standard streams, at its end.
fn with_stdio(arguments: &[&str], input: &str) -> (Option<i32>, String) {
    let mut command = Command::new(PS340);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    // A process that refuses its arguments does not read.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = within_patience("the end", move || child.wait_with_output().unwrap());
    (output.status.code(), String::from_utf8(output.stdout).unwrap())
}

#[test]
fn a_host_on_the_standard_streams_has_them_alone() {
    let input = format!("{ECHO} SEND 'hello' TO <1>E;");
    assert_eq!(with_stdio(&["--listen", "stdio:"], &input), (Some(0), "hello\r\n".into()));
    assert_eq!(with_stdio(&["--listen", "stdio:", "--operator", "stdio"], &input), (Some(2), String::new()));
}

#[test]
fn a_plain_file_is_sent_as_a_host_would() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("commands");
    fs::write(&path, format!("{ECHO} SEND 'from a file' TO <1>E;")).unwrap();
    let capture = folder.path().join("capture");
    let file = format!("file:{},speed=9600", path.display());
    let mut process = Process::start(&["--listen", &file, "--capture", &capture.display().to_string()]);
    assert!(within_patience("the end", move || process.child.wait().unwrap()).success());
    let captured = fs::read_to_string(capture).unwrap();
    assert!(captured.contains(" < from a file\\r\\n\n"), "{captured}");
}

#[test]
fn the_parallel_interface_listens() {
    use protocol::parallel::{ParallelFrame, ParallelFrameReader, write_block, write_word};
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (first, second) = (file("first"), file("second"));
    let process = Process::start(&["--listen", "parallel:127.0.0.1:0", "--capture", &first]);
    let (_, address) = process.lines[0].split_once(':').unwrap();
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_nodelay(true).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut reader = ParallelFrameReader::default();
    let mut next = |stream: &mut TcpStream| loop {
        if let Some(frame) = reader.next() {
            return frame;
        }
        let mut buffer = [0; 512];
        let count = stream.read(&mut buffer).expect("the machine answers");
        assert!(count > 0);
        reader.push(&buffer[..count]);
    };
    let mut words = |stream: &mut TcpStream, said: &[u16], answer: &[ParallelFrame]| {
        let mut bytes = Vec::new();
        said.iter().for_each(|word| write_word(*word, &mut bytes));
        stream.write_all(&bytes).unwrap();
        answer.iter().for_each(|frame| assert_eq!(next(stream), *frame));
    };
    let word = |word: u16| ParallelFrame::Word(word);
    words(&mut stream, &[], &[word(0x3000)]);
    words(&mut stream, &[0xe000, 0xc000], &[word(0xe000), word(0xc000)]);
    let text = format!("{ECHO} SEND 'by words' TO <1>E;");
    words(&mut stream, &[text.len() as u16, 0], &[]);
    let mut block = Vec::new();
    write_block(text.as_bytes(), &mut block);
    stream.write_all(&block).unwrap();
    words(&mut stream, &[], &[word(0xca00)]);
    words(&mut stream, &[0x5000], &[word(0x5000)]);
    let message = ParallelFrame::Block(b"by words".into());
    words(&mut stream, &[80, 0], &[word(0x5100), word(8), message, word(0x5a00)]);
    // The words play again.
    drop(stream);
    wait_until_left(&first, 1);
    drop(process);
    let mut process = Process::start(&["--listen", &format!("file:{first}.part"), "--capture", &second]);
    assert!(within_patience("the end", move || process.child.wait().unwrap()).success());
    let captured = fs::read_to_string(second).unwrap();
    assert!(captured.contains("D\\x00\\x08by wordsWZ\\x00\n"), "{captured}");
}

#[test]
fn what_cannot_be_opened_is_told() {
    let output = Command::new(PS340).args(["--listen", "serial:/nowhere,9600"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("cannot listen on serial:/nowhere,9600,8N1: "), "{told}");
}
