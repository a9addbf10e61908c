//! The PS 340 in its window, worked by real events of the X window system: an X server without a screen, and xdotool.
//!
//! Needs Xvfb, xdotool and a software Vulkan or OpenGL (`.ci/run` installs them).

use crate::TIMEOUT;
use std::{
    collections::HashMap,
    io::{BufRead, BufReader, Write},
    net::TcpStream,
    process::{Child, ChildStdout, Command, Stdio},
    sync::{
        Arc, Mutex,
        atomic::{AtomicU16, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

/// A process that ends with the test.
#[derive(Debug)]
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The displays that tests may take.
const FIRST_DISPLAY: u16 = 90;
const LAST_DISPLAY: u16 = 190;
/// The first display that the next test tries.
static NEXT_DISPLAY: AtomicU16 = AtomicU16::new(FIRST_DISPLAY);

/// An X server of its own.
#[derive(Debug)]
struct Display {
    name: String,
    _server: Running,
}

impl Display {
    /// None where there is no Xvfb or no xdotool.
    fn open() -> Option<Display> {
        let has = |program: &str| Command::new(program).arg("-version").output().is_ok();
        if !has("Xvfb") || !has("xdotool") {
            assert!(std::env::var_os("CI").is_none(), "Xvfb and xdotool must be installed");
            eprintln!("the window is not tested: Xvfb or xdotool is not installed");
            return None;
        }
        // Tests run beside each other. A server that looks for a free number by itself may take away the socket of
        // one that is only just starting; a server that is given its number fails if another one has locked it.
        // A server that says that it is ready may still turn clients away: it is asked, and never starts over.
        for number in NEXT_DISPLAY.fetch_add(1, Ordering::Relaxed)..=LAST_DISPLAY {
            let mut server = Command::new("Xvfb");
            server.args([
                &format!(":{number}"),
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1280x860x24",
                "-nolisten",
                "tcp",
                "-noreset",
            ]);
            let mut child = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("Xvfb starts");
            let out = child.stdout.take().expect("piped");
            let display = Display { name: format!(":{number}"), _server: Running(child) };
            let mut line = String::new();
            BufReader::new(out).read_line(&mut line).expect("what Xvfb says is text");
            if line.trim() == number.to_string() && display.answers() {
                return Some(display);
            }
        }
        panic!("no display from :{FIRST_DISPLAY} to :{LAST_DISPLAY} is free");
    }

    /// Whether clients reach the server.
    fn answers(&self) -> bool {
        self.command("xdotool").arg("getdisplaygeometry").output().expect("xdotool runs").status.success()
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY");
        command
    }

    /// Does something as a person would; a moment passes after it.
    fn act(&self, arguments: &str) {
        let done = self.command("xdotool").args(arguments.split(' ')).status().expect("xdotool runs");
        assert!(done.success(), "xdotool {arguments}");
        std::thread::sleep(Duration::from_millis(300));
    }
}

/// The windowed machine, with an operator and, if a test wants one, a host.
#[derive(Debug)]
pub struct WindowedMachine {
    display: Display,
    positions: Arc<Mutex<HashMap<String, [i32; 2]>>>,
    operator: BufReader<TcpStream>,
    host: Option<TcpStream>,
    /// Where hosts attach, as `HOST:PORT`.
    pub line: String,
    /// The number that the X server gave the window.
    window: String,
    _machine: Running,
}

/// Steps of a drag.
const DRAG_STEPS: i32 = 12;
/// What opens the operator's line.
const TOKEN: &str = "window";

impl WindowedMachine {
    /// Opens the window of a program; none where Xvfb or xdotool is not installed and `CI` is not set.
    ///
    /// # Panics
    /// If there is no window within [`TIMEOUT`], or a tool is missing where `CI` is set.
    pub fn open(program: &str) -> Option<WindowedMachine> {
        let display = Display::open()?;
        let mut machine = display.command(program);
        machine.args(["--window", "--listen", "tcp:127.0.0.1:0", "--operator", "tcp:127.0.0.1:0", "--files", "/"]);
        machine.env("PS340_TOKEN", TOKEN).env("PS340_LOG", "ps340=debug").stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = machine.spawn().expect("ps340 starts");
        let (out, log) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
        let machine = Running(child);
        let places = Arc::new(Mutex::new(HashMap::new()));
        let noted = places.clone();
        std::thread::spawn(move || {
            for line in BufReader::new(log).lines().map_while(Result::ok) {
                match parse_position(&line) {
                    Some((device, at)) => drop(noted.lock().unwrap().insert(device, at)),
                    None => eprintln!("{line}"),
                }
            }
        });
        let [line, operator] = addresses(out);
        let connect = |address: &str| {
            let stream = TcpStream::connect(address).expect("it listens");
            stream.set_read_timeout(Some(TIMEOUT)).expect("a socket has a timeout");
            stream
        };
        let operator = BufReader::new(connect(&operator));
        let mut desk = WindowedMachine {
            host: None,
            line,
            display,
            positions: places,
            operator,
            window: String::new(),
            _machine: machine,
        };
        assert_eq!(desk.operator_command(&format!("token {TOKEN}")), "ok");
        desk.position_of("vector screen");
        // Without a window manager nobody gives the window the keyboard; it is there a moment after its first picture.
        let search = ["search", "--onlyvisible", "--limit", "1", "--name", "^PS 340$"];
        let begin = Instant::now();
        while desk.window.is_empty() {
            assert!(begin.elapsed() < TIMEOUT, "the window is not there");
            std::thread::sleep(Duration::from_millis(100));
            let found = desk.display.command("xdotool").args(search).output().expect("xdotool runs");
            desk.window = String::from_utf8_lossy(&found.stdout).trim().to_owned();
        }
        desk.display.act(&format!("windowfocus --sync {}", desk.window));
        Some(desk)
    }

    /// Does something as a person would, in the words of xdotool; a moment passes after it.
    pub fn act(&self, arguments: &str) {
        self.display.act(arguments);
    }

    /// Gives the window a width and a height in pixels.
    pub fn resize(&self, size: &str) {
        self.display.act(&format!("windowsize {} {size}", self.window));
    }

    /// Drags from a device by so many pixels to the right and down, in steps.
    pub fn drag(&self, device: &str, [right, down]: [i32; 2]) {
        let [x, y] = self.position_of(device);
        self.act(&format!("mousemove {x} {y}"));
        self.act("mousedown 1");
        for step in 1..=DRAG_STEPS {
            self.act(&format!("mousemove {} {}", x + right * step / DRAG_STEPS, y + down * step / DRAG_STEPS));
        }
        self.act("mouseup 1");
    }

    /// Chooses a view in the menu of those that look into the machine.
    pub fn inspect(&self, view: &str) {
        self.click("menu Inspect");
        self.click(&format!("view {view}"));
    }

    /// Where a device is, once it is shown and has not moved for a while.
    ///
    /// # Panics
    /// If that does not come.
    pub fn position_of(&self, device: &str) -> [i32; 2] {
        let begin = Instant::now();
        let mut before = None;
        loop {
            let now = self.positions.lock().unwrap().get(device).copied();
            match now {
                Some(at) if now == before => return at,
                _ => before = now,
            }
            assert!(begin.elapsed() < TIMEOUT, "the {device} is not shown");
            std::thread::sleep(Duration::from_millis(500));
        }
    }

    /// Clicks a device.
    pub fn click(&self, device: &str) {
        let [x, y] = self.position_of(device);
        self.display.act(&format!("mousemove {x} {y}"));
        self.display.act("click 1");
    }

    /// Gives an operator command, and returns the reply.
    pub fn operator_command(&mut self, order: &str) -> String {
        writeln!(self.operator.get_mut(), "{order}").expect("the operator's line is open");
        let mut reply = String::new();
        self.operator.read_line(&mut reply).expect("a reply comes");
        reply.trim_end().to_owned()
    }

    /// Sends the machine something as a host does.
    pub fn send(&mut self, commands: &str) {
        let line = &self.line;
        let host = self.host.get_or_insert_with(|| TcpStream::connect(line).expect("the machine listens"));
        host.write_all(commands.as_bytes()).expect("the host's line is open");
    }

    /// The host leaves.
    pub fn leave(&mut self) {
        self.host = None;
    }

    /// Waits until a reply to an operator command holds a text.
    ///
    /// # Panics
    /// If it does not come to that.
    pub fn expect(&mut self, order: &str, text: &str) {
        let begin = Instant::now();
        let mut reply = self.operator_command(order);
        while !reply.contains(text) {
            assert!(begin.elapsed() < TIMEOUT, "'{order}' gives '{reply}' without '{text}'");
            std::thread::sleep(Duration::from_millis(50));
            reply = self.operator_command(order);
        }
    }
}

/// The device and its position that a line of the log gives.
fn parse_position(line: &str) -> Option<(String, [i32; 2])> {
    let (device, at) = line.trim().strip_prefix("DEBUG ")?.split_once(" at ")?;
    let (x, y) = at.split_once(' ')?;
    Some((device.to_owned(), [x.parse().ok()?, y.parse().ok()?]))
}

/// The addresses of line and operator, once the machine has printed them.
fn addresses(out: ChildStdout) -> [String; 2] {
    let (sender, lines) = mpsc::channel();
    std::thread::spawn(move || {
        BufReader::new(out).lines().map_while(Result::ok).for_each(|line| drop(sender.send(line)));
    });
    let [mut line, mut operator] = [String::new(), String::new()];
    while line.is_empty() || operator.is_empty() {
        let said = lines.recv_timeout(TIMEOUT).expect("the machine tells its addresses");
        if let Some(address) = said.strip_prefix("ready line tcp:") {
            line = address.to_owned();
        } else if let Some(address) = said.strip_prefix("ready operator tcp:") {
            operator = address.to_owned();
        }
    }
    [line, operator]
}
