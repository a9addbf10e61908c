//! What keys of the window, the mouse and a game controller do: a table from a file, each entry an operator
//! command.

use crate::operator::{self, OperatorCommand, OperatorCommandError};
use egui::{Key, Modifiers, PointerButton};
use std::collections::HashMap;

/// The table that is in force without a file. A file changes or adds entries.
pub const DEFAULT_MAPPING: &str = include_str!("default.map");

/// Keys that are held beside another, or beside a button of the mouse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
struct HeldModifiers {
    shift: bool,
    ctrl: bool,
    alt: bool,
}

/// A key with the keys that are held beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Chord {
    key: Key,
    modifiers: HeldModifiers,
}

/// A dial, and by how many turns it is turned.
type Turn = (u8, f64);

/// What a button of the mouse does over a picture of the tablet.
#[derive(Clone, Debug, PartialEq)]
pub enum Click {
    /// It is a button of the puck, with this code, as long as it is down.
    Puck(u8),
    /// An operator command, when it goes down.
    OperatorCommand(String),
}

/// What the mouse does: over a picture of the tablet, besides moving the puck, and over the vector screen while it
/// turns dials.
#[derive(Clone, Debug, Default)]
pub struct Mouse {
    /// What drags turn, along x and y.
    drags: HashMap<(usize, HeldModifiers), [Option<Turn>; 2]>,
    /// What a step of the wheel turns.
    roll: Option<Turn>,
    /// In the order of [`MOUSE_BUTTONS`].
    buttons: [Option<Click>; MOUSE_BUTTONS.len()],
    /// Operator commands of a step of the wheel, up and down.
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
    /// Operator commands by button.
    buttons: HashMap<u8, String>,
    /// Dial, and its turns a second at the end of the way, by axis.
    axes: HashMap<u8, Turn>,
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
    #[error(
        "'{0}' is no key; examples: F1, Ctrl+Alt+C, Up, mouse left, wheel up, drag Shift+left x, drag wheel, pad button 0, pad axis 1"
    )]
    Key(String),
    /// It is no operator command.
    #[error(transparent)]
    OperatorCommand(#[from] OperatorCommandError),
    /// The operator command of an axis or a drag does not turn a dial.
    #[error("axes and drags turn a dial: 'dial N TURNS'")]
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
    /// Changes and adds entries by the lines of a file. An empty operator command takes the entry away.
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
            match turn(parsed)? {
                None => drop(self.axes.remove(&axis)),
                Some(turn) => drop(self.axes.insert(axis, turn)),
            }
        } else if let Some(drag) = key.strip_prefix("drag ") {
            *self.mouse.drag(drag.trim()).ok_or_else(unknown)? = turn(parsed)?;
        } else if let Some(number) = key.strip_prefix("pad button ") {
            let button = number.trim().parse().map_err(|_| unknown())?;
            put(&mut self.buttons, button, order);
        } else if let Some(name) = key.strip_prefix("mouse ") {
            let place = MOUSE_BUTTONS.iter().position(|row| row.0.eq_ignore_ascii_case(name.trim()));
            self.mouse.buttons[place.ok_or_else(unknown)?] = parsed.map(|parsed| match parsed {
                OperatorCommand::PuckPress(code) => Click::Puck(code),
                _ => Click::OperatorCommand(order.into()),
            });
        } else if let Some(direction) = key.strip_prefix("wheel ") {
            let place = ["up", "down"].iter().position(|name| name.eq_ignore_ascii_case(direction.trim()));
            self.mouse.wheel[place.ok_or_else(unknown)?] = parsed.map(|_| order.into());
        } else {
            put(&mut self.keys, Chord::named(key).ok_or_else(unknown)?, order);
        }
        Ok(())
    }

    /// The operator command of a key.
    pub fn key(&self, key: Key, held: Modifiers) -> Option<&str> {
        self.keys.get(&Chord { key, modifiers: held.into() }).map(String::as_str)
    }

    /// What the mouse does.
    pub fn mouse(&self) -> &Mouse {
        &self.mouse
    }

    /// The operator command of a button of a game controller.
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

    /// The dials that a drag of a button turns.
    ///
    /// - `held`: when the button went down. `way`: to the right and up, as parts of the screen.
    pub fn dragged(&self, button: PointerButton, held: Modifiers, way: [f64; 2]) -> impl Iterator<Item = Turn> {
        let place = MOUSE_BUTTONS.iter().position(|row| row.1 == button);
        let turns = place.and_then(|place| self.drags.get(&(place, held.into()))).copied().unwrap_or_default();
        let turned = turns.into_iter().zip(way).filter_map(|(turn, way)| turn.map(|(dial, turns)| (dial, turns * way)));
        turned.filter(|(_, turns)| *turns != 0.0)
    }

    /// The dial that so many steps of the wheel turn.
    pub fn rolled(&self, steps: f64) -> Option<Turn> {
        self.roll.map(|(dial, turns)| (dial, turns * steps))
    }

    /// The entry of a drag such as `Shift+left x`, or of `wheel`.
    fn drag(&mut self, name: &str) -> Option<&mut Option<Turn>> {
        if name.eq_ignore_ascii_case("wheel") {
            return Some(&mut self.roll);
        }
        let (button, axis) = name.rsplit_once(' ')?;
        let axis = ["x", "y"].iter().position(|name| name.eq_ignore_ascii_case(axis))?;
        let (held, button) = HeldModifiers::before(button.trim());
        let place = MOUSE_BUTTONS.iter().position(|row| row.0.eq_ignore_ascii_case(button))?;
        Some(&mut self.drags.entry((place, held)).or_default()[axis])
    }

    /// The operator command of a step of the wheel.
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

/// The dial that an operator command turns; none if it turns none.
fn turn(order: Option<OperatorCommand>) -> Result<Option<Turn>, MappingProblem> {
    match order {
        None => Ok(None),
        Some(OperatorCommand::Dial { dial, turns }) => Ok(Some((dial, turns))),
        Some(_) => Err(MappingProblem::Axis),
    }
}

impl From<Modifiers> for HeldModifiers {
    fn from(held: Modifiers) -> HeldModifiers {
        HeldModifiers { shift: held.shift, ctrl: held.ctrl, alt: held.alt }
    }
}

impl HeldModifiers {
    /// The keys that a name such as `Shift+Ctrl+left` begins with, and what follows them.
    fn before(name: &str) -> (HeldModifiers, &str) {
        let mut rest = name;
        let mut held = |prefix: &str| match rest.get(..prefix.len()) {
            Some(start) if start.eq_ignore_ascii_case(prefix) && rest.len() > prefix.len() => {
                rest = &rest[prefix.len()..];
                true
            }
            _ => false,
        };
        let held = HeldModifiers { shift: held("Shift+"), ctrl: held("Ctrl+"), alt: held("Alt+") };
        (held, rest)
    }
}

impl Chord {
    fn named(name: &str) -> Option<Chord> {
        let (held, rest) = HeldModifiers::before(name);
        Some(Chord { key: Key::from_name(rest)?, modifiers: held })
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
        let dragged = |held| mapping.mouse().dragged(PointerButton::Primary, held, [0.5, 0.0]).collect::<Vec<_>>();
        assert_eq!((dragged(Modifiers::NONE), dragged(Modifiers::SHIFT)), (vec![(2, -0.45)], vec![(5, 0.5)]));
        assert_eq!(mapping.mouse().rolled(-2.0), Some((4, -0.2)));
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
        assert_eq!(mouse.button(PointerButton::Secondary), Some(&Click::OperatorCommand("key 5".into())));
        assert_eq!(mouse.button(PointerButton::Middle), None);
        assert_eq!((mouse.wheel(true), mouse.wheel(false)), (None, Some("dial 4 -0.02")));
        mapping.read("drag ctrl+Alt+right y = dial 8 2\ndrag left x =\ndrag wheel = dial 7 1\n").unwrap();
        let dragged = |button, held| mapping.mouse().dragged(button, held, [1.0, 0.5]).collect::<Vec<_>>();
        assert_eq!(dragged(PointerButton::Secondary, Modifiers::CTRL | Modifiers::ALT), [(8, 1.0)]);
        assert_eq!(dragged(PointerButton::Primary, Modifiers::NONE), [(1, 0.45)]);
        assert_eq!(mapping.mouse().rolled(1.0), Some((7, 1.0)));
    }

    #[test]
    fn a_wrong_line_is_named() {
        let wrong = |text: &str| Mapping::default().read(text).unwrap_err().to_string();
        assert!(wrong("F1 = key 1\n\nF1 key 1").starts_with("line 3: there is no '='"));
        assert!(wrong("Fx = key 1").contains("'Fx' is no key"));
        assert!(wrong("F1 = kee 1").contains("did you mean 'key'"));
        for line in ["pad axis 1 = key 1", "drag left x = key 1"] {
            assert!(wrong(line).contains("axes and drags turn a dial"));
        }
        assert!(wrong("drag left z = dial 1 1").contains("no key") && wrong("drag up x = dial 1 1").contains("no key"));
        assert!(wrong("pad button x = key 1").contains("no key"));
        assert!(wrong("mouse up = key 1").contains("no key") && wrong("wheel left = key 1").contains("no key"));
    }
}
