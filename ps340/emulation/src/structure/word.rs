//! The words of the command language for nodes, for messages and descriptions.

use super::Node;

impl Node {
    /// The command that makes such a node.
    pub fn word(&self) -> &'static str {
        match self {
            Node::Nil => "NIL",
            Node::Instance(_) => "INSTANCE OF",
            Node::Group(_) => "BEGIN_STRUCTURE",
            Node::Vectors(_) => "VECTOR_LIST",
            Node::Characters(_) => "CHARACTERS",
            Node::Operate { operation, .. } => operation.word(),
            Node::Polygons(_) => "POLYGON",
            Node::Labels(_) => "LABELS",
            Node::Illumination(_) => "ILLUMINATION",
            Node::Attributes(_) => "ATTRIBUTES",
            Node::Font(_) => "BEGIN_FONT",
            Node::Pattern(_) => "PATTERN",
            Node::RawBlock(_) => "RAWBLOCK",
            Node::Variable(_) => "VARIABLE",
        }
    }
}
