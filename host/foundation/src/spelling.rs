//! What somebody may have meant who wrote a name that is not known.

/// Most names that are offered.
const MOST: usize = 4;

/// What to say of a name that is not known: what it may have meant, or else the names that there are.
///
/// ```
/// assert_eq!(foundation::spelling::advice("coper", &["copper", "gold"]), "did you mean copper?");
/// assert_eq!(foundation::spelling::advice("steel", &["stainless_steel", "gold"]), "did you mean stainless_steel?");
/// assert_eq!(foundation::spelling::advice("jade", &["copper", "gold"]), "there are copper, gold");
/// ```
pub fn advice(name: &str, known: &[&str]) -> String {
    question(name, known).unwrap_or_else(|| match known {
        [] => "there are none".into(),
        known => format!("there are {}", known.join(", ")),
    })
}

/// Whether this or that was meant, as a question; none if nothing is near.
pub fn question(name: &str, known: &[&str]) -> Option<String> {
    match meant(name, known)[..] {
        [] => None,
        [one] => Some(format!("did you mean {one}?")),
        [ref others @ .., last] => Some(format!("did you mean {} or {last}?", others.join(", "))),
    }
}

/// The known names that are nearest to one by the letters to be changed, or that have it as one of their words; at most a
/// few.
fn meant<'a>(name: &str, known: &[&'a str]) -> Vec<&'a str> {
    let plain = |name: &str| name.to_lowercase().replace([' ', '-'], "_");
    let name = plain(name);
    let allowed = match name.chars().count() {
        0..=2 => 0,
        count => 1.max((count + 1) / 4),
    };
    let near = known.iter().map(|known| (distance(&name, &plain(known)), *known));
    let mut near: Vec<(usize, &str)> = near.filter(|(d, _)| *d <= allowed).collect();
    near.sort_unstable();
    let nearest = near.first().map(|(d, _)| *d);
    let mut meant: Vec<&str> =
        near.into_iter().take_while(|(d, _)| Some(*d) == nearest).map(|(_, known)| known).collect();
    if meant.is_empty() {
        let has_word = |known: &&&str| plain(known).split('_').any(|word| word == name);
        meant = known.iter().filter(has_word).copied().collect();
    }
    meant.truncate(MOST);
    meant
}

/// Number of letters to insert, delete, replace or exchange with the next one to get from one word to the other.
///
/// # Source
/// Damerau 1964 and Levenshtein 1966, in the form in which no letter is changed twice.
fn distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|word| word.chars().take(64).collect::<Vec<char>>());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    rows[0] = (0..=b.len()).collect();
    for i in 1..=a.len() {
        rows[i][0] = i;
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = least;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_meant_is_near_or_has_the_word() {
        let known = ["copper", "brass", "red_brass", "lead", "oak_leaf", "green_leaf", "BK7", "grey_brick"];
        assert_eq!(meant("coper", &known), ["copper"]);
        assert_eq!(meant("bk7", &known), ["BK7"]);
        assert_eq!(meant("Red Brass", &known), ["red_brass"]);
        assert_eq!(meant("leaf", &known), ["lead"]);
        assert_eq!(meant("oak", &known), ["oak_leaf"]);
        assert_eq!(meant("teak", &known), [""; 0]);
        assert_eq!(meant("", &known), [""; 0]);
        assert_eq!(advice("bras", &known), "did you mean brass?");
        assert_eq!(advice("brick", &known), "did you mean grey_brick?");
        assert!(advice("zzz", &known).starts_with("there are copper, brass"));
    }
}
