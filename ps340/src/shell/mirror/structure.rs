//! The display structure as a window shows it: a tree of lines.

use crate::{
    machine::Machine,
    port::ObjectId,
    structure::{Member, Node},
};

/// Nodes that are shown; of more, the first.
const MAX_NODES: usize = 1_000;
/// Levels that are shown.
const MAX_LEVELS: usize = 64;

/// A node of the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeShown {
    /// Levels above it.
    pub level: usize,
    /// What it is, such as `ROT := ROTATE ... APPLIED TO CUBE`.
    pub text: String,
}

/// What is displayed, and everything below it. A node that is met again is shown again, but not within itself.
pub(super) fn tree(machine: &Machine) -> Vec<NodeShown> {
    let mut lines = Vec::new();
    // What is to be shown, the next one last; with the nodes above it.
    let mut open: Vec<(ObjectId, Vec<ObjectId>)> =
        machine.memory().structures.displayed().map(|id| (id, Vec::new())).collect();
    open.reverse();
    while let Some((id, above)) = open.pop() {
        if lines.len() == MAX_NODES {
            lines.push(NodeShown { level: 0, text: format!("... more than {MAX_NODES} nodes") });
            break;
        }
        let again = above.contains(&id);
        let text = machine.describe_object(id);
        lines.push(NodeShown { level: above.len(), text: if again { format!("{text} (again)") } else { text } });
        if again || above.len() >= MAX_LEVELS {
            continue;
        }
        let path: Vec<ObjectId> = above.iter().copied().chain([id]).collect();
        let mut below = children(machine, id);
        below.reverse();
        open.extend(below.into_iter().map(|child| (child, path.clone())));
    }
    lines
}

/// The nodes below a node that have an object of their own.
fn children(machine: &Machine, id: ObjectId) -> Vec<ObjectId> {
    let structures = &machine.memory().structures;
    match structures.node(structures.follow(id)) {
        Some(Node::Instance(members)) => members.clone(),
        Some(Node::Operate { descendant, .. }) => descendant.iter().copied().collect(),
        Some(Node::Group(members)) => members
            .iter()
            .filter_map(|member| match member {
                Member::Named(id) | Member::Included(id) => Some(*id),
                Member::Unnamed(_) => None,
            })
            .collect(),
        _ => Vec::new(),
    }
}
