//! Numbers for people to read: three significant digits.

/// Digits that are shown.
const DIGITS: usize = 3;

/// A text whose numbers with a point have three significant digits; others, names and texts in quotes stay.
pub fn rounded(text: &str) -> String {
    let mut readable = String::with_capacity(text.len());
    let mut rest = text;
    let mut before = ' ';
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '\'' => quoted(rest),
            '0'..='9' | '.' if !is_in_name(before) => number(rest),
            _ => first.len_utf8(),
        };
        let (piece, after) = rest.split_at(length);
        match piece.parse::<f64>() {
            Ok(value) if piece.contains('.') && value.is_finite() => readable.push_str(&short(value, piece)),
            _ => readable.push_str(piece),
        }
        before = piece.chars().next_back().unwrap_or(' ');
        rest = after;
    }
    readable
}

fn is_in_name(before: char) -> bool {
    before.is_ascii_alphanumeric() || "_$.".contains(before)
}

/// Bytes of a text in quotes.
fn quoted(text: &str) -> usize {
    text[1..].find('\'').map_or(text.len(), |end| end + 2)
}

/// Bytes of a number, with its exponent.
fn number(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(|byte| byte.is_ascii_digit() || *byte == b'.').count();
    let mantissa = digits(0);
    let bytes = text.as_bytes();
    let sign = usize::from(matches!(bytes.get(mantissa + 1), Some(b'+' | b'-')));
    match bytes.get(mantissa) {
        Some(b'e' | b'E') if bytes.get(mantissa + 1 + sign).is_some_and(u8::is_ascii_digit) => {
            mantissa + 1 + sign + digits(mantissa + 1 + sign)
        }
        _ => mantissa.max(1),
    }
}

/// A number of three significant digits, or as it is written if that is as short.
fn short(value: f64, written: &str) -> String {
    if value == 0.0 {
        return "0".into();
    }
    // The exponent after rounding: 0.9996 is 1.
    let scientific = format!("{value:.*e}", DIGITS - 1);
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()).unwrap_or(0);
    let text = match exponent {
        -4..=8 => {
            let decimals = usize::try_from(DIGITS as i32 - 1 - exponent).unwrap_or(0);
            let text = format!("{value:.decimals$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
        _ => scientific,
    };
    if text.len() < written.len() { text } else { written.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_significant_digits() {
        for (text, expected) in [
            ("49.99999999999999", "50"),
            ("V3D 0.123456,-17.34999 1e-12", "V3D 0.123,-17.3 1e-12"),
            ("A1.25 := ROTATE IN X 200.00000001;", "A1.25 := ROTATE IN X 200;"),
            ("'1.23456' 1.23456", "'1.23456' 1.23"),
            ("12345 123456.789 0.99951", "12345 123457 1"),
            ("1.23456e-7 0.0000 3.", "1.23e-7 0 3"),
            ("1.5 ä 2.25", "1.5 ä 2.25"),
        ] {
            assert_eq!(rounded(text), expected);
        }
    }
}
