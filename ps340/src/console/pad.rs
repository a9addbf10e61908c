//! A game controller: its buttons give operator commands, its axes turn dials.
//!
//! # Source
//! The joystick interface of Linux (`/dev/input/jsN`): records of eight bytes, in the byte order of the machine: time
//! in milliseconds (u32), value (i16), kind (u8: 1 button, 2 axis, 128 added for the state at the start), number (u8).
//! Elsewhere there is no controller.

use super::{dials::DialPanel, mapping::Mapping, operator_commands::OperatorCommands};
use std::{
    collections::BTreeMap,
    fs::File,
    io::Read,
    sync::mpsc::{Receiver, Sender, channel},
    time::Duration,
};

/// Bytes of a record.
const RECORD: usize = 8;
const BUTTON: u8 = 1;
const AXIS: u8 = 2;
/// Marks the state at the start.
const INITIAL: u8 = 128;
/// Controllers that are looked for.
const CONTROLLERS: u8 = 4;
/// How often a controller that is not there is looked for.
const RETRY: Duration = Duration::from_secs(3);
/// Part of the way of an axis, near its middle, where it does not turn anything.
const DEAD: f64 = 0.12;
/// Longest time that one frame may turn a dial for, in seconds.
const LONGEST_FRAME: f64 = 0.1;

/// What happens at a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PadEvent {
    /// A button goes down.
    Press(u8),
    /// An axis moves to a position, -1..=1.
    Move(u8, f64),
}

impl PadEvent {
    /// The event of a record; none for a button that comes up, or is down at the start.
    fn read(record: [u8; RECORD]) -> Option<PadEvent> {
        let [_, _, _, _, low, high, kind, number] = record;
        let value = i16::from_ne_bytes([low, high]);
        match kind & !INITIAL {
            BUTTON if value != 0 && kind & INITIAL == 0 => Some(PadEvent::Press(number)),
            AXIS => Some(PadEvent::Move(number, (f64::from(value) / f64::from(i16::MAX)).max(-1.0))),
            _ => None,
        }
    }
}

/// The controllers.
pub struct Pad {
    events: Receiver<PadEvent>,
    /// Where each axis that is not in its middle stands.
    axes: BTreeMap<u8, f64>,
}

impl Pad {
    /// Looks for controllers from now on, in threads that wake `context` when something happens.
    pub fn new(context: &egui::Context) -> Pad {
        let (sender, events) = channel();
        if cfg!(target_os = "linux") {
            for number in 0..CONTROLLERS {
                let (sender, context) = (sender.clone(), context.clone());
                std::thread::spawn(move || follow(number, &sender, &context));
            }
        }
        Pad { events, axes: BTreeMap::new() }
    }

    /// Gives the operator commands of the buttons, and turns dials by the axes.
    ///
    /// - `seconds`: since the frame before.
    pub fn act(
        &mut self,
        seconds: f64,
        mapping: &Mapping,
        dials: &mut DialPanel,
        commands: &mut OperatorCommands,
        context: &egui::Context,
    ) {
        for event in self.events.try_iter() {
            match event {
                PadEvent::Press(button) => {
                    if let Some(order) = mapping.button(button) {
                        commands.give(order);
                    }
                }
                PadEvent::Move(axis, place) if place.abs() > DEAD => drop(self.axes.insert(axis, place)),
                PadEvent::Move(axis, _) => drop(self.axes.remove(&axis)),
            }
        }
        for (axis, place) in &self.axes {
            if let Some((dial, turns)) = mapping.axis(*axis) {
                let way = (place.abs() - DEAD) / (1.0 - DEAD) * place.signum();
                dials.turn(dial, turns * way * seconds.min(LONGEST_FRAME));
                context.request_repaint();
            }
        }
    }
}

/// Reads a controller whenever it is there, until the window is closed.
fn follow(number: u8, events: &Sender<PadEvent>, context: &egui::Context) {
    loop {
        if let Ok(mut file) = File::open(format!("/dev/input/js{number}")) {
            let mut record = [0; RECORD];
            while file.read_exact(&mut record).is_ok() {
                if let Some(event) = PadEvent::read(record) {
                    if events.send(event).is_err() {
                        return;
                    }
                    context.request_repaint();
                }
            }
        }
        std::thread::sleep(RETRY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(value: i16, kind: u8, number: u8) -> [u8; RECORD] {
        let [low, high] = value.to_ne_bytes();
        [0, 0, 0, 0, low, high, kind, number]
    }

    #[test]
    fn records_are_read() {
        assert_eq!(PadEvent::read(record(1, BUTTON, 3)), Some(PadEvent::Press(3)));
        assert_eq!(PadEvent::read(record(0, BUTTON, 3)), None);
        assert_eq!(PadEvent::read(record(1, BUTTON | INITIAL, 3)), None);
        assert_eq!(PadEvent::read(record(i16::MAX, AXIS, 1)), Some(PadEvent::Move(1, 1.0)));
        assert_eq!(PadEvent::read(record(i16::MIN, AXIS | INITIAL, 0)), Some(PadEvent::Move(0, -1.0)));
    }
}
