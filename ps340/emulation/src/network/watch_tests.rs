//! Observing a network: counters, traces, breaks, single firings, snapshots.

use super::*;
use crate::network::tests::Bench;
use crate::port::Literal::{I, S, V2};
use protocol::Value;
use protocol::command::Input;
use std::collections::BTreeSet;

/// A chain A, B, C of F:ADDC with 1, and X after it, which is no function.
fn chain() -> Bench {
    let mut bench = Bench::default();
    bench.define("A:=F:ADDC B:=F:ADDC C:=F:ADDC").connect("A<1>:<1>B B<1>:<1>C C<1>:<1>X");
    for name in ["A", "B", "C"] {
        bench.send(I(1), 2, name);
    }
    bench
}

#[test]
fn counters_tell_what_each_function_did() {
    let mut bench = chain();
    let (a, b, x) = (bench.id("A"), bench.id("B"), bench.id("X"));
    assert_eq!(bench.network.activity(a), None);
    bench.network.count_activity(true);
    for i in 0..3 {
        bench.send(I(i), 1, "A");
    }
    bench.send(S("text"), 1, "A").send(I(1), 7, "A").send(V2([1.0; 2]), 1, "B").run();
    let expected = Activity { firings: 3, received: 3, sent: 3, refused: 2, longest_queue: 3, ..Activity::default() };
    assert_eq!(bench.network.activity(a), Some(expected));
    let of_b = bench.network.activity(b).unwrap();
    assert_eq!((of_b.firings, of_b.faults, of_b.received, of_b.sent), (4, 1, 4, 3));
    assert_eq!(bench.network.activity(x), None, "no function");
    bench.define("A:=F:NOP");
    assert_eq!(bench.network.activity(a), Some(Activity::default()), "instanced anew, counted anew");
    bench.network.count_activity(false);
    assert!(bench.network.instruments.is_none());
}

#[test]
fn a_trace_tells_each_message_with_its_arc_and_the_queue() {
    let mut bench = chain();
    let (a, b, c) = (bench.id("A"), bench.id("B"), bench.id("C"));
    bench.network.trace(Traced::Objects(BTreeSet::from([b])));
    bench.send(I(10), 1, "A").send(I(20), 1, "A").send(I(0), 1, "B").run();
    let to = |object, input| Destination { object, input: Input::Number(input) };
    let from = |object| Some(ArcSource { object, output: 1 });
    let line = |firing, from, to, value: i32, waiting| {
        let value = Value::Integer(value);
        Trace { firing, from, to, value, outcome: Delivery::Arrived { waiting } }
    };
    let expected = [
        line(0, None, to(b, 1), 0, 1),
        line(1, from(a), to(b, 1), 11, 2),
        line(2, from(b), to(c, 1), 1, 1),
        line(3, from(a), to(b, 1), 21, 2),
        line(4, from(b), to(c, 1), 12, 2),
        line(6, from(b), to(c, 1), 22, 2),
    ];
    let (lines, cut) = bench.network.take_trace();
    assert_eq!(cut, 0);
    assert_eq!(lines.len(), expected.len(), "{lines:#?}");
    for (line, expected) in lines.iter().zip(&expected) {
        assert_eq!((line.from, line.to, &line.value), (expected.from, expected.to, &expected.value), "{lines:#?}");
    }
    assert_eq!(lines[..3], expected[..3]);
    bench.network.trace(Traced::Nothing);
    bench.send(I(0), 1, "A").run();
    assert_eq!(bench.network.take_trace().0, []);
    assert!(bench.network.instruments.is_none());
}

#[test]
fn a_trace_tells_what_was_refused_lost_and_handed_over() {
    let mut bench = chain();
    bench.network.trace(Traced::Everything);
    bench.send(S("text"), 1, "C").send(I(1), 1, "C").run();
    let outcomes: Vec<_> = bench.network.take_trace().0.into_iter().map(|line| line.outcome).collect();
    assert_eq!(outcomes, [Delivery::Refused, Delivery::Arrived { waiting: 1 }, Delivery::Left]);
}

#[test]
fn a_trace_is_bounded_in_lines_and_in_strings() {
    let mut bench = Bench::default();
    bench.define("A:=F:NOP").network.trace(Traced::Everything);
    let a = bench.id("A");
    let long = Value::String(vec![b'x'; 65_535].into());
    for _ in 0..TRACE_LINES + 10 {
        bench.network.send(a, Input::Number(1), long.clone(), &mut bench.effects);
        bench.network.run(10, &mut bench.effects);
    }
    let (lines, cut) = bench.network.take_trace();
    assert_eq!((lines.len(), cut), (TRACE_LINES, 10));
    assert!(lines.iter().all(|line| line.value == Value::String(vec![b'x'; TRACED_BYTES].into())));
}

#[test]
fn a_break_stops_the_network_before_the_function_fires_each_time() {
    let mut bench = chain();
    let b = bench.id("B");
    bench.network.set_break(b, true);
    bench.send(I(1), 1, "A").send(I(2), 1, "A");
    for expected in [Some(b), Some(b), None] {
        let ran = bench.network.run(1_000, &mut bench.effects);
        assert_eq!((ran.stopped, ran.idle), (expected, expected.is_none()));
        assert_eq!((bench.network.next(), bench.network.is_held()), (expected, expected.is_some()));
        let again = bench.network.run(1_000, &mut bench.effects);
        assert_eq!((again.stopped, again.firings, again.work), (expected, 0, 0), "it stands still until it is resumed");
        bench.network.resume();
    }
    assert_eq!(bench.arrived("X"), [I(4).value(), I(5).value()]);
    assert_eq!(bench.network.breaks().collect::<Vec<_>>(), [b]);
    bench.network.set_break(b, false);
    assert!(bench.network.instruments.is_none());
}

#[test]
fn single_firings_go_in_the_order_of_a_run() {
    let (mut bench, mut stepped) = (chain(), Vec::new());
    let [a, b, c] = ["A", "B", "C"].map(|name| bench.id(name));
    bench.send(I(1), 1, "A").send(I(2), 1, "A");
    while let Some(object) = bench.network.step_one(&mut bench.effects) {
        stepped.push(object);
        let ran = bench.network.run(100, &mut bench.effects);
        assert_eq!((ran.firings, ran.stopped), (0, bench.network.next()), "a run does nothing between");
    }
    assert_eq!(stepped, [a, a, b, b, c, c]);
    bench.network.resume();
    assert_eq!(bench.arrived("X"), [I(4).value(), I(5).value()]);
    assert!(bench.network.instruments.is_none());
}

#[test]
fn clocks_stand_still_while_the_network_is_held() {
    let mut bench = Bench::default();
    bench.define("C:=F:CLFRAMES").connect("C<1>:<1>X").send(I(1), 1, "C");
    bench.send(crate::port::Literal::B(true), 3, "C").send(crate::port::Literal::B(true), 4, "C");
    bench.network.advance(1, 0, &mut bench.effects);
    bench.network.hold();
    bench.network.advance(50, 0, &mut bench.effects);
    bench.network.resume();
    bench.network.advance(51, 0, &mut bench.effects);
    assert_eq!(bench.effects.len(), 2);
}

#[test]
fn a_snapshot_shows_functions_inputs_and_arcs() {
    let mut bench = chain();
    let (a, b) = (bench.id("A"), bench.id("B"));
    bench.send(I(5), 1, "A").send(I(6), 1, "A");
    assert_eq!(bench.network.snapshot().count(), 3);
    let view = bench.network.snapshot().next().unwrap();
    assert_eq!((view.object(), view.row().name, view.is_ready(), view.outputs()), (a, "ADDC", true, 1));
    let inputs: Vec<_> = view.inputs().map(|i| (i.number(), i.is_active(), i.len(), i.first().cloned())).collect();
    assert_eq!(inputs, [(1, true, 2, Some(I(5).value())), (2, false, 1, Some(I(1).value()))]);
    assert_eq!(view.inputs().next().unwrap().messages().count(), 2);
    assert_eq!(view.arcs().collect::<Vec<_>>(), [(1, bench.network.port(b, 1).unwrap().destination())]);
    assert!(bench.network.port(b, 1).unwrap().is_wanting());
    assert!(bench.network.port(b, 3).is_none() && bench.network.port(b, 0).is_none());
}
