//! Drawings of plants as plain data: strokes, polygons, spheres, and surfaces that are placed; and their triangles.
//!
//! The turtle of a grammar makes one, and so do models of trees and of tufts.

mod predefined;
mod plant_drawing;
mod builder;
mod error;
mod tubes;
mod ribbons;
mod meshing;

pub(super) use builder::{DrawingBuilder, append};
pub use error::DrawingError;
pub use plant_drawing::{CrossSection, DrawnPolygon, DrawnSphere, PlacedPredefined, PlantDrawing, Stroke, StrokeNode};
pub use predefined::{PredefinedPart, PredefinedSurface};
pub(super) use tubes::push;
