//! Comparing what came with what was expected.

use super::case::{Expected, StrokeLine};

/// A numbered message of the machine, in parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MachineMessage<'m> {
    /// `E`, `W` or `I`.
    pub class: char,
    /// Its number.
    pub number: u16,
    /// What follows the number.
    pub text: &'m str,
}

/// Reads a message of the form `E 5 *** text`.
pub fn fault(message: &[u8]) -> Option<MachineMessage<'_>> {
    let text = std::str::from_utf8(message).ok()?;
    let class = text.chars().next().filter(|c| "EWI".contains(*c))?;
    let (number, text) = text[1..].strip_prefix(' ')?.split_once(" *** ")?;
    Some(MachineMessage { class, number: number.parse().ok()?, text })
}

/// Whether a message is what was expected. [`Expected::AnyOrder`] is no question for one message, and false.
///
/// - `tolerance`: of numbers, absolute and relative.
/// - `any_fault`: numbers and texts of the machine's messages do not matter, only their class.
pub fn matches(expected: &Expected, message: &[u8], tolerance: f64, any_fault: bool) -> bool {
    match expected {
        Expected::Exact(bytes) => bytes == message,
        Expected::Numbers(text) => same_numbers(text, &String::from_utf8_lossy(message), tolerance),
        Expected::Glob(glob) => glob_matches(glob, &String::from_utf8_lossy(message)),
        Expected::Fault { class, number, text } => fault(message).is_some_and(|found| {
            let same_number = number.is_none_or(|n| n == found.number);
            let same_text = text.as_ref().is_none_or(|glob| glob_matches(glob, found.text));
            found.class == *class && (any_fault || same_number && same_text)
        }),
        Expected::AnyOrder(_) => false,
    }
}

/// A piece of a text: a number or a word.
#[derive(Clone, Debug, PartialEq)]
enum TextToken<'t> {
    Number(f64),
    Word(&'t str),
}

/// Numbers and words; blanks and commas separate, and a number ends a word.
fn pieces(text: &str) -> Vec<TextToken<'_>> {
    let mut pieces = Vec::new();
    let mut rest = text.trim_start_matches([' ', ',']);
    while let Some(first) = rest.chars().next() {
        let length = number_length(rest);
        if length > 0
            && let Ok(number) = rest[..length].parse()
        {
            pieces.push(TextToken::Number(number));
            rest = &rest[length..];
        } else {
            let ends = |c: char| c == ' ' || c == ',' || c.is_ascii_digit() || "+-.".contains(c);
            let after = first.len_utf8();
            let end = rest[after..].find(ends).map_or(rest.len(), |at| at + after);
            pieces.push(TextToken::Word(&rest[..end]));
            rest = &rest[end..];
        }
        rest = rest.trim_start_matches([' ', ',']);
    }
    pieces
}

/// The length of the number at the beginning: sign, digits, point, digits, exponent; 0 if there is none.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut at = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(at);
    at += whole;
    let mut fraction = 0;
    if bytes.get(at) == Some(&b'.') {
        fraction = digits(at + 1);
        if whole + fraction > 0 {
            at += 1 + fraction;
        }
    }
    if whole + fraction == 0 {
        return 0;
    }
    if matches!(bytes.get(at), Some(b'E' | b'e')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let exponent = if at + 1 + sign <= bytes.len() { digits(at + 1 + sign) } else { 0 };
        if exponent > 0 {
            at += 1 + sign + exponent;
        }
    }
    at
}

/// Whether two numbers differ by the tolerance at most, absolutely or relatively.
pub fn close(a: f64, b: f64, tolerance: f64) -> bool {
    a == b || (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(1.0)
}

/// Whether both texts have the same words, and numbers within the tolerance.
pub fn same_numbers(expected: &str, found: &str, tolerance: f64) -> bool {
    let (expected, found) = (pieces(expected), pieces(found));
    expected.len() == found.len()
        && expected.iter().zip(&found).all(|pair| match pair {
            (TextToken::Number(a), TextToken::Number(b)) => close(*a, *b, tolerance),
            (a, b) => a == b,
        })
}

/// Whether a text is as a pattern says: `*` any text, `?` any character.
pub fn glob_matches(glob: &str, text: &str) -> bool {
    let (glob, text): (Vec<char>, Vec<char>) = (glob.chars().collect(), text.chars().collect());
    let (mut g, mut t) = (0, 0);
    // Where the latest star stood, and how much of the text it has taken.
    let mut star = None;
    while t < text.len() {
        if glob.get(g) == Some(&'*') {
            star = Some((g, t));
            g += 1;
        } else if glob.get(g).is_some_and(|c| *c == '?' || *c == text[t]) {
            g += 1;
            t += 1;
        } else if let Some((at, taken)) = star {
            star = Some((at, taken + 1));
            g = at + 1;
            t = taken + 1;
        } else {
            return false;
        }
    }
    glob[g..].iter().all(|c| *c == '*')
}

/// The reason why strokes are not as expected; none if they are.
pub fn strokes_differ(
    count: Option<usize>,
    expected: &[StrokeLine],
    found: &[StrokeLine],
    tolerance: f64,
) -> Option<String> {
    let wanted = count.or((!expected.is_empty()).then_some(expected.len()));
    if let Some(wanted) = wanted
        && wanted != found.len()
    {
        return Some(format!("{wanted} strokes"));
    }
    let all = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| close(*a, *b, tolerance));
    let same = |a: &StrokeLine, b: &StrokeLine| {
        all(&a.start, &b.start)
            && all(&a.end, &b.end)
            && a.intensity.is_none_or(|i| b.intensity.is_some_and(|found| all(&i, &found)))
            && a.color.is_none_or(|c| b.color.is_some_and(|found| all(&c, &found)))
    };
    let wrong = expected.iter().zip(found).position(|(a, b)| !same(a, b))?;
    Some(format!("stroke {}: {:?}", wrong + 1, expected[wrong]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_compared_as_numbers_and_words_as_words() {
        assert!(same_numbers("V 0.25 -0.125", "V0.25,-.125", 1e-9));
        assert!(same_numbers("1V 1E-1", "1V  .1", 1e-9));
        assert!(same_numbers("100000 -3 1e-9 1;", " 100000,-3,1E-09,1;", 1e-9));
        assert!(!same_numbers("V 1 2", "V 1 2 3", 1e-9));
        assert!(!same_numbers("V 1", "M 1", 1e-9));
        assert!(!same_numbers("1", "1.001", 1e-6));
        assert!(same_numbers("1", "1.001", 1e-2));
        assert!(!same_numbers("1", "TRUE", 1e-2));
    }

    #[test]
    fn patterns_know_stars_and_question_marks() {
        for (glob, text, expected) in [
            ("*", "", true),
            ("a*c", "abbbc", true),
            ("a*c", "abbbd", false),
            ("*a*b*", "xxaxxbxx", true),
            ("a?c", "abc", true),
            ("a?c", "ac", false),
            ("", "", true),
            ("", "a", false),
            ("*ab", "aab", true),
        ] {
            assert_eq!(glob_matches(glob, text), expected, "{glob} {text}");
        }
    }

    #[test]
    fn faults_are_known_by_their_form() {
        let found = fault(b"E 5 *** Bad message type").unwrap();
        assert_eq!(found, MachineMessage { class: 'E', number: 5, text: "Bad message type" });
        assert_eq!(fault(b"E5"), None);
        assert_eq!(fault(b"X 5 *** y"), None);
        let wanted = |number| Expected::Fault { class: 'E', number, text: None };
        assert!(matches(&wanted(Some(5)), b"E 5 *** a", 0.0, false));
        assert!(!matches(&wanted(Some(6)), b"E 5 *** a", 0.0, false));
        assert!(matches(&wanted(Some(6)), b"E 5 *** a", 0.0, true));
        assert!(!matches(&wanted(None), b"W 5 *** a", 0.0, true));
    }

    #[test]
    fn strokes_are_compared_in_order() {
        let line = |x: f64| StrokeLine { start: [x, 0.0], end: [x, 1.0], intensity: Some([1.0, 1.0]), color: None };
        let bare = |x: f64| StrokeLine { intensity: None, ..line(x) };
        assert_eq!(strokes_differ(None, &[bare(1.0), bare(2.0)], &[line(1.0), line(2.0)], 1e-6), None);
        assert!(strokes_differ(None, &[bare(2.0), bare(1.0)], &[line(1.0), line(2.0)], 1e-6).is_some());
        assert!(strokes_differ(Some(1), &[], &[], 1e-6).is_some());
        assert_eq!(strokes_differ(Some(0), &[], &[], 1e-6), None);
    }
}
