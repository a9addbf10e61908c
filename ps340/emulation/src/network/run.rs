//! Messages on their way: arrival, firing, delivery, and the passing of time.

use super::{
    Destination, MAX_STRING_BYTES, Network,
    observe::{ArcSource, Delivery, NoObserver, Observer},
};
use crate::port::{Arrival, Backlog, Cause, Effect, Elapsed, Fault, Firing, KindSet, ObjectId, Outbox, Port, Problem};
use protocol::{Kind, Value, command::Input};

/// Hundredths of a second in one tick of the system clock.
const CENTISECONDS_PER_TICK: u64 = 5;

/// Bytes of a string that cost as much of the budget as one message.
const BYTES_PER_UNIT: usize = 64;

/// What a run did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct RunReport {
    /// Firings.
    pub firings: u64,
    /// What of the budget was used; a single firing may exceed what was left.
    pub work: u64,
    /// Whether nothing is ready any more; false if the budget or a break ended the run.
    pub idle: bool,
    /// The function before whose firing the network stands still, if a person made it stop.
    pub stopped: Option<ObjectId>,
}

/// Calls a method with the observer as its last argument.
macro_rules! observed {
    ($network:ident.$method:ident($($argument:expr),*)) => {
        match $network.instruments.take() {
            None => $network.$method($($argument,)* &mut NoObserver),
            Some(mut instruments) => {
                let result = $network.$method($($argument,)* &mut *instruments);
                $network.instruments = Some(instruments);
                result
            }
        }
    };
}

impl Network {
    /// Sends a message to an input, as if from a function.
    pub fn send(&mut self, to: ObjectId, input: Input, mut value: Value, effects: &mut Vec<Effect>) {
        if !value.is_finite() {
            return effects.push(self.fault(to, Cause::Overflow));
        }
        observed!(self.deliver(None, Destination { object: to, input }, &mut value, effects));
    }

    /// Sends a message from an output of an object: what a device does, or the answer to a request.
    ///
    /// A message from an output that is not connected, or does not exist, goes nowhere.
    pub fn emit(&mut self, from: ObjectId, output: u16, mut value: Value, effects: &mut Vec<Effect>) {
        if !value.is_finite() {
            return effects.push(self.fault(from, Cause::Overflow));
        }
        let source = ArcSource { object: from, output };
        if self.instance(from).is_some() {
            observed!(self.distribute(source, &mut value, effects));
        } else {
            let arcs: Vec<_> = self.outside.get(&(from, output)).into_iter().flat_map(|arcs| arcs.iter()).collect();
            for arc in arcs {
                observed!(self.deliver(Some(source), arc, &mut value.clone(), effects));
            }
        }
    }

    /// Lets instances fire until none is ready, the budget is spent, or a break is met.
    ///
    /// - `budget`: units of work. A firing costs one for each message that it delivers, at least one, and one more
    ///   for every 64 bytes of their strings; so the budget bounds time and memory. The last firing may exceed it.
    pub fn run(&mut self, budget: u64, effects: &mut Vec<Effect>) -> RunReport {
        observed!(self.run_observed(budget, effects))
    }

    /// Lets the first ready instance fire, whatever stands in the way, and stops the network after it.
    ///
    /// - Returns which it was; none if none is ready.
    pub fn step_one(&mut self, effects: &mut Vec<Effect>) -> Option<ObjectId> {
        let mut outbox = self.outbox.take().unwrap_or_default();
        let first = self.next_ready();
        if let Some(object) = first {
            observed!(self.fire(object, &mut outbox, effects));
        }
        self.outbox = Some(outbox);
        self.hold();
        first
    }

    /// Lets the clocks advance to a time and send what is due. They stand still while the network is stopped.
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
        if !self.is_held() {
            observed!(self.advance_clocks(&elapsed, effects));
        }
    }

    fn run_observed<O: Observer>(&mut self, budget: u64, effects: &mut Vec<Effect>, observer: &mut O) -> RunReport {
        let before = self.counters.firings;
        let mut outbox = self.outbox.take().unwrap_or_default();
        let (mut work, mut stopped) = (0, None);
        while work < budget {
            if !O::IS_ACTIVE {
                work += self.run_in_place(budget - work, effects);
                if work == budget {
                    break;
                }
            }
            let Some(object) = self.next_ready() else { break };
            if observer.stops_before(object) {
                self.instances[object.index()].queued = true;
                self.ready.put_back(object);
                stopped = Some(object);
                break;
            }
            work += self.fire(object, &mut outbox, effects, observer);
        }
        self.outbox = Some(outbox);
        RunReport { firings: self.counters.firings - before, work, idle: self.ready.is_empty(), stopped }
    }

    /// Takes the first instance that is ready from the list.
    #[inline(always)]
    fn next_ready(&mut self) -> Option<ObjectId> {
        loop {
            let object = self.ready.pop_front()?;
            let instance = &mut self.instances[object.index()];
            instance.queued = false;
            // It may have become another one since, or lost what it had.
            if instance.is_ready() {
                return Some(object);
            }
        }
    }

    fn advance_clocks<O: Observer>(&mut self, elapsed: &Elapsed, effects: &mut Vec<Effect>, observer: &mut O) {
        let mut outbox = self.outbox.take().unwrap_or_default();
        for i in 0..self.clocks.len() {
            let object = self.clocks[i];
            let instance = &self.instances[object.index()];
            let Some(clock) = instance.row.and_then(|row| row.clock) else { continue };
            let (inputs, memory) = self.ports.get_mut(instance.ports).split_at_mut(usize::from(instance.inputs));
            match clock(
                &mut Firing::new(object, instance.size, inputs, memory, &mut outbox, effects, &mut self.string_bytes),
                elapsed,
            ) {
                Ok(0) => {}
                Ok(lost) => {
                    self.counters.lost += lost;
                    effects.push(self.fault(object, Cause::Late { lost }));
                }
                Err(problem) => {
                    outbox.clear();
                    self.fail(object, problem, effects, observer);
                }
            }
            if outbox.first().is_some() {
                observer.emits(object);
            }
            self.deliver_results(object, &mut outbox, effects, observer);
        }
        self.outbox = Some(outbox);
    }

    /// Fires an instance once; returns the work done.
    #[inline(always)]
    fn fire<O: Observer>(
        &mut self,
        object: ObjectId,
        outbox: &mut Outbox,
        effects: &mut Vec<Effect>,
        observer: &mut O,
    ) -> u64 {
        let instance = &mut self.instances[object.index()];
        let Some(row) = instance.row else { return 0 };
        self.counters.firings += 1;
        observer.fires(object);
        let (inputs, memory) = self.ports.get_mut(instance.ports).split_at_mut(usize::from(instance.inputs));
        let leaving = if instance.strings && self.string_bytes > 0 { leaving_bytes(inputs) } else { 0 };
        match (row.behaviour)(&mut Firing::new(
            object,
            instance.size,
            inputs,
            memory,
            outbox,
            effects,
            &mut self.string_bytes,
        )) {
            Ok(()) => {
                self.string_bytes -= leaving;
                let active = usize::from(instance.active);
                instance.missing += consume(&mut inputs[..active], &mut self.backlog);
            }
            Err(problem) => {
                outbox.clear();
                // What it took out before it failed is gone; the rest is counted as it is removed.
                self.string_bytes -= leaving - leaving_bytes(inputs);
                self.fail(object, problem, effects, observer);
            }
        }
        let instance = &mut self.instances[object.index()];
        if instance.is_ready() {
            instance.queued = true;
            self.ready.push_back(object);
        }
        self.deliver_results(object, outbox, effects, observer)
    }

    /// Reports why an instance could not fire, and removes what stood in the way: the message of a wrong kind, or
    /// one message of each active input.
    #[cold]
    fn fail<O: Observer>(&mut self, object: ObjectId, problem: Problem, effects: &mut Vec<Effect>, observer: &mut O) {
        observer.fails(object);
        let instance = &mut self.instances[object.index()];
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
        self.string_bytes -= leaving_bytes(removed);
        instance.missing += consume(removed, &mut self.backlog);
        effects.push(self.fault(object, cause));
    }

    /// Delivers the results of a firing in their order; returns the work done, at least 1.
    #[inline(always)]
    fn deliver_results<O: Observer>(
        &mut self,
        object: ObjectId,
        outbox: &mut Outbox,
        effects: &mut Vec<Effect>,
        observer: &mut O,
    ) -> u64 {
        let has_more = outbox.has_more();
        let Some((output, message)) = outbox.first() else { return 1 };
        let from = ArcSource { object, output: *output };
        // The common case first: one result, along one arc.
        if let (1, Some(arc), false, false) =
            (*output, self.instances[object.index()].only_arc, has_more, matches!(message, Value::String(_)))
        {
            self.deliver(Some(from), arc, message, effects, observer);
            outbox.note_delivery();
            return 1;
        }
        let mut work = self.distribute(from, message, effects, observer);
        for (output, message) in outbox.more() {
            work += self.distribute(ArcSource { object, output: *output }, message, effects, observer);
        }
        outbox.clear();
        work.max(1)
    }

    /// Delivers a message along the arcs of an output, in the order of connection; returns the work done.
    #[inline(never)]
    fn distribute<O: Observer>(
        &mut self,
        from: ArcSource,
        message: &mut Value,
        effects: &mut Vec<Effect>,
        observer: &mut O,
    ) -> u64 {
        let units = match message {
            Value::String(text) => 1 + (text.len() / BYTES_PER_UNIT) as u64,
            _ => 1,
        };
        let run = self.instances[from.object.index()].outputs;
        let place = usize::from(from.output).wrapping_sub(1);
        let count = self.outputs.get(run).get(place).map_or(0, |arcs| arcs.len());
        for index in 0..count {
            let Some(arc) = self.outputs.get(run)[place].get(index) else { break };
            let mut copy =
                if index + 1 < count { message.clone() } else { std::mem::replace(message, Value::Boolean(false)) };
            self.deliver(Some(from), arc, &mut copy, effects, observer);
        }
        units * count as u64
    }

    /// Delivers a message to where an arc ends. It is moved out of its slot.
    #[inline(always)]
    fn deliver<O: Observer>(
        &mut self,
        from: Option<ArcSource>,
        to: Destination,
        message: &mut Value,
        effects: &mut Vec<Effect>,
        observer: &mut O,
    ) {
        self.counters.deliveries += 1;
        let copy = observer.copy(from, to, message);
        let outcome = self.arrive(to, message, effects);
        if O::IS_ACTIVE {
            let outcome = match outcome {
                Delivery::Arrived { .. } => Delivery::Arrived { waiting: self.waiting(to) },
                other => other,
            };
            observer.delivered(from, to, copy, outcome);
        }
    }

    /// Lets a message arrive at an input. How many wait there is not counted.
    #[inline(always)]
    fn arrive(&mut self, to: Destination, message: &mut Value, effects: &mut Vec<Effect>) -> Delivery {
        let Some(instance) = self.instances.get_mut(to.object.index()) else {
            return self.stray(to, message, effects);
        };
        let Some(place) = instance.input(to.input) else {
            return self.stray(to, message, effects);
        };
        let port = &mut self.ports.get_mut(instance.ports)[place];
        let kind = message.kind();
        if !port.accepts(kind) {
            return self.refuse(to.object, Cause::Kind { input: place as u16 + 1, kind }, effects);
        }
        let arrival = if KindSet::HEAVY.contains(kind) || (self.string_bytes > 0 && !port.is_active()) {
            arrive_with_strings(port, message, &mut self.backlog, &mut self.string_bytes)
        } else {
            port.arrive(message, &mut self.backlog)
        };
        match arrival {
            Arrival::Queued => {}
            Arrival::Awaited => {
                instance.note_arrival(port.is_active());
                if !instance.queued && instance.is_ready() {
                    instance.queued = true;
                    self.ready.push_back(to.object);
                }
            }
            Arrival::Lost => return self.lose(to.object, place as u16 + 1, effects),
        }
        Delivery::Arrived { waiting: 0 }
    }

    /// Puts an instance at the end of the list if it is ready and not there yet.
    pub(super) fn queue_if_ready(&mut self, object: ObjectId) {
        let instance = &mut self.instances[object.index()];
        if !instance.queued && instance.is_ready() {
            instance.queued = true;
            self.ready.push_back(object);
        }
    }

    /// A message for an object that is no function, or for an input that the function does not have.
    #[inline(never)]
    fn stray(&mut self, to: Destination, message: &mut Value, effects: &mut Vec<Effect>) -> Delivery {
        if self.instance(to.object).is_some() {
            return self.refuse(to.object, Cause::NoSuchInput(to.input), effects);
        }
        let value = std::mem::replace(message, Value::Boolean(false));
        effects.push(Effect::Deliver { object: to.object, input: to.input, value });
        Delivery::Left
    }

    /// Counts a lost message; reports the first, tenth, hundredth and so on, so that reports are no flood.
    #[cold]
    pub(super) fn lose(&mut self, object: ObjectId, input: u16, effects: &mut Vec<Effect>) -> Delivery {
        self.counters.lost += 1;
        let lost = self.lost.entry((object, input)).or_default();
        *lost += 1;
        let lost = *lost;
        if 10_u64.checked_pow(lost.ilog10()) == Some(lost) {
            effects.push(self.fault(object, Cause::Flood { input, lost }));
        }
        Delivery::Lost
    }

    #[cold]
    fn refuse(&self, object: ObjectId, cause: Cause, effects: &mut Vec<Effect>) -> Delivery {
        effects.push(self.fault(object, cause));
        Delivery::Refused
    }

    #[cold]
    fn fault(&self, object: ObjectId, cause: Cause) -> Effect {
        let function = self.function(object).map_or("", |row| row.name);
        Effect::Fault { object, fault: Fault { function, cause } }
    }
}

/// Lets a message arrive where values of any size are involved, whose bytes are counted and limited.
#[cold]
fn arrive_with_strings(port: &mut Port, message: &mut Value, backlog: &mut Backlog, bytes: &mut usize) -> Arrival {
    let replaced = if port.is_active() { 0 } else { port.string_bytes(backlog) };
    let added = message.heap_bytes();
    if added > 0 && *bytes - replaced + added > MAX_STRING_BYTES {
        return Arrival::Lost;
    }
    let arrival = port.arrive(message, backlog);
    if arrival != Arrival::Lost {
        *bytes = *bytes - replaced + added;
    }
    arrival
}

/// Bytes of the strings that the next firing consumes.
#[cold]
fn leaving_bytes(inputs: &[Port]) -> usize {
    inputs.iter().map(Port::leaving_bytes).sum()
}

/// Removes one message from each active input that has one; returns how many of them are empty now.
#[inline(always)]
fn consume(ports: &mut [Port], backlog: &mut Backlog) -> u16 {
    let mut emptied = 0;
    for port in ports {
        if port.is_active() && !port.is_empty() {
            emptied += u16::from(port.consume(backlog));
        }
    }
    emptied
}
