//! What a script prints.

/// Most lines that are kept.
const MOST_LINES: usize = 10_000;
/// Most bytes of them.
const MOST_BYTES: usize = 4 << 20;

/// The lines that a script printed, as many as are worth reading.
#[derive(Default)]
pub(super) struct Printed {
    lines: Vec<String>,
    bytes: usize,
    left_out: u64,
}

impl Printed {
    /// One more line; left out once there are too many.
    pub(super) fn add(&mut self, text: &str) {
        self.bytes = self.bytes.saturating_add(text.len());
        if self.left_out > 0 || self.lines.len() == MOST_LINES || self.bytes > MOST_BYTES {
            self.left_out += 1;
        } else {
            self.lines.push(text.to_owned());
        }
    }

    /// The lines; the last one says how many were left out.
    pub(super) fn finish(mut self) -> Vec<String> {
        match self.left_out {
            0 => {}
            1 => self.lines.push("(1 more line was printed)".into()),
            count => self.lines.push(format!("({count} more lines were printed)")),
        }
        self.lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_counted() {
        let print = |count: usize, text: &str| {
            let mut printed = Printed::default();
            (0..count).for_each(|_| printed.add(text));
            printed.finish()
        };
        assert_eq!(print(2, "a"), ["a", "a"]);
        let many = print(10_003, "a");
        assert_eq!((many.len(), many[10_000].as_str()), (10_001, "(3 more lines were printed)"));
        let long = print(6, &"a".repeat(1 << 20));
        assert_eq!((long.len(), long[4].as_str()), (5, "(2 more lines were printed)"));
    }
}
