//! Networks as users and clients of the time build them, and networks that try to break the machine.

use super::*;
use crate::{
    functions::{devices, find},
    matrices::rotation,
    port::{
        Cause, Effect,
        Literal::{self, B, I, R, S, V2, V3},
        MAX_QUEUE, ObjectId,
    },
};
use glam::{DMat3, DMat4, DVec3};
use protocol::{
    Kind, Name, Value,
    command::{Axis, Input},
    value::PickList,
};
use std::collections::HashMap;

/// A network whose objects have names; unknown names are objects without a function.
#[derive(Default)]
pub(super) struct Bench {
    pub(super) network: Network,
    names: HashMap<String, ObjectId>,
    pub(super) effects: Vec<Effect>,
}

impl Bench {
    pub(super) fn with_devices() -> Bench {
        let mut bench = Bench::default();
        for initial in devices::initial() {
            let id = bench.id(&initial.name);
            bench.network.define(id, initial.function, initial.device).unwrap();
        }
        bench
    }

    pub(super) fn id(&mut self, name: &str) -> ObjectId {
        let next = ObjectId(self.names.len() as u32);
        *self.names.entry(name.into()).or_insert(next)
    }

    /// `A := F:TYPE` or `A := F:TYPE(n)`, several of them, separated by blanks.
    pub(super) fn define(&mut self, definitions: &str) -> &mut Bench {
        for definition in definitions.split(' ') {
            let (name, function) = definition.split_once(":=F:").unwrap();
            let (function, size) = match function.split_once('(') {
                Some((function, size)) => (function, Some(size.trim_end_matches(')').parse().unwrap())),
                None => (function, None),
            };
            let id = self.id(name);
            self.network.define(id, find(function).unwrap(), size).unwrap();
        }
        self
    }

    /// `A<1>:<2>B`, several of them, separated by blanks.
    pub(super) fn connect(&mut self, arcs: &str) -> &mut Bench {
        for arc in arcs.split(' ') {
            let (source, destination) = arc.split_once(":<").unwrap();
            let (source, output) = source.trim_end_matches('>').split_once('<').unwrap();
            let (input, target) = destination.split_once('>').unwrap();
            let (source, target) = (self.id(source), self.id(target));
            let input = Input::Number(input.parse().unwrap());
            self.network.connect(source, output.parse().unwrap(), target, input).unwrap();
        }
        self
    }

    pub(super) fn send(&mut self, value: Literal, input: u32, name: &str) -> &mut Bench {
        let id = self.id(name);
        self.network.send(id, Input::Number(input), value.value(), &mut self.effects);
        self
    }

    pub(super) fn emit(&mut self, name: &str, output: u16, value: Literal) -> &mut Bench {
        let id = self.id(name);
        self.network.emit(id, output, value.value(), &mut self.effects);
        self
    }

    /// Runs until idle; what came out since the last time.
    pub(super) fn run(&mut self) -> Vec<Effect> {
        assert!(self.network.run(10_000_000, &mut self.effects).idle);
        std::mem::take(&mut self.effects)
    }

    /// Runs until idle; the messages for a name that is no function.
    pub(super) fn arrived(&mut self, name: &str) -> Vec<Value> {
        let id = self.id(name);
        let effects = self.run();
        effects.into_iter().filter_map(|e| deliver(e).filter(|(object, _)| *object == id)).map(|(_, v)| v).collect()
    }

    /// Runs until idle; the lines that went to the host.
    pub(super) fn host(&mut self) -> Vec<String> {
        let line = |e| match e {
            Effect::Host { bytes, .. } => Some(String::from_utf8(bytes.into()).unwrap()),
            _ => None,
        };
        self.run().into_iter().filter_map(line).collect()
    }
}

pub(super) fn deliver(effect: Effect) -> Option<(ObjectId, Value)> {
    match effect {
        Effect::Deliver { object, value, .. } => Some((object, value)),
        _ => None,
    }
}

pub(super) fn faults(effects: &[Effect]) -> Vec<Cause> {
    let cause = |effect: &Effect| match effect {
        Effect::Fault { fault, .. } => Some(fault.cause),
        _ => None,
    };
    effects.iter().filter_map(cause).collect()
}

/// The functions, constants and limits of the dial network that every client of the time used.
fn dial_network() -> Bench {
    let mut bench = Bench::with_devices();
    bench
        .define("DRX:=F:DXROTATE DRY:=F:DYROTATE DRZ:=F:DZROTATE DSC:=F:DSCALE")
        .define("TVX:=F:XVECTOR TVY:=F:YVECTOR TVZ:=F:ZVECTOR TAC:=F:ACCUMULATE")
        .connect("DIALS<1>:<1>DRX DRX<1>:<1>WORLD.RX DIALS<2>:<1>DRY DRY<1>:<1>WORLD.RY")
        .connect("DIALS<3>:<1>DRZ DRZ<1>:<1>WORLD.RZ DIALS<4>:<1>DSC DSC<1>:<1>WORLD.S")
        .connect("DIALS<5>:<1>TVX TVX<1>:<1>TAC DIALS<6>:<1>TVY TVY<1>:<1>TAC DIALS<7>:<1>TVZ TVZ<1>:<1>TAC")
        .connect("TAC<1>:<1>WORLD.T");
    for name in ["DRX", "DRY", "DRZ"] {
        bench.send(R(0.0), 2, name).send(R(200.0), 3, name);
    }
    bench.send(R(1.0), 2, "DSC").send(R(0.2), 3, "DSC").send(R(1000.0), 4, "DSC").send(R(0.01), 5, "DSC");
    bench.send(V3([0.0; 3]), 2, "TAC").send(R(5.0), 4, "TAC").send(R(100.0), 5, "TAC").send(R(-100.0), 6, "TAC");
    assert_eq!(bench.run(), [], "constants fire nothing");
    bench
}

#[test]
fn a_dial_turns_the_node_by_its_factor() {
    let mut bench = dial_network();
    let turned = bench.emit("DIALS", 1, R(0.1)).arrived("WORLD.RX");
    let [Value::Matrix3(matrix)] = &turned[..] else { panic!("{turned:?}") };
    let (s, c) = 20_f64.to_radians().sin_cos();
    let by_hand = DMat3::from_cols_array_2d(&[[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]);
    assert!(matrix.abs_diff_eq(by_hand, 1e-15));
    assert!((**matrix * DVec3::Y).z > 0.0, "+Y goes towards +Z, into the screen");
}

#[test]
fn a_dial_scales_and_moves_the_nodes() {
    let mut bench = dial_network();
    let scaled = bench.emit("DIALS", 4, R(0.5)).arrived("WORLD.S");
    let [Value::Matrix3(matrix)] = &scaled[..] else { panic!("{scaled:?}") };
    assert!(matrix.abs_diff_eq(DMat3::from_diagonal(DVec3::splat(1.1)), 1e-15));
    assert_eq!(bench.emit("DIALS", 5, R(0.1)).arrived("WORLD.T"), [V3([0.5, 0.0, 0.0]).value()]);
    assert_eq!(bench.emit("DIALS", 7, R(-100.0)).arrived("WORLD.T"), [V3([0.5, 0.0, -100.0]).value()]);
}

#[test]
fn a_reset_value_and_a_zero_delta_reset_the_node() {
    let mut bench = dial_network();
    bench.emit("DIALS", 1, R(0.37)).emit("DIALS", 4, R(3.0)).run();
    assert_eq!(bench.send(R(0.0), 2, "DRX").run(), [], "a reset value alone sends nothing");
    assert_eq!(bench.send(R(0.0), 1, "DRX").arrived("WORLD.RX"), [Value::Matrix3(Box::new(DMat3::IDENTITY))]);
    let scaled = bench.send(R(1.0), 2, "DSC").send(R(1.0), 3, "DSC").send(R(0.0), 1, "DSC").arrived("WORLD.S");
    assert_eq!(scaled, [Value::Matrix3(Box::new(DMat3::IDENTITY))]);
    // The client's slip: a vector where a number belongs.
    let effects = bench.send(V3([0.0; 3]), 1, "TVX").run();
    assert_eq!(faults(&effects), [Cause::Kind { input: 1, kind: Kind::Vector3 }]);
}

#[test]
fn a_thousand_turns_lose_no_precision() {
    let mut bench = dial_network();
    for _ in 0..1_000 {
        bench.emit("DIALS", 3, R(1.8)).run();
    }
    let turned = bench.emit("DIALS", 3, R(0.15)).arrived("WORLD.RZ");
    let [Value::Matrix3(matrix)] = &turned[..] else { panic!("{turned:?}") };
    assert!(matrix.abs_diff_eq(rotation(Axis::Z, 30.0), 1e-12));
}

#[test]
fn a_press_of_the_puck_is_one_message_to_the_host() {
    let mut bench = Bench::with_devices();
    bench
        .define("DEL:=F:DELTA ADD1:=F:ADDC RTE:=F:ROUTE(9) SUB1:=F:SUBC")
        .define("PRT3:=F:PRINT PRT6:=F:PRINT CAT:=F:CONCATENATE")
        .connect("TABLETIN<3>:<1>DEL DEL<1>:<1>ADD1 ADD1<1>:<1>RTE ADD1<1>:<2>RTE")
        .connect("RTE<2>:<1>SUB1 RTE<3>:<1>SUB1 RTE<5>:<1>SUB1 RTE<9>:<1>SUB1 SUB1<1>:<1>PRT3 PRT3<1>:<1>CAT")
        .connect("TABLETIN<6>:<1>PRT6 PRT6<1>:<2>CAT CAT<1>:<1>HOST_MESSAGE")
        .send(I(1), 2, "DEL")
        .send(I(1), 2, "ADD1")
        .send(I(1), 2, "SUB1")
        .send(B(false), 2, "PRT3");
    bench.emit("TABLETIN", 6, V2([0.25, -0.125])).emit("TABLETIN", 3, I(1)).emit("TABLETIN", 3, I(0));
    assert_eq!(bench.host(), ["1V 0.25,-0.125"]);
    bench.emit("TABLETIN", 3, I(8)).emit("TABLETIN", 6, V2([-1.0, 1.0])).emit("TABLETIN", 3, I(0));
    assert_eq!(bench.host(), ["8V -1,1"]);
}

#[test]
fn a_matrix_comes_back_to_the_host_in_five_messages() {
    let mut bench = Bench::with_devices();
    bench
        .define("FXF:=F:XFORMDATA FLIST:=F:LIST FPRINT:=F:PRINT")
        .connect("FXF<1>:<1>FLIST FLIST<1>:<1>FPRINT FPRINT<1>:<1>HOST_MESSAGE");
    let effects = bench.send(S("r001.mxform1"), 2, "FXF").send(B(true), 1, "FXF").run();
    let [Effect::RequestTransform { function, node, .. }] = &effects[..] else { panic!("{effects:?}") };
    assert_eq!((node.as_str(), *function), ("R001.MXFORM1", bench.id("FXF")));
    let matrix = DMat4::from_scale_rotation_translation(
        DVec3::splat(1.1),
        glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7),
        DVec3::new(12345.678, -0.000_123, 1e5),
    );
    bench.network.emit(*function, 1, Value::Transform(Box::new(matrix)), &mut bench.effects);
    let lines = bench.host();
    assert_eq!((lines.len(), lines[0].as_str()), (5, "MATRIX_4X4"));
    assert!(lines[4].ends_with(';'));
    for (i, line) in lines[1..].iter().enumerate() {
        let row: Vec<f64> = line[1..].trim_end_matches(';').split(',').map(|n| n.parse().unwrap()).collect();
        for (read, sent) in row.iter().zip(matrix.col(i).to_array()) {
            assert!((read - sent).abs() <= 1e-9 * sent.abs(), "{line}");
        }
    }
}

#[test]
fn add_waits_for_both_inputs_and_pairs_in_order() {
    let mut bench = Bench::default();
    bench.define("A:=F:ADD").connect("A<1>:<1>X").send(I(1), 1, "A").send(I(2), 1, "A");
    assert_eq!(bench.run(), []);
    assert_eq!(bench.send(I(10), 2, "A").send(I(20), 2, "A").arrived("X"), [I(11).value(), I(22).value()]);
}

#[test]
fn a_wrong_pair_loses_one_message_only() {
    let mut bench = Bench::default();
    bench.define("A:=F:ADD").connect("A<1>:<1>X").send(V3([1.0; 3]), 1, "A").send(V2([1.0; 2]), 2, "A");
    assert_eq!(faults(&bench.run()), [Cause::Kind { input: 2, kind: Kind::Vector2 }]);
    assert_eq!(bench.send(V3([1.0; 3]), 2, "A").arrived("X"), [V3([2.0; 3]).value()]);
}

#[test]
fn fan_out_follows_the_order_of_connection_and_arcs_come_once() {
    let mut bench = Bench::default();
    bench.define("A:=F:NOP").connect("A<1>:<1>C A<1>:<1>B A<1>:<2>C A<1>:<1>C").send(I(1), 1, "A");
    let (b, c) = (bench.id("B"), bench.id("C"));
    let got: Vec<_> = bench
        .run()
        .into_iter()
        .filter_map(|e| match e {
            Effect::Deliver { object, input, .. } => Some((object, input)),
            _ => None,
        })
        .collect();
    assert_eq!(got, [(c, Input::Number(1)), (b, Input::Number(1)), (c, Input::Number(2))]);
}

#[test]
fn all_forms_of_disconnect_work_and_absent_arcs_are_harmless() {
    let mut bench = Bench::default();
    bench.define("P:=F:PARTS").connect("P<1>:<1>X P<1>:<1>Y P<2>:<1>X P<2>:<2>X");
    let (p, x, y) = (bench.id("P"), bench.id("X"), bench.id("Y"));
    let to = |object, input| Destination { object, input: Input::Number(input) };
    let arcs = |bench: &Bench| bench.network.arcs(p).collect::<Vec<_>>();
    bench.network.disconnect(p, Some(1), Some(to(x, 1)));
    assert_eq!(arcs(&bench), [(1, to(y, 1)), (2, to(x, 1)), (2, to(x, 2))]);
    bench.network.disconnect(p, Some(7), Some(to(x, 9)));
    bench.network.disconnect(ObjectId(999), None, None);
    bench.network.disconnect(p, None, Some(to(x, 1)));
    assert_eq!(arcs(&bench), [(1, to(y, 1)), (2, to(x, 2))]);
    bench.network.disconnect(p, Some(2), None);
    assert_eq!(arcs(&bench), [(1, to(y, 1))]);
    bench.network.disconnect(p, None, None);
    assert_eq!(arcs(&bench), []);
}

#[test]
fn instancing_again_empties_and_keeps_the_arcs_to_it() {
    let mut bench = Bench::default();
    bench.define("A:=F:NOP B:=F:ADD").connect("A<1>:<1>B B<1>:<1>X").send(I(5), 1, "A").run();
    bench.define("B:=F:ADD").send(I(1), 2, "B");
    assert_eq!(bench.run(), [], "the 5 that waited is gone");
    bench.connect("B<1>:<1>X").send(I(7), 1, "A");
    assert_eq!(bench.arrived("X"), [I(8).value()]);
    bench.define("B:=F:ADD").send(I(7), 1, "A").send(I(1), 2, "B");
    assert_eq!(bench.run(), [], "its own arc is gone");
}

#[test]
fn what_a_deleted_function_would_get_comes_out_as_an_effect() {
    let mut bench = Bench::default();
    bench.define("A:=F:NOP B:=F:NOP").connect("A<1>:<1>B B<1>:<1>X");
    let b = bench.id("B");
    bench.network.undefine(b);
    assert_eq!(bench.send(I(3), 1, "A").arrived("B"), [I(3).value()]);
    assert_eq!(bench.network.arcs(b).count(), 0);
}

#[test]
fn an_arc_from_a_name_without_a_function_works_when_it_gets_one() {
    let mut bench = Bench::default();
    bench.connect("A<1>:<1>X");
    assert_eq!(bench.emit("A", 1, I(1)).arrived("X"), [I(1).value()], "a node may send too");
    assert_eq!(bench.define("A:=F:NOP").send(I(2), 1, "A").arrived("X"), [I(2).value()]);
}

#[test]
fn inputs_and_outputs_that_do_not_exist_are_warnings() {
    let mut bench = Bench::default();
    bench.define("A:=F:NOP B:=F:NOP");
    let (a, b) = (bench.id("A"), bench.id("B"));
    let fault = bench.network.connect(a, 2, b, Input::Number(1)).unwrap_err();
    assert_eq!(fault.text("A"), "W 9 *** No such output <2> of A");
    let fault = bench.network.connect(a, 1, b, Input::Append).unwrap_err();
    assert_eq!(fault.text("B"), "W 9 *** No such input <append> of B");
    assert_eq!(faults(&bench.send(I(1), 2, "A").run()), [Cause::NoSuchInput(Input::Number(2))]);
}

#[test]
fn a_feedback_loop_with_high_gain_ends_in_a_fault_and_sends_finite_values_only() {
    let mut bench = Bench::default();
    bench.define("G:=F:MULC").connect("G<1>:<1>G G<1>:<1>X").send(R(-1e3), 2, "G").send(R(1.0), 1, "G");
    let effects = bench.run();
    assert_eq!(faults(&effects), [Cause::Overflow]);
    let values: Vec<Value> = effects.into_iter().filter_map(deliver).map(|(_, value)| value).collect();
    assert_eq!(values.len(), 102, "1e3 to the powers 1 to 102 are below the largest real, 1.8e308");
    assert!(values.iter().all(Value::is_finite));
}

#[test]
fn an_endless_loop_is_bounded_by_the_budget_and_its_integers_wrap() {
    let mut bench = Bench::default();
    bench.define("L:=F:ADDC").connect("L<1>:<1>L").send(I(i32::MAX - 4), 2, "L").send(I(0), 1, "L");
    let ran = bench.network.run(100_000, &mut bench.effects);
    assert!(!ran.idle && ran.firings == 100_000);
    let expected = (i32::MAX - 4).wrapping_mul(100_000);
    let l = bench.id("L");
    assert_eq!(bench.network.port(l, 1).unwrap().first(), Some(&Value::Integer(expected)));
}

#[test]
fn a_loop_that_doubles_a_string_stays_within_the_longest_string() {
    let mut bench = Bench::default();
    bench.define("S:=F:NOP C:=F:CONCATENATE").connect("S<1>:<1>C S<1>:<2>C C<1>:<1>S").send(S("0123456789"), 1, "S");
    assert_eq!(faults(&bench.run()), [Cause::TooLong]);
    assert_eq!(bench.network.string_bytes, 0);
}

#[test]
fn a_budget_bounds_the_messages_of_a_wide_loop() {
    let mut bench = Bench::default();
    bench.define("L:=F:NOP").connect("L<1>:<1>L");
    for i in 0..999 {
        bench.connect(&format!("L<1>:<1>X{i}"));
    }
    bench.send(I(1), 1, "L");
    let ran = bench.network.run(10_000, &mut bench.effects);
    assert_eq!((ran.firings, ran.idle, bench.effects.len()), (10, false, 9_990));
}

#[test]
fn a_flood_is_counted_and_reported_and_the_rest_works_on() {
    let mut bench = Bench::default();
    bench.define("A:=F:ADD").connect("A<1>:<1>X");
    for i in 0..MAX_QUEUE as i32 + 150 {
        bench.send(I(i), 1, "A");
    }
    let flood = |lost| Cause::Flood { input: 1, lost };
    assert_eq!(faults(&bench.run()), [flood(1), flood(10), flood(100)]);
    assert_eq!(bench.network.counters().lost, 150);
    for _ in 0..MAX_QUEUE {
        bench.send(I(0), 2, "A");
    }
    let sums = bench.arrived("X");
    assert_eq!((sums.len(), sums.last()), (MAX_QUEUE, Some(&Value::Integer(MAX_QUEUE as i32 - 1))));
}

#[test]
fn what_a_function_takes_out_before_it_fails_is_counted_no_more() {
    let mut bench = Bench::default();
    bench.define("P:=F:PICKINFO").send(I(-1), 2, "P");
    let identifiers = vec![Name::new("LINES").unwrap()];
    let pick = PickList { index: 1, identifiers, node: None, type_code: 1, coordinates: None };
    let p = bench.id("P");
    bench.network.send(p, Input::Number(1), Value::Pick(Box::new(pick)), &mut bench.effects);
    assert!(bench.network.string_bytes > 0);
    assert_eq!(faults(&bench.run()), [Cause::Range { input: 2 }]);
    assert_eq!(bench.network.audit(), Ok(()));
    assert_eq!(bench.network.string_bytes, 0);
}

#[test]
fn strings_that_wait_have_a_limit_in_bytes() {
    let mut bench = Bench::default();
    bench.define("A:=F:CONCATENATE B:=F:CONCATENATE");
    let a = bench.id("A");
    let long = Value::String(vec![b'x'; 65_535].into());
    for _ in 0..1_100 {
        bench.network.send(a, Input::Number(1), long.clone(), &mut bench.effects);
    }
    assert!(bench.network.string_bytes <= MAX_STRING_BYTES);
    assert_eq!(bench.network.counters().lost, 1_100 - (MAX_STRING_BYTES / 65_535) as u64);
    bench.effects.clear();
    bench.network.undefine(a);
    assert_eq!(bench.network.string_bytes, 0);
    assert_eq!(bench.send(S("one"), 1, "B").run(), []);
}

#[test]
fn a_long_chain_needs_no_stack() {
    let mut bench = Bench::default();
    const LENGTH: u32 = 200_000;
    let row = find("ADDC").unwrap();
    for id in 0..LENGTH {
        bench.network.define(ObjectId(id), row, None).unwrap();
        bench.network.send(ObjectId(id), Input::Number(2), Value::Integer(1), &mut bench.effects);
        bench.network.connect(ObjectId(id), 1, ObjectId(id + 1), Input::Number(1)).unwrap();
    }
    bench.network.send(ObjectId(0), Input::Number(1), Value::Integer(0), &mut bench.effects);
    let last = Effect::Deliver { object: ObjectId(LENGTH), input: Input::Number(1), value: I(LENGTH as i32).value() };
    assert_eq!(bench.run(), [last]);
}

#[test]
fn sinks_ask_the_machine_for_effects() {
    let mut bench = Bench::with_devices();
    let label = |label, text: &str| Effect::Label { label, text: text.as_bytes().into() };
    use crate::port::Label;
    bench.send(S("ROT X"), 1, "DLABEL1").send(S("TOO LONG FOR IT"), 1, "FLABEL12").send(I(42), 1, "FLABEL0");
    let expected = [label(Label::Dial(1), "ROT X"), label(Label::Key(12), "TOO LONG"), label(Label::Strip, "42")];
    assert_eq!(bench.run(), expected);
    bench.send(B(true), 1, "CLEAR_LABELS").send(I(0), 1, "OFFBUTTONLIGHTS").send(I(32), 1, "ONBUTTONLIGHTS");
    let lights = [Effect::ClearLabels, Effect::Light { button: 0, on: false }, Effect::Light { button: 32, on: true }];
    assert_eq!(bench.run(), lights);
    bench.send(S(" "), 1, "MESSAGE_DISPLAY").send(S("\x1b[H\x1b[J"), 1, "ES_TE").send(I(0), 1, "TURNONDISPLAY");
    let texts = [Effect::Message((*b" ").into()), Effect::Terminal((*b"\x1b[H\x1b[J").into()), Effect::TurnOnDisplay];
    assert_eq!(bench.run(), texts);
    bench.connect("ERROR<1>:<1>HOST_MESSAGEB MEMORY_MONITOR<1>:<1>FLABEL0");
    bench.send(S("E 7 ***"), 1, "ERROR").send(I(1), 3, "MEMORY_MONITOR");
    let monitor = bench.id("MEMORY_MONITOR");
    let mut effects = bench.run();
    effects.sort_by_key(|effect| matches!(effect, Effect::Host { .. }));
    let object = bench.id("HOST_MESSAGEB");
    let host = Effect::Host { object, bytes: (*b"E 7 ***").into(), binary: true };
    assert_eq!(effects, [Effect::ReportMemory { function: monitor }, host]);
}
