//! What a person does at the devices, and what their initial instances send for it.
//!
//! Dials send at samples, everything else at once. Keyboard and screen have modules of their own (`keyboard`, `tube`).

use super::{
    device_message::DeviceMessage,
    dials::Dials,
    key::{Key, KeyboardMode},
    tablet::{Tablet, TabletEvent},
};
use crate::port::{DialSetting, TabletCommand};
use protocol::Value;

/// Something that a person does.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Turns a dial, 1..=8, by so many turns, clockwise positive.
    Dial {
        /// 1..=8.
        dial: u8,
        /// 1.0 is a full turn.
        turns: f64,
    },
    /// Presses a function key: 1..=12, with SHIFT 13..=24, with CONTROL 25..=36.
    Key(u8),
    /// Presses a lighted button, 1..=32.
    Button(u8),
    /// Uses the tablet.
    Tablet(TabletEvent),
    /// Types characters.
    Type(Vec<u8>),
    /// Presses a key of the keyboard that has a name.
    Press(Key),
    /// Gives the keyboard another mode, as the keys HOST, LOCAL and COMMAND do.
    Mode(KeyboardMode),
}

/// The state of dials and tablet.
#[derive(Debug, Default)]
pub(super) struct Devices {
    dials: Dials,
    tablet: Tablet,
}

impl Devices {
    /// Whether all are idle: nothing waits for a frame.
    pub(super) fn is_quiet(&self) -> bool {
        self.dials.is_idle()
    }

    /// What an event makes the instances send at once.
    pub(super) fn event(&mut self, event: &Event) -> Vec<DeviceMessage> {
        match event {
            Event::Dial { dial, turns } => {
                self.dials.turn(*dial, *turns);
                Vec::new()
            }
            Event::Key(key) => vec![("FKEYS", 1, Value::Integer((*key).into()))],
            Event::Button(button) => vec![("BUTTONSIN", 1, Value::Integer((*button).into()))],
            Event::Tablet(event) => self.tablet.event(*event),
            Event::Type(_) | Event::Press(_) | Event::Mode(_) => Vec::new(),
        }
    }

    /// What the dials send at a frame.
    pub(super) fn frame(&mut self, frame: u64) -> Vec<DeviceMessage> {
        self.dials.sample(frame)
    }

    /// How a dial is sampled from now on.
    pub(super) fn set_dial(&mut self, dial: u8, setting: DialSetting) {
        self.dials.set(dial, setting);
    }

    /// A command to the tablet, and what it answers.
    pub(super) fn command_tablet(&mut self, command: TabletCommand) -> Vec<DeviceMessage> {
        self.tablet.command(command)
    }

    /// Where stylus or puck is, -1..=1, while it is in range.
    pub(super) fn pointer(&self) -> Option<[f64; 2]> {
        self.tablet.pointer()
    }
}
