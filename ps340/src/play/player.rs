//! The player: a machine, one host on its line, an operator, and time that passes only while a step waits.

use super::script::{Expected, Script, ScriptLine, Step};
use crate::{
    line::LineId,
    machine::{Input, Machine, Micros, Settings, time_of_frame},
    operator::{CommandOutcome, perform},
};
use files::Sandbox;
use std::collections::VecDeque;

/// The host line that the text of the files goes to.
const LINE: LineId = LineId(1);
/// Messages of the machine that wait to be expected; older ones of the classes W and I are forgotten.
const MAX_PENDING_MESSAGES: usize = 10_000;

/// How a run waits, and what it forgives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlayOptions {
    /// Frames that a step waits for a message by default.
    pub frames: u64,
    /// Whether a failed step lets the run go on, and errors of the machine that no step expected are forgiven.
    pub keep_going: bool,
}

impl Default for PlayOptions {
    /// A second, and no forgiveness.
    fn default() -> PlayOptions {
        PlayOptions { frames: 60, keep_going: false }
    }
}

/// What is reported to somebody who watches a run. Methods may do nothing.
pub trait Watcher {
    /// A line of the transcript: `>` text to the machine, `@` a directive, `=` the reply of the operator's line, `<` a
    /// message to the host, `!` a message of the machine.
    fn log(&mut self, sign: char, text: &[u8]);

    /// A frame has passed, or a line was begun. Returns whether the run is to end.
    fn stops(&mut self, file: &str, line: usize, frame: u64) -> bool;
}

/// A step that failed, or an error that no step expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong: what was expected, and what came.
    pub text: String,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.text)
    }
}

/// How a file ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayEnd {
    /// All its lines were played.
    Played,
    /// A step failed, and the run does not go on.
    Failed,
    /// By the operator command `quit`.
    Quit,
    /// Whoever watches ended it.
    Stopped,
}

/// A machine that plays command files.
#[derive(Debug)]
pub struct Player {
    machine: Machine,
    options: PlayOptions,
    /// The folder below which operator commands write; none if they may not.
    files: Option<Sandbox>,
    /// Messages of the machine that were taken from its log.
    checked_messages: u64,
    /// Messages of the machine that no step has expected yet, with the line during which they came.
    waiting: VecDeque<Failure>,
    /// The file and line that is played.
    file: String,
    line: usize,
    /// Bytes to the host that are no whole line yet.
    partial: Vec<u8>,
    failures: Vec<Failure>,
    steps: u64,
    /// Lines of the files that the machine has not got: directives.
    unsent: usize,
}

impl Player {
    /// A machine as after its start, with a host on its line.
    ///
    /// - `files`: the folder below which operator commands write; without one, those that write files or end the
    ///   machine fail.
    pub fn new(settings: Settings, options: PlayOptions, files: Option<Sandbox>) -> Player {
        let mut machine = Machine::new(settings);
        machine.step([Input::Attach(LINE)], 0);
        Player {
            machine,
            options,
            files,
            checked_messages: 0,
            waiting: VecDeque::new(),
            file: String::new(),
            line: 0,
            partial: Vec::new(),
            failures: Vec::new(),
            steps: 0,
            unsent: 0,
        }
    }

    /// Plays a file. What it leaves in the machine stays for the next one.
    pub fn play(&mut self, script: &Script, watcher: &mut dyn Watcher) -> PlayEnd {
        self.file.clone_from(&script.file);
        for ScriptLine { number, step } in &script.lines {
            self.line = *number;
            if watcher.stops(&self.file, self.line, self.machine.frame()) {
                return PlayEnd::Stopped;
            }
            self.unsent += 1;
            let end = match step {
                Step::Nothing => None,
                Step::Text(text) => {
                    // Directives count as empty lines, so that the lines that the machine counts are those of the file.
                    let mut bytes = vec![b'\n'; std::mem::take(&mut self.unsent) - 1];
                    bytes.extend_from_slice(text);
                    if !text.trim_ascii().is_empty() {
                        watcher.log('>', text.trim_ascii_end());
                    }
                    self.step([Input::Bytes(LINE, bytes)], 0, watcher);
                    None
                }
                Step::OperatorCommand(order, text) => {
                    watcher.log('@', text.as_bytes());
                    let outcome = perform(order, &mut self.machine, self.files.as_ref());
                    self.step([], 0, watcher);
                    self.perform_command(outcome, watcher)
                }
                Step::Expect { expected, within } => {
                    watcher.log('@', format!("expect {expected}").as_bytes());
                    self.steps += 1;
                    self.expect(expected, within.unwrap_or(self.options.frames), watcher)
                }
            };
            match end {
                Some(PlayEnd::Failed) if self.options.keep_going => {}
                Some(end) => return end,
                None => {}
            }
        }
        PlayEnd::Played
    }

    /// Lets frames pass.
    pub fn wait(&mut self, frames: u64, watcher: &mut dyn Watcher) -> PlayEnd {
        for _ in 0..frames {
            if self.frame(watcher) {
                return PlayEnd::Stopped;
            }
        }
        PlayEnd::Played
    }

    /// Ends the line of the host: what it began and did not end is given up, and reported.
    pub fn hang_up(&mut self, watcher: &mut dyn Watcher) {
        self.step([Input::Detach(LINE)], 0, watcher);
    }

    /// The failures of the run in the order of their lines: steps that failed and, unless they are forgiven, errors
    /// of the machine that no step expected. Those are given once.
    pub fn take_failures(&mut self) -> Vec<Failure> {
        let mut failures = std::mem::take(&mut self.failures);
        let unexpected = std::mem::take(&mut self.waiting).into_iter().filter(|message| message.text.starts_with('E'));
        if !self.options.keep_going {
            // Errors come first: they are why a step failed.
            failures.splice(0..0, unexpected.map(|m| Failure { text: format!("unexpected: {}", m.text), ..m }));
        }
        failures
    }

    /// Expectations that were played.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The machine.
    pub fn machine(&mut self) -> &mut Machine {
        &mut self.machine
    }

    fn fail(&mut self, text: String) -> Option<PlayEnd> {
        self.failures.push(Failure { file: self.file.clone(), line: self.line, text });
        Some(PlayEnd::Failed)
    }

    fn perform_command(&mut self, outcome: CommandOutcome, watcher: &mut dyn Watcher) -> Option<PlayEnd> {
        let result = match outcome {
            CommandOutcome::Quit => return Some(PlayEnd::Quit),
            CommandOutcome::Done(result) => result,
            CommandOutcome::Waiting(wait) => loop {
                if let Some(result) = wait.poll(&mut self.machine) {
                    break result;
                }
                if self.frame(watcher) {
                    return Some(PlayEnd::Stopped);
                }
            },
        };
        watcher.log('=', crate::operator::reply(&result).as_bytes());
        result.err().and_then(|error| self.fail(error))
    }

    fn expect(&mut self, expected: &Expected, frames: u64, watcher: &mut dyn Watcher) -> Option<PlayEnd> {
        let last = self.machine.frame().saturating_add(frames);
        loop {
            match expected {
                Expected::Error(pattern) => {
                    let class = pattern.first().copied().unwrap_or(b'E');
                    let found = self.waiting.iter().position(|m| m.text.as_bytes().first() == Some(&class));
                    if let Some(message) = found.and_then(|at| self.waiting.remove(at)) {
                        if expected.is_error(&message.text) {
                            return None;
                        }
                        return self.fail(format!("expected {expected}, got {}", message.text));
                    }
                }
                Expected::Typed(characters) => {
                    let typed = self.machine.typed();
                    if typed.starts_with(characters) {
                        self.machine.take_typed(characters.len());
                        return None;
                    }
                    if !characters.starts_with(typed) {
                        let came = typed.escape_ascii().to_string();
                        return self.fail(format!("expected {expected}, got '{came}'"));
                    }
                }
                _ => {
                    if let Some(message) = self.machine.take_message() {
                        if expected.is(&message) {
                            return None;
                        }
                        let came = String::from_utf8_lossy(&message).into_owned();
                        return self.fail(format!("expected {expected}, got '{}'", came.escape_debug()));
                    }
                }
            }
            if self.machine.frame() >= last {
                return match expected {
                    Expected::None => None,
                    _ => self.fail(format!("expected {expected}, got nothing in {frames} frames")),
                };
            }
            if self.frame(watcher) {
                return Some(PlayEnd::Stopped);
            }
        }
    }

    /// Lets one frame pass. Returns whether the run is to end.
    fn frame(&mut self, watcher: &mut dyn Watcher) -> bool {
        self.step([], time_of_frame(self.machine.frame() + 1), watcher);
        watcher.stops(&self.file, self.line, self.machine.frame())
    }

    fn step<const N: usize>(&mut self, inputs: [Input; N], until: Micros, watcher: &mut dyn Watcher) {
        for output in self.machine.step(inputs, until) {
            self.partial.extend_from_slice(&output.bytes);
        }
        let end = self.partial.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        for line in self.partial[..end].split_inclusive(|byte| *byte == b'\n') {
            watcher.log('<', line.trim_ascii_end());
        }
        self.partial.drain(..end);
        let said = self.machine.counters().messages;
        let new = usize::try_from(said - self.checked_messages).unwrap_or(usize::MAX);
        self.checked_messages = said;
        let kept = self.machine.log().count();
        let place = |text: &str| Failure { file: self.file.clone(), line: self.line, text: text.into() };
        for text in self.machine.log().skip(kept.saturating_sub(new)) {
            watcher.log('!', text.as_bytes());
            self.waiting.push_back(place(text));
            if self.waiting.len() > MAX_PENDING_MESSAGES {
                self.waiting.pop_front();
            }
        }
    }
}
