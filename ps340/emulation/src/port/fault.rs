//! Faults of the machine: typed, with a number, a class and a text, as the operator and the host see them.

use protocol::{Kind, command::Input};

/// The reason why a function could not fire: what a behaviour returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// The message at this input has an unacceptable kind.
    Kind(u16),
    /// The messages do not go together, such as a 2D with a 3D vector. The last active input is blamed.
    Mismatch,
    /// The value at this input is out of range.
    Range(u16),
    /// Division by zero.
    DivisionByZero,
    /// A result that is too large or undefined.
    Overflow,
    /// Points or ranges that determine no result, such as AT and FROM in one place.
    Degenerate,
    /// A string longer than a message may be.
    TooLong,
}

/// A fault of the emulated machine, without the name of the object, which is known higher up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The type of the function, without `F:`.
    pub function: &'static str,
    /// What went wrong.
    pub cause: Cause,
}

/// What went wrong at a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A message of an unacceptable kind; it was removed.
    Kind {
        /// Where it arrived.
        input: u16,
        /// What it was.
        kind: Kind,
    },
    /// A value out of range.
    Range {
        /// Where it arrived.
        input: u16,
    },
    /// Division by zero.
    DivisionByZero,
    /// A result that is too large or undefined.
    Overflow,
    /// Points or ranges that determine no result.
    Degenerate,
    /// A string longer than a message may be.
    TooLong,
    /// More arcs leave an output than the machine keeps.
    TooManyArcs {
        /// Of which output.
        output: u16,
    },
    /// The function has no such input.
    NoSuchInput(Input),
    /// The function has no such output.
    NoSuchOutput(u16),
    /// The object is no function.
    NotAFunction,
    /// Messages were lost because a queue was full.
    Flood {
        /// Of which input.
        input: u16,
        /// How many were lost there in all.
        lost: u64,
    },
    /// A function of the user, which is code for another processor.
    UserCode,
    /// Outputs of a clock were left out because time advanced too far at once.
    Late {
        /// How many were left out.
        lost: u64,
    },
}

impl Fault {
    /// The number of the message.
    ///
    /// # Source
    /// Ours: the numbers of the machine's message file are not known.
    pub const fn number(&self) -> u16 {
        match self.cause {
            Cause::Kind { .. } => 5,
            Cause::Range { .. } => 6,
            Cause::DivisionByZero | Cause::Overflow | Cause::Degenerate => 7,
            Cause::TooLong | Cause::TooManyArcs { .. } => 8,
            Cause::NoSuchInput(_) | Cause::NoSuchOutput(_) | Cause::NotAFunction => 9,
            Cause::UserCode => 10,
            Cause::Flood { .. } | Cause::Late { .. } => 12,
        }
    }

    /// The class of the message: `E` error or `W` warning.
    pub const fn class(&self) -> char {
        match self.cause {
            Cause::NoSuchInput(_) | Cause::NoSuchOutput(_) | Cause::NotAFunction => 'W',
            Cause::Flood { .. } | Cause::Late { .. } => 'W',
            _ => 'E',
        }
    }

    /// The message as the machine shows it, such as `E 5 *** Bad message type at <1>DRX: 3D vector`.
    ///
    /// - `name`: the name of the object.
    pub fn text(&self, name: impl std::fmt::Display) -> String {
        let (class, number) = (self.class(), self.number());
        let what = match self.cause {
            Cause::Kind { input, kind } => format!("Bad message type at <{input}>{name}: {kind}"),
            Cause::Range { input } => format!("Value out of range at <{input}>{name}"),
            Cause::DivisionByZero => format!("Arithmetic error in {name}: division by zero"),
            Cause::Overflow => format!("Arithmetic error in {name}: result too large or undefined"),
            Cause::Degenerate => format!("Arithmetic error in {name}: no result for these points or limits"),
            Cause::TooLong => format!("Insufficient memory in {name}: string too long"),
            Cause::TooManyArcs { output } => format!("Insufficient memory: too many connections from {name}<{output}>"),
            Cause::NoSuchInput(input) => format!("No such input {input} of {name}"),
            Cause::NoSuchOutput(output) => format!("No such output <{output}> of {name}"),
            Cause::NotAFunction => format!("{name} is no function"),
            Cause::Flood { input, lost } => format!("Queue full at <{input}>{name}: {lost} messages lost"),
            Cause::UserCode => format!("{name}: functions of the user are code for another processor"),
            Cause::Late { lost } => format!("Clock {name} is late: {lost} outputs left out"),
        };
        format!("{class} {number} *** {what}")
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text(format_args!("F:{}", self.function)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_read_as_numbered_messages() {
        let fault = Fault { function: "XVECTOR", cause: Cause::Kind { input: 1, kind: Kind::Vector3 } };
        assert_eq!(fault.text("TVX"), "E 5 *** Bad message type at <1>TVX: 3D vector");
        assert_eq!(fault.to_string(), "E 5 *** Bad message type at <1>F:XVECTOR: 3D vector");
        let none = Fault { function: "ADD", cause: Cause::NoSuchInput(Input::Append) };
        assert_eq!(none.text("A"), "W 9 *** No such input <append> of A");
    }
}
