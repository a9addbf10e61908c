//! The modes of the terminal, with the numbers by which hosts switch them.

/// The modes that are on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Modes {
    /// IRM: characters push those after them to the right.
    pub insert: bool,
    /// LNM: a line feed also returns the cursor to column 1, and RETURN sends CR LF.
    pub new_line: bool,
    /// Not SRM: typed characters appear at once. Off at the start, as the host echoes.
    pub local_echo: bool,
    /// DECCKM: the arrow keys send what applications expect.
    pub application_cursor: bool,
    /// DECKPAM: the same for the numeric keypad.
    pub application_keypad: bool,
    /// DECOM: rows count from the top of the scroll region.
    pub origin: bool,
    /// DECAWM: a character past the last column begins a new row. On at the start; ours.
    pub wrap: bool,
    /// DECSCNM: the screen is reversed; drawn as a frame.
    pub reverse_screen: bool,
    /// DECTCEM: the cursor is seen.
    pub cursor_visible: bool,
}

impl Default for Modes {
    fn default() -> Modes {
        Modes {
            insert: false,
            new_line: false,
            local_echo: false,
            application_cursor: false,
            application_keypad: false,
            origin: false,
            wrap: true,
            reverse_screen: false,
            cursor_visible: true,
        }
    }
}

impl Modes {
    /// Switches an ANSI mode (`ESC [ n h` and `l`); false if the terminal has no such mode.
    pub(super) fn set_ansi(&mut self, number: u16, on: bool) -> bool {
        match number {
            4 => self.insert = on,
            12 => self.local_echo = !on,
            20 => self.new_line = on,
            _ => return false,
        }
        true
    }

    /// Switches a mode of the maker (`ESC [ ? n h` and `l`); false if the terminal has no such mode.
    pub(super) fn set_private(&mut self, number: u16, on: bool) -> bool {
        match number {
            1 => self.application_cursor = on,
            5 => self.reverse_screen = on,
            6 => self.origin = on,
            7 => self.wrap = on,
            25 => self.cursor_visible = on,
            _ => return false,
        }
        true
    }
}
