//! The thread of the machine: takes what happens on the lines, and lets frames pass when they are due.

use super::{ExitReason, Mirror, Operator, Options, TimeSource};
use crate::{
    calligraphic::SharedDisplay,
    line::{Capture, Interface, LineEvent, LineId, OperatorLine, Reply, Writer},
    machine::{Input, Machine, Micros, time_of_frame},
    operator::{CommandOutcome, OperatorCommand, Wait, parse, perform, reply},
};
use files::Sandbox;
use std::{
    collections::{BTreeMap, HashMap},
    io,
    sync::Arc,
    time::{Duration, Instant},
};
use tokio::sync::{mpsc, oneshot};

/// Events that wait for the machine; with [`LineEvent::Bytes`] of 64 KiB this bounds memory.
pub(super) const WAITING_EVENTS: usize = 16;
/// Frames that a host which has closed its side still gets answers for, if the network is busy: a second.
const GRACE_FRAMES: u64 = 60;
/// How far the machine may lag behind the wall clock before it gives time up instead of catching up.
const MAX_LAG: Micros = 250_000;

/// What the thread of the machine holds.
pub(super) struct MachineLoop {
    machine: Machine,
    mirror: Option<Arc<Mirror>>,
    /// The folder below which operator commands write.
    files: Sandbox,
    /// Whether captures may give operator commands that reach out.
    replays_operator: bool,
    /// Takes what the operator does, if a capture is requested.
    capture: Option<Capture>,
    inbox: mpsc::Receiver<LineEvent>,
    timer: tokio::runtime::Runtime,
    clock: TimeSource,
    /// Wall-clock time of machine time 0.
    epoch: Instant,
    writers: BTreeMap<LineId, (String, Writer)>,
    waits: Vec<(Wait, oneshot::Sender<Reply>)>,
    /// Hosts that have closed their side, and the frame at which they are let go at the latest.
    leaving: Vec<(LineId, u64)>,
    /// Messages lost since the latest frame, by line.
    lost: HashMap<LineId, u64>,
    /// Endpoints at which hosts can still attach, or an operator.
    sources: usize,
}

impl MachineLoop {
    /// A machine with its lines; `inbox` receives what happens on them.
    ///
    /// # Errors
    /// Those of the system.
    pub(super) fn new(
        options: &Options,
        files: Sandbox,
        mirror: Option<Arc<Mirror>>,
        capture: Option<Capture>,
        inbox: mpsc::Receiver<LineEvent>,
    ) -> io::Result<MachineLoop> {
        let sources = options.listen.len() + usize::from(options.operator != Operator::None || mirror.is_some());
        let mut machine = Machine::new(options.settings);
        let alone = || Arc::new(SharedDisplay::new(options.drawer.clone()));
        machine.share_screen(mirror.as_ref().map_or_else(alone, |mirror| mirror.screen().clone()), mirror.is_some());
        tracing::info!("the vector screen is drawn by {}", options.drawer);
        Ok(MachineLoop {
            machine,
            mirror,
            files,
            replays_operator: options.replays_operator,
            capture,
            inbox,
            timer: tokio::runtime::Builder::new_current_thread().enable_time().build()?,
            clock: options.clock,
            epoch: Instant::now(),
            writers: BTreeMap::new(),
            waits: Vec::new(),
            leaving: Vec::new(),
            lost: HashMap::new(),
            sources,
        })
    }

    /// Takes events and lets frames pass until the end.
    pub(super) fn run(mut self) -> ExitReason {
        loop {
            let mut event = self.next_event();
            // However much the hosts send, frames pass when they are due.
            for _ in 0..WAITING_EVENTS {
                let Some(next) = event else { break };
                if let Some(end) = self.take(next) {
                    return end;
                }
                event = if self.frame_is_due() { None } else { self.inbox.try_recv().ok() };
            }
            if let Some(end) = event.and_then(|last| self.take(last)) {
                return end;
            }
            self.let_go();
            self.poll_waits();
            if self.sources == 0 && self.leaving.is_empty() {
                return ExitReason::Quit;
            }
            // One frame a round, so that events are seen between frames that are late.
            let next = time_of_frame(self.machine.frame() + 1);
            let until = if self.frame_is_due() { next } else { 0 };
            self.step(None, until);
            if self.machine.was_relieved() {
                processes::return_memory();
            }
            self.poll_waits();
        }
    }

    /// Whether it is time for the next frame.
    fn frame_is_due(&mut self) -> bool {
        match self.clock {
            TimeSource::Real => self.now() >= time_of_frame(self.machine.frame() + 1),
            TimeSource::Virtual => !self.waits.is_empty(),
        }
    }

    /// The next event, or none when the next frame is due.
    fn next_event(&mut self) -> Option<LineEvent> {
        match self.clock {
            TimeSource::Virtual if !self.waits.is_empty() => self.inbox.try_recv().ok(),
            TimeSource::Virtual => self.timer.block_on(self.inbox.recv()).or(Some(LineEvent::Interrupted)),
            TimeSource::Real => {
                let due = Duration::from_micros(time_of_frame(self.machine.frame() + 1));
                let deadline = tokio::time::Instant::from_std(self.epoch + due);
                let inbox = &mut self.inbox;
                self.timer.block_on(async { tokio::time::timeout_at(deadline, inbox.recv()).await.ok().flatten() })
            }
        }
    }

    /// Machine time by the wall clock. A machine that lags far behind loses time.
    fn now(&mut self) -> Micros {
        let elapsed = Micros::try_from(self.epoch.elapsed().as_micros()).unwrap_or(Micros::MAX);
        let latest = time_of_frame(self.machine.frame()) + MAX_LAG;
        if elapsed > latest {
            self.epoch += Duration::from_micros(elapsed - latest);
        }
        elapsed.min(latest)
    }

    fn take(&mut self, event: LineEvent) -> Option<ExitReason> {
        match event {
            LineEvent::Attached { line, peer, interface, writer } => {
                tracing::info!("host line {peer} attached");
                self.writers.insert(line, (peer, writer));
                let attach = match interface {
                    Interface::Stream => Input::Attach(line),
                    Interface::Parallel => Input::AttachParallel(line),
                };
                self.step(Some(attach), 0);
            }
            LineEvent::Bytes(line, bytes) => {
                if let Some(mirror) = &self.mirror {
                    mirror.pass(line, true, &bytes, &self.machine);
                }
                self.step(Some(Input::Bytes(line, bytes)), 0);
            }
            LineEvent::Closed { line, error } => {
                if let Some((peer, _)) = self.writers.get(&line) {
                    match error {
                        Some(error) => tracing::warn!("host line {peer} closed: {error}"),
                        None => tracing::info!("host line {peer} closed"),
                    }
                }
                self.leaving.push((line, self.machine.frame() + GRACE_FRAMES));
            }
            LineEvent::Operator(order) => {
                return self.perform_command(order);
            }
            LineEvent::SourceEnded => self.sources = self.sources.saturating_sub(1),
            LineEvent::OperatorGone => return Some(ExitReason::Quit),
            LineEvent::Interrupted => return Some(ExitReason::Interrupted),
        }
        None
    }

    /// Carries out an operator command.
    fn perform_command(
        &mut self,
        OperatorLine { text, reply: answer, is_replayed }: OperatorLine,
    ) -> Option<ExitReason> {
        let parsed = parse(&text);
        let mut outcome = match &parsed {
            Ok(order) => {
                if let Some(capture) = self.capture.as_ref().filter(|_| order.is_action()) {
                    capture.record_operator_command(&text);
                }
                let files = Some(&self.files).filter(|_| !is_replayed || self.replays_operator);
                perform(order, &mut self.machine, files)
            }
            Err(error) => CommandOutcome::Done(Err(error.to_string())),
        };
        if let (true, CommandOutcome::Done(Err(error))) = (is_replayed, &outcome) {
            tracing::warn!("'{text}' of a capture is not carried out: {error}");
        }
        // What an operator command made the machine send leaves before its reply.
        self.step(None, 0);
        if let (Ok(OperatorCommand::Dial { .. }), CommandOutcome::Done(Ok(said))) = (&parsed, &mut outcome) {
            *said = match self.clock {
                TimeSource::Real => "the machine reads it at the next frame".into(),
                TimeSource::Virtual => "the machine reads it at the next frame; 'frames 1' lets one pass".into(),
            };
        }
        let lines = if let Ok(OperatorCommand::Lines(on)) = parsed { Some(on) } else { None };
        match outcome {
            CommandOutcome::Done(result) => drop(answer.send(Reply { text: reply(&result), lines })),
            CommandOutcome::Waiting(wait) => self.waits.push((wait, answer)),
            CommandOutcome::Quit => {
                let _ = answer.send(reply(&Ok("quit".into())).into());
                return Some(ExitReason::Quit);
            }
        }
        None
    }

    fn step(&mut self, input: Option<Input>, until: Micros) {
        for output in self.machine.step(input, until) {
            if let Some(mirror) = &self.mirror {
                mirror.pass(output.line, false, &output.bytes, &self.machine);
            }
            let refused = self.writers.get(&output.line).is_some_and(|(_, writer)| !writer.send(output.bytes));
            let lost = output.lost + if refused { output.messages } else { 0 };
            if lost > 0 {
                *self.lost.entry(output.line).or_default() += lost;
            }
        }
        if until > 0 {
            if let Some(mirror) = &self.mirror {
                mirror.renew(&mut self.machine, self.writers.values().map(|(peer, _)| peer.as_str()));
            }
            for (line, lost) in std::mem::take(&mut self.lost) {
                let peer = self.writers.get(&line).map_or("that closed", |w| w.0.as_str());
                tracing::warn!("host line {peer} does not read; {lost} messages to it are lost");
            }
        }
    }

    /// Lets hosts go that have closed their side. What they asked for may still be on its way through the network, so a
    /// host stays for a while if that is busy.
    fn let_go(&mut self) {
        for (line, until) in std::mem::take(&mut self.leaving) {
            let time_stands = self.clock == TimeSource::Virtual && self.waits.is_empty();
            if self.machine.network_rests() || self.machine.frame() >= until || time_stands {
                self.step(Some(Input::Detach(line)), 0);
                self.writers.remove(&line);
            } else {
                self.leaving.push((line, until));
            }
        }
    }

    fn poll_waits(&mut self) {
        for (wait, reply_to) in std::mem::take(&mut self.waits) {
            match wait.poll(&mut self.machine) {
                Some(result) => drop(reply_to.send(reply(&result).into())),
                None => self.waits.push((wait, reply_to)),
            }
        }
    }
}
