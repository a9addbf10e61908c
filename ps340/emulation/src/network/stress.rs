//! Random commands against the network: nothing panics, and its books stay right.

use super::*;
use crate::{
    functions::all,
    port::{Effect, Literal, ObjectId},
};
use proptest::prelude::*;
use protocol::Value;
use protocol::command::Input;

/// What a host may do.
#[derive(Clone, Debug)]
enum Act {
    Define(u32, usize, Option<u16>),
    Undefine(u32),
    Connect(u32, u16, u32, u32),
    Disconnect(u32, Option<u16>),
    Cness(u32, u32, bool),
    Send(u32, u32, usize, f64),
    Emit(u32, u16, usize, f64),
    Run(u64),
    Advance(u64),
}

fn act() -> impl Strategy<Value = Act> {
    let id = 0..6_u32;
    let number = prop_oneof![-3.0..3.0_f64, Just(0.0), Just(1e308), Just(f64::NAN), Just(f64::INFINITY), Just(-1e-308)];
    prop_oneof![
        2 => (id.clone(), any::<prop::sample::Index>(), prop::option::of(0..5_u16))
            .prop_map(|(id, row, size)| Act::Define(id, row.index(all().count()), size)),
        1 => id.clone().prop_map(Act::Undefine),
        4 => (id.clone(), 0..4_u16, id.clone(), 0..6_u32).prop_map(|(a, o, b, i)| Act::Connect(a, o, b, i)),
        1 => (id.clone(), prop::option::of(0..4_u16)).prop_map(|(a, o)| Act::Disconnect(a, o)),
        2 => (id.clone(), 0..7_u32, any::<bool>()).prop_map(|(a, i, constant)| Act::Cness(a, i, constant)),
        8 => (id.clone(), 0..7_u32, 0..12_usize, number.clone()).prop_map(|(a, i, k, n)| Act::Send(a, i, k, n)),
        1 => (id, 0..4_u16, 0..12_usize, number).prop_map(|(a, o, k, n)| Act::Emit(a, o, k, n)),
        3 => (0..300_u64).prop_map(Act::Run),
        1 => (0..50_u64).prop_map(Act::Advance),
    ]
}

fn value(kind: usize, n: f64) -> Value {
    match kind {
        0 => Literal::B(n > 0.0),
        1 => Literal::I(n as i32),
        2 => Literal::R(n),
        3 => Literal::S("PS 340"),
        4 => Literal::V2([n, 1.0]),
        5 => Literal::V3([n, 1.0, 2.0]),
        6 => Literal::V4([n, 1.0, 2.0, 3.0]),
        7 => Literal::M2([[n, 1.0]; 2]),
        8 => Literal::M3([[n, 1.0, 2.0]; 3]),
        9 => Literal::M43([[n, 1.0, 2.0]; 4]),
        10 => Literal::M4([[n, 1.0, 2.0, 3.0]; 4]),
        _ => Literal::T([[n, 1.0, 2.0, 3.0]; 4]),
    }
    .value()
}

/// Carries the acts out on an empty network; everything that came out.
fn perform(acts: &[Act], mut network: Network) -> (Network, Vec<Effect>) {
    let (mut effects, mut frame) = (Vec::new(), 0);
    for act in acts {
        match *act {
            Act::Define(id, row, size) => drop(network.define(ObjectId(id), all().nth(row).unwrap(), size)),
            Act::Undefine(id) => network.undefine(ObjectId(id)),
            Act::Connect(a, o, b, i) => drop(network.connect(ObjectId(a), o, ObjectId(b), Input::Number(i))),
            Act::Disconnect(a, o) => network.disconnect(ObjectId(a), o, None),
            Act::Cness(a, i, constant) => drop(network.setup_cness(ObjectId(a), Input::Number(i), constant)),
            Act::Send(a, i, k, n) => network.send(ObjectId(a), Input::Number(i), value(k, n), &mut effects),
            Act::Emit(a, o, k, n) => network.emit(ObjectId(a), o, value(k, n), &mut effects),
            Act::Run(budget) => drop(network.run(budget, &mut effects)),
            Act::Advance(frames) => {
                frame += frames;
                network.advance(frame, frame, &mut effects);
            }
        }
        assert_eq!(network.audit(), Ok(()), "{act:?}");
    }
    (network, effects)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_networks_keep_their_books_and_send_finite_values(acts in prop::collection::vec(act(), 1..120)) {
        let (mut network, effects) = perform(&acts, Network::new());
        for effect in &effects {
            if let Effect::Deliver { value, .. } = effect {
                prop_assert!(value.is_finite());
            }
        }
        let (_, again) = perform(&acts, Network::new());
        prop_assert_eq!(&effects, &again, "the same acts give the same effects");
        let mut watched = Network::new();
        watched.count_activity(true);
        watched.trace(Traced::Everything);
        let (watched, again) = perform(&acts, watched);
        prop_assert_eq!(effects, again, "who looks on changes nothing");
        prop_assert_eq!(network.counters(), watched.counters());
        for id in 0..6 {
            network.undefine(ObjectId(id));
        }
        prop_assert_eq!(network.string_bytes, 0);
        prop_assert_eq!(network.objects().count(), 0);
    }
}
