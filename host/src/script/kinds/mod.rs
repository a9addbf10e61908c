//! Kinds of values that parameters take, one type each: what it is called, what it takes, what that becomes.

mod numbers;
mod vectors;
mod words;
mod lists;
mod curves;
mod places;
mod materials;
mod models;

pub(super) use curves::{CurveKind, Loops, SidesKind, Spline};
pub(super) use lists::{Contours, Indices, Numbers, Objects, PointsKind, RowsOfNumbers};
pub(super) use materials::{
    AmountKind, DistributionKind, DistributionValue, FunctionOfAngle, MaterialOrigin, MaterialOriginKind, Reflectance,
    Reflectances,
};
pub(super) use models::{BoundsKind, ModelFunction, NameOrFile, PlantNumbers, VariedKind, VariedMap};
pub(super) use numbers::{ANY_NUMBER, Integer, Length, NumberKind, RangeKind, number};
pub(super) use places::{ObjectGroups, PlaceValue, PlacesKind};
pub(super) use vectors::{AxisKind, Factors, Lengths, NamedAxis, Powers, RectangleKind, Vector};
pub(super) use words::{Flag, NumberOrText, NumberOrTextValue, ObjectKind, ScalarKind, TextKind, Word};
