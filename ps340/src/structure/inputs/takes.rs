//! Which inputs a node has, and which kinds of message it takes there: what arcs are checked against, and what messages
//! say. Tests hold it to what the nodes do.

use super::value::{FIRST, FOURTH, SECOND, THIRD};
use crate::{
    port::KindSet,
    structure::{Node, Operation},
};
use protocol::{Kind, command::Input};

const PLACE: KindSet = KindSet::VECTOR2.or(KindSet::VECTOR3);
const MATRIX2: KindSet = KindSet::of(&[Kind::Matrix2]);
const MATRIX3: KindSet = KindSet::of(&[Kind::Matrix3]);

impl Node {
    /// The kinds that an input takes; none if the node has no such input.
    pub fn takes(&self, input: Input) -> Option<KindSet> {
        let kinds = match self {
            Node::Operate { operation, .. } => operation.takes(input),
            Node::Vectors(_) => vectors(input),
            Node::Characters(_) => match input {
                Input::Position => PLACE,
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
        let Node::Operate { operation, .. } = self else { return false };
        matches!(operation, Operation::Rendering { .. } | Operation::WriteBack)
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
    let element = KindSet::LABEL.or(KindSet::STRING).or(PLACE);
    match input {
        Input::Step => KindSet::VECTOR2,
        Input::Clear => KindSet::ANY,
        Input::Delete => KindSet::INTEGER,
        Input::Append => element,
        Input::Number(_) | Input::Last => element.or(KindSet::BOOLEAN),
        Input::Position | Input::Substitute => KindSet::NONE,
    }
}

impl Operation {
    fn takes(&self, input: Input) -> KindSet {
        match (input, self) {
            (FIRST, operation) => operation.takes_first(),
            (SECOND, Operation::Color { .. }) => KindSet::NUMBER,
            (SECOND, Operation::PickLocation { .. }) => PLACE,
            (SECOND, Operation::Rendering { .. }) | (THIRD, Operation::Rate { .. }) => KindSet::BOOLEAN,
            (SECOND | FOURTH, Operation::Rate { .. }) => KindSet::INTEGER,
            _ => KindSet::NONE,
        }
    }

    fn takes_first(&self) -> KindSet {
        match self {
            Operation::Character(_) => MATRIX2,
            Operation::Linear(_) => MATRIX3,
            Operation::Affine(_) => KindSet::of(&[Kind::Matrix4x3]),
            Operation::Projective(_) => KindSet::of(&[Kind::Matrix4]),
            Operation::Translate(_) | Operation::PickLocation { .. } => PLACE,
            Operation::Viewport { .. } | Operation::LoadViewport { .. } => MATRIX2.or(MATRIX3),
            Operation::TextSize(_) => MATRIX2.or(KindSet::NUMBER),
            Operation::Color { .. } => KindSet::VECTOR2.or(KindSet::NUMBER),
            Operation::ColorBlending(_) | Operation::Contrast(_) => KindSet::NUMBER,
            Operation::Intensity { .. } => KindSet::BOOLEAN.or(KindSet::VECTOR2),
            Operation::DepthClipping(_)
            | Operation::Csm(_)
            | Operation::Picking(_)
            | Operation::ExternalRate(_)
            | Operation::Blinking(_)
            | Operation::Plotter(_)
            | Operation::Displays { .. }
            | Operation::ConditionalBit { .. }
            | Operation::WriteBack => KindSet::BOOLEAN,
            Operation::LevelOfDetail(_)
            | Operation::IfLevel { .. }
            | Operation::Rate { .. }
            | Operation::BlinkRate(_)
            | Operation::Priority(_)
            | Operation::LineTexture { .. } => KindSet::INTEGER,
            Operation::Rendering { .. } => KindSet::INTEGER.or(KindSet::BOOLEAN).or(KindSet::STRING),
            Operation::XformMatrix
            | Operation::XformVector
            | Operation::CancelXform
            | Operation::Font(_)
            | Operation::Orientation(_)
            | Operation::PickIdentifier(_)
            | Operation::ChangeLevelOfDetail(_)
            | Operation::IfBit { .. }
            | Operation::IfPhase(_)
            | Operation::SectioningPlane => KindSet::NONE,
        }
    }
}
