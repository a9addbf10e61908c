//! What keys of the window, the mouse and a game controller do: a table from a file, each entry an order of the
//! operator.

use crate::operator::{self, Order, OrderError};
use egui::{Key, Modifiers, PointerButton};
use std::collections::HashMap;

/// The table that is in force without a file. A file changes or adds entries.
pub const DEFAULT_MAPPING: &str = include_str!("default.map");

/// A key with the keys that are held beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Chord {
    key: Key,
    shift: bool,
    ctrl: bool,
    alt: bool,
}

/// What a button of the mouse does over a picture of the tablet.
#[derive(Clone, Debug, PartialEq)]
pub enum Click {
    /// It is a button of the puck, with this code, as long as it is down.
    Puck(u8),
    /// An order, when it goes down.
    Order(String),
}

/// What the mouse does over a picture of the tablet, besides moving the puck.
#[derive(Clone, Debug, Default)]
pub struct Mouse {
    /// In the order of [`MOUSE_BUTTONS`].
    buttons: [Option<Click>; MOUSE_BUTTONS.len()],
    /// Orders of a step of the wheel, up and down.
    wheel: [Option<String>; 2],
}

/// The buttons of a mouse by name.
const MOUSE_BUTTONS: [(&str, PointerButton); 5] = [
    ("left", PointerButton::Primary),
    ("middle", PointerButton::Middle),
    ("right", PointerButton::Secondary),
    ("back", PointerButton::Extra1),
    ("forward", PointerButton::Extra2),
];

/// What keys, the mouse, and the buttons and axes of a game controller, do.
#[derive(Clone, Debug)]
pub struct Mapping {
    keys: HashMap<Chord, String>,
    mouse: Mouse,
    /// Orders by button.
    buttons: HashMap<u8, String>,
    /// Dial, and its turns a second at the end of the way, by axis.
    axes: HashMap<u8, (u8, f64)>,
}

/// A line of a mapping file that is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct MappingError {
    /// The number of the line in the file, from 1.
    pub line: usize,
    /// What is wrong.
    pub problem: MappingProblem,
}

/// What can be wrong with a line of a mapping file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MappingProblem {
    /// No equals sign.
    #[error("there is no '=' between a key and an order")]
    NoEquals,
    /// A key that is not known.
    #[error("'{0}' is no key; examples: F1, Ctrl+Alt+C, Up, mouse left, wheel up, pad button 0, pad axis 1")]
    Key(String),
    /// The order is none.
    #[error(transparent)]
    Order(#[from] OrderError),
    /// The order of an axis does not turn a dial.
    #[error("an axis turns a dial: 'dial N TURNS'")]
    Axis,
}

impl Default for Mapping {
    fn default() -> Mapping {
        let mut mapping =
            Mapping { keys: HashMap::new(), mouse: Mouse::default(), buttons: HashMap::new(), axes: HashMap::new() };
        let read = mapping.read(DEFAULT_MAPPING);
        debug_assert!(read.is_ok(), "{read:?}");
        mapping
    }
}

impl Mapping {
    /// Changes and adds entries by the lines of a file. An empty order takes the entry away.
    ///
    /// # Errors
    /// The first line that is wrong; the lines before it are in force.
    pub fn read(&mut self, text: &str) -> Result<(), MappingError> {
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            if !line.is_empty() && !line.starts_with('#') {
                self.read_line(line).map_err(|problem| MappingError { line: number + 1, problem })?;
            }
        }
        Ok(())
    }

    fn read_line(&mut self, line: &str) -> Result<(), MappingProblem> {
        let (key, order) = line.split_once('=').ok_or(MappingProblem::NoEquals)?;
        let (key, order) = (key.trim(), order.trim());
        let parsed = if order.is_empty() { None } else { Some(operator::parse(order)?) };
        let unknown = || MappingProblem::Key(key.into());
        if let Some(number) = key.strip_prefix("pad axis ") {
            let axis = number.trim().parse().map_err(|_| unknown())?;
            match parsed {
                None => drop(self.axes.remove(&axis)),
                Some(Order::Dial { dial, turns }) => drop(self.axes.insert(axis, (dial, turns))),
                Some(_) => return Err(MappingProblem::Axis),
            }
        } else if let Some(number) = key.strip_prefix("pad button ") {
            let button = number.trim().parse().map_err(|_| unknown())?;
            put(&mut self.buttons, button, order);
        } else if let Some(name) = key.strip_prefix("mouse ") {
            let place = MOUSE_BUTTONS.iter().position(|row| row.0.eq_ignore_ascii_case(name.trim()));
            self.mouse.buttons[place.ok_or_else(unknown)?] = parsed.map(|parsed| match parsed {
                Order::PuckPress(code) => Click::Puck(code),
                _ => Click::Order(order.into()),
            });
        } else if let Some(direction) = key.strip_prefix("wheel ") {
            let place = ["up", "down"].iter().position(|name| name.eq_ignore_ascii_case(direction.trim()));
            self.mouse.wheel[place.ok_or_else(unknown)?] = parsed.map(|_| order.into());
        } else {
            put(&mut self.keys, Chord::named(key).ok_or_else(unknown)?, order);
        }
        Ok(())
    }

    /// The order of a key.
    pub fn key(&self, key: Key, held: Modifiers) -> Option<&str> {
        let chord = Chord { key, shift: held.shift, ctrl: held.ctrl, alt: held.alt };
        self.keys.get(&chord).map(String::as_str)
    }

    /// What the mouse does.
    pub fn mouse(&self) -> &Mouse {
        &self.mouse
    }

    /// The order of a button of a game controller.
    pub fn button(&self, button: u8) -> Option<&str> {
        self.buttons.get(&button).map(String::as_str)
    }

    /// The dial that an axis of a game controller turns, and its turns a second at the end of the way.
    pub fn axis(&self, axis: u8) -> Option<(u8, f64)> {
        self.axes.get(&axis).copied()
    }
}

impl Mouse {
    /// What a button does.
    pub fn button(&self, button: PointerButton) -> Option<&Click> {
        let place = MOUSE_BUTTONS.iter().position(|row| row.1 == button)?;
        self.buttons[place].as_ref()
    }

    /// The order of a step of the wheel.
    pub fn wheel(&self, is_up: bool) -> Option<&str> {
        self.wheel[usize::from(!is_up)].as_deref()
    }
}

/// Sets an entry, or takes it away.
fn put<K: std::hash::Hash + Eq>(table: &mut HashMap<K, String>, key: K, order: &str) {
    if order.is_empty() {
        table.remove(&key);
    } else {
        table.insert(key, order.into());
    }
}

impl Chord {
    fn named(name: &str) -> Option<Chord> {
        let mut rest = name;
        let mut held = |prefix: &str| match rest.get(..prefix.len()) {
            Some(start) if start.eq_ignore_ascii_case(prefix) && rest.len() > prefix.len() => {
                rest = &rest[prefix.len()..];
                true
            }
            _ => false,
        };
        let (shift, ctrl, alt) = (held("Shift+"), held("Ctrl+"), held("Alt+"));
        Some(Chord { key: Key::from_name(rest)?, shift, ctrl, alt })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_table_is_read_whole() {
        let mapping = Mapping::default();
        assert_eq!(mapping.key(Key::F3, Modifiers::NONE), Some("key 3"));
        assert_eq!(mapping.key(Key::F12, Modifiers::CTRL), Some("key 12 control"));
        assert_eq!(mapping.key(Key::ArrowUp, Modifiers::NONE), Some("key up"));
        assert_eq!(mapping.axis(0), Some((2, 0.5)));
        assert_eq!(mapping.button(3), Some("key 4"));
        assert_eq!(mapping.mouse().button(PointerButton::Secondary), Some(&Click::Puck(4)));
        assert_eq!(mapping.mouse().wheel(true), None);
    }

    #[test]
    fn a_file_changes_adds_and_takes_away() {
        let mut mapping = Mapping::default();
        mapping.read("# mine\nF1 = button 7\nctrl+alt+Q = quit\nF2 =\npad axis 2 = dial 8 -1\n").unwrap();
        assert_eq!(mapping.key(Key::F1, Modifiers::NONE), Some("button 7"));
        assert_eq!(mapping.key(Key::Q, Modifiers::CTRL | Modifiers::ALT), Some("quit"));
        assert_eq!(mapping.key(Key::F2, Modifiers::NONE), None);
        assert_eq!(mapping.axis(2), Some((8, -1.0)));
        mapping.read("mouse right = key 5\nmouse middle =\nwheel down = dial 4 -0.02\n").unwrap();
        let mouse = mapping.mouse();
        assert_eq!(mouse.button(PointerButton::Secondary), Some(&Click::Order("key 5".into())));
        assert_eq!(mouse.button(PointerButton::Middle), None);
        assert_eq!((mouse.wheel(true), mouse.wheel(false)), (None, Some("dial 4 -0.02")));
    }

    #[test]
    fn a_wrong_line_is_named() {
        let wrong = |text: &str| Mapping::default().read(text).unwrap_err().to_string();
        assert!(wrong("F1 = key 1\n\nF1 key 1").starts_with("line 3: there is no '='"));
        assert!(wrong("Fx = key 1").contains("'Fx' is no key"));
        assert!(wrong("F1 = kee 1").contains("did you mean 'key'"));
        assert!(wrong("pad axis 1 = key 1").contains("an axis turns a dial"));
        assert!(wrong("pad button x = key 1").contains("no key"));
        assert!(wrong("mouse up = key 1").contains("no key") && wrong("wheel left = key 1").contains("no key"));
    }
}
