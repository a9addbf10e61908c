//! Networks at their limits, each with the outcome that the machine states.

use super::*;
use crate::network::tests::{Bench, deliver, faults};
use crate::{
    functions::find,
    port::{
        Cause, Effect,
        Literal::{I, R},
        MAX_QUEUE, ObjectId,
    },
};
use protocol::Value;
use protocol::command::Input;

fn reals(effects: Vec<Effect>) -> Vec<f64> {
    let number = |effect| deliver(effect).and_then(|(_, value)| value.number());
    effects.into_iter().filter_map(number).collect()
}

#[test]
fn a_loop_with_gain_sends_its_powers_until_a_real_overflows() {
    for gain in [1.5, 2.0, 10.0, 1e3, 1e6_f64] {
        for sign in [1.0, -1.0] {
            let mut bench = Bench::default();
            bench.define("G:=F:MULC").connect("G<1>:<1>G G<1>:<1>X").send(R(sign * gain), 2, "G").send(R(1.0), 1, "G");
            let effects = bench.run();
            assert_eq!(faults(&effects), [Cause::Overflow], "{gain}");
            let powers = reals(effects);
            let largest = (1..).take_while(|&n| gain.powi(n).is_finite()).count();
            assert_eq!(powers.len(), largest, "{gain}: no output after the largest power");
            for (n, power) in (1..).zip(&powers) {
                let expected = (sign * gain).powi(n);
                assert!((power / expected - 1.0).abs() < f64::from(n) * 1e-15, "{gain} to the power {n}");
            }
            assert_eq!(bench.run(), [], "the loop stands still, the network goes on");
            assert_eq!(reals(bench.define("N:=F:NOP").connect("N<1>:<1>X").send(R(1.0), 1, "N").run()), [1.0]);
        }
    }
}

#[test]
fn a_loop_with_a_gain_up_to_one_never_ends_and_keeps_to_the_budget() {
    for (gain, end) in [(0.1, 0.0), (0.9, 0.0), (1.0, 1.0), (-1.0, 1.0)] {
        let mut bench = Bench::default();
        bench.define("G:=F:MULC").connect("G<1>:<1>G").send(R(gain), 2, "G").send(R(1.0), 1, "G");
        let ran = bench.network.run(100_000, &mut bench.effects);
        assert_eq!((ran.firings, ran.work, ran.idle, bench.effects.len()), (100_000, 100_000, false, 0));
        let g = bench.id("G");
        let left = bench.network.port(g, 1).unwrap().first().and_then(Value::number).unwrap();
        // 0.9 times the smallest real is the smallest real again.
        assert!((left - end).abs() < 1e-300, "{gain}: {left}");
    }
}

#[test]
fn integers_wrap_in_a_loop_and_reals_fault() {
    let mut bench = Bench::default();
    bench.define("G:=F:MULC").connect("G<1>:<1>G").send(I(3), 2, "G").send(I(1), 1, "G");
    bench.network.run(1_000, &mut bench.effects);
    let g = bench.id("G");
    let expected = (0..1_000).fold(1_i32, |power, _| power.wrapping_mul(3));
    assert_eq!(bench.network.port(g, 1).unwrap().first(), Some(&Value::Integer(expected)));
    assert_eq!(faults(&bench.effects), []);
}

#[test]
fn a_self_loop_takes_turns_with_the_rest_of_the_network() {
    let mut bench = Bench::default();
    bench.define("L:=F:ADDC A:=F:NOP").connect("L<1>:<1>L L<1>:<1>X A<1>:<1>Y").send(I(1), 2, "L");
    bench.send(I(0), 1, "L").send(I(100), 1, "A").send(I(101), 1, "A");
    bench.network.run(8, &mut bench.effects);
    let y = bench.id("Y");
    let turns: Vec<bool> =
        std::mem::take(&mut bench.effects).into_iter().filter_map(deliver).map(|(id, _)| id == y).collect();
    assert_eq!(turns, [false, true, false, true, false], "two units for the loop, one for A, in turns");
}

#[test]
fn of_a_million_messages_to_one_input_the_first_ten_thousand_wait() {
    let mut bench = Bench::default();
    bench.define("A:=F:ADD").connect("A<1>:<1>X");
    let a = bench.id("A");
    for i in 0..1_000_000 {
        bench.network.send(a, Input::Number(1), Value::Integer(i), &mut bench.effects);
    }
    let lost = 1_000_000 - MAX_QUEUE as u64;
    let reported: Vec<_> = (0..6).map(|n| Cause::Flood { input: 1, lost: 10_u64.pow(n) }).collect();
    assert_eq!(faults(&bench.run()), reported);
    let port = bench.network.port(a, 1).unwrap();
    assert_eq!((port.len(), port.lost(), bench.network.counters().lost), (MAX_QUEUE, lost, lost));
    assert!(port.messages().zip(0..).all(|(message, i)| *message == Value::Integer(i)), "in their order");
    bench.define("A:=F:ADD");
    assert_eq!((bench.network.port(a, 1).unwrap().lost(), bench.network.backlog.capacity_in_use()), (0, 0));
    let mut drained = Bench::default();
    drained.define("A:=F:NOP").connect("A<1>:<1>X");
    let a = drained.id("A");
    for i in 0..1_000_000 {
        drained.network.send(a, Input::Number(1), Value::Integer(i), &mut drained.effects);
        if i % 1_000 == 999 {
            drained.network.run(u64::MAX, &mut drained.effects);
        }
    }
    assert_eq!(drained.effects.len(), 1_000_000, "a network that keeps up loses nothing");
}

/// Functions 0 to `count` - 1, F:ADDC with 1, each connected with the next; the object `count` is none.
fn chain(count: u32) -> (Network, Vec<Effect>) {
    let (mut network, mut effects) = (Network::new(), Vec::new());
    for id in 0..count {
        network.define(ObjectId(id), find("ADDC").unwrap(), None).unwrap();
        network.send(ObjectId(id), Input::Number(2), Value::Integer(1), &mut effects);
        network.connect(ObjectId(id), 1, ObjectId(id + 1), Input::Number(1)).unwrap();
    }
    (network, effects)
}

#[test]
fn a_hundred_thousand_functions_fire_in_the_order_in_which_they_became_ready() {
    const COUNT: u32 = 100_000;
    let (mut network, mut effects) = chain(COUNT);
    network.retain_arcs(|_, _, _| false);
    let order: Vec<u32> = (0..COUNT).map(|i| (u64::from(i) * 7_919 % u64::from(COUNT)) as u32).collect();
    for &id in &order {
        network.connect(ObjectId(id), 1, ObjectId(COUNT + id), Input::Number(1)).unwrap();
        network.send(ObjectId(id), Input::Number(1), Value::Integer(id as i32), &mut effects);
    }
    assert!(network.run(u64::MAX, &mut effects).idle);
    let arrived = effects.into_iter().filter_map(deliver).map(|(object, value)| (object.0 - COUNT, value));
    assert!(arrived.eq(order.iter().map(|&id| (id, Value::Integer(id as i32 + 1)))));
}

#[test]
fn redefinition_and_deletion_in_the_middle_of_a_run() {
    let (mut network, mut effects) = chain(100);
    network.send(ObjectId(0), Input::Number(1), Value::Integer(0), &mut effects);
    assert_eq!(network.run(50, &mut effects), RunReport { firings: 50, work: 50, idle: false, stopped: None });
    // 50 is ready: it loses its message, and does not fire.
    network.define(ObjectId(50), find("NOP").unwrap(), None).unwrap();
    assert!(network.run(50, &mut effects).idle);
    assert_eq!(effects, []);
    // Made anew while it is ready, it keeps its position in the list, without a second one.
    network.connect(ObjectId(50), 1, ObjectId(51), Input::Number(1)).unwrap();
    for _ in 0..3 {
        network.send(ObjectId(50), Input::Number(1), Value::Integer(5), &mut effects);
        network.define(ObjectId(50), find("NOP").unwrap(), None).unwrap();
        network.connect(ObjectId(50), 1, ObjectId(51), Input::Number(1)).unwrap();
    }
    assert_eq!(network.ready.iter().count(), 1);
    network.send(ObjectId(50), Input::Number(1), Value::Integer(7), &mut effects);
    network.run(10, &mut effects);
    // Deleted on the way: what would go to 70 comes out, since nobody has the name.
    network.undefine(ObjectId(70));
    assert!(network.run(1_000, &mut effects).idle);
    let out = Effect::Deliver { object: ObjectId(70), input: Input::Number(1), value: Value::Integer(7 + 19) };
    assert_eq!(std::mem::take(&mut effects), [out]);
    // Defined again, the arc to it works at once; its own arc is gone.
    network.define(ObjectId(70), find("NOP").unwrap(), None).unwrap();
    network.send(ObjectId(69), Input::Number(1), Value::Integer(1), &mut effects);
    network.run(1_000, &mut effects);
    assert_eq!((effects.len(), network.view(ObjectId(70)).unwrap().arcs().count()), (0, 0));
    assert_eq!(network.activity(ObjectId(70)), None);
}

#[test]
fn an_arc_to_a_name_without_a_definition_hands_its_messages_over_until_it_has_one() {
    let mut bench = Bench::default();
    bench.define("A:=F:NOP").connect("A<1>:<3>LATER").send(I(1), 1, "A");
    let later = bench.id("LATER");
    let out = Effect::Deliver { object: later, input: Input::Number(3), value: I(1).value() };
    assert_eq!(bench.run(), [out]);
    bench.define("LATER:=F:NOP").send(I(2), 1, "A");
    assert_eq!(faults(&bench.run()), [Cause::NoSuchInput(Input::Number(3))], "the new function has one input");
    bench.define("LATER:=F:SYNC(3)").send(I(3), 1, "A").run();
    assert_eq!(bench.network.port(later, 3).unwrap().first(), Some(&I(3).value()));
}
