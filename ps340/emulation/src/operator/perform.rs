//! Carrying out an operator command on a machine.

use super::{OperatorCommand, OperatorCommandRow, display, fault::REFUSED, inspect::inspect, rows};
use crate::{
    calligraphic,
    example::EXAMPLES,
    machine::{Event, Key, Machine, TabletEvent},
};
use files::Sandbox;

/// The outcome of an operator command.
#[derive(Clone, Debug, PartialEq)]
pub enum CommandOutcome {
    /// Done, with a text, or failed, with the reason.
    Done(Result<String, String>),
    /// The reply comes later: ask the wait after each step.
    Waiting(Wait),
    /// The machine is to end.
    Quit,
}

/// Something that an operator command waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// That a frame is reached.
    Frame(u64),
    /// That nothing is left to do, or the frame is reached.
    Idle(u64),
    /// That a message to the host is there, or the frame is reached.
    Message(u64),
}

impl Wait {
    /// The reply, once there is one.
    pub fn poll(self, machine: &mut Machine) -> Option<Result<String, String>> {
        let frame = machine.frame();
        match self {
            Wait::Frame(end) => (frame >= end).then(|| Ok(format!("frame {frame}"))),
            Wait::Idle(_) if machine.is_idle() => Some(Ok(format!("idle at frame {frame}"))),
            Wait::Idle(end) => (frame >= end).then(|| Err("still busy".into())),
            Wait::Message(end) => match machine.take_message() {
                Some(message) => Some(Ok(String::from_utf8_lossy(&message).into_owned())),
                None => (frame >= end).then(|| Err("no message to the host".into())),
            },
        }
    }
}

/// Carries out an operator command.
///
/// - `files`: the folder below which it writes. Without one, operator commands that reach out
///   ([`OperatorCommand::reaches_out`]) are refused.
pub fn perform(command: &OperatorCommand, machine: &mut Machine, files: Option<&Sandbox>) -> CommandOutcome {
    if command.reaches_out() && files.is_none() {
        return CommandOutcome::Done(Err(REFUSED.into()));
    }
    let frame = machine.frame();
    let event = match command {
        OperatorCommand::Dial { dial, turns } => Event::Dial { dial: *dial, turns: *turns },
        OperatorCommand::Key(key) => Event::Key(*key),
        OperatorCommand::Press(key) => Event::Press(*key),
        OperatorCommand::Mode(Some(mode)) => Event::Mode(*mode),
        OperatorCommand::Mode(None) => return CommandOutcome::Done(Ok(machine.keyboard_mode().word().into())),
        OperatorCommand::Keys => return CommandOutcome::Done(Ok(Key::names().collect::<Vec<_>>().join(" "))),
        OperatorCommand::Button(button) => Event::Button(*button),
        OperatorCommand::PuckMove(at) => Event::Tablet(TabletEvent::Move(*at)),
        OperatorCommand::PuckPress(code) => Event::Tablet(TabletEvent::Press(*code)),
        OperatorCommand::PuckRelease => Event::Tablet(TabletEvent::Release),
        OperatorCommand::PuckAway => Event::Tablet(TabletEvent::Away),
        OperatorCommand::Type(text) => Event::Type(text.clone()),
        OperatorCommand::Frames(n) => return CommandOutcome::Waiting(Wait::Frame(frame.saturating_add(*n))),
        OperatorCommand::Idle(n) => return CommandOutcome::Waiting(Wait::Idle(frame.saturating_add(*n))),
        OperatorCommand::Message { fresh, frames } => {
            if *fresh {
                while machine.take_message().is_some() {}
            }
            return CommandOutcome::Waiting(Wait::Message(frame.saturating_add(*frames)));
        }
        OperatorCommand::Messages => return CommandOutcome::Done(Ok(messages(machine))),
        OperatorCommand::Lines(_) => return CommandOutcome::Done(Ok(String::new())),
        OperatorCommand::Display(order) => return CommandOutcome::Done(display::perform(order, machine, files)),
        OperatorCommand::Show(name) => {
            return CommandOutcome::Done(machine.describe(name).ok_or(format!("there is no {name}")));
        }
        OperatorCommand::Strokes(most) => {
            machine.renew_picture();
            return CommandOutcome::Done(Ok(calligraphic::text(&machine.latest_update().strokes, *most)));
        }
        OperatorCommand::Overlay(most) => {
            return CommandOutcome::Done(Ok(calligraphic::text(machine.overlay(), *most)));
        }
        OperatorCommand::Counters => return CommandOutcome::Done(Ok(machine.counters().to_string())),
        OperatorCommand::Inspect(what) => return CommandOutcome::Done(inspect(what, machine, files)),
        OperatorCommand::Panel => {
            return CommandOutcome::Done(Ok(format!("{}\n{}", machine.panel(), machine.switches())));
        }
        OperatorCommand::Terminal => return CommandOutcome::Done(Ok(machine.terminal().text())),
        OperatorCommand::Log => return CommandOutcome::Done(Ok(machine.log().collect::<Vec<_>>().join("\n"))),
        OperatorCommand::Example(None) => {
            let lines = EXAMPLES.iter().map(|example| format!("{:<8} {}", example.name, example.summary()));
            return CommandOutcome::Done(Ok(lines.collect::<Vec<_>>().join("\n")));
        }
        OperatorCommand::Example(Some(example)) => {
            machine.run_program(example.text.as_bytes());
            return CommandOutcome::Done(Ok(example.summary().into()));
        }
        OperatorCommand::Help(None) => return CommandOutcome::Done(Ok(help())),
        OperatorCommand::Help(Some(row)) => return CommandOutcome::Done(Ok(help_on(row))),
        OperatorCommand::Quit => return CommandOutcome::Quit,
    };
    machine.event(event);
    CommandOutcome::Done(Ok(String::new()))
}

fn help() -> String {
    rows().map(help_on).collect::<Vec<_>>().join("\n")
}

fn help_on(row: &OperatorCommandRow) -> String {
    format!("{:<50} {}", format!("{} {}", row.word, row.arguments), row.summary)
}

/// The messages to the host that nobody took, one a line.
fn messages(machine: &mut Machine) -> String {
    let taken = std::iter::from_fn(|| machine.take_message());
    let lines: Vec<String> = taken.map(|message| String::from_utf8_lossy(&message).into_owned()).collect();
    if lines.is_empty() { "no message to the host".into() } else { lines.join("\n") }
}
