//! Arcs and inputs of function networks.

use crate::Name;

/// One arc of a function network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arc {
    /// The function that sends.
    pub source: Name,
    /// Its output, 1 and up.
    pub output: u16,
    /// Where the messages go.
    pub destination: Destination,
}

/// An input of a named object: `<i>name`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// The input.
    pub input: Input,
    /// Of what.
    pub name: Name,
}

/// An input of a function or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// `<1>`, `<2>`, ... For the data nodes, the index of an element.
    Number(u32),
    /// `<append>`, 0 in the library of the time.
    Append,
    /// `<delete>`, -1.
    Delete,
    /// `<clear>`, -2.
    Clear,
    /// `<step>`, -3.
    Step,
    /// `<position>`, -4.
    Position,
    /// `<last>`, -5.
    Last,
    /// `<substitute>`, -6.
    Substitute,
}

impl Input {
    /// The inputs that have a word, with that word.
    pub const WORDS: [(Input, &str); 7] = [
        (Input::Append, "append"),
        (Input::Delete, "delete"),
        (Input::Clear, "clear"),
        (Input::Step, "step"),
        (Input::Position, "position"),
        (Input::Last, "last"),
        (Input::Substitute, "substitute"),
    ];

    /// The input number of the library of the time: 0 for append, -1 for delete, and so on. \[S\]
    pub const fn code(self) -> i64 {
        match self {
            Input::Number(n) => n as i64,
            Input::Append => 0,
            Input::Delete => -1,
            Input::Clear => -2,
            Input::Step => -3,
            Input::Position => -4,
            Input::Last => -5,
            Input::Substitute => -6,
        }
    }

    /// The input with a [`code`](Self::code).
    pub fn from_code(code: i64) -> Option<Input> {
        match code {
            1.. => u32::try_from(code).ok().map(Input::Number),
            _ => Input::WORDS.iter().map(|w| w.0).find(|i| i.code() == code),
        }
    }
}

impl std::fmt::Display for Input {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Input::Number(n) => write!(f, "<{n}>"),
            word => {
                let text = Input::WORDS.iter().find(|w| w.0 == *word).map_or("", |w| w.1);
                write!(f, "<{text}>")
            }
        }
    }
}
