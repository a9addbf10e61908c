//! Strokes of the vector screen, read from the operator line of an emulator or from the text of WRITEBACK.

use super::case::StrokeLine;

/// What stands before the lines of WRITEBACK, so that they are no messages of the case.
pub const MARK: &str = "~S ";

/// Most vectors that WRITEBACK can send through HOST_MESSAGE: two lines for a dot, and an input keeps 10,000 messages.
const MAX_VECTORS: usize = 9_000;

/// The strokes in the reply to `strokes`: their number, then on each line x, y, x, y, two intensities, red, green,
/// blue.
pub fn from_operator(reply: &str) -> Option<Vec<StrokeLine>> {
    let mut lines = reply.lines();
    let count: usize = lines.next()?.split(' ').next()?.parse().ok()?;
    let read = |line: &str| -> Option<StrokeLine> {
        let n: [f64; 9] = numbers(line)?.try_into().ok()?;
        let (intensity, color) = (Some([n[4], n[5]]), Some([n[6], n[7], n[8]]));
        Some(StrokeLine { start: [n[0], n[1]], end: [n[2], n[3]], intensity, color })
    };
    let strokes: Option<Vec<StrokeLine>> = lines.map(read).collect();
    strokes.filter(|s| s.len() == count)
}

/// A stroke as one line of a failure.
pub fn text(stroke: &StrokeLine) -> String {
    let StrokeLine { start, end, intensity, color } = stroke;
    let list = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let more = [intensity.map(|i| list(&i)), color.map(|c| list(&c))];
    let more: Vec<String> = more.into_iter().flatten().collect();
    format!("{} {} {}", list(start), list(end), more.join(" "))
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split([' ', ',']).filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect()
}

/// What a line of WRITEBACK leaves to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuation {
    /// There are further lines.
    Lines,
    /// It was the last.
    Nothing,
    /// There are more strokes than can come over the host line.
    TooMany,
}

/// Reads the text of WRITEBACK line by line: a vector list in screen coordinates, with the colours in comments.
#[derive(Clone, Debug, Default)]
pub struct WritebackText {
    /// The strokes read so far.
    pub strokes: Vec<StrokeLine>,
    begun: bool,
    at: Option<([f64; 2], f64)>,
    color: Option<[f64; 3]>,
}

impl WritebackText {
    /// Reads a line; none if it is no line of the text.
    pub fn line(&mut self, line: &str) -> Option<Continuation> {
        let (line, rest) =
            line.strip_suffix(';').map_or((line, Continuation::Lines), |line| (line, Continuation::Nothing));
        if !self.begun {
            self.begun = true;
            let count: usize = line.strip_prefix("VECTOR_LIST ITEMIZED N=")?.parse().ok()?;
            return Some(if count > MAX_VECTORS { Continuation::TooMany } else { rest });
        }
        if let Some(color) = line.strip_prefix("{ COLOR ").and_then(|line| line.strip_suffix(" }")) {
            let [hue, saturation] = numbers(color)?.try_into().ok()?;
            self.color = Some(rgb(hue, saturation));
            return Some(rest);
        }
        let [x, y, intensity] = numbers(&line.get(1..)?.replace("I=", ""))?.try_into().ok()?;
        let place = [x, y];
        if line.starts_with('L') {
            let (start, first) = self.at?;
            let intensity = Some([first, intensity]);
            self.strokes.push(StrokeLine { start, end: place, intensity, color: self.color });
        }
        self.at = Some((place, intensity));
        Some(rest)
    }
}

/// Red, green and blue of a hue (degrees, 0 is blue) and a saturation 0..=1: the formula of the reference, section A.5.
fn rgb(hue: f64, saturation: f64) -> [f64; 3] {
    let sixths = (hue - 120.0).rem_euclid(360.0) / 60.0;
    let (low, fraction) = (1.0 - saturation, sixths.fract());
    let (falling, rising) = (1.0 - saturation * fraction, 1.0 - saturation * (1.0 - fraction));
    match sixths as u32 {
        0 => [1.0, rising, low],
        1 => [falling, 1.0, low],
        2 => [low, 1.0, rising],
        3 => [low, falling, 1.0],
        4 => [rising, low, 1.0],
        _ => [1.0, low, falling],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reply_of_the_operator_is_read() {
        let read = from_operator("1 strokes\n0,0 0.5,0 1 0.5 1,0,0").unwrap();
        let stroke = StrokeLine {
            start: [0.0, 0.0],
            end: [0.5, 0.0],
            intensity: Some([1.0, 0.5]),
            color: Some([1.0, 0.0, 0.0]),
        };
        assert_eq!(read, [stroke]);
        assert_eq!(from_operator("2 strokes\n0,0 0.5,0 1 0.5 1,0,0"), None);
    }

    #[test]
    fn lines_that_join_and_dots_are_read_from_writeback() {
        let mut text = WritebackText::default();
        let lines = ["VECTOR_LIST ITEMIZED N=5", "{ COLOR 120,1 }", "P -1,0 I=1", "L 0.5,0.25 I=1", "L 1,1 I=0.5"];
        for line in lines {
            assert_eq!(text.line(line), Some(Continuation::Lines), "{line}");
        }
        assert_eq!(text.line("{ COLOR 0,0 }"), Some(Continuation::Lines));
        assert_eq!(text.line("P 0,0 I=1"), Some(Continuation::Lines));
        assert_eq!(text.line("L 0,0 I=1;"), Some(Continuation::Nothing));
        let stroke =
            |start, end, intensity, color| StrokeLine { start, end, intensity: Some(intensity), color: Some(color) };
        let expected = [
            stroke([-1.0, 0.0], [0.5, 0.25], [1.0, 1.0], [1.0, 0.0, 0.0]),
            stroke([0.5, 0.25], [1.0, 1.0], [1.0, 0.5], [1.0, 0.0, 0.0]),
            stroke([0.0, 0.0], [0.0, 0.0], [1.0, 1.0], [1.0, 1.0, 1.0]),
        ];
        assert_eq!(text.strokes, expected);
    }

    #[test]
    fn an_empty_picture_and_one_that_is_too_large_are_told_apart() {
        assert_eq!(WritebackText::default().line("VECTOR_LIST ITEMIZED N=0;"), Some(Continuation::Nothing));
        assert_eq!(WritebackText::default().line("VECTOR_LIST ITEMIZED N=20000"), Some(Continuation::TooMany));
        assert_eq!(WritebackText::default().line("P 0,0 I=1"), None);
    }

    #[test]
    fn the_circle_of_hues_begins_at_blue() {
        assert_eq!(rgb(0.0, 1.0), [0.0, 0.0, 1.0]);
        assert_eq!(rgb(180.0, 1.0), [1.0, 1.0, 0.0]);
        assert_eq!(rgb(330.0, 0.5), [0.5, 0.75, 1.0]);
    }
}
