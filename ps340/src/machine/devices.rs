//! Dials, keys, buttons, tablet and keyboard: what their initial instances send.
//!
//! # Source
//! Outputs of TABLETIN: a press sends `<6>` exactly once and `<3>` with the new code, a release `<3>` = 0 and
//! `<2>` = FALSE, as clients of the time rely on; `<1>` and `<4>` are the position while in range (remembered) and while
//! pressed (uncertain).

use glam::DVec2;
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
    /// Types characters in interactive mode.
    Type(Vec<u8>),
}

/// What the puck does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TabletEvent {
    /// Is put or moved to a place, -1..=1.
    Move([f64; 2]),
    /// Buttons with this sum of codes (1, 2, 4, 8) are down.
    Press(u8),
    /// All buttons are up.
    Release,
    /// Is taken off the tablet.
    Away,
}

/// Instance, output and value of a message from a device.
pub(super) type Emission = (&'static str, u16, Value);

/// The state of the devices.
#[derive(Debug, Default)]
pub(super) struct Devices {
    /// Turns of each dial since the last frame.
    dials: [f64; 8],
    in_range: bool,
    position: [f64; 2],
    buttons: u8,
}

impl Devices {
    /// Whether nothing waits for the next frame.
    pub(super) fn is_quiet(&self) -> bool {
        self.dials.iter().all(|t| *t == 0.0)
    }

    /// What an event makes the instances send at once.
    pub(super) fn event(&mut self, event: Event) -> Vec<Emission> {
        match event {
            Event::Dial { dial, turns } => {
                if let Some(sum) = self.dials.get_mut(usize::from(dial).wrapping_sub(1))
                    && turns.is_finite()
                {
                    *sum += turns;
                }
                Vec::new()
            }
            Event::Key(key) => vec![("FKEYS", 1, Value::Integer(key.into()))],
            Event::Button(button) => vec![("BUTTONSIN", 1, Value::Integer(button.into()))],
            Event::Tablet(event) => self.tablet(event),
            Event::Type(text) => {
                let places = [("KEYBOARD", 1), ("KBHANDLER", 4)];
                let typed = text.iter().flat_map(|c| places.map(|(to, output)| (to, output, Value::string([*c]))));
                typed.collect()
            }
        }
    }

    /// What the dials send at a frame: one message a dial at most, with the sum of its turns. Ours.
    pub(super) fn frame(&mut self) -> Vec<Emission> {
        let turned = std::mem::take(&mut self.dials);
        let moved = (1..).zip(turned).filter(|(_, turns)| *turns != 0.0);
        moved.map(|(output, turns)| ("DIALS", output, Value::Real(turns))).collect()
    }

    fn tablet(&mut self, event: TabletEvent) -> Vec<Emission> {
        const TABLET: &str = "TABLETIN";
        let mut out = Vec::new();
        let here = |at: [f64; 2]| Value::Vector2(DVec2::from_array(at));
        match event {
            TabletEvent::Move(at) => {
                self.position = at;
                if !std::mem::replace(&mut self.in_range, true) {
                    out.push((TABLET, 5, Value::Boolean(true)));
                }
                out.push((TABLET, 1, here(at)));
                if self.buttons != 0 {
                    out.push((TABLET, 4, here(at)));
                }
            }
            TabletEvent::Press(code) => {
                let before = std::mem::replace(&mut self.buttons, code);
                if before == code {
                    return out;
                }
                if before == 0 {
                    out.push((TABLET, 2, Value::Boolean(true)));
                }
                out.push((TABLET, 3, Value::Integer(code.into())));
                if before == 0 {
                    out.push((TABLET, 4, here(self.position)));
                    out.push((TABLET, 6, here(self.position)));
                }
            }
            TabletEvent::Release => {
                if std::mem::take(&mut self.buttons) != 0 {
                    out.push((TABLET, 3, Value::Integer(0)));
                    out.push((TABLET, 2, Value::Boolean(false)));
                }
            }
            TabletEvent::Away => {
                out.extend(self.tablet(TabletEvent::Release));
                if std::mem::take(&mut self.in_range) {
                    out.push((TABLET, 5, Value::Boolean(false)));
                }
            }
        }
        out
    }
}
