//! The cells of the screen, the cursor, the scroll region and the tab stops, with the edits of them.

/// Rows of the screen.
pub const ROWS: usize = 24;
/// Columns of the screen.
pub const COLUMNS: usize = 80;

/// Columns from one tab stop to the next at the start.
const TAB: usize = 8;

/// How a character looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Brighter.
    pub bold: bool,
    /// With a line below.
    pub underline: bool,
    /// Comes and goes.
    pub blink: bool,
    /// In a frame, as the strokes of the screen cannot be dark on light. Ours.
    pub reverse: bool,
}

/// One cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The character; a blank if nothing is there.
    pub character: char,
    /// How it looks.
    pub attributes: Attributes,
}

impl Default for Cell {
    fn default() -> Cell {
        Cell { character: ' ', attributes: Attributes::default() }
    }
}

type Row = [Cell; COLUMNS];

/// Where the cursor is, and how it writes.
#[derive(Clone, Copy, Debug, Default)]
struct Cursor {
    row: usize,
    column: usize,
    /// A character was written in the last column: the next one begins a new row, if it may.
    at_end: bool,
    attributes: Attributes,
}

/// The screen.
#[derive(Debug)]
pub(super) struct TerminalScreen {
    rows: Vec<Row>,
    cursor: Cursor,
    saved: Cursor,
    /// First and last row of the scroll region.
    top: usize,
    bottom: usize,
    tabs: [bool; COLUMNS],
}

impl Default for TerminalScreen {
    fn default() -> TerminalScreen {
        TerminalScreen {
            rows: vec![[Cell::default(); COLUMNS]; ROWS],
            cursor: Cursor::default(),
            saved: Cursor::default(),
            top: 0,
            bottom: ROWS - 1,
            tabs: std::array::from_fn(|column| column % TAB == 0),
        }
    }
}

/// What part of a row or of the screen goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// From the cursor to the end.
    FromCursor,
    /// From the beginning to the cursor.
    Beginning,
    /// All.
    All,
}

impl TerminalScreen {
    pub(super) fn row(&self, row: usize) -> &[Cell] {
        self.rows.get(row).map_or(&[], |r| &r[..])
    }

    pub(super) fn cursor(&self) -> (usize, usize) {
        (self.cursor.row, self.cursor.column)
    }

    pub(super) fn region(&self) -> (usize, usize) {
        (self.top, self.bottom)
    }

    pub(super) fn attributes_mut(&mut self) -> &mut Attributes {
        &mut self.cursor.attributes
    }

    /// The rows as lines of text, without blanks at their ends.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        for row in &self.rows {
            let line: String = row.iter().map(|cell| cell.character).collect();
            text.push_str(line.trim_end_matches(' '));
            text.push('\n');
        }
        text
    }

    /// Writes a character and moves on.
    pub(super) fn write(&mut self, character: char, wrap: bool, insert: bool) {
        if self.cursor.at_end && wrap {
            self.cursor.column = 0;
            self.line_feed();
        }
        if insert {
            self.insert_characters(1);
        }
        self.cursor.at_end = false;
        let Cursor { row, column, attributes, .. } = self.cursor;
        self.rows[row][column] = Cell { character, attributes };
        if column + 1 < COLUMNS {
            self.cursor.column += 1;
        } else {
            self.cursor.at_end = true;
        }
    }

    /// Moves the cursor to a position on the screen, or as near as there is one.
    pub(super) fn move_to(&mut self, row: usize, column: usize) {
        self.cursor.row = row.min(ROWS - 1);
        self.cursor.column = column.min(COLUMNS - 1);
        self.cursor.at_end = false;
    }

    /// Moves up by rows, not out of the scroll region if the cursor is in it or below its top.
    pub(super) fn up(&mut self, rows: usize) {
        let limit = if self.cursor.row >= self.top { self.top } else { 0 };
        self.move_to(self.cursor.row.saturating_sub(rows).max(limit), self.cursor.column);
    }

    /// Moves down by rows, not out of the scroll region if the cursor is in it or above its bottom.
    pub(super) fn down(&mut self, rows: usize) {
        let limit = if self.cursor.row <= self.bottom { self.bottom } else { ROWS - 1 };
        self.move_to((self.cursor.row + rows).min(limit), self.cursor.column);
    }

    pub(super) fn left(&mut self, columns: usize) {
        self.move_to(self.cursor.row, self.cursor.column.saturating_sub(columns));
    }

    pub(super) fn right(&mut self, columns: usize) {
        self.move_to(self.cursor.row, self.cursor.column + columns);
    }

    /// Moves one row down; at the bottom of the scroll region that scrolls.
    pub(super) fn line_feed(&mut self) {
        if self.cursor.row == self.bottom {
            self.scroll_up(self.top, 1);
        } else if self.cursor.row + 1 < ROWS {
            self.cursor.row += 1;
        }
        self.cursor.at_end = false;
    }

    /// Moves one row up; at the top of the scroll region that scrolls.
    pub(super) fn reverse_line_feed(&mut self) {
        if self.cursor.row == self.top {
            self.scroll_down(self.top, 1);
        } else {
            self.cursor.row = self.cursor.row.saturating_sub(1);
        }
        self.cursor.at_end = false;
    }

    /// Moves the rows from `from` to the bottom of the region up; blank rows come in at the bottom.
    pub(super) fn scroll_up(&mut self, from: usize, count: usize) {
        let moved = &mut self.rows[from..=self.bottom];
        let count = count.min(moved.len());
        moved.rotate_left(count);
        let kept = moved.len() - count;
        moved[kept..].fill([Cell::default(); COLUMNS]);
    }

    /// Moves the rows from `from` to the bottom of the region down; blank rows come in at `from`.
    pub(super) fn scroll_down(&mut self, from: usize, count: usize) {
        let moved = &mut self.rows[from..=self.bottom];
        let count = count.min(moved.len());
        moved.rotate_right(count);
        moved[..count].fill([Cell::default(); COLUMNS]);
    }

    /// Inserts blank rows at the cursor; nothing outside the scroll region.
    pub(super) fn insert_rows(&mut self, count: usize) {
        if (self.top..=self.bottom).contains(&self.cursor.row) {
            self.scroll_down(self.cursor.row, count);
            self.move_to(self.cursor.row, 0);
        }
    }

    /// Deletes rows at the cursor; nothing outside the scroll region.
    pub(super) fn delete_rows(&mut self, count: usize) {
        if (self.top..=self.bottom).contains(&self.cursor.row) {
            self.scroll_up(self.cursor.row, count);
            self.move_to(self.cursor.row, 0);
        }
    }

    /// Inserts blanks at the cursor; what is pushed out of the row is lost.
    pub(super) fn insert_characters(&mut self, count: usize) {
        let moved = &mut self.rows[self.cursor.row][self.cursor.column..];
        let count = count.min(moved.len());
        moved.rotate_right(count);
        moved[..count].fill(Cell::default());
        self.cursor.at_end = false;
    }

    /// Deletes characters at the cursor; blanks come in at the end of the row.
    pub(super) fn delete_characters(&mut self, count: usize) {
        let moved = &mut self.rows[self.cursor.row][self.cursor.column..];
        let count = count.min(moved.len());
        moved.rotate_left(count);
        let kept = moved.len() - count;
        moved[kept..].fill(Cell::default());
        self.cursor.at_end = false;
    }

    /// Blanks characters from the cursor on.
    pub(super) fn erase_characters(&mut self, count: usize) {
        let end = (self.cursor.column + count).min(COLUMNS);
        self.rows[self.cursor.row][self.cursor.column..end].fill(Cell::default());
        self.cursor.at_end = false;
    }

    /// Blanks a part of the row of the cursor.
    pub(super) fn erase_in_row(&mut self, part: Part) {
        let column = self.cursor.column;
        let cells = match part {
            Part::FromCursor => column..COLUMNS,
            Part::Beginning => 0..column + 1,
            Part::All => 0..COLUMNS,
        };
        self.rows[self.cursor.row][cells].fill(Cell::default());
        self.cursor.at_end = false;
    }

    /// Blanks a part of the screen.
    pub(super) fn erase(&mut self, part: Part) {
        self.erase_in_row(part);
        let row = self.cursor.row;
        let rows = match part {
            Part::FromCursor => row + 1..ROWS,
            Part::Beginning => 0..row,
            Part::All => 0..ROWS,
        };
        self.rows[rows].fill([Cell::default(); COLUMNS]);
    }

    /// Fills the screen with one character, for adjusting it.
    pub(super) fn fill(&mut self, character: char) {
        self.rows.fill([Cell { character, ..Cell::default() }; COLUMNS]);
    }

    /// Sets the scroll region, rows from 0; nothing if it has not two rows at least.
    pub(super) fn set_region(&mut self, top: usize, bottom: usize) -> bool {
        let bottom = bottom.min(ROWS - 1);
        let valid = top < bottom;
        if valid {
            (self.top, self.bottom) = (top, bottom);
        }
        valid
    }

    /// Remembers position and attributes of the cursor.
    pub(super) fn save_cursor(&mut self) {
        self.saved = self.cursor;
    }

    /// Puts the cursor where it was remembered.
    pub(super) fn restore_cursor(&mut self) {
        self.cursor = self.saved;
    }

    /// Sets a tab stop at the cursor.
    pub(super) fn set_tab(&mut self) {
        self.tabs[self.cursor.column] = true;
    }

    /// Clears the tab stop at the cursor, or all.
    pub(super) fn clear_tabs(&mut self, all: bool) {
        if all {
            self.tabs = [false; COLUMNS];
        } else {
            self.tabs[self.cursor.column] = false;
        }
    }

    /// Moves to a tab stop on the right, or to the last column.
    pub(super) fn tab(&mut self, count: usize) {
        let mut stops = (self.cursor.column + 1..COLUMNS).filter(|c| self.tabs[*c]);
        let column = stops.nth(count.max(1) - 1).unwrap_or(COLUMNS - 1);
        self.move_to(self.cursor.row, column);
    }

    /// Moves to a tab stop on the left, or to the first column.
    pub(super) fn back_tab(&mut self, count: usize) {
        let column = (0..self.cursor.column).rev().filter(|c| self.tabs[*c]).nth(count.max(1) - 1).unwrap_or(0);
        self.move_to(self.cursor.row, column);
    }
}
