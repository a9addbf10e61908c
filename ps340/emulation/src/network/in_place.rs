//! The short way of the commonest firing: a queue and a constant, one result, one arc.

use super::Network;
use crate::{
    functions::QueuePosition,
    port::{Arrival, Effect, ObjectId},
};

/// The reason why the short way ends before its budget.
enum End {
    /// What comes next goes the long way, or nothing is ready.
    LongWay,
    /// A message was lost at a full input, counted from 0.
    Lost(ObjectId, usize),
}

impl Network {
    /// Fires the first of those that are ready, one after the other, as long as their results are worked out where
    /// the messages lie and move from there along an only arc, to another function or out of the network.
    ///
    /// What happens is what happens with any other firing, in the same order, in half the steps.
    ///
    /// - `budget`: most firings.
    /// - Returns how many fired.
    pub(super) fn run_in_place(&mut self, budget: u64, effects: &mut Vec<Effect>) -> u64 {
        let before = self.counters.firings;
        while let fired = self.counters.firings - before
            && let End::Lost(object, place) = self.run_until_lost(budget - fired, effects)
        {
            self.lose(object, place as u16 + 1, effects);
        }
        self.counters.firings - before
    }

    /// Does the same until a message is lost at a full queue.
    #[inline(never)]
    fn run_until_lost(&mut self, budget: u64, effects: &mut Vec<Effect>) -> End {
        let Network { instances, ports, backlog, ready, string_bytes, counters, .. } = self;
        let instances = instances.as_mut_slice();
        let ports = ports.items();
        let mut end = End::LongWay;
        let mut fired = 0;
        while fired < budget && matches!(end, End::LongWay) {
            let Some(object) = ready.first() else { break };
            let Some(source) = instances.get(object.index()) else { break };
            let (Some(order), Some(arc), Some(row)) = (source.in_place, source.only_arc, source.row) else { break };
            let (Some(in_place), true) = (row.in_place, source.is_ready()) else { break };
            let inputs = source.ports.range().start;
            let (message, constant) = match order {
                QueuePosition::MessageFirst => (inputs, inputs + 1),
                QueuePosition::ConstantFirst => (inputs + 1, inputs),
            };
            // An arc from an instance to itself is of another sort.
            let pair = instances.get_disjoint_mut([object.index(), arc.object.index()]);
            let Ok([source, target]) = pair else { break };
            let mut arrival = Arrival::Queued;
            let queue = if let Some(place) = target.input(arc.input) {
                let places = [message, constant, target.ports.range().start + place];
                let Ok([queue, constant, port]) = ports.get_disjoint_mut(places) else { break };
                let (Some(message), Some(constant)) = (queue.first_mut(), constant.first()) else { break };
                if !port.accepts(message.kind())
                    || (*string_bytes > 0 && !port.is_active())
                    || !in_place(message, constant, order)
                {
                    break;
                }
                arrival = port.arrive(message, backlog);
                match arrival {
                    Arrival::Awaited => target.note_arrival(port.is_active()),
                    Arrival::Lost => end = End::Lost(arc.object, place),
                    Arrival::Queued => {}
                }
                queue
            } else if target.row.is_none() {
                let Ok([queue, constant]) = ports.get_disjoint_mut([message, constant]) else { break };
                let (Some(message), Some(constant)) = (queue.first_mut(), constant.first()) else { break };
                if !in_place(message, constant, order) {
                    break;
                }
                effects.push(Effect::Deliver { object: arc.object, input: arc.input, value: queue.take() });
                queue
            } else {
                break;
            };
            fired += 1;
            ready.drop_first();
            if queue.consume(backlog) {
                source.missing += 1;
                source.queued = false;
            } else {
                ready.push_back(object);
            }
            if arrival == Arrival::Awaited && !target.queued && target.is_ready() {
                target.queued = true;
                ready.push_back(arc.object);
            }
        }
        counters.firings += fired;
        counters.deliveries += fired;
        end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        functions::{all, find},
        network::NetworkCounters,
        port::{
            Literal::{self, I, M4, R},
            MAX_QUEUE,
        },
    };
    use protocol::command::Input;

    const F: ObjectId = ObjectId(1);
    const NEXT: ObjectId = ObjectId(2);
    const BEYOND: ObjectId = ObjectId(3);

    /// A network of two functions, F and NEXT, whose first outputs have the arcs named.
    fn pair(rows: [&str; 2], arcs: &[(ObjectId, ObjectId, u32)]) -> Network {
        let mut network = Network::new();
        for (id, name) in [F, NEXT].into_iter().zip(rows) {
            network.define(id, find(name).unwrap(), None).unwrap();
        }
        for &(from, to, input) in arcs {
            network.connect(from, 1, to, Input::Number(input)).unwrap();
        }
        network
    }

    /// What comes of messages for F, by the short way or, since an observer is there, by the long one.
    fn outcome(mut network: Network, sends: &[(u32, Literal)], watched: bool) -> (Vec<Effect>, NetworkCounters) {
        let mut effects = Vec::new();
        network.count_activity(watched);
        for &(input, value) in sends {
            network.send(F, Input::Number(input), value.value(), &mut effects);
        }
        network.run(40_000, &mut effects);
        assert_eq!(network.audit(), Ok(()));
        (effects, network.counters())
    }

    fn assert_same(make: impl Fn() -> Network, sends: &[(u32, Literal)]) {
        assert_eq!(outcome(make(), sends, false), outcome(make(), sends, true), "{sends:?}");
    }

    #[test]
    fn the_short_way_gives_what_the_long_way_gives_to_the_bit() {
        let a = M4([[0.1, 2.0, -0.3, 1e-9], [0.7, 1e5, 5.0, 0.0], [2.0, 1.0 / 3.0, 1.0, 0.0], [3.0, 4.0, 5.0, 1.0]]);
        let values =
            [R(0.1), R(-3.7e5), R(1.7e308), I(3), a, M4([[1.1, 0.3, 7.0, -1.0 / 7.0]; 4]), M4([[1e200; 4]; 4])];
        let arcs = [(F, NEXT, 1), (NEXT, BEYOND, 1)];
        let mut tried = 0;
        for row in all().filter(|row| row.in_place.is_some()) {
            for constant in 1..=2 {
                let make = || {
                    let mut network = pair([row.name, "NOP"], &arcs);
                    network.setup_cness(F, Input::Number(constant), true).unwrap();
                    network.setup_cness(F, Input::Number(3 - constant), false).unwrap();
                    network
                };
                for fixed in values {
                    let messages = values.iter().map(|message| (3 - constant, *message));
                    let sends: Vec<_> = std::iter::once((constant, fixed)).chain(messages).collect();
                    assert_same(make, &sends);
                    tried += 1;
                }
            }
        }
        assert_eq!(tried, 8 * 2 * values.len());
    }

    #[test]
    fn full_queues_and_arcs_that_lead_back_are_treated_as_by_the_long_way() {
        let reals: Vec<_> = std::iter::once((2, R(1.0))).chain((0..3).map(|i| (1, R(f64::from(i))))).collect();
        assert_same(|| pair(["ADDC", "NOP"], &[(F, F, 1)]), &reals);
        assert_same(|| pair(["ADDC", "NOP"], &[(F, F, 2)]), &reals);
        assert_same(|| pair(["ADDC", "ADDC"], &[(F, NEXT, 1), (NEXT, F, 1)]), &reals);
        // The second function waits for its constant, so all that arrives stays.
        let full = || {
            let mut network = pair(["ADDC", "ADDC"], &[(F, NEXT, 1)]);
            let mut effects = Vec::new();
            for _ in 1..MAX_QUEUE {
                network.send(NEXT, Input::Number(1), R(0.0).value(), &mut effects);
            }
            network
        };
        assert_same(full, &reals);
        assert_eq!(outcome(full(), &reals, false).1.lost, 2);
    }
}
