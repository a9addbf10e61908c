//! The network: instances of functions, arcs between them, and the list of those that are ready to fire.
//!
//! One FIFO of ready instances: the head fires once and goes to the end if it is still ready; then its results
//! arrive at their destinations, in the order of the outputs and of the connections. A firing takes nothing but
//! messages that are there, so loops are no recursion and need no stack; a budget bounds each run.
//!
//! Used: the execution model of the manuals. Modelled: queues, constants, faults, re-instancing. Not modelled:
//! the time that a function took on the machine's own processor.

mod arcs;
mod instance;
mod pool;
mod run;

#[cfg(test)]
mod clock_tests;
#[cfg(test)]
mod contract;
#[cfg(test)]
mod stress;
#[cfg(test)]
mod tests;

pub use arcs::{Destination, MAX_ARCS};
pub use run::Ran;

use crate::{
    functions::{FunctionRow, Rule, SizeError},
    port::{Cause, Fault, ObjectId, Port},
};
use arcs::Output;
use instance::Instance;
use pool::{Pool, Run};
use protocol::{Kind, Value, command::Input};
use std::collections::{BTreeMap, VecDeque};

/// Most bytes of strings that wait in a network; messages beyond are lost, counted and reported. Ours.
pub const MAX_STRING_BYTES: usize = 64 << 20;

/// The place in the index of an object that is no function.
const NO_SLOT: u32 = u32::MAX;

/// Instances of functions and the arcs between them.
#[derive(Debug)]
pub struct Network {
    /// The slot of each object, [`NO_SLOT`] for one that is no function.
    index: Vec<u32>,
    instances: Vec<Instance>,
    free: Vec<u32>,
    ports: Pool<Port>,
    outputs: Pool<Output>,
    /// Arcs that leave objects that are no functions (yet), by object and output.
    outside: BTreeMap<(ObjectId, u16), Output>,
    ready: VecDeque<u32>,
    /// Slots of the clocks, in the order of their instancing.
    clocks: Vec<u32>,
    outbox: Vec<(u16, Value)>,
    string_bytes: usize,
    counters: Counters,
    frame: u64,
    centiseconds: u64,
}

/// What a network did since it was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counters {
    /// Firings.
    pub firings: u64,
    /// Messages that arrived at an input or left as an effect.
    pub deliveries: u64,
    /// Messages lost because a queue was full.
    pub lost: u64,
}

impl Default for Network {
    fn default() -> Network {
        Network::new()
    }
}

impl Network {
    /// An empty network at time 0.
    pub const fn new() -> Network {
        Network {
            index: Vec::new(),
            instances: Vec::new(),
            free: Vec::new(),
            ports: Pool::new(),
            outputs: Pool::new(),
            outside: BTreeMap::new(),
            ready: VecDeque::new(),
            clocks: Vec::new(),
            outbox: Vec::new(),
            string_bytes: 0,
            counters: Counters { firings: 0, deliveries: 0, lost: 0 },
            frame: 0,
            centiseconds: 0,
        }
    }

    /// Makes an object an instance of a function: queues empty, constants at their defaults.
    ///
    /// Of an instance that exists, queues and constants are emptied and the connections *from* it go; those *to* it
    /// stay. Connections from an object that was no function before stay too.
    ///
    /// - `size`: the n of F:NAME(n).
    ///
    /// # Errors
    /// [`SizeError`] if n is missing, unexpected or out of range; nothing changes then.
    pub fn define(&mut self, id: ObjectId, row: &'static FunctionRow, size: Option<u16>) -> Result<(), SizeError> {
        let shape = row.shape(size)?;
        self.undefine_instance(id);
        let inputs = (1..=shape.inputs).filter_map(|input| row.input(shape, input)).map(Port::new).collect::<Vec<_>>();
        let active = inputs.iter().filter(|port| port.is_active()).count() as u16;
        let wanting = inputs.iter().filter(|port| port.is_wanting()).count() as u16;
        let strings = inputs.iter().any(|port| port.is_active() && port.accepts(Kind::String));
        let memory = std::iter::repeat_with(|| Port::UNUSED).take(usize::from(row.memory));
        let ports = self.ports.store(inputs.into_iter().chain(memory).collect::<Vec<_>>().into_iter());
        let outputs = (1..=shape.outputs).map(|output| self.outside.remove(&(id, output)).unwrap_or_default());
        let outputs = self.outputs.store(outputs.collect::<Vec<_>>().into_iter());
        let (Some(ports), Some(outputs)) = (ports, outputs) else {
            return Err(SizeError::OutOfRange(row.name, shape.size));
        };
        let instance = Instance {
            object: id,
            row,
            ports,
            outputs,
            inputs: shape.inputs,
            size: shape.size,
            // A function without active inputs never fires.
            missing: wanting + u16::from(active == 0),
            slack: if row.rule == Rule::Any { active.saturating_sub(1) } else { 0 },
            strings,
            queued: false,
        };
        self.string_bytes += self.ports.get(instance.ports).iter().map(Port::string_bytes).sum::<usize>();
        let slot = self.occupy(id, instance);
        if row.clock.is_some() {
            self.clocks.push(slot);
        }
        Ok(())
    }

    /// Puts an instance into a slot of its own.
    fn occupy(&mut self, id: ObjectId, instance: Instance) -> u32 {
        let slot = match self.free.pop() {
            Some(slot) => {
                self.instances[slot as usize] = instance;
                slot
            }
            None => {
                self.instances.push(instance);
                self.instances.len() as u32 - 1
            }
        };
        let place = id.0 as usize;
        if place >= self.index.len() {
            self.index.resize(place + 1, NO_SLOT);
        }
        self.index[place] = slot;
        slot
    }

    /// Ends an instance, with its messages and the connections from it. Connections to it stay.
    ///
    /// Harmless for an object that is no function.
    pub fn undefine(&mut self, id: ObjectId) {
        self.undefine_instance(id);
        self.drop_outside(id, |_| true);
    }

    fn undefine_instance(&mut self, id: ObjectId) {
        let Some(slot) = self.slot(id) else { return };
        let instance = &mut self.instances[slot as usize];
        let (ports, outputs, clock) = (instance.ports, instance.outputs, instance.row.clock.is_some());
        *instance = Instance::vacant();
        self.string_bytes -= self.ports.get(ports).iter().map(Port::string_bytes).sum::<usize>();
        self.ports.release(ports, || Port::UNUSED);
        self.outputs.release(outputs, Output::default);
        if clock {
            self.clocks.retain(|&clock| clock != slot);
        }
        self.index[id.0 as usize] = NO_SLOT;
        self.free.push(slot);
    }

    /// Adds an arc. One that exists already stays single.
    ///
    /// A source that is no function may be connected: the arc works when it becomes one, and for what the machine
    /// sends from it with [`emit`](Self::emit).
    ///
    /// # Errors
    /// A fault if the source has no such output, the destination no such input, or the output too many arcs.
    pub fn connect(&mut self, source: ObjectId, output: u16, to: ObjectId, input: Input) -> Result<(), Fault> {
        if let Some(target) = self.instance(to)
            && target.input(input).is_none()
        {
            return Err(Fault { function: target.row.name, cause: Cause::NoSuchInput(input) });
        }
        let function = self.instance(source).map_or("", |instance| instance.row.name);
        let Some(arcs) = self.output_mut(source, output) else {
            return Err(Fault { function, cause: Cause::NoSuchOutput(output) });
        };
        if arcs.connect(Destination { object: to, input }) {
            Ok(())
        } else {
            Err(Fault { function, cause: Cause::TooManyArcs { output } })
        }
    }

    /// Removes the arcs that leave a source: all, those of an output, those to a destination, or one.
    ///
    /// Harmless if there are none.
    pub fn disconnect(&mut self, source: ObjectId, output: Option<u16>, to: Option<Destination>) {
        let goes = |from: u16, arc: Destination| output.is_none_or(|o| o == from) && to.is_none_or(|t| t == arc);
        self.retain_arcs_of(source, |from, arc| !goes(from, arc));
    }

    /// Keeps the arcs for which `keep` of source, output and destination is true.
    pub fn retain_arcs(&mut self, mut keep: impl FnMut(ObjectId, u16, Destination) -> bool) {
        let mut sources: Vec<ObjectId> = self.outside.keys().map(|(source, _)| *source).collect();
        sources.extend(self.objects());
        for source in sources {
            self.retain_arcs_of(source, |output, arc| keep(source, output, arc));
        }
    }

    /// Forgets the outputs of an object that is no function for which `goes` is true.
    fn drop_outside(&mut self, source: ObjectId, goes: impl Fn(&Output) -> bool) {
        let range = self.outside.range((source, 0)..=(source, u16::MAX));
        let gone: Vec<(ObjectId, u16)> = range.filter(|(_, arcs)| goes(arcs)).map(|(key, _)| *key).collect();
        for key in gone {
            self.outside.remove(&key);
        }
    }

    fn retain_arcs_of(&mut self, source: ObjectId, mut keep: impl FnMut(u16, Destination) -> bool) {
        if let Some(instance) = self.instance(source) {
            let run = instance.outputs;
            for (output, arcs) in (1..).zip(self.outputs.get_mut(run)) {
                arcs.retain(|arc| keep(output, arc));
            }
        }
        for (&(_, output), arcs) in self.outside.range_mut((source, 0)..=(source, u16::MAX)) {
            arcs.retain(|arc| keep(output, arc));
        }
        self.drop_outside(source, |arcs| arcs.single() == Err(0));
    }

    /// The arcs that leave an object, as output and destination, in order.
    pub fn arcs(&self, source: ObjectId) -> impl Iterator<Item = (u16, Destination)> {
        let own = self.instance(source).map_or(Run::default(), |instance| instance.outputs);
        let own = (1..).zip(self.outputs.get(own));
        let outside = self.outside.range((source, 0)..=(source, u16::MAX)).map(|(&(_, output), arcs)| (output, arcs));
        own.chain(outside).flat_map(|(output, arcs)| arcs.iter().map(move |arc| (output, arc)))
    }

    /// The function of an object.
    pub fn function(&self, id: ObjectId) -> Option<&'static FunctionRow> {
        self.instance(id).map(|instance| instance.row)
    }

    /// The port at an input of a function: what waits there.
    pub fn port(&self, id: ObjectId, input: u16) -> Option<&Port> {
        let instance = self.instance(id)?;
        let place = instance.input(Input::Number(u32::from(input)))?;
        self.ports.get(instance.ports).get(place)
    }

    /// The objects that are functions, in the order of their numbers.
    pub fn objects(&self) -> impl Iterator<Item = ObjectId> {
        let occupied = self.index.iter().enumerate().filter(|(_, slot)| **slot != NO_SLOT);
        occupied.map(|(place, _)| ObjectId(place as u32))
    }

    /// What the network did since it was made.
    pub const fn counters(&self) -> Counters {
        self.counters
    }

    #[inline]
    fn slot(&self, id: ObjectId) -> Option<u32> {
        self.index.get(id.0 as usize).copied().filter(|&slot| slot != NO_SLOT)
    }

    fn instance(&self, id: ObjectId) -> Option<&Instance> {
        self.slot(id).map(|slot| &self.instances[slot as usize])
    }

    fn output_mut(&mut self, source: ObjectId, output: u16) -> Option<&mut Output> {
        match self.instance(source).map(|instance| instance.outputs) {
            Some(run) => self.outputs.get_mut(run).get_mut(usize::from(output).wrapping_sub(1)),
            None => Some(self.outside.entry((source, output)).or_default()),
        }
    }
}
