//! The word that was meant: the distance between spellings.

/// Longest word that is compared, in bytes; words of the language are shorter.
const LONGEST: usize = 40;

/// How many edits (a character more, less or another, or two neighbours swapped) make one word of the other; case does
/// not count. None if a word is longer than 40 bytes.
///
/// # Source
/// The optimal string alignment distance: Damerau 1964, computed as Wagner and Fischer 1974.
pub fn distance(a: &[u8], b: &[u8]) -> Option<usize> {
    if a.len() > LONGEST || b.len() > LONGEST {
        return None;
    }
    let same = |x: u8, y: u8| x.eq_ignore_ascii_case(&y);
    let mut two_before = [0; LONGEST + 1];
    let mut before: [usize; LONGEST + 1] = std::array::from_fn(|j| j);
    for (i, &x) in a.iter().enumerate() {
        let mut row = [i + 1; LONGEST + 1];
        for (j, &y) in b.iter().enumerate() {
            let other = before[j] + usize::from(!same(x, y));
            row[j + 1] = other.min(before[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && same(x, b[j - 1]) && same(a[i - 1], y) {
                row[j + 1] = row[j + 1].min(two_before[j - 1] + 1);
            }
        }
        two_before = before;
        before = row;
    }
    Some(before[b.len()])
}

/// The word that `text` is probably meant to be: the nearest, if it is near enough for a slip of a hand; the first of
/// several that are equally near.
///
/// ```
/// use protocol::command::spelling::nearest;
/// assert_eq!(nearest("ROATE", ["ROTATE", "ROUTE"]), Some("ROTATE"));
/// assert_eq!(nearest("X", ["ROTATE", "Y"]), None);
/// ```
pub fn nearest<'w>(text: &str, words: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    let near = words.into_iter().filter_map(|word| Some((edits(text.as_bytes(), word.as_bytes())?, word)));
    near.min_by_key(|(edits, _)| *edits).map(|(_, word)| word)
}

/// The distance, if it is small enough for a slip: one edit in up to four characters, two in up to eight, else three.
pub(super) fn edits(text: &[u8], word: &[u8]) -> Option<usize> {
    let allowed = match text.len() {
        0 | 1 => return None,
        2..=4 => 1,
        5..=8 => 2,
        _ => 3,
    };
    if text.len().abs_diff(word.len()) > allowed {
        return None;
    }
    distance(text, word).filter(|edits| *edits <= allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_slip_is_one_edit() {
        for text in ["ROTATES", "RTATE", "ROTAGE", "ORTATE", "rotatE_"] {
            assert_eq!(distance(text.as_bytes(), b"ROTATE"), Some(1), "{text}");
        }
        assert_eq!(distance(b"", b"ABC"), Some(3));
        assert_eq!(distance(b"AbC", b"aBc"), Some(0));
        assert_eq!(distance(&[b'A'; 41], b"A"), None);
    }

    #[test]
    fn the_nearest_word_is_found_and_far_words_are_not() {
        let words = ["VECTOR_LIST", "VIEWPORT", "ROTATE", "ON"];
        assert_eq!(nearest("vetcor_list", words), Some("VECTOR_LIST"));
        assert_eq!(nearest("VEIWPROT", words), Some("VIEWPORT"));
        assert_eq!(nearest("OM", words), Some("ON"));
        assert_eq!(nearest("PICTURE", words), None);
        assert_eq!(nearest("", words), None);
    }
}
