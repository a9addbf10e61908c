//! The 6-bit form: any bytes as printable characters, for lines that do not carry all eight bits. Ours.
//!
//! Four characters carry three bytes. The bits of the three bytes, the highest of the first byte first, are cut into
//! four numbers of six bits, and each number is sent as the character [`SIX_BIT_ZERO`] plus that number: `0` to `9`,
//! then `: ; < = > ? @`, the capitals, `[ \ ] ^ _` and the grave accent, then `a` to `o`. One byte at the end takes two
//! characters, two bytes take three; their unused low bits are 0.
//!
//! Blanks and control characters between the characters are skipped, so that a host may break lines. The manuals say
//! that a 6-bit mode existed, not which characters it used.

/// The character that stands for 0.
pub const SIX_BIT_ZERO: u8 = b'0';

/// The reason why characters are no 6-bit form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SixBitError {
    /// A character that stands for nothing.
    #[error("character {at}: byte {byte} is no 6-bit character")]
    NoCharacter {
        /// Its position, from 0.
        at: usize,
        /// What it is.
        byte: u8,
    },
    /// One character too many, or bits after the last byte that are not 0.
    #[error("the characters do not make whole bytes")]
    Incomplete,
}

/// Characters that so many bytes take.
const fn six_bit_length(bytes: usize) -> usize {
    bytes / 3 * 4 + [0, 2, 3][bytes % 3]
}

/// Appends bytes in the 6-bit form.
pub fn write_six_bit(bytes: &[u8], out: &mut Vec<u8>) {
    out.reserve(six_bit_length(bytes.len()));
    for group in bytes.chunks(3) {
        let byte = |at: usize| u32::from(group.get(at).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        let characters = [18, 12, 6, 0].map(|shift| SIX_BIT_ZERO + (bits >> shift & 63) as u8);
        out.extend_from_slice(&characters[..=group.len()]);
    }
}

/// Appends the bytes that characters stand for.
///
/// # Errors
/// [`SixBitError`]; `out` is then as it was.
pub fn read_six_bit(characters: &[u8], out: &mut Vec<u8>) -> Result<(), SixBitError> {
    let before = out.len();
    out.reserve(characters.len() / 4 * 3 + 2);
    let (mut bits, mut count, mut at) = (0_u32, 0, 0);
    while let Some(&character) = characters.get(at) {
        if let Some(&[a, b, c, d]) = characters[at..].first_chunk::<4>().filter(|_| count == 0) {
            // Whole groups make up all but the end of a packet.
            let digits = [a, b, c, d].map(|character| u32::from(character.wrapping_sub(SIX_BIT_ZERO)));
            if digits.iter().all(|digit| *digit < 64) {
                let group = digits[0] << 18 | digits[1] << 12 | digits[2] << 6 | digits[3];
                out.extend_from_slice(&group.to_be_bytes()[1..]);
                at += 4;
                continue;
            }
        }
        let digit = match character.wrapping_sub(SIX_BIT_ZERO) {
            digit @ 0..64 => Some(u32::from(digit)),
            _ if character <= b' ' => None,
            _ => {
                out.truncate(before);
                return Err(SixBitError::NoCharacter { at, byte: character });
            }
        };
        at += 1;
        let Some(digit) = digit else { continue };
        bits = bits << 6 | digit;
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    // Whole bytes leave 0, 2 or 4 bits, all 0.
    if count == 6 || bits != 0 {
        out.truncate(before);
        return Err(SixBitError::Incomplete);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(characters: &[u8]) -> Result<Vec<u8>, SixBitError> {
        let mut out = b"kept".to_vec();
        let result = read_six_bit(characters, &mut out);
        assert!(out.starts_with(b"kept") && (result.is_ok() || out.len() == 4));
        result.map(|()| out.split_off(4))
    }

    #[test]
    fn known_bytes_have_known_characters() {
        // 0x4d616e is 010011 010110 000101 101110: 19, 22, 5, 46.
        let mut out = Vec::new();
        write_six_bit(b"Man", &mut out);
        assert_eq!(out, [19, 22, 5, 46].map(|digit| b'0' + digit));
        assert_eq!(read(b"oooo"), Ok(vec![255; 3]));
        assert_eq!(read(b"00"), Ok(vec![0]));
        assert_eq!(read(b""), Ok(vec![]));
    }

    #[test]
    fn lines_may_be_broken_anywhere() {
        assert_eq!(read(b" o\r\no o\to\0"), Ok(vec![255; 3]));
    }

    #[test]
    fn what_is_no_character_is_told() {
        assert_eq!(read(b"0p"), Err(SixBitError::NoCharacter { at: 1, byte: b'p' }));
        assert_eq!(read(b"/"), Err(SixBitError::NoCharacter { at: 0, byte: b'/' }));
        for incomplete in [&b"0"[..], b"00000", b"01", b"001", b"00000o"] {
            assert_eq!(read(incomplete), Err(SixBitError::Incomplete), "{incomplete:?}");
        }
    }

    proptest! {
        #[test]
        fn blanks_anywhere_change_nothing(
            bytes in prop::collection::vec(any::<u8>(), 0..40),
            blanks in prop::collection::vec((any::<prop::sample::Index>(), prop::sample::select(b"\r\n \0".to_vec())), 0..10)
        ) {
            let mut out = Vec::new();
            write_six_bit(&bytes, &mut out);
            for (place, blank) in blanks {
                out.insert(place.index(out.len() + 1), blank);
            }
            prop_assert_eq!(read(&out), Ok(bytes));
        }

        #[test]
        fn bytes_come_back_and_are_printable(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
            let mut out = Vec::new();
            write_six_bit(&bytes, &mut out);
            prop_assert_eq!(out.len(), six_bit_length(bytes.len()));
            prop_assert!(out.iter().all(u8::is_ascii_graphic));
            prop_assert_eq!(read(&out), Ok(bytes));
        }

        #[test]
        fn what_is_read_is_written_so(characters in prop::collection::vec(b'.'..=b'r', 0..20)) {
            if let Ok(bytes) = read(&characters) {
                let mut out = Vec::new();
                write_six_bit(&bytes, &mut out);
                prop_assert_eq!(out, characters);
            }
        }
    }
}
