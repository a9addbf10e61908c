//! What each character and sequence does to the terminal.

use super::{
    Attributes, ROWS, Terminal,
    graphics::CharacterSet,
    screen::Part,
    sequence::{Action, Sequence},
};

const BS: u8 = 8;
const HT: u8 = 9;
const LF: u8 = 10;
const FF: u8 = 12;
const CR: u8 = 13;
const SO: u8 = 14;
const SI: u8 = 15;
const SUB: u8 = 26;

/// The answer to "what are you": a VT100 with the advanced video option.
const ATTRIBUTES: &str = "\x1b[?1;2c";

impl Terminal {
    pub(super) fn perform(&mut self, action: Action) {
        match action {
            Action::Nothing => {}
            Action::Print(code) => self.print(code),
            Action::Control(code) => self.control(code),
            Action::Escape(None, last) => self.escape(last),
            Action::Escape(Some(b'('), last) => self.sets[0] = CharacterSet::designated(last),
            Action::Escape(Some(b')'), last) => self.sets[1] = CharacterSet::designated(last),
            Action::Escape(Some(b'#'), b'8') => self.screen.fill('E'),
            Action::Escape(..) => {}
            Action::Sequence(sequence) => self.sequence(&sequence),
        }
    }

    fn print(&mut self, code: u8) {
        let character = self.sets[self.shift].character(code);
        self.screen.write(character, self.modes.wrap, self.modes.insert);
    }

    fn control(&mut self, code: u8) {
        match code {
            BS => self.screen.left(1),
            HT => self.screen.tab(1),
            LF..=FF => {
                self.screen.line_feed();
                if self.modes.new_line {
                    self.carriage_return();
                }
            }
            CR => self.carriage_return(),
            SO => self.shift = 1,
            SI => self.shift = 0,
            // A character that was damaged on its way, 128 and above, shows the same.
            SUB => self.print(255),
            _ => {}
        }
    }

    fn carriage_return(&mut self) {
        let (row, _) = self.screen.cursor();
        self.screen.move_to(row, 0);
    }

    fn escape(&mut self, last: u8) {
        match last {
            b'7' => self.screen.save_cursor(),
            b'8' => self.screen.restore_cursor(),
            b'D' => self.screen.line_feed(),
            b'E' => {
                self.carriage_return();
                self.screen.line_feed();
            }
            b'H' => self.screen.set_tab(),
            b'M' => self.screen.reverse_line_feed(),
            b'Z' => self.reply(ATTRIBUTES),
            b'c' => self.reset(),
            b'=' => self.modes.application_keypad = true,
            b'>' => self.modes.application_keypad = false,
            _ => {}
        }
    }

    fn sequence(&mut self, sequence: &Sequence) {
        match (sequence.private, sequence.intermediate) {
            (None, None) => self.ansi(sequence),
            (Some(b'?'), None) => self.private(sequence),
            _ => {}
        }
    }

    fn ansi(&mut self, s: &Sequence) {
        let (row, column) = self.screen.cursor();
        let n = s.or(0, 1);
        match s.last {
            b'A' => self.screen.up(n),
            b'B' | b'e' => self.screen.down(n),
            b'C' | b'a' => self.screen.right(n),
            b'D' => self.screen.left(n),
            b'E' => {
                self.screen.down(n);
                self.carriage_return();
            }
            b'F' => {
                self.screen.up(n);
                self.carriage_return();
            }
            b'G' | b'`' => self.screen.move_to(row, n - 1),
            b'H' | b'f' => self.move_cursor(n - 1, s.or(1, 1) - 1),
            b'd' => self.move_cursor(n - 1, column),
            b'I' => self.screen.tab(n),
            b'Z' => self.screen.back_tab(n),
            b'J' => part(s.choice()).into_iter().for_each(|part| self.screen.erase(part)),
            b'K' => part(s.choice()).into_iter().for_each(|part| self.screen.erase_in_row(part)),
            b'L' => self.screen.insert_rows(n),
            b'M' => self.screen.delete_rows(n),
            b'@' => self.screen.insert_characters(n),
            b'P' => self.screen.delete_characters(n),
            b'X' => self.screen.erase_characters(n),
            b'S' => self.screen.scroll_up(self.screen.region().0, n),
            b'T' => self.screen.scroll_down(self.screen.region().0, n),
            b'c' if s.choice() == 0 => self.reply(ATTRIBUTES),
            b'g' => match s.choice() {
                0 => self.screen.clear_tabs(false),
                3 => self.screen.clear_tabs(true),
                _ => {}
            },
            b'h' | b'l' => {
                for mode in &s.parameters {
                    self.modes.set_ansi(*mode, s.last == b'h');
                }
            }
            b'm' => self.attributes(s),
            b'n' => self.report(s.choice()),
            b'r' => self.set_region(n - 1, s.or(1, ROWS as u16) - 1),
            b's' => self.screen.save_cursor(),
            b'u' => self.screen.restore_cursor(),
            // No parity, 8 bits, 9600 baud both ways.
            b'x' if s.choice() <= 1 => self.reply(&format!("\x1b[{};1;1;112;112;1;0x", s.choice() + 2)),
            _ => {}
        }
    }

    fn private(&mut self, s: &Sequence) {
        match s.last {
            b'h' | b'l' => {
                for mode in &s.parameters {
                    self.modes.set_private(*mode, s.last == b'h');
                    // The cursor goes home when rows begin to count otherwise.
                    if *mode == 6 {
                        self.move_cursor(0, 0);
                    }
                }
            }
            b'J' => part(s.choice()).into_iter().for_each(|part| self.screen.erase(part)),
            b'K' => part(s.choice()).into_iter().for_each(|part| self.screen.erase_in_row(part)),
            b'n' => self.report(s.choice()),
            _ => {}
        }
    }

    /// Sets the scroll region, which sends the cursor home.
    fn set_region(&mut self, top: usize, bottom: usize) {
        if self.screen.set_region(top, bottom) {
            self.move_cursor(0, 0);
        }
    }

    /// Moves the cursor; in origin mode rows count from the scroll region, which the cursor then does not leave.
    fn move_cursor(&mut self, row: usize, column: usize) {
        let (top, bottom) = self.screen.region();
        let row = if self.modes.origin { (top + row).min(bottom) } else { row };
        self.screen.move_to(row, column);
    }

    fn attributes(&mut self, s: &Sequence) {
        let pen = self.screen.attributes_mut();
        if s.parameters.is_empty() {
            *pen = Attributes::default();
        }
        for parameter in &s.parameters {
            match parameter {
                0 => *pen = Attributes::default(),
                1 => pen.bold = true,
                4 => pen.underline = true,
                5 => pen.blink = true,
                7 => pen.reverse = true,
                22 => pen.bold = false,
                24 => pen.underline = false,
                25 => pen.blink = false,
                27 => pen.reverse = false,
                // Colours are no matter of such a terminal.
                _ => {}
            }
        }
    }

    /// Answers a question about the state (5) or the cursor (6).
    fn report(&mut self, question: u16) {
        match question {
            5 => self.reply("\x1b[0n"),
            6 => {
                let (row, column) = self.screen.cursor();
                let row = if self.modes.origin { row.saturating_sub(self.screen.region().0) } else { row };
                self.reply(&format!("\x1b[{};{}R", row + 1, column + 1));
            }
            _ => {}
        }
    }
}

/// What a parameter of an erasure means.
fn part(choice: u16) -> Option<Part> {
    match choice {
        0 => Some(Part::FromCursor),
        1 => Some(Part::Beginning),
        2 => Some(Part::All),
        _ => None,
    }
}
