//! Commands as plain data: what the parser and the binary decoder make, and the printer and encoder take.

mod network;
mod data;
mod polygon;
mod curve;
mod operate;
mod command;

pub use super::operate::{Operate, OperateKind};
pub use command::{Command, Initialize, NamePattern, Object};
pub use curve::{Bspline, Polynomial};
pub use data::{Characters, FontCharacter, Fourth, LabelText, Labels, Pattern, VectorClass, VectorList};
pub use network::{Arc, Destination, Input};
pub use operate::{Axis, Boundaries, CharacterOrientation, Comparison, Rate, Scopes};
pub use polygon::{Attributes, CornerColor, Illumination, Polygon, PolygonVertex, SurfaceColor};
