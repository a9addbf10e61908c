//! One instance of a function.

use super::{Destination, pool::Run};
use crate::{
    functions::{FunctionRow, QueuePosition, Rule},
    port::KindSet,
    port::Port,
};
use protocol::command::Input;

/// What a missing constant counts in [`Instance::missing`]. More than all active inputs together, since no function
/// does without one.
const CONSTANT: u16 = 0x100;
/// What it counts that no input is active: such a function never fires. More than all constants together.
const PASSIVE: u16 = 0x8000;

/// One instance of a function, in the place of its object: its row, where its ports and arcs lie, and what it waits
/// for.
#[derive(Debug)]
pub(super) struct Instance {
    /// None for an object that is no function.
    pub(super) row: Option<&'static FunctionRow>,
    /// Inputs, then memory.
    pub(super) ports: Run,
    pub(super) outputs: Run,
    /// Where the only arc from output 1 ends, if there is exactly one: most functions have no other.
    pub(super) only_arc: Option<Destination>,
    /// Number of inputs among the ports.
    pub(super) inputs: u16,
    /// Number of inputs up to the last active one.
    pub(super) active: u8,
    /// The inputs, if it has two, one queue and one constant, and a row that can work in place.
    pub(super) in_place: Option<QueuePosition>,
    /// The n of a family.
    pub(super) size: u16,
    /// What it waits for: one for each active input without a message, much more for constants.
    pub(super) missing: u16,
    /// How much may be missing when it fires.
    pub(super) slack: u16,
    /// Whether an active input accepts values whose size the user decides.
    pub(super) strings: bool,
    /// Whether it stands in the list of those that are ready.
    pub(super) queued: bool,
}

impl Instance {
    /// An object that is no function: no inputs, never ready.
    pub(super) const VACANT: Instance = Instance {
        row: None,
        ports: Run::EMPTY,
        outputs: Run::EMPTY,
        only_arc: None,
        inputs: 0,
        active: 0,
        in_place: None,
        size: 0,
        missing: PASSIVE,
        slack: 0,
        strings: false,
        queued: false,
    };

    /// Whether it can fire.
    #[inline]
    pub(super) const fn is_ready(&self) -> bool {
        self.missing <= self.slack
    }

    /// The index among the ports of an input.
    #[inline]
    pub(super) fn input(&self, input: Input) -> Option<usize> {
        match input {
            Input::Number(n) if n.wrapping_sub(1) < u32::from(self.inputs) => Some(n as usize - 1),
            _ => None,
        }
    }

    /// Notes that the first message, or the constant, has arrived at an input.
    #[inline]
    pub(super) const fn note_arrival(&mut self, is_active: bool) {
        self.missing -= if is_active { 1 } else { CONSTANT };
    }

    /// Counts anew what it waits for.
    ///
    /// - `inputs`: its inputs as they are now.
    pub(super) fn count(&mut self, inputs: &[Port]) {
        let active = inputs.iter().filter(|port| port.is_active());
        let wanting = inputs.iter().filter(|port| port.is_wanting());
        self.active = inputs.iter().rposition(Port::is_active).map_or(0, |place| place as u8 + 1);
        self.in_place = match inputs {
            _ if self.row.is_none_or(|row| row.in_place.is_none()) => None,
            [first, second] if first.is_active() && !second.is_active() => Some(QueuePosition::MessageFirst),
            [first, second] if second.is_active() && !first.is_active() => Some(QueuePosition::ConstantFirst),
            _ => None,
        };
        let queues = active.clone().count() as u16;
        let any = self.row.is_some_and(|row| row.rule == Rule::Any);
        self.missing = wanting.map(|port| if port.is_active() { 1 } else { CONSTANT }).sum();
        self.missing += if queues == 0 { PASSIVE } else { 0 };
        self.slack = if any { queues.saturating_sub(1) } else { 0 };
        self.strings = active.clone().any(|port| KindSet::HEAVY.iter().any(|kind| port.accepts(kind)));
    }
}
