//! Random commands for property tests.

pub(super) mod basic;
mod data;

pub use super::operate::operates;
pub use basic::{names, reals, singles};
pub use data::{objects, vector_lists};

use super::syntax::{Arc, Command, Destination, Initialize, Input, NamePattern, Object};
use crate::Value;
use basic::{matrices2, matrices3, matrices4, matrices4x3, rows, texts, vectors2, vectors3};
use glam::DVec4;
use proptest::prelude::*;

/// Values of every kind.
pub fn values() -> impl Strategy<Value = Value> {
    prop_oneof![
        any::<bool>().prop_map(Value::Boolean),
        any::<i32>().prop_map(Value::Integer),
        reals().prop_map(Value::Real),
        texts().prop_map(Value::String),
        vectors2().prop_map(Value::Vector2),
        vectors3().prop_map(Value::Vector3),
        rows::<4>().prop_map(|v| Value::Vector4(DVec4::from_array(v))),
        matrices2().prop_map(|m| Value::Matrix2(Box::new(m))),
        matrices3().prop_map(|m| Value::Matrix3(Box::new(m))),
        matrices4x3().prop_map(|m| Value::Matrix4x3(Box::new(m))),
        matrices4().prop_map(|m| Value::Matrix4(Box::new(m))),
        matrices4().prop_map(|m| Value::Transform(Box::new(m))),
    ]
}

/// Inputs by number and by word.
pub fn inputs() -> impl Strategy<Value = Input> {
    let word = prop::sample::select(Input::WORDS.map(|row| row.0).to_vec());
    prop_oneof![(1_u32..20).prop_map(Input::Number), (1..=u32::MAX).prop_map(Input::Number), word]
}

/// Inputs of named objects.
pub fn destinations() -> impl Strategy<Value = Destination> {
    (inputs(), names()).prop_map(|(input, name)| Destination { input, name })
}

/// Commands of every kind.
pub fn commands() -> impl Strategy<Value = Command> {
    let definition = (names(), prop::bool::weighted(0.7), objects()).prop_map(|(name, named, object)| {
        // An alias without a name would be no command.
        let named = named || matches!(object, Object::Alias(_));
        Command::Define { name: Some(name).filter(|_| named), object }
    });
    prop_oneof![
        4 => definition,
        1 => editing(),
        1 => network(),
        1 => system(),
    ]
}

/// Commands that edit structures and names.
fn editing() -> impl Strategy<Value = Command> {
    let prefix = prop_oneof![Just(String::new()), names().prop_map(|name| name.as_str().to_owned())];
    let pattern = prop_oneof![names().prop_map(NamePattern::Name), prefix.prop_map(NamePattern::Prefix)];
    let initialize =
        prop::sample::select(vec![Initialize::All, Initialize::Connections, Initialize::Displays, Initialize::Names]);
    prop_oneof![
        1 => Just(Command::EndStructure),
        1 => Just(Command::EndFont),
        1 => Just(Command::Begin),
        1 => Just(Command::End),
        2 => data::font_characters().prop_map(Command::FontCharacter),
        1 => names().prop_map(Command::Display),
        1 => names().prop_map(Command::Remove),
        1 => names().prop_map(Command::RemovePrefix),
        1 => names().prop_map(Command::RemoveFollower),
        1 => names().prop_map(Command::Forget),
        1 => names().prop_map(Command::ForgetUnit),
        1 => names().prop_map(Command::ErasePattern),
        1 => (names(), names()).prop_map(|(name, into)| Command::Include { name, into }),
        1 => (names(), names()).prop_map(|(name, from)| Command::RemoveFrom { name, from }),
        1 => (names(), names()).prop_map(|(name, pattern)| Command::PatternWith { name, pattern }),
        2 => (names(), operates()).prop_map(|(name, operate)| Command::Prefix { name, operate }),
        2 => (names(), operates()).prop_map(|(name, operate)| Command::Follow { name, operate }),
        1 => prop::collection::vec(pattern, 1..4).prop_map(Command::Delete),
        1 => initialize.prop_map(Command::Initialize),
    ]
}

/// Connections and messages.
fn network() -> impl Strategy<Value = Command> {
    prop_oneof![
        2 => (names(), 1..=u16::MAX, destinations())
            .prop_map(|(source, output, destination)| Command::Connect(Arc { source, output, destination })),
        1 => (names(), 1..=u16::MAX, prop::collection::vec(destinations(), 2..5))
            .prop_map(|(source, output, destinations)| Command::ConnectSeveral { source, output, destinations }),
        2 => (names(), prop::option::of(1..=u16::MAX), prop::option::of(destinations()))
            .prop_map(|(source, output, destination)| Command::Disconnect { source, output, destination }),
        4 => (values(), destinations()).prop_map(|(value, destination)| Command::Send { value, destination }),
        1 => (names(), destinations()).prop_map(|(list, destination)| Command::SendVectors { list, destination }),
        1 => (any::<u32>(), any::<bool>(), destinations())
            .prop_map(|(count, lines, destination)| Command::SendMarks { count, lines, destination }),
        1 => (names(), destinations())
            .prop_map(|(variable, destination)| Command::SendVariable { variable, destination }),
        1 => prop::collection::vec(names(), 1..4).prop_map(Command::Variable),
        1 => (any::<bool>(), destinations())
            .prop_map(|(constant, destination)| Command::SetupCness { constant, destination }),
    ]
}

/// Commands to the system.
fn system() -> impl Strategy<Value = Command> {
    let value = prop_oneof![
        Just(String::new()),
        "[A-Z][A-Z0-9_]{0,5}",
        "[0-9]{1,6}",
        "[ -~]{0,8}",
        any::<String>().prop_filter("short", |text| text.len() < 200),
    ];
    prop_oneof![
        any::<u32>().prop_map(Command::ReserveWorkingStorage),
        names().prop_map(Command::Reboot),
        names().prop_map(Command::Configure),
        names().prop_map(Command::SetupPassword),
        names().prop_map(Command::ShowInterface),
        (names(), prop::collection::vec((names(), value), 0..4))
            .prop_map(|(port, options)| Command::SetupInterface { port, options }),
        prop::sample::select(vec![
            Command::OptimizeStructure,
            Command::EndOptimize,
            Command::OptimizeMemory,
            Command::CommandStatus,
            Command::FinishConfiguration,
            Command::ShowInterrupts,
            Command::GiveUpCpu,
            Command::AllowVecnorm,
            Command::Reset,
        ]),
    ]
}
