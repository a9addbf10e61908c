//! What a person may switch on to see a network work: counters, a trace of messages, breaks.

use super::{
    Destination,
    observe::{ArcSource, Delivery, Observer},
};
use crate::port::ObjectId;
use protocol::Value;
use std::collections::{BTreeSet, VecDeque};

/// Most lines that a trace keeps; the oldest go first. Ours.
pub const TRACE_LINES: usize = 4_096;

/// Most bytes of a string in a trace; the rest is cut off. Ours.
pub const TRACED_BYTES: usize = 256;

/// What a function did since its counters were started, or since it was instanced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Activity {
    /// Firings, those that ended in a fault included; of a clock or a device, how often it emitted.
    pub firings: u64,
    /// Firings that ended in a fault, and faults of a clock.
    pub faults: u64,
    /// Messages that arrived at its inputs.
    pub received: u64,
    /// Messages that its outputs sent, one for each arc.
    pub sent: u64,
    /// Messages to it that were lost because a queue was full.
    pub lost: u64,
    /// Messages to it that were refused: of a wrong kind, or for an input that it does not have.
    pub refused: u64,
    /// Most messages that waited at one of its inputs.
    pub longest_queue: usize,
}

/// One message that passed.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// How many firings the network had begun when it passed.
    pub firing: u64,
    /// Where it came from; none for what a command sends.
    pub from: Option<ArcSource>,
    /// Where it went.
    pub to: Destination,
    /// The message; of a string the first [`TRACED_BYTES`] bytes.
    pub value: Value,
    /// What became of it.
    pub outcome: Delivery,
}

/// The messages that are traced.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum Traced {
    /// None.
    #[default]
    Nothing,
    /// All.
    Everything,
    /// Those to and from some objects.
    Objects(BTreeSet<ObjectId>),
}

/// Everything that a person has switched on.
#[derive(Debug, Default)]
pub(super) struct Instruments {
    /// By the numbers of the objects; none if the counters are off.
    pub(super) activity: Option<Vec<Activity>>,
    pub(super) traced: Traced,
    pub(super) lines: VecDeque<Trace>,
    /// Lines that went because there were too many.
    pub(super) cut: u64,
    /// Firings that began under observation, and before.
    pub(super) firings: u64,
    pub(super) breaks: BTreeSet<ObjectId>,
    pub(super) held: bool,
    /// The next firing passes its break.
    pub(super) pass: bool,
}

impl Instruments {
    /// Starts the counters of one function anew.
    pub(super) fn forget(&mut self, id: ObjectId) {
        if let Some(activity) = self.activity.as_mut().and_then(|counted| counted.get_mut(id.index())) {
            *activity = Activity::default();
        }
    }

    pub(super) fn starting(firings: u64) -> Instruments {
        Instruments { firings, ..Instruments::default() }
    }

    pub(super) fn is_off(&self) -> bool {
        let unused = self.lines.is_empty() && self.cut == 0 && self.breaks.is_empty();
        self.activity.is_none() && self.traced == Traced::Nothing && unused && !self.held
    }

    /// The counters of an object, if they are on.
    fn of(&mut self, id: ObjectId) -> Option<&mut Activity> {
        let counted = self.activity.as_mut()?;
        if id.index() >= counted.len() {
            counted.resize(id.index() + 1, Activity::default());
        }
        counted.get_mut(id.index())
    }
}

impl Observer for Instruments {
    const IS_ACTIVE: bool = true;

    fn stops_before(&mut self, object: ObjectId) -> bool {
        let passes = std::mem::take(&mut self.pass) && !self.held;
        self.held |= !passes && self.breaks.contains(&object);
        self.held
    }

    fn fires(&mut self, object: ObjectId) {
        self.firings += 1;
        if let Some(activity) = self.of(object) {
            activity.firings += 1;
        }
    }

    fn emits(&mut self, object: ObjectId) {
        if let Some(activity) = self.of(object) {
            activity.firings += 1;
        }
    }

    fn fails(&mut self, object: ObjectId) {
        if let Some(activity) = self.of(object) {
            activity.faults += 1;
        }
    }

    fn copy(&self, from: Option<ArcSource>, to: Destination, message: &Value) -> Option<Value> {
        let wanted = match &self.traced {
            Traced::Nothing => false,
            Traced::Everything => true,
            Traced::Objects(chosen) => chosen.contains(&to.object) || from.is_some_and(|f| chosen.contains(&f.object)),
        };
        wanted.then(|| match message {
            Value::String(text) => Value::string(&text[..text.len().min(TRACED_BYTES)]),
            other => other.clone(),
        })
    }

    fn delivered(&mut self, from: Option<ArcSource>, to: Destination, message: Option<Value>, outcome: Delivery) {
        if let Some(activity) = from.and_then(|from| self.of(from.object)) {
            activity.sent += 1;
        }
        if outcome != Delivery::Left
            && let Some(activity) = self.of(to.object)
        {
            match outcome {
                Delivery::Arrived { waiting } => {
                    activity.received += 1;
                    activity.longest_queue = activity.longest_queue.max(waiting);
                }
                Delivery::Lost => activity.lost += 1,
                Delivery::Refused => activity.refused += 1,
                Delivery::Left => {}
            }
        }
        if let Some(value) = message {
            if self.lines.len() >= TRACE_LINES {
                self.lines.pop_front();
                self.cut += 1;
            }
            self.lines.push_back(Trace { firing: self.firings, from, to, value, outcome });
        }
    }
}
