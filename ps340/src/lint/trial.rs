//! What a function sends: found by trying.
//!
//! A new instance gets messages in all combinations of the samples of its inputs; what leaves it is what it can send. A
//! kind that no trial shows is not held against anybody: an output that was silent in all trials may send anything.

use super::program::Function;
use crate::{
    functions::FunctionRow,
    network::Network,
    port::{Cause, Effect, Fault, KindSet, Literal, ObjectId, PickLiteral, QueueRole},
};
use protocol::{Kind, Value, command::Input};

/// Most combinations of samples that are tried with one function.
const COMBINATIONS: usize = 400;
/// Firings that a trial may take.
const FIRINGS: u64 = 1000;
/// Steps of time that a clock gets, and how long each is: half a second.
const TICKS: u64 = 6;
const TICK_FRAMES: u64 = 30;
const TICK_CENTISECONDS: u64 = 50;
/// A pick list with everything in it.
const PICKED: PickLiteral = PickLiteral {
    index: 1,
    identifiers: &["A", "B"],
    node: "C",
    type_code: 1,
    point: Some(([0.5, 0.25, 0.0], 3)),
    parameter: None,
};
/// The function that is tried, and the first object of those that its outputs are connected to.
const FUNCTION: ObjectId = ObjectId(0);
const BEYOND: u32 = 1;

/// What the trials of a function showed.
#[derive(Clone, Debug)]
pub(super) struct Trials {
    /// The kinds that leave each output.
    pub(super) outputs: Vec<KindSet>,
    /// A fault that came in all trials, and nothing else.
    pub(super) always: Option<Fault>,
}

/// Tries a function.
///
/// - `inputs`: the samples of each input; those without stay empty.
pub(super) fn function(function: &Function, inputs: &[Vec<Value>]) -> Trials {
    let unknown = || Trials { outputs: vec![KindSet::ANY; usize::from(function.shape.outputs)], always: None };
    let size =
        |inputs: &[Vec<Value>]| inputs.iter().try_fold(1_usize, |n, samples| n.checked_mul(samples.len().max(1)));
    let fits = |inputs: &[Vec<Value>]| size(inputs).filter(|n| *n <= COMBINATIONS);
    let fewer: Vec<Vec<Value>>;
    let (inputs, count) = match fits(inputs) {
        Some(count) => (inputs, count),
        None => {
            fewer = inputs.iter().map(|samples| one_of_each_kind(samples)).collect();
            match fits(&fewer) {
                Some(count) => (&fewer[..], count),
                None => return unknown(),
            }
        }
    };
    let mut outputs = vec![KindSet::NONE; usize::from(function.shape.outputs)];
    let (mut always, mut clean) = (None, false);
    for number in 0..count {
        let mut rest = number;
        let chosen = inputs.iter().map(|samples| {
            let n = samples.len().max(1);
            let sample = samples.get(rest % n);
            rest /= n;
            sample
        });
        let Some(effects) = once(function, &chosen.collect::<Vec<_>>()) else { return unknown() };
        let mut fault = None;
        let mut sent = false;
        for effect in effects {
            match effect {
                Effect::Deliver { object, value, .. } if object.0 >= BEYOND => {
                    sent = true;
                    if let Some(kinds) = outputs.get_mut((object.0 - BEYOND) as usize) {
                        *kinds = kinds.or(KindSet::of(&[value.kind()]));
                    }
                }
                Effect::Fault { fault: found, .. } => {
                    if let Cause::Kind { .. } | Cause::Range { .. } = found.cause {
                        fault = Some(found);
                    }
                }
                _ => sent = true,
            }
        }
        clean |= sent || fault.is_none();
        always = always.or(fault);
    }
    for kinds in outputs.iter_mut().filter(|kinds| **kinds == KindSet::NONE) {
        *kinds = KindSet::ANY;
    }
    Trials { outputs, always: always.filter(|_| !clean) }
}

/// One trial: constants first, then the queues, twice; then time passes.
fn once(function: &Function, chosen: &[Option<&Value>]) -> Option<Vec<Effect>> {
    let mut network = Network::new();
    network.define(FUNCTION, function.row, function.size).ok()?;
    for output in 1..=function.shape.outputs {
        let to = ObjectId(BEYOND + u32::from(output) - 1);
        network.connect(FUNCTION, output, to, Input::Number(1)).ok()?;
    }
    let mut effects = Vec::new();
    let active =
        |input: u16| function.row.input(function.shape, input).is_some_and(|spec| spec.role == QueueRole::Active);
    for round in [false, true, true] {
        for (input, sample) in (1..).zip(chosen) {
            if let Some(sample) = sample.filter(|_| active(input) == round) {
                network.send(FUNCTION, Input::Number(u32::from(input)), sample.clone(), &mut effects);
            }
        }
        network.run(FIRINGS, &mut effects);
    }
    if function.row.clock.is_some() {
        for tick in 1..=TICKS {
            network.advance(tick * TICK_FRAMES, tick * TICK_CENTISECONDS, &mut effects);
            network.run(FIRINGS, &mut effects);
        }
    }
    Some(effects)
}

fn one_of_each_kind(samples: &[Value]) -> Vec<Value> {
    let first = |kind: Kind| samples.iter().find(|sample| sample.kind() == kind).cloned();
    Kind::ALL.into_iter().filter_map(first).collect()
}

/// Messages of a kind, the most usual first.
pub(super) fn samples(kind: Kind) -> Vec<Value> {
    use Literal::{B, I, Label, M2, M3, M4, M43, Pick, R, S, T, V2, V3, V4, Vectors};
    let square: [[f64; 4]; 4] =
        [[1.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 3.0, 0.0], [1.0, 2.0, 3.0, 1.0]];
    let literals: &[Literal] = match kind {
        Kind::Boolean => &[B(true), B(false)],
        Kind::Integer => &[I(1), I(2), I(0), I(-1), I(40)],
        Kind::Real => &[R(0.5), R(2.0), R(0.0), R(-1.0), R(40.0)],
        Kind::String => &[S("A"), S("1"), S("2.5 3"), S("TRUE")],
        Kind::Vector2 => &[V2([0.5, 0.25]), V2([0.0, 0.0])],
        Kind::Vector3 => &[V3([1.0, 2.0, 3.0]), V3([0.0, 0.0, 0.0])],
        Kind::Vector4 => &[V4([1.0, 2.0, 3.0, 1.0]), V4([0.0, 0.0, 0.0, 1.0])],
        Kind::Matrix2 => &[M2([[1.0, 0.0], [0.0, 2.0]])],
        Kind::Matrix3 => &[M3([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]])],
        Kind::Matrix4x3 => &[M43([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0], [1.0, 2.0, 3.0]])],
        Kind::Matrix4 => &[M4(square)],
        Kind::Transform => &[T(square)],
        Kind::Pick => &[Pick(PICKED), Pick(PickLiteral { type_code: 2, parameter: Some(0.5), ..PICKED })],
        Kind::Label => &[Label([1.0, 2.0, 3.0], "A", true)],
        Kind::Vectors => &[Vectors(&[(false, [1.0, 2.0, 3.0]), (true, [2.0, 2.0, 3.0])])],
    };
    literals.iter().map(Literal::value).collect()
}

/// Whether a function needs a message at an input before it fires.
pub(super) fn is_required(row: &FunctionRow, function: &Function, input: u16) -> bool {
    row.input(function.shape, input).is_some_and(|spec| matches!(spec.role, QueueRole::Active | QueueRole::Constant))
}

#[cfg(test)]
mod tests {
    use super::samples;
    use crate::{
        line::LineId,
        machine::{Input as Event, Machine, Settings},
        memory::MassMemory,
        structure::{Node, NodeFault},
    };
    use protocol::{
        Kind, Name,
        command::{Input, reference},
    };

    /// Gives samples of all kinds to an input; returns the kinds that it took, none if there is no such input. An input
    /// past the last element of a list takes nothing, and is not asked.
    fn taken(node: &Node, input: Input) -> Option<Vec<Kind>> {
        let elements = match node {
            Node::Vectors(vectors) => vectors.list.points.len(),
            Node::Labels(block) => block.labels.len(),
            _ => usize::MAX,
        };
        let input = match input {
            Input::Number(n) if n as usize > elements => Input::Last,
            input => input,
        };
        let mut exists = false;
        let takes = |kind: &Kind| {
            samples(*kind).into_iter().any(|value| {
                let mut memory = MassMemory::default();
                let id = memory.define_node(&Name::new("NODE").unwrap(), node.clone()).unwrap();
                let took = memory.accept(id, input, value);
                exists |= !matches!(took, Err(NodeFault::NoSuchInput { .. }));
                !matches!(took, Err(NodeFault::Kind { .. } | NodeFault::NoSuchInput { .. }))
            })
        };
        let kinds: Vec<Kind> = Kind::ALL.iter().copied().filter(takes).collect();
        exists.then_some(kinds)
    }

    #[test]
    fn nodes_take_what_they_say_that_they_take() {
        let mut machine = Machine::new(Settings::default());
        let line = LineId(1);
        let mut text = String::new();
        // Each row for itself: what one of them drops is not that of another.
        for row in reference::rows().filter(|row| !row.example.contains("BEGIN") && !row.example.contains("INIT")) {
            text.push_str(&format!("S{} := BEGIN_STRUCTURE\n", text.len()));
            for statement in row.example.split_inclusive(';') {
                text.push_str(&format!("N{}.X := {}\n", text.len(), statement.rsplit(":=").next().unwrap_or_default()));
            }
            text.push_str("END_STRUCTURE;\n!RESET;\n");
        }
        text.push_str("VARIABLE V;\n");
        machine.step([Event::Attach(line), Event::Bytes(line, text.into_bytes())], 0);
        let words = Input::WORDS.iter().map(|row| row.0);
        let inputs: Vec<Input> = (1..=5).map(Input::Number).chain(words).collect();
        let structures = &machine.memory().structures;
        let nodes = (0..structures.extent()).filter_map(|id| structures.node(crate::port::ObjectId::new(id)));
        let mut seen = std::collections::BTreeSet::new();
        for node in nodes.filter(|node| seen.insert(node.word())) {
            for input in &inputs {
                let says = node.takes(*input).map(|kinds| kinds.iter().collect::<Vec<_>>());
                assert_eq!(says, taken(node, *input), "{} {input}", node.word());
            }
        }
        assert!(seen.len() > 40, "{seen:?}");
    }
}
