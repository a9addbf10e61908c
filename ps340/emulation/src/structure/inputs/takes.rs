//! The inputs that a node has, and the kinds of message that it takes there: what arcs are checked against, and what
//! messages say. Tests hold it to what the nodes do.

use crate::{
    port::KindSet,
    structure::{
        Node, Operation,
        value::{FIRST, POSITION, SECOND, THIRD},
    },
};
use protocol::command::Input;

impl Node {
    /// The kinds that an input takes; none if the node has no such input.
    pub fn takes(&self, input: Input) -> Option<KindSet> {
        let kinds = match self {
            Node::Operate { operation, .. } => operation.takes(input),
            Node::Vectors(_) => vectors(input),
            Node::Characters(_) => match input {
                Input::Position => POSITION,
                Input::Step => KindSet::VECTOR2,
                Input::Clear => KindSet::ANY,
                Input::Delete => KindSet::INTEGER,
                Input::Substitute | Input::Append | Input::Last | Input::Number(_) => KindSet::STRING,
            },
            Node::Labels(_) => labels(input),
            Node::Illumination(_) => match input {
                FIRST | SECOND => KindSet::VECTOR3,
                THIRD => KindSet::NUMBER,
                _ => KindSet::NONE,
            },
            Node::Variable(_) if input == FIRST => KindSet::ANY,
            _ => KindSet::NONE,
        };
        Some(kinds).filter(|kinds| *kinds != KindSet::NONE)
    }

    /// The inputs in words, such as `<1>, <2>`; `no inputs` if there are none.
    pub fn inputs(&self) -> String {
        // The first input past those that the node has; lists have one for each element.
        let end = (1..=FOURTH_AND_ONE).find(|n| self.takes(Input::Number(*n)).is_none());
        let mut all: Vec<String> = match end {
            Some(end) => (1..end).map(|n| format!("<{n}>")).collect(),
            None => vec!["<1> and up".into()],
        };
        let words = Input::WORDS.iter().filter(|row| self.takes(row.0).is_some());
        all.extend(words.map(|row| row.0.to_string()));
        if all.is_empty() { "no inputs".into() } else { all.join(", ") }
    }

    /// Whether the node sends messages, from output 1.
    pub fn has_output(&self) -> bool {
        self.operation().is_some_and(Operation::has_output)
    }
}

/// One more than the most inputs of a node that has not as many as elements.
const FOURTH_AND_ONE: u32 = 5;

fn vectors(input: Input) -> KindSet {
    match input {
        Input::Append => KindSet::VECTOR,
        Input::Delete => KindSet::INTEGER,
        Input::Clear => KindSet::ANY,
        Input::Number(_) | Input::Last => KindSet::VECTOR.or(KindSet::BOOLEAN),
        Input::Step | Input::Position | Input::Substitute => KindSet::NONE,
    }
}

fn labels(input: Input) -> KindSet {
    let element = KindSet::LABEL.or(KindSet::STRING).or(POSITION);
    match input {
        Input::Step => KindSet::VECTOR2,
        Input::Clear => KindSet::ANY,
        Input::Delete => KindSet::INTEGER,
        Input::Append => element,
        Input::Number(_) | Input::Last => element.or(KindSet::BOOLEAN),
        Input::Position | Input::Substitute => KindSet::NONE,
    }
}
