//! Carrying out an order on a machine.

use super::{Order, OrderRow, fault::REFUSED, inspect::inspect, rows, sight};
use crate::{
    calligraphic,
    example::EXAMPLES,
    machine::{Event, Key, Machine, TabletEvent},
};
use files::Beneath;

/// What came of an order.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Done, with a text, or failed, with the reason.
    Done(Result<String, String>),
    /// The reply comes later: ask the wait after each step.
    Waiting(Wait),
    /// The machine is to end.
    Quit,
}

/// Something that an order waits for.
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

/// Carries out an order.
///
/// - `files`: the folder below which it writes. Without one, orders that reach out ([`Order::reaches_out`]) are refused.
pub fn perform(order: &Order, machine: &mut Machine, files: Option<&Beneath>) -> Outcome {
    if order.reaches_out() && files.is_none() {
        return Outcome::Done(Err(REFUSED.into()));
    }
    let frame = machine.frame();
    let event = match order {
        Order::Dial { dial, turns } => Event::Dial { dial: *dial, turns: *turns },
        Order::Key(key) => Event::Key(*key),
        Order::Press(key) => Event::Press(*key),
        Order::Mode(Some(mode)) => Event::Mode(*mode),
        Order::Mode(None) => return Outcome::Done(Ok(machine.keyboard_mode().word().into())),
        Order::Keys => return Outcome::Done(Ok(Key::names().collect::<Vec<_>>().join(" "))),
        Order::Button(button) => Event::Button(*button),
        Order::PuckMove(at) => Event::Tablet(TabletEvent::Move(*at)),
        Order::PuckPress(code) => Event::Tablet(TabletEvent::Press(*code)),
        Order::PuckRelease => Event::Tablet(TabletEvent::Release),
        Order::PuckAway => Event::Tablet(TabletEvent::Away),
        Order::Type(text) => Event::Type(text.clone()),
        Order::Frames(n) => return Outcome::Waiting(Wait::Frame(frame.saturating_add(*n))),
        Order::Idle(n) => return Outcome::Waiting(Wait::Idle(frame.saturating_add(*n))),
        Order::Message { fresh, frames } => {
            if *fresh {
                while machine.take_message().is_some() {}
            }
            return Outcome::Waiting(Wait::Message(frame.saturating_add(*frames)));
        }
        Order::Messages => return Outcome::Done(Ok(messages(machine))),
        Order::Lines(_) => return Outcome::Done(Ok(String::new())),
        Order::Sight(order) => return Outcome::Done(sight::perform(order, machine, files)),
        Order::Show(name) => return Outcome::Done(machine.describe(name).ok_or(format!("there is no {name}"))),
        Order::Strokes(most) => {
            machine.renew_picture();
            return Outcome::Done(Ok(calligraphic::text(&machine.latest_update().strokes, *most)));
        }
        Order::Overlay(most) => return Outcome::Done(Ok(calligraphic::text(machine.overlay(), *most))),
        Order::Counters => return Outcome::Done(Ok(machine.counters().to_string())),
        Order::Inspect(what) => return Outcome::Done(inspect(what, machine, files)),
        Order::Panel => {
            return Outcome::Done(Ok(format!("{}\n{}", machine.panel(), machine.switches())));
        }
        Order::Terminal => return Outcome::Done(Ok(machine.terminal().text())),
        Order::Log => return Outcome::Done(Ok(machine.log().collect::<Vec<_>>().join("\n"))),
        Order::Example(None) => {
            let lines = EXAMPLES.iter().map(|example| format!("{:<8} {}", example.name, example.summary()));
            return Outcome::Done(Ok(lines.collect::<Vec<_>>().join("\n")));
        }
        Order::Example(Some(example)) => {
            machine.run_program(example.text.as_bytes());
            return Outcome::Done(Ok(example.summary().into()));
        }
        Order::Help(None) => return Outcome::Done(Ok(help())),
        Order::Help(Some(row)) => return Outcome::Done(Ok(help_on(row))),
        Order::Quit => return Outcome::Quit,
    };
    machine.event(event);
    Outcome::Done(Ok(String::new()))
}

fn help() -> String {
    rows().map(help_on).collect::<Vec<_>>().join("\n")
}

fn help_on(row: &OrderRow) -> String {
    format!("{:<50} {}", format!("{} {}", row.word, row.arguments), row.summary)
}

/// The messages to the host that nobody took, one a line.
fn messages(machine: &mut Machine) -> String {
    let taken = std::iter::from_fn(|| machine.take_message());
    let lines: Vec<String> = taken.map(|message| String::from_utf8_lossy(&message).into_owned()).collect();
    if lines.is_empty() { "no message to the host".into() } else { lines.join("\n") }
}
