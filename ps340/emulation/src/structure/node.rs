//! The kinds of node: data, operate, instance.

use super::Operation;
use crate::port::ObjectId;
use glam::DVec2;
use protocol::{
    Value,
    command::{Attributes, Characters, FontCharacter, Illumination, LabelText, Pattern, Polygon, VectorList},
};
use std::collections::BTreeMap;

/// What a node takes in the account of the mass memory, in bytes, and what one reference to a descendant: fixed, so
/// that what the machine says of its memory does not change with what a compiler makes of the types here. Ours.
const NODE_BYTES: usize = 144;
pub(super) const MEMBER_BYTES: usize = NODE_BYTES;
const _: () = assert!(size_of::<Node>().abs_diff(NODE_BYTES) <= 16 && size_of::<Member>() == size_of::<Node>());

/// A node of the display structure.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// `NIL`: draws nothing.
    Nil,
    /// INSTANCE OF: descendants, visited in order, each with the state that the instance was entered with.
    Instance(Vec<ObjectId>),
    /// BEGIN_STRUCTURE ... END_STRUCTURE: an operate node without a descendant of its own applies to all
    /// members after it.
    Group(Vec<Member>),
    /// VECTOR_LIST, and the curves, which become lists when they are defined.
    Vectors(Box<Vectors>),
    /// CHARACTERS.
    Characters(Box<Characters>),
    /// An operate node.
    Operate {
        /// What it does to the state.
        operation: Operation,
        /// Its descendant; inside a group, none applies it to the members that follow.
        descendant: Option<ObjectId>,
        /// Of a rendering node, its last rendering in vectors.
        rendered: Option<Box<Rendered>>,
    },
    /// POLYGON.
    Polygons(Box<Polygons>),
    /// LABELS.
    Labels(Box<Labels>),
    /// ILLUMINATION.
    Illumination(Illumination),
    /// ATTRIBUTES: not displayable, polygons refer to it.
    Attributes(Attributes),
    /// BEGIN_FONT ... END_FONT: not displayable. The characters that are defined, by code.
    Font(Box<BTreeMap<u8, FontCharacter>>),
    /// PATTERN: not displayable.
    Pattern(Pattern),
    /// RAWBLOCK: bytes that a host manages.
    RawBlock(Vec<u8>),
    /// VARIABLE: the value, once something was stored.
    Variable(Option<Value>),
}

/// A rendering in vectors, which stands for the original below its node while it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The vectors, with SET COLOR where they are not in the colour that the node has.
    pub members: Vec<Member>,
    /// Whether it is shown.
    pub shown: bool,
}

/// Vectors as they were given, and as they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// The vectors.
    pub list: VectorList,
    /// Values of the parameter of a curve at its first and last point.
    pub parameters: Option<[f64; 2]>,
    /// The vectors in dashes, while a pattern is applied, and that pattern.
    pub dashed: Option<(Pattern, VectorList)>,
}

impl Vectors {
    /// What is drawn.
    pub fn drawn(&self) -> &VectorList {
        self.dashed.as_ref().map_or(&self.list, |dashed| &dashed.1)
    }
}

impl From<VectorList> for Vectors {
    fn from(list: VectorList) -> Vectors {
        Vectors { list, parameters: None, dashed: None }
    }
}

/// Polygons with what they refer to.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygons {
    /// The polygons as given.
    pub polygons: Vec<Polygon>,
    /// The ATTRIBUTES object of each, if any was named for it or before it.
    pub attributes: Vec<Option<ObjectId>>,
}

/// Many texts with one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// Each text, and whether it is shown.
    pub labels: Vec<(LabelText, bool)>,
    /// Advance from cell to cell, in cells; default (1, 0).
    pub step: DVec2,
}

/// A member of a group.
#[derive(Clone, Debug, PartialEq)]
pub enum Member {
    /// A node without a name.
    Unnamed(Node),
    /// An object that belongs to the structure: a node that was named inside it, or an anonymous one (a structure
    /// without a name, a node of PREFIX or FOLLOW).
    Named(ObjectId),
    /// An object that INCLUDE added.
    Included(ObjectId),
}

impl Member {
    /// The memory that it takes, in bytes, without that of objects of their own.
    pub fn bytes(&self) -> usize {
        MEMBER_BYTES + if let Member::Unnamed(node) = self { node.bytes() } else { 0 }
    }
}

impl Rendered {
    /// The memory that it takes, in bytes.
    pub fn bytes(&self) -> usize {
        self.members.iter().map(Member::bytes).sum()
    }
}

impl Node {
    /// An operate node.
    ///
    /// - `descendant`: what it applies to; inside a group, none applies it to the members that follow.
    pub fn operate(operation: Operation, descendant: Option<ObjectId>) -> Node {
        Node::Operate { operation, descendant, rendered: None }
    }

    /// What an operate node does; none for another kind of node.
    pub fn operation(&self) -> Option<&Operation> {
        if let Node::Operate { operation, .. } = self { Some(operation) } else { None }
    }

    /// The memory that grows with the user's data, in bytes.
    pub fn bytes(&self) -> usize {
        NODE_BYTES
            + match self {
                Node::Operate { rendered: Some(rendered), .. } => rendered.bytes(),
                Node::Nil | Node::Operate { .. } | Node::Illumination(_) | Node::Attributes(_) => 0,
                Node::Polygons(p) => {
                    p.polygons.iter().map(|p| size_of::<Polygon>() + size_of_val(p.vertices.as_slice())).sum()
                }
                Node::Labels(l) => l.labels.iter().map(|(l, _)| size_of::<LabelText>() + l.text.len()).sum(),
                Node::Font(font) => {
                    font.values().map(|c| size_of::<FontCharacter>() + size_of_val(c.points.as_slice())).sum()
                }
                Node::Pattern(pattern) => size_of_val(pattern.segments.as_slice()),
                Node::RawBlock(bytes) => bytes.len(),
                Node::Variable(Some(Value::String(text))) => text.len(),
                Node::Variable(_) => 0,
                Node::Instance(members) => members.len() * MEMBER_BYTES,
                Node::Group(members) => members.iter().map(Member::bytes).sum(),
                Node::Vectors(vectors) => {
                    let dashed = vectors.dashed.iter().map(|dashed| &dashed.1);
                    let bytes = |l: &VectorList| l.points.len() * size_of::<[f32; 4]>() + l.lines.len();
                    dashed.chain([&vectors.list]).map(bytes).sum()
                }
                Node::Characters(characters) => characters.text.len(),
            }
    }

    /// The objects that were made inside this structure and belong to it.
    pub fn own_members(&self) -> Vec<ObjectId> {
        let Node::Group(members) = self else { return Vec::new() };
        let own = members.iter().filter_map(|m| if let Member::Named(id) = m { Some(*id) } else { None });
        own.collect()
    }

    /// Clears references to objects that have gone: instances and structures no longer contain them, and what needs a
    /// descendant has [`ObjectId::NOTHING`].
    pub fn forget(&mut self, is_gone: &impl Fn(ObjectId) -> bool) {
        let clear = |reference: &mut Option<ObjectId>| {
            if reference.is_some_and(is_gone) {
                *reference = Some(ObjectId::NOTHING);
            }
        };
        match self {
            Node::Instance(members) => members.retain(|id| !is_gone(*id)),
            Node::Group(members) => forget_members(members, is_gone),
            Node::Operate { operation, descendant, rendered } => {
                clear(descendant);
                operation.forget(is_gone);
                if let Some(rendered) = rendered {
                    forget_members(&mut rendered.members, is_gone);
                }
            }
            Node::Polygons(polygons) => polygons.attributes.iter_mut().for_each(clear),
            _ => {}
        }
    }
}

fn forget_members(members: &mut Vec<Member>, is_gone: &impl Fn(ObjectId) -> bool) {
    members.retain_mut(|member| match member {
        Member::Named(id) | Member::Included(id) => !is_gone(*id),
        // A structure inside a structure is an object of its own, so that this goes one deep.
        Member::Unnamed(node) => {
            node.forget(is_gone);
            true
        }
    });
}
