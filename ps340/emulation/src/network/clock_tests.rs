//! Clocks: the table of their inputs, line by line.

use super::*;
use crate::{
    functions::{clocks::MAX_OUTPUTS_AT_ONCE, find},
    port::{
        Cause, Effect, Fault,
        Literal::{self, B, I, R, V2, V3},
        ObjectId,
    },
};
use protocol::command::Input;
use protocol::{Kind, Value};

const CLOCK: ObjectId = ObjectId(0);
const SEQUENCE: ObjectId = ObjectId(1);
const EXHAUSTED: ObjectId = ObjectId(2);

/// A clock with some inputs sent, at frame 0.
fn clock(function: &str, inputs: &[(u32, Literal)]) -> Network {
    let mut network = Network::new();
    network.define(CLOCK, find(function).unwrap(), None).unwrap();
    network.connect(CLOCK, 1, SEQUENCE, Input::Number(1)).unwrap();
    network.connect(CLOCK, 2, EXHAUSTED, Input::Number(1)).unwrap();
    send(&mut network, inputs);
    network
}

fn send(network: &mut Network, inputs: &[(u32, Literal)]) {
    let mut effects = Vec::new();
    for (input, value) in inputs {
        network.send(CLOCK, Input::Number(*input), value.value(), &mut effects);
    }
    assert!(effects.is_empty() && network.run(1, &mut effects).idle, "a clock fires on no message");
}

/// What leaves the clock when it advances frame by frame: frame, output, value.
fn frames(network: &mut Network, frames: std::ops::RangeInclusive<u64>) -> Vec<(u64, u16, Value)> {
    let mut all = Vec::new();
    for frame in frames {
        let mut effects = Vec::new();
        network.advance(frame, 0, &mut effects);
        all.extend(effects.into_iter().map(|effect| match effect {
            Effect::Deliver { object: SEQUENCE, value, .. } => (frame, 1, value),
            Effect::Deliver { object: EXHAUSTED, value, .. } => (frame, 2, value),
            other => panic!("{other:?}"),
        }));
    }
    all
}

fn sent(list: &[(u64, u16, Literal)]) -> Vec<(u64, u16, Value)> {
    list.iter().map(|(frame, output, value)| (*frame, *output, value.value())).collect()
}

#[test]
fn a_frame_clock_sends_its_sequence_at_each_interval() {
    let mut network = clock("CLFRAMES", &[(1, I(1)), (3, B(true)), (5, R(0.0)), (6, R(2.0)), (4, B(true))]);
    assert_eq!(frames(&mut network, 1..=3), sent(&[(1, 1, R(0.0)), (2, 1, R(2.0)), (3, 1, R(4.0))]));
    let mut slow =
        clock("CLFRAMES", &[(1, I(3)), (3, B(true)), (5, V2([1.0, 0.0])), (6, V2([0.0, 1.0])), (4, B(true))]);
    assert_eq!(frames(&mut slow, 1..=7), sent(&[(3, 1, V2([1.0, 0.0])), (6, 1, V2([1.0, 1.0]))]));
}

#[test]
fn a_clock_counts_tells_its_end_and_starts_again() {
    let mut network = clock("CLFRAMES", &[(1, I(1)), (2, I(2)), (5, I(5)), (6, I(1)), (4, B(true))]);
    let first = [(1, 1, I(5)), (2, 1, I(6)), (2, 2, B(true))];
    assert_eq!(frames(&mut network, 1..=4), sent(&first));
    send(&mut network, &[(4, B(true))]);
    assert_eq!(
        frames(&mut network, 5..=8),
        sent(&[(5, 1, I(7)), (6, 1, I(8)), (6, 2, B(true))]),
        "TRUE at <4> counts anew"
    );
    send(&mut network, &[(5, I(5))]);
    assert_eq!(
        frames(&mut network, 9..=12),
        sent(&[(9, 1, I(5)), (10, 1, I(6)), (10, 2, B(true))]),
        "a new <5> restarts"
    );
    send(&mut network, &[(2, I(1))]);
    assert_eq!(frames(&mut network, 13..=15), sent(&[(13, 1, I(7)), (13, 2, B(true))]), "a new <2> counts anew");
}

#[test]
fn a_gate_stops_a_clock_and_a_whole_interval_passes_afterwards() {
    let mut network = clock("CLFRAMES", &[(1, I(3)), (3, B(true)), (5, I(0)), (6, I(1))]);
    assert_eq!(frames(&mut network, 1..=9), [], "it stands still until TRUE arrives at <4>");
    send(&mut network, &[(4, B(true))]);
    assert_eq!(frames(&mut network, 10..=13), sent(&[(12, 1, I(0))]));
    send(&mut network, &[(4, B(false))]);
    assert_eq!(frames(&mut network, 14..=20), []);
    send(&mut network, &[(4, B(true))]);
    assert_eq!(frames(&mut network, 21..=24), sent(&[(23, 1, I(1))]));
}

#[test]
fn a_new_interval_takes_effect_at_the_next_one() {
    let mut network = clock("CLFRAMES", &[(1, I(4)), (3, B(true)), (5, I(0)), (6, I(1)), (4, B(true))]);
    assert_eq!(frames(&mut network, 1..=5), sent(&[(4, 1, I(0))]));
    send(&mut network, &[(1, I(1))]);
    assert_eq!(frames(&mut network, 6..=10), sent(&[(8, 1, I(1)), (9, 1, I(2)), (10, 1, I(3))]));
}

#[test]
fn a_clock_without_a_sequence_sends_ones_and_without_a_start_begins_at_zero() {
    let mut ones = clock("CLFRAMES", &[(1, I(1)), (3, B(true)), (4, B(true))]);
    assert_eq!(frames(&mut ones, 1..=2), sent(&[(1, 1, I(1)), (2, 1, I(1))]));
    let mut zero = clock("CLFRAMES", &[(1, I(1)), (3, B(true)), (6, V3([1.0, 2.0, 3.0])), (4, B(true))]);
    assert_eq!(frames(&mut zero, 1..=2), sent(&[(1, 1, V3([0.0; 3])), (2, 1, V3([1.0, 2.0, 3.0]))]));
}

#[test]
fn seconds_and_ticks_follow_virtual_time() {
    for (function, centiseconds) in [("CLCSECONDS", 10), ("CLTICKS", 50)] {
        let mut network = clock(function, &[(1, I(10)), (3, B(true)), (5, I(0)), (6, I(1)), (4, B(true))]);
        let mut effects = Vec::new();
        for time in (0..=4 * centiseconds).step_by(7) {
            network.advance(0, time, &mut effects);
        }
        assert_eq!(effects.len() as u64, 4 * centiseconds / 7 * 7 / centiseconds, "{function}");
    }
}

#[test]
fn a_jump_of_time_sends_what_is_due_and_reports_what_it_leaves_out() {
    let mut network = clock("CLCSECONDS", &[(1, I(10)), (3, B(true)), (5, I(0)), (6, I(1)), (4, B(true))]);
    let mut effects = Vec::new();
    network.advance(0, 95, &mut effects);
    assert_eq!(effects.len(), 9);
    effects.clear();
    network.advance(0, u64::MAX, &mut effects);
    assert_eq!(effects.len() as u64, MAX_OUTPUTS_AT_ONCE + 1);
    let late = effects
        .iter()
        .any(|e| matches!(e, Effect::Fault { fault: Fault { cause: Cause::Late { lost }, .. }, .. } if *lost > 0));
    assert!(late);
    effects.clear();
    network.advance(0, 5, &mut effects);
    assert!(effects.is_empty(), "time that runs backwards stands still");
}

#[test]
fn a_fault_stops_a_clock() {
    for (inputs, cause) in [
        ([(1, I(0)), (5, I(0)), (6, I(1))], Cause::Range { input: 1 }),
        ([(1, I(1)), (5, R(0.0)), (6, V2([1.0, 1.0]))], Cause::Kind { input: 6, kind: Kind::Vector2 }),
        ([(1, I(1)), (5, R(1.7e308)), (6, R(1.7e308))], Cause::Overflow),
    ] {
        let mut network = clock("CLFRAMES", &inputs);
        send(&mut network, &[(3, B(true)), (4, B(true))]);
        let mut effects = Vec::new();
        for frame in 1..=5 {
            network.advance(frame, 0, &mut effects);
        }
        assert_eq!(effects, [Effect::Fault { object: CLOCK, fault: Fault { function: "CLFRAMES", cause } }]);
    }
}

#[test]
fn one_tick_moves_and_turns_exactly_once() {
    let mut network = clock("CLFRAMES", &[(1, I(1)), (3, B(true)), (5, R(0.0)), (6, R(90.0)), (4, B(true))]);
    let mut effects = Vec::new();
    for (id, function) in [(10, "ZROTATE"), (11, "SINCOS"), (12, "MULC"), (13, "MULC"), (14, "VEC"), (15, "VECC")] {
        network.define(ObjectId(id), find(function).unwrap(), None).unwrap();
    }
    for (id, value) in [(12, 3.0), (13, 3.0), (15, 0.0)] {
        network.send(ObjectId(id), Input::Number(2), Value::Real(value), &mut effects);
    }
    let arcs =
        [(0, 1, 10, 1), (0, 1, 11, 1), (11, 2, 12, 1), (11, 1, 13, 1), (12, 1, 14, 1), (13, 1, 14, 2), (14, 1, 15, 1)];
    for (from, output, to, input) in arcs.into_iter().chain([(10, 1, 50, 1), (15, 1, 51, 1)]) {
        network.connect(ObjectId(from), output, ObjectId(to), Input::Number(input)).unwrap();
    }
    network.disconnect(CLOCK, Some(1), Some(Destination { object: SEQUENCE, input: Input::Number(1) }));
    let around = [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [-3.0, 0.0, 0.0], [0.0, -3.0, 0.0]];
    for frame in 1..=8 {
        network.advance(frame, 0, &mut effects);
        assert!(network.run(1_000, &mut effects).idle);
        let moved: Vec<_> = std::mem::take(&mut effects)
            .into_iter()
            .filter_map(|e| match e {
                Effect::Deliver { object: ObjectId(51), value, .. } => Some(value),
                Effect::Deliver { object: ObjectId(50), .. } => None,
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(moved, [V3(around[(frame as usize - 1) % 4]).value()]);
    }
}
