//! Messages on their way: arrival, firing, delivery, and the passing of time.

use super::{Destination, MAX_STRING_BYTES, NO_SLOT, Network};
use crate::port::{Arrival, Cause, Effect, Elapsed, Fault, Firing, ObjectId, Port, Problem};
use protocol::{Kind, Value, command::Input};

/// Hundredths of a second in one tick of the system clock.
const CENTISECONDS_PER_TICK: u64 = 5;

/// Bytes of a string that cost as much of the budget as one message.
const BYTES_PER_UNIT: usize = 64;

/// What a run did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Ran {
    /// Firings.
    pub firings: u64,
    /// What of the budget was used; a single firing may exceed what was left.
    pub work: u64,
    /// Whether nothing is ready any more; false if the budget ended the run.
    pub idle: bool,
}

impl Network {
    /// Sends a message to an input, as if from a function.
    pub fn send(&mut self, to: ObjectId, input: Input, value: Value, effects: &mut Vec<Effect>) {
        if !value.is_finite() {
            let function = self.function(to).map_or("", |row| row.name);
            let fault = Fault { function, cause: Cause::Overflow };
            effects.push(Effect::Fault { object: to, fault });
            return;
        }
        self.deliver(Destination { object: to, input }, value, effects);
    }

    /// Sends a message from an output of an object: what a device does, or the answer to a request.
    ///
    /// A message from an output that is not connected, or does not exist, goes nowhere.
    pub fn emit(&mut self, from: ObjectId, output: u16, value: Value, effects: &mut Vec<Effect>) {
        if !value.is_finite() {
            let function = self.function(from).map_or("", |row| row.name);
            effects.push(Effect::Fault { object: from, fault: Fault { function, cause: Cause::Overflow } });
            return;
        }
        if let Some(slot) = self.slot(from) {
            self.distribute(slot, output, value, effects);
        } else {
            let arcs: Vec<_> = self.outside.get(&(from, output)).into_iter().flat_map(|arcs| arcs.iter()).collect();
            for arc in arcs {
                self.deliver(arc, value.clone(), effects);
            }
        }
    }

    /// Lets instances fire until none is ready or the budget is spent.
    ///
    /// - `budget`: units of work. A firing costs one for each message that it delivers, at least one, and one more
    ///   for every 64 bytes of their strings; so the budget bounds time and memory. The last firing may exceed it.
    pub fn run(&mut self, budget: u64, effects: &mut Vec<Effect>) -> Ran {
        let before = self.counters.firings;
        let mut work = 0;
        while work < budget {
            let Some(slot) = self.ready.pop_front() else { break };
            let instance = &mut self.instances[slot as usize];
            // The slot may have been vacated or occupied anew since.
            if std::mem::take(&mut instance.queued) && instance.is_ready() {
                work += self.fire(slot, effects);
            }
        }
        Ran { firings: self.counters.firings - before, work, idle: self.ready.is_empty() }
    }

    /// Lets the clocks advance to a time and send what is due.
    ///
    /// - `frame`: the number of the refresh frame; `centiseconds`: hundredths of a second. Time that runs backwards
    ///   counts as standing still.
    pub fn advance(&mut self, frame: u64, centiseconds: u64, effects: &mut Vec<Effect>) {
        let ticks = |centiseconds: u64| centiseconds / CENTISECONDS_PER_TICK;
        let elapsed = Elapsed {
            frames: frame.saturating_sub(self.frame),
            centiseconds: centiseconds.saturating_sub(self.centiseconds),
            ticks: ticks(centiseconds).saturating_sub(ticks(self.centiseconds)),
        };
        self.frame = self.frame.max(frame);
        self.centiseconds = self.centiseconds.max(centiseconds);
        for i in 0..self.clocks.len() {
            let slot = self.clocks[i];
            let instance = &self.instances[slot as usize];
            let Some(clock) = instance.row.clock else { continue };
            let (object, size, inputs) = (instance.object, instance.size, usize::from(instance.inputs));
            let ports = self.ports.get_mut(instance.ports);
            match clock(&mut Firing::new(object, size, ports, inputs, &mut self.outbox, effects), &elapsed) {
                Ok(0) => {}
                Ok(lost) => {
                    self.counters.lost += lost;
                    effects.push(Effect::Fault { object, fault: self.fault(slot, Cause::Late { lost }) });
                }
                Err(problem) => self.fail(slot, problem, effects),
            }
            self.deliver_outbox(slot, effects);
        }
    }

    /// Fires an instance once; returns the work done.
    #[inline]
    fn fire(&mut self, slot: u32, effects: &mut Vec<Effect>) -> u64 {
        self.counters.firings += 1;
        let instance = &mut self.instances[slot as usize];
        let inputs = usize::from(instance.inputs);
        let ports = self.ports.get_mut(instance.ports);
        let remembered = |ports: &[Port]| ports[inputs..].iter().map(Port::string_bytes).sum::<usize>();
        let strings = instance.strings;
        let leaving = if strings { ports[..inputs].iter().map(Port::leaving_bytes).sum() } else { 0 };
        let before = if strings { remembered(ports) } else { 0 };
        let mut firing = Firing::new(instance.object, instance.size, ports, inputs, &mut self.outbox, effects);
        let outcome = (instance.row.behaviour)(&mut firing);
        if strings {
            self.string_bytes = self.string_bytes + remembered(ports) - before;
        }
        match outcome {
            Ok(()) => {
                self.string_bytes -= leaving;
                instance.missing += consume(&mut ports[..inputs]);
            }
            Err(problem) => self.fail(slot, problem, effects),
        }
        let instance = &mut self.instances[slot as usize];
        if instance.is_ready() {
            instance.queued = true;
            self.ready.push_back(slot);
        }
        self.deliver_outbox(slot, effects)
    }

    /// Reports why an instance could not fire, and removes what stood in the way: the message of a wrong kind, or
    /// one message of each active input.
    #[cold]
    fn fail(&mut self, slot: u32, problem: Problem, effects: &mut Vec<Effect>) {
        self.outbox.clear();
        let instance = &mut self.instances[slot as usize];
        let ports = &mut self.ports.get_mut(instance.ports)[..usize::from(instance.inputs)];
        let last_active = || ports.iter().rposition(Port::is_active).map_or(1, |place| place as u16 + 1);
        let wrong_kind = match problem {
            Problem::Kind(input) => Some(input),
            Problem::Mismatch => Some(last_active()),
            _ => None,
        };
        let cause = match problem {
            Problem::Kind(_) | Problem::Mismatch => {
                let input = wrong_kind.unwrap_or(1);
                let kind = ports.get(usize::from(input) - 1).and_then(Port::first).map_or(Kind::Boolean, Value::kind);
                Cause::Kind { input, kind }
            }
            Problem::Range(input) => Cause::Range { input },
            Problem::DivisionByZero => Cause::DivisionByZero,
            Problem::Overflow => Cause::Overflow,
            Problem::Degenerate => Cause::Degenerate,
            Problem::TooLong => Cause::TooLong,
        };
        let removed = match wrong_kind.and_then(|input| ports.get_mut(usize::from(input) - 1)) {
            Some(port) if port.is_active() => std::slice::from_mut(port),
            _ => ports,
        };
        self.string_bytes -= removed.iter().map(Port::leaving_bytes).sum::<usize>();
        instance.missing += consume(removed);
        let object = instance.object;
        effects.push(Effect::Fault { object, fault: self.fault(slot, cause) });
    }

    fn fault(&self, slot: u32, cause: Cause) -> Fault {
        Fault { function: self.instances[slot as usize].row.name, cause }
    }

    /// Delivers the results of a firing in their order; returns the work done, at least 1.
    #[inline]
    fn deliver_outbox(&mut self, slot: u32, effects: &mut Vec<Effect>) -> u64 {
        let mut outbox = std::mem::take(&mut self.outbox);
        let mut work = 0;
        for (output, value) in outbox.drain(..) {
            work += self.distribute(slot, output, value, effects);
        }
        self.outbox = outbox;
        work.max(1)
    }

    /// Delivers a message along the arcs of an output, in the order of connection; returns the work done.
    #[inline]
    fn distribute(&mut self, slot: u32, output: u16, value: Value, effects: &mut Vec<Effect>) -> u64 {
        let run = self.instances[slot as usize].outputs;
        let place = usize::from(output).wrapping_sub(1);
        let Some(arcs) = self.outputs.get(run).get(place) else { return 0 };
        let units = match &value {
            Value::String(text) => 1 + (text.len() / BYTES_PER_UNIT) as u64,
            _ => 1,
        };
        match arcs.single() {
            Ok(arc) => {
                self.deliver(arc, value, effects);
                units
            }
            Err(count) => {
                for index in 0..count {
                    if let Some(arc) = self.outputs.get(run)[place].get(index) {
                        self.deliver(arc, value.clone(), effects);
                    }
                }
                units * count as u64
            }
        }
    }

    /// Lets a message arrive where an arc ends.
    #[inline]
    fn deliver(&mut self, Destination { object, input }: Destination, value: Value, effects: &mut Vec<Effect>) {
        self.counters.deliveries += 1;
        let slot = self.index.get(object.0 as usize).copied().unwrap_or(NO_SLOT);
        let Some(instance) = self.instances.get_mut(slot as usize) else {
            effects.push(Effect::Deliver { object, input, value });
            return;
        };
        let Some(place) = instance.input(input) else {
            return self.refuse(slot, Cause::NoSuchInput(input), effects);
        };
        let port = &mut self.ports.get_mut(instance.ports)[place];
        if !port.accepts(value.kind()) {
            let cause = Cause::Kind { input: place as u16 + 1, kind: value.kind() };
            return self.refuse(slot, cause, effects);
        }
        let arrival = match &value {
            Value::String(text) => {
                let replaced = if port.is_active() { 0 } else { port.string_bytes() };
                let bytes = self.string_bytes - replaced + text.len();
                if bytes <= MAX_STRING_BYTES {
                    let arrival = port.arrive(value);
                    if !matches!(arrival, Arrival::Lost(_)) {
                        self.string_bytes = bytes;
                    }
                    arrival
                } else {
                    port.lose()
                }
            }
            _ => {
                if !port.is_active() {
                    self.string_bytes -= port.string_bytes();
                }
                port.arrive(value)
            }
        };
        match arrival {
            Arrival::Kept => {}
            Arrival::Awaited => {
                instance.missing -= 1;
                if !instance.queued && instance.is_ready() {
                    instance.queued = true;
                    self.ready.push_back(slot);
                }
            }
            Arrival::Lost(lost) => self.lose(slot, place as u16 + 1, lost, effects),
        }
    }

    #[cold]
    fn refuse(&self, slot: u32, cause: Cause, effects: &mut Vec<Effect>) {
        let object = self.instances[slot as usize].object;
        effects.push(Effect::Fault { object, fault: self.fault(slot, cause) });
    }

    /// Counts a lost message; reports the first, tenth, hundredth and so on, so that reports are no flood.
    #[cold]
    fn lose(&mut self, slot: u32, input: u16, lost: u64, effects: &mut Vec<Effect>) {
        self.counters.lost += 1;
        if 10_u64.checked_pow(lost.ilog10()) == Some(lost) {
            self.refuse(slot, Cause::Flood { input, lost }, effects);
        }
    }
}

/// Removes one message from each active input that has one; returns how many of them are empty now.
#[inline]
fn consume(ports: &mut [Port]) -> u16 {
    let mut emptied = 0;
    for port in ports {
        if port.is_active() && !port.is_empty() {
            emptied += u16::from(port.consume());
        }
    }
    emptied
}
