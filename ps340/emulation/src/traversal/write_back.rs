//! What WRITEBACK sends of a picture: records of eight bytes, or the text of a vector list.
//!
//! # Source
//! That attributes and end points go out as 16-bit items is a reconstruction; the records are ours:
//!
//! | code | a | b | c |
//! |---|---|---|---|
//! | 0 move, 1 draw, 2 dot | x | y | intensity |
//! | 3 hue | 1/64 degree | 0 | 0 |
//! | 4 saturation | 0..=32767 | 0 | 0 |
//! | 65535 end | 0 | 0 | 0 |
//!
//! Each item has 16 bits, the high byte first; x and y are -32768..=32767 over the screen, the intensity 0..=32767.

use super::Stroke;
use crate::{functions::printing::decimal, hue};

/// Bytes of a record.
pub const RECORD: usize = 8;
/// Records in one message; ours, so that a message is no longer than a packet of the time.
pub const RECORDS_PER_MESSAGE: usize = 128;
/// Significant digits in the text.
const DIGITS: usize = 7;

const MOVE: u16 = 0;
const DRAW: u16 = 1;
const DOT: u16 = 2;
const HUE: u16 = 3;
const SATURATION: u16 = 4;
const END: u16 = 0xffff;

/// The items of the strokes, one after the other.
enum Item {
    /// Degrees and 0..=1.
    Color([f32; 2]),
    Move([f32; 2], f32),
    Draw([f32; 2], f32),
    Dot([f32; 2], f32),
}

/// The items of strokes: a colour where it changes, a move where a stroke does not begin at the end of the one before.
fn items<'s>(strokes: impl IntoIterator<Item = &'s Stroke>) -> impl Iterator<Item = Item> {
    let mut color = None;
    let mut at = None;
    strokes.into_iter().flat_map(move |stroke| {
        let mut items = Vec::with_capacity(3);
        if color.replace(stroke.color) != Some(stroke.color) {
            items.push(Item::Color(hue::hue_saturation(stroke.color)));
        }
        let [first, last] = stroke.intensity;
        // A vector along the line of sight is a dot on the screen with two intensities.
        if stroke.is_dot() && first == last {
            items.push(Item::Dot(stroke.start, first));
        } else {
            if at != Some((stroke.start, first)) {
                items.push(Item::Move(stroke.start, first));
            }
            items.push(Item::Draw(stroke.end, last));
        }
        at = Some((stroke.end, last));
        items
    })
}

/// The records of strokes, with the end record.
pub fn records<'s>(strokes: impl IntoIterator<Item = &'s Stroke>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut put = |code: u16, items: [i16; 3]| {
        bytes.extend(code.to_be_bytes());
        items.iter().for_each(|item| bytes.extend(item.to_be_bytes()));
    };
    let screen = |c: f32| (c * 32768.0).round().clamp(-32768.0, 32767.0) as i16;
    let part = |c: f32| (c * 32767.0).round().clamp(0.0, 32767.0) as i16;
    for item in items(strokes) {
        match item {
            Item::Color([h, s]) => {
                put(HUE, [(h * 64.0).round() as i16, 0, 0]);
                put(SATURATION, [part(s), 0, 0]);
            }
            Item::Move([x, y], i) => put(MOVE, [screen(x), screen(y), part(i)]),
            Item::Draw([x, y], i) => put(DRAW, [screen(x), screen(y), part(i)]),
            Item::Dot([x, y], i) => put(DOT, [screen(x), screen(y), part(i)]),
        }
    }
    put(END, [0; 3]);
    bytes
}

/// The strokes as the text of a vector list, a line each, the last with a `;`. A dot is a line of no length; colours
/// stand in comments.
pub fn lines<'s>(strokes: impl IntoIterator<Item = &'s Stroke>) -> Vec<String> {
    let number = |c: f32| decimal(f64::from(c), DIGITS);
    let place = |[x, y]: [f32; 2], i: f32| format!("{},{} I={}", number(x), number(y), number(i));
    let mut lines = vec![String::new()];
    let mut count = 0;
    for item in items(strokes) {
        match item {
            Item::Color([h, s]) => lines.push(format!("{{ COLOR {},{} }}", number(h), number(s))),
            Item::Move(at, i) => lines.push(format!("P {}", place(at, i))),
            Item::Draw(at, i) => lines.push(format!("L {}", place(at, i))),
            Item::Dot(at, i) => {
                lines.push(format!("P {}", place(at, i)));
                lines.push(format!("L {}", place(at, i)));
                count += 1;
            }
        }
        count += usize::from(!matches!(item, Item::Color(_)));
    }
    lines[0] = format!("VECTOR_LIST ITEMIZED N={count}");
    if let Some(last) = lines.last_mut() {
        last.push(';');
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::command::{Command, Object, parse};

    const RED: [f32; 3] = [1.0, 0.0, 0.0];

    fn corner() -> [Stroke; 3] {
        let stroke = |start, end, color| Stroke { start, end, intensity: [1.0, 0.5], color };
        let first = Stroke { intensity: [1.0, 1.0], ..stroke([-1.0, 0.0], [0.5, 0.25], RED) };
        let dot = Stroke { intensity: [1.0, 1.0], ..stroke([0.0, 0.0], [0.0, 0.0], [1.0; 3]) };
        [first, stroke([0.5, 0.25], [1.0, 1.0], RED), dot]
    }

    #[test]
    fn strokes_that_join_need_no_move_between_them() {
        let bytes = records(&corner());
        let words: Vec<u16> = bytes.chunks(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
        let codes: Vec<u16> = words.iter().step_by(4).copied().collect();
        assert_eq!(codes, [HUE, SATURATION, MOVE, DRAW, DRAW, HUE, SATURATION, DOT, END]);
        assert_eq!(words[..4], [HUE, 120 * 64, 0, 0]);
        assert_eq!(words[8..16], [MOVE, 0x8000, 0, 0x7fff, DRAW, 0x4000, 0x2000, 0x7fff]);
        assert_eq!(words[16..20], [DRAW, 0x7fff, 0x7fff, 0x4000]);
    }

    #[test]
    fn the_text_is_a_vector_list_that_draws_the_same() {
        let text = lines(&corner());
        assert_eq!(text[0], "VECTOR_LIST ITEMIZED N=5");
        assert_eq!(text[1], "{ COLOR 120,1 }");
        assert_eq!(text.last().map(String::as_str), Some("L 0,0 I=1;"));
        let parsed = parse(format!("A := {}", text.join("\n")).as_bytes());
        let Ok(Command::Define { object: Object::VectorList(list), .. }) = parsed else { panic!("{parsed:?}") };
        assert_eq!(list.points.len(), 5);
        assert_eq!(list.lines, [false, true, true, false, true]);
        assert_eq!(list.points[2], [1.0, 1.0, 0.0, 0.5]);
    }

    #[test]
    fn a_vector_along_the_line_of_sight_keeps_both_intensities() {
        let stroke = Stroke { start: [0.0; 2], end: [0.0; 2], intensity: [1.0, 0.0], color: [1.0; 3] };
        assert_eq!(lines(&[stroke])[2..], ["P 0,0 I=1", "L 0,0 I=0;"]);
    }

    #[test]
    fn an_empty_picture_is_still_a_message() {
        assert_eq!(records(&[]).len(), RECORD);
        assert_eq!(lines(&[]), ["VECTOR_LIST ITEMIZED N=0;"]);
    }
}
