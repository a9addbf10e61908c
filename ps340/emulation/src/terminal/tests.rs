//! Tests of the terminal: golden screens, answers, robustness.

use super::*;
use crate::traversal::font::{self, Font};
use proptest::prelude::*;

fn fed(text: &str) -> Terminal {
    let mut terminal = Terminal::default();
    terminal.feed(text.as_bytes());
    terminal
}

fn screen(text: &str) -> String {
    fed(text).text()
}

/// A screen whose rows are numbered from 1.
fn numbered() -> Terminal {
    let mut terminal = Terminal::default();
    for row in 1..=ROWS {
        terminal.feed(format!("\x1b[{row}H{row}").as_bytes());
    }
    terminal
}

/// The first column of characters of each row, as far as rows have text.
fn rows(terminal: &Terminal) -> Vec<String> {
    terminal.text().lines().map(str::to_string).collect()
}

#[test]
fn text_stands_where_it_was_written() {
    assert_eq!(screen("HELLO\r\n  WORLD\r\n"), "HELLO\n  WORLD");
    assert_eq!(screen("\x1b[3;5HX\x1b[HY"), "Y\n\n    X");
    assert_eq!(screen("ABC\x08\x08X\ttab\x1b[1;20Hend"), "AXC     tab        end");
}

#[test]
fn what_clients_send_clears_the_screen() {
    let mut terminal = fed("SOME\r\nTEXT");
    terminal.feed(b"\x1b[H\x1b[J");
    assert_eq!((terminal.text().as_str(), terminal.cursor()), ("", (0, 0)));
}

#[test]
fn a_character_behind_the_last_column_begins_a_row_only_when_it_comes() {
    let full = "x".repeat(COLUMNS);
    let mut terminal = fed(&full);
    assert_eq!(terminal.cursor(), (0, COLUMNS - 1));
    terminal.feed(b"\r\nB");
    assert_eq!(terminal.text(), format!("{full}\nB"), "no empty row between");
    assert_eq!(screen(&format!("{full}y")), format!("{full}\ny"));
    let without = screen(&format!("\x1b[?7l{full}yz"));
    assert_eq!(without, format!("{}z", "x".repeat(COLUMNS - 1)), "the last column is written again");
}

#[test]
fn the_screen_scrolls_at_its_bottom_and_at_its_top() {
    let mut terminal = numbered();
    terminal.feed(b"\x1b[24;1H\n");
    assert_eq!(rows(&terminal)[0], "2");
    assert_eq!(rows(&terminal).len(), 23);
    terminal.feed(b"\x1b[H\x1bM\x1bM");
    assert_eq!(rows(&terminal)[..3], ["", "", "2"]);
}

#[test]
fn only_the_scroll_region_scrolls() {
    let mut terminal = numbered();
    terminal.feed(b"\x1b[3;5r");
    assert_eq!(terminal.cursor(), (0, 0), "setting the region sends the cursor home");
    terminal.feed(b"\x1b[5;1H\n\n");
    assert_eq!(rows(&terminal)[..7], ["1", "2", "5", "", "", "6", "7"]);
    terminal.feed(b"\x1b[3;1H\x1bM");
    assert_eq!(rows(&terminal)[..7], ["1", "2", "", "5", "", "6", "7"]);
    terminal.feed(b"\x1b[24;1H\n\n");
    assert_eq!(rows(&terminal)[23], "24", "below the region nothing scrolls");
    terminal.feed(b"\x1b[9;2r\x1b[5;5r");
    assert_eq!(terminal.screen.region(), (2, 4), "a region of less than two rows is none");
}

#[test]
fn rows_are_inserted_and_deleted_inside_the_region() {
    let mut terminal = numbered();
    terminal.feed(b"\x1b[2;5r\x1b[3;7H\x1b[L");
    assert_eq!(rows(&terminal)[..6], ["1", "2", "", "3", "4", "6"]);
    assert_eq!(terminal.cursor(), (2, 0));
    terminal.feed(b"\x1b[2M");
    assert_eq!(rows(&terminal)[..6], ["1", "2", "4", "", "", "6"]);
    terminal.feed(b"\x1b[10H\x1b[99L\x1b[99M");
    assert_eq!(rows(&terminal)[9], "10", "outside the region nothing happens");
}

#[test]
fn characters_are_inserted_deleted_and_erased() {
    assert_eq!(screen("ABCDEF\x1b[3G\x1b[2@"), "AB  CDEF");
    assert_eq!(screen("ABCDEF\x1b[3G\x1b[2P"), "ABEF");
    assert_eq!(screen("ABCDEF\x1b[3G\x1b[2X"), "AB  EF");
    assert_eq!(screen("ABCDEF\x1b[3G\x1b[4hxy\x1b[4lz"), "ABxyzDEF");
    assert_eq!(screen("ABC\x1b[9999@\x1b[9999P\x1b[9999X"), "ABC");
}

#[test]
fn erasures_go_to_the_end_from_the_beginning_or_all_the_way() {
    let block = "ABCDE\r\nABCDE\r\nABCDE\x1b[2;3H";
    for (erasure, left) in [
        ("\x1b[K", "ABCDE\nAB\nABCDE"),
        ("\x1b[1K", "ABCDE\n   DE\nABCDE"),
        ("\x1b[2K", "ABCDE\n\nABCDE"),
        ("\x1b[J", "ABCDE\nAB"),
        ("\x1b[1J", "\n   DE\nABCDE"),
        ("\x1b[2J", ""),
        ("\x1b[7J\x1b[9K", "ABCDE\nABCDE\nABCDE"),
    ] {
        assert_eq!(screen(&format!("{block}{erasure}")), left, "{erasure:?}");
    }
}

#[test]
fn the_cursor_stays_on_the_screen_and_in_the_region() {
    let place = |text: &str| fed(text).cursor();
    assert_eq!(place("\x1b[99;99H"), (23, 79));
    assert_eq!(place("\x1b[0;0H"), (0, 0));
    assert_eq!(place("\x1b[5;5H\x1b[99A\x1b[99D"), (0, 0));
    assert_eq!(place("\x1b[5;10r\x1b[7;3H\x1b[99B"), (9, 2));
    assert_eq!(place("\x1b[5;10r\x1b[7;3H\x1b[99A"), (4, 2));
    assert_eq!(place("\x1b[5;10r\x1b[20;3H\x1b[99B"), (23, 2));
    assert_eq!(place("\x1b[5;10r\x1b[?6h\x1b[2;2H"), (5, 1), "origin mode counts from the region");
    assert_eq!(place("\x1b[5;10r\x1b[?6h\x1b[99;2H"), (9, 1));
    assert_eq!(place("\x1b[4;9H\x1b7\x1b[H\x1b8"), (3, 8));
    assert_eq!(place("\x1b[65535;65536H\x1b[18446744073709551616C"), (23, 79));
}

#[test]
fn a_frame_is_built_from_moves_erasures_and_a_screen_of_e() {
    // In the way of the usual test of cursor movements: a frame of stars, inside it one of E, inside that nothing.
    let mut stream = String::from("\x1b#8");
    for row in 4..=21 {
        stream += &format!("\x1b[{row};11H\x1b[60X");
    }
    stream += "\x1b[H";
    stream += &"*\x08\x1b[B".repeat(23);
    stream += "\x1b[24;80H";
    // At the last column the cursor stays where it is.
    stream += &"*\x1b[A".repeat(23);
    stream += "\x1b[H\x1b[79C*\x1b[24;1H*\x1b[1;2H";
    stream += &"*".repeat(78);
    stream += "\x1b[24;79H";
    stream += &"*\x1b[2D".repeat(78);
    stream += "\x1b[12;30HINSIDE\x1b[5;15r\x1b[?6h\x1b[1;12HTOP\x1b[99;12HBOTTOM";
    let expected: Vec<String> = (1..=24)
        .map(|row: usize| {
            let at = |column: usize| match (row, column) {
                (1 | 24, _) | (_, 1 | 80) => '*',
                (4..=21, 11..=70) => ' ',
                _ => 'E',
            };
            let mut line: Vec<char> = (1..=80).map(at).collect();
            for (text_row, column, text) in [(12, 30, "INSIDE"), (5, 12, "TOP"), (15, 12, "BOTTOM")] {
                if row == text_row {
                    line.splice(column - 1..column - 1 + text.len(), text.chars());
                }
            }
            line.into_iter().collect()
        })
        .collect();
    assert_eq!(screen(&stream), expected.join("\n"));
}

#[test]
fn tab_stops_are_set_and_cleared() {
    let place = |text: &str| fed(text).cursor().1;
    assert_eq!(place("\t"), 8);
    assert_eq!(place("\x1b[9G\t\t"), 24);
    assert_eq!(place("\x1b[4G\x1bH\r\t"), 3);
    assert_eq!(place("\x1b[9G\x1b[g\r\t"), 16);
    assert_eq!(place("\x1b[3g\t"), 79);
    assert_eq!(place("\x1b[3I\x1b[2Z"), 8);
}

#[test]
fn attributes_belong_to_the_characters_written_under_them() {
    let terminal = fed("A\x1b[1;4mB\x1b[24;5;7mC\x1b[mD\x1b[31mE");
    let of = |column| terminal.cell(0, column).attributes;
    let plain = Attributes::default();
    assert_eq!((of(0), of(3), of(4)), (plain, plain, plain));
    assert_eq!(of(1), Attributes { bold: true, underline: true, ..plain });
    assert_eq!(of(2), Attributes { bold: true, blink: true, reverse: true, ..plain });
    assert!(terminal.blinks());
}

#[test]
fn line_graphics_are_characters_of_their_own() {
    assert_eq!(screen("\x1b(0lqqk\x1b(B\r\n\x1b)0a\x0ex\x0fx"), "┌──┐\na│x");
    assert_eq!(screen("\x1b(A#\x1b(B#"), "£#");
    assert_eq!(screen("\u{e9}"), "▒▒", "two bytes above 127");
}

#[test]
fn the_terminal_answers_what_it_is_asked() {
    let answer = |text: &str| String::from_utf8(fed(text).take_replies()).unwrap();
    assert_eq!(answer("\x1b[c"), "\x1b[?1;2c");
    assert_eq!(answer("\x1bZ\x1b[0c"), "\x1b[?1;2c\x1b[?1;2c");
    assert_eq!(answer("\x1b[5n"), "\x1b[0n");
    assert_eq!(answer("\x1b[4;7H\x1b[6n"), "\x1b[4;7R");
    assert_eq!(answer("\x1b[3;9r\x1b[?6h\x1b[2;7H\x1b[6n"), "\x1b[2;7R");
    assert_eq!(answer("\x1b[x"), "\x1b[2;1;1;112;112;1;0x");
    assert_eq!(answer("\x1b[>c\x1b[1c\x1b[99n"), "");
    assert!(fed(&"\x1b[c".repeat(100_000)).take_replies().len() <= MAX_REPLIES);
}

#[test]
fn sequences_that_are_unknown_or_broken_leave_no_trace() {
    for sequence in [
        "\x1b[12;34y",
        "\x1b[?9999h",
        "\x1b[=3q",
        "\x1b%G",
        "\x1b(Z",
        "\x1b]0;title\x07",
        "\x1bPdata\x1b\\",
        "\x1b_x\x1b\\",
        "\x1b[3:4m",
        "\x1b[4?5m",
        "\x1b[ q",
        "\x1b[1;2;3;4;5;6;7;8;9;10;11;12;13;14;15;16;17;18;19;20w",
        "\x00\x7f\x11\x13",
        "\x1b[12\x18\r",
        "\x1b\x1b[m",
    ] {
        let text = screen(&format!("AB{sequence}CD"));
        let expected = if sequence.contains('\x18') { "CD\u{0}" } else { "ABCD" };
        assert_eq!(text, expected.trim_end_matches('\u{0}'), "{sequence:?}");
    }
}

#[test]
fn control_characters_act_inside_sequences_and_cancel_ends_them() {
    assert_eq!(screen("AB\x1b[\x08KX"), "AX");
    assert_eq!(screen("A\x1b[1\x182J"), "A2J");
    assert_eq!(screen("A\x1b[1\x1a2J"), "A▒2J");
    assert_eq!(screen("A\x1b]text\x1b[1mB"), "AB", "a sequence inside a string ends it");
}

#[test]
fn keys_follow_their_modes() {
    let key = |name: &str| SPECIAL_KEYS.iter().find(|k| k.name == name).unwrap();
    let (normal, application) = (*fed("").modes(), *fed("\x1b[?1h\x1b=").modes());
    assert_eq!(key("up").sequence(&normal), b"\x1b[A");
    assert_eq!(key("up").sequence(&application), b"\x1bOA");
    assert_eq!(key("keypad7").sequence(&normal), b"7");
    assert_eq!(key("keypad7").sequence(&application), b"\x1bOw");
    assert_eq!(key("pf1").sequence(&normal), b"\x1bOP");
    for (i, key) in SPECIAL_KEYS.iter().enumerate() {
        assert!(SPECIAL_KEYS[..i].iter().all(|k| k.name != key.name && k.code != key.code), "{}", key.name);
    }
}

#[test]
fn the_set_up_page_flips_features_and_covers_the_screen() {
    let mut terminal = fed("TEXT");
    terminal.toggle_setup();
    assert!(terminal.text().starts_with("SET-UP\n\n1  wrap at the last column          on\n"), "{}", terminal.text());
    terminal.type_in_setup(b'1');
    terminal.type_in_setup(b'x');
    assert!(!terminal.modes().wrap && terminal.text().contains("wrap at the last column          off"));
    terminal.toggle_setup();
    assert_eq!(terminal.text(), "TEXT");
    terminal.toggle_setup();
    terminal.type_in_setup(b'0');
    terminal.toggle_setup();
    assert!(terminal.modes().wrap && terminal.text().is_empty());
}

#[test]
fn a_character_is_drawn_in_its_cell_and_a_blank_nowhere() {
    let mut terminal = Terminal::default();
    assert!(terminal.strokes(true, false).is_empty());
    terminal.feed(b"\x1b[24;80HW");
    let drawn = terminal.strokes(true, false);
    assert_eq!(drawn.len(), font::strokes(Font::Standard.glyph(b'W')).count());
    // The last cell ends 0.04 from the right edge of the screen, and lies above the message line.
    for [x, y] in drawn.iter().flat_map(|s| [s.start, s.end]) {
        assert!((0.936..=0.96).contains(&x) && (-0.88..=-0.8).contains(&y), "{x},{y}");
    }
    let message = text_line(MESSAGE_ROW, &[b'g'; 200], terminal.ink());
    assert_eq!(message.len() % COLUMNS, 0, "80 characters of the line are drawn");
    assert!(message.iter().flat_map(|s| [s.start[1], s.end[1]]).all(|y| (-1.0..-0.88).contains(&y)));
}

#[test]
fn blinking_reversed_and_coloured_text_is_drawn_so() {
    let mut terminal = fed("\x1b[5mA\x1b[m");
    assert!(terminal.strokes(false, false).is_empty() && !terminal.strokes(true, false).is_empty());
    let plain = fed("AB").strokes(true, false).len();
    assert_eq!(fed("\x1b[7mAB").strokes(true, false).len(), plain + 4, "one frame around both");
    assert_eq!(fed("AB").strokes(true, true).len(), plain + 4, "the cursor is a frame");
    assert_eq!(fed("\x1b[?25lAB").strokes(true, true).len(), plain);
    terminal.feed(b"A");
    terminal.set_ink(Ink { hue: 120.0, saturation: 1.0, csm: true });
    assert_eq!(terminal.strokes(false, false)[0].color, [1.0, 0.0, 0.0]);
    terminal.set_ink(Ink { csm: false, ..*terminal.ink() });
    assert_eq!(terminal.strokes(false, false)[0].color, [1.0; 3]);
}

/// Bytes of which many belong to sequences.
fn streams() -> impl Strategy<Value = Vec<u8>> {
    let telling = prop::sample::select(b"\x1b[[[?;0123456789ABCDHJKLMPrmhl@ST78=>c\r\n\t\x08 xyz".to_vec());
    prop::collection::vec(prop_oneof![4 => telling, 1 => any::<u8>()], 0..400)
}

proptest! {
    #[test]
    fn any_bytes_leave_the_cursor_on_a_screen_of_24_by_80(stream in streams()) {
        let mut terminal = Terminal::default();
        terminal.feed(&stream);
        let (row, column) = terminal.cursor();
        prop_assert!(row < ROWS && column < COLUMNS);
        let text = terminal.screen.text();
        prop_assert_eq!(text.lines().count(), ROWS);
        prop_assert!(text.lines().all(|line| line.chars().count() <= COLUMNS && !line.chars().any(char::is_control)));
        let (top, bottom) = terminal.screen.region();
        prop_assert!(top < bottom && bottom < ROWS);
        let strokes = terminal.strokes(true, true);
        prop_assert!(strokes.iter().all(|s| s.start.iter().chain(&s.end).all(|c| c.abs() <= 1.0)));
    }

    #[test]
    fn a_stream_means_the_same_however_it_is_cut(stream in streams(), cut in 0_usize..400) {
        let (mut one, mut two) = (Terminal::default(), Terminal::default());
        one.feed(&stream);
        let (first, second) = stream.split_at(cut.min(stream.len()));
        two.feed(first);
        two.feed(second);
        prop_assert_eq!(one.text(), two.text());
        prop_assert_eq!(one.cursor(), two.cursor());
        prop_assert_eq!(one.take_replies(), two.take_replies());
    }
}
