//! The standard stroke font: every printable character of ASCII in the unit cell.
//!
//! Our own design. Capitals and digits stand on the line y = 0 and are 0.8 high, small letters
//! 0.55, descenders reach -0.2; the width is at most 0.66 of the cell, which leaves the rest as
//! the gap to the next character. Round strokes are parabolas, each drawn as six straight ones: at a cell of a
//! tenth of the screen they are a third of a pixel off. Characters that are easily taken for one another differ
//! in more than size: 0 has a stroke through it, 1 a slanted flag and a foot, I two serifs, l a bent foot.

use super::GlyphPoint;
use std::sync::OnceLock;

/// Straight strokes that stand for a parabola.
const PARTS: usize = 6;
/// Steps of the design grid across and up a cell; characters are 12 wide at most.
const GRID: [f32; 2] = [18.2, 20.0];
/// The first character of the table.
const FIRST: u8 = b'!';

/// The points of a character; none for a space and for codes that the font does not have.
///
/// The first call builds the font, further calls return what is there.
pub(super) fn glyph(code: u8) -> &'static [GlyphPoint] {
    static FONT: OnceLock<Vec<Vec<GlyphPoint>>> = OnceLock::new();
    let font = FONT.get_or_init(|| GLYPHS.iter().map(|row| draw(row)).collect());
    let index = code.checked_sub(FIRST).map(usize::from);
    index.and_then(|index| font.get(index)).map_or(&[], Vec::as_slice)
}

/// Draws a row of the table.
fn draw(row: &str) -> Vec<GlyphPoint> {
    let mut points: Vec<GlyphPoint> = Vec::new();
    for polyline in row.split(" / ") {
        let (mut control, mut drawn) = (None, false);
        for word in polyline.split_whitespace() {
            let point = parse_point(word.trim_matches(['(', ')']));
            if word.starts_with('(') {
                control = Some(point);
                continue;
            }
            if let (Some(bend), Some((start, _))) = (control.take(), points.last().copied()) {
                let part = |part| (parabola(start, bend, point, part as f32 / PARTS as f32), true);
                points.extend((1..PARTS).map(part));
            }
            points.push((point, drawn));
            drawn = true;
        }
    }
    points
}

/// The point at t = 0..=1 of a quadratic Bezier curve.
fn parabola(start: [f32; 2], bend: [f32; 2], end: [f32; 2], t: f32) -> [f32; 2] {
    let rest = 1.0 - t;
    [0, 1].map(|axis| rest * rest * start[axis] + 2.0 * rest * t * bend[axis] + t * t * end[axis])
}

/// A point of the grid, `x,y`, in cell units. The table is fixed; a test reads every number of it.
fn parse_point(text: &str) -> [f32; 2] {
    let (x, y) = text.split_once(',').unwrap_or((text, ""));
    let [x, y] = [x, y].map(|number| number.parse().unwrap_or(f32::NAN));
    [x / GRID[0], y / GRID[1]]
}

/// A row a character from [`FIRST`] on. Points x,y of the grid joined by straight strokes; a point in
/// parentheses bends the stroke between its neighbours; a slash lifts the pen.
const GLYPHS: [&str; 94] = [
    /* ! */ "6,16 6,5 / 5.6,0 6.4,0 6.4,0.8 5.6,0.8 5.6,0",
    /* " */ "4,16 4,11 / 8,16 8,11",
    /* # */ "3,2 5,14 / 7,2 9,14 / 1,10 11,10 / 1,6 11,6",
    /* $ */ "11,12 (11,14) 6,14 (1,14) 1,11 (1,8) 6,8 (11,8) 11,5 (11,2) 6,2 (1,2) 1,4 / 6,17 6,-1",
    /* % */
    "1,0 11,16 / 3,16 (1,16) 1,13.5 (1,11) 3,11 (5,11) 5,13.5 (5,16) 3,16 / 9,5 (7,5) 7,2.5 (7,0) 9,0 (11,0) 11,2.5 (11,5) 9,5",
    /* & */
    "12,0 3,11 (2,12.3) 2,13.5 (2,16) 5,16 (8,16) 8,13.5 (8,11.5) 5,9.5 (1,7) 1,4 (1,0) 5,0 (9.5,0) 11,7",
    /* ' */ "6,16 6,11",
    /* ( */ "8,18 (4,13.5) 4,7.5 (4,1.5) 8,-3",
    /* ) */ "4,18 (8,13.5) 8,7.5 (8,1.5) 4,-3",
    /* * */ "6,13 6,3 / 1.7,10.5 10.3,5.5 / 1.7,5.5 10.3,10.5",
    /* + */ "6,13 6,3 / 1,8 11,8",
    /* , */ "6,1.5 6,0 (6,-2) 4.5,-3",
    /* - */ "2,8 10,8",
    /* . */ "5.6,0 6.4,0 6.4,0.8 5.6,0.8 5.6,0",
    /* / */ "1,-2 11,18",
    /* 0 */ "6,16 (1,16) 1,8 (1,0) 6,0 (11,0) 11,8 (11,16) 6,16 / 4,5 8,11",
    /* 1 */ "2,12.5 6,16 6,0 / 2,0 10,0",
    /* 2 */ "1,12 (1,16) 6,16 (11,16) 11,12 (11,9) 7,6 1,0 11,0",
    /* 3 */ "1.5,16 10.5,16 5.5,9.5 (11,9.5) 11,4.8 (11,0) 6,0 (1.5,0) 1,3.5",
    /* 4 */ "8.5,0 8.5,16 1,5 11.5,5",
    /* 5 */ "10,16 2.5,16 1.7,8.5 (3.5,10) 6,10 (11,10) 11,5 (11,0) 6,0 (1.8,0) 1,3",
    /* 6 */ "10,15.2 (8.5,16) 7,16 (1,16) 1,6 (1,0) 6,0 (11,0) 11,5 (11,10) 6,10 (1.5,10) 1,5.5",
    /* 7 */ "1,16 11,16 4.5,0",
    /* 8 */
    "6,8.6 (1.8,8.6) 1.8,12.3 (1.8,16) 6,16 (10.2,16) 10.2,12.3 (10.2,8.6) 6,8.6 (1,8.6) 1,4.3 (1,0) 6,0 (11,0) 11,4.3 (11,8.6) 6,8.6",
    /* 9 */ "2,0.8 (3.5,0) 5,0 (11,0) 11,10 (11,16) 6,16 (1,16) 1,11 (1,6) 6,6 (10.5,6) 11,10.5",
    /* : */ "5.6,9 6.4,9 6.4,9.8 5.6,9.8 5.6,9 / 5.6,0 6.4,0 6.4,0.8 5.6,0.8 5.6,0",
    /* ; */ "5.6,9 6.4,9 6.4,9.8 5.6,9.8 5.6,9 / 6,1.5 6,0 (6,-2) 4.5,-3",
    /* < */ "10.5,13 1.5,8 10.5,3",
    /* = */ "1,10 11,10 / 1,6 11,6",
    /* > */ "1.5,13 10.5,8 1.5,3",
    /* ? */
    "1.5,12.5 (1.5,16) 6,16 (10.5,16) 10.5,12.3 (10.5,9.5) 8,8.2 (6,7.2) 6,4.5 / 5.6,0 6.4,0 6.4,0.8 5.6,0.8 5.6,0",
    /* @ */
    "8.5,10 (8,11) 6.2,11 (3.5,11) 3.5,7.5 (3.5,4.5) 5.7,4.5 (8,4.5) 8.5,8 / 8.5,11 8.5,6 (8.5,4.5) 10,4.5 (12,4.5) 12,9 (12,16) 6.5,16 (0.5,16) 0.5,8 (0.5,0) 6.5,0 (9,0) 10.5,1",
    /* A */ "0.5,0 6,16 11.5,0 / 2.4,5.5 9.6,5.5",
    /* B */
    "1,0 1,16 6.5,16 (10.2,16) 10.2,12.4 (10.2,8.8) 6.5,8.8 (11,8.8) 11,4.4 (11,0) 6.5,0 1,0 / 1,8.8 6.5,8.8",
    /* C */ "11,12.5 (10,16) 6.5,16 (1,16) 1,8 (1,0) 6.5,0 (10,0) 11,3.5",
    /* D */ "1,0 1,16 5,16 (11,16) 11,8 (11,0) 5,0 1,0",
    /* E */ "10.5,16 1.5,16 1.5,0 10.5,0 / 1.5,8.5 8.5,8.5",
    /* F */ "10.5,16 1.5,16 1.5,0 / 1.5,8.5 8.5,8.5",
    /* G */ "11,12.5 (10,16) 6.5,16 (1,16) 1,8 (1,0) 6.5,0 (9.5,0) 11,2.5 11,7.5 7,7.5",
    /* H */ "1,0 1,16 / 11,0 11,16 / 1,8.5 11,8.5",
    /* I */ "6,0 6,16 / 3,16 9,16 / 3,0 9,0",
    /* J */ "9.5,16 9.5,5 (9.5,0) 5.3,0 (1.5,0) 1,4",
    /* K */ "1.5,0 1.5,16 / 11,16 1.5,6.5 / 4.9,9.9 11.3,0",
    /* L */ "1.5,16 1.5,0 10.5,0",
    /* M */ "0.5,0 0.5,16 6,6 11.5,16 11.5,0",
    /* N */ "1,0 1,16 11,0 11,16",
    /* O */ "6,16 (0.5,16) 0.5,8 (0.5,0) 6,0 (11.5,0) 11.5,8 (11.5,16) 6,16",
    /* P */ "1.5,0 1.5,16 6.5,16 (11,16) 11,11.7 (11,7.4) 6.5,7.4 1.5,7.4",
    /* Q */ "6,16 (0.5,16) 0.5,8 (0.5,0) 6,0 (11.5,0) 11.5,8 (11.5,16) 6,16 / 7.5,4 11.5,-1",
    /* R */ "1.5,0 1.5,16 6.5,16 (11,16) 11,11.8 (11,7.6) 6.5,7.6 1.5,7.6 / 6.5,7.6 11.3,0",
    /* S */ "10.5,13 (9.5,16) 6,16 (1.3,16) 1.3,12.3 (1.3,9.2) 6,8.3 (11,7.4) 11,4 (11,0) 6,0 (2,0) 1,3.3",
    /* T */ "0.5,16 11.5,16 / 6,16 6,0",
    /* U */ "1,16 1,5.5 (1,0) 6,0 (11,0) 11,5.5 11,16",
    /* V */ "0.5,16 6,0 11.5,16",
    /* W */ "0,16 3,0 6,11 9,0 12,16",
    /* X */ "1,0 11,16 / 1,16 11,0",
    /* Y */ "0.5,16 6,7.5 11.5,16 / 6,7.5 6,0",
    /* Z */ "1,16 11,16 1,0 11,0",
    /* [ */ "8,18 4,18 4,-3 8,-3",
    /* \ */ "1,18 11,-2",
    /* ] */ "4,18 8,18 8,-3 4,-3",
    /* ^ */ "2,10.5 6,16 10,10.5",
    /* _ */ "0,-3 12,-3",
    /* ` */ "4.5,16 7,12.5",
    /* a */ "2,9 (2.8,11) 6,11 (10,11) 10,7.5 10,0 / 10,6.5 6,6.5 (1.5,6.5) 1.5,3.2 (1.5,0) 5,0 (8.5,0) 10,3",
    /* b */ "1.5,16 1.5,0 / 1.5,3.5 (2.5,0) 6,0 (10.5,0) 10.5,5.5 (10.5,11) 6,11 (2.5,11) 1.5,7.5",
    /* c */ "10,8.5 (9,11) 6,11 (1.5,11) 1.5,5.5 (1.5,0) 6,0 (9,0) 10,2.5",
    /* d */ "10.5,16 10.5,0 / 10.5,3.5 (9.5,0) 6,0 (1.5,0) 1.5,5.5 (1.5,11) 6,11 (9.5,11) 10.5,7.5",
    /* e */ "1.5,6 10.5,6 (10.5,11) 6,11 (1.5,11) 1.5,5.5 (1.5,0) 6.2,0 (9,0) 10,2.2",
    /* f */ "10,15.5 (9.3,16) 8.3,16 (5.5,16) 5.5,12.5 5.5,0 / 2.5,11 9.5,11",
    /* g */
    "10.5,11 10.5,0.5 (10.5,-4) 6,-4 (3.2,-4) 2,-2.5 / 10.5,3.8 (9.5,0.5) 6,0.5 (1.5,0.5) 1.5,5.7 (1.5,11) 6,11 (9.5,11) 10.5,7.7",
    /* h */ "1.5,16 1.5,0 / 1.5,7 (2.5,11) 6.2,11 (10.2,11) 10.2,7 10.2,0",
    /* i */ "3.5,11 6,11 6,0 / 3,0 9,0 / 5.6,15 6.4,15 6.4,15.8 5.6,15.8 5.6,15",
    /* j */ "4.5,11 7.5,11 7.5,-0.5 (7.5,-4) 4.5,-4 (3,-4) 2,-3 / 7.1,15 7.9,15 7.9,15.8 7.1,15.8 7.1,15",
    /* k */ "2,16 2,0 / 9.5,11 2,4.2 / 4.8,6.7 10,0",
    /* l */ "3.5,16 6,16 6,3 (6,0) 9,0",
    /* m */
    "0.5,11 0.5,0 / 0.5,7.5 (1,11) 3.5,11 (6,11) 6,7.5 6,0 / 6,7.5 (6.5,11) 9,11 (11.5,11) 11.5,7.5 11.5,0",
    /* n */ "1.5,11 1.5,0 / 1.5,7 (2.5,11) 6.2,11 (10.2,11) 10.2,7 10.2,0",
    /* o */ "6,11 (1.2,11) 1.2,5.5 (1.2,0) 6,0 (10.8,0) 10.8,5.5 (10.8,11) 6,11",
    /* p */ "1.5,11 1.5,-4 / 1.5,3.5 (2.5,0) 6,0 (10.5,0) 10.5,5.5 (10.5,11) 6,11 (2.5,11) 1.5,7.5",
    /* q */ "10.5,11 10.5,-4 / 10.5,3.5 (9.5,0) 6,0 (1.5,0) 1.5,5.5 (1.5,11) 6,11 (9.5,11) 10.5,7.5",
    /* r */ "3,11 3,0 / 3,6.5 (4,11) 7.8,11 (9.3,11) 10,10.3",
    /* s */ "9.5,9 (8.7,11) 6,11 (2,11) 2,8.4 (2,6.3) 6,5.7 (10.2,5.1) 10.2,2.8 (10.2,0) 6,0 (2.5,0) 1.6,2.2",
    /* t */ "5,15 5,3.5 (5,0) 7.8,0 (9,0) 9.8,0.6 / 2,11 9,11",
    /* u */ "1.8,11 1.8,4 (1.8,0) 5.8,0 (9.5,0) 10.5,4 / 10.5,11 10.5,0",
    /* v */ "1.2,11 6,0 10.8,11",
    /* w */ "0.2,11 3.2,0 6,8.5 8.8,0 11.8,11",
    /* x */ "1.5,0 10.5,11 / 1.5,11 10.5,0",
    /* y */ "1.2,11 6,0 / 10.8,11 5,-2.3 (4.2,-4) 2,-4",
    /* z */ "1.8,11 10.2,11 1.8,0 10.2,0",
    /* { */ "8.5,18 (6,18) 6,15 6,10.5 (6,7.5) 3.5,7.5 (6,7.5) 6,4.5 6,0 (6,-3) 8.5,-3",
    /* | */ "6,18 6,-3",
    /* } */ "3.5,18 (6,18) 6,15 6,10.5 (6,7.5) 8.5,7.5 (6,7.5) 6,4.5 6,0 (6,-3) 3.5,-3",
    /* ~ */ "1,7 (2,9.5) 4,9.5 (5.5,9.5) 6,8 (6.5,6.5) 8,6.5 (10,6.5) 11,9",
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traversal::font::strokes;

    #[test]
    fn every_printable_character_has_strokes_inside_its_cell() {
        for code in 33..=126 {
            assert!(strokes(glyph(code)).count() > 0, "character {code}");
            for ([x, y], _) in glyph(code) {
                assert!((0.0..=0.66).contains(x) && (-0.25..=1.0).contains(y), "{x},{y} of character {code}");
            }
            let still = strokes(glyph(code)).find(|[start, end]| start == end);
            assert_eq!(still, None, "a stroke of no length in character {code}");
            let moves = glyph(code).windows(2).filter(|pair| !pair[0].1 && !pair[1].1).count();
            assert_eq!(moves, 0, "a single point in character {code}");
        }
    }

    #[test]
    fn other_codes_draw_nothing() {
        for code in (0..=32).chain(127..=255) {
            assert!(glyph(code).is_empty());
        }
    }

    #[test]
    fn capitals_and_digits_stand_on_the_line_and_are_four_fifths_high() {
        for code in (b'A'..=b'Z').chain(b'0'..=b'9').filter(|code| *code != b'Q') {
            let heights = || glyph(code).iter().map(|point| point.0[1]);
            let (low, high) = (heights().fold(f32::MAX, f32::min), heights().fold(f32::MIN, f32::max));
            assert_eq!((low, high), (0.0, 0.8), "{}", code as char);
        }
    }

    #[test]
    fn round_strokes_pass_through_their_ends_and_bend_towards_the_control_point() {
        let line = draw("0,0 (18.2,0) 18.2,20 0,20 / 0,0 18.2,0");
        assert_eq!(line.len(), 1 + PARTS + 1 + 2);
        assert_eq!(
            (line[0], line[PARTS], line[PARTS + 1]),
            (([0.0, 0.0], false), ([1.0, 1.0], true), ([0.0, 1.0], true))
        );
        assert_eq!(line[PARTS / 2], ([0.75, 0.25], true));
        assert_eq!(line[PARTS + 2..], [([0.0, 0.0], false), ([1.0, 0.0], true)]);
    }
}
