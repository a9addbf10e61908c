//! Switching on and off what a person sees of a network: counters, the trace, breaks, and the network itself.

use super::{Activity, Network, Trace, Traced, instruments::Instruments, observe::Observer};
use crate::port::ObjectId;

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

    /// Counts that a device emits a message, if functions are counted.
    pub fn note_emission(&mut self, id: ObjectId) {
        if let Some(instruments) = &mut self.instruments {
            instruments.emits(id);
        }
    }

    /// Chooses which messages are traced from now on. What was traced before stays until it is taken.
    pub fn trace(&mut self, traced: Traced) {
        self.instruments_mut().traced = traced;
        self.put_away();
    }

    /// The messages that are traced.
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

    fn instruments_mut(&mut self) -> &mut Instruments {
        self.instruments.get_or_insert_with(|| Box::new(Instruments::starting(self.counters.firings)))
    }

    /// Puts the instruments away when all are off, so that the network is as fast as before.
    fn put_away(&mut self) {
        if self.instruments.as_ref().is_some_and(|instruments| instruments.is_off()) {
            self.instruments = None;
        }
    }

    /// Ends an instance for ever, with its break.
    pub fn forget(&mut self, id: ObjectId) {
        self.undefine(id);
        if self.breaks().any(|broken| broken == id) {
            self.set_break(id, false);
        }
    }
}
