//! Attacks on whoever runs a machine: through its lines, and through files that it is handed. The victim's files stay
//! as they are.

use std::{
    fs,
    io::{Read, Write},
    net::TcpStream,
    os::unix::{fs::PermissionsExt, fs::symlink, net::UnixListener, net::UnixStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};
use tests::{Ended, Host, TIMEOUT, run};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");
/// What the victim keeps.
const DOCUMENT: &str = "precious";

/// A user's folder: a document, and beside it the folder in which the machine works.
struct Home {
    folder: tempfile::TempDir,
}

impl Home {
    fn new() -> Home {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("document.png"), DOCUMENT).expect("written");
        fs::create_dir(folder.path().join("work")).expect("made");
        Home { folder }
    }

    fn work(&self) -> PathBuf {
        self.folder.path().join("work")
    }

    fn document(&self) -> PathBuf {
        self.folder.path().join("document.png")
    }

    fn assert_untouched(&self) {
        assert_eq!(fs::read_to_string(self.document()).expect("it is there"), DOCUMENT);
        let mut names: Vec<_> =
            fs::read_dir(self.folder.path()).expect("readable").map(|e| e.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["document.png", "work"]);
    }

    fn ps340(&self, arguments: &[&str]) -> Ended {
        run(PS340, arguments, &[], &self.work(), TIMEOUT)
    }
}

/// A machine with an operator's line of its own; killed when dropped.
struct Machine {
    child: Child,
    /// What it printed before it was ready, without `ready `.
    said: Vec<String>,
}

impl Machine {
    fn start(home: &Home, arguments: &[&str]) -> Machine {
        let mut child = Command::new(PS340)
            .args(arguments)
            .env_remove("PS340_TOKEN")
            .current_dir(home.work())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let out = std::io::BufReader::new(child.stdout.take().expect("piped"));
        let mut said = Vec::new();
        for line in std::io::BufRead::lines(out).map_while(Result::ok) {
            match line.strip_prefix("ready ") {
                Some(text) => said.push(text.to_owned()),
                None => return Machine { child, said },
            }
        }
        panic!("it does not get ready: {said:?}");
    }

    /// What it said of something.
    fn told(&self, what: &str) -> &str {
        let found =
            self.said.iter().find_map(|line| line.strip_prefix(what)).unwrap_or_else(|| panic!("{:?}", self.said));
        found.trim_start_matches("tcp:")
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a text, and returns what comes until the other side closes.
fn exchange(address: &str, text: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("it listens");
    stream.set_read_timeout(Some(TIMEOUT)).expect("a time limit");
    // The other side may have closed before all is sent.
    let _ = stream.write_all(text.as_bytes());
    let mut said = Vec::new();
    match stream.read_to_end(&mut said) {
        Err(error) if error.kind() == std::io::ErrorKind::ConnectionReset => {}
        read => drop(read.expect("it closes")),
    }
    String::from_utf8_lossy(&said).into_owned()
}

/// A request of a page in a browser, whose body is lines.
fn request(body: &str) -> String {
    format!("POST /;INITIALIZE; HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: {}\r\n\r\n{body}", body.len())
}

#[test]
fn a_page_in_a_browser_reaches_neither_host_line_nor_operator() {
    let home = Home::new();
    let machine = Machine::start(&home, &["--listen", "tcp:127.0.0.1:0", "--operator", "tcp:127.0.0.1:0"]);
    let (line, operator, token) = (machine.told("line "), machine.told("operator "), machine.told("token "));
    let mut host = Host::attach(line);
    host.send("KEPT := F:NOP; CONNECT KEPT<1>:<1>HOST_MESSAGE;");
    host.synchronize();
    let orders = format!("token {token}\r\npicture vector {}\r\nquit\r\n", home.document().display());
    assert_eq!(exchange(line, &request("INITIALIZE;\r\nDELETE KEPT;\r\n")), "");
    assert_eq!(exchange(operator, &request(&orders)), "");
    // What was there is there, and the machine serves.
    host.send("SEND 'STILL HERE' TO <1>KEPT;");
    assert_eq!(host.message(), "STILL HERE");
    home.assert_untouched();
}

#[test]
fn commands_that_look_like_requests_are_carried_out() {
    let home = Home::new();
    let machine = Machine::start(&home, &["--listen", "tcp:127.0.0.1:0"]);
    let text = "A := F:NOP; POST := F:NOP; X := F:NOP;\nCONNECT A<1>:<1>POST;\nCONNECT POST<1>:<1>HOST_MESSAGE;\nDELETE X;\n\
                GET := F:NOP;\nSEND 'GET / HTTP/1.1' TO <1>A;";
    for piece in [1, 2, 7, text.len()] {
        let mut host = Host::attach(machine.told("line "));
        for part in text.as_bytes().chunks(piece) {
            host.send(part);
        }
        assert_eq!(host.message(), "GET / HTTP/1.1", "in pieces of {piece}");
        host.send("INITIALIZE;");
        host.synchronize();
    }
}

#[test]
fn orders_over_tcp_need_the_token() {
    let home = Home::new();
    let machine = Machine::start(&home, &["--listen", "tcp:127.0.0.1:0", "--operator", "tcp:127.0.0.1:0"]);
    let operator = machine.told("operator ");
    for text in ["picture vector a.png\nquit\n", "token 00000000000000000000000000000000\nquit\n"] {
        let said = exchange(operator, text);
        assert!(said.starts_with("error the first line must be 'token TOKEN'") && said.lines().count() == 1, "{said}");
    }
    let said = exchange(operator, &format!("token {}\npicture vector a.png 16\nquit\n", machine.told("token ")));
    assert_eq!(said, "ok\nok a.png 16x16\nok quit\n");
    assert!(home.work().join("a.png").is_file());
}

#[test]
fn strangers_at_the_operators_port_do_not_keep_its_owner_out() {
    let home = Home::new();
    let machine = Machine::start(&home, &["--listen", "tcp:127.0.0.1:0", "--operator", "tcp:127.0.0.1:0"]);
    let (operator, token) = (machine.told("operator "), machine.told("token "));
    let strangers: Vec<_> = (0..16).map(|_| TcpStream::connect(operator).expect("it listens")).collect();
    assert_eq!(exchange(operator, &format!("token {token}\nquit\n")), "ok\nok quit\n");
    drop(strangers);
}

#[test]
fn the_socket_of_the_operator_is_its_owners() {
    let home = Home::new();
    let _machine = Machine::start(&home, &["--listen", "unix:line", "--operator", "unix:operator"]);
    let mode = fs::metadata(home.work().join("operator")).expect("it is there").permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    let mut stream = UnixStream::connect(home.work().join("operator")).expect("it listens");
    stream.write_all(b"quit\n").expect("sent");
    let mut said = String::new();
    stream.read_to_string(&mut said).expect("answered");
    assert_eq!(said, "ok quit\n");
}

#[test]
fn other_computers_reach_it_only_where_that_was_asked_for() {
    let home = Home::new();
    for arguments in [
        &["--listen", "tcp:0.0.0.0:0"][..],
        &["--listen", "parallel:0.0.0.0:0"],
        &["--listen", "tcp:127.0.0.1:0", "--operator", "tcp:0.0.0.0:0"],
    ] {
        let ended = home.ps340(arguments);
        assert_eq!(ended.code, Some(1), "{}", ended.errors);
        assert!(ended.errors.contains("other computers could reach it; --public allows that"), "{}", ended.errors);
    }
    Machine::start(&home, &["--public", "--listen", "tcp:0.0.0.0:0"]);
}

#[test]
fn a_capture_uses_devices_and_does_not_write_or_end_the_machine() {
    let home = Home::new();
    fs::write(home.work().join("given.cap"), capture(&home.document())).expect("written");
    let ended = home.ps340(&["--listen", "file:given.cap", "--operator", "none", "--clock", "virtual"]);
    assert_eq!(ended.code, Some(0), "{}", ended.errors);
    assert_eq!(ended.errors.matches("of a capture is not carried out").count(), 3, "{}", ended.errors);
    home.assert_untouched();
    let listed = home.ps340(&["lint", "given.cap"]);
    assert_eq!(listed.out.matches("with --orders only").count(), 3, "{}", listed.out);
    assert_eq!(listed.out.lines().count(), 3, "{}", listed.out);
    // Where it was asked for, it may, below the folder.
    let ended = home.ps340(&["--listen", "file:given.cap", "--orders", "--operator", "none", "--clock", "virtual"]);
    assert!(ended.errors.contains("this is not below"), "{}", ended.errors);
    home.assert_untouched();
}

/// A capture in which an operator does more than turn a dial.
fn capture(document: &Path) -> String {
    use protocol::capture::{Event, HEADER, Record};
    let orders = [
        "dial 1 0.5".into(),
        format!("picture vector {}", document.display()),
        format!("graph network {}", document.display()),
        "quit".into(),
    ];
    let mut text = format!("{HEADER}\n");
    for (micros, order) in (0..).zip(orders) {
        Record { micros, line: 0, event: Event::OperatorCommand(order) }.write(&mut text);
    }
    text
}

#[test]
fn a_play_file_writes_only_where_that_was_asked_for_and_below_the_folder() {
    let home = Home::new();
    let document = home.document();
    symlink("../document.png", home.work().join("link.png")).expect("linked");
    symlink("..", home.work().join("up")).expect("linked");
    let names = ["../document.png", "link.png", "up/document.png", document.to_str().expect("text")];
    for name in names {
        fs::write(home.work().join("given.play"), format!("@ picture vector {name}\n")).expect("written");
        let refused = home.ps340(&["play", "given.play"]);
        assert_eq!(refused.code, Some(1), "{}", refused.errors);
        assert!(refused.errors.contains("without --orders"), "{}", refused.errors);
        let outside = home.ps340(&["play", "given.play", "--orders"]);
        assert_eq!(outside.code, Some(1), "{name}: {}", outside.errors);
        let listed = home.ps340(&["lint", "given.play"]);
        assert!(listed.out.contains("given.play:1:1: warning: 'picture vector"), "{}", listed.out);
        home.assert_untouched();
    }
    fs::write(home.work().join("given.play"), "@ dial 1 0.5\n@ picture vector a.png 16\n").expect("written");
    let played = home.ps340(&["play", "given.play", "--orders"]);
    assert_eq!(played.code, Some(0), "{}", played.errors);
    assert!(home.work().join("a.png").is_file());
}

#[test]
fn the_path_of_a_socket_that_is_something_else_is_left_alone() {
    let home = Home::new();
    let address = format!("unix:{}", home.document().display());
    for arguments in [&["--listen", &address][..], &["--listen", "tcp:127.0.0.1:0", "--operator", &address]] {
        let ended = home.ps340(arguments);
        assert_eq!(ended.code, Some(1), "{}", ended.errors);
        assert!(ended.errors.contains("a file that is no socket has this name, and stays"), "{}", ended.errors);
        home.assert_untouched();
    }
    // A socket that is answered stays, one that nobody answers gives way.
    let path = home.work().join("socket");
    let listener = UnixListener::bind(&path).expect("bound");
    let ended = home.ps340(&["--listen", "unix:socket"]);
    assert!(ended.code == Some(1) && ended.errors.contains("another process listens there"), "{}", ended.errors);
    drop(listener);
    let begin = Instant::now();
    let machine = Machine::start(&home, &["--listen", "unix:socket"]);
    assert!(begin.elapsed() < Duration::from_secs(30) && UnixStream::connect(&path).is_ok());
    drop(machine);
}
