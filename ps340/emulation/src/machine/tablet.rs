//! The data tablet with its stylus or puck.
//!
//! # Source
//! A press sends `<6>` exactly once and `<3>` with the new code, a release `<3>` = 0 and `<2>` = FALSE, as clients of
//! the time rely on; `<1>` and `<4>` are the position while in range (remembered) and while pressed (uncertain).
//!
//! That `<3>` sends 0 with every report of the tablet while nothing is down is deduced from a client. Its locator
//! passes `<3>` through F:DELTA, which would be needless if `<3>` sent on change only, and takes the arc away between
//! press and release: a second press of the same button is a change for F:DELTA only if 0 came in between.
//!
//! The rest is ours: the order of the messages of one event; that `<1>` sends only when a position is reported; the
//! commands; that a 0 goes before every code of a single button, and `<6>` with it, which keeps the two in pairs
//! whatever rolls, chords and changes of the network come between; that a held code is not repeated, since a program
//! that connects meanwhile would take it for a press without a position.

use super::device_message::DeviceMessage;
use crate::port::TabletCommand;
use glam::DVec2;
use protocol::Value;

/// What stylus or puck does. The tip switch of the stylus is button 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TabletEvent {
    /// Is put or moved to a position, -1..=1.
    Move([f64; 2]),
    /// Buttons with this sum of codes (1, 2, 4, 8) are down.
    Press(u8),
    /// All buttons are up.
    Release,
    /// Is taken off the tablet.
    Away,
}

const NAME: &str = "TABLETIN";
const STREAM: u16 = 1;
const SWITCH: u16 = 2;
const BUTTONS: u16 = 3;
const DRAWING: u16 = 4;
const PROXIMITY: u16 = 5;
const PRESS: u16 = 6;

/// The state of the tablet.
#[derive(Debug, Default)]
pub(super) struct Tablet {
    in_range: bool,
    position: [f64; 2],
    buttons: u8,
    /// When `<1>` sends: never [`TabletCommand::Trigger`].
    mode: TabletCommand,
}

impl Tablet {
    /// Where stylus or puck is, while it is in range.
    pub(super) fn pointer(&self) -> Option<[f64; 2]> {
        self.in_range.then_some(self.position)
    }

    /// A command, and what it makes the tablet send.
    pub(super) fn command(&mut self, command: TabletCommand) -> Vec<DeviceMessage> {
        match command {
            TabletCommand::Trigger if self.in_range => vec![self.here(STREAM)],
            TabletCommand::Trigger => Vec::new(),
            mode => {
                self.mode = mode;
                Vec::new()
            }
        }
    }

    /// What an event makes TABLETIN send.
    pub(super) fn event(&mut self, event: TabletEvent) -> Vec<DeviceMessage> {
        let mut out = Vec::new();
        match event {
            TabletEvent::Move(at) if at.iter().all(|c| c.is_finite()) => {
                self.position = at.map(|c| c.clamp(-1.0, 1.0));
                self.enter(&mut out);
                let streams = match self.mode {
                    TabletCommand::Stream => true,
                    TabletCommand::SwitchStream => self.buttons != 0,
                    _ => false,
                };
                if streams {
                    out.push(self.here(STREAM));
                }
                match self.buttons {
                    0 => out.push(code(0)),
                    _ => out.push(self.here(DRAWING)),
                }
            }
            TabletEvent::Move(_) => {}
            TabletEvent::Press(0) | TabletEvent::Release => self.release(&mut out),
            TabletEvent::Press(buttons) => self.press(buttons, &mut out),
            TabletEvent::Away => {
                self.release(&mut out);
                if std::mem::take(&mut self.in_range) {
                    out.push((NAME, PROXIMITY, Value::Boolean(false)));
                }
            }
        }
        out
    }

    /// Comes into range, if it was not.
    fn enter(&mut self, out: &mut Vec<DeviceMessage>) {
        if !std::mem::replace(&mut self.in_range, true) {
            out.push((NAME, PROXIMITY, Value::Boolean(true)));
        }
    }

    /// A press somewhere off the tablet is one at the last position. Ours.
    fn press(&mut self, buttons: u8, out: &mut Vec<DeviceMessage>) {
        if !self.in_range {
            out.extend(self.event(TabletEvent::Move(self.position)));
        }
        let before = std::mem::replace(&mut self.buttons, buttons);
        if before == buttons {
            return;
        }
        if before == 0 {
            out.push((NAME, SWITCH, Value::Boolean(true)));
            if matches!(self.mode, TabletCommand::Point | TabletCommand::SwitchStream) {
                out.push(self.here(STREAM));
            }
        }
        let is_single = buttons.is_power_of_two();
        if is_single {
            out.push(code(0));
        }
        out.push(code(buttons));
        if before == 0 {
            out.push(self.here(DRAWING));
        }
        if is_single {
            out.push(self.here(PRESS));
        }
    }

    fn release(&mut self, out: &mut Vec<DeviceMessage>) {
        if std::mem::take(&mut self.buttons) != 0 {
            out.push(code(0));
            out.push((NAME, SWITCH, Value::Boolean(false)));
        }
    }

    fn here(&self, output: u16) -> DeviceMessage {
        (NAME, output, Value::Vector2(DVec2::from_array(self.position)))
    }
}

fn code(buttons: u8) -> DeviceMessage {
    (NAME, BUTTONS, Value::Integer(buttons.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Outputs and values of the messages of some events, as text.
    fn sent(tablet: &mut Tablet, events: &[TabletEvent]) -> String {
        let all = events.iter().flat_map(|event| tablet.event(*event)).map(|(name, output, value)| {
            assert_eq!(name, NAME);
            match value {
                Value::Boolean(b) => format!("<{output}>{b}"),
                Value::Integer(i) => format!("<{output}>{i}"),
                Value::Vector2(v) => format!("<{output}>{},{}", v.x, v.y),
                other => panic!("{other:?}"),
            }
        });
        all.collect::<Vec<_>>().join(" ")
    }

    use TabletEvent::{Away, Move, Press, Release};

    #[test]
    fn a_press_sends_place_and_code_once_and_a_release_zero_and_false() {
        let mut tablet = Tablet::default();
        assert_eq!(sent(&mut tablet, &[Move([0.25, -0.125])]), "<5>true <1>0.25,-0.125 <3>0");
        assert_eq!(sent(&mut tablet, &[Press(4)]), "<2>true <3>0 <3>4 <4>0.25,-0.125 <6>0.25,-0.125");
        assert_eq!(sent(&mut tablet, &[Press(4)]), "", "the same buttons are still down");
        assert_eq!(sent(&mut tablet, &[Move([0.5, 0.0])]), "<1>0.5,0 <4>0.5,0");
        assert_eq!(sent(&mut tablet, &[Release, Release]), "<3>0 <2>false");
        assert_eq!(sent(&mut tablet, &[Move([0.0, 0.0])]), "<1>0,0 <3>0");
        assert_eq!(sent(&mut tablet, &[Away, Away]), "<5>false");
    }

    #[test]
    fn every_code_of_one_button_has_its_place_and_chords_have_none() {
        let mut tablet = Tablet::default();
        sent(&mut tablet, &[Move([0.5, 0.0]), Press(1)]);
        assert_eq!(sent(&mut tablet, &[Press(2)]), "<3>0 <3>2 <6>0.5,0", "rolled from button to button");
        assert_eq!(sent(&mut tablet, &[Press(3)]), "<3>3");
        assert_eq!(sent(&mut tablet, &[Press(2)]), "<3>0 <3>2 <6>0.5,0");
        assert_eq!(sent(&mut tablet, &[Press(0)]), "<3>0 <2>false", "no button is a release");
        assert_eq!(sent(&mut tablet, &[Press(9)]), "<2>true <3>9 <4>0.5,0");
    }

    #[test]
    fn leaving_the_tablet_releases_the_buttons_and_a_press_brings_it_back() {
        let mut tablet = Tablet::default();
        sent(&mut tablet, &[Move([0.5, 0.5]), Press(8)]);
        assert_eq!(sent(&mut tablet, &[Away]), "<3>0 <2>false <5>false");
        assert_eq!(tablet.pointer(), None);
        let back = sent(&mut tablet, &[Press(1)]);
        assert_eq!(back, "<5>true <1>0.5,0.5 <3>0 <2>true <3>0 <3>1 <4>0.5,0.5 <6>0.5,0.5");
    }

    #[test]
    fn commands_choose_when_the_position_streams() {
        let all = [Move([0.5, 0.0]), Press(1), Move([1.0, 0.0]), Release, Move([0.0, 0.0])];
        let streamed = |command| {
            let mut tablet = Tablet::default();
            assert!(tablet.command(command).is_empty());
            sent(&mut tablet, &all).matches("<1>").count()
        };
        assert_eq!(streamed(TabletCommand::Stream), 3);
        assert_eq!(streamed(TabletCommand::SwitchStream), 2);
        assert_eq!(streamed(TabletCommand::Point), 1);
        assert_eq!(streamed(TabletCommand::Remote), 0);
        let mut tablet = Tablet::default();
        assert!(tablet.command(TabletCommand::Trigger).is_empty(), "nothing is in range");
        tablet.event(Move([0.5, 0.0]));
        assert_eq!(tablet.command(TabletCommand::Trigger), [(NAME, STREAM, Value::Vector2(DVec2::new(0.5, 0.0)))]);
    }

    #[test]
    fn places_stay_on_the_tablet() {
        let mut tablet = Tablet::default();
        assert_eq!(sent(&mut tablet, &[Move([5.0, -7.0])]), "<5>true <1>1,-1 <3>0");
        assert_eq!(sent(&mut tablet, &[Move([f64::NAN, 0.0])]), "");
    }
}
