//! What the devices send: found by using each of them on a machine, once.

use crate::{
    line::LineId,
    machine::{Input, Machine, Settings, time_of_frame},
    operator::{parse, perform},
    port::KindSet,
};
use protocol::Name;
use std::{collections::HashMap, sync::LazyLock};

const LINE: LineId = LineId(1);

/// Everything that a person can do, in the words of the operator's line.
const USES: &[&str] = &[
    "mode interactive",
    "dial 1 0.1",
    "dial 2 0.1",
    "dial 3 0.1",
    "dial 4 0.1",
    "dial 5 0.1",
    "dial 6 0.1",
    "dial 7 0.1",
    "dial 8 0.1",
    "key 1",
    "button 1",
    "puck move 0.1 0.2",
    "puck press 1",
    "puck move 0.3 0.2",
    "puck release",
    "puck away",
    "type a",
];

/// The kinds of message that an output of an initial instance sends; none if the devices do not show it.
pub(super) fn kinds(instance: &str, output: u16) -> Option<KindSet> {
    static DEVICE_KINDS: LazyLock<HashMap<(String, u16), KindSet>> = LazyLock::new(use_all);
    DEVICE_KINDS.get(&(instance.to_owned(), output)).copied()
}

/// Uses every device, with a variable connected to each output of the initial instances, and looks what is in it.
fn use_all() -> HashMap<(String, u16), KindSet> {
    let mut machine = Machine::new(Settings::default());
    machine.step([Input::Attach(LINE)], 0);
    let memory = machine.memory();
    let ids: Vec<_> = memory.network.objects().collect();
    let mut outputs = Vec::new();
    for id in ids {
        let Some(row) = memory.network.function(id) else { continue };
        for output in 1..=row.outputs.len() as u16 {
            outputs.push((memory.objects.name(id).to_owned(), output));
        }
    }
    let mut text = String::new();
    for (number, (name, output)) in outputs.iter().enumerate() {
        text.push_str(&format!("VARIABLE SEEN{number}; CONNECT {name}<{output}>:<1>SEEN{number};\n"));
    }
    machine.step([Input::Bytes(LINE, text.into_bytes())], 0);
    for order in USES {
        if let Ok(order) = parse(order) {
            let _ = perform(&order, &mut machine, None);
        }
        let next = time_of_frame(machine.frame() + 1);
        machine.step([], next);
    }
    let seen = |number: usize| {
        let name = Name::new(format!("SEEN{number}")).ok()?;
        machine.memory().variable(&name).ok()?.map(|value| KindSet::of(&[value.kind()]))
    };
    outputs.iter().enumerate().filter_map(|(number, of)| Some((of.clone(), seen(number)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_send_what_the_manuals_say() {
        assert_eq!(kinds("DIALS", 8), Some(KindSet::of(&[protocol::Kind::Real])));
        assert_eq!(kinds("FKEYS", 1), Some(KindSet::INTEGER));
        assert_eq!(kinds("TABLETIN", 2), Some(KindSet::BOOLEAN));
        assert_eq!(kinds("TABLETIN", 6), Some(KindSet::VECTOR2));
        assert_eq!(kinds("KEYBOARD", 1), Some(KindSet::STRING));
        assert_eq!(kinds("ERROR", 1), None);
    }
}
