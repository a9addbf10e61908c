//! The words of an operator command, taken one by one.

use super::OperatorCommandError;

/// What is left of the line.
pub(super) struct WordReader<'a> {
    pub(super) rest: &'a str,
}

impl<'a> WordReader<'a> {
    pub(super) fn next(&mut self) -> Option<&'a str> {
        let (word, rest) = self.rest.split_once(char::is_whitespace).unwrap_or((self.rest, ""));
        self.rest = rest.trim_start();
        (!word.is_empty()).then_some(word)
    }

    pub(super) fn required(&mut self, what: &'static str) -> Result<&'a str, OperatorCommandError> {
        self.next().ok_or(OperatorCommandError::Missing(what))
    }

    pub(super) fn optional<T: std::str::FromStr>(
        &mut self,
        expected: &'static str,
    ) -> Result<Option<T>, OperatorCommandError> {
        let word = self.next();
        word.map(|w| w.parse().map_err(|_| OperatorCommandError::Bad { found: w.into(), expected })).transpose()
    }

    pub(super) fn integer<T: std::str::FromStr + PartialOrd>(
        &mut self,
        low: T,
        high: T,
        expected: &'static str,
    ) -> Result<T, OperatorCommandError> {
        let word = self.required(expected)?;
        let read = word.parse().ok().filter(|n| (low..=high).contains(n));
        read.ok_or_else(|| OperatorCommandError::Bad { found: word.into(), expected })
    }

    pub(super) fn real(&mut self, low: f64, high: f64, expected: &'static str) -> Result<f64, OperatorCommandError> {
        let word = self.required(expected)?;
        let read = word.parse().ok().filter(|x| (low..=high).contains(x));
        read.ok_or_else(|| OperatorCommandError::Bad { found: word.into(), expected })
    }

    /// The next word: `on`, or nothing for it, or `off`.
    pub(super) fn on_or_off(&mut self) -> Result<bool, OperatorCommandError> {
        match self.next() {
            None | Some("on") => Ok(true),
            Some("off") => Ok(false),
            Some(other) => Err(OperatorCommandError::Bad { found: other.into(), expected: "'on' or 'off'" }),
        }
    }
}
