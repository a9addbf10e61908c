//! What can be wrong with a spline, and where.

/// A fault that keeps a spline from being built or changed as asked. Indices count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplineError {
    /// A degree that is zero or too high.
    #[error("degree {degree} is outside 1..={most}")]
    Degree {
        /// The degree.
        degree: usize,
        /// The highest possible.
        most: usize,
    },
    /// A list of the wrong length.
    #[error("{found} {what} were given, {needed} are needed")]
    Count {
        /// What the list holds.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that it must have.
        needed: usize,
    },
    /// A list that is too short.
    #[error("{found} {what} were given, at least {least} are needed")]
    TooFew {
        /// What the list holds.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The least length.
        least: usize,
    },
    /// A list that is too long.
    #[error("{found} {what} were given, the limit is {most}")]
    TooMany {
        /// What the list holds.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The greatest length.
        most: usize,
    },
    /// A row of a control mesh with another length than the first.
    #[error("row {row} has {found} {what}, row 0 has {needed}")]
    Row {
        /// What the row holds.
        what: &'static str,
        /// The row.
        row: usize,
        /// Its length.
        found: usize,
        /// The length of the first row.
        needed: usize,
    },
    /// A number outside its range.
    #[error("{what} {index} is {value}, it must be {range}")]
    Value {
        /// What the number is.
        what: &'static str,
        /// The place of the number in its list, from 0.
        index: usize,
        /// The number.
        value: f64,
        /// The numbers that it may be.
        range: &'static str,
    },
    /// A knot below the one before it.
    #[error("knot {index} is {value}, below the knot before it")]
    Decreasing {
        /// The index of the knot, from 0.
        index: usize,
        /// The knot.
        value: f64,
    },
    /// A knot that occurs so often that the spline would break there.
    #[error("knot {index}, {value}, occurs {found} times; at most {most} are possible there")]
    Multiplicity {
        /// Its first place.
        index: usize,
        /// The knot.
        value: f64,
        /// How often it occurs.
        found: usize,
        /// How often it may occur.
        most: usize,
    },
    /// Three zero intervals in a row.
    #[error("the intervals {index} and the two that follow it are all zero: the spline would break there")]
    Zeros {
        /// The first of the three.
        index: usize,
    },
    /// A span that is too short beside the others.
    #[error("span {span} is {length} long; it must be zero or at least 1e-13 of the domain")]
    Short {
        /// The number of the span among those that are not zero.
        span: usize,
        /// Its length.
        length: f64,
    },
    /// A domain without length.
    #[error("no span has a length above zero")]
    NoSpan,
    /// A control point that is not finite, or too far away.
    #[error("control point {column} of row {row} is {point}, its coordinates must be numbers within 1e100")]
    Point {
        /// The row of the control mesh; 0 for a curve.
        row: usize,
        /// Its place in the row.
        column: usize,
        /// The point.
        point: glam::DVec3,
    },
    /// A weight outside its range.
    #[error("weight {column} of row {row} is {weight}, it must be within 1e-12..=1e12")]
    Weight {
        /// The row of the control mesh; 0 for a curve.
        row: usize,
        /// Its place in the row.
        column: usize,
        /// The weight.
        weight: f64,
    },
    /// A parameter outside the domain, or at its ends where it must be inside.
    #[error("parameter {parameter} is not inside {low}..{high}")]
    Outside {
        /// The parameter.
        parameter: f64,
        /// The low end of the domain.
        low: f64,
        /// The high end of the domain.
        high: f64,
    },
}
