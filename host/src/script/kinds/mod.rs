//! Kinds of values that parameters take, one type each: what it is called, what it takes, what that becomes.

mod numbers;
mod vectors;
mod words;
mod lists;
mod curves;
mod materials;

pub(super) use curves::{Curve, Loops, Sides, Spline};
pub(super) use lists::{Contours, Indices, Numbers, Objects, Points, RowsOfNumbers};
pub(super) use materials::{Amount, Distribution, DistributionValue, FunctionOfAngle, Reflectance};
pub(super) use numbers::{ANY_NUMBER, Integer, Length, Number, NumberOrText, NumberOrTextValue, number};
pub(super) use vectors::{Axis, Factors, Lengths, NamedAxis, Powers, Vector};
pub(super) use words::{AnObject, Flag, Scalar, Text, Word};
