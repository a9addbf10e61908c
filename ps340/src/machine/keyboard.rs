//! The keyboard: its three modes, its keys, and the command line of its command mode.
//!
//! # Source
//! Three modes, the prompt `@@` and that what is open shows in it, KEYBOARD, SPECKEYS and the names of the keys are remembered; KBHANDLER `<4>` with one
//! character a message is confirmed. Ours: HOST, COMMAND and LOCAL choose the terminal's, the command and the
//! interactive mode. The machine starts in interactive mode, in which KBHANDLER `<4>` speaks as clients expect; with
//! `--plain-text terminal` it starts as a terminal, where a connected KBHANDLER `<4>` takes the characters from the line.

use super::{HostLine, Machine, PlainText, WORK_PER_STEP};
use crate::{
    line::LineId,
    terminal::{SPECIAL_KEYS, SpecialKey},
};
use protocol::Value;
use std::collections::VecDeque;

/// Where typed characters go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum KeyboardMode {
    /// To the host, as from a terminal.
    Terminal,
    /// To the machine's own command interpreter, line by line.
    Command,
    /// To KEYBOARD, SPECKEYS and KBHANDLER.
    #[default]
    Interactive,
}

impl KeyboardMode {
    /// The mode's word.
    pub fn word(self) -> &'static str {
        match self {
            KeyboardMode::Terminal => "terminal",
            KeyboardMode::Command => "command",
            KeyboardMode::Interactive => "interactive",
        }
    }
}

/// A key with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Chooses a mode.
    Mode(KeyboardMode),
    /// Switches the graphics off and on.
    Graph,
    /// Switches the terminal's text off and on.
    Term,
    /// Opens and closes the set-up page.
    Setup,
    /// Types a character.
    Character(u8),
    /// An arrow, or a key of the keypad.
    Special(SpecialKey),
}

/// The keys with names, but for the special ones of the terminal.
const KEYS: &[(&str, Key)] = &[
    ("host", Key::Mode(KeyboardMode::Terminal)),
    ("local", Key::Mode(KeyboardMode::Interactive)),
    ("command", Key::Mode(KeyboardMode::Command)),
    ("graph", Key::Graph),
    ("term", Key::Term),
    ("setup", Key::Setup),
    ("return", Key::Character(b'\r')),
    ("linefeed", Key::Character(b'\n')),
    ("tab", Key::Character(b'\t')),
    ("backspace", Key::Character(8)),
    ("delete", Key::Character(127)),
    ("escape", Key::Character(27)),
];

impl Key {
    /// The key of a name, in either case of letters.
    pub fn named(name: &str) -> Option<Key> {
        let plain = KEYS.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, key)| *key);
        let special = || SPECIAL_KEYS.iter().find(|k| k.name.eq_ignore_ascii_case(name)).map(|k| Key::Special(*k));
        plain.or_else(special)
    }

    /// The names of all keys.
    pub fn names() -> impl Iterator<Item = &'static str> {
        KEYS.iter().map(|(name, _)| *name).chain(SPECIAL_KEYS.iter().map(|k| k.name))
    }
}

/// The line of the machine's own command interpreter, which no host has.
pub(super) const LOCAL: LineId = LineId(u64::MAX);

/// The prompt; what is open is said behind it.
const PROMPT: &str = "@@";
/// Longest command line, in characters.
const MAX_COMMAND: usize = 1000;
/// Command lines that the arrows bring back.
const MAX_REMEMBERED: usize = 50;
/// Most bytes to the host that are kept for whoever looks on; those after them are not.
const MAX_TYPED: usize = 4096;
const BS: u8 = 8;
const CONTROL_U: u8 = 21;
const DEL: u8 = 127;

/// The state of the keyboard.
#[derive(Debug, Default)]
pub(super) struct Keyboard {
    mode: KeyboardMode,
    /// The command line so far.
    line: Vec<u8>,
    /// The latest command lines, oldest first.
    remembered: VecDeque<Vec<u8>>,
    /// Which of them was brought back: so many before the next.
    back: usize,
    /// Whether a prompt stands at the cursor and waits.
    prompted: bool,
    /// The host that spoke to the terminal last.
    host: Option<LineId>,
    /// What the terminal sent to its host, for whoever looks on.
    typed: Vec<u8>,
}

/// What a typed character does to the command line.
#[derive(Debug, PartialEq, Eq)]
enum Edit {
    /// Shows this.
    Echo(Vec<u8>),
    /// Ends the line.
    Done(Vec<u8>),
}

impl Keyboard {
    pub(super) fn mode(&self) -> KeyboardMode {
        self.mode
    }

    /// A host is gone.
    pub(super) fn detach(&mut self, line: LineId) {
        self.host = self.host.filter(|host| *host != line);
    }

    fn edit(&mut self, character: u8) -> Edit {
        match character {
            b'\r' | b'\n' => {
                let line = std::mem::take(&mut self.line);
                self.back = 0;
                if !line.is_empty() && self.remembered.back() != Some(&line) {
                    self.remembered.push_back(line.clone());
                    let excess = self.remembered.len().saturating_sub(MAX_REMEMBERED);
                    self.remembered.drain(..excess);
                }
                Edit::Done(line)
            }
            BS | DEL if self.line.pop().is_some() => Edit::Echo(b"\x08 \x08".to_vec()),
            CONTROL_U => self.replace(Vec::new()),
            b'\t' => self.edit(b' '),
            32..=126 if self.line.len() < MAX_COMMAND => {
                self.line.push(character);
                Edit::Echo(vec![character])
            }
            _ => Edit::Echo(Vec::new()),
        }
    }

    /// Brings a remembered line back: an older one, or a younger one.
    fn recall(&mut self, older: bool) -> Edit {
        let wanted = if older { self.back + 1 } else { self.back.saturating_sub(1) };
        if wanted > self.remembered.len() {
            return Edit::Echo(Vec::new());
        }
        self.back = wanted;
        let line = self.remembered.len().checked_sub(wanted).and_then(|at| self.remembered.get(at));
        self.replace(line.cloned().unwrap_or_default())
    }

    fn replace(&mut self, line: Vec<u8>) -> Edit {
        let mut echo = b"\x08 \x08".repeat(self.line.len());
        echo.extend_from_slice(&line);
        self.line = line;
        Edit::Echo(echo)
    }
}

impl Machine {
    /// The mode of the keyboard.
    pub fn keyboard_mode(&self) -> KeyboardMode {
        self.keyboard.mode
    }

    /// Gives the keyboard another mode; the command mode shows its prompt.
    pub(super) fn switch_keyboard(&mut self, mode: KeyboardMode) {
        if mode == self.keyboard.mode {
            return;
        }
        self.keyboard.line.clear();
        self.keyboard.back = 0;
        self.keyboard.prompted = false;
        if self.terminal.cursor().1 > 0 {
            self.terminal.feed(b"\r\n");
        }
        self.keyboard.mode = mode;
        self.prompt();
    }

    /// Takes typed characters.
    pub(super) fn type_characters(&mut self, characters: &[u8]) {
        if self.terminal.in_setup() {
            characters.iter().for_each(|c| self.terminal.type_in_setup(*c));
            return;
        }
        match self.keyboard.mode {
            KeyboardMode::Interactive => {
                let places = [("KEYBOARD", 1), ("KBHANDLER", 4)];
                let typed =
                    characters.iter().flat_map(|c| places.map(|(to, output)| (to, output, Value::string([*c]))));
                let typed = typed.collect();
                self.emit(typed);
            }
            KeyboardMode::Terminal if self.handler_is_connected() => {
                self.emit(characters.iter().map(|c| ("KBHANDLER", 4, Value::string([*c]))).collect());
            }
            KeyboardMode::Terminal => self.send_as_terminal(characters),
            KeyboardMode::Command => {
                for character in characters {
                    let edit = self.keyboard.edit(*character);
                    self.show_edit(edit);
                }
            }
        }
    }

    /// Takes a key with a name.
    pub(super) fn press(&mut self, key: Key) {
        match key {
            Key::Mode(mode) => self.switch_keyboard(mode),
            Key::Graph => self.tube.graphics = !self.tube.graphics,
            Key::Term => self.tube.text = !self.tube.text,
            Key::Setup => self.terminal.toggle_setup(),
            Key::Character(character) => self.type_characters(&[character]),
            Key::Special(key) => self.press_special(key),
        }
    }

    fn press_special(&mut self, key: SpecialKey) {
        match self.keyboard.mode {
            _ if self.terminal.in_setup() => key.character().into_iter().for_each(|c| self.terminal.type_in_setup(c)),
            KeyboardMode::Interactive => self.emit(vec![("SPECKEYS", 1, Value::string([key.code]))]),
            KeyboardMode::Terminal => {
                let sequence = key.sequence(self.terminal.modes());
                self.type_characters(&sequence);
            }
            KeyboardMode::Command => match (key.name, key.character()) {
                ("up", _) | ("down", _) => {
                    let edit = self.keyboard.recall(key.name == "up");
                    self.show_edit(edit);
                }
                (_, Some(character)) => self.type_characters(&[character]),
                _ => {}
            },
        }
    }

    /// Characters for the terminal, from a host's line or from the network.
    pub(super) fn show_text(&mut self, from: Option<LineId>, text: &[u8]) {
        self.keyboard.host = from.or(self.keyboard.host);
        self.terminal.feed(text);
        let replies = self.terminal.take_replies();
        self.send_to_terminal_host(replies);
    }

    /// A message of the machine, which the terminal shows in command mode.
    pub(super) fn show_message(&mut self, message: &str) {
        if self.keyboard.mode != KeyboardMode::Command {
            return;
        }
        if self.keyboard.prompted || self.terminal.cursor().1 > 0 {
            self.terminal.feed(b"\r\n");
        }
        for line in message.lines() {
            let shown: Vec<u8> = line.bytes().map(|b| if b.is_ascii_control() { b' ' } else { b }).collect();
            self.terminal.feed(&shown);
            self.terminal.feed(b"\r\n");
        }
        if self.keyboard.prompted {
            self.prompt();
        }
    }

    fn show_edit(&mut self, edit: Edit) {
        match edit {
            Edit::Echo(echo) => self.terminal.feed(&echo),
            Edit::Done(mut line) => {
                self.terminal.feed(b"\x18\r\n");
                self.keyboard.prompted = false;
                line.push(b'\n');
                self.interpret(&line);
                self.prompt();
            }
        }
    }

    /// Shows the prompt of the command mode, with what was typed behind it.
    fn prompt(&mut self) {
        if self.keyboard.mode == KeyboardMode::Command {
            self.keyboard.prompted = true;
            // CAN ends a sequence that somebody else has begun on the terminal.
            let open = self.lines.get(&LOCAL).map_or(String::new(), HostLine::open);
            let blank = if open.is_empty() { " " } else { "> " };
            let line = [b"\x18", PROMPT.as_bytes(), open.as_bytes(), blank.as_bytes(), &self.keyboard.line].concat();
            self.terminal.feed(&line);
        }
    }

    /// Gives a program to the machine's own command interpreter, as a text without packets.
    pub fn run_program(&mut self, text: &[u8]) {
        self.work_left = WORK_PER_STEP;
        self.activity();
        self.interpret(text);
    }

    /// Gives text to the machine's own command interpreter.
    fn interpret(&mut self, text: &[u8]) {
        let mut local = self.lines.remove(&LOCAL).unwrap_or_else(|| HostLine::new(LOCAL, PlainText::Commands));
        local.receive(text, self);
        self.lines.insert(LOCAL, local);
        self.settle();
    }

    /// Whether somebody takes the characters of the keyboard from KBHANDLER.
    fn handler_is_connected(&self) -> bool {
        let handler = self.memory.objects.find("KBHANDLER");
        handler.is_some_and(|id| self.memory.network.arcs(id).any(|(output, _)| output == 4))
    }

    fn send_as_terminal(&mut self, characters: &[u8]) {
        let modes = *self.terminal.modes();
        let mut sent = Vec::with_capacity(characters.len());
        for character in characters {
            sent.push(*character);
            if *character == b'\r' && modes.new_line {
                sent.push(b'\n');
            }
        }
        if modes.local_echo {
            self.terminal.feed(&sent);
        }
        self.send_to_terminal_host(sent);
    }

    /// Sends what the terminal says to the host that spoke to it last, or else to the one that came first.
    fn send_to_terminal_host(&mut self, bytes: Vec<u8>) {
        let host = self.keyboard.host.filter(|line| self.writers.contains_key(line));
        let host = host.or_else(|| self.writers.keys().next().copied());
        if let (Some(line), false) = (host, bytes.is_empty()) {
            let room = MAX_TYPED.saturating_sub(self.keyboard.typed.len());
            self.keyboard.typed.extend_from_slice(&bytes[..bytes.len().min(room)]);
            self.outputs.push(line, bytes);
        }
    }

    /// The bytes that the terminal sent to its host and nobody took yet, 4096 at most.
    pub fn typed(&self) -> &[u8] {
        &self.keyboard.typed
    }

    /// Takes the first `count` of these bytes.
    pub fn take_typed(&mut self, count: usize) {
        let count = count.min(self.keyboard.typed.len());
        self.keyboard.typed.drain(..count);
    }
}
