//! What a person may switch on to see a network work: counters, a trace of messages, breaks.

use super::{
    Destination, Network,
    observe::{Observer, Outcome, Source},
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
    /// Firings, those that ended in a fault included; of a clock or a device, how often it spoke.
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
    pub from: Option<Source>,
    /// Where it went.
    pub to: Destination,
    /// The message; of a string the first [`TRACED_BYTES`] bytes.
    pub value: Value,
    /// What became of it.
    pub outcome: Outcome,
}

/// Which messages are traced.
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
    activity: Option<Vec<Activity>>,
    traced: Traced,
    lines: VecDeque<Trace>,
    /// Lines that went because there were too many.
    cut: u64,
    /// Firings that began under observation, and before.
    firings: u64,
    breaks: BTreeSet<ObjectId>,
    held: bool,
    /// The next firing passes its break.
    pass: bool,
}

impl Network {
    /// Switches the counters of the functions on, from 0, or off.
    pub fn count_activity(&mut self, on: bool) {
        self.instruments_mut().activity = on.then(Vec::new);
        self.put_away();
    }

    /// Whether the counters of the functions are on.
    pub fn counts_activity(&self) -> bool {
        self.instruments.as_ref().is_some_and(|instruments| instruments.activity.is_some())
    }

    /// What a function did since its counters were started; none if they are off, or it is no function.
    pub fn activity(&self, id: ObjectId) -> Option<Activity> {
        let counted = self.instruments.as_ref()?.activity.as_ref()?;
        self.function(id).map(|_| counted.get(id.index()).copied().unwrap_or_default())
    }

    /// Counts that a device speaks, if functions are counted.
    pub fn note_speech(&mut self, id: ObjectId) {
        if let Some(instruments) = &mut self.instruments {
            instruments.speaks(id);
        }
    }

    /// Chooses which messages are traced from now on. What was traced before stays until it is taken.
    pub fn trace(&mut self, traced: Traced) {
        self.instruments_mut().traced = traced;
        self.put_away();
    }

    /// Which messages are traced.
    pub fn traced(&self) -> &Traced {
        self.instruments.as_ref().map_or(&Traced::Nothing, |instruments| &instruments.traced)
    }

    /// Takes the trace, the oldest line first, and how many lines before it went because there were too many.
    pub fn take_trace(&mut self) -> (Vec<Trace>, u64) {
        let Some(instruments) = &mut self.instruments else { return (Vec::new(), 0) };
        let taken = (std::mem::take(&mut instruments.lines).into(), std::mem::take(&mut instruments.cut));
        self.put_away();
        taken
    }

    /// Makes the network stop before an object fires, each time, also if it becomes another function; or no longer.
    pub fn set_break(&mut self, id: ObjectId, on: bool) {
        let breaks = &mut self.instruments_mut().breaks;
        if on {
            breaks.insert(id);
        } else {
            breaks.remove(&id);
        }
        self.put_away();
    }

    /// The objects with a break.
    pub fn breaks(&self) -> impl Iterator<Item = ObjectId> {
        self.instruments.iter().flat_map(|instruments| instruments.breaks.iter().copied())
    }

    /// Stops the network: messages still arrive, but nothing fires and clocks stand still until
    /// [`resume`](Self::resume).
    pub fn hold(&mut self) {
        self.instruments_mut().held = true;
    }

    /// Whether the network is stopped, by [`hold`](Self::hold), a break or a single firing.
    pub fn is_held(&self) -> bool {
        self.instruments.as_ref().is_some_and(|instruments| instruments.held)
    }

    /// Lets a network that is stopped go on. The function before which it stopped passes its break once.
    pub fn resume(&mut self) {
        let Some(instruments) = &mut self.instruments else { return };
        instruments.pass |= instruments.held;
        instruments.held = false;
        self.put_away();
    }

    /// The function that is going to fire next.
    pub fn next(&self) -> Option<ObjectId> {
        self.ready.iter().find(|id| self.instances[id.index()].is_ready())
    }

    /// Starts the counters of one function anew.
    pub(super) fn forget_activity(&mut self, id: ObjectId) {
        let counted = self.instruments.as_mut().and_then(|instruments| instruments.activity.as_mut());
        if let Some(activity) = counted.and_then(|counted| counted.get_mut(id.index())) {
            *activity = Activity::default();
        }
    }

    fn instruments_mut(&mut self) -> &mut Instruments {
        self.instruments.get_or_insert_with(|| Box::new(Instruments::starting(self.counters.firings)))
    }

    /// Puts the instruments away when all are off, so that the network is as fast as before.
    fn put_away(&mut self) {
        if self.instruments.as_ref().is_some_and(|instruments| instruments.is_off()) {
            self.instruments = None;
        }
    }
}

impl Instruments {
    fn starting(firings: u64) -> Instruments {
        Instruments { firings, ..Instruments::default() }
    }

    fn is_off(&self) -> bool {
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
    const LOOKS: bool = true;

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

    fn speaks(&mut self, object: ObjectId) {
        if let Some(activity) = self.of(object) {
            activity.firings += 1;
        }
    }

    fn fails(&mut self, object: ObjectId) {
        if let Some(activity) = self.of(object) {
            activity.faults += 1;
        }
    }

    fn copy(&self, from: Option<Source>, to: Destination, message: &Value) -> Option<Value> {
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

    fn passes(&mut self, from: Option<Source>, to: Destination, message: Option<Value>, outcome: Outcome) {
        if let Some(activity) = from.and_then(|from| self.of(from.object)) {
            activity.sent += 1;
        }
        if outcome != Outcome::Left
            && let Some(activity) = self.of(to.object)
        {
            match outcome {
                Outcome::Arrived { waiting } => {
                    activity.received += 1;
                    activity.longest_queue = activity.longest_queue.max(waiting);
                }
                Outcome::Lost => activity.lost += 1,
                Outcome::Refused => activity.refused += 1,
                Outcome::Left => {}
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
