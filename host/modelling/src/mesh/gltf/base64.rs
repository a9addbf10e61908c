//! Bytes as text.
//!
//! # Source
//! Josefsson 2006, RFC 4648, section 4.

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Bytes as text with padding.
pub fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |k: usize| u32::from(group.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k) & 63) as usize] as char;
            text.push(if k <= group.len() { letter } else { '=' });
        }
    }
    text
}

/// The bytes of a text; the place of the first letter that is wrong.
pub fn decode(text: &str) -> Result<Vec<u8>, usize> {
    let letters = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(letters.len() / 4 * 3 + 2);
    for (group, part) in letters.chunks(4).enumerate() {
        let mut bits = 0;
        for (k, letter) in part.iter().enumerate() {
            let value = match letter {
                b'A'..=b'Z' => letter - b'A',
                b'a'..=b'z' => letter - b'a' + 26,
                b'0'..=b'9' => letter - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return Err(4 * group + k),
            };
            bits |= u32::from(value) << (18 - 6 * k);
        }
        if part.len() == 1 {
            return Err(4 * group);
        }
        bytes.extend_from_slice(&bits.to_be_bytes()[1..part.len()]);
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_of_the_standard_hold() {
        let examples = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
        for (count, text) in examples.into_iter().enumerate() {
            let bytes = &b"foobar"[..count];
            assert_eq!((encode(bytes).as_str(), decode(text)), (text, Ok(bytes.to_vec())));
        }
        assert_eq!((decode("Zg=a"), decode("Zm9vY"), decode("Zm9ä")), (Err(2), Err(4), Err(3)));
    }
}
