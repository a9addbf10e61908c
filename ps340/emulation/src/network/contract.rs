//! What every row of the table of functions must keep, whatever it computes.

use super::*;
use crate::{
    functions::{FunctionRow, Rule, Shape, all, devices},
    port::{Cause, Effect, Fault, Literal, ObjectId, QueueRole},
};
use protocol::Value;
use protocol::command::Input;
use std::collections::HashSet;

const FUNCTION: ObjectId = ObjectId(3);
/// Output n is connected to the object with this number plus n, which does not exist.
const BEYOND: u32 = 100;

const EVERY_KIND: [Literal; 12] = [
    Literal::B(true),
    Literal::I(1),
    Literal::R(0.5),
    Literal::S("text"),
    Literal::V2([1.0, 2.0]),
    Literal::V3([1.0, 2.0, 3.0]),
    Literal::V4([1.0, 2.0, 3.0, 4.0]),
    Literal::M2([[1.0, 2.0]; 2]),
    Literal::M3([[1.0, 2.0, 3.0]; 3]),
    Literal::M43([[1.0, 2.0, 3.0]; 4]),
    Literal::M4([[1.0, 2.0, 3.0, 4.0]; 4]),
    Literal::T([[1.0, 2.0, 3.0, 4.0]; 4]),
];

fn rows() -> impl Iterator<Item = &'static FunctionRow> {
    all().chain(devices::rows())
}

/// A size that the row takes, and the shape with it.
fn some_shape(row: &FunctionRow) -> (Option<u16>, Shape) {
    [None, Some(3)].into_iter().find_map(|size| row.shape(size).ok().map(|shape| (size, shape))).unwrap()
}

fn instance(row: &'static FunctionRow, size: Option<u16>) -> Network {
    let mut network = Network::new();
    network.define(FUNCTION, row, size).unwrap();
    for output in 1..=row.shape(size).unwrap().outputs {
        let beyond = ObjectId(BEYOND + u32::from(output));
        network.connect(FUNCTION, output, beyond, Input::Number(1)).unwrap();
    }
    network
}

fn send(network: &mut Network, input: u16, value: Literal) -> Vec<Effect> {
    let mut effects = Vec::new();
    network.send(FUNCTION, Input::Number(u32::from(input)), value.value(), &mut effects);
    assert!(network.run(1_000, &mut effects).idle);
    assert_eq!(network.audit(), Ok(()), "{value:?} at <{input}>");
    effects
}

/// The numbers in a value, and everything else about it as text.
fn anatomy(value: &Value) -> (Vec<f64>, String) {
    let numbers = match value {
        Value::Real(r) => vec![*r],
        Value::Vector2(v) => v.to_array().into(),
        Value::Vector3(v) => v.to_array().into(),
        Value::Vector4(v) => v.to_array().into(),
        Value::Matrix2(m) => m.to_cols_array().into(),
        Value::Matrix3(m) => m.to_cols_array().into(),
        Value::Matrix4x3(m) | Value::Matrix4(m) | Value::Transform(m) => m.to_cols_array().into(),
        other => return (vec![], format!("{other:?}")),
    };
    (numbers, value.kind().to_string())
}

fn is_close(a: &Value, b: &Value) -> bool {
    let ((a, a_rest), (b, b_rest)) = (anatomy(a), anatomy(b));
    a_rest == b_rest && a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-12 * a.abs().max(b.abs()))
}

#[test]
fn names_are_unique_and_rows_are_described() {
    let mut names = HashSet::new();
    for row in rows() {
        assert!(names.insert(row.name), "{} stands twice", row.name);
        assert!(protocol::Name::new(row.name).is_ok_and(|name| name.as_str() == row.name), "{}", row.name);
        assert!(!row.summary.is_empty(), "{} has no summary", row.name);
        let is_initial = devices::rows().any(|device| device.name == row.name);
        assert!(is_initial || row.clock.is_some() || !row.examples.is_empty(), "{} has no example", row.name);
        for port in row.inputs {
            assert!(!port.summary.is_empty(), "{} has an input without a summary", row.name);
            if let QueueRole::Default(value) = port.role {
                assert!(port.kinds.contains(value.value().kind()), "a default of {} is no such kind", row.name);
            }
        }
    }
    let initial: HashSet<String> = devices::initial().map(|initial| initial.name).collect();
    for name in ["DIALS", "DLABEL1", "DLABEL8", "FLABEL0", "FLABEL12", "HOST_MESSAGE", "ERROR"] {
        assert!(initial.contains(name), "{name} is missing");
    }
    assert_eq!(initial.len(), devices::initial().count());
}

#[test]
fn examples_give_their_results_and_faults() {
    for row in rows() {
        for example in row.examples {
            let size = (example.size > 0).then_some(example.size);
            let mut network = instance(row, size);
            let (mut results, mut faults) = (Vec::new(), Vec::new());
            for (input, value) in example.sends {
                for effect in send(&mut network, *input, *value) {
                    match effect {
                        Effect::Deliver { object, value, .. } => results.push(((object.0 - BEYOND) as u16, value)),
                        Effect::Fault { fault, .. } => faults.push(fault.number()),
                        _ => {}
                    }
                }
            }
            let expected: Vec<_> = example.results.iter().map(|(output, value)| (*output, value.value())).collect();
            let same = results.len() == expected.len()
                && results.iter().zip(&expected).all(|(a, b)| a.0 == b.0 && is_close(&a.1, &b.1));
            assert!(same, "{}: {example:?}\n gave {results:?}", row.name);
            assert_eq!(faults, example.faults, "{}: {example:?}", row.name);
        }
    }
}

#[test]
fn a_message_of_a_wrong_kind_is_a_fault_and_leaves_all_queues_alone() {
    let mut checked = 0;
    for row in rows() {
        let (size, shape) = some_shape(row);
        for input in 1..=shape.inputs {
            let accepted = row.input(shape, input).unwrap().kinds;
            for wrong in EVERY_KIND.iter().filter(|value| !accepted.contains(value.value().kind())) {
                let mut network = instance(row, size);
                let lengths = |network: &Network| {
                    (1..=shape.inputs).map(|i| network.port(FUNCTION, i).unwrap().len()).collect::<Vec<_>>()
                };
                let before = lengths(&network);
                let effects = send(&mut network, input, *wrong);
                let cause = Cause::Kind { input, kind: wrong.value().kind() };
                assert_eq!(effects, [Effect::Fault { object: FUNCTION, fault: Fault { function: row.name, cause } }]);
                assert_eq!((lengths(&network), network.counters().firings), (before, 0), "{}", row.name);
                checked += 1;
            }
        }
    }
    assert!(checked > 500, "{checked}");
}

#[test]
fn nothing_fires_while_an_input_that_it_waits_for_is_empty() {
    let mut checked = 0;
    for row in rows().filter(|row| row.rule == Rule::All) {
        for example in row.examples {
            let size = (example.size > 0).then_some(example.size);
            let shape = row.shape(size).unwrap();
            for missing in 1..=shape.inputs {
                if !instance(row, size).port(FUNCTION, missing).unwrap().is_wanting() {
                    continue;
                }
                let mut network = instance(row, size);
                let sent: Vec<_> = example.sends.iter().filter(|(input, _)| *input != missing).collect();
                for (input, value) in sent {
                    send(&mut network, *input, *value);
                }
                assert_eq!(network.counters().firings, 0, "{} fired without input {missing}", row.name);
                checked += 1;
            }
        }
    }
    assert!(checked > 100, "{checked}");
}

#[test]
fn a_firing_takes_one_message_of_each_active_input_and_no_constant() {
    for row in rows().filter(|row| row.rule == Rule::All) {
        let Some(example) = row.examples.iter().find(|example| example.faults.is_empty()) else { continue };
        let size = (example.size > 0).then_some(example.size);
        let shape = row.shape(size).unwrap();
        let mut network = instance(row, size);
        // The first message to each input, then one more to each active one: the constants must still be there.
        let first = |input: u16| example.sends.iter().find(|(i, _)| *i == input).map(|(_, value)| *value);
        for input in (1..=shape.inputs).rev() {
            if let Some(value) = first(input) {
                send(&mut network, input, value);
            }
        }
        for input in 1..=shape.inputs {
            if let (true, Some(value)) = (network.port(FUNCTION, input).unwrap().is_active(), first(input)) {
                send(&mut network, input, value);
            }
        }
        assert_eq!(network.counters().firings, 2, "{}", row.name);
        for input in 1..=shape.inputs {
            let port = network.port(FUNCTION, input).unwrap();
            assert!(!port.is_active() || port.is_empty(), "{} left a message at {input}", row.name);
            assert!(port.is_active() || !port.is_wanting(), "{} lost its constant {input}", row.name);
        }
    }
}

#[test]
fn sizes_are_checked() {
    for row in rows() {
        assert!(
            row.shape(None).is_ok() != row.shape(Some(3)).is_ok() || row.family == crate::functions::Family::Device
        );
        assert!(row.shape(Some(0)).is_err() || row.family == crate::functions::Family::Device, "{}", row.name);
        assert!(row.shape(Some(128)).is_err() || row.family == crate::functions::Family::Device, "{}", row.name);
    }
}
