//! The kinds of node: data, operate, instance.

use crate::{matrices, port::ObjectId};
use glam::{DMat2, DMat3, DMat4, DVec2, DVec3};
use protocol::{
    Name, Value,
    command::{
        Attributes, Boundaries, CharacterOrientation, Characters, Comparison, FontCharacter, Illumination, Label,
        Operate, Pattern, Polygon, Rate, VectorList,
    },
};
use std::collections::BTreeMap;

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

/// Vectors as they were given, and as they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// The vectors.
    pub list: VectorList,
    /// Values of the parameter of a curve at its first and last point.
    pub parameters: Option<[f64; 2]>,
    /// The same in dashes, while a pattern is applied, and that pattern.
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
    pub labels: Vec<(Label, bool)>,
    /// Advance from cell to cell, in cells; default (1, 0).
    pub step: DVec2,
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
    /// XFORM VECTOR.
    XformVector,
    /// CANCEL XFORM.
    CancelXform,
    /// WRITEBACK.
    WriteBack,
    /// LOAD VIEWPORT: replaces the enclosing one.
    LoadViewport {
        /// Left and right on the screen.
        horizontal: [f64; 2],
        /// Bottom and top.
        vertical: [f64; 2],
        /// Intensity at the back and at the front.
        intensity: Option<[f64; 2]>,
    },
    /// TEXT SIZE: replaces the character matrix.
    TextSize(f64),
    /// CHARACTER FONT; none for STANDARD FONT.
    Font(Option<ObjectId>),
    /// SET COLOR BLENDING: saturation of blended lists.
    ColorBlending(f64),
    /// SET CONTRAST, 0..=1.
    Contrast(f64),
    /// SET CSM.
    Csm(bool),
    /// SET DISPLAYS.
    Displays {
        /// Bit n for screen n, 0..=3.
        scopes: u8,
        /// ON or OFF.
        on: bool,
    },
    /// SET CHARACTERS.
    Orientation(CharacterOrientation),
    /// SET PICKING.
    Picking(bool),
    /// SET PICKING IDENTIFIER.
    PickIdentifier(Name),
    /// SET PICKING LOCATION.
    PickLocation {
        /// Centre of the pick box, -1..=1.
        center: DVec2,
        /// Half its size.
        size: DVec2,
    },
    /// SET LEVEL_OF_DETAIL.
    LevelOfDetail(u16),
    /// INCREMENT and DECREMENT LEVEL_OF_DETAIL.
    ChangeLevelOfDetail(i32),
    /// SET CONDITIONAL_BIT.
    ConditionalBit {
        /// 0..=14.
        bit: u8,
        /// ON or OFF.
        on: bool,
    },
    /// SET RATE; the frame of the display when it was set.
    Rate {
        /// The phases.
        rate: Rate,
        /// The frame from which they are counted.
        since: u64,
    },
    /// SET RATE EXTERNAL: the phase, as functions set it.
    ExternalRate(bool),
    /// SET BLINKING.
    Blinking(bool),
    /// SET BLINK RATE, frames of a phase.
    BlinkRate(u32),
    /// SET PLOTTER.
    Plotter(bool),
    /// SET PRIORITY.
    Priority(i32),
    /// SET LINE_TEXTURE.
    LineTexture {
        /// Whether it goes on around corners.
        around_corners: bool,
        /// Which texture.
        texture: u32,
    },
    /// IF CONDITIONAL_BIT.
    IfBit {
        /// 0..=14.
        bit: u8,
        /// The state that lets through.
        on: bool,
    },
    /// IF LEVEL_OF_DETAIL.
    IfLevel {
        /// How the level compares with `level`.
        comparison: Comparison,
        /// 0..=32767.
        level: u16,
    },
    /// IF PHASE.
    IfPhase(bool),
    /// SURFACE_RENDERING and SOLID_RENDERING.
    Rendering {
        /// Whether the polygons below are the boundary of a solid.
        solid: bool,
    },
    /// SECTIONING_PLANE.
    SectioningPlane,
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
            _ => return Err("this operation is not there yet"),
        })
    }
}

impl Node {
    /// The memory that grows with the user's data, in bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Node>()
            + match self {
                Node::Nil | Node::Operate { .. } | Node::Illumination(_) | Node::Attributes(_) => 0,
                Node::Polygons(p) => {
                    p.polygons.iter().map(|p| size_of::<Polygon>() + size_of_val(p.vertices.as_slice())).sum()
                }
                Node::Labels(l) => l.labels.iter().map(|(l, _)| size_of::<Label>() + l.text.len()).sum(),
                Node::Font(font) => {
                    font.values().map(|c| size_of::<FontCharacter>() + size_of_val(c.points.as_slice())).sum()
                }
                Node::Pattern(pattern) => size_of_val(pattern.segments.as_slice()),
                Node::RawBlock(bytes) => bytes.len(),
                Node::Variable(_) => 0,
                Node::Instance(members) => members.len() * MEMBER_BYTES,
                Node::Group(members) => {
                    members.iter().map(|m| MEMBER_BYTES + if let Member::Unnamed(n) = m { n.bytes() } else { 0 }).sum()
                }
                Node::Vectors(vectors) => {
                    let dashed = vectors.dashed.iter().map(|dashed| &dashed.1);
                    let bytes = |l: &VectorList| l.points.len() * size_of::<[f32; 4]>() + l.lines.len();
                    dashed.chain([&vectors.list]).map(bytes).sum()
                }
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
