//! The keyboard: its three modes, its keys, and the command line of its command mode.
//!
//! # Source
//! Three modes, the prompt `@@` and that what is open shows in it, KEYBOARD, SPECKEYS and the names of the keys are
//! remembered; KBHANDLER `<4>` with one character a message is confirmed. Ours: HOST, COMMAND and LOCAL choose the
//! terminal's, the command and the interactive mode. The machine starts in interactive mode, in which KBHANDLER `<4>`
//! sends as clients expect; with `--plain-text terminal` it starts as a terminal, where a connected KBHANDLER `<4>`
//! takes the characters from the line.

use super::{
    Key, KeyboardMode, Machine, PlainText, WORK_PER_STEP,
    host_line::HostLine,
    keyboard::{Edit, LOCAL},
};
use crate::{line::LineId, terminal::SpecialKey};
use protocol::Value;

/// The prompt; what is open is shown after it.
const PROMPT: &str = "@@";
/// Most bytes to the host that are kept for whoever observes the terminal; those after them are not.
const MAX_TYPED: usize = 4096;

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

    /// Shows the prompt of the command mode, with what was typed after it.
    fn prompt(&mut self) {
        if self.keyboard.mode == KeyboardMode::Command {
            self.keyboard.prompted = true;
            // CAN ends a sequence that somebody else has begun on the terminal.
            let open = self.lines.hosts.get(&LOCAL).map_or(String::new(), HostLine::open);
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
        let mut local = self.lines.hosts.remove(&LOCAL).unwrap_or_else(|| HostLine::new(LOCAL, PlainText::Commands));
        local.receive(text, self);
        self.lines.hosts.insert(LOCAL, local);
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

    /// Sends the output of the terminal to the host whose text it received last, or else to the one that came first.
    fn send_to_terminal_host(&mut self, bytes: Vec<u8>) {
        let host = self.lines.terminal_host(self.keyboard.host);
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
