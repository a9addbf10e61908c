//! The window, worked by real events of the X window system: an X server without a screen, and xdotool.
//!
//! Needs Xvfb, xdotool and a software Vulkan or OpenGL (`.ci/run` installs them). Where they are not installed the test
//! says so and does nothing; where `CI` is set it fails.

#![cfg(all(feature = "window", target_os = "linux"))]

use std::{
    collections::HashMap,
    io::{BufRead, BufReader, Write},
    net::TcpStream,
    process::{Child, ChildStdout, Command, Stdio},
    sync::{Arc, Mutex, mpsc},
    time::{Duration, Instant},
};

/// How long anything may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// A process that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// An X server of its own.
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
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", "1280x860x24", "-nolisten", "tcp"]);
        let mut child = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("Xvfb starts");
        let out = child.stdout.take().expect("piped");
        let mut line = String::new();
        BufReader::new(out).read_line(&mut line).expect("Xvfb says its number");
        Some(Display { name: format!(":{}", line.trim()), _server: Running(child) })
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

/// The machine in its window, with an operator and a host.
struct Desk {
    display: Display,
    places: Arc<Mutex<HashMap<String, [i32; 2]>>>,
    operator: BufReader<TcpStream>,
    host: TcpStream,
    /// The number that the X server gave the window.
    window: String,
    _machine: Running,
}

/// What opens the operator's line.
const TOKEN: &str = "window";

impl Desk {
    fn open() -> Option<Desk> {
        let display = Display::open()?;
        let mut machine = display.command(env!("CARGO_BIN_EXE_ps340"));
        machine.args(["--window", "--listen", "tcp:127.0.0.1:0", "--operator", "tcp:127.0.0.1:0"]);
        machine.env("PS340_TOKEN", TOKEN).env("PS340_LOG", "ps340=debug").stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = machine.spawn().expect("ps340 starts");
        let (out, log) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
        let machine = Running(child);
        let places = Arc::new(Mutex::new(HashMap::new()));
        let noted = places.clone();
        std::thread::spawn(move || {
            for line in BufReader::new(log).lines().map_while(Result::ok) {
                match place(&line) {
                    Some((device, at)) => drop(noted.lock().unwrap().insert(device, at)),
                    None => eprintln!("{line}"),
                }
            }
        });
        let [line, operator] = addresses(out);
        let connect = |address: &str| {
            let stream = TcpStream::connect(address).expect("it listens");
            stream.set_read_timeout(Some(PATIENCE)).expect("a socket has a timeout");
            stream
        };
        let operator = BufReader::new(connect(&operator));
        let mut desk =
            Desk { host: connect(&line), display, places, operator, window: String::new(), _machine: machine };
        assert_eq!(desk.order(&format!("token {TOKEN}")), "ok");
        desk.place("vector screen");
        // Without a window manager nobody gives the window the keyboard; it is there a moment after its first picture.
        let search = ["search", "--onlyvisible", "--limit", "1", "--name", "^PS 340$"];
        let begin = Instant::now();
        while desk.window.is_empty() {
            assert!(begin.elapsed() < PATIENCE, "the window is not there");
            std::thread::sleep(Duration::from_millis(100));
            let found = desk.display.command("xdotool").args(search).output().expect("xdotool runs");
            desk.window = String::from_utf8_lossy(&found.stdout).trim().to_owned();
        }
        desk.display.act(&format!("windowfocus --sync {}", desk.window));
        Some(desk)
    }

    /// Where a device is, once it is shown and has not moved for a while.
    fn place(&self, device: &str) -> [i32; 2] {
        let begin = Instant::now();
        let mut before = None;
        loop {
            let now = self.places.lock().unwrap().get(device).copied();
            match now {
                Some(at) if now == before => return at,
                _ => before = now,
            }
            assert!(begin.elapsed() < PATIENCE, "the {device} is not shown");
            std::thread::sleep(Duration::from_millis(500));
        }
    }

    fn click(&self, device: &str) {
        let [x, y] = self.place(device);
        self.display.act(&format!("mousemove {x} {y}"));
        self.display.act("click 1");
    }

    fn order(&mut self, order: &str) -> String {
        writeln!(self.operator.get_mut(), "{order}").expect("the operator's line is open");
        let mut reply = String::new();
        self.operator.read_line(&mut reply).expect("a reply comes");
        reply.trim_end().to_owned()
    }

    fn tell(&mut self, commands: &str) {
        self.host.write_all(commands.as_bytes()).expect("the host's line is open");
    }

    /// Waits until a reply to an order holds a text.
    fn expect(&mut self, order: &str, text: &str) {
        let begin = Instant::now();
        let mut reply = self.order(order);
        while !reply.contains(text) {
            assert!(begin.elapsed() < PATIENCE, "'{order}' gives '{reply}' without '{text}'");
            std::thread::sleep(Duration::from_millis(50));
            reply = self.order(order);
        }
    }
}

/// The device and its place that a line of the log tells.
fn place(line: &str) -> Option<(String, [i32; 2])> {
    let (device, at) = line.trim().strip_prefix("DEBUG ")?.split_once(" at ")?;
    let (x, y) = at.split_once(' ')?;
    Some((device.to_owned(), [x.parse().ok()?, y.parse().ok()?]))
}

/// The addresses of line and operator, once the machine has told them.
fn addresses(out: ChildStdout) -> [String; 2] {
    let (sender, lines) = mpsc::channel();
    std::thread::spawn(move || {
        BufReader::new(out).lines().map_while(Result::ok).for_each(|line| drop(sender.send(line)));
    });
    let [mut line, mut operator] = [String::new(), String::new()];
    while line.is_empty() || operator.is_empty() {
        let said = lines.recv_timeout(PATIENCE).expect("the machine tells its addresses");
        if let Some(address) = said.strip_prefix("ready line tcp:") {
            line = address.to_owned();
        } else if let Some(address) = said.strip_prefix("ready operator tcp:") {
            operator = address.to_owned();
        }
    }
    [line, operator]
}

#[test]
fn dials_keys_puck_and_keyboard_reach_the_machine() {
    let Some(mut desk) = Desk::open() else { return };

    // A dial that is dragged by 120 points to the right makes half a turn.
    desk.tell(
        "SUM := F:ACCUMULATE; SEND 0 TO <2>SUM; SEND 0 TO <3>SUM; SEND 1 TO <4>SUM; SEND 9 TO <5>SUM; \
               SEND -9 TO <6>SUM; CONNECT DIALS<1>:<1>SUM; CONNECT SUM<1>:<1>TEXT; TEXT := F:PRINT; \
               CONNECT TEXT<1>:<1>HOST_MESSAGE;\n",
    );
    desk.expect("show TEXT", "PRINT");
    let [x, y] = desk.place("dial 1");
    desk.display.act(&format!("mousemove {x} {y}"));
    desk.display.act("mousedown 1");
    for step in 1..=12 {
        desk.display.act(&format!("mousemove {} {y}", x + 10 * step));
    }
    desk.display.act("mouseup 1");
    let begin = Instant::now();
    let mut turned = 0.0_f64;
    while (turned - 0.5).abs() > 1e-3 {
        assert!(begin.elapsed() < PATIENCE, "the dial was turned by {turned}");
        let reply = desk.order("message 60");
        turned = reply.strip_prefix("ok ").and_then(|text| text.trim().parse().ok()).unwrap_or(turned);
    }

    // F3 is function key 3.
    desk.tell(
        "CONNECT FKEYS<1>:<1>TEXT; CONNECT BUTTONSIN<1>:<1>TEXT; LATER := VECTOR_LIST ITEMIZED N=2 P 0,0 L 0,0;\n",
    );
    desk.expect("show LATER", "VECTOR_LIST");
    let [x, y] = desk.place("vector screen");
    desk.click("vector screen");
    desk.display.act("key F3");
    desk.expect("message 60", "ok 3");

    // A lighted button that is clicked.
    desk.click("button 7");
    desk.expect("message 60", "ok 7");

    // The word OPEN of the menu is picked with the puck.
    desk.tell(include_str!("../programs/pick.ps300"));
    desk.expect("show MENU", "BEGIN_STRUCTURE");
    let [corner_x, _] = desk.place("vector screen's corner");
    let half = f64::from(corner_x - x);
    let (word_x, word_y) = (f64::from(x) + 0.62 * half, f64::from(y) - 0.5 * half);
    desk.display.act(&format!("mousemove {word_x:.0} {word_y:.0}"));
    desk.display.act("mousedown 1");
    desk.display.act("mouseup 1");
    desk.expect("message 60", "OPEN");

    // A command that is typed on the keyboard.
    desk.display.act("key ctrl+alt+c");
    desk.expect("mode", "command");
    desk.display.act("type --delay 60 TYPED:=F:PRINT;");
    desk.display.act("key Return");
    desk.expect("show TYPED", "PRINT");

    // The pane of the tablet: the puck in the middle of its right half.
    desk.tell("CONNECT TABLETIN<1>:<1>TEXT; CONNECT BUTTONSIN<1>:<1>TEXT;\n");
    desk.click("view Tablet");
    let [x, y] = desk.place("tablet");
    desk.display.act(&format!("mousemove {} {y}", x + 60));
    desk.expect("message 60", "ok V 0.");

    // The knob of the brightness at its lowest. Where frames are slow, a whole drag may fall into one: it is done again.
    desk.click("view Display");
    let begin = Instant::now();
    while !desk.order("knob").contains("brightness 0,") {
        assert!(begin.elapsed() < PATIENCE, "the knob does not turn: {}", desk.order("knob"));
        let [x, y] = desk.place("knob brightness");
        let steps = [format!("mousemove {} {y}", x + 30), "mousedown 1".into(), format!("mousemove {} {y}", x - 20)];
        for step in steps.iter().map(String::as_str).chain(["mouseup 1"]) {
            desk.display.act(step);
            desk.order("frames 3");
        }
    }
    desk.click("view Display");

    // From a pixel to 8K and back, the window shows what it is given, while polygons are shaded.
    desk.tell(
        "RESERVE_WORKING_STORAGE 100000; SEND FIX(3) TO <5>SHADINGENVIRONMENT; \
               T := POLYGON .5,.5,.5 .5,-.5,-.5 -.5,.5,-.5 POLYGON .5,.5,.5 -.5,.5,-.5 -.5,-.5,.5 \
               POLYGON .5,.5,.5 -.5,-.5,.5 .5,-.5,-.5 POLYGON .5,-.5,-.5 -.5,-.5,.5 -.5,.5,-.5; \
               SOLID := SOLID_RENDERING APPLIED TO T; DISPLAY SOLID;\n",
    );
    desk.tell(&"SEND FIX(8) TO <1>SOLID;".repeat(60));
    let before = desk.place("button 9");
    for size in ["1 1", "7680 4320", "1 8400", "1280 860"] {
        desk.display.act(&format!("windowsize {} {size}", desk.window));
        desk.expect("refresh", "Hz");
    }
    let begin = Instant::now();
    while desk.place("button 9") != before {
        assert!(begin.elapsed() < PATIENCE, "the window is not as it was");
    }
    desk.click("button 9");
    desk.expect("message 60", "ok 9");
    desk.tell("CONNECT SOLID<1>:<1>TEXT; SEND FIX(8) TO <1>SOLID;\n");
    desk.expect("message 60", "ok T");
}

#[test]
fn a_display_that_nobody_serves_is_named_and_the_machine_does_not_start() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ps340"));
    command.args(["--window", "--listen", "tcp:127.0.0.1:0"]).env("DISPLAY", ":9999").env_remove("WAYLAND_DISPLAY");
    let output = command.output().expect("ps340 runs");
    let text = String::from_utf8_lossy(&output.stderr);
    // Where the libraries of the window system are missing too, the first of them is named instead.
    let is_named = text.contains("the display :9999 cannot be reached") || text.contains("apt install");
    assert!(is_named && output.status.code() == Some(1), "{text}");
    assert!(output.stdout.is_empty(), "{}", String::from_utf8_lossy(&output.stdout));
}
