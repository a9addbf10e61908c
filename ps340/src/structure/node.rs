//! The kinds of node: data, operate, instance.

use crate::{matrices, port::ObjectId};
use glam::{DMat2, DMat3, DMat4, DVec3};
use protocol::command::{Boundaries, Characters, Operate, VectorList};

/// What one reference to a descendant takes.
pub(super) const MEMBER_BYTES: usize = size_of::<Member>();

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
    /// VECTOR_LIST.
    Vectors(Box<VectorList>),
    /// CHARACTERS.
    Characters(Box<Characters>),
    /// An operate node.
    Operate {
        /// What it does to the state.
        operation: Operation,
        /// Its descendant; inside a group, none applies it to the members that follow.
        descendant: Option<ObjectId>,
    },
}

/// A member of a group.
#[derive(Clone, Debug, PartialEq)]
pub enum Member {
    /// A node without a name.
    Unnamed(Node),
    /// A node that was named inside the structure, and belongs to it.
    Named(ObjectId),
    /// An object that INCLUDE added.
    Included(ObjectId),
}

/// What an operate node does to the state. Matrices are in the glam form of [`protocol::Value`].
#[derive(Clone, Debug, PartialEq)]
pub enum Operation {
    /// MATRIX_2X2: multiplies the character matrix.
    Character(DMat2),
    /// ROTATE, SCALE, MATRIX_3X3.
    Linear(DMat3),
    /// TRANSLATE.
    Translate(DVec3),
    /// LOOK, MATRIX_4X3.
    Affine(DMat4),
    /// WINDOW, FIELD_OF_VIEW, MATRIX_4X4.
    Projective(DMat4),
    /// VIEWPORT, relative to the enclosing one.
    Viewport {
        /// Left and right.
        horizontal: [f64; 2],
        /// Bottom and top.
        vertical: [f64; 2],
        /// Intensity at the back and at the front.
        intensity: Option<[f64; 2]>,
    },
    /// SET COLOR.
    Color {
        /// Degrees; 0 is blue.
        hue: f64,
        /// 0 white, 1 pure.
        saturation: f64,
    },
    /// SET INTENSITY.
    Intensity {
        /// OFF leaves the viewport's range in force.
        on: bool,
        /// At the back and at the front.
        range: [f64; 2],
    },
    /// SET DEPTH_CLIPPING.
    DepthClipping(bool),
    /// XFORM MATRIX.
    XformMatrix,
}

/// Front and back when a view does not give them: about what the manuals name, and what a client passed.
const DEFAULT_BOUNDARIES: Boundaries = Boundaries { front: 1e-15, back: 1e15 };

impl Operation {
    /// The operation of a command.
    ///
    /// # Errors
    /// A sentence that says what is degenerate (an empty window, an angle outside 0..180, a LOOK whose eye
    /// and centre coincide).
    pub fn new(operate: &Operate) -> Result<Operation, &'static str> {
        Ok(match *operate {
            Operate::Rotate { axis, angle } => Operation::Linear(matrices::rotation(axis, angle)),
            Operate::Scale(factors) => Operation::Linear(DMat3::from_diagonal(factors)),
            Operate::Translate(by) => Operation::Translate(by),
            Operate::Matrix2(m) => Operation::Character(m),
            Operate::Matrix3(m) => Operation::Linear(m),
            Operate::Matrix4x3(m) => Operation::Affine(m),
            Operate::Matrix4(m) => Operation::Projective(m),
            Operate::Look { at, from, up } => Operation::Affine(
                matrices::look(at, from, up.unwrap_or(at + DVec3::Y))
                    .ok_or("LOOK needs FROM and AT apart, and UP across the line of sight")?,
            ),
            Operate::Window { x, y, boundaries } => {
                let b = boundaries.unwrap_or(DEFAULT_BOUNDARIES);
                let window = matrices::window(x, y, [b.front, b.back]);
                Operation::Projective(window.ok_or("WINDOW needs three ranges that are not empty")?)
            }
            Operate::FieldOfView { angle, boundaries } => {
                let b = boundaries.unwrap_or(DEFAULT_BOUNDARIES);
                let view = matrices::field_of_view(angle, [b.front, b.back]);
                Operation::Projective(
                    view.ok_or("FIELD_OF_VIEW needs an angle between 0 and 180 and FRONT before BACK")?,
                )
            }
            Operate::Viewport { horizontal, vertical, intensity } => {
                Operation::Viewport { horizontal, vertical, intensity }
            }
            Operate::SetColor { hue, saturation } => Operation::Color { hue, saturation },
            Operate::SetIntensity { on, range } => Operation::Intensity { on, range },
            Operate::SetDepthClipping(on) => Operation::DepthClipping(on),
            Operate::XformMatrix => Operation::XformMatrix,
        })
    }
}

impl Node {
    /// The memory that grows with the user's data, in bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Node>()
            + match self {
                Node::Nil | Node::Operate { .. } => 0,
                Node::Instance(members) => members.len() * MEMBER_BYTES,
                Node::Group(members) => {
                    members.iter().map(|m| MEMBER_BYTES + if let Member::Unnamed(n) = m { n.bytes() } else { 0 }).sum()
                }
                Node::Vectors(list) => list.points.len() * size_of::<[f32; 4]>() + list.lines.len(),
                Node::Characters(characters) => characters.text.len(),
            }
    }

    /// The objects that were named inside this structure and belong to it.
    pub fn own_members(&self) -> Vec<ObjectId> {
        fn collect(members: &[Member], into: &mut Vec<ObjectId>) {
            for member in members {
                match member {
                    Member::Named(id) => into.push(*id),
                    Member::Unnamed(Node::Group(inner)) => collect(inner, into),
                    Member::Unnamed(_) | Member::Included(_) => {}
                }
            }
        }
        let mut own = Vec::new();
        if let Node::Group(members) = self {
            collect(members, &mut own);
        }
        own
    }
}
