//! The network as a graph: instances of functions, and the arcs between them.

use super::{
    Destination,
    arcs::OutputArcs,
    instance::Instance,
    instruments::Instruments,
    pool::{Pool, Run},
    ready::Ready,
};
use crate::{
    functions::{FunctionRow, SizeError},
    port::{Backlog, Cause, Fault, ObjectId, Outbox, Port},
};
use protocol::command::Input;
use std::collections::BTreeMap;

/// Most bytes of strings that wait in a network; messages beyond are lost, counted and reported. Ours.
pub const MAX_STRING_BYTES: usize = 64 << 20;

/// Instances of functions and the arcs between them.
#[derive(Debug)]
pub struct Network {
    /// By the numbers of the objects, also of those that are no functions.
    pub(super) instances: Vec<Instance>,
    pub(super) ports: Pool<Port>,
    /// Messages after the first at each port.
    pub(super) backlog: Backlog,
    pub(super) outputs: Pool<OutputArcs>,
    /// Arcs that leave objects that are no functions (yet), by object and output.
    pub(super) outside: BTreeMap<(ObjectId, u16), OutputArcs>,
    /// Those that can fire, in the order in which they became ready. An instance stands here once at most; if it
    /// is made anew, it keeps its position.
    pub(super) ready: Ready,
    /// The clocks, in the order of their instancing.
    pub(super) clocks: Vec<ObjectId>,
    /// None while it is in use, and before the first firing.
    pub(super) outbox: Option<Box<Outbox>>,
    /// Bytes of the strings that wait at inputs or are remembered.
    pub(super) string_bytes: usize,
    /// Messages lost at each input that ever lost one.
    pub(super) lost: BTreeMap<(ObjectId, u16), u64>,
    pub(super) counters: NetworkCounters,
    pub(super) instruments: Option<Box<Instruments>>,
    pub(super) frame: u64,
    pub(super) centiseconds: u64,
}

/// What a network did since it was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct NetworkCounters {
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
            instances: Vec::new(),
            ports: Pool::new(),
            backlog: Backlog::new(),
            outputs: Pool::new(),
            outside: BTreeMap::new(),
            ready: Ready::new(),
            clocks: Vec::new(),
            outbox: None,
            string_bytes: 0,
            lost: BTreeMap::new(),
            counters: NetworkCounters { firings: 0, deliveries: 0, lost: 0 },
            instruments: None,
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
        let memory = std::iter::repeat_with(|| Port::UNUSED).take(usize::from(row.memory));
        let inputs = (1..=shape.inputs).filter_map(|input| row.input(shape, input)).map(Port::new);
        let ports = self.ports.store(inputs.chain(memory).collect::<Vec<_>>().into_iter());
        let outputs = (1..=shape.outputs).map(|output| self.outside.remove(&(id, output)).unwrap_or_default());
        let outputs = self.outputs.store(outputs.collect::<Vec<_>>().into_iter());
        let (Some(ports), Some(outputs)) = (ports, outputs) else {
            return Err(SizeError::OutOfRange(row.name, shape.size));
        };
        self.make_room(id);
        let instance = &mut self.instances[id.index()];
        *instance = Instance {
            row: Some(row),
            ports,
            outputs,
            inputs: shape.inputs,
            size: shape.size,
            queued: instance.queued,
            ..Instance::VACANT
        };
        instance.count(&self.ports.get(ports)[..usize::from(shape.inputs)]);
        self.note_sole_arc(id);
        if row.clock.is_some() {
            self.clocks.push(id);
        }
        Ok(())
    }

    /// Ends an instance, with its messages and the connections from it. Connections to it stay.
    ///
    /// Harmless for an object that is no function.
    pub fn undefine(&mut self, id: ObjectId) {
        self.undefine_instance(id);
        self.drop_outside(id, |_| true);
    }

    fn undefine_instance(&mut self, id: ObjectId) {
        let Some(instance) = self.instances.get_mut(id.index()) else { return };
        let Some(row) = instance.row else { return };
        let (ports, outputs) = (instance.ports, instance.outputs);
        *instance = Instance { queued: instance.queued, ..Instance::VACANT };
        for port in self.ports.get_mut(ports) {
            self.string_bytes -= port.string_bytes(&self.backlog);
            port.abandon(&mut self.backlog);
        }
        self.ports.release(ports, || Port::UNUSED);
        self.outputs.release(outputs, OutputArcs::default);
        if row.clock.is_some() {
            self.clocks.retain(|&clock| clock != id);
        }
        if !self.lost.is_empty() {
            self.lost.retain(|&(object, _), _| object != id);
        }
        if let Some(instruments) = &mut self.instruments {
            instruments.forget(id);
        }
    }

    /// Adds an arc. One that exists already stays single.
    ///
    /// A source that is no function may be connected: the arc works when it becomes one, and for what the machine
    /// sends from it with [`emit`](Self::emit).
    ///
    /// # Errors
    /// A fault if the source has no such output, the destination no such input, or the output too many arcs.
    pub fn connect(&mut self, source: ObjectId, output: u16, to: ObjectId, input: Input) -> Result<(), Fault> {
        if let (Some(row), Some(target)) = (self.function(to), self.instance(to))
            && target.input(input).is_none()
        {
            return Err(Fault { function: row.name, cause: Cause::NoSuchInput(input) });
        }
        let function = self.function(source).map_or("", |row| row.name);
        let Some(arcs) = self.output_mut(source, output) else {
            return Err(Fault { function, cause: Cause::NoSuchOutput(output) });
        };
        if arcs.connect(Destination { object: to, input }) {
            self.note_sole_arc(source);
            self.make_room(to);
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
    fn drop_outside(&mut self, source: ObjectId, goes: impl Fn(&OutputArcs) -> bool) {
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
            self.note_sole_arc(source);
        }
        for (&(_, output), arcs) in self.outside.range_mut((source, 0)..=(source, u16::MAX)) {
            arcs.retain(|arc| keep(output, arc));
        }
        self.drop_outside(source, |arcs| arcs.len() == 0);
    }

    /// The arcs that leave an object, as output and destination, in order.
    pub fn arcs(&self, source: ObjectId) -> impl Iterator<Item = (u16, Destination)> {
        let own = self.instance(source).map_or(Run::EMPTY, |instance| instance.outputs);
        let own = (1..).zip(self.outputs.get(own));
        let outside = self.outside.range((source, 0)..=(source, u16::MAX)).map(|(&(_, output), arcs)| (output, arcs));
        own.chain(outside).flat_map(|(output, arcs)| arcs.iter().map(move |arc| (output, arc)))
    }

    /// The function of an object.
    pub fn function(&self, id: ObjectId) -> Option<&'static FunctionRow> {
        self.instances.get(id.index()).and_then(|instance| instance.row)
    }

    /// The objects that are functions, in the order of their numbers.
    pub fn objects(&self) -> impl Iterator<Item = ObjectId> {
        let functions = self.instances.iter().enumerate().filter(|(_, instance)| instance.row.is_some());
        functions.map(|(place, _)| ObjectId::new(place))
    }

    /// What the network did since it was made.
    pub const fn counters(&self) -> NetworkCounters {
        self.counters
    }

    /// The instance of an object that is a function.
    pub(super) fn instance(&self, id: ObjectId) -> Option<&Instance> {
        self.instances.get(id.index()).filter(|instance| instance.row.is_some())
    }

    /// Makes an entry in the table of instances for an object, if there is none.
    pub(super) fn make_room(&mut self, id: ObjectId) {
        if id.index() >= self.instances.len() {
            self.instances.resize_with(id.index() + 1, || Instance::VACANT);
        }
    }

    /// Notes in a function where the only arc from output 1 ends, after its arcs have changed.
    pub(super) fn note_sole_arc(&mut self, id: ObjectId) {
        if let Some(instance) = self.instances.get_mut(id.index()) {
            instance.only_arc = self.outputs.get(instance.outputs).first().and_then(OutputArcs::sole);
        }
    }

    pub(super) fn output_mut(&mut self, source: ObjectId, output: u16) -> Option<&mut OutputArcs> {
        match self.instance(source).map(|instance| instance.outputs) {
            Some(run) => self.outputs.get_mut(run).get_mut(usize::from(output).wrapping_sub(1)),
            None => Some(self.outside.entry((source, output)).or_default()),
        }
    }
}
