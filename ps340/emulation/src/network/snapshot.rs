//! The network as it is now, for people who look into it: functions, what waits at their inputs, arcs.

use super::{Activity, Destination, Network, instance::Instance};
use crate::{
    functions::FunctionRow,
    port::{ObjectId, Port},
};
use protocol::{Value, command::Input};

/// A function as it is now.
#[derive(Clone, Copy, Debug)]
pub struct FunctionView<'a> {
    network: &'a Network,
    object: ObjectId,
    row: &'static FunctionRow,
    instance: &'a Instance,
}

/// An input of a function as it is now.
#[derive(Clone, Copy, Debug)]
pub struct InputView<'a> {
    network: &'a Network,
    object: ObjectId,
    number: u16,
    port: &'a Port,
}

impl Network {
    /// The functions as they are now, in the order of their numbers.
    pub fn snapshot(&self) -> impl Iterator<Item = FunctionView<'_>> {
        self.objects().filter_map(|id| self.view(id))
    }

    /// A function as it is now.
    pub fn view(&self, id: ObjectId) -> Option<FunctionView<'_>> {
        let instance = self.instance(id)?;
        Some(FunctionView { network: self, object: id, row: instance.row?, instance })
    }

    /// An input of a function as it is now.
    ///
    /// - `input`: from 1.
    pub fn port(&self, id: ObjectId, input: u16) -> Option<InputView<'_>> {
        self.view(id)?.inputs().nth(usize::from(input).checked_sub(1)?)
    }

    /// How many messages wait where an arc ends; 0 if that is no input of a function.
    pub(super) fn waiting(&self, to: Destination) -> usize {
        let Some(instance) = self.instance(to.object) else { return 0 };
        let place = instance.input(to.input);
        place.map_or(0, |place| self.ports.get(instance.ports)[place].len(&self.backlog))
    }
}

impl<'a> FunctionView<'a> {
    /// The object.
    pub const fn object(&self) -> ObjectId {
        self.object
    }

    /// What it does.
    pub const fn row(&self) -> &'static FunctionRow {
        self.row
    }

    /// The n of a family such as ROUTE(n), else 0.
    pub const fn size(&self) -> u16 {
        self.instance.size
    }

    /// Whether it is going to fire.
    pub const fn is_ready(&self) -> bool {
        self.instance.is_ready()
    }

    /// Number of its outputs.
    pub fn outputs(&self) -> usize {
        self.network.outputs.get(self.instance.outputs).len()
    }

    /// Its inputs, from input 1.
    pub fn inputs(&self) -> impl Iterator<Item = InputView<'a>> + use<'a> {
        let (network, object) = (self.network, self.object);
        let ports = &network.ports.get(self.instance.ports)[..usize::from(self.instance.inputs)];
        (1..).zip(ports).map(move |(number, port)| InputView { network, object, number, port })
    }

    /// The arcs from it, as output and destination, in order.
    pub fn arcs(&self) -> impl Iterator<Item = (u16, Destination)> + use<'a> {
        self.network.arcs(self.object)
    }

    /// What it did since its counters were started; none if they are off.
    pub fn activity(&self) -> Option<Activity> {
        self.network.activity(self.object)
    }
}

impl<'a> InputView<'a> {
    /// Its number, from 1.
    pub const fn number(&self) -> u16 {
        self.number
    }

    /// Whether it is a queue; else it is a constant.
    pub const fn is_active(&self) -> bool {
        self.port.is_active()
    }

    /// Whether the function waits for a message here.
    pub const fn is_wanting(&self) -> bool {
        self.port.is_wanting()
    }

    /// Whether no message is here.
    pub const fn is_empty(&self) -> bool {
        self.port.is_empty()
    }

    /// How many messages wait here; 1 for a constant that has a value.
    pub fn len(&self) -> usize {
        self.port.len(&self.network.backlog)
    }

    /// The message that leaves next, or the constant.
    pub fn first(&self) -> Option<&'a Value> {
        self.port.first()
    }

    /// The messages that wait here, the first first; or the constant.
    pub fn messages(&self) -> impl Iterator<Item = &'a Value> + use<'a> {
        self.port.messages(&self.network.backlog)
    }

    /// How many messages were lost here because the queue was full.
    pub fn lost(&self) -> u64 {
        self.network.lost.get(&(self.object, self.number)).copied().unwrap_or(0)
    }

    /// Where an arc to it ends.
    pub fn destination(&self) -> Destination {
        Destination { object: self.object, input: Input::Number(u32::from(self.number)) }
    }
}
