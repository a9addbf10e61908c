//! Numbers by which equal values are found.

use rustc_hash::FxHasher;
use std::fmt::{self, Debug, Write};
use std::hash::Hasher;

/// A number that values with the same text for programmers have in common, and others hardly ever: values that hold
/// floating-point numbers are sorted by it before they are compared.
pub fn debug_hash(value: &impl Debug) -> u64 {
    struct Hashed(FxHasher);
    impl Write for Hashed {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.write(text.as_bytes());
            Ok(())
        }
    }
    let mut hashed = Hashed(FxHasher::default());
    // Hashing cannot fail.
    let _ = write!(hashed, "{value:?}");
    hashed.0.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_have_one_number_and_others_have_others() {
        assert_eq!(debug_hash(&[0.1, 0.2]), debug_hash(&[0.1, 0.2]));
        assert_ne!(debug_hash(&[0.1, 0.2]), debug_hash(&[0.1, 0.200_000_000_000_000_04]));
    }
}
