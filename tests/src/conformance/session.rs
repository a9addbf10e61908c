//! One case on one machine: attach, clear, play the steps, compare, leave.

use super::{
    case::{Case, Expected, Step, StrokeLine, with_number},
    compare::{matches, strokes_differ},
    form::{Sender, Transport, TransportError},
    line::{Endpoint, Line},
    person::{Operator, OperatorFault},
    strokes::{self, Continuation, WritebackText},
};
use protocol::wire::MessageReader;
use std::{
    collections::VecDeque,
    io,
    time::{Duration, Instant},
};

/// Lines of the transcript of a failure that are kept.
const TRANSCRIPT_LINES: usize = 30;
/// Messages that may come without being asked for before a case is given up.
const MAX_MESSAGES: usize = 20_000;
/// Bytes of repeated commands that are sent at a time.
const PIECE: usize = 64 << 10;
/// The password that cases set. A machine without one takes any.
const PASSWORD: &str = "SECRET";
/// Least tolerance of strokes that WRITEBACK sends, with seven digits.
const WRITEBACK_TOLERANCE: f64 = 1e-5;

/// What the cases are run against, and how.
#[derive(Clone, Debug)]
pub struct Target {
    /// The endpoint of the machine.
    pub endpoint: Endpoint,
    /// How commands travel.
    pub transport: Transport,
    /// Seed for cutting the stream at random places.
    pub cut: Option<u64>,
    /// How long a machine may take to answer.
    pub timeout: Duration,
    /// Numbers and texts of the machine's messages do not matter.
    pub any_fault: bool,
    /// The machine is started again (REBOOT) before each case: what a case changes and INITIALIZE spares reaches no
    /// other.
    pub reboots: bool,
}

/// The reason why a case failed.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// The line of the step in the file.
    pub line: usize,
    /// What was expected.
    pub expected: String,
    /// What came.
    pub found: String,
    /// The latest of what went to and fro.
    pub transcript: Vec<String>,
}

/// The reason why a case came to no end by itself.
#[derive(Debug)]
pub enum Stop {
    /// Not as expected.
    Failed {
        /// What was expected.
        expected: String,
        /// What came.
        found: String,
    },
    /// It cannot be played here.
    Skipped(String),
    /// There is no machine.
    Unreachable(io::Error),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Stop {
        let found = format!("the line failed: {error}");
        Stop::Failed { expected: "a line that works".into(), found }
    }
}

impl From<TransportError> for Stop {
    fn from(error: TransportError) -> Stop {
        Stop::Failed { expected: "commands that can travel in this form".into(), found: error.to_string() }
    }
}

impl From<OperatorFault> for Stop {
    fn from(fault: OperatorFault) -> Stop {
        match fault {
            OperatorFault::Beyond(why) => Stop::Skipped(why.into()),
            fault => Stop::Failed { expected: "an order that is carried out".into(), found: fault.to_string() },
        }
    }
}

/// A case in play.
pub struct Session<'s> {
    target: &'s Target,
    operator: Option<&'s mut dyn Operator>,
    case: &'s Case,
    line: Line,
    sender: Sender,
    reader: MessageReader,
    /// Bytes that still have to go.
    waiting: Vec<u8>,
    /// Messages that came.
    messages: VecDeque<Vec<u8>>,
    tokens: u64,
    watched: u64,
    reply: String,
    transcript: VecDeque<String>,
}

impl<'s> Session<'s> {
    /// Attaches and clears the machine.
    ///
    /// # Errors
    /// [`Stop::Unreachable`] if there is no machine, else that it does not answer.
    pub fn begin(
        target: &'s Target,
        operator: Option<&'s mut dyn Operator>,
        case: &'s Case,
    ) -> Result<Session<'s>, Stop> {
        let line = Line::attach(&target.endpoint).map_err(Stop::Unreachable)?;
        let mut session = Session {
            target,
            operator,
            case,
            line,
            sender: Sender::new(target.transport, target.cut),
            reader: MessageReader::default(),
            waiting: Vec::new(),
            messages: VecDeque::new(),
            tokens: 0,
            watched: 0,
            reply: String::new(),
            transcript: VecDeque::new(),
        };
        if target.reboots {
            session.commands(&format!("\n!RESET;\nREBOOT {PASSWORD};\n"), false)?;
            session.synchronize()?;
        }
        session.commands("INITIALIZE;\nCONNECT ERROR<1>:<1>HOST_MESSAGE;\n", false)?;
        if case.wants_warnings() {
            session.commands("CONNECT WARNING<1>:<1>HOST_MESSAGE;\n", false)?;
        }
        session.synchronize()?;
        session.messages.clear();
        Ok(session)
    }

    /// Plays all steps.
    ///
    /// # Errors
    /// The line of the step that stopped the case, and why.
    pub fn play(&mut self) -> Result<(), (usize, Stop)> {
        for (number, (line, step)) in self.case.steps.iter().enumerate() {
            if let Err(stop) = self.step(step) {
                self.give_rest(number + 1);
                return Err((*line, stop));
            }
        }
        let last = self.case.steps.last().map_or(self.case.line, |(line, _)| *line);
        self.quiet().map_err(|stop| (last, stop))
    }

    /// Gives the operator commands from a step on, whatever comes of them, so that a case that stops leaves no button
    /// pressed.
    fn give_rest(&mut self, from: usize) {
        let Some(operator) = self.operator.as_mut().filter(|operator| operator.drives_time()) else { return };
        for (_, step) in &self.case.steps[from..] {
            if let Step::OperatorCommand(order) = step {
                // The case has failed; what an operator command replies now does not matter.
                let _ = operator.give(order);
            }
        }
    }

    /// Leaves the machine empty, so that what a case began goes on for nobody.
    pub fn end(mut self) -> Vec<String> {
        let _ = self.commands("\nINITIALIZE;\n", false).and_then(|()| self.flush());
        self.line.detach();
        self.transcript.into()
    }

    fn step(&mut self, step: &Step) -> Result<(), Stop> {
        match step {
            Step::Send(text) => self.commands(text, self.case.text_only)?,
            Step::Each { first, last, text } => self.each(*first, *last, text)?,
            Step::Raw(bytes) => {
                self.note(format!("> {}", bytes.escape_ascii()));
                self.waiting.extend_from_slice(bytes);
                self.flush()?;
            }
            Step::Watch { name, output, word } => self.watch(name, *output, word.as_deref())?,
            Step::Expect(expected) => self.expect(expected)?,
            Step::OperatorCommand(order) => {
                self.synchronize()?;
                self.reply = self.operator_command(order)?;
            }
            Step::Reply(glob) => {
                let reply = std::mem::take(&mut self.reply);
                let Some(operator) = &mut self.operator else { return Err(no_operator()) };
                if !operator.confirm(&reply, glob) {
                    return Err(Stop::Failed { expected: format!("a sight like {glob}"), found: reply });
                }
                self.reply = reply;
            }
            Step::Frames(count) => self.frames(*count)?,
            Step::Strokes { count, frames, lines } => self.strokes(*count, *frames, lines)?,
            Step::Drop => {
                self.synchronize()?;
                self.messages.clear();
            }
            Step::Silence => self.quiet()?,
        }
        Ok(())
    }

    fn commands(&mut self, text: &str, text_only: bool) -> Result<(), Stop> {
        self.note(format!("> {}", text.trim_end()));
        Ok(self.sender.write(text.as_bytes(), text_only, &mut self.waiting)?)
    }

    /// Repeated commands go at once, so that a million of them need no memory.
    fn each(&mut self, first: usize, last: usize, text: &str) -> Result<(), Stop> {
        self.note(format!("> {} (# is {first} to {last})", text.trim_end()));
        let mut piece = String::new();
        for number in first..=last {
            piece.push_str(&with_number(text, number));
            if piece.len() > PIECE || number == last {
                self.sender.write(piece.as_bytes(), self.case.text_only, &mut self.waiting)?;
                self.flush()?;
                piece.clear();
            }
        }
        Ok(())
    }

    /// Sends each message of an output to the host, printed, with a word before it if there is one.
    fn watch(&mut self, name: &str, output: u16, word: Option<&str>) -> Result<(), Stop> {
        self.watched += 1;
        let n = self.watched;
        let text = match word {
            None => format!(
                "WATCHP{n} := F:PRINT; CONNECT {name}<{output}>:<1>WATCHP{n}; CONNECT WATCHP{n}<1>:<1>HOST_MESSAGE;\n"
            ),
            Some(word) => format!(
                "WATCHP{n} := F:PRINT; WATCHC{n} := F:CCONCATENATE; SEND '{word} ' TO <1>WATCHC{n}; \
                 CONNECT {name}<{output}>:<1>WATCHP{n}; CONNECT WATCHP{n}<1>:<2>WATCHC{n}; \
                 CONNECT WATCHC{n}<1>:<1>HOST_MESSAGE;\n"
            ),
        };
        self.commands(&text, false)
    }

    /// Gives what waits to the line.
    fn flush(&mut self) -> Result<(), Stop> {
        let bytes = std::mem::take(&mut self.waiting);
        for piece in self.sender.pieces(&bytes) {
            self.line.send(piece)?;
        }
        Ok(())
    }

    /// Waits until everything sent so far was carried out and its messages are here.
    fn synchronize(&mut self) -> Result<(), Stop> {
        self.tokens += 1;
        let token = format!("~{}~", self.tokens);
        let text = format!("SEND '{token}' TO <1>HOST_MESSAGE;\n");
        // A case about the text form may have stopped the interpreter of text only.
        self.sender.write(text.as_bytes(), self.case.text_only, &mut self.waiting)?;
        self.flush()?;
        let deadline = Instant::now() + self.target.timeout;
        loop {
            let Some(mut message) = self.receive(deadline)? else {
                let found = format!("nothing for {:?}, after: {}", self.target.timeout, self.collected());
                return Err(Stop::Failed { expected: "an answer of the machine".into(), found });
            };
            if message.ends_with(token.as_bytes()) {
                message.truncate(message.len() - token.len());
                // A message without an end of its own stands directly before.
                if !message.is_empty() {
                    self.arrived(message);
                }
                return Ok(());
            }
            self.arrived(message);
            if self.messages.len() > MAX_MESSAGES {
                return Err(Stop::Failed { expected: "an end of the messages".into(), found: self.collected() });
            }
        }
    }

    /// The next message from the line itself.
    fn receive(&mut self, deadline: Instant) -> Result<Option<Vec<u8>>, Stop> {
        loop {
            match self.reader.next() {
                Some(Ok(message)) => return Ok(Some(message)),
                Some(Err(error)) => {
                    let expected = "a message".into();
                    return Err(Stop::Failed { expected, found: error.to_string() });
                }
                None => {}
            }
            match self.line.receive(deadline)? {
                Some(bytes) => self.reader.push(&bytes),
                None => return Ok(None),
            }
        }
    }

    fn arrived(&mut self, message: Vec<u8>) {
        self.note(format!("< {}", message.escape_ascii()));
        self.messages.push_back(message);
    }

    /// The next message of the case; none if there is none.
    fn next_message(&mut self) -> Result<Option<Vec<u8>>, Stop> {
        if self.messages.is_empty() {
            self.synchronize()?;
        }
        // What takes a few frames has the time to end, where time stands otherwise.
        if self.messages.is_empty() && self.time_stands() {
            self.operator_command("idle 300")?;
            self.synchronize()?;
        }
        // Where time passes by itself, a message may still be on its way.
        if self.messages.is_empty() && !self.time_stands() {
            let deadline = Instant::now() + self.target.timeout;
            if let Some(message) = self.receive(deadline)? {
                self.arrived(message);
            }
        }
        Ok(self.messages.pop_front())
    }

    fn time_stands(&self) -> bool {
        self.operator.as_ref().is_some_and(|operator| operator.drives_time())
    }

    fn expect(&mut self, expected: &Expected) -> Result<(), Stop> {
        let Expected::AnyOrder(all) = expected else {
            let message = self.next_message()?;
            let is_right = message.as_ref().is_some_and(|m| self.is(expected, m));
            return if is_right { Ok(()) } else { Err(failed(expected.to_string(), message.as_deref())) };
        };
        let mut open: Vec<&Expected> = all.iter().collect();
        while !open.is_empty() {
            let message = self.next_message()?;
            let place = message.as_ref().and_then(|m| open.iter().position(|e| self.is(e, m)));
            let Some(place) = place else {
                let wanted: Vec<String> = open.iter().map(ToString::to_string).collect();
                return Err(failed(wanted.join(" or "), message.as_deref()));
            };
            open.remove(place);
        }
        Ok(())
    }

    fn is(&self, expected: &Expected, message: &[u8]) -> bool {
        matches(expected, message, self.case.tolerance, self.target.any_fault)
    }

    fn quiet(&mut self) -> Result<(), Stop> {
        self.synchronize()?;
        if self.messages.is_empty() {
            return Ok(());
        }
        Err(Stop::Failed { expected: "no message".into(), found: self.collected() })
    }

    fn collected(&self) -> String {
        let some: Vec<String> = self.messages.iter().take(10).map(|m| format!("\"{}\"", m.escape_ascii())).collect();
        let more = if self.messages.len() > 10 { " and more" } else { "" };
        if some.is_empty() { "nothing".into() } else { format!("{}{more}", some.join(", ")) }
    }

    fn operator_command(&mut self, order: &str) -> Result<String, Stop> {
        self.note(format!("@ {order}"));
        let Some(operator) = &mut self.operator else { return Err(no_operator()) };
        let reply = operator.give(order)?;
        if !reply.is_empty() && !order.starts_with("strokes") {
            self.note(format!("= {reply}"));
        }
        Ok(reply)
    }

    fn frames(&mut self, count: u64) -> Result<(), Stop> {
        self.synchronize()?;
        if self.time_stands() {
            self.operator_command(&format!("frames {count}"))?;
        } else {
            // A few frames more, for machines that are late.
            std::thread::sleep(Duration::from_millis((count + 3) * 1000 / 60));
        }
        Ok(())
    }

    fn strokes(&mut self, count: Option<usize>, frames: u64, lines: &[StrokeLine]) -> Result<(), Stop> {
        let (found, tolerance) = if self.time_stands() {
            (self.strokes_on_screen(frames)?, self.case.tolerance)
        } else if frames == 1 {
            (self.strokes_written_back()?, self.case.tolerance.max(WRITEBACK_TOLERANCE))
        } else {
            return Err(Stop::Skipped("frames that follow one another need the operator line of an emulator".into()));
        };
        match strokes_differ(count, lines, &found, tolerance) {
            None => Ok(()),
            Some(expected) => {
                let some: Vec<String> = found.iter().take(12).map(strokes::text).collect();
                let found = format!("{} strokes: {}", found.len(), some.join(" | "));
                Err(Stop::Failed { expected, found })
            }
        }
    }

    /// The strokes of so many frames, as the operator line lists them.
    fn strokes_on_screen(&mut self, frames: u64) -> Result<Vec<StrokeLine>, Stop> {
        let mut found = Vec::new();
        for _ in 0..frames {
            self.frames(1)?;
            let reply = self.operator_command("strokes")?;
            let Some(drawn) = strokes::from_operator(&reply) else {
                return Err(Stop::Failed { expected: "strokes, one a line".into(), found: reply });
            };
            found.extend(drawn);
        }
        Ok(found)
    }

    /// The strokes of the next update, over the host line: what WRITEBACK sends of all that is displayed.
    fn strokes_written_back(&mut self) -> Result<Vec<StrokeLine>, Stop> {
        self.frames(1)?;
        self.watched += 1;
        let (n, mark) = (self.watched, strokes::MARK);
        let ask = format!(
            "WATCHC{n} := F:CCONCATENATE; SEND '{mark}' TO <1>WATCHC{n}; CONNECT WRITEBACK<2>:<2>WATCHC{n}; \
             CONNECT WATCHC{n}<1>:<1>HOST_MESSAGE; SEND TRUE TO <1>WRITEBACK;\n"
        );
        self.commands(&ask, false)?;
        self.flush()?;
        let mut text = WritebackText::default();
        let deadline = Instant::now() + self.target.timeout;
        loop {
            let Some(message) = self.receive(deadline)? else {
                return Err(Stop::Skipped("WRITEBACK tells no strokes".into()));
            };
            let Some(line) = message.strip_prefix(mark.as_bytes()) else {
                self.arrived(message);
                continue;
            };
            let line = String::from_utf8_lossy(line);
            match text.line(&line) {
                Some(Continuation::Lines) => {}
                Some(Continuation::Nothing) => break,
                Some(Continuation::TooMany) => {
                    return Err(Stop::Skipped("more strokes than WRITEBACK brings over the host line".into()));
                }
                None => {
                    let expected = "the text of a vector list from WRITEBACK".into();
                    return Err(Stop::Failed { expected, found: line.into_owned() });
                }
            }
        }
        self.commands(&format!("DISCONNECT WRITEBACK<2>:<2>WATCHC{n};\n"), false)?;
        Ok(text.strokes)
    }

    fn note(&mut self, line: String) {
        if self.transcript.len() >= TRANSCRIPT_LINES {
            self.transcript.pop_front();
        }
        self.transcript.push_back(line);
    }
}

fn no_operator() -> Stop {
    Stop::Skipped("nobody is at the machine".into())
}

fn failed(expected: String, message: Option<&[u8]>) -> Stop {
    let found = message.map_or("no message".into(), |m| format!("\"{}\"", m.escape_ascii()));
    Stop::Failed { expected, found }
}
