//! The words of the command language for nodes and operations, for messages and descriptions.

use super::{Node, Operation};

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

impl Operation {
    /// The command that makes such a node; for those that keep but a matrix, that of the matrix.
    pub fn word(&self) -> &'static str {
        match self {
            Operation::Character(_) => "MATRIX_2X2",
            Operation::Linear(_) => "MATRIX_3X3",
            Operation::Translate(_) => "TRANSLATE",
            Operation::Affine(_) => "MATRIX_4X3",
            Operation::Projective(_) => "MATRIX_4X4",
            Operation::Viewport { .. } => "VIEWPORT",
            Operation::LoadViewport { .. } => "LOAD VIEWPORT",
            Operation::TextSize(_) => "TEXT SIZE",
            Operation::Font(Some(_)) => "CHARACTER FONT",
            Operation::Font(None) => "STANDARD FONT",
            Operation::Color { .. } => "SET COLOR",
            Operation::ColorBlending(_) => "SET COLOR BLENDING",
            Operation::Intensity { .. } => "SET INTENSITY",
            Operation::Contrast(_) => "SET CONTRAST",
            Operation::Csm(_) => "SET CSM",
            Operation::DepthClipping(_) => "SET DEPTH_CLIPPING",
            Operation::Displays { .. } => "SET DISPLAY",
            Operation::Orientation(_) => "SET CHARACTERS",
            Operation::Picking(_) => "SET PICKING",
            Operation::PickIdentifier(_) => "SET PICKING IDENTIFIER",
            Operation::PickLocation { .. } => "SET PICKING LOCATION",
            Operation::LevelOfDetail(_) => "SET LEVEL_OF_DETAIL",
            Operation::ChangeLevelOfDetail(1..) => "INCREMENT LEVEL_OF_DETAIL",
            Operation::ChangeLevelOfDetail(_) => "DECREMENT LEVEL_OF_DETAIL",
            Operation::ConditionalBit { .. } => "SET CONDITIONAL_BIT",
            Operation::Rate { .. } => "SET RATE",
            Operation::ExternalRate(_) => "SET RATE EXTERNAL",
            Operation::Blinking(_) => "SET BLINKING",
            Operation::BlinkRate(_) => "SET BLINK RATE",
            Operation::Plotter(_) => "SET PLOTTER",
            Operation::Priority(_) => "SET PRIORITY",
            Operation::LineTexture { .. } => "SET LINE_TEXTURE",
            Operation::IfBit { .. } => "IF CONDITIONAL_BIT",
            Operation::IfLevel { .. } => "IF LEVEL_OF_DETAIL",
            Operation::IfPhase(_) => "IF PHASE",
            Operation::XformMatrix => "XFORM MATRIX",
            Operation::XformVector => "XFORM VECTOR",
            Operation::CancelXform => "CANCEL XFORM",
            Operation::WriteBack => "WRITEBACK",
            Operation::Rendering { solid: false, .. } => "SURFACE_RENDERING",
            Operation::Rendering { solid: true, .. } => "SOLID_RENDERING",
            Operation::SectioningPlane => "SECTIONING_PLANE",
        }
    }
}
