//! What a program of the time does, in its manner, over a host line: the locator, frames.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use tests::{Host, Machine};

const PS340: &str = env!("CARGO_BIN_EXE_ps340-under-test");

/// The network that turns a press into a message: the code of the button, V, the position.
const LOCATOR: &str = "DEL := F:DELTA; SEND FIX(1) TO <2>DEL; ADD := F:ADDC; SEND FIX(1) TO <2>ADD; RTE := F:ROUTE(9);
    SUB := F:SUBC; SEND FIX(1) TO <2>SUB; PRT3 := F:PRINT; PRT6 := F:PRINT; SEND FALSE TO <2>PRT3;
    CONCAT := F:CONCATENATE; CONNECT DEL<1>:<1>ADD; CONNECT ADD<1>:<1>RTE; CONNECT ADD<1>:<2>RTE;
    CONNECT RTE<2>:<1>SUB; CONNECT RTE<3>:<1>SUB; CONNECT RTE<5>:<1>SUB; CONNECT RTE<9>:<1>SUB;
    CONNECT SUB<1>:<1>PRT3; CONNECT PRT3<1>:<1>CONCAT; CONNECT PRT6<1>:<2>CONCAT; CONNECT CONCAT<1>:<1>HOST_MESSAGE;";
/// What a program does before it waits for a press, and when it has read the answer.
const ASK: &str = "CONNECT TABLETIN<3>:<1>DEL; CONNECT TABLETIN<6>:<1>PRT6;";
const LEAVE: &str = "DISCONNECT TABLETIN<3>:<1>DEL; DISCONNECT TABLETIN<6>:<1>PRT6;";

/// Waits until the machine has done what was sent. Nothing else must have come back.
fn meet(host: &mut Host) {
    host.send("SEND 'DONE' TO <1>HOST_MESSAGE;");
    assert_eq!(host.message(), "DONE");
}

/// Buttons that are down after some act with a puck.
fn next_code(before: u8, random: &mut Pcg64Mcg) -> u8 {
    let single = [1, 2, 4, 8][random.random_range(0..4)];
    match random.random_range(0..4) {
        0 => 0,
        // Another button while one is down, or one of several is let go.
        1 => before ^ single,
        _ => single,
    }
}

/// Presses, releases, rolls, chords, connections and disconnections by chance; each press of one button while the
/// program asks has one answer, with its code and its position.
fn locate(clock: &str, seed: u64, acts: usize) {
    let mut machine = Machine::start(PS340, &["--clock", clock]);
    let mut host = machine.attach();
    host.send(LOCATOR);
    meet(&mut host);
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let (mut down, mut asks, mut place, mut answers) = (0, false, [0.0, 0.0], 0);
    for act in 0..acts {
        match random.random_range(0..6) {
            0 => {
                asks = !asks;
                host.send(if asks { ASK } else { LEAVE });
                meet(&mut host);
            }
            1 => {
                place = [random.random_range(-8..=8), random.random_range(-8..=8)].map(|at| f64::from(at) / 8.0);
                machine.operator_command(&format!("puck move {} {}", place[0], place[1]));
            }
            _ => {
                let code = next_code(down, &mut random);
                let is_new = code != std::mem::replace(&mut down, code);
                machine.operator_command(&if code == 0 { "puck release".into() } else { format!("puck press {code}") });
                if asks && is_new && code.is_power_of_two() {
                    let expected = format!("{code}V {},{}", place[0], place[1]);
                    assert_eq!(host.message(), expected, "act {act} of seed {seed}, {clock} clock");
                    answers += 1;
                }
            }
        }
    }
    meet(&mut host);
    assert!(answers > acts / 10, "{answers} answers");
}

#[test]
fn every_press_has_one_answer_with_its_place_whatever_comes_between() {
    locate("virtual", 1, 1_000);
}

#[test]
fn every_press_has_one_answer_in_real_time_too() {
    locate("real", 2, 1_000);
}

#[test]
fn a_typed_return_is_one_line_end() {
    let mut machine = Machine::start(PS340, &["--clock", "virtual"]);
    let mut host = machine.attach();
    host.send("CONNECT KBHANDLER<4>:<1>HOST_MESSAGE;");
    meet(&mut host);
    machine.operator_command("type A\\r\\d");
    assert_eq!(host.bytes(8), b"A\r\n\r\n\x7f\r\n");
}

/// A number of the machine's counters.
fn counter(machine: &mut Machine, name: &str) -> usize {
    let said = machine.operator_command("counters");
    let value = said.split(' ').find_map(|word| word.strip_prefix(name)?.strip_prefix('='));
    value.and_then(|value| value.parse().ok()).unwrap_or_else(|| panic!("no {name} in {said}"))
}

/// A frame as a client draws it: what was temporary goes, then 35 segments with a stroke each.
fn draw(host: &mut Host, frame: usize) {
    let mut text = "DELETE T*; DELETE L*; REMOVE T001 FROM FRAME;\n".to_string();
    for segment in 0..35 {
        let y = segment as f64 / 35.0;
        text += &format!(
            "T{segment:03} := BEGIN_STRUCTURE VIEWPORT HORIZONTAL = -1:1 VERTICAL = -1:1; IF := WINDOW X = -1:1 Y = -1:1;
             IL := LOOK AT 0,0,0 FROM 0,0,-1; S := INSTANCE OF NIL; END_STRUCTURE; INCLUDE T{segment:03} IN FRAMET;
             L{segment:03} := BEGIN_STRUCTURE SET COLOR 120,1; D := VECTOR_LIST ITEMIZED N=2 P -0.5,{y} L 0.5,{y};
             END_STRUCTURE; INCLUDE L{segment:03} IN T{segment:03}.S; SEND {frame} TO <1>T{segment:03}.IL;\n"
        );
    }
    host.send(text);
    host.synchronize();
}

#[test]
fn a_hundred_frames_cost_what_one_costs() {
    let mut machine = Machine::start(PS340, &["--clock", "virtual"]);
    let mut host = machine.attach();
    host.send("DISPLAY FRAMER; DISPLAY FRAMET; FRAME := INSTANCE OF NIL; FRAMET := INSTANCE OF NIL;");
    // What was deleted is cleared away now and then, so that memory goes up and down.
    let (mut most, mut refresh) = (0, None);
    for frame in 0..100 {
        draw(&mut host, frame);
        machine.operator_command("frames 2");
        assert_eq!(counter(&mut machine, "strokes"), 35, "in frame {frame}");
        let micros = counter(&mut machine, "refresh_micros");
        assert_eq!(micros, *refresh.get_or_insert(micros), "in frame {frame}");
        let bytes = counter(&mut machine, "bytes");
        if frame < 20 {
            most = most.max(bytes);
        }
        assert!(bytes <= most, "{bytes} bytes in frame {frame}, at most {most} before");
    }
}
