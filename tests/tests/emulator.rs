//! The emulator as its own process, driven as `nc` and an operator would.

use std::{
    fs,
    io::{Read, Write},
    net::TcpStream,
    time::{Duration, Instant},
};
use tests::{Host, Machine, TIMEOUT};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

const CUBE: &str = "
INITIALIZE;
CUBE := VECTOR_LIST ITEMIZED N = 16
   P -1,-1,-1  L  1,-1,-1  L  1, 1,-1  L -1, 1,-1  L -1,-1,-1
   L -1,-1, 1  L  1,-1, 1  L  1, 1, 1  L -1, 1, 1  L -1,-1, 1
   P  1,-1,-1  L  1,-1, 1   P  1, 1,-1  L  1, 1, 1   P -1, 1,-1  L -1, 1, 1 ;
WORLD := BEGIN_STRUCTURE
   PER := FIELD_OF_VIEW 30 FRONT = 6 BACK = 14;
          LOOK AT 0,0,0 FROM 0,0,-10;
   RX  := ROTATE IN X 0;
   MAT := XFORM MATRIX;
          INSTANCE OF CUBE;
END_STRUCTURE;
DRX := F:DXROTATE; CONNECT DIALS<1>:<1>DRX; CONNECT DRX<1>:<1>WORLD.RX;
SEND 0 TO <2>DRX; SEND 200 TO <3>DRX;
PR := F:PRINT; CONNECT DIALS<1>:<1>PR; CONNECT PR<1>:<1>HOST_MESSAGE;
DISPLAY WORLD;
";

#[test]
fn typed_text_makes_a_cube_a_network_turns_it_and_the_message_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).display().to_string();
    let mut machine = Machine::start(PS340, &[]);
    let mut host = machine.attach();
    host.send(CUBE);
    host.synchronize();
    machine.operator_command("idle");
    machine.operator_command(&format!("picture vector {} 256", file("before.png")));
    machine.operator_command("dial 1 0.1");
    assert_eq!(host.message().parse::<f64>().unwrap(), 0.1);
    machine.operator_command("idle");
    machine.operator_command(&format!("picture vector {} 256", file("after.png")));
    let (before, after) = (image::open(file("before.png")).unwrap(), image::open(file("after.png")).unwrap());
    let lit = |image: &image::DynamicImage| image.to_luma8().pixels().filter(|p| p.0[0] > 64).count();
    assert!(lit(&before) > 500 && lit(&after) > 500, "{} and {} pixels glow", lit(&before), lit(&after));
    assert_ne!(before, after);
    // The closed form: a rotation by 20 degrees about X.
    let shown = machine.operator_command("show WORLD.RX");
    let numbers: Vec<f64> = shown.split([' ', ',']).filter_map(|w| w.parse().ok()).collect();
    let (s, c) = 20_f64.to_radians().sin_cos();
    for (found, expected) in numbers.iter().zip([1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c]) {
        assert!((found - expected).abs() < 1e-12, "{shown}");
    }
    assert_eq!(numbers.len(), 9);
    assert!(machine.operator_command("log").is_empty(), "{}", machine.operator_command("log"));
}

#[test]
fn a_host_that_dies_leaves_the_machine_and_its_picture() {
    let mut machine = Machine::start(PS340, &[]);
    let mut host = machine.attach();
    host.send(CUBE);
    host.synchronize();
    host.send("HALF := BEGIN_STRUCTURE ROTATE IN X");
    drop(host);
    let mut other = machine.attach();
    other.synchronize();
    assert!(machine.runs());
    assert!(machine.operator_command("show WORLD").contains("BEGIN_STRUCTURE"));
    assert!(machine.reply("show HALF").starts_with("error"));
    machine.operator_command("quit");
    assert_eq!(machine.end(), Some(0));
    let errors = machine.errors();
    assert!(errors.contains("attached") && errors.contains("closed"), "{errors}");
}

#[test]
fn the_machine_ends_with_its_operator() {
    let mut machine = Machine::start(PS340, &[]);
    let mut host = machine.attach();
    host.synchronize();
    machine.close_operator();
    assert_eq!(machine.end(), Some(0));
}

#[test]
fn two_hosts_share_one_machine() {
    let machine = Machine::start(PS340, &[]);
    let (mut one, mut two) = (machine.attach(), machine.attach());
    one.synchronize();
    two.synchronize();
    one.send("N := F:NOP; CONNECT N<1>:<1>HOST_MESSAGE;");
    one.synchronize();
    two.send("SEND 'FROM TWO' TO <1>N;");
    while one.message() != "FROM TWO" {}
    while two.message() != "FROM TWO" {}
}

#[test]
fn a_unix_socket_is_a_line_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("line");
    let address = format!("unix:{}", path.display());
    let mut machine = Machine::start(PS340, &["--listen", &address]);
    let mut stream = std::os::unix::net::UnixStream::connect(&path).unwrap();
    stream.write_all(b"N := F:NOP;SEND 'OVER UNIX' TO <1>HOST_MESSAGE;").unwrap();
    assert_eq!(machine.operator_command("message"), "OVER UNIX");
    machine.operator_command("quit");
    machine.end();
    assert!(!path.exists(), "the socket's file is removed");
}

#[test]
fn an_address_in_use_is_a_clear_error() {
    let machine = Machine::start(PS340, &[]);
    let address = format!("tcp:{}", machine.line);
    let folder = tempfile::tempdir().unwrap();
    let ended = tests::run(PS340, &["--listen", &address], &[], folder.path(), Duration::from_secs(30));
    assert_eq!(ended.code, Some(1));
    assert!(ended.errors.contains(&address), "{}", ended.errors);
}

#[test]
fn a_virtual_clock_passes_only_while_someone_waits() {
    let mut machine = Machine::start(PS340, &["--clock", "virtual"]);
    let frame = |machine: &mut Machine| machine.operator_command("counters").split(' ').next().map(str::to_string);
    assert_eq!(frame(&mut machine).as_deref(), Some("frame=0"));
    machine.operator_command("frames 1000000");
    assert_eq!(frame(&mut machine).as_deref(), Some("frame=1000000"));
}

#[test]
fn plain_text_and_keyboard_begin_as_the_options_say() {
    let all: [(&[&str], &str, bool); 4] = [
        (&[], "interactive", true),
        (&["--plain-text", "terminal"], "terminal", false),
        (&["--plain-text", "terminal", "--keyboard", "command"], "command", false),
        (&["--keyboard", "terminal"], "terminal", true),
    ];
    for (options, mode, is_command) in all {
        let mut machine = Machine::start(PS340, options);
        assert_eq!(machine.operator_command("mode"), mode, "{options:?}");
        let mut host = machine.attach();
        host.send("A := VECTOR_LIST DOTS 0,0; DISPLAY A;\r\n");
        let begin = Instant::now();
        let (mut drawn, mut shown) = (false, false);
        while !drawn && !shown {
            assert!(begin.elapsed() < TIMEOUT, "{options:?}: the text went nowhere");
            drawn = machine.operator_command("strokes").starts_with("1 ");
            shown = machine.operator_command("terminal").contains("DISPLAY A;");
        }
        assert_eq!((drawn, shown), (is_command, !is_command), "{options:?}");
    }
}

#[test]
fn noise_on_the_line_is_survived() {
    let machine = Machine::start(PS340, &[]);
    let mut noisy = TcpStream::connect(&machine.line).unwrap();
    let noise: Vec<u8> = (0..200_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    noisy.write_all(&noise).unwrap();
    drop(noisy);
    let mut host = Host::attach(&machine.line);
    host.synchronize();
}

#[test]
fn pictures_are_the_same_with_one_thread_and_with_two() {
    let folder = tempfile::tempdir().unwrap();
    let mut pictures = Vec::new();
    for threads in ["1", "2"] {
        let mut machine = Machine::start(PS340, &["--threads", threads]);
        let mut host = machine.attach();
        host.send(CUBE);
        host.synchronize();
        for extension in ["png", "exr"] {
            let file = folder.path().join(format!("{threads}.{extension}"));
            machine.operator_command(&format!("picture vector {} 300", file.display()));
            pictures.push(fs::read(file).unwrap());
        }
    }
    assert!(pictures[0] == pictures[2] && pictures[1] == pictures[3]);
}

#[test]
fn a_host_that_closes_its_side_still_gets_its_answer_from_a_busy_machine() {
    let machine = Machine::start(PS340, &[]);
    let mut busy = machine.attach();
    busy.send("N := F:NOP; CONNECT N<1>:<1>N; SEND 1 TO <1>N; P := F:PRINT; CONNECT P<1>:<1>HOST_MESSAGE;");
    busy.synchronize();
    let mut stream = TcpStream::connect(&machine.line).unwrap();
    stream.set_read_timeout(Some(tests::TIMEOUT)).unwrap();
    stream.write_all(b"SEND 2 TO <1>P;").unwrap();
    stream.shutdown(std::net::Shutdown::Write).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert_eq!(answer, "2\r\n");
}

#[test]
fn frames_pass_and_operators_are_answered_while_a_host_floods_the_line() {
    let mut machine = Machine::start(PS340, &[]);
    let mut stream = TcpStream::connect(&machine.line).unwrap();
    let (stop, stopped) = std::sync::mpsc::channel::<()>();
    let flood = std::thread::spawn(move || {
        let commands =
            "A := VECTOR_LIST 0,0 1,1 0,1; NONSENSE; SEND 1 TO <1>B; B := F:ADDC; SEND 2 TO <2>B;".repeat(1000);
        while let Err(std::sync::mpsc::TryRecvError::Empty) = stopped.try_recv() {
            if stream.write_all(commands.as_bytes()).is_err() {
                return;
            }
        }
    });
    for _ in 0..3 {
        machine.operator_command("frames 20");
    }
    machine.operator_command("dial 1 0.5");
    machine.operator_command("counters");
    drop(stop);
    flood.join().unwrap();
    assert!(machine.runs());
}
