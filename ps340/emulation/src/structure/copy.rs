//! COPY: some elements of a node as a new node.

use super::{Labels, Node};
use protocol::command::{Characters, VectorClass, VectorList};

/// The reason why nothing was copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CopyFault {
    /// Only vectors, characters and labels have elements that can be copied.
    #[error("only vectors, characters and labels can be copied")]
    Kind,
    /// The range is not all there.
    #[error("there are {0} elements")]
    Range(usize),
}

/// The node that has `count` elements of `node` from element `start` (1 and up).
///
/// The first vector of a copy is a position, as that of every list. A text stays where its source begins; a
/// pattern does not go along. Ours.
///
/// # Errors
/// [`CopyFault`].
pub fn copy(node: &Node, start: u32, count: u32) -> Result<Node, CopyFault> {
    let range = |len: usize| {
        let start = (start as usize).checked_sub(1);
        let end = start.and_then(|start| start.checked_add(count as usize));
        start.zip(end).filter(|(_, end)| *end <= len).map(|(start, end)| start..end).ok_or(CopyFault::Range(len))
    };
    match node {
        Node::Vectors(vectors) => {
            let list = &vectors.list;
            let range = range(list.points.len())?;
            let whole = list.class != VectorClass::Separate || range.start.is_multiple_of(2);
            let class = if whole { list.class } else { VectorClass::Itemized };
            let lines = if class == VectorClass::Itemized {
                range.clone().map(|i| i > range.start && list.is_line(i)).collect()
            } else {
                Vec::new()
            };
            let points = list.points[range].to_vec();
            Ok(Node::Vectors(Box::new(VectorList { class, points, lines, estimate: None, ..*list }.into())))
        }
        Node::Characters(source) => {
            let text = source.text[range(source.text.len())?].into();
            Ok(Node::Characters(Box::new(Characters { text, ..**source })))
        }
        Node::Labels(source) => {
            let labels = source.labels[range(source.labels.len())?].to_vec();
            Ok(Node::Labels(Box::new(Labels { labels, step: source.step })))
        }
        _ => Err(CopyFault::Kind),
    }
}
