//! Lines of a rendering as members of a structure.

use super::Segment;
use crate::structure::{Member, Node, Operation};
use protocol::command::{Fourth, VectorClass, VectorList};

/// Lines as members of a structure: a vector list for each colour, in the order in which the colours come first, with
/// SET COLOR before it unless it is in the colour `at_node` that is in force anyway.
pub fn members(mut segments: Vec<Segment>, at_node: [f64; 2]) -> Vec<Member> {
    let mut members = Vec::new();
    // Those in the colour of the node come before a SET COLOR would hold for them.
    let mut next = Some(at_node);
    while let Some(color) = next {
        let (now, later): (Vec<Segment>, Vec<Segment>) = segments.into_iter().partition(|s| s.color == color);
        if color != at_node {
            let operation = Operation::Color { hue: color[0], saturation: color[1] };
            members.push(Member::Unnamed(Node::operate(operation, None)));
        }
        if !now.is_empty() {
            members.push(Member::Unnamed(list(&now)));
        }
        next = later.first().map(|segment| segment.color);
        segments = later;
    }
    members
}

fn list(segments: &[Segment]) -> Node {
    let points = segments.iter().flat_map(|segment| segment.ends);
    let list = VectorList {
        block_normalized: false,
        class: VectorClass::Separate,
        dimension: 3,
        estimate: None,
        fourth: Fourth::Intensity,
        internal_units: false,
        points: points.map(|p| [p.x as f32, p.y as f32, p.z as f32, 1.0]).collect(),
        lines: Vec::new(),
    };
    Node::Vectors(Box::new(list.into()))
}
